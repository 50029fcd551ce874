//! Whole programs that only differ by where they are cut.

use std::collections::BTreeMap;

use super::*;
use crate::source::MemoryFiles;

const CAVITY: &str = "\
UNITS/ MM
N1 = NET/ 4, 4, (0, 0, 0), (0, 10, 0), (0, 20, 0), (0, 30, 0), $
  (12, 0, 0), (12, 10, -7), (12, 20, -6), (12, 30, 0), $
  (24, 0, 0), (24, 10, -5), (24, 20, -8), (24, 30, 0), $
  (36, 0, 0), (36, 10, 0), (36, 20, 0), (36, 30, 0)
T1 = CUTTER/ BALL, 8, NUMBER, 1
LOADTL/ T1
SPINDL/ 8000, CLW
FEDRAT/ 900, MMPM
TOLER/ 0.02
CLEARP/ 20
MOVE
FINISH = SURFAC/ N1, ZIGZAG, U, STEP, 5
FINI
";

/// The positions of the program's blocks, in thousandths; words that are left out stay as they were.
fn positions(placed: &str) -> Vec<[i64; 3]> {
    let files = MemoryFiles(BTreeMap::from([("a.apt".to_owned(), CAVITY.replace("MOVE\n", placed))]));
    let options = Options { posts: vec!["linuxcnc".to_owned()], ..Options::default() };
    let build = build("a.apt", &files, &options);
    let errors: Vec<&str> =
        build.diagnostics.iter().filter(|d| d.code.id.starts_with('E')).map(|d| d.message.as_str()).collect();
    assert!(errors.is_empty(), "{errors:?}");
    let proven = build.outputs[0].proven.as_ref().expect("an NC program");
    let mut at = [i64::MIN; 3];
    let mut out = Vec::new();
    for line in proven.text().lines() {
        let moves = line.starts_with(['G', 'X', 'Y', 'Z']) && !line.contains("G53");
        for word in line.split_whitespace().filter(|_| moves) {
            let axis = word.chars().next().and_then(|c| ['X', 'Y', 'Z'].iter().position(|a| *a == c));
            if let (Some(axis), Ok(x)) = (axis, word[1..].parse::<f64>()) {
                #[allow(clippy::cast_possible_truncation)]
                let thousandths = (x * 1000.0).round() as i64;
                at[axis] = thousandths;
            }
        }
        if at.iter().all(|x| *x != i64::MIN) && out.last() != Some(&at) {
            out.push(at);
        }
    }
    assert!(out.len() > 50, "{} positions", out.len());
    out
}

/// The same positions within one step of the grid: halves are rounded away from zero, wherever that is.
fn near(wanted: impl ExactSizeIterator<Item = [i64; 3]>, found: &[[i64; 3]]) {
    assert_eq!(wanted.len(), found.len());
    for (a, b) in wanted.zip(found) {
        assert!(a.iter().zip(b).all(|(x, y)| (x - y).abs() <= 1), "{a:?} {b:?}");
    }
}

#[test]
fn a_net_that_is_shifted_by_steps_of_the_grid_gives_the_same_numbers_shifted() {
    let (here, there) = (positions(""), positions("TRACUT/ (MATRIX/ TRANSL, 64, -32, 0)\n"));
    near(here.iter().map(|p| [p[0] + 64_000, p[1] - 32_000, p[2]]), &there);
}

#[test]
fn a_net_that_is_turned_by_a_right_angle_gives_the_path_turned() {
    let (here, there) = (positions(""), positions("TRACUT/ (MATRIX/ XYROT, 90)\n"));
    near(here.iter().map(|p| [-p[1], p[0], p[2]]), &there);
}

/// Two planes that meet in a ridge.
const ROOF: &str = "\
UNITS/ MM
N1 = NET/ 4, 7, (0, 0, 0), (0, 3, 2), (0, 6, 4), (0, 9, 6), (0, 12, 4), (0, 15, 2), (0, 18, 0), $
  (5, 0, 0), (5, 3, 2), (5, 6, 4), (5, 9, 6), (5, 12, 4), (5, 15, 2), (5, 18, 0), $
  (10, 0, 0), (10, 3, 2), (10, 6, 4), (10, 9, 6), (10, 12, 4), (10, 15, 2), (10, 18, 0), $
  (15, 0, 0), (15, 3, 2), (15, 6, 4), (15, 9, 6), (15, 12, 4), (15, 15, 2), (15, 18, 0)
T1 = CUTTER/ BALL, 8, NUMBER, 1
LOADTL/ T1
SPINDL/ 8000, CLW
FEDRAT/ 900, MMPM
TOLER/ 0.004
CLEARP/ 20
FINISH = SURFAC/ N1, ZIGZAG, WAY, CUSP, 0.04
FINI
";

fn roof(way: &str) -> Build {
    let files = MemoryFiles(BTreeMap::from([("a.apt".to_owned(), ROOF.replace("WAY", way))]));
    build("a.apt", &files, &Options { posts: vec!["linuxcnc".to_owned()], ..Options::default() })
}

