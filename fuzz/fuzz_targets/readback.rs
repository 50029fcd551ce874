//! Any bytes as a program for every control: no panic, no hang, every event usable.
//!
//! How to run it stands in `fuzz/README.md`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use partwright::readback::{EventKind, MOST_FAULTS, MachineSetup, Rotary, controls, run};

fuzz_target!(|data: &[u8]| {
    let setup = MachineSetup { rotary: Some(Rotary { letter: 'C', reversed: false }), ..MachineSetup::default() };
    for control in controls() {
        let Ok(trace) = run(data, control, &setup) else { panic!("a control of the list is not known") };
        assert!(trace.faults.len() <= MOST_FAULTS);
        for event in &trace.events {
            if let EventKind::Move(cut) = &event.kind {
                let _ = (cut.start(), cut.end(), cut.length());
            }
        }
    }
});
