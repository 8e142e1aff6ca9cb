//! The columns of a table have these names.

use crate::scene::keys::AXES;

/// Names a component: `name` where there is one axis; `name_x`, `name_y` or `name_z` where
/// there are more.
pub fn per_axis(name: &str, axes: usize, i: usize) -> String {
    if axes == 1 { name.to_string() } else { format!("{name}_{}", AXES[i]) }
}

/// Names a component of the stress: `stress` in 1D; `stress_xx`, `stress_xy`, … else.
pub fn of_stress(axes: usize, i: usize, j: usize) -> String {
    if axes == 1 { "stress".to_string() } else { format!("stress_{}{}", AXES[i], AXES[j]) }
}

/// Lists the components of a symmetric tensor on and above its diagonal.
pub fn upper_half(axes: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..axes).flat_map(move |i| (i..axes).map(move |j| (i, j)))
}
