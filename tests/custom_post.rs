//! Controllers written in one file from the guide alone: that of the guide itself, those under `examples/posts`, one of the
//! tests. All are built and proven.

mod common;

use std::path::Path;

use common::Directory;
use common::scratch::Scratch;
use partwright::driver::{self, Options};

const POST: &str = include_str!("data/posts/router.post.toml");

#[test]
fn the_guide_shows_the_file_that_is_tested() {
    let guide = include_str!("../docs/posts.md");
    assert!(
        guide.contains(&format!("```toml\n{POST}```")),
        "the example in docs/posts.md is not the tested file"
    );
}

#[test]
fn a_controller_written_in_one_file_makes_proven_programs() {
    let scratch = Scratch::new("custom-post");
    scratch.write("router.post.toml", POST);
    let example = include_str!("../examples/plate_cam.apt");
    scratch.write("plate_cam.apt", example);
    let check = scratch.run(&["post", "check", "router.post.toml", "--deny", "warnings"]);
    assert!(check.status.success(), "{}", String::from_utf8_lossy(&check.stderr));
    let build = scratch.run(&["build", "plate_cam.apt", "--post", "router.post.toml", "-o", "-"]);
    assert!(build.status.success(), "{}", String::from_utf8_lossy(&build.stderr));
    let text = String::from_utf8(build.stdout).expect("ASCII");
    assert!(text.lines().count() > 20 && text.ends_with("M2\r\n"), "{text}");
    insta::assert_snapshot!("custom_post_router", text.replace("\r\n", "\n"));
}

/// Posts of controls that are not built in, or not so, by their files; all but the last are for people to look at.
const POSTS: [&str; 9] = [
    "examples/posts/fagor.post.toml",
    "examples/posts/grblhal_g5.post.toml",
    "examples/posts/itnc530.post.toml",
    "examples/posts/linuxcnc_g5.post.toml",
    "examples/posts/marlin_g5.post.toml",
    "examples/posts/num.post.toml",
    "examples/posts/sinumerik_cip.post.toml",
    "examples/posts/sinumerik_poly.post.toml",
    "tests/data/posts/syntec.post.toml",
];
/// Programs of which all posts' texts are looked at, and those that show what a post is for.
const SHOWN: [&str; 2] = ["plate_cam.apt", "nx_cover.cls"];
const OWN: [(&str, &str); 6] = [
    ("net_arcs.apt", "sinumerik_cip"),
    ("net_nurbs.apt", "itnc530"),
    ("net_nurbs.apt", "sinumerik_poly"),
    ("plate_cam_nurbs.apt", "itnc530"),
    ("plate_cam_nurbs.apt", "linuxcnc_g5"),
    ("plate_cam_nurbs.apt", "sinumerik_poly"),
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn every_post_of_the_examples_is_tested() {
    for path in common::find(&root().join("examples/posts"), "toml") {
        let name = path.strip_prefix(root()).expect("inside").to_string_lossy().replace('\\', "/");
        assert!(POSTS.contains(&name.as_str()), "{name} is not in the list of this test");
    }
}

#[test]
fn posts_of_other_controls_have_nothing_to_complain_about() {
    for post in POSTS {
        let check = Scratch::new("other-controls").run(&[
            "post",
            "check",
            &root().join(post).to_string_lossy(),
            "--deny",
            "warnings",
        ]);
        assert!(check.status.success(), "{post}: {}", String::from_utf8_lossy(&check.stderr));
    }
}

#[test]
fn posts_of_other_controls_make_proven_programs_of_all_examples() {
    let kinds = ["apt", "cls", "aptsource"];
    let folder = root().join("examples");
    let examples = kinds.iter().flat_map(|kind| common::find(&folder, kind));
    for path in examples.filter(|p| p.parent() == Some(folder.as_path())) {
        let name = path.strip_prefix(root()).expect("inside").to_string_lossy().replace('\\', "/");
        let options = Options { posts: POSTS.map(str::to_owned).to_vec(), ..Options::default() };
        let build = driver::build(&name, &Directory(root().to_path_buf()), &options);
        let proven = build.outputs.iter().filter_map(|output| Some((output, output.proven.as_ref()?)));
        let proven: Vec<_> = proven.collect();
        assert_eq!(proven.len(), POSTS.len(), "{name}: {:?}", build.diagnostics);
        let name = name.trim_start_matches("examples/");
        for (output, proven) in proven {
            if SHOWN.contains(&name) || OWN.contains(&(name, output.post.as_str())) {
                insta::assert_snapshot!(format!("{name}.{}", output.post), proven.text());
            }
        }
    }
}

/// Curves of a CL file, level and climbing, as the pieces of those posts that have them.
#[test]
fn curves_of_cl_files_become_pieces() {
    let posts = ["grblhal_g5", "itnc530", "linuxcnc_g5", "marlin_g5", "sinumerik_poly"];
    let posts = posts.map(|post| format!("examples/posts/{post}.post.toml"));
    let options = Options { posts: posts.to_vec(), is_cl: true, ..Options::default() };
    let build = driver::build("tests/cl/nx_curves.clsf", &Directory(root().to_path_buf()), &options);
    let said: Vec<(&str, &str)> = build.diagnostics.iter().map(|d| (d.code.id, d.message.as_str())).collect();
    let level = ["grblhal_g5", "linuxcnc_g5", "marlin_g5"];
    assert_eq!(said.len(), level.len(), "{said:#?}");
    for post in level {
        let climbs = format!("`{post}` has curves in the XY plane only, and their height changes");
        assert!(
            said.iter().any(|(code, message)| *code == "N1013" && message.ends_with(&climbs)),
            "{said:#?}"
        );
    }
    for output in &build.outputs {
        let proven = output.proven.as_ref().expect("proven");
        insta::assert_snapshot!(format!("nx_curves.clsf.{}", output.post), proven.text());
    }
}
