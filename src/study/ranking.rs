//! The ranking tells which configurations are worth what they cost.

use super::configuration::{Configuration, KEYS};
use super::log::{TimedRun, result_cells, result_columns};
use super::measured::{Criterion, Measured};
use super::work::work;
use crate::run::table::{csv, shortest};
use crate::scene::fault::Fault;

/// The time of a run varies over the passes (s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallTime {
    pub median: f64,
    pub least: f64,
    pub largest: f64,
}

/// A configuration that was tried has all its passes taken together.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried {
    pub configuration: Configuration,
    /// What came out, or why nothing did.
    pub measured: Result<Measured, String>,
    pub wall_time: WallTime,
    pub passes: usize,
}

impl Tried {
    /// Counts the pairs of particle and node; none for a run that failed.
    pub fn pairs(&self) -> Option<u64> {
        self.measured.as_ref().ok().map(|measured| measured.cost.particle_node_pairs)
    }

    /// Gives the counted work (instructions); none for a run that failed.
    pub fn work(&self) -> Option<f64> {
        self.measured.as_ref().ok().map(|measured| work(&measured.cost))
    }

    /// Gives the relative error in one quantity; none for a run that failed.
    pub fn error(&self, criterion: Criterion) -> Option<f64> {
        self.measured.as_ref().ok().map(|measured| measured.error(criterion))
    }
}

/// Takes the passes of each configuration together, in the order of first appearance.
pub fn summarise(runs: &[TimedRun]) -> Vec<Tried> {
    let mut order: Vec<&Configuration> = Vec::new();
    for run in runs {
        if !order.contains(&&run.configuration) {
            order.push(&run.configuration);
        }
    }
    let tried = |configuration: &Configuration| {
        let own: Vec<&TimedRun> =
            runs.iter().filter(|run| run.configuration == *configuration).collect();
        let mut times: Vec<f64> = own.iter().map(|run| run.wall_time).collect();
        times.sort_by(f64::total_cmp);
        Tried {
            configuration: configuration.clone(),
            measured: own[0].measured.clone(),
            wall_time: WallTime {
                median: times[times.len() / 2],
                least: times[0],
                largest: times[times.len() - 1],
            },
            passes: own.len(),
        }
    };
    order.into_iter().map(tried).collect()
}

/// A verdict is asked of all that can be recommended, or of one kind of method to stand beside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Among {
    /// MPM and OTM, but for finite elements.
    Particles,
    Mpm,
    /// OTM, but for finite elements.
    Otm,
    FiniteElements,
}

impl Among {
    /// Names the kind, as in `cheapest.csv`.
    pub fn name(self) -> &'static str {
        match self {
            Among::Particles => "mpm and otm",
            Among::Mpm => "mpm",
            Among::Otm => "otm",
            Among::FiniteElements => "finite elements",
        }
    }

    fn has(self, configuration: &Configuration) -> bool {
        let elements = configuration.is_finite_elements();
        match self {
            Among::Particles => !elements,
            Among::Mpm => configuration.value("method") == "mpm",
            Among::Otm => configuration.value("method") == "otm" && !elements,
            Among::FiniteElements => elements,
        }
    }
}

/// The price of a run is counted, so that every run of a study gives one answer: its work, or its
/// pairs of particle and node alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Price {
    Work,
    Pairs,
}

impl Price {
    /// Names the price, as in `cheapest.csv`.
    pub fn name(self) -> &'static str {
        match self {
            Price::Work => "work",
            Price::Pairs => "pairs",
        }
    }

    /// Gives the price of a run; infinite for one that failed.
    fn of(self, row: &Tried) -> f64 {
        let price = match self {
            Price::Work => row.work(),
            Price::Pairs => row.pairs().map(|pairs| pairs as f64),
        };
        price.unwrap_or(f64::INFINITY)
    }
}

/// Picks those of a kind that came to their end, each with its error.
fn judged(
    rows: &[Tried],
    among: Among,
    criterion: Criterion,
) -> impl Iterator<Item = (&Tried, f64)> {
    let own = rows.iter().filter(move |row| among.has(&row.configuration));
    own.filter_map(move |row| Some((row, row.error(criterion)?)))
}

/// Picks those that nobody beats in both error and work, by rising work, each with its
/// error.
pub fn front(rows: &[Tried], criterion: Criterion) -> Vec<(&Tried, f64)> {
    let mut list: Vec<(&Tried, f64)> = judged(rows, Among::Particles, criterion).collect();
    list.sort_by(|a, b| Price::Work.of(a.0).total_cmp(&Price::Work.of(b.0)));
    let mut least = f64::INFINITY;
    list.retain(|(_, error)| {
        let better = *error < least;
        least = least.min(*error);
        better
    });
    list
}

