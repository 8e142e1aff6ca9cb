//! The runs that the weights of the work were fitted to: each row of `data/instructions/work.csv` is counted
//! again, counters and instructions.

use crate::cases::{advance, block};
use lme_mpm::method::cost::Cost;
use lme_mpm::method::time;
use lme_mpm::run;
use lme_mpm::scene::{DYKA, SHIPPED};
use lme_mpm::setup;

/// The file says which runs there are.
pub const FILE: &str = include_str!("../../data/instructions/work.csv");

/// Takes so many steps of the run of a row, and says what they have cost.
pub fn steps(body: &str, configuration: &str, count: usize) -> Cost {
    match body {
        "square" => steps_in::<2>(body, configuration, count),
        "cube" => steps_in::<3>(body, configuration, count),
        _ => steps_in::<1>(body, configuration, count),
    }
}

fn steps_in<const D: usize>(body: &str, configuration: &str, count: usize) -> Cost {
    let cells = configuration
        .split_once("grid.cells=[")
        .map_or(0, |(_, cells)| cells.split(',').next().unwrap().parse().unwrap());
    let text = match body {
        "the bar" => DYKA.to_string(),
        "square" | "cube" => block::<D>(cells),
        title => {
            let own = SHIPPED.iter().find(|scene| scene.text.to_lowercase().contains(title));
            own.unwrap().text.to_string()
        }
    };
    let sets: Vec<String> = configuration.split(' ').map(str::to_string).collect();
    let scene =
        run::parse(body, body, &text, &sets).unwrap_or_else(|fault| panic!("{body}: {fault}"));
    let model = setup::model::<D>(&scene);
    let mut state = setup::initial_state(&model, &scene);
    time::start(&mut state, &model, &mut |_, _| {}).unwrap();
    for step in 1..=count {
        advance(&model, &mut state, step);
    }
    state.cost()
}

/// So many steps of a row are counted: less where a step takes more.
pub fn few(body: &str) -> usize {
    match body {
        "square" => 2,
        "cube" => 1,
        _ => 10,
    }
}
