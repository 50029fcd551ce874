//! Printing of the reference.
