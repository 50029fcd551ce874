//! The target program as text (`--emit target`).
