//! Ends of axes: automatic ones, or those chosen by hand.
//!
//! An axis chosen by hand stays fixed until a double click. A held axis stays fixed even when another scene
//! is opened, so that two scenes can be compared. The views over time share their time axis, and those along
//! the displacement share their displacement axis.

use std::collections::HashMap;

use super::view::{Axis, View};

/// Largest length of a chosen axis, as a multiple of the automatic length.
pub(super) const LONGEST: f64 = 10.0;
/// Smallest length of a chosen axis, as a multiple of the automatic length.
pub(super) const SHORTEST: f64 = 1e-3;

/// Share of an axis that a choice of the whole may lack by rounding.
const WHOLE: f64 = 1e-9;

/// The ends of an axis in its unit: displacement in m, time in s.
pub type Ends = (f64, f64);

#[derive(Debug, Clone, Copy)]
struct Chosen {
    ends: Ends,
    held: bool,
}

#[derive(Debug, Clone, Default)]
pub struct Axes {
    chosen: HashMap<Axis, Chosen>,
    /// Automatic and actual ends when the axis was last shown.
    shown: HashMap<Axis, (Ends, Ends)>,
}

impl Axes {
    /// The ends of an axis: those chosen by hand, or else the `automatic` ones.
    pub(super) fn ends(&mut self, axis: Axis, automatic: Ends) -> Ends {
        let ends = self.chosen(axis).unwrap_or(automatic);
        self.shown.insert(axis, (automatic, ends));
        ends
    }

    pub(super) fn chosen(&self, axis: Axis) -> Option<Ends> {
        self.chosen.get(&axis).map(|choice| choice.ends)
    }

    pub(super) fn shown(&self, axis: Axis) -> Option<Ends> {
        self.shown.get(&axis).map(|ends| ends.1)
    }

    /// Whether a view keeps its axes regardless of motion and scene.
    pub(super) fn is_held(&self, view: View) -> bool {
        let held = |axis: &Axis| self.chosen.get(axis).is_some_and(|choice| choice.held);
        view.axes().is_some_and(|axes| axes.iter().all(held))
    }

    /// Holds the axes of a view at their present ends, or frees held ones.
    pub(super) fn hold(&mut self, view: View) {
        if self.is_held(view) {
            return self.free(view);
        }
        for axis in view.axes().into_iter().flatten() {
            if let Some(ends) = self.shown(axis) {
                self.chosen.insert(axis, Chosen { ends, held: true });
            }
        }
    }

    /// Returns the axes of a view to their automatic ends.
    pub(super) fn free(&mut self, view: View) {
        view.axes().into_iter().flatten().for_each(|axis| _ = self.chosen.remove(&axis));
        if view == View::Accuracy {
            self.chosen.retain(|axis, _| !matches!(axis, Axis::CostAcross | Axis::CostUp));
        }
    }

    /// The choices that remain when another scene is opened.
    pub(super) fn held(&self) -> Self {
        let held = self.chosen.iter().filter(|choice| choice.1.held).map(|(axis, choice)| (*axis, *choice));
        Self { chosen: held.collect(), shown: HashMap::new() }
    }

    pub(super) fn choose(&mut self, axis: Axis, ends: Ends) {
        let Some((automatic, _)) = self.shown.get(&axis) else { return };
        let held = self.chosen.get(&axis).is_some_and(|chosen| chosen.held);
        let spare = WHOLE * (automatic.1 - automatic.0);
        let whole = ends.0 <= automatic.0 + spare && ends.1 >= automatic.1 - spare;
        let (length, shortest) = (ends.1 - ends.0, SHORTEST * (automatic.1 - automatic.0));
        if whole && !held && axis != Axis::Time {
            // the whole automatic range counts as no choice
            self.chosen.remove(&axis);
        } else if length >= shortest && length <= LONGEST * (automatic.1 - automatic.0) {
            self.chosen.insert(axis, Chosen { ends, held });
        }
    }

    /// Multiplies the length of an axis by `by`, with the point at its share `about` fixed.
    pub(super) fn zoom(&mut self, axis: Axis, by: f64, about: f64) {
        let Some((low, high)) = self.shown(axis).filter(|_| by > 0.0 && by.is_finite()) else { return };
        let middle = low + about * (high - low);
        self.choose(axis, (middle - (middle - low) * by, middle + (high - middle) * by));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: Axis = Axis::Up(View::Velocity);

    #[test]
    fn a_zoom_keeps_what_is_under_the_pointer_and_ends_at_the_whole() {
        let mut axes = Axes::default();
        assert_eq!(axes.ends(UP, (-4.0, 4.0)), (-4.0, 4.0));
        axes.zoom(UP, 0.5, 0.25);
        assert_eq!(axes.ends(UP, (-4.0, 4.0)), (-3.0, 1.0));
        // it stands still while the motion takes more room
        assert_eq!(axes.ends(UP, (-8.0, 8.0)), (-3.0, 1.0));
        axes.zoom(UP, 1e-9, 0.5);
        assert_eq!(axes.chosen(UP), Some((-3.0, 1.0)));
        axes.zoom(UP, 6.0, 0.5);
        assert_eq!(axes.chosen(UP), None);
    }
}
