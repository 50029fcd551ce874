//! Places where the same program must come out differently: one table for each.

use super::build::{Sheet, builtin};
use crate::cl::{CycleKind, RetractTo};
use crate::ir::Spindle;
use crate::post::{builtin_names, load_with};
use crate::source::{MemoryFiles, SourceMap};
use crate::target::{BlockKind, FeedWord, Motion, Plane, Position, axes};
use crate::units::LengthUnit;

/// Steps of a millimetre.
fn step(name: &str) -> i64 {
    10i64.pow(u32::from(Sheet::mm(name).program.capabilities.grid.linear_decimals))
}

/// At the origin, everything said.
fn home(name: &str) -> Sheet {
    Sheet::at(name, 0, 0)
}

/// Without block numbers.
fn plain(lines: Vec<String>, numbered: bool) -> Vec<String> {
    // Lines that continue a block have no number.
    let number = |word: &str| word.bytes().all(|b| b.is_ascii_digit());
    let cut = |line: String| match line.split_once(' ') {
        Some((first, rest)) if number(first) => rest.to_owned(),
        _ => line,
    };
    if numbered { lines.into_iter().map(cut).collect() } else { lines }
}

fn rest(name: &str, sheet: &Sheet) -> Vec<String> {
    plain(sheet.rest(), name == "heidenhain")
}

fn check(table: &[(&str, &[&str])], made: impl Fn(&str) -> Vec<String>) {
    let named: std::collections::BTreeSet<&str> = table.iter().map(|(name, _)| *name).collect();
    for name in builtin_names() {
        assert!(named.contains(name), "{name} is not in the table");
    }
    for (name, wanted) in table {
        assert_eq!(made(name), *wanted, "{name}");
    }
}

#[test]
fn dwell_in_a_block() {
    let table: &[(&str, &[&str])] = &[
        ("apt-cl", &["DELAY/1.25"]),
        ("centroid", &["G4 P1.25"]),
        ("fanuc", &["G4 P1250"]),
        ("grbl", &["G4 P1.25"]),
        ("grblhal", &["G4 P1.25"]),
        ("haas", &["G4 P1250"]),
        ("heidenhain", &["CYCL DEF 9.0 DWELL TIME", "CYCL DEF 9.1 DWELL 1.25"]),
        ("linuxcnc", &["G4 P1.25"]),
        ("mach3", &["G4 P1.25"]),
        ("marlin", &["G4 S1.25"]),
        ("mazak", &["G4 P1250"]),
        ("mitsubishi", &["G4 P1250"]),
        ("okuma", &["G4 F1.25"]),
        ("sinumerik", &["G4 F1.25"]),
    ];
    check(table, |name| rest(name, &home(name).event(BlockKind::Dwell(1.25))));
}

#[test]
fn dwell_in_a_cycle() {
    let first = |name: &str| {
        let sheet = home(name).drill(CycleKind::Dwell, &[(10, 20)]);
        plain(sheet.rest(), name == "heidenhain")
    };
    for name in ["fanuc", "haas", "mazak", "mitsubishi"] {
        assert_eq!(first(name), ["G99 G82 X10. Y20. Z-10. R2. P500 F300.", "G80"], "{name}");
    }
    assert_eq!(first("linuxcnc"), ["G99 G82 X10 Y20 Z-10 R2 P0.5 F300", "G80"]);
    assert_eq!(first("mach3"), ["G99 G82 X10 Y20 Z-10 R2 P0.5 F300", "G80"]);
    assert_eq!(first("centroid"), ["G99 G82 X10. Y20. Z-10. R2. P0.5 F300.", "G80"]);
    assert_eq!(first("okuma"), ["G71 Z2.", "G82 X10. Y20. Z-10. R2. P0.5 F300. M53", "G0 Z2."]);
    assert_eq!(first("sinumerik"), ["F300", "MCALL CYCLE82(2,0,2,-10,,0.5)", "G0 X10 Y20", "MCALL"]);
    let klartext = first("heidenhain");
    assert!(klartext.iter().any(|l| l.ends_with("Q211=0.5 ;DWELL TIME AT DEPTH")), "{klartext:?}");
}

