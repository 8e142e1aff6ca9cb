//! The first chapter of the book: one particle between three nodes, by hand, by the one-file
//! method and by the library; its table, its numbers and its picture.

use crate::support::*;
use lme_mpm::method::one_bar::{OneBar, one_bar};
use lme_mpm::port::trace::{Entry, trace};
use std::fmt::Write;

const SCENE: &str = include_str!("../data/scenes/one-particle.toml");

/// All that the program made at k = 0, 1 and 2.
struct Made(Vec<Entry>);

impl Made {
    fn of_the_scene() -> Self {
        Made(trace(&scene(SCENE, &[]), 2).unwrap())
    }

    /// The last value of `symbol` of particle or node `index` in step `step` of time step `k`.
    fn at(&self, k: usize, step: usize, symbol: &str, index: usize) -> f64 {
        let here = |entry: &&Entry| {
            (entry.k, entry.step, entry.symbol) == (k, step, symbol)
                && entry.node.unwrap_or(entry.index) == index
        };
        self.0.iter().rev().find(here).unwrap_or_else(|| panic!("{symbol} of {k}, {step}")).value
    }

    fn says(&self, k: usize, step: usize, symbol: &str, index: usize) -> String {
        short(self.at(k, step, symbol, index))
    }
}

/// A number to four decimals, without zeros at its end.
fn short(x: f64) -> String {
    let rounded = format!("{x:.4}");
    let short = rounded.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" { "0".into() } else { short.into() }
}

/// k = 1 worked with a pencil: Δt = 0.2 s, h = 1 m, m = 2 kg, E = 10 Pa, v = 1 m/s, x = ½ m at
/// k = 0, where both nodes have half of the mass and of the momentum, and node 0 is held.
#[test]
fn one_particle_by_hand() {
    let made = Made::of_the_scene();
    let v_1 = 1.0; // of node 1: half of the momentum over half of the mass
    let x = 0.5 + 0.2 * (0.5 * v_1); // the held node gives the other half of nothing
    let (m_0, m_1) = (2.0 * (1.0 - x), 2.0 * x);
    let d_eps = 0.2 * v_1 / 1.0;
    let (rho, sigma) = (2.0 / (1.0 + d_eps), 10.0 * d_eps);
    let f_1 = -sigma * (2.0 / rho);
    let v = 1.0 + 0.1 * (x * f_1 / m_1);
    for (step, symbol, index, expected) in [
        (1, "x_p", 0, x),
        (1, "v_p", 0, 1.0),
        (2, "N_Ip", 0, 0.4),
        (2, "N_Ip", 1, 0.6),
        (2, "grad_N_Ip", 0, -1.0),
        (3, "m_I", 0, m_0),
        (3, "m_I", 1, m_1),
        (3, "m_I", 2, 0.0),
        (3, "p_I", 1, m_1),
        (4, "v_I", 0, 0.0),
        (4, "v_I", 1, v_1),
        (5, "d_eps_p", 0, d_eps),
        (6, "rho_p", 0, rho),
        (6, "sigma_p", 0, sigma),
        (7, "f_int_I", 0, -f_1),
        (7, "f_I", 0, 0.0),
        (7, "f_I", 1, f_1),
        (8, "p_I_advanced", 1, m_1 * v_1 + 0.1 * f_1),
        (9, "v_p", 0, v),
    ] {
        let computed = made.at(1, step, symbol, index);
        assert!((computed - expected).abs() < 1e-14, "step {step}, {symbol}: {computed}");
    }
    // The predictor of k = 2: both nodal values reach the particle through N = 0.6 alone.
    let (a, v_node) = (0.6 * -2.4 / 1.2, 0.6 * 0.96 / 1.2);
    assert!((made.at(2, 1, "x_p", 0) - (0.6 + 0.2 * v_node + 0.02 * a)).abs() < 1e-14);
    assert!((made.at(2, 1, "v_p", 0) - (0.88 + 0.1 * a)).abs() < 1e-14);
}

