//! This is the whole method in one file: the paper's Algorithm for the elastic bar of §6.
//!
//! Read this file before all others. It has numbers, lists and loops, and the paper's
//! letters: the index is the subscript, so m_I is `m_I[I]` and x_p is `x_p[p]`. The rest
//! of the library does the same steps in 1D to 3D, for more bases, schemes and loads;
//! `tests/one_bar.rs` holds this file to it.

/// The bar is elastic, lies on 0 ≤ x ≤ L, is fixed at x = 0 and free at x = L.
pub struct OneBar {
    /// L (m), ρ (kg/m³) and E (Pa).
    pub length: f64,
    pub density: f64,
    pub youngs_modulus: f64,
    /// The material from here on (m) is thrown with this velocity (m/s).
    pub thrown_from: f64,
    pub velocity: f64,
    pub cells: usize,
    pub particles_per_cell: usize,
    /// Δt (s) and N_t.
    pub dt: f64,
    pub steps: usize,
}

/// A snapshot holds all particles at one k: x_p (m), v_p (m/s), σ_p (Pa), ρ_p (kg/m³).
pub type Snapshot = [Vec<f64>; 4];

// ANCHOR: one_bar
/// Runs the bar and returns its particles at k = 0, 1, …, N_t; with the linear basis, or
/// with local max-ent for `gamma` = γ. There is no answer when a particle leaves the grid
/// or stands where a node without mass is divided by, or when the plain search for λ fails,
/// as it does from γ = 6 or so. All nine steps stand in one piece to be read in one go,
/// which is why this function is long.
pub fn one_bar(bar: &OneBar, gamma: Option<f64>) -> Option<Vec<Snapshot>> {
    let h = bar.length / bar.cells as f64;
    let nodes = bar.cells + 2; // one cell more beyond the free end; node I stands at I h
    let particles = bar.cells * bar.particles_per_cell;
    let share = h / bar.particles_per_cell as f64; // of the bar, for each particle
    let m_p = bar.density * share;
    let mut x_p: Vec<f64> = (0..particles).map(|p| (p as f64 + 0.5) * share).collect();
    let thrown = |x: &f64| if *x >= bar.thrown_from { bar.velocity } else { 0.0 };
    let mut v_p: Vec<f64> = x_p.iter().map(thrown).collect();
    let mut sigma_p = vec![0.0; particles];
    let mut rho_p = vec![bar.density; particles];
    let (mut m_I, mut p_I, mut f_I) = (vec![0.0; nodes], vec![0.0; nodes], vec![0.0; nodes]);
    let mut shape = vec![Vec::new(); particles]; // (I, N_Ip, ∇N_Ip) of each particle
    let mut history = Vec::new();
    for k in 0..=bar.steps {
        // The time step k = 0 moves nothing: it gives the nodes their first values.
        let dt = if k == 0 { 0.0 } else { bar.dt };
        // ANCHOR: one_bar_predict
        // Step 1, the predictor: (27) and (28), with γ = ½ and the nodal values of k. From here
        // to step 9 `v_p` holds the predicted velocity ṽ_p.
        for p in 0..particles {
            let (mut v, mut a) = (0.0, 0.0);
            for &(I, N_Ip, _) in &shape[p] {
                v += p_I[I] * (N_Ip / m_I[I]);
                a += f_I[I] * (N_Ip / m_I[I]);
            }
            x_p[p] += v * dt + a * (0.5 * dt * dt);
            v_p[p] += a * (0.5 * dt);
        }
        // ANCHOR_END: one_bar_predict
        // ANCHOR: one_bar_to_nodes
        // Step 2: the nodes forget, and the particles look around where they are now.
        m_I.fill(0.0);
        p_I.fill(0.0);
        f_I.fill(0.0);
        for p in 0..particles {
            shape[p] = match gamma {
                None => linear(x_p[p], h, nodes),
                Some(gamma) => local_max_ent(x_p[p], h, nodes, gamma),
            }?;
        }
        // Step 3: (13) lumped by rows, and the momentum p̃_I of the predicted velocities.
        for p in 0..particles {
            for &(I, N_Ip, _) in &shape[p] {
                m_I[I] += m_p * N_Ip;
                p_I[I] += v_p[p] * (m_p * N_Ip);
            }
        }
        // ANCHOR_END: one_bar_to_nodes
        // ANCHOR: one_bar_strain
        // Step 4: the essential boundary condition; then ṽ_I = p̃_I / m_I.
        p_I[0] = 0.0;
        for p in 0..particles {
            // Step 5: (16), the strain increment.
            let mut d_eps = 0.0;
            for &(I, _, grad_N_Ip) in &shape[p] {
                d_eps += dt * grad_N_Ip * (p_I[I] / m_I[I]);
            }
            // Step 6: (17), the density; and (3), the stress, which the paper forgets.
            rho_p[p] /= 1.0 + d_eps;
            sigma_p[p] += bar.youngs_modulus * d_eps;
        }
        // ANCHOR_END: one_bar_strain
        // ANCHOR: one_bar_push
        // Step 7: (14), the internal forces; there are no others.
        for p in 0..particles {
            for &(I, _, grad_N_Ip) in &shape[p] {
                f_I[I] -= sigma_p[p] * grad_N_Ip * (m_p / rho_p[p]);
            }
        }
        f_I[0] = 0.0;
        // Step 8: the nodal momentum, half of f_I Δt for second order (as printed, all).
        for I in 0..nodes {
            p_I[I] += f_I[I] * (0.5 * dt);
        }
        // ANCHOR_END: one_bar_push
        // ANCHOR: one_bar_to_particles
        // Step 9, the corrector: (29), with the new forces; now `v_p` is v_p again.
        for p in 0..particles {
            for &(I, N_Ip, _) in &shape[p] {
                v_p[p] += f_I[I] * (N_Ip / m_I[I]) * (0.5 * dt);
            }
        }
        // ANCHOR_END: one_bar_to_particles
        if v_p.iter().any(|v| !v.is_finite()) {
            return None; // a particle exactly on a node beside one without mass
        }
        history.push([x_p.clone(), v_p.clone(), sigma_p.clone(), rho_p.clone()]);
    }
    Some(history)
}

