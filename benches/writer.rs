//! Blocks a second that the writer prints: `cargo bench --bench writer`.
//!
//! A million blocks of each kind, best of five; beside it, as a yardstick, a loop written by hand for the first kind
//! of one dialect, which makes the same bytes.

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

/// Digits of `steps` thousandths, trailing zeros left out.
fn push(out: &mut Vec<u8>, steps: i64) {
    if steps < 0 {
        out.push(b'-');
    }
    let mut digits = [0u8; 20];
    let (mut at, mut rest, mut left) = (20, steps.unsigned_abs(), 3);
    while left > 0 && rest % 10 == 0 {
        rest /= 10;
        left -= 1;
    }
    if left > 0 {
        for _ in 0..left {
            at -= 1;
            digits[at] = b'0' + (rest % 10) as u8;
            rest /= 10;
        }
        at -= 1;
        digits[at] = b'.';
    }
    loop {
        at -= 1;
        digits[at] = b'0' + (rest % 10) as u8;
        rest /= 10;
        if rest == 0 {
            break;
        }
    }
    out.extend_from_slice(&digits[at..]);
}

/// What the writer makes of [`xyz`] for Grbl, by hand: words that have not changed are left out.
fn plain(program: &TargetProgram) -> Vec<u8> {
    let mut out = Vec::with_capacity(program.blocks.len() * 32 + 1024);
    let mut last = [None; 3];
    let (mut code, mut feed) = ("", None);
    for block in &program.blocks {
        let (to, f, motion) = match block.kind {
            BlockKind::Motion(Motion::Rapid { to, .. }) => (to, None, "G0"),
            BlockKind::Motion(Motion::Line { to, feed: FeedWord::PerMinute(f) }) => (to, Some(f), "G1"),
            _ => continue,
        };
        let start = out.len();
        if code != motion {
            out.extend_from_slice(motion.as_bytes());
            code = motion;
        }
        for ((letter, value), old) in [(b'X', to.x), (b'Y', to.y), (b'Z', to.z)].into_iter().zip(&mut last) {
            if *old != Some(value) {
                if out.len() > start {
                    out.push(b' ');
                }
                out.push(letter);
                push(&mut out, value);
                *old = Some(value);
            }
        }
        if f.is_some() && feed != f {
            out.extend_from_slice(b" F");
            push(&mut out, f.unwrap_or_default() * 100);
            feed = f;
        }
        out.push(b'\n');
    }
    out
}

/// The writer against the loop by hand, in the same run.
fn against_plain() {
    let dialect = post::load("grbl", &MemoryFiles::default(), &mut SourceMap::default())
        .unwrap_or_else(|errors| panic!("{}", errors[0].message));
    let mut origins = Arena::default();
    let program = program(&dialect, &mut origins, xyz);
    let (mut by_hand, mut by_table) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..RUNS {
        let start = Instant::now();
        let text = black_box(plain(&program));
        by_hand = by_hand.min(start.elapsed().as_secs_f64());
        let start = Instant::now();
        let written = black_box(post::write(&dialect, &program, &origins))
            .unwrap_or_else(|e| panic!("{}", e[0].message));
        by_table = by_table.min(start.elapsed().as_secs_f64());
        // Before its first motion the writer says the feed mode: nothing has said it yet.
        let same = written.text.replacen("G94 ", "", 1);
        assert!(same.as_bytes() == text, "the two do not print the same");
    }
    println!(
        "by hand {:.2} million blocks/s, the writer takes {:.2} of its time",
        BLOCKS as f64 / by_hand / 1e6,
        by_table / by_hand
    );
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
    against_plain();
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
