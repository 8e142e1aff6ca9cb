//! Mistakes of printing, of axes, and in three dimensions.

use super::{Entry, Mistake, Seed};
use crate::support::kit::{BLOCK, STRIP};

const WIDE: &[&str] = &["basis.kind=lme", "basis.gamma=0.8", "time.cfl=0.3"];

const fn strip(
    name: &'static str,
    seed: Seed<2>,
    shows_in: (usize, &'static str),
    says: &'static str,
) -> Mistake<2> {
    Mistake { name, base: STRIP, sets: &[], seed, shows_in, says }
}

const fn wide(
    name: &'static str,
    seed: Seed<2>,
    shows_in: (usize, &'static str),
    says: &'static str,
) -> Mistake<2> {
    Mistake { name, base: STRIP, sets: WIDE, seed, shows_in, says }
}

const fn block(
    name: &'static str,
    seed: Seed<3>,
    shows_in: (usize, &'static str),
    says: &'static str,
) -> Mistake<3> {
    Mistake { name, base: BLOCK, sets: &[], seed, shows_in, says }
}

fn component(symbol: &str, component: usize, factor: f64, e: &mut Entry) {
    if (e.symbol, e.component) == (symbol, component) {
        e.value *= factor;
    }
}

/// A number rounded to `n` significant digits.
fn rounded(x: f64, n: usize) -> f64 {
    format!("{x:.*e}", n - 1).parse().unwrap()
}

pub static MISTAKES: [Mistake<2>; 20] = [
    strip(
        "sign of ∇N along y",
        Seed::Entry(|e| component("grad_N_Ip", 1, -1.0, e)),
        (2, "grad_N_Ip"),
        "sign of component 1",
    ),
    strip(
        "sign of ∇N",
        Seed::Entry(|e| {
            if e.symbol == "grad_N_Ip" {
                e.value = -e.value
            }
        }),
        (2, "grad_N_Ip"),
        "the sign of ∇N",
    ),
    strip(
        "∇N without 1/h",
        Seed::Entry(|e| {
            component("grad_N_Ip", 0, 0.5, e);
            component("grad_N_Ip", 1, 0.3, e)
        }),
        (2, "grad_N_Ip"),
        "factors h_x, h_y",
    ),
    strip(
        "∂N/∂y with 1/h_x",
        Seed::Entry(|e| component("grad_N_Ip", 1, 0.6, e)),
        (2, "grad_N_Ip"),
        "h_y/h_x",
    ),
    strip(
        "axes of ∇N swapped",
        Seed::Entry(|e| {
            if e.symbol == "grad_N_Ip" {
                e.component = 1 - e.component
            }
        }),
        (2, "grad_N_Ip"),
        "axes x and y are swapped",
    ),
    strip(
        "nodes counted from 1",
        Seed::Entry(|e| e.node = e.node.map(|node| node + 1)),
        (2, "N_Ip"),
        "counted from 1",
    ),
    strip(
        "nodes with y fastest",
        Seed::Entry(|e| {
            if let Some(I) = e.node {
                e.node = Some(I / 5 + 4 * (I % 5))
            }
        }),
        (2, "N_Ip"),
        "x fastest",
    ),
    strip(
        "particles counted from 1",
        Seed::Entry(|e| {
            if e.symbol.ends_with("_p") || e.node.is_some() {
                e.index += 1
            }
        }),
        (0, "x_p"),
        "counted from 1",
    ),
    strip(
        "axes of the force swapped",
        Seed::Entry(|e| {
            if e.symbol == "f_int_I" {
                e.component = 1 - e.component
            }
        }),
        (7, "f_int_I"),
        "axes x and y are swapped",
    ),
    strip(
        "p_I of fixed nodes is 0",
        Seed::Printed(|right| {
            right
                .iter()
                .map(|e| {
                    let held = e.symbol == "p_I"
                        && right.iter().any(|v| {
                            (v.k, v.symbol, v.index, v.component)
                                == (e.k, "v_I", e.index, e.component)
                                && v.value == 0.0
                        });
                    Entry { value: if held { 0.0 } else { e.value }, ..e.clone() }
                })
                .collect()
        }),
        (3, "p_I"),
        "what the particles bring",
    ),
    strip(
        "v_p of the corrector in step 1",
        Seed::Printed(|right| {
            right
                .iter()
                .map(|e| {
                    let later = right.iter().find(|a| {
                        (e.step, e.symbol) == (1, "v_p")
                            && (a.k, a.step, a.symbol, a.index, a.component)
                                == (e.k, 9, "v_p", e.index, e.component)
                    });
                    Entry { value: later.map_or(e.value, |a| a.value), ..e.clone() }
                })
                .collect()
        }),
        (1, "v_p"),
        "numbers of v_p in step 9",
    ),
    strip(
        "k one too many",
        Seed::Printed(|right| {
            right
                .iter()
                .map(|e| Entry { k: if e.step > 0 { e.k + 1 } else { e.k }, ..e.clone() })
                .collect()
        }),
        (1, "x_p"),
        "last time step",
    ),
    strip(
        "k one too few",
        Seed::Printed(|right| {
            right
                .iter()
                .filter(|e| e.k != 0 || e.step == 0)
                .map(|e| Entry { k: e.k.saturating_sub(1), ..e.clone() })
                .collect()
        }),
        (1, "x_p"),
        "next time step",
    ),
    strip(
        "all in single precision",
        Seed::Entry(|e| e.value = f64::from(e.value as f32)),
        (0, "dt"),
        "single precision",
    ),
    strip(
        "places in single precision",
        Seed::Entry(|e| {
            if e.symbol == "x_p" {
                e.value = f64::from(e.value as f32)
            }
        }),
        (0, "x_p"),
        "single precision",
    ),
    strip(
        "printed with six digits",
        Seed::Entry(|e| e.value = rounded(e.value, 6)),
        (2, "grad_N_Ip"),
        "6 digits",
    ),
    strip(
        "printed with eight decimals",
        Seed::Entry(|e| e.value = format!("{:.8}", e.value).parse().unwrap()),
        (2, "grad_N_Ip"),
        "8 decimals",
    ),
    wide(
        "sign of λ",
        Seed::Entry(|e| {
            if e.symbol == "lambda" {
                e.value = -e.value
            }
        }),
        (2, "lambda"),
        "the sign of λ",
    ),
    wide(
        "λ without 1/h",
        Seed::Entry(|e| {
            component("lambda", 0, 0.5, e);
            component("lambda", 1, 0.3, e)
        }),
        (2, "lambda"),
        "factors h_x, h_y",
    ),
    wide(
        "cut off after solving",
        Seed::Entry(|e| {
            if e.symbol == "N_Ip" && e.value < 0.01 {
                e.value = 0.0
            }
        }),
        (2, "N_Ip"),
        "before λ is solved",
    ),
];

pub static IN_3D: [Mistake<3>; 4] = [
    block(
        "no slope along z",
        Seed::Entry(|e| component("grad_N_Ip", 2, 0.0, e)),
        (2, "grad_N_Ip"),
        "component 2 alone",
    ),
    block(
        "axes y and z of σ swapped",
        Seed::Entry(|e| {
            if e.symbol == "sigma_p" {
                let turn = |i: usize| [0, 2, 1][i];
                e.component = 3 * turn(e.component / 3) + turn(e.component % 3)
            }
        }),
        (6, "sigma_p"),
        "axes y and z are swapped",
    ),
    block(
        "shear left out",
        Seed::Entry(|e| {
            if e.symbol == "d_eps_p" && e.component % 4 != 0 {
                e.value = 0.0
            }
        }),
        (5, "d_eps_p"),
        "left out",
    ),
    block(
        "nodes with z fastest",
        Seed::Entry(|e| {
            if let Some(I) = e.node {
                let (i, j, k) = (I % 4, I / 4 % 3, I / 12);
                e.node = Some(k + 3 * (j + 3 * i))
            }
        }),
        (2, "N_Ip"),
        "x fastest",
    ),
];
