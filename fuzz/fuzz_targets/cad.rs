//! Arbitrary text as a STEP and an IGES file: never a panic, never a net of numbers that are none.
#![no_main]

use std::sync::Arc;

use libfuzzer_sys::fuzz_target;
use partwright::cad::{Document, Format};

fuzz_target!(|text: &str| {
    let text: Arc<str> = text.into();
    for format in [Format::Step, Format::Iges] {
        let Ok(document) = Document::open(format, &text) else { continue };
        for face in [None, Some(1), Some(2)] {
            if let Ok(import) = document.net(face) {
                assert!(import.net.jet(0.5, 0.5).p.coords.iter().all(|c| c.is_finite()));
            }
        }
    }
});
