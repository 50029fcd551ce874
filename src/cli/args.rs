//! The command line's grammar.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::diag::render::Format;

pub mod golden;
pub mod post;

use golden::{DiffArgs, NewArgs, TestArgs};
use post::{PostArgs, SchemaArgs};

/// A compiler for part programs: APT-like source in, proven G-code out.
#[derive(Debug, Parser)]
#[command(name = "partwright", version, propagate_version = true, after_help = EXAMPLES)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub verb: Verb,
    /// How messages are written to standard error.
    #[arg(long, value_enum, default_value_t = MessageFormat::Human, global = true, value_name = "FORMAT")]
    pub message_format: MessageFormat,
    /// Colour in messages; `auto`: on a terminal, unless NO_COLOR is set.
    #[arg(long, value_enum, default_value_t = Color::Auto, global = true, value_name = "WHEN")]
    pub color: Color,
}

const EXAMPLES: &str = "\
Examples:
  partwright build plate.apt                        for the machines that the program names
  partwright build plate.apt --post linuxcnc        writes plate.linuxcnc.ngc beside plate.apt
  partwright build plate.apt --post fanuc -o O1.nc  names the output; `-o -` is standard output
  partwright build *.apt --post grbl --out-dir nc   several programs, one directory
  partwright build plate.apt -D STROKE=25mm         gives a PARAM of the program another value
  partwright check plate.apt                        all checks, no output
  partwright test                                   compares all programs here with their golden files
  partwright diff old.fanuc.nc plate.fanuc.nc       compares two NC programs as motion
  partwright explain E0401                          what a message means and how to mend it

Exit status: 0 done, 1 errors in the program, 2 usage or file trouble, 3 a golden file differs,
4 the emitted program failed its proof, 101 a fault of partwright itself.";

/// The verbs.
#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Compile programs and write proven NC programs.
    #[command(after_help = BUILD_EXAMPLES)]
    Build(BuildArgs),
    /// Run all checks of programs and write nothing.
    Check(CheckArgs),
    /// Print the page of a diagnostic code, or list all codes.
    Explain(ExplainArgs),
    /// Post CL files of a CAM system: as build, and every file is taken for a CL file.
    #[command(after_help = CL_EXAMPLES)]
    Cl(BuildArgs),
    /// Write a net of a program as a STEP or STL file.
    #[command(after_help = EXPORT_EXAMPLES)]
    Export(ExportArgs),
    /// Draw a cam, the cutter's path, or its deviation from the exact curves.
    #[command(after_help = PLOT_EXAMPLES)]
    Plot(PlotArgs),
    /// Build programs and compare with golden files.
    Test(TestArgs),
    /// Compare two NC programs as motion.
    Diff(DiffArgs),
    /// Make a project: a post, a program, golden files, a CI file.
    New(NewArgs),
    /// List, show, check, make and try posts.
    Post(PostArgs),
    /// Print the JSON Schema of a file that partwright reads or writes.
    Schema(SchemaArgs),
}

const BUILD_EXAMPLES: &str = "\
Each NC program is called STEM.POST.EXT, with the controller's own extension, and lies beside its source or in --out-dir.
Nothing is written before every program of the command has been proven; a failed build leaves old files as they were.

Examples:
  partwright build plate.apt --post linuxcnc --post fanuc --out-dir nc
  partwright build plate.apt --post shop/mill.post.toml -o plate.nc --report plate.json
  partwright build plate.apt --post grbl -o - | grep G1
  partwright build plate.apt --emit cl              prints the cutter location data
  partwright build plate.apt --post linuxcnc --deps plate.d --deps-format make";

const CL_EXAMPLES: &str = "\
Build takes CL files, too, where their name (.cls .clsf .ncl .nci .as .aptsource .cl) or what stands in them tells.

Examples:
  partwright cl pocket.cls --post heidenhain
  partwright cl bracket.ncl --post fanuc -D SPINDL=3000     a speed for a file that gives none
  partwright cl part.txt --producer catia --lenient --post sinumerik";

const EXPORT_EXAMPLES: &str = "\
Examples:
  partwright export cavity.apt -o cavity.stp        exact, AP214, in mm
  partwright export two.apt --net N2 -o part.stl --tolerance 0.005";

const PLOT_EXAMPLES: &str = "\
Examples:
  partwright plot plate.apt -o plate.svg
  partwright plot plate.apt --what deviation --post grbl -o deviation.png
  partwright plot cavity.apt --what deviation -o cavity.html    a page: turn it, walk through its blocks";

