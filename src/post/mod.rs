//! Target program to text: dialect files and one fast table-driven writer.
