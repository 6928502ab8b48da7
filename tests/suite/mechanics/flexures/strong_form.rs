//! A second method for the same beams, sharing no line with the library's: the differential equations of
//! Reissner's beam are integrated along each flexure by Taylor series, from cell to cell, and Newton's method
//! makes the ends of the cells meet (multiple shooting). The tangents of the cells are carried along by dual
//! numbers.
//!
//! ```text
//! theta' = M/EI + theta_0'       N = H cos theta + Q sin theta      V = Q cos theta - H sin theta
//! M' = -(1 + N/EA) V + N V/GA_s
//! px' = (1 + N/EA) cos theta - V/GA_s sin theta      py' = (1 + N/EA) sin theta + V/GA_s cos theta
//! ```
//!
//! Where it stands: good to some 1e-12 of the force as long as a cell is not longer than the boundary layer
//! at a clamp; stability is not tested, the branch is that of the guess.

mod strip;

use std::f64::consts::PI;

use interwell::mechanics::flexure::Geometry;
use nalgebra::{DMatrix, DVector};
use strip::{Cell, Strip};

/// Both groups, with the number of cells that each flexure is cut into.
#[derive(Clone)]
pub struct StrongForm {
    strips: [Strip; 2],
    preload: f64,
    /// By how much a bowed flexure is shorter than its arc from the start.
    natural_shortening: f64,
    cells: usize,
    length: f64,
    force: f64,
}

/// The mechanism held at one x, in SI.
#[derive(Clone)]
pub struct Held {
    pub x: f64,
    pub force: f64,
    pub stiffness: f64,
    pub axial: f64,
    /// Strain energy; not 0 at x = 0.
    pub energy: f64,
    /// Shortening of a flexure of each group, and how far its middle is from the middle of the sway.
    pub shortening: [f64; 2],
    pub bump: [f64; 2],
    /// The largest moment at the ends of the cells of each group's flexures, over EI.
    pub curvature: [f64; 2],
    unknowns: DVector<f64>,
}

impl StrongForm {
    /// `cells`, an even number, for each flexure.
    pub fn new(geometry: &Geometry, cells: usize) -> Self {
        let shear_modulus = geometry.young / (2.0 * (1.0 + geometry.poisson));
        let modulus = if geometry.plane_strain {
            geometry.young / (1.0 - geometry.poisson * geometry.poisson)
        } else {
            geometry.young
        };
        let inertia = |width: f64| width * geometry.thickness.powi(3) / 12.0;
        let length = geometry.buckling.length;
        let force = modulus * inertia(geometry.buckling.width) / (length * length);
        let strip = |g: usize| {
            let group = [&geometry.parallel, &geometry.buckling][g];
            let area = group.width * geometry.thickness;
            Strip {
                count: group.count as f64,
                length: group.length / length,
                bending: modulus * inertia(group.width) / (force * length * length),
                stretch: force / (modulus * area),
                shear: force / (5.0 / 6.0 * shear_modulus * area),
                bow: if g == 1 { PI * geometry.initial_bow / length } else { 0.0 },
            }
        };
        let strips = [strip(0), strip(1)];
        // The trapezium rule of a periodic function is exact to rounding.
        let versine = |i: usize| 2.0 * (0.5 * strips[1].natural(i as f64 / 64.0).0).sin().powi(2) / 64.0;
        let natural_shortening = (0..64).map(versine).sum();
        Self { strips, preload: geometry.preload / length, natural_shortening, cells, length, force }
    }

    /// A guess for x = 0: the `bumped` group takes up what compression alone does not.
    fn guess(&self, bumped: usize) -> DVector<f64> {
        let m = self.cells;
        let mut all = DVector::zeros(4 * m + 3);
        let strip = &self.strips[bumped];
        let wave = 2.0 * PI / strip.length;
        let load = strip.count * strip.bending * wave * wave;
        let squeezed: f64 = self.strips.iter().map(|s| load * s.length * s.stretch / s.count).sum();
        let left = self.preload - squeezed + if bumped == 1 { self.natural_shortening } else { 0.0 };
        let size = 2.0 * (left.max(0.0) / strip.length).sqrt();
        for i in 0..=m {
            let s = strip.length * i as f64 / m as f64;
            all[self.moment(bumped, i)] =
                strip.bending * (size * wave * (wave * s).cos() - strip.natural(s).1);
            if i > 0 && i < m {
                all[self.angle(bumped, i)] = size * (wave * s).sin();
            }
        }
        all[4 * m + 2] = load;
        all
    }

