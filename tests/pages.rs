//! Pages of `plot -o FILE.html`, opened from a file by Chromium without a window: no error on its console, a picture in
//! three dimensions, and controls that do what they say.
//!
//! Pages are skipped, and said so, where Chromium is not installed (Debian: `chromium`); `PARTWRIGHT_REQUIRE_CHROMIUM=1` makes that
//! an error.

mod common;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use common::Directory;
use partwright::driver::{self, Build, Options};
use partwright::plot::{self, What};

fn installed() -> bool {
    let version =
        Command::new("chromium").arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    let there = version.is_ok_and(|s| s.success());
    let required = std::env::var_os("PARTWRIGHT_REQUIRE_CHROMIUM").is_some_and(|v| v == "1");
    assert!(there || !required, "PARTWRIGHT_REQUIRE_CHROMIUM=1, and there is no chromium to run");
    if !there {
        eprintln!("SKIPPED: chromium is not installed, the pages are not opened");
    }
    there
}

fn build(example: &str) -> Build {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let options = Options { posts: vec!["linuxcnc".to_owned()], ..Options::default() };
    let build = driver::build(example, &Directory(folder), &options);
    assert!(!build.has_errors(), "{:#?}", build.diagnostics);
    build
}

fn page(example: &str, what: &What) -> String {
    let build = build(example);
    plot::page(what, &build, build.outputs.first()).expect("a page")
}

/// A folder of its own for each test: Chromium locks its profile.
#[expect(clippy::disallowed_methods, reason = "a scratch file of the test")]
fn write(name: &str, page: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("page-{name}"));
    std::fs::create_dir_all(&folder).expect("a directory");
    let file = folder.join("page.html");
    std::fs::write(&file, page).expect("a file");
    file
}

/// Opens a page; its document after the scripts ran, and what came on the console.
fn opened(file: &Path, hash: &str, how: &[&str]) -> (String, String) {
    let profile = file.with_file_name("profile");
    let done = Command::new("chromium")
        .args(["--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader"])
        .args(["--enable-unsafe-swiftshader", "--hide-scrollbars", "--window-size=1200,800"])
        .args([
            "--disable-background-networking",
            "--no-first-run",
            "--enable-logging=stderr",
            "--disable-dev-shm-usage",
        ])
        .args(["--virtual-time-budget=3000"])
        .arg(format!("--user-data-dir={}", profile.display()))
        .args(how)
        .arg(format!("file://{}{hash}", file.display()))
        .output()
        .expect("chromium runs");
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(done.status.success(), "{said}");
    let console: String = said.lines().filter(|l| l.contains("CONSOLE")).collect();
    (String::from_utf8_lossy(&done.stdout).into_owned(), console)
}

/// What a page becomes after `script`, which runs behind its own and hands over what it found as text.
fn after(name: &str, page: &str, hash: &str, script: &str) -> String {
    let script = format!(
        "<script>const found = []; try {{ {script} }} catch (e) {{ found.push('FAILED ' + e); }}\
         document.body.append(Object.assign(document.createElement('pre'), {{ id: 'found', textContent: found.join('\\n') }}));</script></body>"
    );
    let file = write(name, &page.replace("</body>", &script));
    let (document, console) = opened(&file, hash, &["--dump-dom"]);
    assert_eq!(console, "");
    let found = document.split("<pre id=\"found\">").nth(1).and_then(|r| r.split("</pre>").next());
    found.unwrap_or_else(|| panic!("the page did not come up:\n{document}")).to_owned()
}

/// Distinct colours of the left two thirds of a picture of the page, where the scene is.
fn colours(name: &str, page: &str) -> usize {
    let file = write(name, page);
    let picture = file.with_file_name("page.png");
    let (_, console) = opened(&file, "", &[&format!("--screenshot={}", picture.display())]);
    assert_eq!(console, "");
    let bytes = std::fs::read(&picture).expect("a screenshot");
    let pixels = resvg::tiny_skia::Pixmap::decode_png(&bytes).expect("a PNG");
    assert_eq!((pixels.width(), pixels.height()), (1200, 800));
    let inside = |x: u32, y: u32| pixels.pixel(x, y).map(|p| (p.red(), p.green(), p.blue()));
    let all = (100..700).flat_map(|y| (50..800).map(move |x| (x, y)));
    all.filter_map(|(x, y)| inside(x, y)).collect::<BTreeSet<_>>().len()
}

#[test]
fn a_measured_surface_comes_up_coloured() {
    if !installed() {
        return;
    }
    let measured = colours("measured", &page("net_cavity.apt", &What::Deviation));
    assert!(measured > 400, "{measured} colours");
}

#[test]
fn a_cam_comes_up_in_space() {
    if !installed() {
        return;
    }
    let solid = colours("cam", &page("rough_and_finish.apt", &What::Path));
    assert!(solid > 60, "{solid} colours");
}

#[test]
fn the_controls_of_the_page_work() {
    if !installed() {
        return;
    }
    let script = r"
        const now = () => document.querySelector('#nc .now').textContent.replace(/^\d+/, '');
        const all = Number(slider.max), boxes = [...document.querySelectorAll('#toggles input')];
        found.push(all > 1000, Number(slider.value) === all);
        slider.value = 100;
        slider.dispatchEvent(new Event('input'));
        found.push(now() === lines[line[99]- 1], element('where').textContent.startsWith('move 100 of '));
        found.push(location.hash === '#line=' + line[99]);
        found.push(state.textContent.includes(length(points[3 * to[99]])));
        const path = paths.find(p => p.name === 'cuts');
        found.push(path.done.geometry.drawRange.count > 0, path.done.visible);
        boxes.find(b => b.parentElement.textContent.includes('cuts')).click();
        found.push(path.done.visible);
        for (const b of document.querySelectorAll('[data-view]')) b.click();
        camera.updateMatrixWorld();
        look('top');
        const at = onScreen(new THREE.Vector3().fromArray(points, 3 * to[200]));
        const move = moveAt(at[0], at[1]);
        found.push(move !== null && Math.abs(move - 200) <= 1);
        pointer = at;
        hover();
        found.push(!tip.hidden && tip.textContent.includes(lines[line[move] - 1]));
        document.querySelector('#marks button').click();
        found.push(document.querySelectorAll('.mark').length === document.querySelectorAll('#marks button').length);
        element('play').click();
        found.push(element('play').textContent);
    ";
    let found = after("controls", &page("net_cavity.apt", &What::Deviation), "", script);
    let wanted = "true\ntrue\ntrue\ntrue\ntrue\ntrue\ntrue\nfalse\ntrue\ntrue\ntrue\ntrue\nPause";
    assert_eq!(found, wanted);
}

#[test]
fn a_page_opens_at_the_line_that_its_address_names() {
    if !installed() {
        return;
    }
    let script = "found.push(document.querySelector('#nc .now').textContent, element('slider').value !== element('slider').max);";
    let page = page("plate_cam.apt", &What::Path);
    let found = after("line", &page, "#line=20", script);
    assert!(found.starts_with("20") && found.ends_with("true"), "{found}");
}
