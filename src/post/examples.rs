//! Posts of `examples/posts` whose curves are pieces, for tests.

use super::{Dialect, load};
use crate::source::{MemoryFiles, SourceMap};

/// Names and texts.
const TEXTS: [(&str, &str); 5] = [
    ("grblhal_g5", include_str!("../../examples/posts/grblhal_g5.post.toml")),
    ("itnc530", include_str!("../../examples/posts/itnc530.post.toml")),
    ("linuxcnc_g5", include_str!("../../examples/posts/linuxcnc_g5.post.toml")),
    ("marlin_g5", include_str!("../../examples/posts/marlin_g5.post.toml")),
    ("sinumerik_poly", include_str!("../../examples/posts/sinumerik_poly.post.toml")),
];

/// Names of posts whose curves are pieces, cut as such.
pub(crate) fn exact() -> impl Iterator<Item = &'static str> {
    names().filter(|name| !["grblhal_g5", "marlin_g5"].contains(name))
}

/// Names of posts whose curves are pieces.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    TEXTS.iter().map(|(name, _)| *name)
}

/// One of those, or a built-in post.
pub(crate) fn any(name: &str) -> Dialect {
    let files = TEXTS.iter().map(|(name, text)| (format!("{name}.post.toml"), (*text).to_owned())).collect();
    let own = names().any(|n| n == name);
    let name = if own { format!("{name}.post.toml") } else { name.to_owned() };
    load(&name, &MemoryFiles(files), &mut SourceMap::default()).unwrap_or_else(|e| panic!("{name}: {e:#?}"))
}
