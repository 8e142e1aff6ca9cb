//! A node that its particles see from afar only is light: whether, and along which axes, is
//! decided here.
//!
//! With m_II/m_I = ε a node's own frequency is c/(εh): no usable time step would be stable, and
//! for ε → 0 the matrix is singular.

use super::shape::Shape;
use super::state::Particles;
use crate::method::grid::odometer;

/// Below this share of m_I a node is light along an axis.
const LIGHT: f64 = 0.25;

/// Light says for each node along which axes it is light.
#[derive(Clone, Debug)]
pub struct Light<const D: usize> {
    /// m_dI = Σ_p N_Ip m_p N_dIp (kg), N_dIp the factor of axis d.
    near: Vec<[f64; D]>,
    /// m_II = Σ_p N_Ip m_p N_Ip (kg).
    own: Vec<f64>,
    along: Vec<[bool; D]>,
    /// It is light, but along no axis.
    alone: Vec<bool>,
    /// It is one or the other.
    any: Vec<bool>,
}

/// A particle sees this node of its row.
#[derive(Clone, Copy, Debug)]
pub struct Sight<const D: usize> {
    pub I: usize,
    /// N_Ip (–).
    pub N: f64,
    /// N_dIp, the factors of a product (–).
    factor: [f64; D],
    /// Its place along each axis of the row; 0 in a list.
    at: [usize; D],
}

/// Lists in `row` the nodes that particle p sees, with the factors of a product.
pub fn look<const D: usize>(row: &mut Vec<Sight<D>>, shape: &Shape<D>, p: usize) {
    row.clear();
    match shape.axes(p) {
        Some(axes) => {
            let mut places = odometer(axes.map(<[_]>::len));
            shape.lines(p, |line| {
                for ((I, N, _), at) in line.entries().zip(&mut places) {
                    let factor = std::array::from_fn(|d| axes[d][at[d]].N);
                    row.push(Sight { I, N, factor, at });
                }
            });
        }
        None => {
            for (I, N, _) in shape.of(p) {
                row.push(Sight { I, N, factor: [0.0; D], at: [0; D] });
            }
        }
    }
}

impl<const D: usize> Light<D> {
    /// Makes the rule for `nodes` nodes, none of them light.
    pub fn blank(nodes: usize) -> Self {
        Light {
            near: vec![[0.0; D]; nodes],
            own: vec![0.0; nodes],
            along: vec![[false; D]; nodes],
            alone: vec![false; nodes],
            any: vec![false; nodes],
        }
    }

    // ANCHOR: light
    /// Finds the light nodes; `m` is m_I (kg), and `row` a buffer.
    ///
    /// With N_Ip = Π_d N_dIp node I is light along axis d when
    /// m_dI = Σ_p N_Ip m_p N_dIp < ¼ m_I. Of particles in rows and columns m_dI/m_I is the
    /// m_ii/m_i of the bar along that axis, whatever the others are.
    /// A node that is light along no axis, but has m_II < 4⁻ᴰ m_I, stands alone. It is seen by
    /// some particles from afar along one axis, by others along another; of particles in rows
    /// and columns there is none, since there m_II/m_I = Π_d m_dI/m_I. Where rows are lists no
    /// node is light along an axis.
    pub fn find(
        &mut self,
        row: &mut Vec<Sight<D>>,
        particle: &Particles<D>,
        shape: &Shape<D>,
        m: &[f64],
    ) {
        self.near.fill([0.0; D]);
        self.own.fill(0.0);
        for p in 0..particle.len() {
            look(row, shape, p);
            for I in row.iter() {
                for d in 0..D {
                    self.near[I.I][d] += I.N * particle.m[p] * I.factor[d];
                }
                self.own[I.I] += I.N * particle.m[p] * I.N;
            }
        }
        let bound: f64 = (0..D).map(|_| LIGHT).product();
        let is_list = (0..particle.len()).any(|p| shape.axes(p).is_none());
        for I in 0..m.len() {
            self.along[I] = self.near[I].map(|m_dI| !is_list && m_dI < LIGHT * m[I]);
            let light = self.along[I].contains(&true);
            self.alone[I] = !light && self.own[I] < bound * m[I];
            self.any[I] = light || self.alone[I];
        }
    }

    /// Says how much of the pair I, J goes to the diagonal: to m_II over m_p N_Ip, and to m_JJ
    /// over m_p N_Jp (–), which is as much; `None` for nothing.
    ///
    /// With a node that stands alone it is N_Jp, all of it. Two nodes on one line along an axis
    /// d, one of them light along it, are tied by N_dJp: in 1D that is all of the pair, and
    /// else more, since it stands for the pairs of I with all nodes that share J's place along
    /// d. A tie does not feel a velocity that is constant along its axis. m_p N_Ip N_dJp is the
    /// same from J's side. A node that is light along d has m_II ≥ m_I − m_dI > ¾ m_I then.
    #[inline(always)]
    pub fn diagonal_shares(&self, I: &Sight<D>, J: &Sight<D>) -> Option<[f64; 2]> {
        if !(self.any[I.I] || self.any[J.I]) || I.I == J.I {
            return None;
        }
        let is_alone = self.alone[I.I] || self.alone[J.I];
        let mut shares = if is_alone { [J.N, I.N] } else { [0.0; 2] };
        let mut apart = (0..D).filter(|d| I.at[*d] != J.at[*d]);
        if let (Some(d), None) = (apart.next(), apart.next())
            && (self.along[I.I][d] || self.along[J.I][d])
        {
            shares[0] += J.factor[d];
            shares[1] += I.factor[d];
        }
        Some(shares)
    }
    // ANCHOR_END: light
}