#[test]
fn full_circles() {
    let table: &[(&str, &[&str])] = &[
        ("apt-cl", &["FEDRAT/300, MMPM", "CIRCLE/0, 0, 0, 0, 0, -1, 10", "GOTO/10, 0, 0"]),
        ("centroid", &["G2 I-10. J0. F300."]),
        ("fanuc", &["G2 I-10. J0. F300."]),
        ("grbl", &["G2 X10 I-10 J0 F300"]),
        ("grblhal", &["G2 X10 I-10 J0 F300"]),
        ("haas", &["G2 I-10. J0. F300."]),
        ("heidenhain", &["CC X+0 Y+0", "C X+10 Y+0 DR- F300"]),
        ("linuxcnc", &["G2 I-10 J0 F300"]),
        ("mach3", &["G2 I-10 J0 F300"]),
        ("marlin", &["G2 I-10 J0 F300"]),
        ("mazak", &["G2 I-10. J0. F300."]),
        ("mitsubishi", &["G2 I-10. J0. F300."]),
        ("okuma", &["G2 I-10. J0. F300."]),
        ("sinumerik", &["G2 I-10 J0 F300"]),
    ];
    check(table, |name| {
        let ten = 10 * step(name);
        rest(name, &Sheet::at(name, ten, 0).arc(ten, 0, [-ten, 0], true))
    });
}

#[test]
fn arcs_and_what_is_left_out_of_them() {
    // A half turn whose end differs in X only, another after it, and the same centre offsets again.
    let table: &[(&str, &[&str])] = &[
        (
            "apt-cl",
            &[
                "FEDRAT/300, MMPM",
                "CIRCLE/10, 0, 0, 0, 0, 1, 10",
                "GOTO/20, 0, 0",
                "CIRCLE/30, 0, 0, 0, 0, 1, 10",
                "GOTO/40, 0, 0",
            ],
        ),
        ("centroid", &["G3 X20. I10. J0. F300.", "X40. I10. J0."]),
        ("fanuc", &["G3 X20. I10. J0. F300.", "X40. I10. J0."]),
        ("grbl", &["G3 X20 I10 J0 F300", "X40 I10 J0"]),
        ("grblhal", &["G3 X20 I10 J0 F300", "X40 I10 J0"]),
        ("haas", &["G3 X20. I10. J0. F300.", "X40. I10. J0."]),
        ("heidenhain", &["CC X+10 Y+0", "C X+20 Y+0 DR+ F300", "CC X+30 Y+0", "C X+40 Y+0 DR+"]),
        ("linuxcnc", &["G3 X20 I10 J0 F300", "X40 I10 J0"]),
        ("mach3", &["G3 X20 I10 J0 F300", "X40 I10 J0"]),
        ("marlin", &["G3 X20 I10 J0 F300", "G3 X40 I10 J0"]),
        ("mazak", &["G3 X20. I10. J0. F300.", "X40. I10. J0."]),
        ("mitsubishi", &["G3 X20. I10. J0. F300.", "X40. I10. J0."]),
        ("okuma", &["G3 X20. I10. J0. F300.", "X40. I10. J0."]),
        ("sinumerik", &["G3 X20 I10 J0 F300", "X40 I10 J0"]),
    ];
    check(table, |name| {
        let ten = 10 * step(name);
        let sheet = home(name).arc(2 * ten, 0, [ten, 0], false).arc(4 * ten, 0, [ten, 0], false);
        rest(name, &sheet)
    });
}

