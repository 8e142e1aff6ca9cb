//! What is under test: schemes, bases and mass matrices by name, and what theory says of
//! each.

use super::Each;

/// Changes of a scene, `KEY=VALUE`.
pub type Sets = &'static [&'static str];

/// A scheme under test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// It names the scheme in tables and snapshots.
    pub name: &'static str,
    pub sets: Sets,
    /// Stress and velocity are those of one leapfrog with Newmark's method: the mapping to
    /// the nodes and back filters the velocity before it strains, the energy stays, and a
    /// light node takes nothing from the time step. The other schemes lose energy.
    pub leapfrog: bool,
    pub force: StepForce,
    /// The order in Δt on smooth data, where a single one fits.
    pub order: Each<Option<f64>>,
    pub carries_acceleration: bool,
}

/// The force that one step adds to the momentum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepForce {
    MeanOfBothEnds,
    AtItsStart,
    /// Generalized-α has a recurrence, which starts from the acceleration of k = 0.
    Recurrence {
        rho_b: f64,
    },
}

pub const NEWMARK: Scheme = Scheme {
    name: "newmark",
    sets: &["time.integrator=newmark"],
    leapfrog: true,
    force: StepForce::MeanOfBothEnds,
    order: Each { v: Some(2.0), sigma: Some(2.0), u: None },
    carries_acceleration: true,
};

/// Step 8 adds f Δt, and so the displacement counts half of it twice.
pub const NEWMARK_AS_PRINTED: Scheme = Scheme {
    name: "newmark as printed",
    sets: &["time.integrator=newmark", "time.reading=as-printed"],
    order: Each { v: Some(2.0), sigma: Some(2.0), u: Some(1.0) },
    ..NEWMARK
};

/// The velocity of this and the other Euler forms stands half a step off.
pub const STRESS_FIRST: Scheme = Scheme {
    name: "euler (first)",
    sets: &["time.integrator=forward-euler", "time.stress_update=first"],
    force: StepForce::AtItsStart,
    order: Each { v: Some(1.0), sigma: Some(2.0), u: Some(1.0) },
    carries_acceleration: false,
    ..NEWMARK
};

pub const STRESS_LAST: Scheme = Scheme {
    name: "euler (last)",
    sets: &["time.integrator=forward-euler", "time.stress_update=last"],
    leapfrog: false,
    order: Each { v: Some(1.0), sigma: None, u: None },
    ..STRESS_FIRST
};

pub const MODIFIED_LAST: Scheme = Scheme {
    name: "euler (modified last)",
    sets: &["time.integrator=forward-euler", "time.stress_update=modified-last"],
    order: Each { v: Some(1.0), sigma: Some(2.0), u: None },
    ..STRESS_FIRST
};

pub const CORRECTED_EULER: Scheme =
    Scheme { name: "corrected euler", sets: &["time.integrator=corrected-euler"], ..MODIFIED_LAST };

/// Generalized-α maps its acceleration, so that no single order fits its velocity either.
pub const GENERALIZED_ALPHA: Scheme = Scheme {
    name: "generalized-α (0.8)",
    sets: &["time.integrator=generalized-alpha", "time.rho_b=0.8"],
    leapfrog: false,
    force: StepForce::Recurrence { rho_b: 0.8 },
    order: Each { v: None, sigma: None, u: None },
    carries_acceleration: true,
};

/// All schemes with their variants.
pub const SCHEMES: [Scheme; 7] = [
    NEWMARK,
    NEWMARK_AS_PRINTED,
    STRESS_FIRST,
    STRESS_LAST,
    MODIFIED_LAST,
    CORRECTED_EULER,
    GENERALIZED_ALPHA,
];

/// A basis under test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BasisCase {
    /// It names the basis in tables.
    pub name: &'static str,
    /// It names the basis in the names of snapshots.
    pub file: &'static str,
    pub sets: Sets,
    /// Nodes outside the body see it from afar and are light.
    pub reaches_far: bool,
    /// The order in h on smooth data, where one is known: v, σ and u.
    pub order: Option<Each<f64>>,
}

/// The basis that the bar's scene has of itself.
pub const LINEAR: BasisCase = BasisCase {
    name: "linear",
    file: "linear",
    sets: &[],
    reaches_far: false,
    order: Some(Each { v: 2.0, sigma: 1.0, u: 2.0 }),
};

pub const UGIMP: BasisCase =
    BasisCase { name: "ugimp", file: "ugimp", sets: &["basis.kind=ugimp"], ..LINEAR };

pub const BSPLINE: BasisCase = BasisCase {
    name: "bspline",
    file: "bspline",
    sets: &["basis.kind=bspline"],
    reaches_far: false,
    order: None,
};

pub const LME_WIDE: BasisCase = BasisCase {
    name: "lme γ = 0.8",
    file: "lme_0.8",
    sets: &["basis.kind=lme", "basis.gamma=0.8"],
    reaches_far: true,
    order: None,
};

pub const LME_MIDDLE: BasisCase = BasisCase {
    name: "lme γ = 1.8",
    file: "lme_1.8",
    sets: &["basis.kind=lme", "basis.gamma=1.8"],
    ..LME_WIDE
};

pub const LME_NARROW: BasisCase = BasisCase {
    name: "lme γ = 4",
    file: "lme_4",
    sets: &["basis.kind=lme", "basis.gamma=4"],
    reaches_far: false,
    order: None,
};

/// Every basis of the bar.
pub const BASES: [BasisCase; 6] = [LINEAR, UGIMP, BSPLINE, LME_WIDE, LME_MIDDLE, LME_NARROW];

/// A mass matrix under test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassCase {
    pub name: &'static str,
    pub sets: Sets,
}

pub const LUMPED: MassCase = MassCase { name: "lumped", sets: &["mass=lumped"] };
pub const CONSISTENT: MassCase = MassCase { name: "consistent", sets: &["mass=consistent"] };
pub const MASSES: [MassCase; 2] = [LUMPED, CONSISTENT];