    fn moment(&self, group: usize, i: usize) -> usize {
        2 * self.cells * group + i
    }

    fn angle(&self, group: usize, i: usize) -> usize {
        2 * self.cells * group + self.cells + i
    }

    /// The cells of one group as `unknowns` has them.
    fn shoot(&self, group: usize, unknowns: &DVector<f64>) -> Vec<Cell> {
        let (m, strip) = (self.cells, &self.strips[group]);
        let size = strip.length / m as f64;
        let axial = -unknowns[4 * m + 2] / strip.count;
        let lateral = unknowns[4 * m + group];
        let cell = |i: usize| {
            let theta = if i == 0 { 0.0 } else { unknowns[self.angle(group, i)] };
            strip.cell(size * i as f64, size, [theta, unknowns[self.moment(group, i)], axial, lateral])
        };
        (0..m).map(cell).collect()
    }

    /// Newton's method from `unknowns`; none where it does not converge. `even` keeps a bump away.
    fn newton(&self, x: f64, mut unknowns: DVector<f64>, even: bool) -> Option<Held> {
        let (m, size) = (self.cells, 4 * self.cells + 3);
        let target = x / self.length;
        let mut settled = false;
        for _ in 0..40 {
            let mut matrix = DMatrix::zeros(size, size);
            let mut miss = DVector::zeros(size);
            let (mut energy, mut shortening, mut bump, mut curvature) =
                (0.0, [0.0; 2], [-0.5 * target; 2], [0.0_f64; 2]);
            miss[4 * m + 2] = self.preload + self.natural_shortening;
            for g in 0..2 {
                miss[4 * m + g] = target;
                let by_force = [(4 * m + 2, 3, -1.0 / self.strips[g].count), (4 * m + g, 4, 1.0)];
                for (i, cell) in self.shoot(g, &unknowns).iter().enumerate() {
                    // Each row: what there should be less what the cell makes of its beginning.
                    let (theta_row, moment_row) = (2 * m * g + 2 * i, 2 * m * g + 2 * i + 1);
                    let rows = [
                        (theta_row, cell.ends[0], (i + 1 < m).then(|| self.angle(g, i + 1))),
                        (moment_row, cell.ends[1], Some(self.moment(g, i + 1))),
                        (4 * m + 2, cell.gains[0], None),
                        (4 * m + g, cell.gains[1], None),
                    ];
                    for (row, value, next) in rows {
                        miss[row] -= value.0[0];
                        if i > 0 {
                            matrix[(row, self.angle(g, i))] += value.0[1];
                        }
                        matrix[(row, self.moment(g, i))] += value.0[2];
                        for (column, place, factor) in by_force {
                            matrix[(row, column)] += factor * value.0[place];
                        }
                        if let Some(next) = next {
                            miss[row] += unknowns[next];
                            matrix[(row, next)] -= 1.0;
                        }
                    }
                    energy += self.strips[g].count * cell.gains[2].0[0];
                    shortening[g] += cell.gains[0].0[0];
                    bump[g] += if i < m / 2 { cell.gains[1].0[0] } else { 0.0 };
                    for moment in [unknowns[self.moment(g, i)], cell.ends[1].0[0]] {
                        curvature[g] = curvature[g].max((moment / self.strips[g].bending).abs());
                    }
                }
            }
            let factors = matrix.lu();
            let mut step = factors.solve(&miss)?;
            if even {
                self.symmetrise(&mut step);
            }
            let turns = step.iter().zip(unknowns.iter()).take(4 * m);
            let turn = turns.fold(0.0_f64, |most, (s, u)| most.max(s.abs() / (1.0 + u.abs())));
            unknowns += &step * (1.0 / turn).min(1.0);
            let common = step.iter().skip(4 * m).zip(unknowns.iter().skip(4 * m));
            let change = common.fold(0.0_f64, |most, (s, u)| most.max(s.abs() / (1.0 + u.abs())));
            if settled {
                // The matrix is that of the solution by now.
                let mut one = DVector::zeros(size);
                one[4 * m] = 1.0;
                one[4 * m + 1] = 1.0;
                let along = factors.solve(&one)?;
                let total = |of: &DVector<f64>| {
                    self.strips[0].count * of[4 * m] + self.strips[1].count * of[4 * m + 1]
                };
                return Some(Held {
                    x,
                    force: total(&unknowns) * self.force,
                    stiffness: total(&along) * self.force / self.length,
                    axial: unknowns[4 * m + 2] * self.force,
                    energy: energy * self.force * self.length,
                    shortening: [shortening[0], shortening[1] - self.natural_shortening]
                        .map(|u| u * self.length),
                    bump: bump.map(|w| w * self.length),
                    curvature: curvature.map(|k| k / self.length),
                    unknowns,
                });
            }
            settled = change < 1e-10 && turn < 1e-8;
            if !change.is_finite() {
                return None;
            }
        }
        None
    }

