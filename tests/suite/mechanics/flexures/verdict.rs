//! Checks of every claim of [`Flexures::solve`] against fresh states.

use interwell::mechanics::flexure::{Flexures, Geometry, State};
use interwell::mechanics::{ForceCurve, Landscape};

/// What the claims are relative to.
pub struct Scales {
    /// The largest force between the wells; with one, that at the edge of the inside.
    pub force: f64,
    /// The depth of the wells; with one, the energy at the edge of the inside.
    pub barrier: f64,
    /// Of the energy of a state, which is a difference from that at x = 0.
    pub rounding: f64,
    /// |k(0)|.
    pub stiffness: f64,
    /// How far the inside reaches.
    pub inside: f64,
}

impl Scales {
    pub fn of(geometry: &Geometry, curve: &ForceCurve, flexures: &Flexures, landscape: &Landscape) -> Self {
        let kink = landscape.kinks.last().map(|kink| kink.x);
        let well = landscape.right_stable().map_or(0.0, |well| well.x);
        let inside = kink.unwrap_or(well);
        // Densely sampled: the largest pull may lie at the kink.
        let pull = (0..=400).map(|i| -curve.force(well.max(inside) * f64::from(i) / 400.0));
        Self {
            force: if landscape.barrier.is_some() {
                pull.fold(0.0, f64::max)
            } else {
                curve.force(inside).abs()
            },
            barrier: landscape.barrier.map_or(curve.potential(inside), |barrier| barrier.from_right_j),
            rounding: 3e-12 * geometry.preload * flexures.state(0.0).map_or(0.0, |state| state.axial),
            stiffness: curve.stiffness(0.0).abs(),
            inside,
        }
    }
}

/// Collects what does not hold.
pub struct Verdict {
    pub faults: Vec<String>,
}

impl Verdict {
    fn at_most(&mut self, what: &str, x: f64, value: f64, bound: f64) {
        if !(value <= bound) {
            self.faults.push(format!("{what} at x = {x:e}: {value:.2e} > {bound:.1e}"));
        }
    }

    fn holds(&mut self, what: &str, x: f64, condition: bool) {
        if !condition {
            self.faults.push(format!("{what} at x = {x:e}"));
        }
    }

    /// Everything that is promised for `geometry` solved to `tolerance`, looked at in `places` (from 0 to 1
    /// along the curve) and beside each kink.
    pub fn of(
        geometry: &Geometry,
        tolerance: f64,
        (curve, flexures): &(ForceCurve, Flexures),
        places: &[f64],
    ) -> Self {
        let mut verdict = Self { faults: Vec::new() };
        let landscape = Landscape::of(curve);
        let scales = Scales::of(geometry, curve, flexures, &landscape);
        verdict.shape(geometry, curve, &landscape);
        let accuracy = flexures.accuracy();
        // without a kink there is no inside, and with one well no barrier to relate an error to
        let may_be_missing = landscape.kinks.is_empty() || landscape.barrier.is_none();
        let inside = |error: f64| if may_be_missing && error.is_nan() { 0.0 } else { error };
        for (name, value, bound) in [
            ("reported force", inside(accuracy.force), tolerance),
            (
                "reported potential",
                inside(accuracy.potential),
                tolerance + (scales.rounding / scales.barrier).max(0.0),
            ),
            ("reported stiffness", inside(accuracy.stiffness), 100.0 * tolerance),
            ("reported outer force", accuracy.outer_force, tolerance),
        ] {
            verdict.at_most(name, f64::NAN, value, bound);
        }
        let end = curve.domain().1;
        let mut positions: Vec<f64> = places.iter().map(|place| place * end).collect();
        let kink = landscape.kinks.last().map(|kink| kink.x);
        if let Some(kink) = kink {
            positions.extend([1e-3, 1e-6, 1e-9].iter().flat_map(|d| [kink * (1.0 - d), kink * (1.0 + d)]));
        }
        let mut last: Option<(f64, State)> = None;
        positions.sort_by(f64::total_cmp);
        for x in positions {
            match flexures.state(x) {
                Err(e) => verdict.faults.push(format!("no state at {x:e}: {e}")),
                Ok(state) => {
                    verdict.state(curve, &scales, tolerance, &state);
                    verdict.bump(geometry, kink, &state);
                    verdict.mirrored(flexures, &state);
                    last = Some((x, state));
                }
            }
        }
        verdict.holds("no state at all", 0.0, last.is_some());
        if let Some(kink) = landscape.kinks.last() {
            let at = flexures.state(kink.x);
            let inner = at.map_or(f64::NAN, |s| (s.stiffness - kink.stiffness_left).abs());
            verdict.at_most(
                "stiffness inside the kink",
                kink.x,
                inner,
                1e-4 * kink.stiffness_left.abs().max(scales.stiffness),
            );
        }
        verdict
    }

