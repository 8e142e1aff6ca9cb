//! An exact solution gives these fields at a point.

/// These are v (m/s), σ (Pa) and u (m) at one material point and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fields {
    pub velocity: f64,
    pub stress: f64,
    pub displacement: f64,
}

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
