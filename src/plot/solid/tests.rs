use crate::driver::{self, Options};
use crate::plot::page::tests::SURFACE;
use crate::plot::{Figure, PlotError, What, draw_output};
use crate::source::MemoryFiles;

fn build(name: &str, program: &str) -> driver::Build {
    let files = MemoryFiles([(name.to_owned(), program.to_owned())].into());
    let options = Options { posts: vec!["linuxcnc".to_owned()], ..Options::default() };
    let build = driver::build(name, &files, &options);
    assert!(!build.has_errors(), "{:#?}", build.diagnostics);
    build
}

fn figure(what: &What, build: &driver::Build) -> Result<Figure, PlotError> {
    draw_output(what, build, build.outputs.first())
}

fn parses(figure: &Figure) {
    let options = resvg::usvg::Options::default();
    resvg::usvg::Tree::from_str(figure.svg(), &options).expect("an SVG document");
    assert!(!figure.svg().contains("NaN") && !figure.svg().contains("inf"), "{}", figure.svg());
}

#[test]
fn a_surface_has_a_path_and_a_map_of_what_is_left() {
    let build = build("a.apt", SURFACE);
    for what in [What::Path, What::Deviation] {
        let drawn = figure(&what, &build).expect("a figure");
        parses(&drawn);
        assert_eq!(drawn, figure(&what, &build).expect("a figure"));
    }
    let path = figure(&What::Path, &build).expect("a figure");
    for text in ["from above", "links between passes", "T1 ball-end Ø6"] {
        assert!(path.svg().contains(text), "{text}");
    }
}

#[test]
fn the_map_names_the_extremes_of_the_proof() {
    let build = build("a.apt", SURFACE);
    let svg = figure(&What::Deviation, &build).expect("a figure").svg().to_owned();
    let proven = build.outputs[0].proven.as_ref().expect("a proof");
    let proof = proven.certificate().operations[0].surface.clone().expect("a surface");
    let cusp = proof.cusp.expect("cusps");
    assert!(svg.contains(&format!("highest cusp {:.2} µm", 1000.0 * cusp.value)), "{proof:?}");
    let text = proven.text().lines().nth(cusp.line as usize - 1).expect("a line");
    assert!(svg.contains(&format!("line {}: {text}", cusp.line)));
    assert!(!svg.contains("deeper:") && !svg.contains("not cut:"), "all of it is cut, and nothing gouged");
}

/// What the picture says of the share of the area with more left than the scale shows.
fn more_left(program: &str) -> f64 {
    let svg = figure(&What::Deviation, &build("a.apt", program)).expect("a figure").svg().to_owned();
    let text = svg.split("more left: ").nth(1).and_then(|r| r.split(' ').next());
    text.map_or(0.0, |t| t.parse().expect("a number"))
}

#[test]
fn what_the_cutter_cannot_reach_shows_as_more_left() {
    assert!(more_left(SURFACE) < 0.01);
    assert!(more_left(&SURFACE.replace("BALL, 6", "BALL, 40")) > 5.0);
}

#[test]
fn a_program_of_points_in_space_is_drawn_from_two_sides_and_a_flat_one_as_before() {
    let points = |z: &str| {
        format!(
            "T1 = CUTTER/ FLAT, 16, NUMBER, 1\nLOADTL/ T1\nSPINDL/ 1200, CLW\nFEDRAT/ 300\nRAPID\nGOTO/ 0, 0, 5\n\
             GOTO/ 10, 0, {z}\nGOTO/ 10, 10, 5\nFINI\n"
        )
    };
    let drawn = |z: &str| figure(&What::Path, &build("a.apt", &points(z))).expect("a figure");
    assert!(drawn("4").svg().contains("from the front left"));
    assert!(!drawn("5").svg().contains("from the front left"));
    parses(&drawn("4"));
}

#[test]
fn a_cl_file_has_a_picture() {
    let text = "PARTNO A\nUNITS/MM\nLOADTL/1\nSPINDL/1000,RPM,CLW\nFEDRAT/200,MMPM\nRAPID\nGOTO/0,0,5\nGOTO/10,0,5\nFINI\n";
    let build = build("a.cls", text);
    parses(&figure(&What::Path, &build).expect("a figure"));
    assert_eq!(figure(&What::Deviation, &build), Err(PlotError::NoSurface));
}
