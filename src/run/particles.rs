//! Makes the table of all particles at one time.

use super::columns::{of_stress, per_axis, upper_half};
use super::table::Table;
use crate::method::continuum::state::Particles;
use crate::method::exact::Exact;
use crate::scene::Scene;
use nalgebra::SVector;

/// Makes the table of every particle in the scene's own coordinates at time `t`; its
/// `reference` (m) is its material point.
pub fn table<const D: usize>(
    scene: &Scene,
    particle: &Particles<D>,
    reference: &[SVector<f64, D>],
    exact: &Option<Exact<D>>,
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
            table.put(|| per_axis("displacement", D, i), particle.u[p][i]);
        }
        for i in 0..D {
            table.put(|| per_axis("velocity", D, i), particle.v[p][i]);
        }
        for (i, j) in upper_half(D) {
            table.put(|| of_stress(D, i, j), particle.sigma[p][(i, j)]);
        }
        table.put(|| "density".into(), particle.rho[p]);
        table.put(|| "mass".into(), particle.m[p]);
        if let Some(exact) = exact {
            let fields = exact.at(&reference[p], t);
            for i in 0..D {
                let name = || format!("{}_exact", per_axis("displacement", D, i));
                table.put(name, fields.displacement[i]);
            }
            for i in 0..D {
                let name = || format!("{}_exact", per_axis("velocity", D, i));
                table.put(name, fields.velocity[i]);
            }
            for (i, j) in upper_half(D) {
                table.put(|| format!("{}_exact", of_stress(D, i, j)), fields.stress[(i, j)]);
            }
        }
        table.end_row();
    }
    table
}
