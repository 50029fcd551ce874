//! Reading back a million blocks, by control and kind of move. `cargo bench --bench readback`.

use std::fmt::Write as _;
use std::time::Instant;

use partwright::readback::{Fault, Follow, MachineSetup, TraceEvent, run, run_with};

/// Counts and keeps nothing.
#[derive(Default)]
struct Count {
    events: u64,
    faults: u64,
}

impl Follow for Count {
    fn event(&mut self, _: TraceEvent) {
        self.events += 1;
    }
    fn fault(&mut self, _: Fault) {
        self.faults += 1;
    }
    fn assumed(&mut self, _: Fault) {
        self.faults += 1;
    }
}

const BLOCKS: u32 = 1_000_000;

fn lines() -> String {
    let mut text = String::from("G21 G90 G17 G94 G61\nT1 M6\nG43 H1\nS1000 M3\nG0 X0 Y0 Z0\nG1 X1 F300\n");
    for i in 0..BLOCKS {
        let _ = writeln!(text, "X{}.{:03} Y-{}.{:03}", i % 97, i % 1000, i % 89, (i * 7) % 1000);
    }
    text + "M30\n"
}

fn arcs() -> String {
    let mut text = String::from("G21 G90 G17 G94 G61\nT1 M6\nG43 H1\nS1000 M3\nG0 X10 Y0 Z0\n");
    for i in 0..BLOCKS / 2 {
        let _ = writeln!(
            text,
            "G2 X-10.000 Y0.000 I-10.000 J0.000 F{}\nG3 X10.000 Y0.000 I10.000 J0.000",
            300 + i % 7
        );
    }
    text + "M30\n"
}

fn main() {
    for (name, text) in [("lines", lines()), ("arcs", arcs())] {
        let mut count = Count::default();
        let start = Instant::now();
        run_with(text.as_bytes(), "linuxcnc", &MachineSetup::default(), &mut count)
            .expect("linuxcnc is known");
        let streamed = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let trace = run(text.as_bytes(), "linuxcnc", &MachineSetup::default()).expect("linuxcnc is known");
        let kept = start.elapsed().as_secs_f64();
        assert_eq!((count.faults, trace.faults.len()), (0, 0), "{:?}", trace.faults.first());
        let rate = |seconds: f64| f64::from(BLOCKS) / seconds / 1e6;
        println!(
            "readback {name}: {:.2} million blocks/s streamed, {:.2} kept ({} events)",
            rate(streamed),
            rate(kept),
            count.events
        );
    }
}
