//! AST to IR: names, dimensions, macros, loops, checks.