#[test]
fn arcs_in_other_planes_say_their_plane_and_no_offset_along_its_axis() {
    let arc = |name: &str, plane: Plane| {
        let ten = 10 * step(name);
        let feed = home(name).minute();
        let to = match plane {
            Plane::Zx => Position { x: 2 * ten, ..Position::default() },
            _ => Position { y: 2 * ten, ..Position::default() },
        };
        let centre = if plane == Plane::Zx { [0, ten] } else { [ten, 0] };
        let sheet = home(name)
            .event(BlockKind::Motion(Motion::Arc { to, plane, centre, clockwise: true, feed }))
            .at_position(to);
        let at = sheet.position();
        rest(name, &sheet.arc(at.x + ten, at.y + ten, [ten, 0], true).event(BlockKind::EndCycle))
    };
    assert_eq!(arc("fanuc", Plane::Zx), ["G18 G2 X20. I10. K0. F300.", "G17 X30. Y10. I10. J0."]);
    assert_eq!(arc("fanuc", Plane::Yz), ["G19 G2 Y20. J10. K0. F300.", "G17 X10. Y30. I10. J0."]);
    // The planes of the one change the axis of the tool's length, and its CIP is asked for by posts; poles say the plane.
    let planes = builtin("sinumerik").capabilities(LengthUnit::Millimetre, None).unwrap().planes;
    assert_eq!(planes.into_keys().collect::<Vec<_>>(), [Plane::Xy]);
    assert_eq!(arc("sinumerik", Plane::Zx), ["CIP X20 I1=10 J1=0 K1=-10 F300", "G2 X30 Y10 I10 J0"]);
    assert_eq!(arc("heidenhain", Plane::Yz)[..2], ["CC Y+10 Z+0", "C Y+20 Z+0 DR- F300"]);
    assert_eq!(
        arc("apt-cl", Plane::Yz)[1..3],
        ["CIRCLE/0, 10, 0, -1, 0, 0, 10".to_owned(), "GOTO/0, 20, 0".to_owned()]
    );
}

#[test]
fn a_program_never_ends_or_drills_in_another_plane() {
    let feed = home("fanuc").minute();
    let to = Position { x: 20_000, ..Position::default() };
    let arc = Motion::Arc { to, plane: Plane::Zx, centre: [0, 10_000], clockwise: true, feed };
    let sheet =
        home("fanuc").event(BlockKind::Motion(arc)).at_position(to).drill(CycleKind::Drill, &[(1, 1)]);
    assert_eq!(sheet.rest()[1..3], ["G17", "G99 G81 X1. Y1. Z-10. R2. F300."]);
    let sheet = home("fanuc").event(BlockKind::Motion(arc)).at_position(to).event(BlockKind::End);
    assert_eq!(sheet.rest()[1], "G17");
}

#[test]
fn helices() {
    let helix = |name: &str| {
        let ten = 10 * step(name);
        let feed = home(name).minute();
        let to = Position { x: ten, y: ten, z: -ten, r: 0 };
        let motion = Motion::Arc { to, plane: Plane::Xy, centre: [0, ten], clockwise: false, feed };
        let sheet = home(name).event(BlockKind::Motion(motion)).at_position(to);
        rest(name, &sheet.rapid(to.x, to.y, 0, axes::Z).line(to.x, 0))
    };
    assert_eq!(helix("fanuc"), ["G3 X10. Y10. Z-10. I0. J10. F300.", "G0 Z0.", "G1 Y0."]);
    assert_eq!(helix("linuxcnc"), ["G3 X10 Y10 Z-10 I0 J10 F300", "G0 Z0", "G1 Y0"]);
    // Turning by an angle leaves the tool near its point, not on it: the next straight move says both words.
    assert_eq!(
        helix("heidenhain"),
        ["CC X+0 Y+10", "CP IPA+90 Z-10 DR+ F300", "L Z+0 R0 FMAX", "L X+10 Y+0 R0"]
    );
    assert_eq!(
        helix("apt-cl")[1..3],
        ["CIRCLE/0, 10, 0, 0, 0, 1, 10".to_owned(), "GOTO/10, 10, -10".to_owned()]
    );
}

#[test]
fn numbers_and_their_points() {
    let table: &[(&str, &[&str])] = &[
        ("apt-cl", &["FEDRAT/300, MMPM", "GOTO/-1.5, 20, 0"]),
        ("centroid", &["G1 X-1.5 Y20. F300."]),
        ("fanuc", &["G1 X-1.5 Y20. F300."]),
        ("grbl", &["G1 X-1.5 Y20 F300"]),
        ("grblhal", &["G1 X-1.5 Y20 F300"]),
        ("haas", &["G1 X-1.5 Y20. F300."]),
        ("heidenhain", &["L X-1.5 Y+20 R0 F300"]),
        ("linuxcnc", &["G1 X-1.5 Y20 F300"]),
        ("mach3", &["G1 X-1.5 Y20 F300"]),
        ("marlin", &["G1 X-1.5 Y20 F300"]),
        ("mazak", &["G1 X-1.5 Y20. F300."]),
        ("mitsubishi", &["G1 X-1.5 Y20. F300."]),
        ("okuma", &["G1 X-1.5 Y20. F300."]),
        ("sinumerik", &["G1 X-1.5 Y20 F300"]),
    ];
    check(table, |name| rest(name, &home(name).line(-3 * step(name) / 2, 20 * step(name))));
}

