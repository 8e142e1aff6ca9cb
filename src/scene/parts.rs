//! A scene is made of these parts, checked.

use crate::method::basis::Basis;
use crate::method::choice::{Filter, Law, Mass, Method};
use crate::method::continuum::law::Elastic;
use crate::method::exact::riemann::End;
use crate::method::reading::Kinematics;
use crate::method::reconstruction::Reconstruction;

/// A scene is checked: every value is in range and every list has one entry for each axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The file's name without its ending, or "scene": where the results go.
    pub name: String,
    pub title: String,
    pub method: Method,
    pub mass: Mass,
    pub kinematics: Kinematics,
    pub filter: Option<Filter>,
    pub reconstruction: Option<Reconstruction>,
    pub body: Body,
    pub grid: GridSpec,
    pub basis: Basis,
    pub time: Time,
    pub check: Check,
    /// For each axis its lower and upper side.
    pub boundary: Vec<[Side; 2]>,
    pub motion: Motion,
    pub body_force: Option<BodyForceSpec>,
    pub traction: Option<TractionSpec>,
    pub probes: Vec<Probe>,
    /// Record every so many steps.
    pub every: usize,
    /// Write the particles for ParaView whenever a step is recorded.
    pub vtk: bool,
}

/// A run may be off by so much before it ends by name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Check {
    /// The growth of the energy, as a share of the largest that start and loads have given (–).
    pub energy: f64,
    /// How far the material may turn with the rate law (rad).
    pub rotation: f64,
}

/// The body is a box of elastic material.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// L along each axis (m).
    pub length: Vec<f64>,
    /// The lower corner (m).
    pub origin: Vec<f64>,
    /// ρ at the start (kg/m³).
    pub density: f64,
    pub law: Law,
    /// E (Pa).
    pub youngs_modulus: f64,
    /// ν (–).
    pub poisson_ratio: f64,
    /// The material is inside these; without any it fills the box.
    pub balls: Vec<Ball>,
}

impl Body {
    /// Gives the material with its moduli.
    pub fn elastic(&self) -> Elastic {
        Elastic::new(self.law, self.youngs_modulus, self.poisson_ratio)
    }
}

/// A ball holds the points within a radius: in 2D it is a disc.
#[derive(Clone, Debug, PartialEq)]
pub struct Ball {
    /// From the body's lower corner (m).
    pub centre: Vec<f64>,
    /// (m).
    pub radius: f64,
}

/// This declares cells and particles.
#[derive(Clone, Debug, PartialEq)]
pub struct GridSpec {
    /// Cells over the body along each axis.
    pub cells: Vec<usize>,
    /// Particles per cell along each axis.
    pub particles_per_cell: Vec<usize>,
    /// Cells before and after the body along each axis.
    pub beyond: Vec<[usize; 2]>,
    /// How far the particles of MPM stand from the middle of their share of the body, along
    /// every axis to one side and the other in turn, in units of their distance. No key sets
    /// it: a scene has 0, and a study moves them to see whether a result hangs on where they
    /// stand.
    pub offset: f64,
}

/// This declares the time step and the end of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Time {
    /// The largest Courant number c Δt / h; infinite where only the next bounds it, or load steps
    /// are counted.
    pub cfl: f64,
    /// The largest Δt, as a part of the predicted limit.
    pub fraction_of_critical: Option<f64>,
    /// The number of load steps of a quasi-static run, which has no time step.
    pub load_steps: Option<usize>,
    /// Run even if the predicted limit of Δt says that it must blow up.
    pub allow_unstable: bool,
    /// Particles may move so many cells until the limit of Δt is looked at again; 0 for no
    /// watch.
    pub watch: f64,
    /// The end of the run (s).
    pub end: f64,
}

/// A side says which components of the velocity are zero there; with none it is free.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Side {
    pub fixed: Vec<bool>,
}

impl Side {
    /// Tells whether some component of the velocity is zero there.
    pub fn holds(&self) -> bool {
        self.fixed.contains(&true)
    }

    /// Gives the end of a bar along `axis` with this side.
    pub fn end(&self, axis: usize) -> End {
        if self.fixed[axis] { End::Fixed } else { End::Free }
    }
}

