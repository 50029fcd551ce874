//! CAD files in small.

use std::sync::Arc;

use proptest::prelude::*;

use super::*;
use crate::geom::Point3;

fn step(data: &str) -> Result<Document, Trouble> {
    let text: Arc<str> =
        format!("ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n{data}ENDSEC;\nEND-ISO-10303-21;\n").into();
    Document::open(Format::Step, &text)
}

const INCH: &str = "\
#1=(CONVERSION_BASED_UNIT('INCH',#2)LENGTH_UNIT()NAMED_UNIT(#4));
#2=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(2.54),#3);
#3=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.CENTI.,.METRE.));
#4=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);
#5=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));
#6=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#5,#1))REPRESENTATION_CONTEXT('',''));
";
const METRE: &str = "\
#101=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.));
#106=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#101))REPRESENTATION_CONTEXT('',''));
";
const POINTS: &str = "\
#11=CARTESIAN_POINT('',(0.,0.,0.));
#12=CARTESIAN_POINT('',(0.,4.,.3));
#13=CARTESIAN_POINT('',(6.,0.,2.E-1));
#14=CARTESIAN_POINT('',(6.,4.,0.));
";
const PATCH: &str = "#20=BEZIER_SURFACE('',1,1,((#11,#12),(#13,#14)),.UNSPECIFIED.,.F.,.F.,.F.);\n";

fn corner(import: &Import) -> Point3 {
    let [m, n] = import.net.size().map(crate::math::count);
    import.net.jet(m, n).p
}

#[test]
fn lengths_are_in_the_units_of_the_context() {
    let import = step(&[INCH, POINTS, PATCH].concat()).and_then(|d| d.net(None)).expect("a net");
    assert_eq!((import.notices, import.face), (vec![], 1));
    assert!(
        (corner(&step(&[INCH, POINTS, PATCH].concat()).and_then(|d| d.net(Some(1))).expect("a net"))
            - Point3::new(152.4, 101.6, 0.0))
        .norm()
            < 1e-12
    );
    let import = step(&[POINTS, PATCH].concat()).and_then(|d| d.net(None)).expect("a net");
    assert_eq!((corner(&import), import.notices), (Point3::new(6.0, 4.0, 0.0), vec![Notice::NoUnit]));
}

#[test]
fn of_two_units_that_of_the_representation_counts() {
    let holders = "#40=SHAPE_REPRESENTATION('',(#41),#106);\n#41=SHELL('#20',#20);\n\
                   #42=SHAPE_REPRESENTATION('#20',(#11),#6);\n";
    let text = [INCH, METRE, POINTS, PATCH, holders].concat();
    let import = step(&text).and_then(|d| d.net(None)).expect("a net");
    assert!((corner(&import) - Point3::new(6000.0, 4000.0, 0.0)).norm() < 1e-9);
}

#[test]
fn units_that_go_round_in_circles_are_refused() {
    let circle = "#1=(CONVERSION_BASED_UNIT('A',#2)LENGTH_UNIT()NAMED_UNIT(*));\n\
                  #2=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(2.),#1);\n\
                  #6=(GLOBAL_UNIT_ASSIGNED_CONTEXT((#1))REPRESENTATION_CONTEXT('',''));\n";
    let trouble = step(&[circle, POINTS, PATCH].concat()).and_then(|d| d.net(None)).expect_err("no unit");
    assert_eq!(trouble.kind, TroubleKind::File);
}

