//! Recognises what a mistake has done to the numbers of a symbol: fewer digits, another time
//! step, another order, other axes, a factor, and so on.

use super::entry::{Address, Entry, address};
use std::collections::{HashMap, HashSet};

/// Two traces are looked up side by side.
pub struct Traces<'a> {
    pub reference: &'a HashMap<Address, f64>,
    pub theirs: &'a HashMap<Address, f64>,
    /// The reference in the paper's order, with a 0 where only the port has a node.
    pub all: &'a [Entry],
}

/// A number stands beside that of the port, both what they are and what a step has added to
/// them.
#[derive(Clone, Copy)]
pub struct Both<'a> {
    pub entry: &'a Entry,
    pub right: f64,
    pub own: f64,
}

/// These are all numbers of a symbol that one step of one time step makes.
pub struct Group<'a> {
    pub list: Vec<Both<'a>>,
    /// The reference by index, node and component.
    right: HashMap<(usize, Option<usize>, usize), f64>,
    /// So small is nothing.
    pub nothing: f64,
    pub traces: &'a Traces<'a>,
}

/// Tells whether two numbers are the same but for round-off.
pub fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6 * a.abs().max(b.abs())
}

impl<'a> Traces<'a> {
    fn at(&self, entry: &Entry) -> Option<f64> {
        self.reference.get(&address(entry)).copied()
    }

    fn theirs_at(&self, entry: &Entry) -> Option<f64> {
        let unseen = entry.node.map(|_| 0.0);
        self.theirs.get(&address(entry)).copied().or(unseen)
    }

    /// Gives what the scene says, at the start.
    pub fn given(&self, symbol: &'static str, component: usize) -> Option<f64> {
        self.reference.get(&(0, 0, symbol, 0, None, component)).copied()
    }

    /// Lists the components (I, i) of nodes that are fixed: of what the particles bring them in
    /// some time step they never keep anything.
    pub fn fixed(&self) -> HashSet<(usize, usize)> {
        let nonzero = |symbol: &'static str| {
            let of = self.all.iter().filter(move |e| e.symbol == symbol && e.value != 0.0);
            of.map(|e| (e.index, e.component)).collect::<HashSet<_>>()
        };
        let without =
            |brought, kept| nonzero(brought).difference(&nonzero(kept)).copied().collect();
        let of_momentum: HashSet<(usize, usize)> = without("p_I", "v_I");
        let of_force: HashSet<(usize, usize)> = without("f_int_I", "f_I");
        of_momentum.into_iter().chain(of_force).collect()
    }

    /// Counts the dimensions of the scene, as far as the reference tells.
    pub fn dimension(&self) -> usize {
        (0..3).take_while(|d| self.given("h", *d).is_some()).count()
    }

    /// Takes the numbers beside `entry`, of the same symbol, step and time step.
    pub fn group(&'a self, entry: &Entry, nothing: f64) -> Group<'a> {
        let same = |e: &&Entry| (e.k, e.step, e.symbol) == (entry.k, entry.step, entry.symbol);
        let both = |e: &'a Entry| Some(Both { entry: e, right: e.value, own: self.theirs_at(e)? });
        Group::of(self.all.iter().filter(same).filter_map(both).collect(), nothing, self)
    }

    /// Gives the last number before `entry` of the same symbol and index; for the advanced
    /// momentum the mapped one.
    fn before(&self, entry: &Entry) -> Option<f64> {
        self.given("dt", 0)?; // the cases of a kernel do not follow each other
        if entry.symbol == "p_I_advanced" {
            let steps = (0..entry.step).rev();
            return steps
                .filter_map(|step| self.at(&Entry { step, symbol: "p_I", ..entry.clone() }))
                .next();
        }
        let earlier = (0..entry.step).rev().map(|step| (entry.k, step));
        let last = entry.k.checked_sub(1).map(|k| (0..10).rev().map(move |step| (k, step)));
        earlier
            .chain(last.into_iter().flatten())
            .find_map(|(k, step)| self.at(&Entry { k, step, ..entry.clone() }))
    }
}

