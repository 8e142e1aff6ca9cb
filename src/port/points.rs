//! Turns CSV of points into CSV of values, for the commands `exact` and `shape`.

use super::rows::{self, Rows};
use crate::method::basis::scattered::{Places, fill_from_nodes};
use crate::method::basis::{Basis, Extents, Scratch, fill_from_grid};
use crate::method::breakdown::Breakdown;
use crate::method::continuum::shape::Shape;
use crate::method::continuum::state::Multiplier;
use crate::method::grid::Grid;
use crate::run::table::{csv, shortest};
use crate::scene::Scene;
use crate::scene::fault::Fault;
use crate::setup;
use nalgebra::SVector;
use std::io::Read;

/// Points are read from CSV: the columns found, and one row for each line.
pub struct Points {
    name: String,
    rows: Vec<(u64, Vec<f64>)>,
}

impl Points {
    /// Reads the first of `layouts` that fits the header: columns by name, in
    /// any order. All values must be finite.
    ///
    /// Errors: [`Fault::Points`] with the line.
    pub fn read(name: &str, input: impl Read, layouts: &[&[&str]]) -> Result<Self, Fault> {
        let names: Vec<String> = layouts.iter().map(|layout| layout.join(",")).collect();
        let wanted = format!("a header line with the columns {}", names.join(" or "));
        let text = rows::text(name, input)?;
        let mut lines = Rows::of(name, &text, wanted)?;
        let header = lines.header.clone();
        let find = |layout: &&&[&str]| {
            layout.len() == header.len() && layout.iter().all(|c| header.iter().any(|h| h == *c))
        };
        let Some(layout) = layouts.iter().find(find) else {
            let found: Vec<&str> = header.iter().collect();
            let problem = format!("the columns are `{}`", rows::brief(&found.join(",")));
            return Err(lines.no_header(problem));
        };
        let mut rows = Vec::new();
        while let Some((line, record)) = lines.next_row()? {
            let mut row = Vec::new();
            for column in *layout {
                let at = header.iter().position(|h| h == *column).unwrap_or(0);
                let text = record.get(at).unwrap_or("");
                match text.parse::<f64>() {
                    Ok(x) if x.is_finite() => row.push(x),
                    _ => {
                        let problem = format!("`{}` is not a value of {column}", rows::brief(text));
                        return Err(lines.fault(line, problem, "a finite number".to_string()));
                    }
                }
            }
            rows.push((line, row));
        }
        Ok(Points { name: name.to_string(), rows })
    }

    /// Counts the coordinates of each point.
    fn dimension(&self) -> usize {
        self.rows.first().map_or(0, |(_, row)| row.len())
    }

    fn vectors<const D: usize>(&self) -> Vec<SVector<f64, D>> {
        self.rows.iter().map(|(_, row)| SVector::from_fn(|d, _| row[d])).collect()
    }

    /// Makes the fault `problem` in the line of point `n`.
    fn fault(&self, n: usize, problem: String, allowed: String) -> Fault {
        let line = self.rows.get(n).map_or(1, |(line, _)| *line);
        Fault::Points { path: self.name.clone(), line, problem, allowed }
    }
}