#[test]
fn every_way_of_passes_goes_over_a_ridge() {
    for way in ["U", "V", "X", "Y", "ISOCSP", "CONST"] {
        let build = roof(way);
        assert!(!build.has_errors(), "{way}: {:?}", build.diagnostics);
        assert!(build.outputs[0].proven.is_some(), "{way}");
    }
}

#[test]
fn passes_lie_closer_only_where_that_is_asked_for() {
    let ir = roof("U").ir.expect("a program");
    let passes = |asked: &[(usize, Place)], everywhere: bool| {
        let (mut closer, mut sink) = (Closer::default(), Sink::default());
        closer.add(asked, everywhere);
        let cl = plan::plan_closer(&ir, &closer, &mut sink).expect("CL data");
        cl.records.iter().filter(|r| matches!(r.kind, crate::cl::RecordKind::Pass(_))).count()
    };
    let place = Place { at: crate::geom::Point3::new(7.0, 3.0, 2.0), reach: 2.0, share: 0.25 };
    let (before, near, all) = (passes(&[], false), passes(&[(0, place)], false), passes(&[(0, place)], true));
    assert!(before < near && near < all && all < 3 * before, "{before} {near} {all}");
    assert_eq!(before, passes(&[(1, place)], true));
}

const THROUGH: &str = "T1 = CUTTER/ FLAT, 6, NUMBER, 1\nT2 = CUTTER/ FLAT, 8, NUMBER, 2\nLOADTL/ T1\nSPINDL/ 900, CLW\n\
    FEDRAT/ 300\nCOOLNT/ THRU\nRAPID\nGOTO/ 0, 0, 5\nGOTO/ 10, 0, 5\nCOOLNT/ FLOOD\nGOTO/ 20, 0, 5\nCOOLNT/ THRU\n\
    LOADTL/ T2\nSPINDL/ 900, CLW\nRAPID\nGOTO/ 0, 0, 5\nGOTO/ 10, 0, 5\nFINI\n";
const OWN: &str = "inherits = \"fanuc\"\n[post]\ncontrol = \"fanuc M51=through M59=through-off\"\n\
    [coolant]\nthrough = \"M51\"\nthrough-off = \"M59\"\n";

/// The program's words among some, or the codes of its messages.
fn said(name: &str, source: &str, post: &str, among: &[&str]) -> Result<String, Vec<&'static str>> {
    let files = [
        (name, source),
        ("own.post.toml", OWN),
        ("lie.post.toml", &OWN.replace("through = \"M51\"", "through = \"M59\"")),
        ("silent.post.toml", "inherits = \"haas\"\n[stops]\nrestart = false\n"),
    ];
    let files = MemoryFiles(files.map(|(name, text)| (name.to_owned(), text.to_owned())).into());
    let options = Options { posts: vec![post.to_owned()], ..Options::default() };
    let build = build(name, &files, &options);
    let Some(proven) = build.outputs.first().and_then(|o| o.proven.as_ref()) else {
        return Err(build.diagnostics.iter().map(|d| d.code.id).collect());
    };
    let words = proven.text().split_whitespace().filter(|w| among.contains(w));
    Ok(words.collect::<Vec<_>>().join(" "))
}

/// The program's M codes of coolant, or the codes of its messages.
fn coolant(name: &str, source: &str, post: &str) -> Result<String, Vec<&'static str>> {
    said(name, source, post, &["M7", "M8", "M9", "M88", "M89", "M51", "M59"])
}

#[test]
fn what_a_stop_may_have_stopped_is_said_again_before_the_next_move() {
    const STOPS: &str = "T1 = CUTTER/ FLAT, 6, NUMBER, 1\nLOADTL/ T1\nSPINDL/ 900, CLW\nFEDRAT/ 300\n\
        COOLNT/ FLOOD\nRAPID\nGOTO/ 0, 0, 5\nGOTO/ 10, 0, 5\nSTOP\nGOTO/ 20, 0, 5\nOPSTOP\nCOOLNT/ OFF\n\
        GOTO/ 30, 0, 5\nSTOP\nSPINDL/ 800, CLW\nCOOLNT/ FLOOD\nGOTO/ 40, 0, 5\nSTOP\nFINI\n";
    let codes = |post| said("a.apt", STOPS, post, &["M0", "M1", "M3", "M8", "M9"]);
    for post in ["fanuc", "haas", "linuxcnc", "heidenhain"] {
        let text = codes(post).unwrap_or_else(|codes| panic!("{post}: {codes:?}"));
        assert!(text.starts_with("M3 M8 M0 M3 M8 M1 M9 M3 M0 M3 M8 M0"), "{post}: {text}");
    }
    assert!(codes("silent.post.toml").is_err_and(|codes| codes.iter().all(|c| *c == "E0807")));
}

