//! A basis keeps its working space from table to table, so that nothing is allocated anew.

use super::bins::Bins;
use super::ddmp::Duals;
use super::lme::{AxisFunctions, Lme};
use crate::method::continuum::shape::Shape;
use crate::method::cost::Cost;

/// This is the working space of local max-ent and of the dual domain method; the other bases need
/// none.
#[derive(Clone, Debug, PartialEq)]
pub struct Scratch<const D: usize> {
    pub(super) lme: Lme<D>,
    /// Local max-ent along one axis; where it needs the general search, that and its row.
    pub(super) axes: [AxisFunctions; D],
    pub(super) axis_lme: Lme<1>,
    pub(super) axis_row: Shape<1>,
    /// Nodes that move, sorted for the search.
    pub(super) bins: Bins<D>,
    pub(super) duals: Duals<D>,
    /// Candidates looked at so far.
    pub(super) cost: Cost,
}

impl<const D: usize> Default for Scratch<D> {
    fn default() -> Self {
        Scratch {
            lme: Lme::default(),
            axes: std::array::from_fn(|_| AxisFunctions::default()),
            axis_lme: Lme::default(),
            axis_row: Shape::default(),
            bins: Bins::default(),
            duals: Duals::default(),
            cost: Cost::default(),
        }
    }
}

impl<const D: usize> Scratch<D> {
    /// Counts candidates, exponentials and Newton iterations so far.
    pub fn cost(&self) -> Cost {
        let of_axes = self.axes.iter().fold(self.axis_lme.cost(), |sum, axis| sum + axis.cost);
        self.cost + self.lme.cost() + of_axes
    }
}
