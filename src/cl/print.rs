//! CL data as APT CL text (`--emit cl`).
