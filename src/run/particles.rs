//! Makes the table of all particles at one time.

use super::table::Table;
use crate::method::continuum::state::Particles;
use crate::method::exact::Exact;
use crate::scene::Scene;
use crate::scene::keys::AXES;
use nalgebra::SVector;

/// Names a component: `name` where there is one axis; `name_x`, `name_y` or `name_z` where
/// there are more.
pub fn per_axis(name: &str, axes: usize, i: usize) -> String {
    if axes == 1 { name.to_string() } else { format!("{name}_{}", AXES[i]) }
}

/// Makes the table of every particle in the scene's own coordinates at time `t`; its
/// `reference` (m) is where it stood at t = 0.
pub fn table<const D: usize>(
    scene: &Scene,
    particle: &Particles<D>,
    reference: &[SVector<f64, D>],
    exact: &Option<Exact>,
    t: f64,
) -> Table {
    let mut table = Table::new();
    for p in 0..particle.len() {
        table.put(|| "particle".into(), p as f64);
        for i in 0..D {
            let x = scene.body.origin[i] + particle.x[p][i];
            table.put(|| per_axis("position", D, i), x);
        }
        for i in 0..D {
            table.put(|| per_axis("displacement", D, i), particle.x[p][i] - reference[p][i]);
        }
        for i in 0..D {
            table.put(|| per_axis("velocity", D, i), particle.v[p][i]);
        }
        for (i, j) in (0..D).flat_map(|i| (i..D).map(move |j| (i, j))) {
            let name = || match D {
                1 => "stress".to_string(),
                _ => format!("stress_{}{}", AXES[i], AXES[j]),
            };
            table.put(name, particle.sigma[p][(i, j)]);
        }
        table.put(|| "density".into(), particle.rho[p]);
        table.put(|| "mass".into(), particle.m[p]);
        if let Some(exact) = exact {
            let fields = exact.at(reference[p][0], t);
            table.put(|| "displacement_exact".into(), fields.displacement);
            table.put(|| "velocity_exact".into(), fields.velocity);
            table.put(|| "stress_exact".into(), fields.stress);
        }
        table.end_row();
    }
    table
}
