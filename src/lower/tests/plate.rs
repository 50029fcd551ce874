//! The plate cam on three controls.

use std::sync::Arc;

use super::cl::{Draft, contour, plate};
use super::{INCH, dialect, lowered, made, made_with};
use crate::cl::{Contour, Lead, RecordKind};
use crate::geom::curve::CircularArc;
use crate::geom::{Point2, Side};
use crate::ir::{Band, Coolant, Feed, Interpolation, Rotary};

fn draft(interpolation: Interpolation) -> Draft {
    Draft::new().contour(plate(interpolation, Lead::Arc(8.0)))
}

fn blocks(interpolation: Interpolation, post: &str) -> u32 {
    let rotary = (interpolation == Interpolation::RTheta).then_some('C');
    made(&draft(interpolation).cl, post, rotary).certificate.operations[0].blocks
}

#[test]
fn lines_arcs_and_spirals_meet_the_published_bounds() {
    assert!(blocks(Interpolation::Linear, "fanuc") <= 100);
    assert!(blocks(Interpolation::Linear, "linuxcnc") <= 98);
    assert!(blocks(Interpolation::Circular, "grbl") <= 15);
    assert!(blocks(Interpolation::RTheta, "linuxcnc") <= 42);
    assert!(blocks(Interpolation::RTheta, "fanuc") <= 42);
}

#[test]
fn every_built_in_post_proves_the_cam_in_both_units() {
    for post in crate::post::builtin_names() {
        for inch in [false, true] {
            let mut draft = draft(Interpolation::Circular).add(RecordKind::Dwell(0.5));
            if inch {
                draft.cl.units = INCH;
            }
            let made = made(&draft.cl, post, None);
            // Marlin goes by an arc's angle, then straight to its end: two moves a block.
            let most = if post == "marlin" { 30 } else { 15 };
            assert!(made.certificate.operations[0].blocks <= most, "{post}");
        }
    }
}

#[test]
fn every_level_uses_the_same_fit() {
    let mut contour = plate(Interpolation::Circular, Lead::Arc(8.0));
    contour.levels = vec![-2.0, -4.0, -5.0];
    let made = made(&Draft::new().contour(contour).cl, "grbl", None);
    let counts: Vec<u32> = made.target.pieces.iter().map(|p| p.blocks).collect();
    assert_eq!(counts.len(), 3);
    assert!(counts.iter().all(|c| *c == counts[0]));
}

#[test]
fn every_kind_of_lead_is_proven_on_every_control() {
    for lead in [Lead::Arc(8.0), Lead::Line(4.0), Lead::Plunge] {
        for (post, rotary) in [("linuxcnc", None), ("fanuc", None), ("grbl", None), ("linuxcnc", Some('C'))] {
            let kind = if rotary.is_some() { Interpolation::RTheta } else { Interpolation::Circular };
            let mut contour: Contour = plate(kind, lead);
            contour.plunge_feed = Some(120.0);
            let made = made(&Draft::new().contour(contour).cl, post, rotary);
            assert_eq!(made.notes.contains(&"N0605"), rotary.is_some() && lead != Lead::Plunge);
        }
    }
}

#[test]
fn inch_programs_are_proven_too() {
    for post in ["linuxcnc", "fanuc", "grbl"] {
        for kind in [Interpolation::Linear, Interpolation::Circular] {
            let mut draft = draft(kind);
            draft.cl.units = INCH;
            let made = made(&draft.cl, post, None);
            assert!(made.text.contains("G20"), "{}", made.text);
        }
    }
}

#[test]
fn a_reversed_table_turns_the_other_way() {
    let rotary = |reversed| Some(Rotary { letter: Some('C'), reversed });
    let draft = draft(Interpolation::RTheta);
    let plus = made_with(&draft.cl, &dialect("linuxcnc", None), rotary(false)).text;
    let minus = made_with(&draft.cl, &dialect("linuxcnc", None), rotary(true)).text;
    assert!(plus.contains(" C3") && minus.contains(" C-3"));
}

#[test]
fn cartesian_and_polar_operations_follow_each_other() {
    let polar = || plate(Interpolation::RTheta, Lead::Arc(8.0));
    let plain = || plate(Interpolation::Circular, Lead::Arc(8.0));
    let mut draft = Draft::new().contour(plain()).contour(polar()).contour(polar()).contour(plain());
    draft = draft.rapid(0.0, 60.0, 5.0);
    for post in ["linuxcnc", "fanuc"] {
        let made = made(&draft.cl, post, Some('C'));
        assert_eq!(made.target.pieces.len(), 4);
    }
}