#[test]
fn inch_feeds() {
    // An inch a minute.
    let feed = |name: &str| {
        let sheet = Sheet::new(builtin(name), LengthUnit::Inch, None).rapid(0, 0, 0, 7);
        let grid = sheet.program.capabilities.grid;
        let steps = (grid.feed_scale * crate::target::power_of_ten(grid.feed_decimals)).round() as i64;
        let line = sheet.line_at(1, 0, 0, 0, FeedWord::PerMinute(steps)).rest().concat();
        let number = if name == "apt-cl" { "FEDRAT/" } else { "F" };
        line.split_once(number).map(|(_, f)| f.split(['G', ' ']).next().unwrap().to_owned()).unwrap()
    };
    for name in builtin_names().filter(|n| *n != "heidenhain" && *n != "apt-cl") {
        assert_eq!(feed(name).trim_end_matches('.'), "1", "{name}");
    }
    assert_eq!(feed("heidenhain"), "10", "tenths of an inch");
    assert_eq!(feed("apt-cl"), "1,");
}

#[test]
fn feeds_are_said_again_after_a_change_of_feed_type() {
    for name in ["fanuc", "sinumerik", "linuxcnc", "mazak", "mitsubishi", "haas", "okuma", "mach3"] {
        let one = step(name);
        let grid = home(name).program.capabilities.grid;
        let minute = home(name).minute();
        let turn = FeedWord::PerRevolution(10i64.pow(u32::from(grid.feed_per_revolution_decimals)) / 10);
        let lines = home(name)
            .line_at(one, 0, 0, 0, minute)
            .line_at(2 * one, 0, 0, 0, turn)
            .line_at(3 * one, 0, 0, 0, minute)
            .rest();
        assert!(lines[0].contains("F300"), "{name}: {lines:?}");
        assert!(lines[1].starts_with("G95") && lines[1].contains("F0.1"), "{name}: {lines:?}");
        assert!(lines[2].starts_with("G94") && lines[2].contains("F300"), "{name}: {lines:?}");
    }
}

#[test]
fn rapid_moves_that_go_at_f_say_theirs() {
    let lines = home("marlin").line(1000, 0).rapid(0, 0, 0, axes::X).line(1000, 0).rest();
    assert_eq!(lines, ["G1 X1 F300", "G0 X0 F3000", "G1 X1 F300"]);
}

