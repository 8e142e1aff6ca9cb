//! One way to compute a scene: method, mass, basis, integrator, grid and time step,
//! with a name in one word, and the scene file that goes with it.

use crate::run;
use crate::scene::Scene;
use crate::scene::fault::{Fault, SceneError};
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// A scene file as a template for its variants.
#[derive(Clone, Debug)]
pub struct Template {
    /// Where it was read, for messages and commands.
    pub path: PathBuf,
    table: Table,
}

/// One way to compute a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// "mpm" or "otm".
    pub method: String,
    /// "lumped" or "consistent".
    pub mass: String,
    /// The kind, for lme with γ and cut-off: "linear", "lme-0.8", "lme-4-0.01".
    pub basis: String,
    /// The kind, with what it needs: "newmark", "forward-euler-last",
    /// "generalized-alpha-0.8".
    pub integrator: String,
    /// The scene's cells are multiplied by this.
    pub refinement: f64,
    pub particles_per_cell: usize,
    pub cfl: f64,
}

impl std::fmt::Display for Configuration {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{}/{}/{}/{}/{}/{}/{}",
            self.method,
            self.mass,
            self.basis,
            self.integrator,
            self.refinement,
            self.particles_per_cell,
            self.cfl
        )
    }
}

impl std::str::FromStr for Configuration {
    type Err = Fault;

    fn from_str(text: &str) -> Result<Self, Fault> {
        let fault = |problem: String| Fault::Argument {
            argument: "--row",
            problem,
            allowed: "method/mass/basis/integrator/refinement/particles per cell/cfl, as --list prints it",
        };
        let parts: Vec<&str> = text.split('/').collect();
        let [method, mass, basis, integrator, refinement, per_cell, cfl] = parts[..] else {
            return Err(fault(format!("`{text}` has {} parts", parts.len())));
        };
        let number = |text: &str| match text.parse::<f64>() {
            Ok(x) if x > 0.0 && x.is_finite() => Ok(x),
            _ => Err(fault(format!("`{text}` is not a number above 0"))),
        };
        Ok(Configuration {
            method: method.to_string(),
            mass: mass.to_string(),
            basis: basis.to_string(),
            integrator: integrator.to_string(),
            refinement: number(refinement)?,
            particles_per_cell: per_cell
                .parse()
                .map_err(|_| fault(format!("`{per_cell}` is not a whole number")))?,
            cfl: number(cfl)?,
        })
    }
}

impl Template {
    /// Reads a scene from `text`, and checks that it is one; `path` is named in errors.
    ///
    /// Errors: [`Fault::Scene`].
    pub fn parse(path: &Path, text: &str) -> Result<Self, Fault> {
        let name = path.display().to_string();
        run::parse("scene", &name, text, &[])?;
        let table: Table = text.parse().map_err(|error: toml::de::Error| {
            Fault::Scene(Box::new(SceneError {
                path: name,
                text: text.to_string(),
                span: error.span().unwrap_or(0..0),
                key: String::new(),
                problem: error.message().to_string(),
                allowed: String::new(),
                suggestion: None,
            }))
        })?;
        Ok(Template { path: path.to_path_buf(), table })
    }

