//! A net as a STEP file: one face on one B-spline surface, bounded by the surface's own edges, in an open shell (AP214).

use core::fmt::Write as _;

use crate::geom::Point3;
use crate::geom::surface::grid::Grid;

/// Ends of edges nearer than this are one point, mm.
const SAME: f64 = 1e-9;

/// The text of a file with the net called `name`; the same for the same net, without time, place or author.
#[must_use]
pub fn write(name: &str, grid: &Grid) -> String {
    let mut file = Writer::default();
    let (product, context) = file.product(name);
    let origin = file.point(&Point3::origin());
    let axis = file.add("DIRECTION('',(0.,0.,1.))");
    let x = file.add("DIRECTION('',(1.,0.,0.))");
    let frame = file.add(format!("AXIS2_PLACEMENT_3D('',#{origin},#{axis},#{x})"));
    let points: Vec<usize> = grid.poles.iter().map(|p| file.point(p)).collect();
    let surface = file.surface(grid, &points);
    let edges = file.edges(grid, &points);
    let turn = file.add(format!("EDGE_LOOP('',({}))", list(&edges)));
    let bound = file.add(format!("FACE_OUTER_BOUND('',#{turn},.T.)"));
    let face = file.add(format!("ADVANCED_FACE('{name}',(#{bound}),#{surface},.T.)"));
    let shell = file.add(format!("OPEN_SHELL('{name}',(#{face}))"));
    let model = file.add(format!("SHELL_BASED_SURFACE_MODEL('{name}',(#{shell}))"));
    let shape =
        file.add(format!("MANIFOLD_SURFACE_SHAPE_REPRESENTATION('{name}',(#{frame},#{model}),#{context})"));
    file.add(format!("SHAPE_DEFINITION_REPRESENTATION(#{product},#{shape})"));
    format!(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('net {name}'),'2;1');\n\
         FILE_NAME('{name}','',(''),(''),'partwright','partwright','');\n\
         FILE_SCHEMA(('AUTOMOTIVE_DESIGN {{ 1 0 10303 214 1 1 1 1 }}'));\nENDSEC;\nDATA;\n{}ENDSEC;\nEND-ISO-10303-21;\n",
        file.text
    )
}

#[derive(Default)]
struct Writer {
    text: String,
    last: usize,
}