/// Arguments of `build`.
#[derive(Debug, Args)]
pub struct BuildArgs {
    /// Program files; `-` is standard input.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Controller: a built-in post or a file NAME.post.toml; may be given several times. Without it the
    /// program's MACHIN statements decide.
    #[arg(long, value_name = "NAME|FILE")]
    pub post: Vec<String>,
    /// What the posts say otherwise in this run.
    #[command(flatten)]
    pub overrides: post::PostSet,
    /// The output file, when there is only one; `-` is standard output.
    #[arg(short, long, value_name = "FILE", conflicts_with = "out_dir")]
    pub output: Option<PathBuf>,
    /// Directory for the outputs; made when it does not exist.
    #[arg(long, value_name = "DIR")]
    pub out_dir: Option<PathBuf>,
    /// What to produce: ast, ir, cl and target are printed, or written to --out-dir.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "nc", value_name = "STAGES")]
    pub emit: Vec<Stage>,
    /// Write the certificates of all NC programs as JSON (docs/schema/report.schema.json).
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
    /// Write which source line, CL record and NC lines belong together (docs/schema/source-map.schema.json).
    #[arg(long, value_name = "FILE")]
    pub source_map: Option<PathBuf>,
    /// Write the files that were read and the files that are made.
    #[arg(long, value_name = "FILE")]
    pub deps: Option<PathBuf>,
    /// The form of --deps.
    #[arg(long, value_enum, default_value_t = DepsFormat::Make, value_name = "FORMAT", requires = "deps")]
    pub deps_format: DepsFormat,
    /// What all verbs that compile take.
    #[command(flatten)]
    pub common: CommonArgs,
}

/// What all verbs that compile take.
#[derive(Debug, Args)]
pub struct CommonArgs {
    /// Give the PARAM called NAME another value, as it would stand in the program.
    #[arg(short = 'D', long = "define", value_name = "NAME=VALUE")]
    pub define: Vec<String>,
    /// The system that wrote a CL file, where it is not recognised: nx, catia, creo, solidworks, ncl, mastercam, plain.
    #[arg(long, value_name = "NAME")]
    pub producer: Option<String>,
    /// Go on, with warnings, where a CL file has records that are not known or cannot be carried out.
    #[arg(long)]
    pub lenient: bool,
    /// Make a warning code (or `warnings`, all of them) an error.
    #[arg(long, value_name = "CODE")]
    pub deny: Vec<String>,
    /// Leave out what stands behind column 72 of a line, as on punched cards.
    #[arg(long)]
    pub card_columns: bool,
    /// Threads to work with; the result does not depend on it.
    #[arg(short = 'j', long = "jobs", value_name = "N")]
    pub jobs: Option<usize>,
}

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct CheckArgs {
    /// Program files; `-` is standard input.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// What all verbs that compile take.
    #[command(flatten)]
    pub common: CommonArgs,
}

/// Arguments of `explain`.
#[derive(Debug, Args)]
pub struct ExplainArgs {
    /// A code such as E0401; without one all codes are listed.
    #[arg(value_name = "CODE")]
    pub code: Option<String>,
}

/// Arguments of `export`.
#[derive(Debug, Args)]
pub struct ExportArgs {
    /// The program file; `-` is standard input.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// The net, when the program has several.
    #[arg(long, value_name = "NAME")]
    pub net: Option<String>,
    /// The file to write: FILE.stp, FILE.step or FILE.stl.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// How far triangles of an STL file may be from the surface, mm.
    #[arg(long, default_value_t = 0.01, value_name = "MM")]
    pub tolerance: f64,
    /// What all verbs that compile take.
    #[command(flatten)]
    pub common: CommonArgs,
}

/// Arguments of `plot`.
#[derive(Debug, Args)]
pub struct PlotArgs {
    /// The program file; `-` is standard input.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// What to draw.
    #[arg(long, value_enum, default_value_t = Picture::Cam, value_name = "WHAT")]
    pub what: Picture,
    /// The cam to draw, when the program has several.
    #[arg(long, value_name = "NAME")]
    pub cam: Option<String>,
    /// The picture: FILE.svg or FILE.png, or FILE.html, a page to turn and walk through (path, deviation); `-` is standard
    /// output (SVG). Default: STEM.WHAT.svg beside the source.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Pixels of a PNG for every unit of the drawing.
    #[arg(long, default_value_t = 2.0, value_name = "FACTOR")]
    pub scale: f32,
    /// The controller whose path is drawn; without it the program's first, or linuxcnc.
    #[arg(long, value_name = "NAME|FILE")]
    pub post: Option<String>,
    /// What all verbs that compile take.
    #[command(flatten)]
    pub common: CommonArgs,
}

/// Pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Picture {
    /// A cam with its pitch curve, the cutter's path, and the diagrams of motion, pressure angle and curvature.
    Cam,
    /// The cutter's path.
    Path,
    /// How far the blocks are from the exact curves, or what the cutter leaves on a surface.
    Deviation,
}

/// Stages that can be printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Stage {
    /// The syntax tree.
    Ast,
    /// The evaluated program.
    Ir,
    /// Cutter location data, APT CL text.
    Cl,
    /// The program of one controller, before it is spelled.
    Target,
    /// The NC program.
    Nc,
}

/// Forms of the dependency file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DepsFormat {
    /// A rule for make and ninja.
    Make,
    /// An object with `inputs` and `outputs`.
    Json,
}

/// Forms of messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum MessageFormat {
    /// With the source lines.
    Human,
    /// `file:line:column: error[E0101]: message`.
    Short,
    /// One JSON object a line (docs/diagnostics-json.md).
    Json,
}

impl From<MessageFormat> for Format {
    fn from(format: MessageFormat) -> Self {
        match format {
            MessageFormat::Human => Format::Human,
            MessageFormat::Short => Format::Short,
            MessageFormat::Json => Format::Json,
        }
    }
}

/// When messages are coloured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Color {
    /// On a terminal, unless NO_COLOR is set.
    Auto,
    /// Always.
    Always,
    /// Never.
    Never,
}