#[test]
fn r_theta_without_a_rotary_axis_becomes_arcs_with_a_note() {
    let made = made(&draft(Interpolation::RTheta).cl, "grbl", None);
    assert_eq!(made.notes, ["N0602"]);
    assert_eq!(made.target.pieces[0].interpolation, Interpolation::Circular);
}

#[test]
fn a_control_without_arcs_gets_lines_with_a_note() {
    let text = "inherits = \"grbl\"\n[arcs]\nenabled = false\n";
    let made = made_with(&draft(Interpolation::Circular).cl, &dialect("plain.post.toml", Some(text)), None);
    assert!(made.notes.contains(&"N0601"), "{:?}", made.notes);
    assert!(!made.text.contains("G2") || made.text.contains("G21"));
    assert_eq!(made.certificate.moves.arcs, 0);
}

#[test]
fn full_circles_are_whole_or_split_as_the_control_wants() {
    let circle = |text: Option<&str>, name: &str| {
        let curve = CircularArc::circle(Point2::new(0.0, 0.0), 28.0, 0.3, true).unwrap();
        let contour = contour(Arc::new(curve), Side::Left, Interpolation::Circular, Lead::Plunge);
        made_with(&Draft::new().contour(contour).cl, &dialect(name, text), None).certificate.moves.arcs
    };
    for name in ["linuxcnc", "fanuc", "grbl"] {
        assert_eq!(circle(None, name), 1, "{name}");
    }
    let quarters = "inherits = \"fanuc\"\n[arcs]\nfull-circle = \"split\"\nmax-sweep = 90\n";
    assert_eq!(circle(Some(quarters), "quarters.post.toml"), 4);
    let halves = "inherits = \"grbl\"\n[arcs]\nfull-circle = \"split\"\n";
    assert_eq!(circle(Some(halves), "halves.post.toml"), 2);
}

#[test]
fn arcs_are_split_at_the_largest_sweep() {
    let text = "inherits = \"grbl\"\n[arcs]\nmax-sweep = 20\n";
    let made = made_with(&draft(Interpolation::Circular).cl, &dialect("short.post.toml", Some(text)), None);
    assert!(made.certificate.moves.arcs > 18);
}

#[test]
fn nurbs_are_proven_where_the_control_has_them() {
    for post in ["linuxcnc", "fanuc"] {
        let made = made(&draft(Interpolation::Nurbs).cl, post, None);
        assert_eq!(made.target.pieces[0].interpolation, Interpolation::Nurbs);
        assert!(made.certificate.moves.nurbs > 0);
        assert!(made.notes.is_empty(), "{:?}", made.notes);
    }
    assert_eq!(made(&draft(Interpolation::Nurbs).cl, "grbl", None).notes, ["N0603"]);
}

#[test]
fn auto_takes_the_fewest_blocks() {
    let auto =
        |post: &str, rotary| made(&draft(Interpolation::Auto).cl, post, rotary).target.pieces[0].clone();
    assert_eq!(auto("grbl", None).interpolation, Interpolation::Circular);
    assert_eq!(auto("linuxcnc", Some('C')).interpolation, Interpolation::Circular);
}

#[test]
fn the_controls_share_is_kept_inside_the_band() {
    let text = "inherits = \"linuxcnc\"\n[path-control]\nshare = 0.25\n";
    let made = made_with(&draft(Interpolation::Linear).cl, &dialect("share.post.toml", Some(text)), None);
    assert!(made.text.contains("G64 P0.0025"), "{}", made.text);
    let piece = &made.target.pieces[0];
    assert_eq!(piece.reserved, 0.0025);
    let proof = &made.certificate.operations[0];
    assert!(proof.into.as_ref().is_none_or(|d| d.value.abs() <= 0.0075 + 1e-6));
    let mut contour = plate(Interpolation::Linear, Lead::Plunge);
    contour.band = Band { into: 0.0, out: 0.01 };
    let one_sided =
        made_with(&Draft::new().contour(contour).cl, &dialect("share.post.toml", Some(text)), None);
    assert!(one_sided.notes.contains(&"N0606"));
    assert!(!one_sided.text.contains("G64"));
}

