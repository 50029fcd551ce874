//! The post of the guide: a controller written in one file, built and proven.

mod common;

use common::scratch::Scratch;

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
