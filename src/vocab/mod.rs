//! The one table of statements, words, slots, dimensions, defaults and help texts.
