//! A point sees some nodes, and some of those share its weight.

use super::failure::Failure;
use nalgebra::{SMatrix, SVector};

/// Faces tell for each axis whether x lies on a flat side of the hull that is normal to it: ±1
/// for the direction to the inside, else 0.
pub type Faces<const D: usize> = [f64; D];

/// This holds the nodes that a point sees. Those that share its weight are found by [`share`].
#[derive(Clone, Debug, PartialEq)]
pub struct Seen<const D: usize> {
    /// The numbers I of the nodes.
    pub I: Vec<usize>,
    /// ξ_I = (x − x_I)/h.
    pub xi: Vec<SVector<f64, D>>,
    /// (x_b − x_I)/h for one node b near x: whole numbers on a grid.
    pub offset: Vec<SVector<f64, D>>,
    /// All offsets are whole numbers.
    pub on_grid: bool,
    /// Which of the nodes is node 0, where it is not to be the nearest.
    pub base: Option<usize>,
    /// The sides of the hull that x lies on.
    pub faces: Faces<D>,
    /// The node on which x lies exactly.
    pub on_node: Option<usize>,
    /// Which of the nodes share the weight, but for `on_node`.
    pub sharing: Vec<usize>,
    /// ξ_0 of node 0, the nearest of those that share the weight.
    pub xi_0: SVector<f64, D>,
    /// a_I = (x_0 − x_I)/h of the nodes in `sharing`.
    pub a: Vec<SVector<f64, D>>,
    /// The largest |a_I| along an axis.
    pub reach: f64,
}

impl<const D: usize> Default for Seen<D> {
    fn default() -> Self {
        Seen {
            I: Vec::new(),
            xi: Vec::new(),
            offset: Vec::new(),
            on_grid: false,
            base: None,
            faces: [0.0; D],
            on_node: None,
            sharing: Vec::new(),
            xi_0: SVector::zeros(),
            a: Vec::new(),
            reach: 0.0,
        }
    }
}

impl<const D: usize> Seen<D> {
    /// Forgets all nodes. `on_grid` promises that all offsets to come are whole numbers.
    pub fn clear(&mut self, on_grid: bool) {
        self.I.clear();
        self.xi.clear();
        self.offset.clear();
        (self.on_grid, self.base) = (on_grid, None);
    }

    /// Adds node I with (x − x_I)/h and its offset. A distance along an axis below 1e-150 h is
    /// none: its square would have no number.
    pub fn push(&mut self, I: usize, xi: SVector<f64, D>, offset: SVector<f64, D>) {
        self.I.push(I);
        self.xi.push(xi.map(|xi| if libm::fabs(xi) < 1e-150 { 0.0 } else { xi }));
        self.offset.push(offset);
    }

    /// Gives the largest |ξ_I| along an axis.
    pub fn size(&self) -> f64 {
        self.xi.iter().map(|xi| xi.amax()).fold(0.0, f64::max)
    }
}

/// Finds the nodes that share the weight, those on all faces of x, and where they stand
/// relative to the nearest of them.
///
/// A node on which x lies exactly is not listed: ξ_I = 0 adds nothing to r. The others
/// alone fix λ, even where their weights are too small for a number.
///
/// Errors: [`Failure::OutsideHull`].
pub fn share<const D: usize>(seen: &mut Seen<D>) -> Result<(), Failure> {
    seen.faces = faces(&seen.xi)?;
    let Seen { xi, offset, faces, sharing, a, .. } = seen;
    sharing.clear();
    let inside = *faces == [0.0; D];
    let (mut nearest, mut least) = (None, f64::INFINITY);
    for (n, xi) in xi.iter().enumerate() {
        if inside || (0..D).all(|d| faces[d] == 0.0 || xi[d] == 0.0) {
            sharing.push(n);
            let square = xi.dot(xi);
            if square < least {
                (nearest, least) = (Some(n), square);
            }
        }
    }
    // On two faces at once x is a corner of the box, which may hold no node.
    let nearest = nearest.ok_or(Failure::OutsideHull)?;
    seen.on_node = (least == 0.0).then_some(nearest);
    let nearest = seen.base.filter(|base| sharing.contains(base)).unwrap_or(nearest);
    seen.xi_0 = xi[nearest];
    if seen.on_node.is_some() {
        sharing.retain(|n| Some(*n) != seen.on_node);
    }
    a.clear();
    a.extend(sharing.iter().map(|n| offset[*n] - offset[nearest]));
    seen.reach = a.iter().map(|a| a.amax()).fold(0.0, f64::max);
    Ok(())
}

/// Finds the flat sides that x lies on. Outside the box of the nodes is outside
/// their hull.
fn faces<const D: usize>(xi: &[SVector<f64, D>]) -> Result<Faces<D>, Failure> {
    let mut faces = [0.0; D];
    for d in 0..D {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for xi in xi {
            low = low.min(xi[d]);
            high = high.max(xi[d]);
        }
        faces[d] = match (low, high) {
            (low, high) if !(low <= 0.0 && 0.0 <= high) || low == high => {
                return Err(Failure::OutsideHull);
            }
            (_, 0.0) => 1.0,
            (0.0, _) => -1.0,
            _ => 0.0,
        };
    }
    Ok(faces)
}

/// Puts a 1 into the row and column of J that are empty on a face; the rest is left alone.
pub fn fill_faces<const D: usize>(J: &mut SMatrix<f64, D, D>, faces: &Faces<D>) {
    for d in (0..D).filter(|d| faces[*d] != 0.0) {
        J[(d, d)] = 1.0;
    }
}

/// Tells whether all nodes lie strictly on one side of the plane through x with the normal
/// λ: then log Z has no minimum.
pub fn separates<const D: usize>(lambda: &SVector<f64, D>, seen: &Seen<D>) -> bool {
    seen.sharing.iter().all(|n| lambda.dot(&seen.xi[*n]) < 0.0)
}
