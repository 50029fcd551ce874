//! The certificate file of `--report`, and the few lines that say the same on standard error.

use std::path::Path;

use serde::Serialize;

use super::args::Stage;
use super::build::{Compiled, Planned};
use super::output::Product;
use crate::units::LengthUnit;
use crate::verify::{Certificate, ClearingProof, Deviation, OperationProof};

/// Version of the report's form: minor steps only add members.
const VERSION: &str = "1.0";

#[derive(Serialize)]
struct Report<'a> {
    schema: &'static str,
    version: &'static str,
    partwright: &'static str,
    programs: Vec<Program<'a>>,
}

#[derive(Serialize)]
struct Program<'a> {
    source: String,
    inputs: &'a [String],
    outputs: Vec<NcFile<'a>>,
}

#[derive(Serialize)]
struct NcFile<'a> {
    post: &'a str,
    file: Option<String>,
    certificate: &'a Certificate,
    #[serde(skip)]
    units: LengthUnit,
}

fn nc_files<'a>(source: usize, one: &'a Compiled, planned: &[Planned]) -> Vec<NcFile<'a>> {
    let file = |index: usize| {
        let found =
            planned.iter().find(|p| p.source == source && p.output == Some(index) && p.stage == Stage::Nc);
        found.map(|p| p.path.to_string_lossy().into_owned())
    };
    let outputs = one.build.outputs.iter().enumerate();
    let proven = outputs.filter_map(|(index, output)| Some((index, output, output.proven.as_ref()?)));
    proven
        .map(|(index, output, proven)| NcFile {
            post: &output.post,
            file: file(index),
            certificate: proven.certificate(),
            units: output.units,
        })
        .collect()
}

/// The report of a run.
pub fn product(path: &Path, compiled: &[Compiled], planned: &[Planned]) -> Product {
    let programs = compiled.iter().enumerate().map(|(i, one)| Program {
        source: one.path.to_string_lossy().into_owned(),
        inputs: &one.build.inputs,
        outputs: nc_files(i, one, planned),
    });
    let report = Report {
        schema: "partwright-report",
        version: VERSION,
        partwright: env!("CARGO_PKG_VERSION"),
        programs: programs.collect(),
    };
    let mut text = serde_json::to_string_pretty(&report).unwrap_or_default();
    text.push('\n');
    Product { path: path.to_path_buf(), bytes: text.into_bytes() }
}

/// A few lines for people: what was written and how good it is.
pub fn summary(compiled: &[Compiled], planned: &[Planned]) -> String {
    let files = compiled.iter().enumerate().flat_map(|(i, one)| nc_files(i, one, planned));
    files.map(|file| line(&file)).collect()
}

fn line(file: &NcFile<'_>) -> String {
    let name = file.file.as_deref().filter(|n| *n != "-").unwrap_or("standard output");
    let certificate = file.certificate;
    let moves = certificate.moves;
    let count = moves.rapids + moves.lines + moves.arcs + moves.spirals + moves.nurbs;
    let parts = [
        Some(format!("{count} moves")),
        deviation(certificate, file.units),
        cusps(certificate, file.units),
        unreachable(certificate, file.units),
        bound(certificate),
        cleared(certificate, file.units),
        Some(duration(certificate.time.total())),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    format!("{name}: {}\n", parts.join(", "))
}

/// The largest deviations of all operations, in the program's unit.
fn deviation(certificate: &Certificate, units: LengthUnit) -> Option<String> {
    let largest = |of: fn(&OperationProof) -> Option<Deviation>| {
        certificate.operations.iter().filter_map(of).map(|d| d.value).max_by(f64::total_cmp)
    };
    let into = largest(|o| o.into)?;
    let out = largest(|o| o.out)?;
    let decimals = match units {
        LengthUnit::Millimetre => 4,
        LengthUnit::Inch => 6,
    };
    let shown = |v: f64| format!("{:.decimals$}", v / units.in_mm());
    Some(format!("at most {} into and {} {} off the part", shown(into), shown(out), units.symbol()))
}

/// The highest cusp of all finished surfaces, and what may be left at most.
fn cusps(certificate: &Certificate, units: LengthUnit) -> Option<String> {
    let surfaces = || certificate.operations.iter().filter_map(|o| o.surface.as_ref());
    let highest = surfaces().filter_map(|s| s.cusp).map(|c| c.value).max_by(f64::total_cmp)?;
    let left = surfaces().map(|s| s.left_bound).fold(0.0, f64::max);
    let decimals = if units == LengthUnit::Inch { 6 } else { 4 };
    let shown = |v: f64| format!("{:.decimals$}", v / units.in_mm());
    Some(format!("cusps of {}, nowhere more than {} {} left", shown(highest), shown(left), units.symbol()))
}

/// What is cleared in levels, and the path beside the shortest that its volume allows.
fn cleared(certificate: &Certificate, units: LengthUnit) -> Option<String> {
    let clearings = || certificate.operations.iter().filter_map(|o| o.clearing.as_ref());
    clearings().next()?;
    let sum = |of: fn(&ClearingProof) -> f64, unit: f64| clearings().map(of).sum::<f64>() / unit;
    let (unit, symbol) = (units.in_mm(), units.symbol());
    let volume = sum(|c| c.volume, unit * unit * unit);
    let [cut, least] = [sum(|c| c.cut, unit), sum(|c| c.bound, unit)];
    Some(format!(
        "{volume:.1} {symbol}³ cleared by {cut:.1} {symbol} at feed ({least:.1} by volume the least)"
    ))
}

/// What of the finished surfaces the cutters cannot reach, and the most that is left there.
fn unreachable(certificate: &Certificate, units: LengthUnit) -> Option<String> {
    let surfaces = || certificate.operations.iter().filter_map(|o| o.surface.as_ref());
    let most = surfaces().filter_map(|s| s.unreachable).max_by(|a, b| a.value.total_cmp(&b.value))?;
    let (out, whole) = surfaces()
        .filter_map(|s| Some((s.unreachable_area?, s.area)))
        .fold((0.0, 0.0), |sum, own| (sum.0 + own.0, sum.1 + own.1));
    let (few, many) = if units == LengthUnit::Inch { (4, 6) } else { (1, 4) };
    let square = units.in_mm() * units.in_mm();
    let shown = |v: f64| format!("{:.many$}", v / units.in_mm());
    (out > 0.0).then(|| {
        format!(
            "unreachable {:.few$} {}² of {:.few$} (largest remaining {} {} at X {} Y {} Z {})",
            out / square,
            units.symbol(),
            whole / square,
            shown(most.value),
            units.symbol(),
            shown(most.x),
            shown(most.y),
            shown(most.z)
        )
    })
}

/// Blocks of the contours, and the proven lower bound where it is known for all of them.
fn bound(certificate: &Certificate) -> Option<String> {
    let pieces = || certificate.operations.iter().flat_map(|o| &o.pieces);
    let blocks: u32 = pieces().map(|p| p.blocks).sum();
    let least: Option<u32> = pieces().map(|p| p.lower_bound).sum();
    (blocks > 0).then(|| match least {
        Some(least) => format!("{blocks} contour blocks ({least} is the least possible)"),
        None => format!("{blocks} contour blocks"),
    })
}

fn duration(seconds: f64) -> String {
    let whole = seconds.round().max(0.0);
    let (minutes, rest) = ((whole / 60.0).floor(), whole % 60.0);
    if minutes > 0.0 { format!("{minutes} min {rest} s") } else { format!("{seconds:.1} s") }
}
