//! Where the time goes: every stage of the main example, and a million blocks written and read back.
//!
//! `cargo bench --bench stages` prints, for each row, the median of several runs and what it means per unit.
//! Times depend on the machine; compare rows of one run with each other.

use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

use partwright::arena::Arena;
use partwright::diag::Sink;
use partwright::driver::{self, Options};
use partwright::ir::Origin;
use partwright::source::{FileId, MemoryFiles, SourceMap, Span};
use partwright::target::{Block, BlockKind, FeedWord, Motion, Position, TargetProgram};
use partwright::units::LengthUnit;
use partwright::{lower, plan, post, readback, sema, syntax, verify};

const RUNS: usize = 15;

fn median(mut work: impl FnMut()) -> Duration {
    work();
    let mut times: Vec<Duration> = (0..RUNS)
        .map(|_| {
            let start = Instant::now();
            work();
            start.elapsed()
        })
        .collect();
    times.sort();
    times[RUNS / 2]
}

fn row(name: &str, time: Duration, remark: &str) {
    println!("{name:<34} {:>10.3} ms  {remark}", time.as_secs_f64() * 1e3);
}

fn main() {
    let example =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/plate_cam.apt"))
            .expect("the main example");
    stages(&example);
    million_blocks();
}

fn stages(text: &str) {
    let files = MemoryFiles([("plate_cam.apt".to_owned(), text.to_owned())].into());
    let options = Options { posts: vec!["linuxcnc".to_owned()], ..Options::default() };
    let whole = median(|| {
        black_box(driver::build("plate_cam.apt", &files, &options));
    });

    let mut sink = Sink::default();
    let mut sources = SourceMap::default();
    let file = sources.add("plate_cam.apt", text);
    let parse = median(|| {
        black_box(syntax::parse(file, text, &mut Sink::default()));
    });
    let analyse = median(|| {
        let mut sources = sources.clone();
        black_box(sema::analyse(file, &mut sources, &files, &sema::Options::default(), &mut Sink::default()));
    });
    let ir = sema::analyse(file, &mut sources, &files, &sema::Options::default(), &mut sink).expect("an IR");
    let planned = median(|| {
        black_box(plan::plan(&ir, &mut Sink::default()));
    });
    let cl = plan::plan(&ir, &mut sink).expect("CL data");
    let loaded = median(|| {
        black_box(post::load("linuxcnc", &files, &mut SourceMap::default()).expect("a dialect"));
    });
    let dialect = post::load("linuxcnc", &files, &mut SourceMap::default()).expect("a dialect");
    let capabilities = dialect.capabilities(LengthUnit::Millimetre, None).expect("capabilities");
    let lowered = median(|| {
        black_box(lower::lower(&cl, &capabilities, &mut Sink::default()));
    });
    let target = lower::lower(&cl, &capabilities, &mut sink).expect("a target program");
    let written = median(|| {
        black_box(post::write(&dialect, &target, &cl.origins).expect("text"));
    });
    let text = post::write(&dialect, &target, &cl.origins).expect("text");
    let proven = median(|| {
        let emitted = verify::Emitted { text: text.text.clone(), lines: text.lines.clone() };
        black_box(verify::prove(&cl, &target, emitted, dialect.control(), &mut Sink::default()));
    });
    row("the main example, whole", whole, "source text to proven program");
    row("  syntax", parse, "");
    row("  syntax and sema", analyse, "");
    row("  plan", planned, "");
    row("  post: load the dialect", loaded, "");
    row("  lower", lowered, "");
    row("  post: write", written, "");
    row("  readback and verify", proven, "");
}

/// A program of a million short lines on a slowly rising spiral.
fn million_blocks() {
    const BLOCKS: u32 = 1_000_000;
    let files = MemoryFiles::default();
    let dialect = post::load("linuxcnc", &files, &mut SourceMap::default()).expect("a dialect");
    let capabilities = dialect.capabilities(LengthUnit::Millimetre, None).expect("capabilities");
    let mut origins = Arena::default();
    let origin = origins.push(Origin { span: Span::new(FileId(0), 0, 0), calls: Vec::new() });
    let block = |kind| Block { kind, origin, piece: None, record: None };
    let mut blocks = vec![block(BlockKind::Begin)];
    for i in 0..BLOCKS {
        let angle = f64::from(i) * 0.01;
        let (s, c) = partwright::math::sin_cos(angle);
        #[allow(clippy::cast_possible_truncation)]
        let steps = |x: f64| (x * 1e6) as i64;
        let to = Position { x: steps(c * 0.5), y: steps(s * 0.5), z: i64::from(i / 100), r: 0 };
        blocks.push(block(BlockKind::Motion(Motion::Line { to, feed: FeedWord::PerMinute(300_000) })));
    }
    blocks.push(block(BlockKind::End));
    let target = TargetProgram {
        title: None,
        capabilities,
        tools: Vec::new(),
        pieces: Vec::new(),
        nurbs: Vec::new(),
        cycles: Vec::new(),
        blocks,
    };
    let write = median(|| {
        black_box(post::write(&dialect, &target, &origins).expect("text"));
    });
    let text = post::write(&dialect, &target, &origins).expect("text").text;
    let setup = readback::MachineSetup::default();
    let read = median(|| {
        black_box(readback::run(text.as_bytes(), dialect.control(), &setup).expect("a known control"));
    });
    let rate = |time: Duration| {
        format!("{:.1} million blocks a second", f64::from(BLOCKS) / time.as_secs_f64() / 1e6)
    };
    row("write a million blocks", write, &rate(write));
    row("read a million blocks back", read, &rate(read));
}
