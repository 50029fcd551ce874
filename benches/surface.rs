//! Whole jobs on surfaces, from the source text to the proven program, and how their cost grows.
//!
//! `cargo bench --bench surface [-- NAME]`: the rows whose name contains NAME. Times depend on the machine; compare rows
//! of one run with each other.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use partwright::driver::{self, Options};
use partwright::source::MemoryFiles;

/// A net over a rectangle: its poles are equally spaced, and `height` gives their z from their row and column.
fn net(size: (f64, f64), poles: usize, height: impl Fn(usize, usize) -> f64) -> String {
    let step = |extent: f64, k: usize| {
        extent * f64::from(u32::try_from(k).unwrap_or(0)) / f64::from(u32::try_from(poles - 1).unwrap_or(1))
    };
    let mut text = format!("N1 = NET/ {poles}, {poles}");
    for i in 0..poles {
        for j in 0..poles {
            let _ =
                write!(text, ", $\n({:.9}, {:.9}, {:.6})", step(size.0, i), step(size.1, j), height(i, j));
        }
    }
    text
}

/// One patch of 100 by 100 mm.
fn hill() -> String {
    const Z: [[f64; 4]; 4] =
        [[0.0, 10.0, 5.0, 0.0], [8.0, 25.0, 20.0, 6.0], [4.0, 18.0, 25.0, 12.0], [0.0, 6.0, 10.0, 3.0]];
    net((100.0, 100.0), 4, |i, j| Z[i][j])
}

/// 3 by 3 patches over 200 by 200 mm, smooth at their joints.
fn waves() -> String {
    const Z: [f64; 10] = [0.0, 6.0, 12.0, 9.0, 6.0, 1.0, 3.0, 5.0, 7.0, 0.0];
    net((200.0, 200.0), 10, |i, j| 0.5 * (Z[i] + Z[j]))
}

fn program(net: &str, outtol: f64, operation: &str) -> String {
    format!(
        "UNITS/ MM\nMACHIN/ LINUXCNC\n{net}\nT1 = CUTTER/ BALL, 10, NUMBER, 1\nLOADTL/ T1\nSPINDL/ 8000\nFEDRAT/ 900\n\
         INTOL/ 0\nOUTTOL/ {outtol}\nCLEARP/ 60\nSURFAC/ N1, ZIGZAG, {operation}\nFINI\n"
    )
}

fn row(name: &str, runs: u32, text: &str) {
    if std::env::args().skip(1).any(|a| !a.starts_with('-') && !name.contains(&a)) {
        return;
    }
    let files = MemoryFiles([("job.apt".to_owned(), text.to_owned())].into());
    let mut best = Duration::MAX;
    let mut shown = String::new();
    for _ in 0..runs {
        let start = Instant::now();
        let build = driver::build("job.apt", &files, &Options::default());
        best = best.min(start.elapsed());
        let proof =
            build.outputs.first().and_then(|o| o.proven.as_ref()).map(|p| p.certificate().operations.clone());
        shown = match proof.as_deref() {
            Some([one, ..]) => one.surface.as_ref().map_or_else(String::new, |s| {
                format!(
                    "{:>8} blocks {:>6} passes {:>10.1} mm, left at most {:.5} mm",
                    s.blocks, s.passes, s.length, s.left_bound
                )
            }),
            _ => format!("refused: {:?}", build.diagnostics.iter().map(|d| d.code.id).collect::<Vec<_>>()),
        };
    }
    println!("{name:<28} {best:>10.2?}  {shown}");
}

fn main() {
    for outtol in [0.01, 0.001] {
        row(&format!("201 lines, OUTTOL {outtol}"), 5, &program(&hill(), outtol, "U, STEP, 0.5"));
    }
    for cusp in [0.02, 0.01, 0.005, 0.0025] {
        row(&format!("patch, CUSP {cusp}"), 1, &program(&hill(), 0.01, &format!("U, CUSP, {cusp}")));
    }
    for cusp in [0.008, 0.004, 0.002] {
        row(&format!("3 x 3 patches, CUSP {cusp}"), 1, &program(&waves(), 0.01, &format!("U, CUSP, {cusp}")));
    }
}
