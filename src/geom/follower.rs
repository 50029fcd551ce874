//! Followers: the four kinds of Kim & Yang (1991), sections 2.1–2.4, by envelope theory.
