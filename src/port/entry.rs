//! A trace is made of entries; they have symbols, and a form as CSV.

use crate::method::basis::Basis;
use crate::method::basis::anisotropic::Metric;
use crate::method::breakdown::Breakdown;
use crate::method::continuum::shape::Shape;
use crate::method::continuum::state::{Nodes, Particles};
use crate::method::continuum::sums;
use crate::method::model::{Model, State};
use crate::method::reading::Kinematics;
use crate::method::reconstruction::internal_force;
use crate::run::table;
use crate::scene::Scene;
use crate::scene::fault::Fault;
use nalgebra::{SMatrix, SVector};

/// An entry is one number of a trace.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// The time step, 0 for the start.
    pub k: usize,
    /// The step of the scheme within it, counted from 1; 0 for what is given, and for OTM's
    /// start.
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

/// An address says where an entry stands in a trace: k, step, symbol, index, node, component.
pub type Address = (usize, usize, &'static str, usize, Option<usize>, usize);

/// Gives the address of an entry.
pub fn address(entry: &Entry) -> Address {
    let Entry { k, step, symbol, index, node, component, .. } = *entry;
    (k, step, symbol, index, node, component)
}

/// A trace has these columns.
pub const COLUMNS: [&str; 7] = ["k", "step", "symbol", "index", "node", "component", "value"];

/// Symbols stand in the paper's order, what is given first, each with its equation or what it
/// is, and its place in the book. Places come before what is made at them.
pub const SYMBOLS: [(&str, &str, &str); 35] = [
    ("dt", "T/n", "algorithm.html#time-step"),
    ("E", "what is given", "governing-equations.html#eq-3"),
    ("nu", "what is given", "governing-equations.html#eq-3"),
    ("h", "what is given", "grid.html#nodes"),
    ("gamma", "what is given", "local-max-ent.html"),
    ("m_p", "ρ times its share of the body", "grid.html#particles"),
    ("x_I", "OTM, step 2", "otm.html"),
    ("x_p", "(19) or the scheme's own", "time-integration.html"),
    ("N_Ip", "(31) or the basis at hand", "basis.html"),
    ("grad_N_Ip", "(35) or the basis at hand", "basis.html"),
    ("lambda", "(37)", "local-max-ent.html"),
    ("m_I", "(13)", "weak-form.html#eq-13"),
    ("p_I", "the mapped momentum", "weak-form.html"),
    ("v_I", "the velocity of the nodes", "weak-form.html"),
    ("a_I", "(26) mapped", "time-integration.html#eq-26"),
    ("G_p", "the gradient of a step's displacement", "finite-strain.html"),
    ("d_eps_p", "(16)", "weak-form.html#eq-16"),
    ("F_p", "the deformation gradient", "finite-strain.html"),
    ("rho_p", "(17)", "weak-form.html#eq-17"),
    ("sigma_p", "(3)", "governing-equations.html#eq-3"),
    ("f_int_I", "(14)", "weak-form.html#eq-14"),
    ("f_ext_I", "(15)", "weak-form.html#eq-15"),
    ("f_I", "(18)", "weak-form.html#eq-18"),
    ("p_I_advanced", "the advanced momentum", "time-integration.html"),
    ("a_p", "(18) at the particle, or (26)", "time-integration.html#eq-26"),
    ("v_p", "(19) or the scheme's own", "time-integration.html"),
    // Kernels by themselves, level 0 of the conformance kit.
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

/// These symbols belong to a particle and a node; all others leave the node out.
pub const PAIRS: [&str; 2] = ["N_Ip", "grad_N_Ip"];

/// A trace recorder writes the entries of one step of one time step after the other.
#[derive(Default)]
pub struct TraceRecorder {
    pub entries: Vec<Entry>,
    k: usize,
    step: usize,
}

impl TraceRecorder {
    /// Says that what follows is of step `step` of time step `k`.
    pub fn at(&mut self, k: usize, step: usize) -> &mut Self {
        (self.k, self.step) = (k, step);
        self
    }

    /// Checks that what this time step has written down are numbers.
    ///
    /// Errors: [`Breakdown::NodeNotFinite`], [`Breakdown::NotFinite`].
    pub(super) fn finite(&self) -> Result<(), Breakdown> {
        let new = &self.entries[self.entries.partition_point(|entry| entry.k < self.k)..];
        let Some(entry) = new.iter().find(|entry| !entry.value.is_finite()) else {
            return Ok(());
        };
        let (symbol, index) = (entry.symbol, entry.index);
        Err(match symbol.ends_with("_I") || symbol.starts_with("p_I") {
            true => Breakdown::NodeNotFinite { node: index, symbol },
            false => Breakdown::NotFinite { particle: index, symbol },
        })
    }

    /// Writes what a scene gives: Δt, E, ν, h, γ of local max-ent, and the particles (with OTM
    /// the nodes' places, too) at the start.
    pub fn given<const D: usize>(&mut self, scene: &Scene, state: &State<D>, model: &Model<D>) {
        self.at(0, 0).numbers("dt", &[model.dt]);
        self.numbers("E", &[scene.body.youngs_modulus]);
        self.numbers("nu", &[scene.body.poisson_ratio]);
        self.vectors("h", &[model.grid.h]);
        if let Basis::Lme { gamma, .. } = model.basis {
            self.numbers("gamma", &[gamma]);
        }
        for symbol in ["m_p", "x_I", "x_p", "F_p", "rho_p", "sigma_p", "v_p"] {
            self.symbol(symbol, state, model, 0.0);
        }
    }

    /// Writes what `symbol` has become in a state; loads are those of `t` (s): one table, which is
    /// why this function is long.
    pub fn symbol<const D: usize>(
        &mut self,
        symbol: &'static str,
        State { particle, node, shape, .. }: &State<D>,
        model: &Model<D>,
        t: f64,
    ) {
        match symbol {
            "N_Ip" => self.shapes(shape),
            "grad_N_Ip" => self.gradients(shape),
            "lambda" => {
                let known = particle.lambda.iter().filter(|_| model.basis.traits().multiplier);
                let h = &model.grid.h;
                self.multipliers(known.enumerate().map(|(p, known)| {
                    Metric { h, A: particle.pull.get(p) }.gradient(&known.lambda)
                }));
            }
            "m_I" => self.numbers(symbol, &node.m),
            "p_I" | "p_I_advanced" => self.vectors(symbol, &node.p),
            "v_I" => self.vectors(symbol, &node.v),
            "a_I" => self.vectors(symbol, &node.a_last),
            "a_I_next" => self.vectors("a_I", &node.a_next),
            "x_I" => self.vectors(symbol, &node.x),
            "f_I" => self.vectors(symbol, &node.f),
            "f_int_I" => {
                let mut own = Nodes::blank(node.len());
                let rule = model.reconstruction;
                internal_force(&mut own, particle, shape, &model.grid, rule);
                self.vectors(symbol, &own.f);
            }
            "f_ext_I" => {
                if let Some(loads) = &model.loads {
                    let mut own = Nodes::blank(node.len());
                    sums::external_force(&mut own, particle, shape, loads, t);
                    self.vectors(symbol, &own.f);
                }
            }
            "G_p" | "d_eps_p" | "d_eps_p_printed" | "d_eps_p_of_map" => {
                self.strain(symbol, particle, model);
            }
            "F_p" => self.tensors(symbol, &particle.F),
            "rho_p" => self.numbers(symbol, &particle.rho),
            "sigma_p" => self.tensors(symbol, &particle.sigma),
            "x_p" => self.vectors(symbol, &particle.x),
            "a_p" => self.vectors(symbol, &particle.a),
            "m_p" => self.numbers(symbol, &particle.m),
            _ => self.vectors("v_p", &particle.v),
        }
    }

    /// Writes what the material is strained by: Δε_p, unless the law is hyperelastic, and G_p
    /// where it says more. Newmark's method makes Δε_p in step 5 as printed, and in step 6 from
    /// the map.
    fn strain<const D: usize>(
        &mut self,
        symbol: &'static str,
        particle: &Particles<D>,
        model: &Model<D>,
    ) {
        let rate = !model.law.law.is_hyperelastic();
        let of_map = model.kinematics == Kinematics::Consistent;
        let (wanted, name, list) = match symbol {
            "G_p" => (model.keeps_gradient(), symbol, &particle.G),
            "d_eps_p_printed" => (rate && !of_map, "d_eps_p", &particle.d_eps),
            "d_eps_p_of_map" => (rate && of_map, "d_eps_p", &particle.d_eps),
            _ => (rate, symbol, &particle.d_eps),
        };
        if wanted {
            self.tensors(name, list);
        }
    }

    fn number(&mut self, symbol: &'static str, index: usize, component: usize, value: f64) {
        let (k, step) = (self.k, self.step);
        self.entries.push(Entry { k, step, symbol, index, node: None, component, value });
    }

    /// Writes the components of a vector, or of a tensor by rows.
    pub fn components(&mut self, symbol: &'static str, index: usize, values: &[f64]) {
        for (component, value) in values.iter().enumerate() {
            self.number(symbol, index, component, *value);
        }
    }

    pub(super) fn numbers(&mut self, symbol: &'static str, list: &[f64]) {
        for (index, value) in list.iter().enumerate() {
            self.number(symbol, index, 0, *value);
        }
    }

    pub(super) fn vectors<const D: usize>(
        &mut self,
        symbol: &'static str,
        list: &[SVector<f64, D>],
    ) {
        for (index, vector) in list.iter().enumerate() {
            self.components(symbol, index, vector.as_slice());
        }
    }

    pub(super) fn tensors<const D: usize>(
        &mut self,
        symbol: &'static str,
        list: &[SMatrix<f64, D, D>],
    ) {
        for (index, tensor) in list.iter().enumerate() {
            for i in 0..D {
                for j in 0..D {
                    self.number(symbol, index, i * D + j, tensor[(i, j)]);
                }
            }
        }
    }

    fn pair(&mut self, symbol: &'static str, p: usize, I: usize, component: usize, value: f64) {
        let (k, step, node) = (self.k, self.step, Some(I));
        self.entries.push(Entry { k, step, symbol, index: p, node, component, value });
    }

    /// Writes N_Ip.
    pub fn shapes<const D: usize>(&mut self, shape: &Shape<D>) {
        for (I, p, N_Ip, _) in shape.pairs() {
            self.pair("N_Ip", p, I, 0, N_Ip);
        }
    }

    /// Writes ∇N_Ip (1/m).
    pub fn gradients<const D: usize>(&mut self, shape: &Shape<D>) {
        for (I, p, _, grad_N_Ip) in shape.pairs() {
            for (component, value) in grad_N_Ip.iter().enumerate() {
                self.pair("grad_N_Ip", p, I, component, *value);
            }
        }
    }

    /// Writes λ_p (1/m).
    pub fn multipliers<const D: usize>(&mut self, lambda: impl Iterator<Item = SVector<f64, D>>) {
        let lambda: Vec<_> = lambda.collect();
        self.vectors("lambda", &lambda);
    }
}

/// Writes a number as C's `%a` does, exact in every digit.
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

/// Writes a trace as CSV; numbers in the shortest decimal that reads back the same, or in
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
            if in_hex { hex(value) } else { table::shortest(value) },
        ]
    };
    table::csv(&COLUMNS, entries.iter().map(line))
}