impl<'a> Group<'a> {
    fn of(list: Vec<Both<'a>>, nothing: f64, traces: &'a Traces<'a>) -> Group<'a> {
        let place = |e: &Entry| (e.index, e.node, e.component);
        let right = list.iter().map(|both| (place(both.entry), both.right)).collect();
        Group { list, right, nothing, traces }
    }

    /// Tells whether two numbers are the same: relative to them, or to what is nothing.
    fn same(&self, a: f64, b: f64) -> bool {
        near(a, b) || (a - b).abs() <= self.nothing
    }

    /// Tells whether every number of the port is what `right` says: a thousand times nearer to it
    /// than to the reference, wherever the two are apart, and the same elsewhere.
    fn all(&self, right: impl Fn(&Both<'a>) -> Option<f64>) -> bool {
        let mut tells = false;
        let fits = self.list.iter().all(|both| {
            let Some(value) = right(both) else { return false };
            let little = self.nothing + 1e-13 * both.own.abs();
            let apart = (both.own - both.right).abs();
            tells |= apart > little;
            (both.own - value).abs() <= little + if apart > little { 1e-3 * apart } else { 0.0 }
        });
        fits && tells
    }

    /// Goes through the numbers that differ.
    pub fn off(&self) -> impl Iterator<Item = &Both<'a>> {
        self.list.iter().filter(|both| !self.same(both.own, both.right))
    }

    /// Takes what this step has added, in place of the sums; nothing where there was nothing.
    pub fn increments(&self) -> Option<Group<'a>> {
        let added = |both: &Both<'a>| {
            let before = self.traces.before(both.entry)?;
            Some(Both { right: both.right - before, own: both.own - before, ..*both })
        };
        let list = self.list.iter().map(added).collect::<Option<Vec<_>>>()?;
        let large = self.list.iter().fold(0.0_f64, |most, both| most.max(both.right.abs()));
        let nothing = self.nothing.max(1e-14 * large);
        let moved = list.iter().zip(&self.list).any(|(new, old)| !near(new.right, old.right));
        moved.then(|| Group::of(list, nothing, self.traces))
    }

    /// Finds numbers of another time step. They show in the first symbol of it: where others
    /// before it are right, it is no matter of the count.
    pub fn of_another_time(&self) -> Option<String> {
        let own = self.list.first()?.entry;
        let printed = |e: &&Entry| e.k == own.k && self.traces.theirs.contains_key(&address(e));
        let first = self.traces.all.iter().filter(|e| e.step > 0).find(printed)?;
        if (first.step, first.symbol) != (own.step, own.symbol) {
            return None;
        }
        for (by, words) in [(1, "next"), (-1, "last")] {
            let at = |both: &Both| {
                let k = both.entry.k.checked_add_signed(by)?;
                self.traces.at(&Entry { k, ..both.entry.clone() })
            };
            if self.all(at) {
                return Some(format!(
                    "these are the numbers of the {words} time step: k = 0 is the start, k = 1 the \
                     first step"
                ));
            }
        }
        None
    }

    /// Finds numbers of another symbol or step in this time step, or of the same one in the
    /// last.
    pub fn of_another_symbol(&self) -> Option<String> {
        let first = self.list.first()?.entry;
        let pairs = first.node.is_some();
        let mut seen = HashSet::new();
        for other in self.traces.all.iter().filter(|e| e.node.is_some() == pairs) {
            let place = (other.k, other.step, other.symbol);
            let this = (first.k, first.step, first.symbol);
            let last = other.symbol == first.symbol && other.k + 1 == first.k;
            if place == this || !(other.k == first.k || last) || !seen.insert(place) {
                continue;
            }
            let (k, step, symbol) = place;
            if self.all(|both| self.traces.at(&Entry { k, step, symbol, ..both.entry.clone() })) {
                let when = if last { " of the last time step" } else { "" };
                return Some(format!("these are the numbers of {symbol} in step {step}{when}"));
            }
        }
        None
    }

    /// Finds a sum to which nothing was added, or of which only the last addend is there.
    pub fn of_a_sum(&self) -> Option<String> {
        let symbol = self.list.first()?.entry.symbol;
        let changes = |both: &Both| self.traces.before(both.entry) != Some(both.right);
        if self.list.iter().any(changes) && self.all(|both| self.traces.before(both.entry)) {
            return Some(format!("this step has not changed {symbol}"));
        }
        let increment = |both: &Both| Some(both.right - self.traces.before(both.entry)?);
        self.all(increment)
            .then(|| format!("{symbol} is only what this step adds: what was there before is lost"))
    }

    /// Finds nothing where there should be something.
    pub fn of_nothing(&self) -> Option<String> {
        let symbol = self.list.first()?.entry.symbol;
        self.all(|_| Some(0.0))
            .then(|| format!("{symbol} is 0 throughout: it is not computed, or not carried on"))
    }

    /// Finds one factor in all numbers, or a sign.
    pub fn of_a_factor(&self) -> Option<f64> {
        let largest = self.list.iter().max_by(|a, b| a.right.abs().total_cmp(&b.right.abs()))?;
        let factor = largest.own / largest.right;
        let real = factor.is_finite() && factor != 0.0 && self.tells(factor, |_| true);
        (real && self.all(|both| Some(factor * both.right))).then_some(factor)
    }

    /// Tells whether a factor says anything: there are two numbers to have it, or it has a name.
    fn tells(&self, factor: f64, own: impl Fn(usize) -> bool) -> bool {
        let some = self.list.iter().filter(|both| both.right != 0.0 && own(both.entry.component));
        let plain = self.named(factor).trim_start_matches('−').contains('.');
        some.count() > 1 || !plain
    }

    /// Finds one number that is added to all.
    pub fn of_an_offset(&self) -> Option<f64> {
        let first = self.list.first()?;
        let offset = first.own - first.right;
        (self.list.len() > 2 && self.all(|both| Some(both.right + offset))).then_some(offset)
    }
}

