//! A study keeps of a finished run how wrong it was, and what it cost.

use crate::method::cost::Cost;
use crate::output::summary;
use crate::run::run;
use crate::scene::Scene;

/// A criterion is what a run is judged by: its error in one quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Criterion {
    Velocity,
    Stress,
    Displacement,
}

impl Criterion {
    /// All three stand here.
    pub const ALL: [Criterion; 3] =
        [Criterion::Velocity, Criterion::Stress, Criterion::Displacement];

    /// Names the quantity, as probes and columns do.
    pub fn name(self) -> &'static str {
        match self {
            Criterion::Velocity => "velocity",
            Criterion::Stress => "stress",
            Criterion::Displacement => "displacement",
        }
    }
}

/// A finished run has relative errors, an energy drift and a counted cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    pub velocity: f64,
    pub stress: f64,
    pub displacement: f64,
    /// The largest; of its balance for a scene with loads.
    pub energy_drift: f64,
    pub cost: Cost,
}

impl Measured {
    /// Runs a scene and takes its errors.
    ///
    /// Errors: why there are none, in words.
    pub fn of(scene: &Scene) -> Result<Self, String> {
        let outcome = run(scene, &mut |_| {}).map_err(|stopped| stopped.broken.to_string())?;
        let lines = summary::lines(scene, &outcome, 0.0);
        let value = |name: &str| lines.iter().find(|l| l.quantity == name).map(|l| l.value);
        let error = |criterion| error(scene, criterion, &value);
        let drift = value("energy_drift_largest").or(value("energy_balance_largest"));
        let mut measured = Measured {
            velocity: error(Criterion::Velocity),
            stress: error(Criterion::Stress),
            displacement: error(Criterion::Displacement),
            energy_drift: drift.unwrap_or(0.0),
            cost: outcome.cost,
        };
        match measured.places().iter().all(|(_, x)| x.is_finite()) {
            true => Ok(measured),
            false => Err("nothing moves this body, or its errors are not finite".to_string()),
        }
    }

    /// Picks the relative error in one quantity.
    pub fn error(&self, criterion: Criterion) -> f64 {
        match criterion {
            Criterion::Velocity => self.velocity,
            Criterion::Stress => self.stress,
            Criterion::Displacement => self.displacement,
        }
    }

    /// Lists every number that is not a count with its name, to be set.
    fn places(&mut self) -> [(&'static str, &mut f64); 4] {
        [
            ("velocity", &mut self.velocity),
            ("stress", &mut self.stress),
            ("displacement", &mut self.displacement),
            ("energy_drift", &mut self.energy_drift),
        ]
    }

    /// Lists every number with its name, in the order of the columns.
    pub fn named(mut self) -> Vec<(&'static str, f64)> {
        let errors = self.places().map(|(name, x)| (name, *x));
        let counts = self.cost.named().map(|(name, count)| (name, count as f64));
        errors.into_iter().chain(counts).collect()
    }

    /// Reads what [`Measured::named`] has listed from the `number` of every name; gives `None`
    /// if one is missing.
    pub fn read(number: impl Fn(&str) -> Option<f64>) -> Option<Self> {
        let mut measured = Measured::default();
        for (name, x) in measured.places() {
            *x = number(name)?;
        }
        for (name, count) in measured.cost.places() {
            // Beyond 2⁵³ a number is no count any more.
            *count = number(name).filter(|x| x.trunc() == *x && *x < 9e15)? as u64;
        }
        Some(measured)
    }
}

/// Finds the relative error in one quantity: of its probes together, or of its field at the end
/// where no probe follows it; `value` gives a line of the summary.
fn error(scene: &Scene, criterion: Criterion, value: &dyn Fn(&str) -> Option<f64>) -> f64 {
    let name = criterion.name();
    let probes = scene.probes.iter().filter(|probe| probe.quantity.name_unit().0 == name);
    let list: Vec<f64> =
        probes.filter_map(|probe| value(&format!("{}_rms_relative", probe.name))).collect();
    match list.is_empty() {
        true => value(&format!("{name}_field_rms_relative")).unwrap_or(f64::NAN),
        false => libm::sqrt(list.iter().map(|x| x * x).sum::<f64>() / list.len() as f64),
    }
}
