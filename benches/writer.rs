//! Blocks a second that the writer prints: `cargo bench --bench writer`.
//!
//! A million blocks of each kind, best of five.

use std::hint::black_box;
use std::time::Instant;

use partwright::arena::Arena;
use partwright::ir::Origin;
use partwright::post;
use partwright::source::{FileId, MemoryFiles, SourceMap, Span};
use partwright::target::{Block, BlockKind, FeedWord, Motion, Position, TargetProgram, axes};
use partwright::units::LengthUnit;

const BLOCKS: i64 = 1_000_000;
const RUNS: usize = 5;

/// The motion of block `i`.
type Kind = fn(i64) -> Motion;

fn xyz(i: i64) -> Motion {
    // Three axes that change in every block, five digits each, as in 3-D finishing.
    let to =
        Position { x: i * 37 % 90_001 - 45_000, y: i * 91 % 80_021 - 40_000, z: -(i * 13 % 20_011), r: 0 };
    Motion::Line { to, feed: FeedWord::PerMinute(12_000) }
}

fn xy(i: i64) -> Motion {
    let to = Position { x: i * 37 % 90_001 - 45_000, y: i * 91 % 80_021 - 40_000, z: -5_000, r: 0 };
    Motion::Line { to, feed: FeedWord::PerMinute(3_000) }
}

fn arc(i: i64) -> Motion {
    let to = Position { x: i * 37 % 90_001 - 45_000, y: i * 91 % 80_021 - 40_000, z: -5_000, r: 0 };
    Motion::Arc {
        plane: partwright::target::Plane::Xy,
        to,
        centre: [i % 9_973, -(i % 7_919)],
        clockwise: i % 2 == 0,
        feed: FeedWord::PerMinute(3_000),
    }
}

fn program(dialect: &post::Dialect, origins: &mut Arena<Origin>, kind: Kind) -> TargetProgram {
    let origin = origins.push(Origin { span: Span::new(FileId(0), 0, 0), calls: Vec::new() });
    let capabilities =
        dialect.capabilities(LengthUnit::Millimetre, None).unwrap_or_else(|e| panic!("{}", e.message));
    let start = Motion::Rapid { to: Position::default(), axes: axes::X | axes::Y | axes::Z };
    let blocks = core::iter::once(start)
        .chain((0..BLOCKS).map(kind))
        .map(|motion| Block { kind: BlockKind::Motion(motion), origin, piece: None, record: None })
        .collect();
    TargetProgram {
        title: None,
        capabilities,
        tools: Vec::new(),
        pieces: Vec::new(),
        nurbs: Vec::new(),
        cycles: Vec::new(),
        blocks,
    }
}

/// Time to find, inherit and check a built-in post: part of every cold start.
fn load_time(name: &str) {
    let mut best = f64::INFINITY;
    for _ in 0..50 {
        let start = Instant::now();
        let _ = black_box(post::load(name, &MemoryFiles::default(), &mut SourceMap::default()));
        best = best.min(start.elapsed().as_secs_f64());
    }
    println!("{name:10} loaded in {:.3} ms", best * 1e3);
}

fn main() {
    for name in ["linuxcnc", "fanuc", "grbl"] {
        load_time(name);
        let dialect = post::load(name, &MemoryFiles::default(), &mut SourceMap::default())
            .unwrap_or_else(|errors| panic!("{name}: {}", errors[0].message));
        for (label, kind) in [("G1 X Y Z", xyz as Kind), ("G1 X Y", xy), ("G2/G3 X Y I J", arc)] {
            let mut origins = Arena::default();
            let program = program(&dialect, &mut origins, kind);
            let mut best = f64::INFINITY;
            let mut bytes = 0;
            for _ in 0..RUNS {
                let start = Instant::now();
                let written = black_box(post::write(&dialect, &program, &origins))
                    .unwrap_or_else(|e| panic!("{}", e[0].message));
                best = best.min(start.elapsed().as_secs_f64());
                bytes = written.text.len();
            }
            println!(
                "{name:10} {label:14} {:6.2} million blocks/s, {bytes} bytes",
                BLOCKS as f64 / best / 1e6
            );
        }
    }
}
