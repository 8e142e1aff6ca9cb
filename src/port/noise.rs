//! Says how large round-off is allowed to be: for each symbol a floor, from what the reference
//! gives, below which a difference means nothing.
//!
//! The strain of a body that only flies is 0 but for the last digits of Δt v/h; a node that has
//! hardly any mass has a velocity without digits. [`FLOORS`] says each in words.

use super::entry::Entry;
use std::collections::{BTreeSet, HashMap};

/// Floors stand here in words, symbol by symbol.
pub const FLOORS: [(&str, &str); 11] = [
    (
        "where",
        "V is the largest |v_p| so far, where F_p is kept at least h/Δt, q_I = h Σ_p m_p |∇N_Ip|/m_I from 1 to 1e15, W the largest mean of q_I that a \
         particle's ∇N_Ip have weighed so far, e_p = Δt V Σ_I |∇N_Ip| q_I of this table or the last and at least Δt V W/h, M = λ + 2μ, F the largest \
         force or floor of one, X = Σ_k Δt V W; of v_p, x, ρ the values in the reference",
    ),
    ("v_I", "(V + Δt F/m) q_I, at least V W; m is the mass of the heaviest node"),
    ("a_I", "(F/m) q_I, or the largest a_p in place of F/m"),
    ("d_eps_p, G_p", "e_p"),
    ("F_p", "1, or the largest e_p so far"),
    ("rho_p", "ρ, or ρ times the largest e_p so far"),
    ("sigma_p", "M times the largest e_p so far; M where F_p is kept, whose digits are those of 1"),
    (
        "f_int_I, f_ext_I, f_I",
        "Σ_p |∇N_Ip| (m_p/ρ) times the floor of σ_p, or the largest of all three",
    ),
    ("a_p", "F over the smallest m_p"),
    ("v_p, p_I, p_I_advanced", "V W + Δt F/m_p; m V W; m V W + Δt F"),
    (
        "x_p, x_I, N_Ip, m_I, grad_N_Ip, lambda",
        "x, the largest place, at least h, plus X; x/h; m x/h; x/h²; 2γ x/h²",
    ),
];

/// Where more digits of a node's mass are lost than this, its velocity has none, and is one of
/// those that its particles have.
const MOST: f64 = 1e15;

