//! A configuration is one way to compute a scene, written as a list of `KEY=VALUE`; a
//! template is the scene that is computed in many ways.

use crate::run;
use crate::scene::fault::Fault;
use crate::scene::{Budget, Scene, merged};
use std::path::Path;

/// These keys are what a study varies. A configuration answers for all of them: what the scene
/// says of them itself is taken out first.
pub const KEYS: [&str; 20] = [
    "method",
    "mass",
    "basis.kind",
    "basis.degree",
    "basis.gamma",
    "basis.cutoff",
    "basis.support",
    "basis.metric",
    "forces.reconstruction",
    "forces.degree",
    "filter",
    "time.integrator",
    "time.reading",
    "time.stress_update",
    "time.rho_b",
    "grid.cells",
    "grid.particles_per_cell",
    "grid.beyond",
    "time.cfl",
    "time.fraction_of_critical",
];

/// A configuration gives values of [`KEYS`] in the form `KEY=VALUE` that `--set` takes. It
/// is written and read as one line, with a space between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration(Vec<String>);

impl Configuration {
    /// Gives the value of a key, which is empty if the configuration leaves it out.
    pub fn value(&self, key: &str) -> &str {
        let mut values = self.0.iter().filter_map(|set| set.strip_prefix(key)?.strip_prefix('='));
        values.next().unwrap_or("")
    }

    /// Gives a configuration with another value of a key that this one has.
    pub fn with(&self, key: &str, value: &str) -> Self {
        let own = |set: &String| match set.split_once('=') {
            Some((other, _)) if other == key => format!("{key}={value}"),
            _ => set.clone(),
        };
        Configuration(self.0.iter().map(own).collect())
    }

    /// Puts the values of some keys side by side, as in "lme 0.8".
    pub fn words(&self, keys: &[&str]) -> String {
        let values = keys.iter().map(|key| self.value(key)).filter(|value| !value.is_empty());
        values.collect::<Vec<_>>().join(" ")
    }

    /// Tells whether these are linear finite elements: OTM with the linear basis. Studies
    /// compare with them, but they stand on no front and are never recommended: where no
    /// particle is needed, they win.
    pub fn is_finite_elements(&self) -> bool {
        self.value("method") == "otm" && self.value("basis.kind") == "linear"
    }

    /// Names the group that gives the colour in a diagram: basis and mass, or the method.
    pub fn family(&self) -> String {
        match self.value("method") {
            _ if self.is_finite_elements() => "finite elements".to_string(),
            "otm" => "otm".to_string(),
            _ => format!("{}, {}", self.value("basis.kind"), self.value("mass")),
        }
    }
}

impl std::fmt::Display for Configuration {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0.join(" "))
    }
}

impl std::str::FromStr for Configuration {
    type Err = Fault;

    /// Reads a line of `KEY=VALUE`.
    ///
    /// Errors: [`Fault::Argument`] for what is none, and for a key that no study varies or
    /// that is given twice. Values are checked with the scene.
    fn from_str(line: &str) -> Result<Self, Fault> {
        let fault = |problem: String| Fault::Argument {
            argument: "--row",
            problem,
            allowed: "a line of KEY=VALUE with spaces between them and none inside, as --list \
                      prints it",
        };
        let mut found: Vec<&str> = Vec::new();
        for set in line.split_whitespace() {
            let key = match set.split_once('=') {
                Some((key, value)) if !value.is_empty() => key,
                _ => return Err(fault(format!("`{set}` is not KEY=VALUE"))),
            };
            if !KEYS.contains(&key) {
                return Err(fault(format!("`{key}` is not one of {}", KEYS.join(", "))));
            }
            if found.contains(&key) {
                return Err(fault(format!("`{key}` stands there twice")));
            }
            found.push(key);
        }
        if found.is_empty() {
            return Err(fault("nothing is given".to_string()));
        }
        Ok(Configuration(line.split_whitespace().map(String::from).collect()))
    }
}