/// Turns `x,t` into `x,t,velocity,stress,displacement` of the scene's exact solution; x
/// in the scene's coordinates, at t = 0.
///
/// Errors: [`Fault::NoExact`]; [`Fault::Points`] with the line of the first
/// point that is not a number, outside the body, or before t = 0.
pub fn exact_at(scene: &Scene, name: &str, input: impl Read) -> Result<Vec<u8>, Fault> {
    setup::has_exact(scene)?;
    if scene.dimension() > 1 {
        return Err(Fault::NoExact { why: "points are asked for along one axis, and it has more" });
    }
    let exact = setup::exact::<1>(scene)?;
    let points = Points::read(name, input, &[&["x", "t"]])?;
    let (origin, length) = (scene.body.origin[0], scene.body.length[0]);
    let end = origin + length;
    let mut rows = Vec::new();
    for (n, (_, row)) in points.rows.iter().enumerate() {
        let (x, t) = (row[0], row[1]);
        let named =
            |what: &str, value: f64| format!("`{}` is not a value of {what}", shortest(value));
        if !(origin <= x && x <= end) {
            let allowed = format!("a number from {} to {}", shortest(origin), shortest(end));
            return Err(points.fault(n, named("x", x), allowed));
        }
        if !(0.0..=exact.latest()).contains(&t) {
            let allowed = format!("a number from 0 to {}", shortest(exact.latest()));
            return Err(points.fault(n, named("t", t), allowed));
        }
        // At the body's own upper corner, to the last bit, as in a scene.
        let fields = exact.along(if x == end { length } else { x - origin }, t);
        let values = [x, t, fields.velocity, fields.stress, fields.displacement];
        rows.push(values.map(shortest).to_vec());
    }
    csv(&["x", "t", "velocity", "stress", "displacement"], rows.into_iter())
}

/// Nodes and points for `shape` have these coordinates.
pub const COORDINATES: [&[&str]; 3] = [&["x"], &["x", "y"], &["x", "y", "z"]];

/// What is asked of a basis at points.
pub struct ShapeQuery {
    pub basis: Basis,
    /// Only a full grid of nodes will do.
    pub needs_grid: bool,
    /// h, the spacing of the nodes (m).
    pub spacing: f64,
    /// How far the particles of GIMP have stretched, along each axis; `None` with the others.
    pub stretch: Option<f64>,
}

/// Writes `point,node,N,dN_dx[,dN_dy[,dN_dz]]` of a basis with the given nodes and
/// spacing (m), points and nodes counted from 0, nodes outside the support left
/// out. `half_length` of [`Basis::Ugimp`] is in units of the spacing.
///
/// Nodes that form a full grid have the functions of a run with MPM. Local max-ent takes others,
/// too, unless a box is asked for, which `needs_grid`: they have those of a run with OTM, of the nodes within R, which is
/// at least the spacing and widened where they do not enclose the point.
///
/// Errors: [`Fault::Points`] with the line of a point that the basis cannot
/// serve, or of a node that is not on a regular grid where the basis needs one.
pub fn shape_at(asked: &ShapeQuery, nodes: &Points, points: &Points) -> Result<Vec<u8>, Fault> {
    if nodes.rows.is_empty() {
        let allowed = "at least one node".to_string();
        return Err(nodes.fault(0, "there are no nodes".to_string(), allowed));
    }
    if !points.rows.is_empty() && points.dimension() != nodes.dimension() {
        let problem = format!("points have {} coordinates", points.dimension());
        let allowed = format!("{}, as the nodes have", nodes.dimension());
        return Err(points.fault(0, problem, allowed));
    }
    match nodes.dimension() {
        1 => shape_in::<1>(asked, nodes, points),
        2 => shape_in::<2>(asked, nodes, points),
        _ => shape_in::<3>(asked, nodes, points),
    }
}

fn shape_in<const D: usize>(
    ShapeQuery { basis, needs_grid, spacing, stretch }: &ShapeQuery,
    nodes: &Points,
    points: &Points,
) -> Result<Vec<u8>, Fault> {
    let (place, x) = (nodes.vectors::<D>(), points.vectors::<D>());
    let stretch = vec![SVector::repeat(stretch.unwrap_or(1.0)); stretch.map_or(0, |_| x.len())];
    let (mut shape, mut scratch) = (Shape::default(), Scratch::default());
    let mut lambda = vec![Multiplier::default(); x.len()];
    let (file_node, done) = match regular_grid(*spacing, nodes, &place) {
        Ok(Regular { grid, lowest, file_node }) => {
            let x: Vec<_> = x.iter().map(|x| x - lowest).collect();
            let x = Extents { x: &x, stretch: &stretch };
            let done = fill_from_grid(&mut shape, &mut scratch, &mut lambda, basis, &grid, x);
            (file_node, done)
        }
        Err(fault) if *needs_grid || basis.width().is_none() => return Err(fault),
        Err(_) => {
            let nodes = Places { x: &place, h: &SVector::repeat(*spacing) };
            let done = fill_from_nodes(&mut shape, &mut scratch, &mut lambda, basis, nodes, &x);
            ((0..place.len()).collect(), done)
        }
    };
    done.map_err(|breakdown| unserved(points, breakdown))?;
    let mut rows = Vec::new();
    for (I, n, N, grad) in shape.pairs() {
        if N != 0.0 || grad.iter().any(|slope| *slope != 0.0) {
            let mut row = vec![n.to_string(), file_node[I].to_string(), shortest(N)];
            row.extend(grad.iter().map(|slope| shortest(*slope)));
            rows.push(row);
        }
    }
    let columns = ["point", "node", "N", "dN_dx", "dN_dy", "dN_dz"];
    csv(&columns[..3 + D], rows.into_iter())
}

