//! Arguments of `test`, `diff` and `new`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Arguments of `test`.
#[derive(Debug, Args)]
#[command(after_help = TEST_EXAMPLES)]
pub struct TestArgs {
    /// Where to look for programs, with the directories below; or one program.
    #[arg(default_value = ".", value_name = "DIR")]
    pub dir: PathBuf,
    /// Take what is new and what differs as golden files, and remove those that no test makes.
    #[arg(long)]
    pub accept: bool,
    /// Only tests with this text in `PROGRAM [VARIANT] POST`.
    #[arg(long, value_name = "TEXT")]
    pub filter: Option<String>,
    /// How to print.
    #[arg(long, value_enum, default_value_t = TestFormat::Text, value_name = "FORMAT")]
    pub format: TestFormat,
    /// Where to print; `-` is standard output.
    #[arg(short, long, default_value = "-", value_name = "FILE")]
    pub output: PathBuf,
    /// Threads to work with; the result does not depend on it.
    #[arg(short = 'j', long = "jobs", value_name = "N")]
    pub jobs: Option<usize>,
}

const TEST_EXAMPLES: &str = "\
Every program below DIR that names its machine, or has a NAME.test.toml or golden files beside it, is built and compared
with NAME.POST.golden.EXT. Differences are shown as text and as motion. docs/testing.md says more.

Examples:
  partwright test                                   all programs below this directory
  partwright test parts --filter fanuc              some of them
  partwright test --accept                          takes what is new and different
  partwright test --format junit -o junit.xml       for build servers

Exit status: 0 all as accepted, 1 a program has errors, 2 usage or file trouble, 3 something differs.";

/// Forms of test reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum TestFormat {
    /// For people.
    Text,
    /// For programs (`partwright schema test-report`).
    Json,
    /// For build servers.
    Junit,
}

/// Arguments of `diff`.
#[derive(Debug, Args)]
#[command(after_help = DIFF_EXAMPLES)]
pub struct DiffArgs {
    /// An NC program.
    #[arg(value_name = "A")]
    pub a: PathBuf,
    /// Another NC program.
    #[arg(value_name = "B")]
    pub b: PathBuf,
    /// The post whose control executes both; without it the one in the name STEM.POST.EXT.
    #[arg(long, value_name = "NAME|FILE")]
    pub post: Option<String>,
    /// Largest distance of paths that count as the same, mm.
    #[arg(long, default_value_t = 0.001, value_name = "MM", value_parser = positive)]
    pub tolerance: f64,
    /// Largest difference of feeds and speeds that count as the same, percent.
    #[arg(long, default_value_t = 0.1, value_name = "PERCENT", value_parser = positive)]
    pub rate_tolerance: f64,
    /// Letter of the rotary table, when the programs move one.
    #[arg(long, value_name = "LETTER")]
    pub rotary: Option<char>,
    /// How to print.
    #[arg(long, value_enum, default_value_t = super::post::TextOrJson::Text, value_name = "FORMAT")]
    pub format: super::post::TextOrJson,
}

const DIFF_EXAMPLES: &str = "\
Both programs are executed by the control's interpreter. The same path may be cut into other blocks.

Examples:
  partwright diff plate.fanuc.nc old/plate.fanuc.nc
  partwright diff a.nc b.nc --post haas --tolerance 0.01

Exit status: 0 the same motion, 2 usage or file trouble, 3 a difference, 4 the control cannot execute one of them.";

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("a number above 0 is needed".to_owned()),
    }
}

/// Arguments of `new`.
#[derive(Debug, Args)]
pub struct NewArgs {
    /// The directory of the project; made when it does not exist.
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
    /// The post that the project's own post inherits from.
    #[arg(long, default_value = "linuxcnc", value_name = "NAME")]
    pub from: String,
}