/// Components are told apart by their place in a vector or a tensor by rows.
impl<'a> Group<'a> {
    fn components(&self) -> usize {
        self.list.iter().map(|both| both.entry.component + 1).max().unwrap_or(0)
    }

    /// Tells how many axes the components have, and whether they are those of a tensor.
    fn shape(&self) -> Option<(usize, bool)> {
        let d = self.traces.dimension();
        match (self.components(), d) {
            (_, 0) => [(2, (2, false)), (3, (3, false)), (4, (2, true)), (9, (3, true))]
                .into_iter()
                .find(|(count, _)| *count == self.components())
                .map(|(_, shape)| shape),
            (count, d) if d > 1 && count == d => Some((d, false)),
            (count, d) if d > 1 && count == d * d => Some((d, true)),
            _ => None,
        }
    }

    fn with_component(&self, both: &Both<'a>, component: usize) -> Option<f64> {
        self.right.get(&(both.entry.index, both.entry.node, component)).copied()
    }

    /// Finds components that have changed their places: axes swapped, a tensor transposed.
    pub fn of_swapped_axes(&self) -> Option<String> {
        let (d, tensor) = self.shape()?;
        let transposed = |both: &Both<'a>| {
            let c = both.entry.component;
            self.with_component(both, (c % d) * d + c / d)
        };
        if tensor && self.all(transposed) {
            return Some(
                "the tensor is transposed: component i D + j is that of row i, column j".into(),
            );
        }
        const NAMES: [&str; 3] = ["x", "y", "z"];
        for (a, b) in [(0, 1), (1, 2), (0, 2)].into_iter().filter(|pair| pair.1 < d) {
            let turned = |axis: usize| {
                if axis == a {
                    b
                } else if axis == b {
                    a
                } else {
                    axis
                }
            };
            let other = |both: &Both<'a>| {
                let c = both.entry.component;
                let there = if tensor { turned(c / d) * d + turned(c % d) } else { turned(c) };
                self.with_component(both, there)
            };
            if self.all(other) {
                return Some(format!("the axes {} and {} are swapped", NAMES[a], NAMES[b]));
            }
        }
        None
    }

    /// Finds components that have a factor of their own; that of the shear first.
    pub fn of_component_factors(&self) -> Option<String> {
        let (d, tensor) = self.shape()?;
        let symbol = self.list.first()?.entry.symbol;
        let shear = |c: usize| tensor && c / d != c % d;
        for (factor, words) in [
            (2.0, "twice: engineering shear γ_xy = 2 ε_xy is not a component of the tensor"),
            (0.5, "halved: the tensor has ε_xy, and the factor 2μ stands before it"),
            (0.0, "left out"),
        ] {
            let own = |both: &Both<'a>| {
                Some(if shear(both.entry.component) { factor } else { 1.0 } * both.right)
            };
            if self.all(own) {
                return Some(format!("the shear components of {symbol} are {words}"));
            }
        }
        let factor = |c: usize| {
            let of = self.list.iter().filter(|both| both.entry.component == c);
            let largest = of.max_by(|a, b| a.right.abs().total_cmp(&b.right.abs()))?;
            Some(if largest.right == 0.0 { 1.0 } else { largest.own / largest.right })
        };
        let factors = (0..self.components()).map(factor).collect::<Option<Vec<_>>>()?;
        let own = |both: &Both<'a>| Some(factors[both.entry.component] * both.right);
        let tells = |(c, factor): (usize, &f64)| self.tells(*factor, |other| other == c);
        if !self.all(own) || !factors.iter().enumerate().all(tells) {
            return None;
        }
        let mut odd = factors.iter().enumerate().filter(|(_, factor)| !near(**factor, 1.0));
        let (c, factor) = odd.clone().next()?;
        if odd.all(|(_, factor)| near(*factor, -1.0)) {
            return Some(format!("the sign of component {c}"));
        }
        let names: Vec<String> =
            factors.iter().enumerate().map(|(c, factor)| self.named_along(c, *factor)).collect();
        let single = factors.iter().filter(|factor| !near(**factor, 1.0)).count() == 1;
        Some(match single {
            true => format!("component {c} alone has the factor {}", self.named(*factor)),
            false => format!("the components have the factors {}", names.join(", ")),
        })
    }

    /// Says the factor of a component: by its own h, where it is that.
    fn named_along(&self, component: usize, factor: f64) -> String {
        const NAMES: [&str; 3] = ["h_x", "h_y", "h_z"];
        let h = self.traces.given("h", component).filter(|_| component < 3);
        match h {
            Some(h) if near(factor, h) => NAMES[component].to_string(),
            Some(h) if near(factor, 1.0 / h) => format!("1/{}", NAMES[component]),
            _ => self.named(factor),
        }
    }

    /// Says a factor in words, where it is made of what the scene gives.
    pub fn named(&self, factor: f64) -> String {
        let of = |symbol, c| self.traces.given(symbol, c);
        let mut known = vec![
            (2.0, "2".to_string()),
            (0.5, "1/2".into()),
            (4.0, "4".into()),
            (0.25, "1/4".into()),
        ];
        let axes = ["x", "y", "z"];
        for d in 0..self.traces.dimension() {
            let Some(h) = of("h", d) else { continue };
            let name =
                if self.traces.dimension() > 1 { format!("h_{}", axes[d]) } else { "h".into() };
            known.push((h, name.clone()));
            known.push((1.0 / h, format!("1/{name}")));
            known.push((h * h, format!("{name}²")));
            for e in (0..3).filter(|e| *e != d) {
                if let Some(other) = of("h", e) {
                    known.push((h / other, format!("{name}/h_{}", axes[e])));
                }
            }
        }
        if let Some(dt) = of("dt", 0) {
            known.push((dt, "Δt".into()));
            known.push((1.0 / dt, "1/Δt".into()));
        }
        let sign = if factor < 0.0 { "−" } else { "" };
        let found = known.into_iter().find(|(value, _)| near(*value, factor.abs()));
        format!("{sign}{}", found.map_or(format!("{:.6}", factor.abs()), |(_, name)| name))
    }
}

