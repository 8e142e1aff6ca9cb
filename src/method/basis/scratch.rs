//! A basis keeps its working space from table to table, so that nothing is allocated anew.

use super::bins::Bins;
use super::lme::Lme;
use crate::method::continuum::shape::Shape;
use crate::method::cost::Cost;

/// This is the working space of local max-ent; the other bases need none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scratch<const D: usize> {
    pub(super) lme: Lme<D>,
    /// Local max-ent along one axis, and a row of it for each axis.
    pub(super) axis_lme: Lme<1>,
    pub(super) axes: Shape<1>,
    /// Nodes that move, sorted for the search.
    pub(super) bins: Bins<D>,
    /// Candidates looked at so far.
    pub(super) cost: Cost,
}

impl<const D: usize> Scratch<D> {
    /// Counts candidates, exponentials and Newton iterations so far.
    pub fn cost(&self) -> Cost {
        self.cost + self.lme.cost() + self.axis_lme.cost()
    }
}