#[test]
fn tool_changes() {
    let table: &[(&str, &[&str])] = &[
        ("apt-cl", &["CUTTER/16, 0", "LOADTL/1", "SPINDL/1200, CLW", "RAPID", "GOTO/0, 0, 5"]),
        ("centroid", &["(T1, FLAT, D=16)", "G53 G0 Z0.", "T1 M6", "G43 H1", "S1200 M3", "G0 X0. Y0. Z5."]),
        ("fanuc", &["G91 G28 Z0.", "G90", "(T1, FLAT, D=16)", "T1 M6", "S1200 M3", "G43 H1 G0 X0. Y0. Z5."]),
        ("grbl", &["(T1, flat, D=16)", "S1200 M3", "G0 X0 Y0 Z5"]),
        ("grblhal", &["(T1, flat, D=16)", "S1200 M3", "G0 X0 Y0 Z5"]),
        ("haas", &["G91 G28 Z0.", "G90", "(T1, FLAT, D=16)", "T1 M6", "S1200 M3", "G43 H1 G0 X0. Y0. Z5."]),
        (
            "heidenhain",
            &["; T1, flat, D=16", "L Z+0 R0 FMAX M91", "TOOL CALL 1 Z S1200", "M3", "L X+0 Y+0 Z+5 R0 FMAX"],
        ),
        ("linuxcnc", &["(T1, flat, D=16)", "T1 M6", "G43 H1", "S1200 M3", "G0 X0 Y0 Z5"]),
        ("mach3", &["(T1, flat, D=16)", "G53 G0 Z0", "T1 M6", "G43 H1", "S1200 M3", "G0 X0 Y0 Z5"]),
        ("marlin", &["; T1, flat, D=16", "M3 S1200", "G0 X0 Y0 Z5 F3000"]),
        ("mazak", &["G91 G28 Z0.", "G90", "(T1, FLAT, D=16)", "T1 M6", "S1200 M3", "G43 H1 G0 X0. Y0. Z5."]),
        (
            "mitsubishi",
            &["G91 G28 Z0.", "G90", "(T1, FLAT, D=16)", "T1 M6", "S1200 M3", "G43 H1 G0 X0. Y0. Z5."],
        ),
        ("okuma", &["G16 H0 G0 Z0.", "(T1, FLAT, D=16)", "T1 M6", "S1200 M3", "G56 H1 G0 X0. Y0. Z5."]),
        ("sinumerik", &["; T1, flat, D=16", "SUPA G0 Z0 D0", "T1 M6", "D1", "S1200 M3", "G0 X0 Y0 Z5"]),
    ];
    check(table, |name| {
        let sheet = Sheet::mm(name)
            .event(BlockKind::ToolChange(0))
            .event(BlockKind::Spindle(Spindle::on(1200.0, true)))
            .rapid(0, 0, 5 * step(name), 7);
        plain(sheet.body(), name == "heidenhain")
    });
}

#[test]
fn tools_by_name_and_speeds_that_change_alone() {
    let set = [("options.TOOLS".to_owned(), "name".to_owned())];
    let dialect = load_with("sinumerik", &set, &MemoryFiles::default(), &mut SourceMap::default()).unwrap();
    let sheet = Sheet::new(dialect, LengthUnit::Millimetre, None).event(BlockKind::ToolChange(0));
    assert_eq!(sheet.body()[2], "T=\"T1\" M6");
    let on = |rpm| BlockKind::Spindle(Spindle::on(rpm, true));
    let sheet = home("heidenhain").event(BlockKind::ToolChange(0)).event(on(900.0)).event(on(950.0));
    let lines = plain(sheet.rest(), true);
    assert_eq!(lines[lines.len() - 4..], ["TOOL CALL 1 Z S900", "M3", "TOOL CALL S950", "M3"]);
}

#[test]
fn smoothing_words_carry_the_share_of_the_tolerance() {
    let path = |name: &str| rest(name, &home(name).event(BlockKind::PathTolerance(Some(0.0025))));
    assert_eq!(path("linuxcnc"), ["G64 P0.0025 Q0"]);
    assert_eq!(path("haas"), ["G64", "G187 P3 E0.0025"]);
    assert_eq!(path("sinumerik"), ["CYCLE832(0.0025,112001)"]);
    assert_eq!(path("heidenhain"), ["CYCL DEF 32.0 TOLERANCE", "CYCL DEF 32.1 T0.0025"]);
    for name in ["fanuc", "grbl", "mazak", "mitsubishi", "okuma", "centroid", "marlin", "apt-cl"] {
        assert_eq!(path(name), [""; 0], "{name} has no word for it");
    }
    for name in ["haas", "sinumerik", "heidenhain"] {
        let capabilities = builtin(name).capabilities(LengthUnit::Millimetre, None).unwrap();
        assert_eq!(capabilities.path_tolerance.map(|p| p.share), Some(0.25), "{name}");
    }
}