/// Says which point has no functions, why, and what to do.
fn unserved(points: &Points, breakdown: Breakdown) -> Fault {
    let (n, problem, allowed) = match breakdown {
        Breakdown::ReachesBeyond { particle: n, .. } => (
            n,
            format!("a particle at point {n} reaches beyond the grid of nodes with its own size"),
            "a point at least --half-length inside the grid, or a smaller --half-length",
        ),
        Breakdown::NoBasis { particle: n, failure } => (
            n,
            format!("point {n} has no shape functions, because {failure}"),
            "a point inside the convex hull of the nodes near it",
        ),
        Breakdown::LeftGrid { particle: n, .. } => (
            n,
            format!("point {n} stands outside the grid of nodes"),
            "a point inside the grid; give it nodes around it, or move it",
        ),
        Breakdown::Domain { particle: n, cells, .. } => (
            n,
            format!("the domain of a particle at point {n} would be {cells} cells long"),
            "--half-length times --stretch above 0 and at most --spacing",
        ),
        other => {
            (0, other.to_string(), "a point and nodes whose distance over --spacing is finite")
        }
    };
    points.fault(n, problem, allowed.to_string())
}

/// A regular grid knows the node of the file at each of its places.
struct Regular<const D: usize> {
    grid: Grid<D>,
    lowest: SVector<f64, D>,
    file_node: Vec<usize>,
}

/// Finds the grid that the nodes form: all places of a box, each taken once.
fn regular_grid<const D: usize>(
    spacing: f64,
    nodes: &Points,
    place: &[SVector<f64, D>],
) -> Result<Regular<D>, Fault> {
    let allowed = || {
        let spacing = shortest(spacing);
        format!(
            "nodes of a full grid with the spacing {spacing}; any nodes with --basis lme, where \
             --support is not box"
        )
    };
    let lowest = place.iter().fold(place[0], |low, x| low.inf(x));
    let highest = place.iter().fold(place[0], |high, x| high.sup(x));
    let extent = highest - lowest;
    let cells: [usize; D] = std::array::from_fn(|d| libm::round(extent[d] / spacing) as usize);
    let count = cells.iter().fold(1.0, |count, n| count * (*n as f64 + 1.0));
    if count != place.len() as f64 || cells.contains(&0) {
        let problem = format!("{} nodes do not fill a box", place.len());
        return Err(nodes.fault(0, problem, allowed()));
    }
    let grid = Grid::new(SVector::repeat(spacing), cells, [0; D], extent);
    let mut file_node = vec![usize::MAX; place.len()];
    for (n, x) in place.iter().enumerate() {
        let s = (x - lowest) / spacing;
        let index = std::array::from_fn(|d| libm::round(s[d]) as usize);
        let off = (0..D).any(|d| libm::fabs(s[d] - index[d] as f64) > 1e-9);
        let I = grid.node(index);
        if off || file_node[I] != usize::MAX {
            return Err(nodes.fault(n, format!("node {n} is off the grid or doubled"), allowed()));
        }
        file_node[I] = n;
    }
    Ok(Regular { grid, lowest, file_node })
}
