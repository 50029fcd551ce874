//! IGES files in small.

use std::sync::Arc;

use proptest::prelude::*;

use super::*;
use crate::geom::Point3;

/// A file of entities: type, directory line of the matrix, parameters without their type.
fn iges(global: &str, entities: &[(u32, u32, &str)]) -> String {
    let mut lines: Vec<String> = vec![format!("{:72}S{:7}", "start", 1)];
    let pad = |data: &str, section: char, n: usize| format!("{data:72}{section}{n:7}");
    let chunks = |text: &str, size: usize| -> Vec<String> {
        let letters: Vec<char> = text.chars().collect();
        letters.chunks(size).map(|c| c.iter().collect()).collect()
    };
    lines.extend(chunks(global, 72).iter().enumerate().map(|(i, c)| pad(c, 'G', i + 1)));
    let mut directory = Vec::new();
    let mut parameters = Vec::new();
    for (i, (kind, matrix, text)) in entities.iter().enumerate() {
        let own = chunks(&format!("{kind},{text};"), 64);
        let first = parameters.len() + 1;
        directory
            .push(format!("{kind:8}{first:8}{:8}{:8}{:8}{:8}{matrix:8}{:8}{:>8}", 0, 0, 0, 0, 0, "00000000"));
        directory.push(format!("{kind:8}{:8}{:8}{:8}{:8}{:32}", 0, 0, own.len(), 0, ""));
        parameters.extend(own.into_iter().map(|c| format!("{c:64}{:8}", 2 * i + 1)));
    }
    lines.extend(directory.iter().enumerate().map(|(i, d)| pad(d, 'D', i + 1)));
    lines.extend(parameters.iter().enumerate().map(|(i, p)| pad(p, 'P', i + 1)));
    lines.push(pad("S      1G      1D      2P      1", 'T', 1));
    lines.join("\r\n") + "\r\n"
}

fn open(text: &str) -> Result<Document, Trouble> {
    Document::open(Format::Iges, &Arc::from(text))
}

fn net(text: &str, face: Option<usize>) -> Result<Import, Trouble> {
    open(text).and_then(|d| d.net(face))
}

const MM: &str = "1H,,1H;,4Hpart,8Hpart.igs,9Ha, b; c H,3H1.0,32,38,6,308,15,4Hpart,1.0,2,2HMM,1,0.1,\
                  15H20260101.000000,1.0D-6,100.0,1Ha,1Hb,11,0;";
/// 3 × 2 poles of degrees 2 and 1; the index of u runs fastest in the file.
const SURFACE: &str = "2,1,2,1,0,0,1,0,0,0.,0.,0.,1.,1.,1.,0.,0.,1.,1.,1.,1.,1.,1.,1.,1.,\
                       0.,0.,0.,10.,0.,2.D0,20.,0.,0.,0.,8.,1.,10.,8.,3.,20.,8.,1.E0,0.,1.,0.,1.";

#[test]
fn a_surface_is_read_with_its_rows_in_u() {
    let import = net(&iges(MM, &[(128, 0, SURFACE)]), None).expect("a net");
    assert_eq!((import.notices.clone(), import.net.patches()[0].degree()), (vec![], [2, 1]));
    let patch = &import.net.patches()[0];
    assert_eq!(patch.pole(1, 0), Point3::new(10.0, 0.0, 2.0));
    assert_eq!(patch.pole(2, 1), Point3::new(20.0, 8.0, 1.0));
}

#[test]
fn units_scales_and_matrices_apply() {
    let last = |text: &str| net(text, None).expect("a net").net.patches()[0].pole(2, 1);
    let turn = "0.,-1.,0.,5.,1.,0.,0.,0.,0.,0.,1.,0.";
    let shift = "1.,0.,0.,100.,0.,1.,0.,0.,0.,0.,1.,7.";
    let inch = MM.replace("1.0,2,2HMM", "1.0,1,4HINCH");
    assert_eq!(last(&iges(&inch, &[(128, 0, SURFACE)])), Point3::new(20.0 * 25.4, 8.0 * 25.4, 25.4));
    let named = MM.replace("1.0,2,2HMM", "1.0,3,2HCM");
    assert_eq!(last(&iges(&named, &[(128, 0, SURFACE)])), Point3::new(200.0, 80.0, 10.0));
    let half = MM.replace("1.0,2,2HMM", "0.5,2,2HMM");
    assert_eq!(last(&iges(&half, &[(128, 0, SURFACE)])), Point3::new(40.0, 16.0, 2.0));
    // The surface is turned first, then what turned it is shifted.
    let placed = iges(MM, &[(124, 3, turn), (124, 0, shift), (128, 1, SURFACE)]);
    assert_eq!(last(&placed), Point3::new(-8.0 + 5.0 + 100.0, 20.0, 8.0));
    let round = iges(MM, &[(124, 3, turn), (124, 1, shift), (128, 1, SURFACE)]);
    assert_eq!(net(&round, None).expect_err("no end").kind, TroubleKind::File);
    let none = MM.replace("1.0,2,2HMM", "1.0,3,5HELLEN");
    assert_eq!(net(&iges(&none, &[(128, 0, SURFACE)]), None).expect("a net").notices, [Notice::NoUnit]);
}