    /// The scene file of one configuration. What only the template's own basis,
    /// integrator or method needed is left out.
    pub fn text(&self, configuration: &Configuration) -> String {
        let mut table = self.table.clone();
        let text = |text: &str| Value::String(text.to_string());
        table.insert("method".into(), text(&configuration.method));
        table.insert("mass".into(), text(&configuration.mass));
        table.insert("basis".into(), Value::Table(basis(&configuration.basis)));
        if let Some(time) = table.get_mut("time").and_then(Value::as_table_mut) {
            for key in ["reading", "stress_update", "rho_b", "fraction_of_critical"] {
                time.remove(key);
            }
            time.extend(integrator(&configuration.integrator));
            time.insert("cfl".into(), Value::Float(configuration.cfl));
        }
        if let Some(grid) = table.get_mut("grid").and_then(Value::as_table_mut) {
            let refined = |cells: &Value| {
                let cells = cells.as_integer().unwrap_or(1) as f64 * configuration.refinement;
                Value::Integer((libm::round(cells) as i64).max(1))
            };
            let cells = grid.get("cells").cloned().unwrap_or(Value::Integer(1));
            let (cells, per_cell) = match &cells {
                Value::Array(list) => (
                    Value::Array(list.iter().map(refined).collect()),
                    Value::Array(vec![
                        Value::Integer(configuration.particles_per_cell as i64);
                        list.len()
                    ]),
                ),
                one => (refined(one), Value::Integer(configuration.particles_per_cell as i64)),
            };
            grid.insert("cells".into(), cells);
            grid.insert("particles_per_cell".into(), per_cell);
            if configuration.method == "otm" {
                grid.remove("beyond");
            } else if let Some(beyond) = grid.get_mut("beyond").and_then(Value::as_table_mut) {
                for (_, cells) in beyond.iter_mut() {
                    *cells = match cells.as_integer() {
                        Some(n) if n > 0 => refined(&Value::Integer(n)),
                        _ => Value::Integer(0),
                    };
                }
            }
        }
        table.to_string()
    }

    /// The scene of the template itself.
    ///
    /// Errors: [`Fault::Scene`].
    pub fn scene_as_it_is(&self) -> Result<Scene, Fault> {
        let name = self.path.display().to_string();
        Ok(run::parse("scene", &name, &self.table.to_string(), &[])?)
    }

    /// Number of axes.
    pub fn dimension(&self) -> usize {
        let length = self.table.get("body").and_then(|body| body.get("length"));
        length.and_then(Value::as_array).map_or(1, Vec::len)
    }

    /// The scene of one configuration.
    ///
    /// Errors: [`Fault::Scene`] for one that the scene cannot have.
    pub fn scene(&self, configuration: &Configuration) -> Result<Scene, Fault> {
        let name = format!("{} as {configuration}", self.path.display());
        Ok(run::parse("scene", &name, &self.text(configuration), &[])?)
    }
}

/// "lme-0.8-1e-6": the kind, γ, the cut-off. (A minus sign is part of a number.)
fn basis(text: &str) -> Table {
    let mut table = Table::new();
    let Some(numbers) = text.strip_prefix("lme-") else {
        table.insert("kind".into(), Value::String(text.to_string()));
        return table;
    };
    table.insert("kind".into(), Value::String("lme".into()));
    // The whole is γ, or it is cut at the first minus sign that leaves two numbers.
    let number = |text: &str| text.parse::<f64>().ok();
    let mut cuts = numbers.match_indices('-').map(|(at, _)| (&numbers[..at], &numbers[at + 1..]));
    let two = cuts.find_map(|(gamma, cutoff)| Some((number(gamma)?, number(cutoff)?)));
    match (number(numbers), two) {
        (Some(gamma), _) => {
            table.insert("gamma".into(), Value::Float(gamma));
        }
        (None, Some((gamma, cutoff))) => {
            table.insert("gamma".into(), Value::Float(gamma));
            table.insert("cutoff".into(), Value::Float(cutoff));
        }
        // Said as it is, so that the scene refuses it by name.
        (None, None) => {
            table.insert("gamma".into(), Value::String(numbers.to_string()));
        }
    }
    table
}

fn integrator(text: &str) -> Table {
    let mut table = Table::new();
    let kinds = [("forward-euler-", "stress_update"), ("generalized-alpha-", "rho_b")];
    let found = kinds.iter().find_map(|(kind, key)| Some((kind, key, text.strip_prefix(kind)?)));
    let kind = match found {
        Some((kind, key, rest)) => {
            let value = rest.parse().map_or(Value::String(rest.to_string()), Value::Float);
            table.insert((*key).into(), value);
            kind.trim_end_matches('-')
        }
        None => text,
    };
    table.insert("integrator".into(), Value::String(kind.to_string()));
    table
}