/// Each row is looked for among all: of more rows that would take too long.
const MOST_ROWS: usize = 3000;

/// The order of particles, and of nodes.
impl<'a> Group<'a> {
    /// Finds the same numbers at other indices; for a pair at other nodes.
    pub fn of_another_order(&self) -> Option<String> {
        let pairs = self.list.first()?.entry.node.is_some();
        let what =
            if pairs || self.list[0].entry.symbol.ends_with("_I") { "nodes" } else { "particles" };
        for (by, words) in [(1, "1 instead of 0"), (-1, "1 less than 0")] {
            if self.is_shifted(pairs, by) {
                return Some(format!(
                    "the {what} are numbered off by one: they are counted from {words}"
                ));
            }
        }
        self.permuted(pairs, what)
    }

    /// Tells whether the port has every number at the index, or node, that is `by` larger.
    fn is_shifted(&self, pairs: bool, by: isize) -> bool {
        let (mut told, mut fits, mut looked) = (0, 0, 0);
        let values = self.list.iter().filter(|both| both.right != 0.0);
        for Both { entry, right, own } in values.clone() {
            let moved = |place: usize| place.checked_add_signed(by);
            let there = match pairs {
                true => {
                    entry.node.and_then(moved).map(|I| Entry { node: Some(I), ..(*entry).clone() })
                }
                false => moved(entry.index).map(|index| Entry { index, ..(*entry).clone() }),
            };
            let Some(shifted) = there.and_then(|e| self.traces.theirs_at(&e)) else { continue };
            looked += 1;
            told += usize::from(!self.same(*own, *right));
            fits += usize::from(self.same(shifted, *right));
        }
        told > 0 && fits > 1 && fits == looked && 2 * looked >= values.count()
    }