#[test]
fn faces_are_counted_and_trimmed_ones_told() {
    let line = |a: &str, b: &str| format!("{a},{b}");
    let (a, b, c, d) = ("0.,0.,0.", "20.,0.,0.", "20.,8.,1.", "0.,8.,1.");
    let flat = SURFACE.replace("10.,0.,2.D0", "10.,0.,0.").replace("10.,8.,3.", "10.,8.,1.");
    let sides = [line(a, b), line(b, c), line(c, d), line(d, a)];
    let half = [line(a, "10.,0.,0."), line("10.,0.,0.", "10.,8.,1."), line("10.,8.,1.", d), line(d, a)];
    let file = |sides: &[String; 4], trimmed: &str| {
        let mut entities: Vec<(u32, u32, &str)> = vec![(128, 0, &flat)];
        entities.extend(sides.iter().map(|s| (110, 0, s.as_str())));
        entities.extend([
            (102, 0, "4,3,5,7,9"),
            (142, 0, "1,1,0,11,2"),
            (144, 0, trimmed),
            (122, 0, "1,0.,0.,1."),
        ]);
        entities.push((144, 0, "17,0,0,0"));
        iges(MM, &entities)
    };
    let notices = |text: &str| net(text, None).expect("a net").notices;
    assert_eq!(notices(&file(&sides, "1,0,0,0")), []);
    assert_eq!(notices(&file(&sides, "1,1,0,13")), []);
    assert_eq!(notices(&file(&half, "1,1,0,13")), [Notice::Trimmed]);
    assert_eq!(notices(&file(&sides, "1,1,1,13,13")), [Notice::Trimmed]);
    let trouble = net(&file(&sides, "1,0,0,0"), Some(2)).expect_err("no B-spline");
    assert_eq!(trouble.message, "face 2 lies on a surface of type 122, which is no B-spline surface");
    assert_eq!(trouble.help.as_deref(), Some("face 1 lies on one"));
    let part = SURFACE.replace("1.E0,0.,1.,0.,1.", "1.E0,0.,0.5,0.,1.");
    assert_eq!(notices(&iges(MM, &[(128, 0, &part)])), [Notice::Trimmed]);
}

#[test]
fn other_delimiters_and_rational_surfaces_are_understood() {
    let global = MM.replace("a, b; c H", "a/ b# c H").replace([',', ';'], "/").replace("1H//1H/", "1H//1H#");
    let global = global.strip_suffix('/').map(|g| format!("{g}#")).expect("an end");
    let surface = SURFACE
        .replace(",0,0,1,0,0,", ",0,0,0,0,0,")
        .replace("1.,1.,1.,1.,1.,1.,1.,0.", "1.,1.,2.,1.,1.,1.,1.,0.");
    let text =
        iges(&global, &[(128, 0, &surface.replace(',', "/"))]).replace("128,", "128/").replace(';', "#");
    let import = net(&text, None).expect("a net");
    assert!(import.net.patches()[0].is_rational());
    assert_eq!(import.net.patches()[0].pole(1, 0), Point3::new(10.0, 0.0, 2.0));
}

#[test]
fn what_is_no_iges_file_says_so() {
    let trouble = |text: &str| net(text, None).expect_err("no file");
    assert!(trouble("ISO-10303-21;\n").message.contains("no IGES file"));
    assert_eq!(trouble("").kind, TroubleKind::File);
    let whole = iges(MM, &[(128, 0, SURFACE)]);
    for length in 0..whole.len() - 90 {
        assert_eq!(trouble(&whole[..length]).kind, TroubleKind::File);
    }
    let short = iges(MM, &[(128, 0, "2,1,2,1,0,0,1,0,0,0.,0.")]);
    assert!(trouble(&short).message.contains("list of 6 numbers"), "{}", trouble(&short).message);
    let huge = iges(MM, &[(128, 0, "999999,999999,3,3,0,0,1,0,0,0.,0.")]);
    assert_eq!(trouble(&huge).kind, TroubleKind::File);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn broken_iges_files_are_refused_or_read(
        changes in proptest::collection::vec((any::<prop::sample::Index>(), "[-0-9,;.HD SGPT]"), 1..4),
    ) {
        let mut text = iges(MM, &[(124, 0, "1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,1.,0."), (128, 1, SURFACE), (144, 0, "3,1,0,5")]);
        for (at, with) in &changes {
            let at = at.index(text.len());
            text.replace_range(at..=at, with);
        }
        if let Ok(import) = net(&text, None) {
            prop_assert!(import.net.jet(0.5, 0.5).p.coords.iter().all(|c| c.is_finite()));
        }
    }
}