impl Writer {
    /// Adds an instance; its number.
    fn add(&mut self, body: impl AsRef<str>) -> usize {
        self.last += 1;
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "#{}={};", self.last, body.as_ref());
        self.last
    }

    fn point(&mut self, p: &Point3) -> usize {
        self.add(format!("CARTESIAN_POINT('',({},{},{}))", real(p.x), real(p.y), real(p.z)))
    }

    /// Product definition shape and geometric context.
    fn product(&mut self, name: &str) -> (usize, usize) {
        let application =
            self.add("APPLICATION_CONTEXT('core data for automotive mechanical design processes')");
        self.add(format!(
            "APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,#{application})"
        ));
        let context = self.add(format!("PRODUCT_CONTEXT('',#{application},'mechanical')"));
        let product = self.add(format!("PRODUCT('{name}','{name}','',(#{context}))"));
        self.add(format!("PRODUCT_RELATED_PRODUCT_CATEGORY('part','',(#{product}))"));
        let formation = self.add(format!("PRODUCT_DEFINITION_FORMATION('','',#{product})"));
        let context =
            self.add(format!("PRODUCT_DEFINITION_CONTEXT('part definition',#{application},'design')"));
        let definition = self.add(format!("PRODUCT_DEFINITION('design','',#{formation},#{context})"));
        let shape = self.add(format!("PRODUCT_DEFINITION_SHAPE('','',#{definition})"));
        let mm = self.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
        let radian = self.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
        let steradian = self.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
        let accuracy = self.add(format!(
            "UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-7),#{mm},'distance_accuracy_value','accuracy')"
        ));
        let space = self.add(format!(
            "(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{accuracy}))\
             GLOBAL_UNIT_ASSIGNED_CONTEXT((#{mm},#{radian},#{steradian}))REPRESENTATION_CONTEXT('','3D'))"
        ));
        (shape, space)
    }

    fn surface(&mut self, grid: &Grid, points: &[usize]) -> usize {
        let [p, q] = grid.degree;
        let rows: Vec<String> = points.chunks(grid.counts[1]).map(|row| format!("({})", list(row))).collect();
        let form = format!("{p},{q},({}),.UNSPECIFIED.,.F.,.F.,.F.", rows.join(","));
        let [(u, m), (v, n)] = [grid.knots(0), grid.knots(1)];
        let knots =
            format!("({}),({}),({}),({}),.UNSPECIFIED.", counts(&m), counts(&n), reals(&u), reals(&v));
        let Some(weights) = &grid.weights else {
            return self.add(format!("B_SPLINE_SURFACE_WITH_KNOTS('',{form},{knots})"));
        };
        let rows: Vec<String> =
            weights.chunks(grid.counts[1]).map(|row| format!("({})", reals(row))).collect();
        self.add(format!(
            "(BOUNDED_SURFACE()B_SPLINE_SURFACE({form})B_SPLINE_SURFACE_WITH_KNOTS({knots})\
             GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(({}))REPRESENTATION_ITEM('')SURFACE())",
            rows.join(",")
        ))
    }

    /// The oriented edges of the face, counter-clockwise in (u, v). A side that is a point has no edge; two opposite
    /// sides that are the same curve are one edge, used twice.
    fn edges(&mut self, grid: &Grid, points: &[usize]) -> Vec<usize> {
        let mut corners: Vec<(Point3, usize)> = Vec::new();
        let mut known: Vec<(Vec<usize>, usize)> = Vec::new();
        let mut out = Vec::new();
        for (axis, last, forward) in [(0, false, true), (1, true, true), (0, true, false), (1, false, false)]
        {
            let side = grid.side(axis, last);
            let at = |k: usize| grid.poles[k];
            let same = |a: &[usize], b: &[usize]| {
                a.len() == b.len() && a.iter().zip(b).all(|(i, j)| (at(*i) - at(*j)).norm() <= SAME)
            };
            let Some((&first, &end)) = side.first().zip(side.last()) else { continue };
            if side.iter().all(|k| (at(*k) - at(first)).norm() <= SAME) {
                continue;
            }
            let found = known.iter().find(|(other, _)| same(other, &side)).map(|(_, edge)| *edge);
            let edge = found.unwrap_or_else(|| {
                let ends = [first, end].map(|k| self.vertex(&mut corners, at(k), points[k]));
                let curve = self.curve(grid, axis, &side, points);
                self.add(format!("EDGE_CURVE('',#{},#{},#{curve},.T.)", ends[0], ends[1]))
            });
            known.push((side, edge));
            let sense = if forward { ".T." } else { ".F." };
            out.push(self.add(format!("ORIENTED_EDGE('',*,*,#{edge},{sense})")));
        }
        out
    }

    fn vertex(&mut self, corners: &mut Vec<(Point3, usize)>, at: Point3, point: usize) -> usize {
        if let Some((_, vertex)) = corners.iter().find(|(p, _)| (p - at).norm() <= SAME) {
            return *vertex;
        }
        let vertex = self.add(format!("VERTEX_POINT('',#{point})"));
        corners.push((at, vertex));
        vertex
    }

    fn curve(&mut self, grid: &Grid, axis: usize, side: &[usize], points: &[usize]) -> usize {
        let poles: Vec<usize> = side.iter().map(|k| points[*k]).collect();
        let form = format!("{},({}),.UNSPECIFIED.,.F.,.F.", grid.degree[axis], list(&poles));
        let (knots, multiplicities) = grid.knots(axis);
        let knots = format!("({}),({}),.UNSPECIFIED.", counts(&multiplicities), reals(&knots));
        let Some(weights) = &grid.weights else {
            return self.add(format!("B_SPLINE_CURVE_WITH_KNOTS('',{form},{knots})"));
        };
        let weights: Vec<f64> = side.iter().map(|k| weights[*k]).collect();
        self.add(format!(
            "(BOUNDED_CURVE()B_SPLINE_CURVE({form})B_SPLINE_CURVE_WITH_KNOTS({knots})CURVE()\
             GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_CURVE(({}))REPRESENTATION_ITEM(''))",
            reals(&weights)
        ))
    }
}

fn list(ids: &[usize]) -> String {
    ids.iter().map(|id| format!("#{id}")).collect::<Vec<_>>().join(",")
}

fn counts(numbers: &[usize]) -> String {
    numbers.iter().map(usize::to_string).collect::<Vec<_>>().join(",")
}

fn reals(numbers: &[f64]) -> String {
    numbers.iter().map(|x| real(*x)).collect::<Vec<_>>().join(",")
}

/// The shortest text that reads back as the same number, with the point that the format asks for.
fn real(x: f64) -> String {
    if x == 0.0 {
        return "0.".into();
    }
    let text = format!("{x:?}");
    match text.split_once('e') {
        Some((digits, exponent)) => {
            let point = if digits.contains('.') { "" } else { "." };
            format!("{digits}{point}E{exponent}")
        }
        None => text.strip_suffix(".0").map_or(text.clone(), |whole| format!("{whole}.")),
    }
}

#[cfg(test)]
mod tests {
    use super::real;

    #[test]
    fn reals_have_a_point_and_all_their_digits() {
        let texts = [0.0, -0.0, 1.0, -2.5, 0.1, 1e-7, 1.5e-9, 1e22, 1.0 / 3.0].map(real);
        let wanted = ["0.", "0.", "1.", "-2.5", "0.1", "1.E-7", "1.5E-9", "1.E22", "0.3333333333333333"];
        assert_eq!(texts, wanted);
        assert_eq!("1.E-7".parse(), Ok(1e-7));
    }
}