/// The lines that the chapter shows make the same numbers.
#[test]
fn one_particle_in_one_file() {
    let bar = OneBar {
        length: 1.0,
        density: 2.0,
        youngs_modulus: 10.0,
        thrown_from: 0.0,
        velocity: 1.0,
        cells: 1,
        particles_per_cell: 1,
        dt: 0.2,
        steps: 2,
    };
    let (made, history) = (Made::of_the_scene(), one_bar(&bar, None).unwrap());
    for (k, [x, v, sigma, rho]) in history.iter().enumerate() {
        for (step, symbol, here) in
            [(1, "x_p", x), (9, "v_p", v), (6, "sigma_p", sigma), (6, "rho_p", rho)]
        {
            assert!((here[0] - made.at(k, step, symbol, 0)).abs() < 1e-15, "{k}: {symbol}");
        }
    }
}

/// What the chapter's table tells, row by row: step, words, symbol in the trace, index, unit.
const ROWS: [(usize, &str, &str, usize, &str); 19] = [
    (1, "place of the particle", "x_p", 0, "m"),
    (1, "its velocity after half of the change", "v_p", 0, "m/s"),
    (2, "share N of node 0", "N_Ip", 0, "–"),
    (2, "share N of node 1", "N_Ip", 1, "–"),
    (3, "mass of node 0", "m_I", 0, "kg"),
    (3, "mass of node 1", "m_I", 1, "kg"),
    (3, "mass of node 2", "m_I", 2, "kg"),
    (3, "momentum of node 0", "p_I", 0, "kg m/s"),
    (3, "momentum of node 1", "p_I", 1, "kg m/s"),
    (4, "velocity of the held node 0", "v_I", 0, "m/s"),
    (4, "velocity of node 1", "v_I", 1, "m/s"),
    (5, "increment of the strain", "d_eps_p", 0, "–"),
    (6, "density", "rho_p", 0, "kg/m³"),
    (6, "stress", "sigma_p", 0, "Pa"),
    (7, "force on node 0 before the wall takes it", "f_int_I", 0, "N"),
    (7, "force on node 1", "f_I", 1, "N"),
    (8, "momentum of node 1 after half of the push", "p_I_advanced", 1, "kg m/s"),
    (9, "acceleration that reaches the particle", "a_p", 0, "m/s²"),
    (9, "its velocity after all of the change", "v_p", 0, "m/s"),
];

/// The chapter's table, and the same numbers by name for its sentences: `m_I[1]@1.3` is the
/// mass of node 1 after step 3 of k = 1.
#[test]
fn one_particle_number_by_number() {
    let made = Made::of_the_scene();
    let mut table = "step,what,k = 0,k = 1,k = 2\n".to_string();
    let mut numbers = "quantity,value,unit\n".to_string();
    for (step, says, symbol, index, unit) in ROWS {
        let [a, b, c] = [0, 1, 2].map(|k| made.says(k, step, symbol, index));
        let in_unit = if unit == "–" { String::new() } else { format!(" ({unit})") };
        writeln!(table, "{step},{says}{in_unit},{a},{b},{c}").unwrap();
        for (k, value) in [a, b, c].iter().enumerate() {
            writeln!(numbers, "{symbol}[{index}]@{k}.{step},{value},{unit}").unwrap();
        }
    }
    approve("one_particle__table", &table);
    approve("one_particle__numbers", &numbers);
}

const BLUE: &str = "#0072b2";
const RED: &str = "#d55e00";
const GREEN: &str = "#00704f";
const INK: &str = "#222222";

/// A panel of the picture: words and shapes at places of its own.
struct Panel(String);

impl Panel {
    /// A node stands at this distance from the panel's left edge for x in m.
    fn at(x: f64) -> f64 {
        46.0 + 104.0 * x
    }

    fn words(&mut self, x: f64, y: f64, colour: &str, says: &str) {
        let says = says.replace('-', "−");
        writeln!(
            self.0,
            "<text x=\"{x:.1}\" y=\"{y}\" fill=\"{colour}\" text-anchor=\"middle\">{says}</text>"
        )
        .unwrap();
    }