/// The motion says how the body moves at the start.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// At rest but for these regions.
    Regions(Vec<Region>),
    /// v = V φ(x) in a natural mode of the bar.
    Vibration { mode: usize, velocity: f64 },
    /// u_i = A φ(X_i) sin(ωt + θ_i), kept going at finite strain by a body force.
    Manufactured(ManufacturedSpec),
    /// A ring about the middle of the body turns to and fro, kept going by a body force.
    Vortex(VortexSpec),
}

/// This declares a motion in modes along every axis.
#[derive(Clone, Debug, PartialEq)]
pub struct ManufacturedSpec {
    pub mode: usize,
    /// A (m).
    pub amplitude: f64,
    /// ω (rad/s).
    pub frequency: f64,
    /// θ along each axis (rad).
    pub phase: Vec<f64>,
}

/// This declares a ring that turns by A sin ωt at its middle radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VortexSpec {
    /// R_0 (m).
    pub radius: f64,
    /// A (rad).
    pub angle: f64,
    /// ω (rad/s).
    pub frequency: f64,
}

/// This declares a force per mass, the same everywhere.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyForceSpec {
    /// b (m/s²).
    pub acceleration: Vec<f64>,
    /// The time over which it grows linearly (s); 0 for at once.
    pub ramp: f64,
}

/// This declares tractions on the sides of the box.
#[derive(Clone, Debug, PartialEq)]
pub struct TractionSpec {
    /// For each axis its lower and upper side: t (Pa) per area at t = 0.
    pub sides: Vec<[Vec<f64>; 2]>,
    /// The time over which they grow linearly (s); 0 for at once.
    pub ramp: f64,
}

/// A region is a box [from, to) in the body's frame with an initial velocity, v + ω × r from its
/// middle.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Lower corner from the body's lower corner (m).
    pub from: Vec<f64>,
    /// Upper corner from the body's lower corner (m).
    pub to: Vec<f64>,
    /// v (m/s).
    pub velocity: Vec<f64>,
    /// ω in 2D (rad/s), 0 elsewhere.
    pub spin: f64,
}

/// A probe follows a quantity at the particle nearest to a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    pub name: String,
    pub quantity: Quantity,
    /// From the body's lower corner (m).
    pub position: Vec<f64>,
}

/// A quantity is a component of a particle's state, axes counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    Velocity(usize),
    Stress(usize, usize),
    Displacement(usize),
}

impl Quantity {
    /// Gives the name, for the labels of axes, and the unit.
    pub fn name_unit(&self) -> (&'static str, &'static str) {
        match self {
            Quantity::Velocity(_) => ("velocity", "m/s"),
            Quantity::Stress(..) => ("stress", "Pa"),
            Quantity::Displacement(_) => ("displacement", "m"),
        }
    }
}

impl Region {
    /// Tells whether a point is in the box [from, to), x from the body's lower corner.
    pub fn contains(&self, x: &[f64]) -> bool {
        (self.from.iter().zip(&self.to).zip(x)).all(|((from, to), x)| from <= x && x < to)
    }

    /// Gives component `d` of the velocity (m/s) at `x` (m), v_d + (ω × r)_d.
    pub fn velocity_at(&self, x: &[f64], d: usize) -> f64 {
        if self.spin == 0.0 {
            return self.velocity[d];
        }
        let r = |d: usize| x[d] - 0.5 * (self.from[d] + self.to[d]);
        self.velocity[d] + if d == 0 { -self.spin * r(1) } else { self.spin * r(0) }
    }

    /// Gives the largest size of component `d` of the velocity in the region (m/s).
    pub fn fastest(&self, d: usize) -> f64 {
        let across = if self.spin == 0.0 { 0.0 } else { self.to[1 - d] - self.from[1 - d] };
        self.velocity[d].abs() + 0.5 * (self.spin * across).abs()
    }
}

impl Scene {
    /// Counts the axes: 1, 2 or 3.
    pub fn dimension(&self) -> usize {
        self.body.length.len()
    }

    /// Gives both ends along an axis, by the component of the velocity along it.
    pub fn ends(&self, axis: usize) -> [End; 2] {
        let [lower, upper] = &self.boundary[axis];
        [lower.end(axis), upper.end(axis)]
    }

    /// Tells whether forces act from outside.
    pub fn is_loaded(&self) -> bool {
        let kept_going = matches!(self.motion, Motion::Manufactured(_) | Motion::Vortex(_));
        kept_going || self.body_force.is_some() || self.traction.is_some()
    }
}