#[test]
fn cycles_are_kept_where_the_control_has_them_and_levels_are_said_with_the_first_hole_only() {
    let drill = |name: &str| {
        let sheet = home(name).drill(CycleKind::Deep, &[(10, 20), (10, 30), (10, 30)]);
        let one = step(name);
        rest(name, &sheet.line(one, one))
    };
    assert_eq!(
        drill("fanuc"),
        ["G99 G83 X10. Y20. Z-10. R2. Q4. F300.", "Y30.", "X10. Y30.", "G80", "G1 X1. Y1. Z0. F300."]
    );
    assert_eq!(
        drill("sinumerik"),
        [
            "F300",
            "MCALL CYCLE83(2,0,2,-10,,,4,0,0.5,0,1,1)",
            "G0 X10 Y20",
            "Y30",
            "X10 Y30",
            "MCALL",
            "G1 X1 Y1 Z0 F300"
        ]
    );
    assert_eq!(drill("okuma")[..2], ["G71 Z2.", "G83 X10. Y20. Z-10. R2. Q4. F300. M53"]);
    assert_eq!(drill("okuma")[4], "G0 Z2.", "G80 would stop the spindle");
    let klartext = drill("heidenhain");
    assert_eq!(klartext[9..12], ["L X+10 Y+20 R0 FMAX M99", "L Y+30 R0 FMAX M99", "L X+10 Y+30 R0 FMAX M99"]);
    for name in ["grbl", "grblhal", "marlin"] {
        assert!(
            builtin(name).capabilities(LengthUnit::Millimetre, None).unwrap().cycles.is_empty(),
            "{name}"
        );
    }
}

#[test]
fn the_return_level_is_that_of_the_cycle() {
    let drill = |name: &str, retract: RetractTo| {
        let mut sheet = home(name).drill(CycleKind::Drill, &[(10, 20)]);
        sheet.program.cycles[0].retract = retract;
        rest(name, &sheet).concat()
    };
    for (name, low, high) in [
        ("fanuc", "G99 G81", "G98 G81"),
        ("linuxcnc", "G99 G81", "G98 G81"),
        ("okuma", "G71 Z2.", "G71 Z50."),
        ("sinumerik", "CYCLE81(2,0,2,-10)", "CYCLE81(50,0,2,-10)"),
        ("heidenhain", "Q204=2 ", "Q204=50 "),
        ("apt-cl", "CLEAR, 2", "RETURN, ON"),
    ] {
        assert!(drill(name, RetractTo::Clearance).contains(low), "{name}");
        assert!(drill(name, RetractTo::Initial).contains(high), "{name}");
    }
}

#[test]
fn klartext_blocks_are_numbered_from_0_one_by_one_and_a_continued_block_once() {
    let text = Sheet::mm("heidenhain")
        .title("Plate")
        .drill(CycleKind::Drill, &[(1, 2)])
        .event(BlockKind::End)
        .text();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "0 BEGIN PGM PLATE MM");
    let mut wanted = 0;
    let mut continued = false;
    for line in &lines {
        if !continued {
            assert!(line.starts_with(&format!("{wanted} ")), "{line}");
            wanted += 1;
        }
        continued = line.ends_with('~');
    }
    assert_eq!(*lines.last().unwrap(), format!("{} END PGM PLATE MM", wanted - 1));
}

#[test]
fn dwells_of_mach_are_in_the_unit_that_is_declared() {
    let with = |unit: &str| {
        let set = [("options.DWELL".to_owned(), unit.to_owned())];
        load_with("mach3", &set, &MemoryFiles::default(), &mut SourceMap::default())
    };
    let sheet = Sheet::new(with("ms").unwrap(), LengthUnit::Millimetre, None).rapid(0, 0, 0, 7);
    assert_eq!(sheet.event(BlockKind::Dwell(1.25)).rest(), ["G4 P1250"]);
    let options = with("MS").unwrap().capabilities(LengthUnit::Millimetre, None).unwrap().options;
    assert_eq!(with("ms").unwrap().control_with(&options), "mach3-ms");
    assert_eq!(with("minutes").unwrap_err()[0].code.id, "E0714");
}

