//! Knows from a trace which scheme it is of, and what each step of a scheme usually suffers
//! from.

use super::entry::Entry;

/// A scheme shows in which step makes which symbol.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TracedScheme {
    Newmark,
    EulerFirst,
    EulerLast,
    /// Modified-last and the corrected form, which map the momentum once more.
    EulerMapped,
    GeneralizedAlpha,
    Otm,
    /// Level 0 of the kit: no time step.
    Kernel,
}

impl TracedScheme {
    /// Finds the scheme of a trace.
    pub fn of(entries: &[Entry]) -> TracedScheme {
        let has =
            |step: usize, symbol| entries.iter().any(|e| (e.step, e.symbol) == (step, symbol));
        if entries.iter().any(|e| e.symbol == "x_I") {
            TracedScheme::Otm
        } else if entries.iter().any(|e| e.symbol == "a_I") {
            TracedScheme::GeneralizedAlpha
        } else if has(9, "v_p") || has(1, "v_p") {
            TracedScheme::Newmark
        } else if has(3, "d_eps_p") {
            TracedScheme::EulerFirst
        } else if has(7, "v_I") {
            TracedScheme::EulerMapped
        } else if has(7, "d_eps_p") {
            TracedScheme::EulerLast
        } else {
            TracedScheme::Kernel
        }
    }
}

/// Says what a symbol of a step usually suffers from.
pub fn of_step(entry: &Entry, theirs: f64, scheme: TracedScheme) -> Option<&'static str> {
    let place = (entry.symbol, entry.step);
    if entry.k == 0 && entry.symbol == "d_eps_p" && scheme == TracedScheme::Newmark {
        return Some("at k = 0 Δt is 0, and so is every increment");
    }
    given(place)
        .or_else(|| match scheme {
            TracedScheme::Newmark => of_newmark(place, entry.value, theirs),
            TracedScheme::EulerFirst | TracedScheme::EulerLast | TracedScheme::EulerMapped => {
                of_euler(place, scheme)
            }
            TracedScheme::GeneralizedAlpha => of_generalized_alpha(place),
            TracedScheme::Otm => of_otm(place),
            TracedScheme::Kernel => None,
        })
        .or_else(|| of_all(entry.symbol))
}

/// Says what the start suffers from: one table, which is why this function is long.
fn given(place: (&str, usize)) -> Option<&'static str> {
    Some(match place {
        ("dt", _) => {
            "Δt = T/n, n the next whole number from T c/(CFL h) up, h the smallest of all axes, c = √((λ + 2μ)/ρ)"
        }
        ("h", _) => "h = L/cells along each axis",
        ("E" | "nu" | "gamma", _) => "another scene",
        ("m_p", _) => {
            "the mass of a particle is ρ times its share of the body, with Gauss's weights for OTM"
        }
        ("x_p", 0) => {
            "the start: each particle in the middle of its equal share of a cell, at Gauss's points for OTM; x fastest"
        }
        ("x_I", 0) => {
            "the start: nodes at the corners of the cells that hold particles, in ascending order"
        }
        ("v_p", 0) => "the start: the velocity of the first region that the particle stands in",
        ("a_p", 0) => "the start: under loads a_p is that of the forces at t = 0, else 0",
        ("v_I", 0) => "the start: v_a = Σ m_p v_p N/m_a",
        _ => return None,
    })
}

fn of_newmark(place: (&str, usize), right: f64, theirs: f64) -> Option<&'static str> {
    Some(match place {
        ("x_p", 1) => {
            "(27) moves with the nodes, not with v_p: Σ N (Δt p_I/m_I + ½ Δt² f_I/m_I), p_I as step 8 has left it, N of the step before"
        }
        ("v_p", 1) => "(28) is half a step, ½ Δt Σ N f_I/m_I, with f_I and N of the step before",
        ("v_p" | "a_p", 9) => {
            "(29) is half a step, ½ Δt Σ N f_I/m_I, with the new f_I and the new N"
        }
        ("d_eps_p", 5) if right == 0.0 && theirs != 0.0 => {
            "all nodes move alike: one without mass has no velocity, and moves with the others (16)"
        }
        ("d_eps_p", 5) => "(16) takes v_I of step 4 and the new ∇N, and only the symmetric part",
        ("G_p", 5) => {
            "G is the gradient of the predictor's displacement, with ∇N of the step before"
        }
        ("v_I", 4) => "v_I = p_I/m_I; or is one of the two with the consistent mass matrix?",
        ("f_int_I", 7) => "(14) takes the new σ and ρ: m_p/ρ_p is the volume",
        ("p_I_advanced", 8) => "step 8 adds γ f Δt; as printed, f Δt (time.reading)",
        _ => return None,
    })
}

