//! The bar between two walls that swings across cells: the motion that tells the methods apart.

use super::{Each, MANUFACTURED, advance, at_start, march, scene};
use lme_mpm::method::breakdown::Breakdown;
use lme_mpm::output::summary::Scales;
use lme_mpm::scene::Scene;
use lme_mpm::setup;

/// The motion across ten of its 160 cells, with linear functions, the lumped mass matrix, and the
/// changes `KEY=VALUE`.
pub fn crossing(sets: &[&str]) -> Scene {
    scene(&MANUFACTURED.replace("\"lme\"\ngamma = 0.8\n", "\"linear\"\n"), sets)
}

/// Root of the mean square over particles and time of the relative errors of v, σ and u.
pub fn over_time(scene: &Scene) -> Result<Each<f64>, Breakdown> {
    let (model, mut state) = at_start::<1>(scene);
    let (exact, X) = (setup::exact::<1>(scene).unwrap(), setup::material_points::<1>(scene));
    let scales = Scales::of(scene);
    let mut sums = [0.0; 3];
    march(&model, &mut state, 0);
    for step in 1..=model.steps {
        advance(&model, &mut state, step)?;
        for (p, X_p) in X.iter().enumerate() {
            let right = exact.at(X_p, step as f64 * model.dt);
            let particle = &state.particle;
            sums[0] += ((particle.v[p] - right.velocity)[0] / scales.velocity).powi(2);
            sums[1] += ((particle.sigma[p] - right.stress)[0] / scales.stress).powi(2);
            sums[2] += ((particle.u[p] - right.displacement)[0] / scales.displacement).powi(2);
        }
    }
    let [v, sigma, u] = sums.map(|sum| (sum / (model.steps * X.len()) as f64).sqrt());
    Ok(Each { v, sigma, u })
}
