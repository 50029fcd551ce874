//! Hostile texts for every control: an answer, no panic, in time.

use proptest::prelude::*;

use super::*;

fn setup() -> MachineSetup {
    MachineSetup { rotary: Some(Rotary { letter: 'C', reversed: false }), ..MachineSetup::default() }
}

/// Reads for every control and touches everything that comes.
fn read(text: &[u8]) {
    let setup = setup();
    for control in controls() {
        let trace = run(text, control, &setup).expect("a control of the list");
        assert!(trace.faults.len() <= MOST_FAULTS && needs(control).is_ok());
        for event in &trace.events {
            if let EventKind::Move(cut) = &event.kind {
                let _ = (cut.start(), cut.end(), cut.length(), cut.heights());
            }
        }
    }
}

#[test]
fn long_lines_and_nuls_are_answered() {
    for byte in [0, b'(', b'"', b'9', b'X', b'~', b',', b'[', b' ', 0xff] {
        read(&vec![byte; 300_000]);
    }
    let line = "X1".repeat(200_000);
    read(
        format!(
            "G1 {line}\nMCALL CYCLE81({}\nCYCL DEF 200 {}\n",
            "1,".repeat(50_000),
            "Q1=1 ".repeat(20_000)
        )
        .as_bytes(),
    );
}

#[test]
fn cycles_have_bounds() {
    for text in [
        "%\nO1\nG17 G21 G90 G94 G54 G98\nT1 M6\nG43 H1\nS1 M3\nF1\nG0 X0. Y0. Z5.\nG83 X1. Z-9000. R1. Q0.001 K9999\nM30\n%\n",
        "G17 G710 G90 G94 G54 G60\nT1 M6 D1\nS1 M3 F1\nG0 X0 Y0 Z5\nMCALL CYCLE83(10,0,1,-9000,,,0.0001,0,0,0,1,1)\nX1\n",
        "UNITS/MM\nCYCLE/DEEP, FEDTO, 9000, STEP, 0.0001, MMPM, 1, CLEAR, 2\nGOTO/1, 0, 0\n",
    ] {
        read(text.as_bytes());
    }
}

proptest! {
    #[test]
    fn any_bytes_are_answered(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        read(&bytes);
    }

    #[test]
    fn any_words_are_answered(words in prop::collection::vec("[A-Z]{1,2}[-+=]?[0-9]{0,7}[.]?[0-9]{0,3}|G[0-9]{1,3}|M[0-9]{1,2}|CYCL DEF 200 Q20[0-6]=-?[0-9]{1,3}|MCALL CYCLE8[1-9]\\([0-9,.-]{0,30}\\)|GOTO/ ?[0-9,. -]{1,20}|CYCLE/DEEP, FEDTO, [0-9]{1,5}, STEP, [0-9.]{1,4}|\\n|~|;|%|\\(|\\)", 0..80)) {
        read(words.join(" ").as_bytes());
    }
}