fn of_euler(place: (&str, usize), scheme: TracedScheme) -> Option<&'static str> {
    Some(match (place.0, scheme) {
        ("x_p", _) => "(21) moves with the advanced momentum: Δt Σ N (p_I + f_I Δt)/m_I",
        ("v_p", _) => {
            "(20) adds Δt Σ N f_I/m_I: increments of the nodes' velocity, not the velocity itself"
        }
        ("p_I_advanced", _) => "(18) adds the whole of f_I Δt in Euler's forms",
        ("f_int_I", TracedScheme::EulerFirst) => {
            "with stress-first the forces are of the new σ (time.stress_update)"
        }
        ("f_int_I", _) => {
            "with stress-last the forces are of σ and ρ of the step before (time.stress_update)"
        }
        ("v_I", TracedScheme::EulerMapped) if place.1 == 7 => {
            "the momentum is mapped anew with the new v_p and the old N, and fixed nodes are set to 0 again"
        }
        ("d_eps_p", TracedScheme::EulerFirst) => {
            "with stress-first the strain is of the mapped v_I, before the momentum is advanced"
        }
        ("d_eps_p", TracedScheme::EulerLast) => {
            "with stress-last the strain is of the advanced v_I"
        }
        ("d_eps_p", _) => "the strain is of the momentum mapped anew (time.stress_update)",
        _ => return None,
    })
}

fn of_generalized_alpha(place: (&str, usize)) -> Option<&'static str> {
    Some(match place {
        ("a_I", 3) => {
            "a_I of k is Σ m_p a_p N/m_I, with the a_p that the particle carries from (26)"
        }
        ("a_I", _) => "(1 − α_m) a_I(k+1) + α_m a_I(k) = f_I/m_I with α_m = (2ρ_b − 1)/(1 + ρ_b)",
        ("v_p", _) => "(24) weighs with γ = 3/2 − α_m: Δt Σ N ((1 − γ) a_I(k) + γ a_I(k+1))",
        ("x_p", _) => {
            "(25) weighs with β: Σ N (Δt v_I + Δt² ((½ − β) a_I(k) + β a_I(k+1))), β = (5 − 3ρ_b)/((1 + ρ_b)² (2 − ρ_b))"
        }
        ("a_p", _) => "(26) is Σ N a_I(k+1), all of it, and is carried to the next step",
        ("v_I", 7) => {
            "the strain is of the displacement inside (25) over Δt: v_I + Δt ((½ − β) a_I(k) + β a_I(k+1))"
        }
        ("d_eps_p", _) => "the strain is of the displacement inside (25) over Δt, with the old ∇N",
        ("f_int_I", _) => "the forces are of σ and ρ of the step before",
        _ => return None,
    })
}

fn of_otm(place: (&str, usize)) -> Option<&'static str> {
    Some(match place {
        ("m_I", _) => "m_a = Σ m_p N at the start, and stays (nodal_mass)",
        ("v_I", 1) => "a kick is ½ Δt f_a/m_a with the forces of the step before",
        ("v_I", 7) => {
            "a kick is ½ Δt f_a/m_a with the new forces, and with the m_a of the start, which stays (nodal_mass)"
        }
        ("x_I", _) => "nodes move by Δt v_a after the first kick",
        ("x_p", _) => "points move by Δt Σ v_a N with N of the step before",
        ("G_p", _) => {
            "G = Σ Δt v_a ⊗ ∇N with ∇N of the step before: row i is the velocity's, column j the gradient's"
        }
        ("d_eps_p", _) => "Δε is that of the midpoint, sym of G (1 + G/2)⁻¹",
        ("rho_p", _) => "the volume grows by det(1 + G), not by 1 + tr G",
        ("N_Ip" | "grad_N_Ip", 5) => "N is made on the nodes where they stand now",
        _ => return None,
    })
}

/// Says what a symbol suffers from whatever the scheme.
fn of_all(symbol: &str) -> Option<&'static str> {
    Some(match symbol {
        "v_p" | "x_p" => "shares of nodal values: which of them, and N of which place?",
        "rms" => "(39) as printed has no square: √(1/N Σ (φ − φ̂)²)",
        "v" | "sigma" | "u" => {
            "the ends: a fixed one turns the invariant's sign, a free one does not, and both give back the whole wave"
        }
        "lambda" => {
            "λ: γ = βh² (not β/h²), solved on the set that the cut-off leaves; λ in 1/m, for x − x_I"
        }
        "m_I" => "the mass of a particle is ρ times its share of the cell",
        "p_I" => "p_I = Σ m v N with the velocity that the particles have by now",
        "v_I" => "v_I = p_I/m_I; or is one of the two with the consistent mass matrix?",
        "f_int_I" => "σ and ρ are of another moment (time.stress_update), or the volume is not m/ρ",
        "f_ext_I" => {
            "loads: b m_p N, and traction times the area of the particle's own face in the outermost layer, both sides at a corner; of the time that the scheme says, grown by the ramp"
        }
        "f_I" => "f_I = f_int + f_ext, 0 where it is fixed",
        "rho_p" => "the density is updated with the strain increment of this step: ρ/(1 + tr Δε)",
        "d_eps_p" => {
            "the nodal velocity that the strain is taken from: before or after the momentum is advanced, or mapped anew (time.stress_update)"
        }
        "F_p" => "F grows from the left, (1 + G) F, and G is not transposed",
        "sigma_p" => {
            "σ grows by Δσ = λ tr(Δε) 1 + 2μ Δε, with Δε of this step; a hyperelastic σ is that of F, over J"
        }
        _ => return None,
    })
}