/// A template is a scene that is computed in many ways.
#[derive(Clone, Debug)]
pub struct Template {
    /// The scene as it is written.
    pub scene: Scene,
    path: String,
    text: String,
    /// `grid.beyond` as it is written: sides and cells.
    beyond: Vec<(String, i64)>,
    budget: Budget,
}

impl Template {
    /// Reads a scene from `text`, and checks that it is one; `path` is named in errors.
    ///
    /// Errors: [`Fault::Scene`].
    pub fn parse(path: &Path, text: &str) -> Result<Self, Fault> {
        Template::parse_within(&Budget::default(), path, text)
    }

    /// Reads a scene as [`Template::parse`] does; it and its configurations are held against
    /// another `budget`.
    ///
    /// Errors: [`Fault::Scene`].
    pub fn parse_within(budget: &Budget, path: &Path, text: &str) -> Result<Self, Fault> {
        let path = path.display().to_string();
        let scene = run::parse_within(budget, "scene", &path, text, &[])?;
        let table = merged(&path, text, &[])?;
        let sides = table.get("grid").and_then(|grid| grid.get("beyond")?.as_table());
        let cells = |(side, n): (&String, &toml::Value)| Some((side.clone(), n.as_integer()?));
        let beyond = sides.into_iter().flatten().filter_map(cells).collect();
        Ok(Template { scene, path, text: text.to_string(), beyond, budget: *budget })
    }

    /// Writes the grid of `method` as part of a configuration: the scene's cells times
    /// `refinement`, at least one, and as many of them beyond the body as it asks for.
    pub fn grid(&self, method: &str, refinement: f64, particles_per_cell: usize) -> String {
        let refined = |cells: f64| libm::round(cells * refinement).max(1.0);
        let list = |values: Vec<String>| match values.as_slice() {
            [one] => one.clone(),
            _ => format!("[{}]", values.join(",")),
        };
        let cells = self.scene.grid.cells.iter().map(|n| refined(*n as f64).to_string()).collect();
        let per_cell = vec![particles_per_cell.to_string(); self.scene.dimension()];
        let mut grid =
            format!("grid.cells={} grid.particles_per_cell={}", list(cells), list(per_cell));
        // OTM has no nodes beyond the body.
        if method == "mpm" && !self.beyond.is_empty() {
            let cells = |n: i64| if n > 0 { refined(n as f64) } else { 0.0 };
            let sides = self.beyond.iter().map(|(side, n)| format!("{side}={}", cells(*n)));
            grid += &format!(" grid.beyond={{{}}}", sides.collect::<Vec<_>>().join(","));
        }
        grid
    }

    /// Lists the `--set` that make one configuration of the scene.
    fn sets(configuration: &Configuration) -> Vec<String> {
        let mut sets = KEYS.map(|key| format!("{key}=")).to_vec();
        sets.extend_from_slice(&configuration.0);
        sets
    }

    /// Reads the scene of one configuration.
    ///
    /// Errors: [`Fault::Scene`] for one that the scene cannot have.
    pub fn scene(&self, configuration: &Configuration) -> Result<Scene, Fault> {
        let sets = Self::sets(configuration);
        Ok(run::parse_within(&self.budget, "scene", &self.path, &self.text, &sets)?)
    }

    /// Writes the scene file of one configuration.
    ///
    /// Errors: [`Fault::Scene`] for one whose keys the scene cannot have.
    pub fn file(&self, configuration: &Configuration) -> Result<String, Fault> {
        Ok(merged(&self.path, &self.text, &Self::sets(configuration))?.to_string())
    }

    /// Tells one study from another by a digest of the scene: FNV-1a of its cells and of all
    /// that configurations do not vary.
    ///
    /// Errors: none for a scene that could be read.
    pub fn digest(&self) -> Result<String, Fault> {
        let grid = self.grid("mpm", 1.0, 1);
        let any = "method=mpm mass=lumped basis.kind=linear time.integrator=newmark time.cfl=1";
        let text = self.file(&format!("{any} {grid}").parse()?)?;
        let digest = text.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
        });
        Ok(format!("{digest:016x}"))
    }
}