// ANCHOR: one_bar_hat
/// Gives (I, N_I, ∇N_I) of the linear basis for the two nodes beside x.
fn linear(x: f64, h: f64, nodes: usize) -> Option<Vec<(usize, f64, f64)>> {
    let cell = (x / h) as usize;
    let xi = (x - cell as f64 * h) / h;
    let row = vec![(cell, 1.0 - xi, -1.0 / h), (cell + 1, xi, 1.0 / h)];
    (x >= 0.0 && cell + 1 < nodes).then_some(row)
}
// ANCHOR_END: one_bar_hat
// ANCHOR_END: one_bar

// ANCHOR: one_bar_lme
/// Gives (I, N_I, ∇N_I) of local max-ent, (31)-(37), for the nodes within the cut-off radius,
/// by Newton's method from λ = 0.
fn local_max_ent(x: f64, h: f64, nodes: usize, gamma: f64) -> Option<Vec<(usize, f64, f64)>> {
    let beta = gamma / (h * h);
    let from = |I: usize| x - I as f64 * h; // x − x_I
    let seen: Vec<usize> =
        (0..nodes).filter(|I| libm::exp(-beta * from(*I) * from(*I)) >= 1e-6).collect();
    let mut lambda = 0.0;
    for _ in 0..50 {
        let weight = |I: &usize| libm::exp(-beta * from(*I) * from(*I) + lambda * from(*I));
        let Z: f64 = seen.iter().map(weight).sum(); // (32)
        let p: Vec<f64> = seen.iter().map(|I| weight(I) / Z).collect(); // (31)
        let r: f64 = seen.iter().zip(&p).map(|(I, p)| p * from(*I)).sum(); // (37)
        let square = |(I, p): (&usize, &f64)| p * (from(*I) - r) * (from(*I) - r);
        let J: f64 = seen.iter().zip(&p).map(square).sum(); // (36)
        if r.abs() < 1e-14 * h {
            let grad = |p: f64, I: usize| -p / J * from(I); // (35), where r = 0
            return Some(seen.iter().zip(p).map(|(I, p)| (*I, p, grad(p, *I))).collect());
        }
        lambda -= r / J;
    }
    None
}
// ANCHOR_END: one_bar_lme