/// A question is which rows reach an error in one quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Question {
    pub criterion: Criterion,
    /// The largest error that is allowed, relative.
    pub error: f64,
}

/// Lists those of a kind that reach the error, the cheapest first, each with its own error.
pub fn reaching(
    rows: &[Tried],
    among: Among,
    price: Price,
    Question { criterion, error }: Question,
) -> Vec<(&Tried, f64)> {
    let mut list: Vec<(&Tried, f64)> =
        judged(rows, among, criterion).filter(|(_, found)| *found <= error).collect();
    list.sort_by(|a, b| price.of(a.0).total_cmp(&price.of(b.0)));
    list
}

/// Picks the cheapest of a kind that reaches the error, with its own error.
pub fn cheapest(
    rows: &[Tried],
    among: Among,
    price: Price,
    question: Question,
) -> Option<(&Tried, f64)> {
    reaching(rows, among, price, question).into_iter().next()
}

/// Picks the one of a kind with the least error, with that.
pub fn best(rows: &[Tried], among: Among, criterion: Criterion) -> Option<(&Tried, f64)> {
    judged(rows, among, criterion).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Writes `trade.csv`: every configuration key by key, errors, cost, times, and on which
/// fronts it stands.
pub fn table(rows: &[Tried]) -> Result<Vec<u8>, Fault> {
    let mut columns = KEYS.to_vec();
    columns.extend(result_columns());
    columns.extend([
        "work",
        "wall_time_median",
        "wall_time_least",
        "wall_time_largest",
        "passes",
        "front",
    ]);
    let fronts = Criterion::ALL.map(|criterion| (criterion.name(), front(rows, criterion)));
    let line = |row: &Tried| {
        let mut cells = KEYS.map(|key| row.configuration.value(key).to_string()).to_vec();
        cells.extend(result_cells(&row.measured));
        let WallTime { median, least, largest } = row.wall_time;
        cells.push(row.work().map_or(String::new(), shortest));
        cells.extend([median, least, largest].map(shortest));
        cells.push(row.passes.to_string());
        let on = |front: &[(&Tried, f64)]| front.iter().any(|(other, _)| std::ptr::eq(*other, row));
        let names = fronts.iter().filter(|(_, front)| on(front)).map(|(name, _)| *name);
        cells.push(names.collect::<Vec<_>>().join(" "));
        cells
    };
    csv(&columns, rows.iter().map(line))
}

/// The table of the cheapest asks for these levels of error.
pub const LEVELS: [f64; 7] = [0.2, 0.1, 0.05, 0.03, 0.01, 0.003, 0.001];

/// A verdict has these lines: whom it is asked of, and by which price.
pub const VERDICT: [(Among, Price); 5] = [
    (Among::Particles, Price::Work),
    (Among::Particles, Price::Pairs),
    (Among::Mpm, Price::Work),
    (Among::Otm, Price::Work),
    (Among::FiniteElements, Price::Work),
];

/// Writes `cheapest.csv`: for each criterion, level and line of the verdict the cheapest
/// configuration that reaches it; where none does, the least error there is.
pub fn cheapest_table(rows: &[Tried]) -> Result<Vec<u8>, Fault> {
    let mut lines = Vec::new();
    for criterion in Criterion::ALL {
        for error in LEVELS {
            for (among, price) in VERDICT {
                let mut line = vec![criterion.name().to_string(), shortest(error)];
                line.extend([among.name(), price.name()].map(String::from));
                line.extend(match cheapest(rows, among, price, Question { criterion, error }) {
                    Some((row, found)) => {
                        let prices = [Price::Work, Price::Pairs].map(|price| price.of(row));
                        let numbers = [found, row.wall_time.median, prices[0], prices[1]];
                        let [found, time, work, pairs] = numbers.map(shortest);
                        [row.configuration.to_string(), found, time, work, pairs]
                    }
                    None => {
                        let least = best(rows, among, criterion);
                        let least = least.map_or(String::new(), |(_, error)| shortest(error));
                        let none = String::new;
                        ["none".to_string(), least, none(), none(), none()]
                    }
                });
                lines.push(line);
            }
        }
    }
    let columns = [
        "quantity",
        "level",
        "among",
        "by",
        "configuration",
        "error",
        "wall_time",
        "work",
        "pairs",
    ];
    csv(&columns, lines.into_iter())
}