    fn arrow(&mut self, from: (f64, f64), to: (f64, f64), colour: &str, tip: &str) {
        writeln!(
            self.0,
            "<path d=\"M {:.1} {} L {:.1} {}\" stroke=\"{colour}\" stroke-width=\"2.5\" \
             marker-end=\"url(#{tip})\"/>",
            from.0, from.1, to.0, to.1
        )
        .unwrap();
    }

    /// The line of the grid with its three nodes; a forgotten one is dashed.
    fn grid(&mut self, forgotten: bool) {
        let (fill, dash) =
            if forgotten { ("#ffffff", " stroke-dasharray=\"3 3\"") } else { ("#444444", "") };
        let (left, right) = (Panel::at(0.0), Panel::at(2.0));
        writeln!(
            self.0,
            "<path d=\"M {left} 150 L {right} 150\" stroke=\"#888888\" stroke-width=\"1.5\"{dash}/>"
        )
        .unwrap();
        for I in 0..3 {
            let x = Panel::at(f64::from(I));
            writeln!(
                self.0,
                "<rect x=\"{:.1}\" y=\"143\" width=\"14\" height=\"14\" fill=\"{fill}\" \
                 stroke=\"#444444\"{dash}/>",
                x - 7.0
            )
            .unwrap();
            self.words(x, 176.0, if forgotten { "#777777" } else { INK }, &format!("node {I}"));
        }
    }

    fn particle(&mut self, x: f64) {
        writeln!(self.0, "<circle cx=\"{:.1}\" cy=\"90\" r=\"10\" fill=\"{BLUE}\"/>", Panel::at(x))
            .unwrap();
    }
}

/// Panel 1: what the particle carries goes to the nodes.
fn to_nodes(made: &Made) -> Panel {
    let mut panel = Panel(String::new());
    let x = made.at(1, 1, "x_p", 0);
    panel.grid(false);
    panel.words(Panel::at(x), 68.0, BLUE, "particle: 2 kg, 1 m/s");
    for I in [0, 1] {
        let node = Panel::at(I as f64);
        panel.arrow((Panel::at(x), 90.0), (node, 138.0), BLUE, "blue");
        let beside = if I == 0 { node - 6.0 } else { node + 34.0 };
        panel.words(beside, 112.0, BLUE, &format!("N = {}", made.says(1, 2, "N_Ip", I)));
    }
    for I in [0, 1, 2] {
        let node = Panel::at(I as f64);
        panel.words(node, 202.0, INK, &format!("{} kg", made.says(1, 3, "m_I", I)));
        panel.words(node, 222.0, INK, &format!("{} kg m/s", made.says(1, 3, "p_I", I)));
    }
    panel.particle(x);
    panel
}

/// Panel 2: the equation of motion is solved on the nodes.
fn solve(made: &Made) -> Panel {
    let mut panel = Panel(String::new());
    let (x, node) = (made.at(1, 1, "x_p", 0), Panel::at(1.0));
    panel.grid(false);
    panel.particle(x);
    let (strain, stress) = (made.says(1, 5, "d_eps_p", 0), made.says(1, 6, "sigma_p", 0));
    panel.words(Panel::at(x) + 20.0, 68.0, BLUE, &format!("strain {strain}, stress {stress} Pa"));
    panel.arrow((node + 8.0, 138.0), (node + 62.0, 138.0), GREEN, "green");
    panel.words(node + 62.0, 126.0, GREEN, &format!("v = {} m/s", made.says(1, 4, "v_I", 1)));
    panel.arrow((node - 8.0, 138.0), (node - 62.0, 138.0), RED, "red");
    panel.words(node - 62.0, 126.0, RED, &format!("force {} N", made.says(1, 7, "f_I", 1)));
    panel.words(Panel::at(0.0), 202.0, INK, "held");
    panel.words(node + 20.0, 202.0, INK, "momentum");
    let (before, after) = (made.says(1, 3, "p_I", 1), made.says(1, 8, "p_I_advanced", 1));
    panel.words(node + 20.0, 222.0, INK, &format!("{before} → {after} kg m/s"));
    panel
}

