use super::base64;
use crate::driver::{self, Options};
use crate::plot::{PlotError, What, page};
use crate::source::MemoryFiles;

fn build(program: &str) -> driver::Build {
    let files = MemoryFiles([("a.apt".to_owned(), program.to_owned())].into());
    let options = Options { posts: vec!["linuxcnc".to_owned()], ..Options::default() };
    let build = driver::build("a.apt", &files, &options);
    assert!(!build.has_errors(), "{:#?}", build.diagnostics);
    build
}

fn page_of(what: &What, program: &str) -> Result<String, PlotError> {
    let build = build(program);
    page(what, &build, build.outputs.first())
}

const MOVES: &str = "T1 = CUTTER/ FLAT, 16, NUMBER, 1\nLOADTL/ T1\nSPINDL/ 1200, CLW\nFEDRAT/ 300\nRAPID\nGOTO/ 0, 0, 5\nGOTO/ 10, 0, 5\nFINI\n";

pub(crate) const SURFACE: &str = "UNITS/ MM\nN1 = NET/ 4, 4, (0, 0, 0), (0, 4, 0), (0, 8, 0), (0, 12, 0), $\n\
    (4, 0, 0), (4, 4, -3), (4, 8, -2), (4, 12, 0), (8, 0, 0), (8, 4, -2), (8, 8, -3), (8, 12, 0), $\n\
    (12, 0, 0), (12, 4, 0), (12, 8, 0), (12, 12, 0)\n\
    T1 = CUTTER/ BALL, 6, NUMBER, 1\nLOADTL/ T1\nSPINDL/ 8000\nFEDRAT/ 800\nINTOL/ 0\nOUTTOL/ 0.01\nCLEARP/ 10\n\
    S1 = SURFAC/ N1, ZIGZAG, U, CUSP, 0.02\nFINI\n";

fn json(page: &str, id: &str) -> serde_json::Value {
    let text = page.split(&format!("id=\"{id}\">")).nth(1).and_then(|r| r.split("</script>").next());
    serde_json::from_str(text.expect("data")).expect("JSON")
}

fn bytes(text: &serde_json::Value) -> Vec<u8> {
    let digit = |c: u8| match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        _ => 63,
    };
    let text = text.as_str().expect("a text").trim_end_matches('=').as_bytes();
    let bits: Vec<u8> = text.iter().flat_map(|c| (0..6).rev().map(move |k| digit(*c) >> k & 1)).collect();
    bits.chunks_exact(8).map(|b| b.iter().fold(0, |byte, bit| byte << 1 | bit)).collect()
}

fn floats(text: &serde_json::Value) -> Vec<f32> {
    bytes(text).chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
}

#[test]
fn base64_is_that_of_the_rfc() {
    let of = |text: &str| base64(text.bytes());
    let cases = ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(of);
    assert_eq!(cases, ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"]);
}

#[test]
fn the_page_has_the_moves_of_the_text_and_nothing_from_elsewhere() {
    let page = page_of(&What::Path, MOVES).expect("a page");
    let data = json(&page, "data");
    let points = floats(&data["points"]);
    assert_eq!(points[points.len() - 3..], [10.0, 0.0, 5.0]);
    let last = bytes(&data["line"]);
    let last = u32::from_le_bytes([
        last[last.len() - 4],
        last[last.len() - 3],
        last[last.len() - 2],
        last[last.len() - 1],
    ]);
    let text = json(&page, "text");
    assert_eq!(text.as_str().and_then(|t| t.lines().nth(last as usize - 1)), Some("G1 X10 F300"));
    let own = page.replace(include_str!("three.min.js"), "");
    assert!(!own.contains("http:") && !own.contains("https:") && !own.contains("src="));
    assert!(own.contains("default-src 'none'") && !own.contains("<!--"));
    assert!(page.contains("Permission is hereby granted"), "the notice of three.js");
    assert!(include_str!("three.min.js").len() < 800_000);
}

#[test]
fn no_text_of_the_program_becomes_markup() {
    let program = format!(
        "PARTNO </script><script>alert(1)</script> <!--DATA--> & \"x\"\nPPRINT <img src=x onerror=alert(2)>\n{MOVES}"
    );
    let page = page_of(&What::Path, &program).expect("a page");
    let own = page.replace(include_str!("three.min.js"), "");
    assert_eq!(own.matches("<script").count(), 4, "the page's own");
    assert_eq!(page.matches("</script").count(), 4, "the page's own");
    assert!(!own.contains("<img") && !own.contains("<!--"));
    assert!(own.contains("&lt;/script&gt;&lt;script&gt;alert(1)"));
    assert!(json(&page, "data")["title"].as_str().expect("a title").contains("</script>"));
}

#[test]
fn a_measured_surface_is_within_what_its_proof_says() {
    let build = build(SURFACE);
    let page = page(&What::Deviation, &build, build.outputs.first()).expect("a page");
    let data = json(&page, "data");
    let surface = &data["surfaces"][0];
    let left = floats(&surface["patches"][0]["left"]);
    let proven = build.outputs[0].proven.as_ref().expect("a proof").certificate();
    let proof = proven.operations[0].surface.as_ref().expect("a surface");
    let (least, most) = left.iter().fold((f32::MAX, f32::MIN), |(a, b), v| (a.min(*v), b.max(*v)));
    let (least, most) = (f64::from(least), f64::from(most));
    assert!(least >= -proof.into.value - 2e-6, "{least}");
    assert!(most <= proof.left_bound + 1e-6 && most > 0.8 * proof.left.value, "{most} {proof:?}");
    assert_eq!(surface["marks"][0]["line"], proof.cusp.expect("cusps").line);
    assert_eq!(surface["range"][1], 0.03);
    let rows = surface["patches"][0]["rows"].as_u64().expect("rows") as usize;
    assert_eq!(left.len() % rows, 0);
    assert!(left.len() <= 70_000, "{}", left.len());
}

#[test]
fn what_no_page_shows_is_said() {
    assert_eq!(page_of(&What::Deviation, MOVES), Err(PlotError::NoSurface));
    assert_eq!(page_of(&What::Cam(None), MOVES), Err(PlotError::FlatOnly));
    let empty = driver::Build::default();
    assert_eq!(page(&What::Path, &empty, None), Err(PlotError::NoPath));
}
