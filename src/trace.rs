//! Every intermediate of the first steps of a run, in the paper's order: what a port
//! is held against.
//!
//! A trace takes the steps of a scheme one by one, as the scheme's own function does,
//! and writes down what each of them has made. `tests/trace.rs` holds the two
//! together: after the same number of steps they have the same bits.
#![allow(non_snake_case)]

use crate::continuum::shape::Shape;
use crate::continuum::state::{Nodes, Particles, State};
use crate::continuum::sums;
use crate::cost::Cost;
use crate::fault::{Breakdown, Fault, Moment};
use crate::model::Model;
use crate::otm;
use crate::reading::{StepEight, StressUpdate};
use crate::scene::{Method, Scene};
use crate::time::generalized_alpha::{self, Parameters};
use crate::time::steps::*;
use crate::time::{self, Integrator};
use nalgebra::{SMatrix, SVector};

/// One number of a trace.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// The time step, 0 for the start.
    pub k: usize,
    /// The step of the scheme within it, counted from 1.
    pub step: usize,
    /// As the columns of the table of symbols: `m_I`, `sigma_p`, ….
    pub symbol: &'static str,
    /// The particle; for a nodal quantity the node.
    pub index: usize,
    /// The node of a pair.
    pub node: Option<usize>,
    /// Axes counted from 0: i of a vector, row-wise i D + j of a tensor.
    pub component: usize,
    pub value: f64,
}

/// Columns of a trace.
pub const COLUMNS: [&str; 7] = ["k", "step", "symbol", "index", "node", "component", "value"];

/// Symbols in the paper's order, with the equation, what it is, and the place in the
/// book.
pub const SYMBOLS: [(&str, &str, &str); 29] = [
    ("dt", "T/n", "algorithm.html#time-step"),
    ("N_Ip", "(31) or the basis at hand", "basis.html"),
    ("grad_N_Ip", "(35) or the basis at hand", "basis.html"),
    ("lambda", "(37)", "local-max-ent.html"),
    ("m_I", "(13)", "weak-form.html#eq-13"),
    ("p_I", "the mapped momentum", "weak-form.html"),
    ("v_I", "the velocity of the nodes", "weak-form.html"),
    ("a_I", "(26) mapped", "time-integration.html#eq-26"),
    ("d_eps_p", "(16)", "weak-form.html#eq-16"),
    ("rho_p", "(17)", "weak-form.html#eq-17"),
    ("sigma_p", "(3)", "governing-equations.html#eq-3"),
    ("f_int_I", "(14)", "weak-form.html#eq-14"),
    ("f_ext_I", "(15)", "weak-form.html#eq-15"),
    ("f_I", "(18)", "weak-form.html#eq-18"),
    ("p_I_advanced", "the advanced momentum", "time-integration.html"),
    ("x_p", "(19) or the scheme's own", "time-integration.html"),
    ("v_p", "(19) or the scheme's own", "time-integration.html"),
    ("x_I", "OTM, step 2", "otm.html"),
    // Kernels by themselves, level 0 of the conformance kit.
    ("E", "what is given", "governing-equations.html#eq-3"),
    ("nu", "what is given", "governing-equations.html#eq-3"),
    ("W_p", "½ σ : D⁻¹ : σ", "conservation.html"),
    ("phi", "what is given", "dyka-bar.html#eq-39"),
    ("phi_exact", "what is given", "dyka-bar.html#eq-39"),
    ("rms", "(39)", "dyka-bar.html#eq-39"),
    ("x", "what is given", "riemann.html"),
    ("t", "what is given", "riemann.html"),
    ("v", "(59)", "riemann.html#eq-59"),
    ("sigma", "(59)", "riemann.html#eq-59"),
    ("u", "(59) integrated", "riemann.html#eq-59"),
];

/// Symbols that belong to a particle and a node; all others leave the node out.
pub const PAIRS: [&str; 2] = ["N_Ip", "grad_N_Ip"];

/// Writes entries of one step of one time step.
#[derive(Default)]
pub struct Recorder {
    pub entries: Vec<Entry>,
    k: usize,
    step: usize,
}