#[test]
fn coolant_through_the_tool_has_words_of_its_own_and_is_not_replaced() {
    let through = |post| coolant("a.apt", THROUGH, post);
    assert_eq!(through("haas").as_deref(), Ok("M88 M89 M8 M9 M88 M89 M88 M89"));
    assert_eq!(through("own.post.toml").as_deref(), Ok("M51 M59 M8 M9 M51 M59 M51 M59"));
    assert_eq!(through("fanuc"), Err(vec!["E0609"; 2]));
    assert!(through("lie.post.toml").is_err_and(|codes| codes.iter().all(|c| c.starts_with("E08"))));
}

/// Takes the texts of some outputs.
struct Takes(Mutex<BTreeMap<usize, String>>, usize);

impl Shelf for Takes {
    fn put(&self, index: usize, _: &Output, text: &str) -> bool {
        if index != self.1 {
            self.0.lock().expect("no panic").insert(index, text.to_owned());
        }
        index != self.1
    }
}

#[test]
fn texts_of_programs_go_to_the_shelf_as_they_are_proven() {
    let files = MemoryFiles(BTreeMap::from([("a.apt".to_owned(), THROUGH.replace("THRU", "MIST"))]));
    let posts = ["fanuc", "haas", "linuxcnc"].map(str::to_owned).to_vec();
    let options = Options { posts, ..Options::default() };
    let shelf = Takes(Mutex::default(), 1);
    let staged = build_to("a.apt", &files, &options, &shelf);
    let kept = build("a.apt", &files, &options);
    let taken = shelf.0.into_inner().expect("no panic");
    for (index, (staged, kept)) in staged.outputs.iter().zip(&kept.outputs).enumerate() {
        let text = |output: &Output| output.proven.as_ref().expect("proven").text().to_owned();
        let found = if index == 1 { text(staged) } else { taken[&index].clone() };
        assert!(!found.is_empty() && found == text(kept));
        assert!(index == 1 || text(staged).is_empty());
    }
}

#[test]
fn a_post_may_end_its_lines_and_count_its_pecks() {
    let post = "inherits = \"fanuc\"\n[post]\ncontrol = \"fanuc line-end=* cycle-pecks=J\"\n[line]\nend = \"*\"\n\
        [cycles.deep]\nwords = \"Z{{ cycle.z }} R{{ cycle.r }} J{{ cycle.pecks }} F{{ cycle.feed }}\"\n";
    let source = "PARTNO A * B\nLOADTL/1\nSPINDL/900,CLW\nFEDRAT/100,MMPM\nRAPID\nGOTO/0,0,20\n\
        CYCLE/DEEP,FEDTO,10,STEP,2.5,RAPTO,1,MMPM,80\nGOTO/5,0,0\nGOTO/9,0,0\nCYCLE/OFF\nFINI\n";
    let files = [("a.cls".to_owned(), source.to_owned()), ("m.post.toml".to_owned(), post.to_owned())];
    let options = Options { posts: vec!["m.post.toml".to_owned()], ..Options::default() };
    let build = build("a.cls", &MemoryFiles(files.into()), &options);
    let proven = build.outputs.first().and_then(|o| o.proven.as_ref());
    let text = proven.unwrap_or_else(|| panic!("{:?}", build.diagnostics)).text();
    assert!(text.lines().all(|line| line == "%" || line.ends_with('*')), "{text}");
    // Eleven millimetres in pecks of 2.5 at most.
    assert!(text.contains("Z-10. R1. J5 F80.*"), "{text}");
}

/// Each message with the notes about it.
fn told(post_set: &[(&str, &str)], posts: &[&str]) -> Vec<(String, Vec<String>)> {
    let files = MemoryFiles(BTreeMap::from([("a.apt".to_owned(), THROUGH.replace("THRU", "FLOOD"))]));
    let posts = posts.iter().map(|p| (*p).to_owned()).collect();
    let post_set = post_set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let build = build("a.apt", &files, &Options { posts, post_set, ..Options::default() });
    build.diagnostics.into_iter().map(|d| (d.message, d.notes)).collect()
}

#[test]
fn a_mistake_in_an_override_is_told_once_for_all_posts() {
    let posts = ["fanuc", "haas", "linuxcnc"];
    let key = "[words.x] has no key `nope`".to_owned();
    assert_eq!(told(&[("words.x.nope", "1")], &posts), [(key.clone(), Vec::new())]);
    // What others say of it in other words are notes, each once.
    let option = |post: &str, name: &str| format!("the post `{post}` has no option `{name}`");
    let of_all = |name: &str| (option("fanuc", name), vec![option("haas", name), option("linuxcnc", name)]);
    let one = ("options.NOPE", "1");
    assert_eq!(told(&[one], &posts), [of_all("NOPE")]);
    assert_eq!(told(&[one], &["fanuc"]), [(option("fanuc", "NOPE"), Vec::new())]);
    // Two mistakes stay two, also where they stand in the same columns.
    let two = told(&[one, ("options.NOPF", "1")], &posts);
    assert_eq!(two, [of_all("NOPE"), of_all("NOPF")]);
    // What is wrong in the program is told for every post.
    let coolant = told(&[("coolant.flood", "")], &posts);
    assert!(coolant.len() >= posts.len(), "{coolant:?}");
}
