//! The summary of a run names its errors, peaks, energy and cost.

use crate::method::cost::Cost;
use crate::method::exact::mode::Mode;
use crate::method::measure::rms;
use crate::run::columns::{of_stress, per_axis, upper_half};
use crate::run::stability::Critical;
use crate::run::{Outcome, Worst};
use crate::scene::{Motion, Probe, Quantity, Scene, wave_speed};
use crate::setup;

/// A line of the summary is a number with a name and a unit.
#[derive(Clone, Debug, PartialEq)]
pub struct SummaryLine {
    pub quantity: String,
    pub value: f64,
    pub unit: &'static str,
}

impl SummaryLine {
    /// Makes a line.
    pub fn new(quantity: impl Into<String>, value: f64, unit: &'static str) -> Self {
        SummaryLine { quantity: quantity.into(), value, unit }
    }
}

/// These scales make errors relative. For a body thrown at v0 they are those of
/// the bar: v0, the plateau Z v0/2, and v0 L/4c. For a mode they are V, Z V and V/ω
/// with its largest speed V, and so for a motion with V and amplitude of its own. Loads add V, Z V
/// and V L/c with V = b L/c + t/Z to what the body starts with. Where nothing acts all are 0.
///
/// Test: `summary_scales_by_what_acts` in `tests/gate.rs`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// (m/s).
    pub velocity: f64,
    /// (Pa).
    pub stress: f64,
    /// (m).
    pub displacement: f64,
}

impl Scales {
    /// Takes the scales from what moves the body: its throw, or its mode, and its loads.
    pub fn of(scene: &Scene) -> Self {
        let (own, loads) = (Scales::of_motion(scene), Scales::of_loads(scene));
        Scales {
            velocity: own.velocity + loads.velocity,
            stress: own.stress + loads.stress,
            displacement: own.displacement + loads.displacement,
        }
    }

    fn of_motion(scene: &Scene) -> Self {
        let c = wave_speed(&scene.body);
        let (velocity, displacement) = match &scene.motion {
            Motion::Vibration { mode, velocity } => {
                let mode = Mode::new(scene.ends(0), *mode, scene.body.length[0]);
                (velocity.abs(), velocity.abs() / (c * mode.k))
            }
            Motion::Manufactured(spec) => {
                ((spec.amplitude * spec.frequency).abs(), spec.amplitude.abs())
            }
            Motion::Vortex(spec) => {
                let arc = (spec.angle * spec.radius).abs();
                (arc * spec.frequency, arc)
            }
            Motion::Regions(regions) => {
                let axes = 0..scene.dimension();
                let sizes = regions.iter().map(|region| {
                    size(&axes.clone().map(|d| region.fastest(d)).collect::<Vec<_>>())
                });
                let thrown = sizes.fold(0.0, f64::max);
                return Scales {
                    velocity: thrown,
                    stress: scene.body.density * c * thrown / 2.0,
                    displacement: thrown * scene.body.length[0] / (4.0 * c),
                };
            }
        };
        Scales { velocity, stress: scene.body.density * c * velocity, displacement }
    }

    fn of_loads(scene: &Scene) -> Self {
        let c = wave_speed(&scene.body);
        let (Z, transit) = (scene.body.density * c, scene.body.length[0] / c);
        let body = scene.body_force.as_ref().map_or(0.0, |b| size(&b.acceleration));
        let sides = scene.traction.iter().flat_map(|load| load.sides.iter().flatten());
        let traction = sides.map(|t| size(t)).fold(0.0, f64::max);
        let velocity = body * transit + traction / Z;
        Scales { velocity, stress: Z * velocity, displacement: velocity * transit }
    }

    /// Picks the scale of a quantity.
    pub fn scale(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Velocity(_) => self.velocity,
            Quantity::Stress(..) => self.stress,
            Quantity::Displacement(_) => self.displacement,
        }
    }
}

fn size(list: &[f64]) -> f64 {
    libm::sqrt(list.iter().map(|x| x * x).sum())
}

/// Gives all lines of the summary; `wall_time` (s) of the time loop.
pub fn lines(scene: &Scene, outcome: &Outcome, wall_time: f64) -> Vec<SummaryLine> {
    let mut lines = Vec::new();
    let exact = setup::has_exact(scene).is_ok();
    let scales = Scales::of(scene);
    for probe in &scene.probes {
        probe_lines(&mut lines, probe, outcome, exact.then(|| scales.scale(probe.quantity)));
    }
    if exact {
        field_lines(&mut lines, &scales, scene.dimension(), outcome);
    }
    energy_lines(&mut lines, scene, outcome);
    warning_lines(&mut lines, outcome);
    if scene.time.load_steps.is_none() {
        lines.push(SummaryLine::new("time_step", outcome.dt, "s"));
        lines.push(SummaryLine::new("courant_number", scene.courant_number(), "1"));
    }
    lines.push(SummaryLine::new("wall_time", wall_time, "s"));
    lines
}

/// Gives the predicted limit of Δt, and the part of it that `dt` (s) is: of the limit over all
/// offsets where particles move, and else of that at the start. A body that nothing strains has
/// no limit, and no such line.
pub fn limit_lines(limit: &Critical, dt: f64) -> Vec<SummaryLine> {
    let over_offsets = limit.over_offsets.unwrap_or(f64::INFINITY);
    [
        ("critical_time_step", limit.start, limit.start, "s"),
        ("critical_time_step_over_offsets", over_offsets, over_offsets, "s"),
        ("fraction_of_critical", limit.used(), dt / limit.used(), "1"),
    ]
    .into_iter()
    .filter(|(_, limit, ..)| limit.is_finite())
    .map(|(name, _, value, unit)| SummaryLine::new(name, value, unit))
    .collect()
}