impl Recorder {
    /// What follows is of step `step` of time step `k`.
    pub fn at(&mut self, k: usize, step: usize) -> &mut Self {
        (self.k, self.step) = (k, step);
        self
    }

    /// That what was written down since the first `checked` entries are numbers; how
    /// many there are now.
    fn all_finite(&self, checked: usize, moment: Moment) -> Result<usize, Breakdown> {
        let new = &self.entries[checked..];
        let Some(entry) = new.iter().find(|entry| !entry.value.is_finite()) else {
            return Ok(self.entries.len());
        };
        let (symbol, index) = (entry.symbol, entry.index);
        Err(match symbol.ends_with("_I") || symbol.starts_with("p_I") {
            true => Breakdown::NodeNotFinite { node: index, moment, symbol },
            false => Breakdown::NotFinite { particle: index, moment, symbol },
        })
    }

    fn number(&mut self, symbol: &'static str, index: usize, component: usize, value: f64) {
        let (k, step) = (self.k, self.step);
        self.entries.push(Entry { k, step, symbol, index, node: None, component, value });
    }

    /// The components of a vector, or of a tensor by rows.
    pub fn components(&mut self, symbol: &'static str, index: usize, values: &[f64]) {
        for (component, value) in values.iter().enumerate() {
            self.number(symbol, index, component, *value);
        }
    }

    fn numbers(&mut self, symbol: &'static str, list: &[f64]) {
        for (index, value) in list.iter().enumerate() {
            self.number(symbol, index, 0, *value);
        }
    }

    fn vectors<const D: usize>(&mut self, symbol: &'static str, list: &[SVector<f64, D>]) {
        for (index, vector) in list.iter().enumerate() {
            self.components(symbol, index, vector.as_slice());
        }
    }

    fn tensors<const D: usize>(&mut self, symbol: &'static str, list: &[SMatrix<f64, D, D>]) {
        for (index, tensor) in list.iter().enumerate() {
            for i in 0..D {
                for j in 0..D {
                    self.number(symbol, index, i * D + j, tensor[(i, j)]);
                }
            }
        }
    }

    /// N_Ip, ∇N_Ip and, where the basis has one, λ_p in 1/m from `lambda` = λ_p h.
    pub fn shapes<const D: usize>(
        &mut self,
        shape: &Shape<D>,
        lambda: &[SVector<f64, D>],
        h: &SVector<f64, D>,
    ) {
        let (k, step) = (self.k, self.step);
        for (I, p, N_Ip, _) in shape.pairs() {
            let (symbol, node) = ("N_Ip", Some(I));
            self.entries.push(Entry { k, step, symbol, index: p, node, component: 0, value: N_Ip });
        }
        for (I, p, _, grad) in shape.pairs() {
            for (component, value) in grad.iter().copied().enumerate() {
                let (symbol, node) = ("grad_N_Ip", Some(I));
                self.entries.push(Entry { k, step, symbol, index: p, node, component, value });
            }
        }
        let lambda: Vec<SVector<f64, D>> = lambda.iter().map(|l| l.component_div(h)).collect();
        self.vectors("lambda", &lambda);
    }

    fn material<const D: usize>(&mut self, particle: &Particles<D>) {
        self.tensors("d_eps_p", &particle.d_eps);
        self.numbers("rho_p", &particle.rho);
        self.tensors("sigma_p", &particle.sigma);
    }

    /// f_int and f_ext by themselves, then the force that the step has made of them.
    fn forces<const D: usize>(
        &mut self,
        node: &Nodes<D>,
        particle: &Particles<D>,
        shape: &Shape<D>,
        model: &Model<D>,
        t: f64,
    ) {
        let mut own = Nodes::blank(node.len());
        sums::internal_force(&mut own, particle, shape);
        self.vectors("f_int_I", &own.f);
        if let Some(loads) = &model.loads {
            own.f.fill(SVector::zeros());
            sums::external_force(&mut own, particle, shape, loads, t, &mut Cost::default());
            self.vectors("f_ext_I", &own.f);
        }
        self.vectors("f_I", &node.f);
    }
}

