//! The figures of a run: errors, peaks, energy, cost.

use crate::cost::Cost;
use crate::exact::Exact;
use crate::measure::rms;
use crate::model::wave_speed;
use crate::run::Outcome;
use crate::scene::{Quantity, Scene};

/// One line of the summary.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    pub quantity: String,
    pub value: f64,
    pub unit: &'static str,
}

/// The scales that make errors relative, from v0, the largest initial speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// v0 (m/s).
    pub velocity: f64,
    /// Z v0 / 2 (Pa), the plateau of the stress.
    pub stress: f64,
    /// v0 L / 4c (m).
    pub displacement: f64,
}

impl Scales {
    pub fn of(scene: &Scene) -> Self {
        let speeds = scene
            .initial_velocity
            .iter()
            .map(|region| libm::sqrt(region.velocity.iter().map(|v| v * v).sum()));
        let v0 = speeds.fold(0.0, f64::max);
        let c = wave_speed(&scene.body);
        Scales {
            velocity: v0,
            stress: scene.body.density * c * v0 / 2.0,
            displacement: v0 * scene.body.length[0] / (4.0 * c),
        }
    }

    /// The scale of a quantity.
    pub fn scale(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Velocity(_) => self.velocity,
            Quantity::Stress(..) => self.stress,
            Quantity::Displacement(_) => self.displacement,
        }
    }
}

/// All lines of the summary; `wall_time` (s) of the time loop.
pub fn lines(scene: &Scene, outcome: &Outcome, wall_time: f64) -> Vec<Line> {
    let mut lines = Vec::new();
    let mut add = |quantity: String, value: f64, unit| lines.push(Line { quantity, value, unit });
    let scales = Scales::of(scene);
    let exact = Exact::of(scene).is_ok();
    let column = |name: &str| outcome.history.column(name).unwrap_or_default();
    let peak = |list: &[f64]| list.iter().fold(0.0, |peak: f64, x| peak.max(x.abs()));

    for probe in &scene.probes {
        let name = &probe.name;
        let unit = probe.quantity.name_unit().1;
        let computed = column(name);
        if exact {
            let expected = column(&format!("{name}_exact"));
            let error = rms(computed.iter().copied().zip(expected.iter().copied()));
            add(format!("{name}_rms"), error, unit);
            let scale = scales.scale(probe.quantity);
            if scale > 0.0 {
                add(format!("{name}_rms_relative"), error / scale, "1");
            }
            add(format!("{name}_peak_exact"), peak(&expected), unit);
        }
        add(format!("{name}_peak"), peak(&computed), unit);
    }
    if exact {
        let of = |name: &str| outcome.particles.column(name).unwrap_or_default();
        let error = rms(of("displacement").into_iter().zip(of("displacement_exact")));
        add("displacement_field_rms".into(), error, "m");
        if scales.displacement > 0.0 {
            let relative = error / scales.displacement;
            add("displacement_field_rms_relative".into(), relative, "1");
        }
    }
    let kinetic = column("kinetic_energy");
    let total: Vec<f64> = kinetic
        .iter()
        .zip(column("strain_energy"))
        .map(|(kinetic, strain)| kinetic + strain)
        .collect();
    if let (Some(&first), Some(&last)) = (total.first(), total.last()) {
        add("energy_start".into(), first, "J");
        add("energy_end".into(), last, "J");
        if first > 0.0 {
            let drift: Vec<f64> = total.iter().map(|energy| energy / first - 1.0).collect();
            add("energy_drift".into(), last / first - 1.0, "1");
            add("energy_drift_largest".into(), peak(&drift), "1");
        }
    }
    add("time_step".into(), outcome.dt, "s");
    add("courant_number".into(), scene.courant_number(), "1");
    add("wall_time".into(), wall_time, "s");
    lines
}

/// The unit of a cost counter.
pub fn cost_unit(name: &str) -> &'static str {
    if name == "bytes_per_particle" { "B" } else { "1" }
}

/// The cost counters as lines.
pub fn cost_lines(cost: &Cost) -> Vec<Line> {
    cost.named()
        .into_iter()
        .map(|(name, count)| Line {
            quantity: name.to_string(),
            value: count as f64,
            unit: cost_unit(name),
        })
        .collect()
}