    /// Takes out what is not symmetric about the middle of a flexure: the bump.
    fn symmetrise(&self, unknowns: &mut DVector<f64>) {
        let m = self.cells;
        for g in 0..2 {
            for i in 0..=m / 2 {
                let (a, b) = (self.moment(g, i), self.moment(g, m - i));
                let half = 0.5 * (unknowns[a] - unknowns[b]);
                (unknowns[a], unknowns[b]) = (half, -half);
                if i > 0 {
                    let (a, b) = (self.angle(g, i), self.angle(g, m - i));
                    let half = 0.5 * (unknowns[a] + unknowns[b]);
                    (unknowns[a], unknowns[b]) = (half, half);
                }
            }
        }
    }

    /// The buckled states at `positions`, ascending from 0, with the bump in this group.
    pub fn buckled(&self, positions: &[f64], bumped: usize) -> Vec<Held> {
        let start = self.newton(0.0, self.guess(bumped), false).expect("a buckled state at 0");
        self.follow(start, positions, false)
    }

    /// The states without a bump at `positions`, ascending, from a buckled one next to the kink.
    pub fn taut(&self, beside: &Held, positions: &[f64]) -> Vec<Held> {
        let mut unknowns = beside.unknowns.clone();
        self.symmetrise(&mut unknowns);
        let start = self.newton(beside.x, unknowns, true).expect("a taut state beside the kink");
        self.follow(start, positions, true)
    }

    fn follow(&self, start: Held, positions: &[f64], even: bool) -> Vec<Held> {
        let (mut before, mut last): (Option<Held>, Held) = (None, start);
        let mut all = Vec::new();
        for x in positions {
            while last.x != *x || all.is_empty() {
                let mut step = x - last.x;
                let next = loop {
                    let to = if step == x - last.x { *x } else { last.x + step };
                    let guess = match &before {
                        Some(before) if before.x != last.x => {
                            let part = (to - last.x) / (last.x - before.x);
                            &last.unknowns + (&last.unknowns - &before.unknowns) * part.min(3.0)
                        }
                        _ => last.unknowns.clone(),
                    };
                    if let Some(next) = self.newton(to, guess, even) {
                        break next;
                    }
                    step *= 0.5;
                    assert!(step.abs() > 1e-9 * self.length, "lost at {to:e}");
                };
                before = Some(std::mem::replace(&mut last, next));
                if last.x == *x {
                    break;
                }
            }
            all.push(last.clone());
        }
        all
    }

    /// How a small bump of this group fares: the rotation in the middle that a unit moment at the clamp
    /// makes. It vanishes with the bump, at the kink.
    fn bump_condition(&self, held: &Held, group: usize) -> f64 {
        let (mut theta, mut moment) = (0.0, 1.0);
        for cell in self.shoot(group, &held.unknowns).iter().take(self.cells / 2) {
            let [a, b] = cell.ends.map(|end| end.0[1] * theta + end.0[2] * moment);
            (theta, moment) = (a, b);
        }
        theta
    }

    /// The kink near the buckled state `beside`: there a bump of this group fits the taut flexure, without a
    /// force of its own.
    pub fn kink(&self, beside: &Held, group: usize) -> Held {
        let mut held = self.taut(beside, &[beside.x]).remove(0);
        let mut value = self.bump_condition(&held, group);
        let mut x = held.x * (1.0 + 1e-6);
        for _ in 0..40 {
            let next = self.follow(held.clone(), &[x], true).remove(0);
            let new = self.bump_condition(&next, group);
            let slope = (new - value) / (next.x - held.x);
            (held, value) = (next, new);
            let step = -value / slope;
            if !(step.abs() > 1e-13 * x) {
                return held;
            }
            x += step;
        }
        panic!("no kink near {x:e}")
    }
}