/// A scale is the largest value of a symbol in a time step, or its floor.
#[derive(Default)]
pub struct Floors {
    largest: HashMap<(usize, &'static str), f64>,
    /// Of all indices of a symbol in a time step.
    of_symbol: HashMap<(usize, &'static str), f64>,
    /// Of one particle or node.
    of_index: HashMap<(usize, &'static str, usize), f64>,
}

/// A scene gives Δt, the smallest h, λ + 2μ, γ, and the particles' masses.
struct Given {
    dt: f64,
    h: f64,
    modulus: f64,
    gamma: f64,
    m_p: HashMap<usize, f64>,
    rho: f64,
}

impl Given {
    fn of(reference: &[Entry]) -> Option<Given> {
        let at_start = |symbol: &'static str| {
            reference.iter().filter(move |e| (e.k, e.step, e.symbol) == (0, 0, symbol))
        };
        let least = |symbol| at_start(symbol).map(|e| e.value).reduce(f64::min);
        let (E, nu) = (least("E")?, least("nu")?);
        Some(Given {
            dt: least("dt")?,
            h: least("h")?,
            modulus: E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            gamma: least("gamma").unwrap_or(1.0),
            m_p: at_start("m_p").map(|e| (e.index, e.value)).collect(),
            rho: least("rho_p")?,
        })
    }
}

/// What runs from time step to time step: the largest velocity, the nodes' masses, ∇N of this
/// table and of the last one, and the floors of strain and acceleration so far.
#[derive(Default)]
struct Running {
    V: f64,
    m_I: HashMap<usize, f64>,
    /// The largest of them (kg).
    m: f64,
    /// h Σ_p m_p |∇N_Ip| of this table.
    slopes: HashMap<usize, f64>,
    tables: [Vec<(usize, usize, f64)>; 2],
    e_p: HashMap<usize, f64>,
    /// The largest W so far, which what a light node has moved keeps for ever, and the sum of Δt V
    /// W (m).
    W: f64,
    dx: f64,
}

impl Floors {
    /// Makes the floors of a reference; of `theirs` only the masses of the nodes are looked at,
    /// since a node may have no mass in one of them, and a digit's worth in the other.
    pub fn of(reference: &[Entry], theirs: &[Entry]) -> Floors {
        let mut floors = Floors::default();
        for entry in reference {
            let largest = floors.largest.entry((entry.k, entry.symbol)).or_insert(0.0);
            *largest = largest.max(entry.value.abs());
        }
        let Some(given) = Given::of(reference) else { return floors };
        let mut by_step: HashMap<usize, Vec<&Entry>> = HashMap::new();
        let masses = theirs.iter().filter(|e| e.symbol == "m_I");
        for entry in reference.iter().chain(masses) {
            by_step.entry(entry.k).or_default().push(entry);
        }
        let mut running = Running::default();
        for k in by_step.keys().copied().collect::<BTreeSet<_>>() {
            running.look(&by_step[&k]);
            running.add_slopes(&given);
            floors.of_step(k, &given, &mut running);
        }
        floors
    }

    /// Gives the scale of an entry, which the absolute tolerance is multiplied by.
    pub fn scale(&self, entry: &Entry) -> f64 {
        let Entry { k, symbol, index, .. } = *entry;
        let of = |found: Option<&f64>| found.copied().unwrap_or(0.0);
        of(self.largest.get(&(k, symbol)))
            .max(of(self.of_symbol.get(&(k, symbol))))
            .max(of(self.of_index.get(&(k, symbol, index))))
    }

    /// Makes the floors of time step `k`.
    fn of_step(&mut self, k: usize, given: &Given, running: &mut Running) {
        self.strains(k, given, running);
        let F = self.forces(k, given, running);
        let (dt, h) = (given.dt, given.h);
        let largest = |symbol| self.largest.get(&(k, symbol)).copied().unwrap_or(0.0);
        let (m, V) = (running.m, running.V * running.W);
        let a = if m > 0.0 { (F / m).max(largest("a_p")) } else { 0.0 };
        for I in running.m_I.keys() {
            let over = running.over_own(*I);
            self.of_index.insert((k, "a_I", *I), a * over);
            self.of_index.insert((k, "v_I", *I), V.max((running.V + dt * a) * over));
        }
        let a_p = given.m_p.values().copied().reduce(f64::min).map_or(0.0, |m_p| F / m_p);
        running.dx += dt * V;
        let x = largest("x_p").max(largest("x_I")).max(h) + running.dx;
        for (symbol, floor) in [
            ("a_p", a_p),
            ("v_p", V + dt * a_p),
            ("p_I", m * V),
            ("p_I_advanced", m * V + dt * F),
            ("x_p", x),
            ("x_I", x),
            ("m_I", m * x / h),
            ("N_Ip", x / h),
            ("grad_N_Ip", x / (h * h)),
            ("lambda", 2.0 * given.gamma * x / (h * h)),
        ] {
            self.of_symbol.insert((k, symbol), floor);
        }
    }

    /// Makes the floors of what the material of time step `k` is strained by, and of its state.
    fn strains(&mut self, k: usize, given: &Given, running: &mut Running) {
        if self.largest.contains_key(&(k, "F_p")) {
            running.V = running.V.max(given.h / given.dt); // the digits of F are those of 1
        }
        let V = running.V;
        running.W = running.W.max(1.0);
        let even = given.dt * V * running.W / given.h;
        let mut e_p: HashMap<usize, f64> = given.m_p.keys().map(|p| (*p, even)).collect();
        for table in &running.tables {
            let mut sums: HashMap<usize, [f64; 2]> = HashMap::new();
            for (p, I, slope) in table {
                let [plain, over] = sums.entry(*p).or_insert([0.0; 2]);
                *plain += slope;
                *over += slope * running.over_own(*I);
            }
            for (p, [plain, over]) in sums {
                let e = e_p.entry(p).or_insert(0.0);
                *e = e.max(given.dt * V * over);
                running.W = running.W.max(if plain > 0.0 { over / plain } else { 1.0 });
            }
        }
        for (p, e) in e_p {
            let so_far = running.e_p.entry(p).or_insert(0.0);
            *so_far = so_far.max(e);
            for (symbol, floor) in [
                ("d_eps_p", e),
                ("G_p", e),
                ("F_p", so_far.max(1.0)),
                ("rho_p", given.rho * so_far.max(1.0)),
                (
                    "sigma_p",
                    given.modulus
                        * if self.largest.contains_key(&(k, "F_p")) {
                            so_far.max(1.0)
                        } else {
                            *so_far
                        },
                ),
            ] {
                self.of_index.insert((k, symbol, p), floor);
            }
        }
    }

    /// Makes the floors of the forces of time step `k`, and gives the largest of them (N).
    fn forces(&mut self, k: usize, given: &Given, running: &Running) -> f64 {
        let mut floor: HashMap<usize, f64> = HashMap::new();
        for (p, I, slope) in &running.tables[1] {
            let volume = given.m_p.get(p).copied().unwrap_or(0.0) / given.rho;
            let stress = self.of_index.get(&(k, "sigma_p", *p)).copied().unwrap_or(0.0);
            *floor.entry(*I).or_insert(0.0) += slope * volume * stress;
        }
        const FORCES: [&str; 3] = ["f_int_I", "f_ext_I", "f_I"];
        let largest = |symbol: &&'static str| self.largest.get(&(k, *symbol)).copied();
        let all = FORCES.iter().filter_map(largest).fold(0.0, f64::max);
        for symbol in FORCES {
            self.of_symbol.insert((k, symbol), all);
            for (I, floor) in &floor {
                self.of_index.insert((k, symbol, *I), *floor);
            }
        }
        floor.into_values().fold(all, f64::max)
    }
}

impl Running {
    /// Gives q_I = h Σ_p m_p |∇N_Ip| / m_I, by which a digit of the particles' places changes the
    /// mass of a node, 1 at least and [`MOST`] at most, as for a node lighter than the heaviest by
    /// that.
    fn over_own(&self, I: usize) -> f64 {
        let own = self.m_I.get(&I).copied().unwrap_or(0.0);
        let moved = self.slopes.get(&I).copied().unwrap_or(0.0);
        match own {
            _ if own <= 0.0 => 1.0,
            _ if own * MOST < self.m => MOST,
            _ => (moved / own).clamp(1.0, MOST),
        }
    }

    /// Adds up h m_p |∇N_Ip| at every node (kg).
    fn add_slopes(&mut self, given: &Given) {
        self.slopes.clear();
        for (p, I, slope) in &self.tables[1] {
            let m_p = given.m_p.get(p).copied().unwrap_or(0.0);
            *self.slopes.entry(*I).or_insert(0.0) += given.h * m_p * slope;
        }
    }

    /// Takes from the entries of a time step what runs on.
    fn look(&mut self, entries: &[&Entry]) {
        let of = |symbol: &'static str| entries.iter().filter(move |e| e.symbol == symbol);
        self.V = of("v_p").map(|e| e.value.abs()).fold(self.V, f64::max);
        if of("m_I").next().is_some() {
            self.m_I.clear();
        }
        for entry in of("m_I") {
            let m_I = self.m_I.entry(entry.index).or_insert(0.0);
            *m_I = m_I.max(entry.value);
        }
        self.m = self.m_I.values().copied().fold(0.0, f64::max);
        if of("grad_N_Ip").next().is_some() {
            let table = of("grad_N_Ip").filter_map(|e| Some((e.index, e.node?, e.value.abs())));
            self.tables = [std::mem::take(&mut self.tables[1]), table.collect()];
        }
    }
}