#[test]
fn no_text_leaves_its_comment_on_any_control() {
    let bad = "MSG, a) b( c% d\nG0 X99\r; e\u{0}ü$~\"";
    for name in builtin_names() {
        let comments = builtin(name).spec().comments.clone();
        let text = Sheet::mm(name).title(bad).event(BlockKind::Comment(bad.into())).text();
        for line in text.lines() {
            assert!(line.bytes().all(|b| b.is_ascii_graphic() || b == b' '), "{name}: {line:?}");
            assert!(
                line.trim() == "%" || line.matches('%').count() == line.matches("%_N_").count(),
                "{name}: {line}"
            );
            let inside = line.find(comments.open.trim()).filter(|_| line.contains("G0 X99"));
            if let Some(start) = inside {
                let body = &line[start + comments.open.len()..];
                let body = body.strip_suffix(&comments.close).unwrap_or(body);
                let closes = !comments.close.is_empty() && body.contains(&comments.close);
                assert!(
                    !closes && !body.to_uppercase().starts_with("MSG") || name != "linuxcnc",
                    "{name}: {line}"
                );
            } else {
                assert!(
                    !line.contains("G0 X99") || name == "apt-cl" && line.starts_with("PARTNO/"),
                    "{name}: {line}"
                );
            }
        }
    }
}

#[test]
fn options_cannot_bring_lines_of_their_own() {
    let set = |key: &str| [(key.to_owned(), "\"0\\nM30\"".to_owned())];
    let load = |post, key| load_with(post, &set(key), &MemoryFiles::default(), &mut SourceMap::default());
    assert_eq!(load("sinumerik", "options.RETRACT").unwrap_err()[0].code.id, "E0714");
    // Options without a list of values, too.
    let dialect = load("fanuc", "options.WCS").unwrap();
    assert_eq!(dialect.capabilities(LengthUnit::Millimetre, None).unwrap_err().code.id, "E0713");
}

#[test]
fn every_post_says_how_sure_it_is_and_on_what_it_rests() {
    for name in builtin_names() {
        let dialect = builtin(name);
        assert!(["interpreter", "manual", "published"].contains(&dialect.confidence()), "{name}");
        assert!(dialect.basis().len() > 10, "{name}");
    }
}

#[test]
fn options_have_the_values_that_their_post_lists() {
    let load = |post: &str, set: &[(&str, &str)]| {
        let set: Vec<_> = set.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
        let shown = |errors: Vec<crate::diag::Diagnostic>| {
            errors
                .iter()
                .map(|e| format!("{} {} {}", e.code.id, e.message, e.help.join(" ")))
                .collect::<Vec<_>>()
        };
        let text = "inherits = \"marlin\"\n[options]\nSIDE = \"left\"\n[option-values]\nSIDE = [\"left\", \"right\"]\n\
                    [templates]\noperation = \"; {{ options.SIDE }}\"\n[post.control-when]\n\"SIDE=rigth\" = \"marlin\"\n";
        let files = MemoryFiles([("my.post.toml".to_owned(), text.to_owned())].into());
        crate::post::load_with(post, &set, &files, &mut SourceMap::default()).map_err(shown)
    };
    assert_eq!(
        load("apt-cl", &[("options.FLAVOUR", "nxx")]).unwrap_err(),
        ["E0714 `nxx` is no value of the option `FLAVOUR`: it is `plain` or `nx` did you mean `nx`?"]
    );
    assert_eq!(
        load("apt-cl", &[("options.FLAVOR", "nx")]).unwrap_err(),
        ["E0713 the post `apt-cl` has no option `FLAVOR` did you mean `FLAVOUR`?"]
    );
    assert_eq!(
        load("my.post.toml", &[]).unwrap_err(),
        ["E0704 `rigth` is no value of the option `SIDE`: it is `left` or `right` did you mean `right`?"]
    );
    let errors = load("okuma", &[("options.RETRACT", "1e3")]).unwrap_err();
    assert_eq!(
        errors,
        ["E0714 `1e3` is no value of the option `RETRACT`: it is a number as the word `z` has it "]
    );
    // Capitals do not matter, and numbers are spelled as their word spells them.
    let chosen = |post: &str, name: &str, value: &str| {
        let dialect = load(post, &[(&format!("options.{name}"), value)]).unwrap();
        dialect.capabilities(LengthUnit::Millimetre, None).unwrap().options[name].clone()
    };
    assert_eq!(chosen("apt-cl", "FLAVOUR", "NX"), "nx");
    assert_eq!(chosen("okuma", "RETRACT", "-10"), "-10.");
    assert_eq!(chosen("heidenhain", "RETRACT", "12.5"), "+12.5");
    assert_eq!(chosen("linuxcnc", "RETRACT", ""), "");
}