/// That a trace of `steps` steps has an end in sight.
///
/// Errors: [`Fault::Argument`] for more steps than the scene has, or more numbers than
/// a trace may hold.
pub fn affordable(scene: &Scene, steps: usize) -> Result<(), Fault> {
    let (particles, nodes, all_steps) = scene.sizes();
    let refuse =
        |problem: String, allowed| Err(Fault::Argument { argument: "--steps", problem, allowed });
    if steps as f64 > all_steps {
        let problem = format!("{steps} steps, and the scene has {all_steps}");
        return refuse(problem, "a whole number up to the number of steps of the scene");
    }
    let D = scene.dimension() as f64;
    let of_particle = scene.pairs_per_particle() * (1.0 + D) + 3.0 * D + 2.0 * D * D + 1.0;
    let numbers = (steps as f64 + 1.0) * (particles * of_particle + nodes * (1.0 + 5.0 * D));
    if numbers > MOST_NUMBERS {
        let problem = format!("{steps} steps of this scene make {numbers:.0e} numbers");
        return refuse(problem, "so many steps that a trace has 30 million numbers at most");
    }
    Ok(())
}

/// Some gigabytes.
const MOST_NUMBERS: f64 = 3e7;

/// Runs the first `steps` steps of a scene and returns everything that they made.
///
/// Errors: [`Breakdown`].
pub fn trace(scene: &Scene, steps: usize) -> Result<Vec<Entry>, Breakdown> {
    match scene.dimension() {
        1 => trace_in::<1>(scene, steps).map(|(entries, _)| entries),
        2 => trace_in::<2>(scene, steps).map(|(entries, _)| entries),
        _ => trace_in::<3>(scene, steps).map(|(entries, _)| entries),
    }
}

/// The same with the state at the end.
pub fn trace_in<const D: usize>(
    scene: &Scene,
    steps: usize,
) -> Result<(Vec<Entry>, State<D>), Breakdown> {
    let model = Model::<D>::of(scene);
    let mut state = model.initial_state(scene);
    let mut recorder = Recorder::default();
    recorder.numbers("dt", &[model.dt]);
    recorder.vectors("x_p", &state.particle.x);
    recorder.vectors("v_p", &state.particle.v);
    let cost = &mut Cost::default();
    match model.method {
        Method::Otm => {
            otm::start(&mut state, &model, cost)?;
            recorder.numbers("m_I", &state.node.m);
            recorder.vectors("v_I", &state.node.v);
        }
        Method::Mpm(Integrator::Newmark(reading)) => {
            newmark(&mut recorder, &mut state, &model, reading, 0.0, Moment::START, cost)?;
        }
        Method::Mpm(_) => time::start(&mut state, &model, cost)?,
    }
    let mut checked = recorder.all_finite(0, Moment::START)?;
    for k in 1..=steps {
        recorder.k = k;
        let moment = Moment { step: k, time: k as f64 * model.dt };
        let (r, s, m, dt) = (&mut recorder, &mut state, &model, model.dt);
        match model.method {
            Method::Otm => otm_step(r, s, m, moment, cost)?,
            Method::Mpm(integrator) => match integrator {
                Integrator::Newmark(reading) => newmark(r, s, m, reading, dt, moment, cost)?,
                Integrator::ForwardEuler(order) => {
                    euler(r, s, m, order, move_with_nodes, moment, cost)?;
                }
                Integrator::CorrectedEuler => {
                    let order = StressUpdate::ModifiedLast;
                    euler(r, s, m, order, move_with_shares, moment, cost)?;
                }
                Integrator::GeneralizedAlpha { rho_b } => alpha(r, s, m, rho_b, moment, cost)?,
            },
        }
        checked = recorder.all_finite(checked, moment)?;
    }
    Ok((recorder.entries, state))
}

