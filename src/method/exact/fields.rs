//! An exact solution gives these fields at a point.

use nalgebra::{SMatrix, SVector};

/// These are v (m/s), σ (Pa) and u (m) at one material point and time: numbers for a bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fields<Vector = f64, Tensor = f64> {
    pub velocity: Vector,
    pub stress: Tensor,
    pub displacement: Vector,
}

/// These are the fields at a point with D axes.
pub type FieldsIn<const D: usize> = Fields<SVector<f64, D>, SMatrix<f64, D, D>>;

impl std::ops::Add for Fields {
    type Output = Fields;
    fn add(self, other: Fields) -> Fields {
        Fields {
            velocity: self.velocity + other.velocity,
            stress: self.stress + other.stress,
            displacement: self.displacement + other.displacement,
        }
    }
}

impl<const D: usize> From<Fields> for FieldsIn<D> {
    /// Takes the fields of a bar, which has one axis.
    fn from(bar: Fields) -> Self {
        Fields {
            velocity: SVector::repeat(bar.velocity),
            stress: SMatrix::repeat(bar.stress),
            displacement: SVector::repeat(bar.displacement),
        }
    }
}

impl From<FieldsIn<1>> for Fields {
    fn from(point: FieldsIn<1>) -> Self {
        Fields {
            velocity: point.velocity[0],
            stress: point.stress[0],
            displacement: point.displacement[0],
        }
    }
}