/// Finds the largest size in a list.
pub fn peak(list: &[f64]) -> f64 {
    list.iter().fold(0.0, |peak: f64, x| peak.max(x.abs()))
}

/// Adds the peak of a probe's history, and its error where the exact solution gives a `scale`.
fn probe_lines(lines: &mut Vec<SummaryLine>, probe: &Probe, outcome: &Outcome, scale: Option<f64>) {
    let mut add = |what: &str, value, unit| {
        lines.push(SummaryLine::new(format!("{}_{what}", probe.name), value, unit));
    };
    let column = |name: &str| outcome.history.column(name).unwrap_or_default();
    let unit = probe.quantity.name_unit().1;
    let computed = column(&probe.name);
    if let Some(scale) = scale {
        let expected = column(&format!("{}_exact", probe.name));
        let error = rms(computed.iter().copied().zip(expected.iter().copied()));
        add("rms", error, unit);
        if scale > 0.0 {
            add("rms_relative", error / scale, "1");
        }
        add("peak_exact", peak(&expected), unit);
    }
    add("peak", peak(&computed), unit);
}

/// Adds the errors of all particles at the end: of a vector or tensor, the root of the mean
/// square of its size.
fn field_lines(lines: &mut Vec<SummaryLine>, scales: &Scales, axes: usize, outcome: &Outcome) {
    let of = |name: &str| outcome.particles.column(name).unwrap_or_default();
    for (name, unit, scale) in [
        ("velocity", "m/s", scales.velocity),
        ("stress", "Pa", scales.stress),
        ("displacement", "m", scales.displacement),
    ] {
        let of_component = |(component, times): (String, f64)| {
            let exact = format!("{component}_exact");
            let error = rms(of(&component).into_iter().zip(of(&exact)));
            times * error * error
        };
        let square: f64 = components(name, axes).map(of_component).sum();
        let error = libm::sqrt(square);
        lines.push(SummaryLine::new(format!("{name}_field_rms"), error, unit));
        if scale > 0.0 {
            lines.push(SummaryLine::new(format!("{name}_field_rms_relative"), error / scale, "1"));
        }
    }
}

/// Lists the columns of a quantity, and how often each entry stands in it.
fn components(name: &'static str, axes: usize) -> impl Iterator<Item = (String, f64)> {
    let one = move |i: usize| (per_axis(name, axes, i), 1.0);
    let of_tensor =
        upper_half(axes).map(move |(i, j)| (of_stress(axes, i, j), if i == j { 1.0 } else { 2.0 }));
    let vectors = (0..axes).map(one).filter(move |_| name != "stress");
    vectors.chain(of_tensor.filter(move |_| name == "stress"))
}

/// Adds the energy at both ends of the run, and how far it drifted from the start, or from
/// the work of the loads.
fn energy_lines(lines: &mut Vec<SummaryLine>, scene: &Scene, outcome: &Outcome) {
    let mut add = |quantity: &str, value, unit| lines.push(SummaryLine::new(quantity, value, unit));
    let column = |name: &str| outcome.history.column(name).unwrap_or_default();
    let (kinetic, strain) = (column("kinetic_energy"), column("strain_energy"));
    let total: Vec<f64> = kinetic.iter().zip(&strain).map(|(k, s)| k + s).collect();
    let (Some(&first), Some(&last)) = (total.first(), total.last()) else {
        return;
    };
    add("energy_start", first, "J");
    add("energy_end", last, "J");
    if scene.is_loaded() {
        let work = column("work");
        add("work_end", work.last().copied().unwrap_or_default(), "J");
        let largest = peak(&total);
        let balance: Vec<f64> =
            total.iter().zip(&work).map(|(energy, work)| energy - first - work).collect();
        if largest > 0.0 {
            add("energy_balance_largest", peak(&balance) / largest, "1");
        }
    } else if first > 0.0 {
        let drift: Vec<f64> = total.iter().map(|energy| energy / first - 1.0).collect();
        add("energy_drift", last / first - 1.0, "1");
        add("energy_drift_largest", peak(&drift), "1");
    }
}

/// Adds the largest growth of the energy, and what the run is warned of, with particle, step and
/// time.
fn warning_lines(lines: &mut Vec<SummaryLine>, outcome: &Outcome) {
    lines.push(SummaryLine::new("energy_growth_largest", outcome.growth, "1"));
    for warning in &outcome.warnings {
        let (name, value, unit) = warning.named();
        lines.push(SummaryLine::new(name, value, unit));
        if let Some(Worst { particle, moment, .. }) = warning.seen() {
            for (what, value, unit) in [
                ("particle", particle as f64, "1"),
                ("step", moment.step as f64, "1"),
                ("time", moment.time, "s"),
            ] {
                lines.push(SummaryLine::new(format!("{name}_{what}"), value, unit));
            }
        }
    }
}

/// Gives the unit of a cost counter.
pub fn cost_unit(name: &str) -> &'static str {
    if name == "bytes_per_particle" { "B" } else { "1" }
}

/// Gives the cost counters as lines.
pub fn cost_lines(cost: &Cost) -> Vec<SummaryLine> {
    cost.named()
        .into_iter()
        .map(|(name, count)| SummaryLine::new(name, count as f64, cost_unit(name)))
        .collect()
}