#[test]
fn feeds_per_revolution_become_feeds_per_minute_where_they_must() {
    let mut draft = draft(Interpolation::Linear);
    for record in &mut draft.cl.records {
        if let RecordKind::Feed(feed) = &mut record.kind {
            *feed = Feed::PerRevolution(0.25);
        }
    }
    let fanuc = made(&draft.cl, "fanuc", None);
    assert!(fanuc.text.contains("G95 ") && fanuc.text.contains("F0.25"), "{}", fanuc.text);
    let grbl = made(&draft.cl, "grbl", None);
    assert!(grbl.text.contains("F300") && !grbl.text.contains("G95"));
    assert_eq!(grbl.notes, ["N0604"]);
}

#[test]
fn coolant_and_optional_stops_are_replaced_with_notes() {
    let draft = Draft::new().add(RecordKind::Coolant(Coolant::Mist)).add(RecordKind::OptionalStop);
    let (target, messages) = lowered(&draft.cl, &dialect("grbl", None), None);
    let codes: Vec<&str> = messages.iter().map(|m| m.code.id).collect();
    assert_eq!(codes, ["N0607", "N0608"]);
    assert!(target.is_some());
    for (needed, code) in [(false, "N0607"), (true, "E0609")] {
        let draft = Draft::new().add(RecordKind::Coolant(Coolant::Through { needed }));
        let (target, messages) = lowered(&draft.cl, &dialect("fanuc", None), None);
        assert_eq!(messages.iter().map(|m| m.code.id).collect::<Vec<_>>(), [code]);
        assert_eq!(target.is_some(), !needed);
    }
}

#[test]
fn travel_word_ranges_and_spindle_are_checked() {
    let text = "inherits = \"grbl\"\n[limits]\nx = [-40, 40]\nspindle = [100, 1000]\n";
    let small = dialect("small.post.toml", Some(text));
    let (target, messages) = lowered(&draft(Interpolation::Linear).cl, &small, None);
    let mut codes: Vec<&str> = messages.iter().map(|m| m.code.id).collect();
    codes.dedup();
    assert_eq!(codes, ["E0607", "E0603"]);
    assert!(target.is_none());
    let far = Draft::new().rapid(1e6, 0.0, 0.0);
    let (_, messages) = lowered(&far.cl, &dialect("grbl", None), None);
    assert_eq!(messages.iter().map(|m| m.code.id).collect::<Vec<_>>(), ["E0604"]);
}

#[test]
fn feeds_that_round_to_nothing_are_refused() {
    let mut draft = draft(Interpolation::Linear);
    for record in &mut draft.cl.records {
        if let RecordKind::Feed(feed) = &mut record.kind {
            *feed = Feed::PerMinute(0.01);
        }
    }
    let (target, messages) = lowered(&draft.cl, &dialect("fanuc", None), None);
    assert!(target.is_none());
    assert_eq!(messages.iter().map(|m| m.code.id).collect::<Vec<_>>(), ["E0605"]);
}

#[test]
fn a_feed_per_revolution_needs_a_spindle() {
    let draft = Draft::new()
        .add(RecordKind::Spindle(crate::ir::Spindle::Off))
        .add(RecordKind::Feed(Feed::PerRevolution(0.1)))
        .rapid(0.0, 0.0, 5.0)
        .linear(0.0, 0.0, 1.0);
    let (_, messages) = lowered(&draft.cl, &dialect("fanuc", None), None);
    assert_eq!(messages.iter().map(|m| m.code.id).collect::<Vec<_>>(), ["E0606"]);
}

#[test]
fn a_band_narrower_than_the_grid_is_refused_with_its_numbers() {
    let mut contour = plate(Interpolation::Linear, Lead::Plunge);
    contour.band = Band { into: 0.0, out: 0.0001 };
    let (target, messages) = lowered(&Draft::new().contour(contour).cl, &dialect("fanuc", None), None);
    assert!(target.is_none());
    assert_eq!(messages[0].code.id, "E0602");
    assert!(messages[0].notes[0].contains("3 decimals"), "{:?}", messages[0]);
}

#[test]
fn rapids_go_up_first_and_down_last() {
    let draft =
        Draft::new().rapid(10.0, 0.0, 5.0).linear(10.0, 0.0, -1.0).rapid(0.0, 20.0, 5.0).rapid(1.0, 1.0, 2.0);
    let made = made(&draft.cl, "grbl", None);
    let moves: Vec<&str> = made.text.lines().skip_while(|l| !l.starts_with("G0 Z")).collect();
    assert_eq!(moves[..8], ["G0 Z5", "X10 Y0", "G1 Z-1 F300", "G0 Z5", "X0 Y20", "X1 Y1", "Z2", "M5"]);
}
