//! Pictures: cam, path and diagrams as SVG and PNG.