#[test]
fn all_spellings_of_a_surface_are_the_same() {
    let grid: String = (0..5)
        .flat_map(|i| (0..4).map(move |j| (i, j)))
        .map(|(i, j)| format!("#{i}{j}9=CARTESIAN_POINT('',({}.,{}.,{}.));\n", 3 * i, 2 * j, (i * j) % 3))
        .collect();
    let row = |i: usize| format!("(#{i}09,#{i}19,#{i}29,#{i}39)");
    let poles = format!("({},{},{},{},{})", row(0), row(1), row(2), row(3), row(4));
    let flags = ".UNSPECIFIED.,.F.,.F.,.F.";
    let net = |surface: String| {
        step(&[INCH, &grid, &surface].concat()).and_then(|d| d.net(None)).expect("a net").net
    };
    let with_knots = |knots: &str| {
        net(format!("#20=B_SPLINE_SURFACE_WITH_KNOTS('',2,3,{poles},{flags},{knots},.UNSPECIFIED.);\n"))
    };
    let clamped = with_knots("(3,1,1,3),(4,4),(0.,1.,2.,3.),(0.,1.)");
    let quasi = net(format!("#20=QUASI_UNIFORM_SURFACE('',2,3,{poles},{flags});\n"));
    assert_eq!(clamped, quasi);
    assert_eq!(clamped.size(), [3, 1]);
    let free =
        with_knots("(1,1,1,1,1,1,1,1),(1,1,1,1,1,1,1,1),(0.,1.,2.,3.,4.,5.,6.,7.),(0.,1.,2.,3.,4.,5.,6.,7.)");
    assert_eq!(free, net(format!("#20=UNIFORM_SURFACE('',2,3,{poles},{flags});\n")));
    let bezier = net(format!("#20=BEZIER_SURFACE('',2,3,{poles},{flags});\n"));
    assert_eq!(bezier.size(), [2, 1]);
    let weights = "((1.,1.,1.,1.),(1.,2.,1.,1.),(1.,1.,1.,1.),(1.,1.,1.,1.),(1.,1.,1.,1.))";
    let rational = net(format!(
        "#20=(BEZIER_SURFACE() B_SPLINE_SURFACE(2,3,{poles},{flags}) RATIONAL_B_SPLINE_SURFACE({weights}) SURFACE());\n"
    ));
    assert!(rational.patches()[0].is_rational() && rational.patches()[0].weight(1, 1) == 2.0);
    assert_eq!(rational.patches()[0].pole(1, 1), bezier.patches()[0].pole(1, 1));
}

#[test]
fn a_list_of_faces_is_short() {
    assert_eq!(listed(&[3]), "3");
    assert_eq!(listed(&[3, 7]), "3 and 7");
    assert_eq!(listed(&[5, 6]), "5 and 6");
    assert_eq!(listed(&[1, 2, 4, 5, 6, 9]), "1, 2, 4 to 6 and 9");
    let odd: Vec<usize> = (0..100).map(|i| 2 * i).collect();
    assert!(listed(&odd).ends_with("20, 22 and more"));
}

#[test]
fn what_is_cut_off_says_where() {
    let whole = ["ISO-10303-21;\nDATA;\n", INCH, POINTS, PATCH, "ENDSEC;\nEND-ISO-10303-21;\n"].concat();
    for length in 0..whole.len() - 1 {
        let text: Arc<str> = whole[..length].into();
        let trouble = Document::open(Format::Step, &text).expect_err("cut off");
        assert_eq!(trouble.kind, TroubleKind::File);
        assert!(trouble.line.is_some_and(|l| (1..=16).contains(&l)));
    }
    let deep = format!("#1={}{};\n", "A(".repeat(100_000), ")".repeat(100_000));
    let trouble = step(&deep).and_then(|d| d.net(None)).expect_err("no surface");
    assert_eq!(trouble.kind, TroubleKind::Face);
    let deep = format!("#1=(A_SURFACE{}{});\n", "(".repeat(100_000), ")".repeat(100_000));
    let trouble = step(&deep).and_then(|d| d.net(None)).expect_err("too deep");
    assert!(trouble.message.contains("too deep"), "{}", trouble.message);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn broken_step_files_are_refused_or_read(
        changes in proptest::collection::vec((any::<prop::sample::Index>(), "[-#(),;'.*$=A-Z0-9/]"), 1..4),
    ) {
        let face = "#30=VERTEX_POINT('',#11);\n#31=LINE('',#11,#11);\n#32=EDGE_CURVE('',#30,#30,#31,.T.);\n\
                    #33=ORIENTED_EDGE('',*,*,#32,.T.);\n#34=EDGE_LOOP('',(#33));\n\
                    #35=FACE_BOUND('',#34,.T.);\n#36=ADVANCED_FACE('',(#35),#20,.T.);\n";
        let mut text = [INCH, POINTS, PATCH, face].concat();
        for (at, with) in &changes {
            let at = at.index(text.len());
            text.replace_range(at..=at, with);
        }
        if let Ok(import) = step(&text).and_then(|d| d.net(None)) {
            prop_assert!(corner(&import).coords.iter().all(|c| c.is_finite()));
        }
    }
}