fn newmark<const D: usize>(
    r: &mut Recorder,
    State { particle, node, shape, mass, scratch }: &mut State<D>,
    model: &Model<D>,
    reading: StepEight,
    dt: f64,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    r.step = 1;
    predict(particle, node, shape, dt);
    r.vectors("x_p", &particle.x);
    r.vectors("v_p", &particle.v);
    r.step = 2;
    discard(node);
    tabulate(shape, scratch, particle, model, moment, cost)?;
    r.shapes(shape, &scratch.lambda, &model.grid.h);
    r.step = 3;
    transfer(node, mass, particle, shape, moment, cost)?;
    r.numbers("m_I", &node.m);
    r.vectors("p_I", &node.p);
    r.step = 4;
    impose_essential(node, mass, &model.fixed, cost);
    r.vectors("v_I", &node.v);
    r.step = 5;
    increment_strain(particle, node, shape, dt);
    r.tensors("d_eps_p", &particle.d_eps);
    r.step = 6;
    update_density(particle, moment)?;
    r.numbers("rho_p", &particle.rho);
    update_stress(particle, &model.law);
    r.tensors("sigma_p", &particle.sigma);
    r.step = 7;
    balance_forces(node, mass, particle, shape, model, moment.time, cost);
    r.forces(node, particle, shape, model, moment.time);
    r.step = 8;
    integrate_momentum(node, dt, reading);
    r.vectors("p_I_advanced", &node.p);
    r.step = 9;
    correct(particle, node, shape, dt);
    r.vectors("v_p", &particle.v);
    Ok(())
}

/// The steps that the Euler forms and generalized-α begin with.
fn begin<const D: usize>(
    r: &mut Recorder,
    State { particle, node, shape, mass, scratch }: &mut State<D>,
    model: &Model<D>,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    r.step = 1;
    discard(node);
    tabulate(shape, scratch, particle, model, moment, cost)?;
    r.shapes(shape, &scratch.lambda, &model.grid.h);
    r.step = 2;
    transfer(node, mass, particle, shape, moment, cost)?;
    r.numbers("m_I", &node.m);
    r.vectors("p_I", &node.p);
    Ok(())
}

/// How an Euler form moves its particles.
type Mover<const D: usize> = fn(&mut Particles<D>, &Nodes<D>, &Shape<D>, f64);

/// Forward Euler and its corrected form, which moves the particles with shares and
/// has the order of `modified-last`.
fn euler<const D: usize>(
    r: &mut Recorder,
    state: &mut State<D>,
    model: &Model<D>,
    order: StressUpdate,
    move_particles: Mover<D>,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    begin(r, state, model, moment, cost)?;
    let (State { particle, node, shape, mass, .. }, dt) = (state, model.dt);
    r.step = 3;
    impose_essential(node, mass, &model.fixed, cost);
    r.vectors("v_I", &node.v);
    if order == StressUpdate::First {
        update_material(particle, node, shape, model, dt, moment)?;
        r.material(particle);
    }
    r.step = 4;
    balance_forces(node, mass, particle, shape, model, moment.time - dt, cost);
    r.forces(node, particle, shape, model, moment.time - dt);
    r.step = 5;
    advance_momentum(node, dt);
    r.vectors("p_I_advanced", &node.p);
    r.step = 6;
    move_particles(particle, node, shape, dt);
    r.vectors("v_p", &particle.v);
    r.vectors("x_p", &particle.x);
    r.step = 7;
    if order == StressUpdate::ModifiedLast {
        map_momentum_anew(node, particle, shape);
        impose_essential(node, mass, &model.fixed, cost);
        r.vectors("v_I", &node.v);
    }
    if order != StressUpdate::First {
        update_material(particle, node, shape, model, dt, moment)?;
        r.material(particle);
    }
    Ok(())
}

fn alpha<const D: usize>(
    r: &mut Recorder,
    state: &mut State<D>,
    model: &Model<D>,
    rho_b: f64,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    begin(r, state, model, moment, cost)?;
    let State { particle, node, shape, mass, .. } = state;
    let (parameters, dt) = (Parameters::new(rho_b), model.dt);
    r.step = 3;
    map_acceleration(node, mass, particle, shape, &model.fixed, cost);
    r.vectors("a_I", &node.a);
    impose_essential(node, mass, &model.fixed, cost);
    r.vectors("v_I", &node.v);
    r.step = 4;
    balance_forces(node, mass, particle, shape, model, moment.time - dt, cost);
    r.forces(node, particle, shape, model, moment.time - dt);
    r.step = 5;
    generalized_alpha::balance_accelerations(node, &parameters);
    r.vectors("a_I", &node.a_next);
    r.step = 6;
    generalized_alpha::move_particles(particle, node, shape, &parameters, dt);
    r.vectors("v_p", &particle.v);
    r.vectors("x_p", &particle.x);
    r.step = 7;
    generalized_alpha::average_velocity(node, &parameters, dt);
    update_material(particle, node, shape, model, dt, moment)?;
    r.material(particle);
    Ok(())
}