    /// Finds numbers that are those of the reference in another order: of whole rows for
    /// particles and nodes, of the nodes of each particle for pairs.
    fn permuted(&self, pairs: bool, what: &str) -> Option<String> {
        let group = |e: &Entry| if pairs { e.index } else { 0 };
        let place = |e: &Entry| if pairs { e.node.unwrap_or(0) } else { e.index };
        let mut rows: HashMap<(usize, usize), [Vec<f64>; 2]> = HashMap::new();
        for both in &self.list {
            let row = rows.entry((group(both.entry), place(both.entry))).or_default();
            row[0].push(both.right);
            row[1].push(both.own);
        }
        let zero = |row: &[f64]| row.iter().all(|x| x.abs() <= self.nothing);
        let equal = |a: &[f64], b: &[f64]| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| self.same(*a, *b))
        };
        if rows.len() > MOST_ROWS {
            return None;
        }
        let empty = |n: usize| rows.values().filter(|row| zero(&row[n])).count();
        if empty(0) != empty(1) {
            return None;
        }
        let mut moved = 0;
        for ((of, at), [right, own]) in &rows {
            if zero(own) || equal(own, right) {
                continue;
            }
            let found = rows.iter().find(|((other, place), [right, _])| {
                other == of && place != at && equal(own, right)
            });
            found?;
            moved += 1;
        }
        let all = match what {
            "nodes" => ", over all cells of the grid, those beyond the body included",
            _ => "",
        };
        (moved > 1).then(|| {
            format!(
                "the same numbers in another order: the {what} are numbered with x fastest, then y, \
                 then z{all}"
            )
        })
    }
}
