//! Random programs: what is printed is read again by a reader of ten lines, word by word.

use proptest::prelude::*;

use super::build::Sheet;
use crate::target::axes;

/// The state a control would be in: X, Y, Z in thousandths.
fn read(line: &str, state: &mut [i64; 3]) {
    for word in line.split(' ') {
        let (letter, number) = word.split_at(1);
        let Some(axis) = "XYZ".find(letter) else { continue };
        let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
        let digits = format!("{whole}{fraction:0<3}");
        state[axis] = digits.parse().unwrap();
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn text_reads_back_to_the_same_positions(
        points in proptest::collection::vec((-99_999_999i64..=99_999_999, -3i64..=3, -2i64..=2, 0u8..3), 1..40),
        name in prop::sample::select(vec!["fanuc", "grbl"]),
    ) {
        let mut sheet = Sheet::at(name, 0, 0);
        let mut wanted = Vec::new();
        for &(x, y, z, kind) in &points {
            sheet = match kind {
                0 => sheet.rapid(x, y, z, axes::X | axes::Y | axes::Z),
                1 => { let feed = sheet.minute(); sheet.line_at(x, y, z, 0, feed) }
                _ => sheet.rapid(x, y, z, axes::X | axes::Y | axes::Z).arc(x + 2000, y, [1000, 0], true),
            };
            wanted.push(if kind == 2 { [x + 2000, y, z] } else { [x, y, z] });
        }
        let written = sheet.written().unwrap();
        let lines: Vec<&str> = written.text.lines().collect();
        let mut state = [0; 3];
        let mut got = Vec::new();
        for (first, end) in &written.lines {
            for line in *first..*end {
                let zero = lines[line as usize - 1].split(' ').any(|w| w.ends_with("-0") || w.ends_with("-0."));
                prop_assert!(!zero, "{}", lines[line as usize - 1]);
                read(lines[line as usize - 1], &mut state);
            }
            got.push(state);
        }
        let ends: Vec<[i64; 3]> = sheet.program.blocks.iter().filter_map(|b| match b.kind {
            crate::target::BlockKind::Motion(crate::target::Motion::Rapid { to, .. }
                | crate::target::Motion::Line { to, .. }
                | crate::target::Motion::Arc { to, .. }) => Some([to.x, to.y, to.z]),
            _ => None,
        }).collect();
        prop_assert_eq!(&got[1..], &ends[..]);
        prop_assert_eq!(got.last(), wanted.last());
    }
}
