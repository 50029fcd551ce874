//! SVG elements on a canvas; the one place of this module that prints numbers.

use core::fmt::Write as _;
use std::collections::BTreeMap;

/// A point of the canvas, pixels, y downwards.
pub(super) type Pixel = (f64, f64);

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pen {
    pub(super) color: &'static str,
    pub(super) width: f64,
    /// Dash pattern, `""` for a solid line.
    pub(super) dash: &'static str,
}

impl Pen {
    pub(super) const fn solid(color: &'static str, width: f64) -> Pen {
        Pen { color, width, dash: "" }
    }
    pub(super) const fn dashed(color: &'static str, width: f64, dash: &'static str) -> Pen {
        Pen { color, width, dash }
    }
}

/// Where a text stands relative to its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text is set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Type {
    pub(super) size: f64,
    pub(super) color: &'static str,
    pub(super) anchor: Anchor,
}

/// SVG text under construction.
#[derive(Debug, Clone, Default)]
pub(super) struct Canvas {
    body: String,
    clips: usize,
}

/// Pixels with two decimals at most, no `-0`.
pub(super) fn px(value: f64) -> String {
    decimal(value, 2)
}

/// At most `decimals` decimals, no trailing zeros, no `-0`.
pub(super) fn decimal(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".into() } else { text.into() }
}

/// Exactly `decimals` decimals with a true minus sign, for axes and figures.
pub(super) fn label(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let zero = text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.');
    if zero { text.trim_start_matches('-').into() } else { text.replace('-', "\u{2212}") }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

impl Canvas {
    /// The finished document.
    pub(super) fn document(&self, width: f64, height: f64, title: &str) -> String {
        let (w, h) = (px(width), px(height));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
             font-family=\"Ubuntu, 'Segoe UI', Helvetica, Arial, sans-serif\">\n<title>{}</title>\n\
             <rect width=\"{w}\" height=\"{h}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            escape(title),
            self.body
        )
    }
    fn push(&mut self, element: core::fmt::Arguments<'_>) {
        // Writing to a string cannot fail.
        let _ = self.body.write_fmt(element);
        self.body.push('\n');
    }
    pub(super) fn line(&mut self, a: Pixel, b: Pixel, pen: Pen) {
        let stroke = stroke(pen);
        self.push(format_args!("<path d=\"M{} {}L{} {}\"{stroke}/>", px(a.0), px(a.1), px(b.0), px(b.1)));
    }
    /// A stroked outline from path data.
    pub(super) fn stroke(&mut self, data: &str, pen: Pen) {
        if !data.is_empty() {
            self.push(format_args!("<path d=\"{data}\" fill=\"none\"{}/>", stroke(pen)));
        }
    }
    /// A filled area from path data; holes by the even-odd rule.
    pub(super) fn fill(&mut self, data: &str, color: &str) {
        if !data.is_empty() {
            self.push(format_args!("<path d=\"{data}\"{} fill-rule=\"evenodd\"/>", paint(color)));
        }
    }
    pub(super) fn rect(&mut self, at: Pixel, size: Pixel, fill: &str, pen: Option<Pen>) {
        let stroke = pen.map_or(String::new(), stroke);
        let (x, y, w, h) = (px(at.0), px(at.1), px(size.0), px(size.1));
        self.push(format_args!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"{}{stroke}/>",
            paint(fill)
        ));
    }
    pub(super) fn circle(&mut self, centre: Pixel, radius: f64, fill: &str, pen: Option<Pen>) {
        let stroke = pen.map_or(String::new(), stroke);
        let (x, y, r) = (px(centre.0), px(centre.1), px(radius));
        self.push(format_args!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\"{}{stroke}/>", paint(fill)));
    }
    /// Many equal dots in one element.
    pub(super) fn dots(&mut self, points: &[Pixel], diameter: f64, color: &'static str) {
        let mut data = String::new();
        for p in points {
            let _ = write!(data, "M{} {}h0", px(p.0), px(p.1));
        }
        if !points.is_empty() {
            let width = px(diameter);
            self.push(format_args!(
                "<path d=\"{data}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" stroke-linecap=\"round\"/>"
            ));
        }
    }
    /// Runs of square cells by colour: path data in cells, from the corner `at`.
    pub(super) fn cells(&mut self, at: Pixel, cell: f64, runs: &BTreeMap<[u8; 3], String>) {
        let (x, y, size) = (px(at.0), px(at.1), px(cell));
        self.push(format_args!(
            "<g transform=\"translate({x} {y}) scale({size})\" fill=\"none\" shape-rendering=\"crispEdges\">"
        ));
        for ([r, g, b], data) in runs {
            self.push(format_args!("<path stroke=\"#{r:02x}{g:02x}{b:02x}\" d=\"{data}\"/>"));
        }
        self.push(format_args!("</g>"));
    }
    pub(super) fn text(&mut self, at: Pixel, text: &str, t: Type) {
        let anchor = match t.anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let (x, y, size) = (px(at.0), px(at.1), px(t.size));
        self.push(format_args!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" fill=\"{}\"{anchor}>{}</text>",
            t.color,
            escape(text)
        ));
    }
    /// Everything drawn by `draw` is clipped to a rectangle.
    pub(super) fn clipped(&mut self, at: Pixel, size: Pixel, draw: impl FnOnce(&mut Canvas)) {
        self.clips += 1;
        let (id, x, y, w, h) = (self.clips, px(at.0), px(at.1), px(size.0), px(size.1));
        self.push(format_args!(
            "<clipPath id=\"c{id}\"><rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"/></clipPath>\n<g clip-path=\"url(#c{id})\">"
        ));
        draw(self);
        self.push(format_args!("</g>"));
    }
}

/// `fill` of a colour, whose alpha, if it has eight digits, becomes an opacity: not every viewer reads them.
fn paint(color: &str) -> String {
    let alpha = color.get(7..9).and_then(|a| u8::from_str_radix(a, 16).ok());
    match (alpha, color.get(..7)) {
        (Some(alpha), Some(rgb)) => {
            format!(" fill=\"{rgb}\" fill-opacity=\"{}\"", px(f64::from(alpha) / 255.0))
        }
        _ => format!(" fill=\"{color}\""),
    }
}

fn stroke(pen: Pen) -> String {
    let dash =
        if pen.dash.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{}\"", pen.dash) };
    format!(
        " stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\" stroke-linecap=\"{}\"{dash}",
        pen.color,
        px(pen.width),
        if pen.dash.is_empty() { "round" } else { "butt" }
    )
}