/// Panel 3: the particle takes its change from the nodes.
fn to_particle(made: &Made) -> Panel {
    let mut panel = Panel(String::new());
    let (x, next, node) = (made.at(1, 1, "x_p", 0), made.at(2, 1, "x_p", 0), Panel::at(1.0));
    panel.grid(false);
    panel.arrow((node, 142.0), (Panel::at(x) + 10.0, 102.0), RED, "red");
    let half = 0.1 * made.at(1, 9, "a_p", 0);
    panel.words(node + 72.0, 122.0, RED, &format!("twice {} m/s", short(half)));
    let v = [(1, 1), (1, 9), (2, 1)].map(|(k, step)| made.says(k, step, "v_p", 0));
    panel.words(150.0, 68.0, BLUE, &format!("velocity {} m/s", v.join(" → ")));
    panel.words(150.0, 212.0, BLUE, &format!("place {} → {} m", short(x), short(next)));
    panel.particle(x);
    panel
}

/// Panel 4: the particle is all that is left.
fn forget(made: &Made) -> Panel {
    let mut panel = Panel(String::new());
    let x = made.at(2, 1, "x_p", 0);
    panel.grid(true);
    panel.particle(x);
    let v = made.says(2, 1, "v_p", 0);
    panel.words(150.0, 68.0, BLUE, &format!("kept: place {} m, {v} m/s,", short(x)));
    let (stress, density) = (made.says(1, 6, "sigma_p", 0), made.says(1, 6, "rho_p", 0));
    panel.words(210.0, 96.0, BLUE, &format!("{stress} Pa, {density} kg/m³"));
    panel.words(150.0, 212.0, "#666666", "what the nodes held is gone");
    panel
}

/// The cycle in four panels, drawn with the numbers of k = 1.
#[test]
fn one_particle_in_pictures() {
    let made = Made::of_the_scene();
    let panels = [
        ("1. Particle → nodes", "steps 2 and 3", to_nodes(&made)),
        ("2. Solve on the nodes", "steps 4 to 8", solve(&made)),
        ("3. Nodes → particle", "step 9, then step 1", to_particle(&made)),
        ("4. Forget the grid", "step 2 again", forget(&made)),
    ];
    let mut body = String::new();
    for (n, (title, steps, panel)) in panels.into_iter().enumerate() {
        let (x, y) = (8 + 308 * (n % 2), 8 + 246 * (n / 2));
        writeln!(
            body,
            "<g transform=\"translate({x} {y})\"><rect width=\"300\" height=\"238\" rx=\"6\" \
             fill=\"#fafafa\" stroke=\"#bbbbbb\"/>\n<text x=\"12\" y=\"26\" font-size=\"18\" \
             font-weight=\"bold\" fill=\"{INK}\">{title}</text>\n<text x=\"12\" y=\"45\" \
             fill=\"#555555\">{steps}</text>\n{}<rect class=\"turn\" style=\"animation-delay: {:.1}s\" \
             width=\"300\" height=\"238\" rx=\"6\" fill=\"none\" stroke=\"{BLUE}\" \
             stroke-width=\"4\"/>\n</g>",
            panel.0,
            1.0 + 1.2 * n as f64
        )
        .unwrap();
    }
    let tips: String = [("blue", BLUE), ("red", RED), ("green", GREEN)]
        .map(|(name, colour)| {
            format!(
                "<marker id=\"{name}\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"5\" \
                 markerHeight=\"5\" orient=\"auto\"><path d=\"M 0 0 L 8 4 L 0 8 z\" \
                 fill=\"{colour}\"/></marker>"
            )
        })
        .concat();
    // A frame goes once through the panels, on a screen whose reader has nothing against it.
    let turn = "<style>.turn { opacity: 0 } @keyframes turn { 0%, 85% { opacity: 1 } 100% { opacity: 0 } } \
                @media screen and (prefers-reduced-motion: no-preference) \
                { .turn { animation: turn 1.2s } }</style>";
    let svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"624\" height=\"500\" \
         viewBox=\"0 0 624 500\" font-family=\"sans-serif\" font-size=\"16\">\n{turn}\n<defs>{tips}</defs>\n\
         <rect width=\"624\" height=\"500\" fill=\"#ffffff\"/>\n{body}</svg>\n"
    );
    approve_picture("one_particle__cycle", svg);
}
