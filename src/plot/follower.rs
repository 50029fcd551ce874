//! The follower, drawn at cam angle 0.

use super::canvas::{Canvas, Pen, Pixel};
use super::theme;
use super::world::{View, polyline};
use crate::geom::cam::Cam;
use crate::geom::follower::Follower;
use crate::geom::{Point2, Vec2};

const BODY: Pen = Pen::solid(theme::FOLLOWER, 2.4);
const THIN: Pen = Pen::solid(theme::FOLLOWER, 1.4);
const FILL: &str = "#f6d3b8a8";

/// Points that a picture must show for the follower to be seen.
pub(super) fn extent(cam: &Cam) -> Vec<Point2> {
    let posture = cam.follower_at_zero();
    let r = cam.definition().follower.roller();
    let corner = Vec2::new(r, r);
    let mut points = vec![posture.tip + corner, posture.tip - corner];
    points.extend(posture.pivot.map(|p| p + Vec2::new(reach(cam) * 0.08, 0.0)));
    if posture.pivot.is_none() {
        points.push(Point2::new(stem_end(cam), posture.tip.y));
    }
    points
}

fn reach(cam: &Cam) -> f64 {
    cam.figures().inner.farthest.value + cam.definition().follower.roller()
}

/// Where a translating follower's stem ends.
fn stem_end(cam: &Cam) -> f64 {
    1.42 * (reach(cam) + cam.definition().follower.roller())
}

pub(super) fn draw(canvas: &mut Canvas, view: &View, cam: &Cam) {
    let posture = cam.follower_at_zero();
    let radius = cam.definition().follower.roller();
    match (posture.pivot, posture.face) {
        (None, None) => {
            stem(canvas, view, cam, posture.tip);
            roller(canvas, view, posture.tip, radius);
        }
        (None, Some(_)) => {
            let face = face_offset(cam);
            let tip = Point2::new(posture.tip.x, face);
            stem(canvas, view, cam, tip);
            let half = face_half(cam);
            plate(
                canvas,
                view,
                posture.tip + Vec2::new(0.0, half),
                posture.tip - Vec2::new(0.0, half),
                Vec2::new(1.0, 0.0),
            );
        }
        (Some(pivot), None) => {
            canvas.line(view.point(pivot), view.point(posture.tip), Pen { width: 5.0, ..BODY });
            roller(canvas, view, posture.tip, radius);
            bearing(canvas, view, pivot);
        }
        (Some(pivot), Some(direction)) => {
            swinging_face(canvas, view, cam, pivot, posture.tip, direction);
            bearing(canvas, view, pivot);
        }
    }
}

/// Half of the drawn width of a translating face: the contact's reach and a little more.
fn face_half(cam: &Cam) -> f64 {
    cam.figures().face.map_or(10.0, |f| f.from.value.abs().max(f.to.value.abs()) * 1.12 + 0.03 * reach(cam))
}

/// The stem's line beside the centre: e to the right of travel in the part of a clockwise cam.
fn face_offset(cam: &Cam) -> f64 {
    match cam.definition().follower {
        Follower::TranslatingFlat { offset } => -offset,
        _ => 0.0,
    }
}

fn stem(canvas: &mut Canvas, view: &View, cam: &Cam, tip: Point2) {
    let end = stem_end(cam);
    let (from, to) = (view.point(tip), view.point(Point2::new(end, tip.y)));
    canvas.line(from, to, Pen { width: 5.0, ..BODY });
    // The guide: two blocks beside the stem.
    let length = (to.0 - from.0) * 0.28;
    let x = from.0 + (to.0 - from.0) * 0.62;
    for y in [to.1 - 15.0, to.1 + 5.0] {
        canvas.rect((x, y), (length, 10.0), FILL, Some(THIN));
    }
}

fn roller(canvas: &mut Canvas, view: &View, centre: Point2, radius: f64) {
    canvas.circle(view.point(centre), radius * view.scale, FILL, Some(BODY));
    canvas.circle(view.point(centre), 3.0, theme::FOLLOWER, None);
}

/// A flat face: a thin plate behind the line from `a` to `b`, thick towards `behind`.
fn plate(canvas: &mut Canvas, view: &View, a: Point2, b: Point2, behind: Vec2) {
    const THICKNESS: f64 = 7.0;
    let depth = behind * (THICKNESS / view.scale);
    let corners: Vec<Pixel> = [a, b, b + depth, a + depth].iter().map(|p| view.point(*p)).collect();
    let data = format!("{}Z", polyline(&corners));
    canvas.fill(&data, FILL);
    canvas.stroke(&data, THIN);
    canvas.line(view.point(a), view.point(b), BODY);
}

fn swinging_face(canvas: &mut Canvas, view: &View, cam: &Cam, pivot: Point2, tip: Point2, direction: Vec2) {
    let face = cam.figures().face;
    let along = (tip - pivot).dot(&direction);
    let foot = tip - direction * along;
    let far = face.map_or(along, |f| f.to.value).max(along) + 0.06 * reach(cam);
    let near = face.map_or(0.0, |f| f.from.value).min(along) * 0.35;
    let outwards = Vec2::new(-direction.y, direction.x);
    // The plate lies on the side of the face that the cam does not touch.
    let behind = if outwards.dot(&foot.coords) > 0.0 { outwards } else { -outwards };
    plate(canvas, view, foot + direction * near, foot + direction * far, behind);
    canvas.line(view.point(pivot), view.point(foot), Pen { width: 5.0, ..BODY });
    canvas.line(view.point(foot), view.point(foot + direction * near), Pen { width: 5.0, ..BODY });
}

fn bearing(canvas: &mut Canvas, view: &View, pivot: Point2) {
    let p = view.point(pivot);
    canvas.circle(p, 9.0, FILL, Some(BODY));
    canvas.circle(p, 2.6, theme::FOLLOWER, None);
    let base = polyline(&[
        (p.0 - 14.0, p.1 + 20.0),
        (p.0 - 6.0, p.1 + 8.0),
        (p.0 + 6.0, p.1 + 8.0),
        (p.0 + 14.0, p.1 + 20.0),
    ]);
    canvas.stroke(&format!("{base}Z"), THIN);
}