fn otm_step<const D: usize>(
    r: &mut Recorder,
    state: &mut State<D>,
    model: &Model<D>,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    let dt = model.dt;
    let State { particle, node, shape, .. } = state;
    r.step = 1;
    otm::kick(node, 0.5 * dt);
    r.vectors("v_I", &node.v);
    r.step = 2;
    otm::move_nodes(node, dt);
    r.vectors("x_I", &node.x);
    r.step = 3;
    otm::move_particles(particle, node, shape, dt);
    r.vectors("x_p", &particle.x);
    r.step = 4;
    otm::deform(particle, node, shape, model, dt, moment)?;
    r.material(particle);
    r.step = 5;
    otm::tabulate(state, model, moment, cost)?;
    let State { particle, node, shape, mass, scratch } = state;
    r.shapes(shape, &scratch.lambda, &model.grid.h);
    r.step = 6;
    node.f.fill(SVector::zeros());
    balance_forces(node, mass, particle, shape, model, moment.time, cost);
    r.forces(node, particle, shape, model, moment.time);
    r.step = 7;
    otm::kick(node, 0.5 * dt);
    r.vectors("v_I", &node.v);
    otm::show_velocity(particle, node, shape);
    r.vectors("v_p", &particle.v);
    Ok(())
}

/// A number as C's `%a` writes it, exact in every digit.
pub fn hex(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let bits = x.to_bits();
    let sign = if x < 0.0 { "-" } else { "" };
    let (exponent, fraction) = ((bits >> 52) as i64 & 0x7ff, bits & ((1 << 52) - 1));
    let (lead, exponent) = if exponent == 0 { (0, -1022) } else { (1, exponent - 1023) };
    let digits = format!("{fraction:013x}");
    let digits = digits.trim_end_matches('0');
    let point = if digits.is_empty() { "" } else { "." };
    format!("{sign}0x{lead}{point}{digits}p{exponent:+}")
}

/// Reads a decimal number, or one in hexadecimal as [`hex`] writes it.
pub fn number(text: &str) -> Option<f64> {
    let (sign, rest) = match text.strip_prefix(['-', '+']) {
        Some(rest) if text.starts_with('-') => (-1.0, rest),
        Some(rest) => (1.0, rest),
        None => (1.0, text),
    };
    let Some(rest) = rest.strip_prefix("0x").or_else(|| rest.strip_prefix("0X")) else {
        return text.parse().ok();
    };
    let (mantissa, exponent) = rest.split_once(['p', 'P'])?;
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = format!("{whole}{fraction}");
    if digits.is_empty() || digits.len() > 15 || digits.starts_with('+') {
        return None;
    }
    let mantissa = u64::from_str_radix(&digits, 16).ok()? as f64;
    let exponent = exponent.parse::<i32>().ok()?.checked_sub(4 * fraction.len() as i32)?;
    Some(sign * libm::ldexp(mantissa, exponent))
}

/// A trace as CSV; numbers in the shortest decimal that reads back the same, or in
/// hexadecimal.
pub fn csv(entries: &[Entry], in_hex: bool) -> Result<Vec<u8>, Fault> {
    let line = |entry: &Entry| {
        let value = entry.value;
        vec![
            entry.k.to_string(),
            entry.step.to_string(),
            entry.symbol.to_string(),
            entry.index.to_string(),
            entry.node.map_or(String::new(), |node| node.to_string()),
            entry.component.to_string(),
            if in_hex { hex(value) } else { crate::history::shortest(value) },
        ]
    };
    crate::history::csv(&COLUMNS, entries.iter().map(line))
}
