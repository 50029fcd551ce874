//! Arguments of `post` and `schema`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

use crate::diag::Diagnostic;
use crate::diag::codes::tools as codes;

/// Overrides of keys of posts.
#[derive(Debug, Clone, Args)]
pub struct PostSet {
    /// Give a key of the post another value, as it would stand in the post file: numbers.plus=true.
    #[arg(long = "post-set", value_name = "KEY=VALUE")]
    pub post_set: Vec<String>,
}

impl PostSet {
    /// Keys and values.
    ///
    /// # Errors
    /// An override without a key or a value.
    pub fn pairs(&self) -> Result<Vec<(String, String)>, Diagnostic> {
        self.post_set.iter().map(|given| pair(given)).collect()
    }
}

fn pair(given: &str) -> Result<(String, String), Diagnostic> {
    let bad = |what: &str| {
        Diagnostic::global(&codes::BAD_POST_SET, format!("--post-set {given} has no {what}"))
            .help("write --post-set KEY=VALUE; `partwright post show NAME --resolved` lists the keys; an empty text is \"\"")
    };
    let (key, value) = given.split_once('=').ok_or_else(|| bad("value"))?;
    match (key.trim(), value.trim()) {
        ("", _) => Err(bad("key")),
        (_, "") => Err(bad("value")),
        (key, value) => Ok((key.to_owned(), value.to_owned())),
    }
}

/// Arguments of `post`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct PostArgs {
    /// What to do.
    #[command(subcommand)]
    pub verb: PostVerb,
}

const EXAMPLES: &str = "\
Examples:
  partwright post list                              the built-in posts, and how sure each is
  partwright post show haas --resolved              every value and the file it comes from
  partwright post new mill --from fanuc             a post of your own: writes mill.post.toml
  partwright post check mill.post.toml              finds what no program needs to find
  partwright post selftest mill.post.toml           dwells, arcs, comments, feeds, cycles …: row by row
  partwright post trace plate.apt --post mill.post.toml   a page to click through: source, CL, NC";

/// What `post` can do.
#[derive(Debug, Subcommand)]
pub enum PostVerb {
    /// List the built-in posts.
    List(PostListArgs),
    /// Print a post: what its file says, or every value with the file it comes from.
    Show(PostShowArgs),
    /// Check posts: keys, templates, parts without effect, abilities that the words cannot express.
    Check(PostCheckArgs),
    /// Write a new post that inherits from another.
    New(PostNewArgs),
    /// Try a post on everything that controls do differently, and print what it makes of it.
    Selftest(PostSelftestArgs),
    /// Write a page that links source lines, CL records and NC lines.
    Trace(PostTraceArgs),
}

/// Arguments of `post list`.
#[derive(Debug, Args)]
pub struct PostListArgs {
    /// How to print.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text, value_name = "FORMAT")]
    pub format: TextOrJson,
}

/// Arguments of `post show`.
#[derive(Debug, Args)]
pub struct PostShowArgs {
    /// A built-in post or a file NAME.post.toml.
    #[arg(value_name = "NAME|FILE")]
    pub post: String,
    /// Print the post after inheritance, with the file and line of every value: a post file of its own.
    #[arg(long)]
    pub resolved: bool,
    /// What the post says otherwise.
    #[command(flatten)]
    pub overrides: PostSet,
}

/// Arguments of `post check`.
#[derive(Debug, Args)]
pub struct PostCheckArgs {
    /// Built-in posts or files NAME.post.toml.
    #[arg(required = true, value_name = "NAME|FILE")]
    pub posts: Vec<String>,
    /// Make a warning code (or `warnings`, all of them) an error.
    #[arg(long, value_name = "CODE")]
    pub deny: Vec<String>,
    /// What the posts say otherwise.
    #[command(flatten)]
    pub overrides: PostSet,
}

/// Arguments of `post new`.
#[derive(Debug, Args)]
pub struct PostNewArgs {
    /// Name of the post, with a directory if it is to lie elsewhere: writes NAME.post.toml.
    #[arg(value_name = "NAME")]
    pub name: PathBuf,
    /// The post to inherit from: the nearest relative of your control.
    #[arg(long, value_name = "NAME|FILE")]
    pub from: String,
}

/// Arguments of `post selftest`.
#[derive(Debug, Args)]
pub struct PostSelftestArgs {
    /// A built-in post or a file NAME.post.toml.
    #[arg(value_name = "NAME|FILE")]
    pub post: String,
    /// Try the rows in programs in inches.
    #[arg(long)]
    pub inch: bool,
    /// How to print.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text, value_name = "FORMAT")]
    pub format: TextOrJson,
    /// What the post says otherwise.
    #[command(flatten)]
    pub overrides: PostSet,
}

/// Arguments of `post trace`.
#[derive(Debug, Args)]
pub struct PostTraceArgs {
    /// The program file; `-` is standard input.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// The controller; without it the program's first, or linuxcnc.
    #[arg(long, value_name = "NAME|FILE")]
    pub post: Option<String>,
    /// The page; `-` is standard output. Default: STEM.POST.html beside the source.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// What the post says otherwise.
    #[command(flatten)]
    pub overrides: PostSet,
    /// What all verbs that compile take.
    #[command(flatten)]
    pub common: super::CommonArgs,
}

/// Arguments of `schema`.
#[derive(Debug, Args)]
pub struct SchemaArgs {
    /// Of what.
    #[arg(value_enum, value_name = "WHAT")]
    pub of: Schema,
}

/// Things that have a schema.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Schema {
    /// Post files, NAME.post.toml.
    Post,
    /// The certificates that `build --report` writes.
    Report,
    /// One line of `--message-format json`.
    Diagnostics,
    /// The file that `build --source-map` writes.
    SourceMap,
    /// Test files, NAME.test.toml.
    Test,
    /// What `test --format json` prints.
    TestReport,
    /// What `diff --format json` prints.
    Diff,
    /// What `post selftest --format json` prints.
    Selftest,
}

/// Text for people or JSON for programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum TextOrJson {
    /// For people.
    Text,
    /// For programs.
    Json,
}