    /// What the curve alone shows.
    fn shape(&mut self, geometry: &Geometry, curve: &ForceCurve, landscape: &Landscape) {
        let (start, end) = curve.domain();
        self.holds("the domain is symmetric", end, start == -end && curve.is_odd());
        let shortest = geometry.parallel.length.min(geometry.buckling.length);
        let kink = landscape.kinks.last().map_or(0.0, |kink| kink.x);
        self.at_most("the curve ends too early", end, (1.15 * kink).max(0.1 * shortest), end * (1.0 + 1e-12));
        // A bulge may pass from one group to the other: one, both, the other, none.
        self.holds("at most three kinks a side", end, landscape.kinks.len() <= 6);
        self.holds("pushed back at the end", end, curve.force(end) > 0.0 && curve.stiffness(end) > 0.0);
        self.holds("a stable place", 0.0, landscape.right_stable().is_some());
        self.holds("no force in the middle", 0.0, curve.force(0.0) == 0.0 && curve.potential(0.0) == 0.0);
        for (i, x) in curve.breaks().iter().enumerate() {
            let (left, right) = (&curve.pieces()[i], &curve.pieces()[i + 1]);
            let terms = |piece: &interwell::mechanics::Piece| {
                piece.coefficients.iter().rev().fold(0.0, |sum, c| sum * (x - piece.origin).abs() + c.abs())
            };
            let size = terms(left).max(terms(right));
            self.at_most("jump of the force", *x, (left.force(*x) - right.force(*x)).abs(), 2e-11 * size);
            let listed = landscape.kinks.iter().any(|kink| kink.x == *x);
            let (inner, outer) = (left.stiffness(*x), right.stiffness(*x));
            let jump = (inner - outer).abs() / inner.abs().max(outer.abs());
            self.holds("a break that is neither smooth nor a kink", *x, listed || jump < 1e-6);
        }
        for i in 0..40 {
            let x = (end * f64::from(i) / 39.0).min(end);
            let same = curve.force(-x) == -curve.force(x)
                && curve.potential(-x) == curve.potential(x)
                && curve.stiffness(-x) == curve.stiffness(x);
            self.holds("odd bit for bit", x, same);
        }
    }

    fn state(&mut self, curve: &ForceCurve, scales: &Scales, tolerance: f64, state: &State) {
        let State { x, force, potential, stiffness, .. } = *state;
        let off = (curve.force(x) - force).abs();
        self.at_most("force", x, off, tolerance * scales.force.max(force.abs()));
        let off = (curve.potential(x) - potential).abs();
        self.at_most("potential", x, off, tolerance * scales.barrier.max(potential.abs()) + scales.rounding);
        if x < scales.inside {
            let off = (curve.stiffness(x) - stiffness).abs();
            self.at_most("stiffness", x, off, 100.0 * tolerance * scales.stiffness);
        }
    }

    /// Straight flexures bulge inside the kink and nowhere else.
    fn bump(&mut self, geometry: &Geometry, kink: Option<f64>, state: &State) {
        if geometry.initial_bow == 0.0 {
            let inside = kink.is_some_and(|kink| state.x < kink);
            self.holds("a bump inside the kink alone", state.x, (state.bump > 0.0) == inside);
        }
    }

    fn mirrored(&mut self, flexures: &Flexures, state: &State) {
        let Ok(other) = flexures.state(-state.x) else {
            return self.faults.push(format!("no state at {:e}", -state.x));
        };
        let same = other.force == -state.force
            && other.potential == state.potential
            && other.stiffness == state.stiffness
            && other.axial == state.axial
            && (other.bump - state.bump).abs() <= 1e-14 * state.x.max(state.bump);
        self.holds("the mirrored state", state.x, same);
    }
}
