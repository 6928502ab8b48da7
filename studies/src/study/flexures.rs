//! Shapes, compression and stress of the flexures over the displacement.
//!
//! Unlike the force curve, which is a polynomial, every position here is solved separately.

use super::curve::check_positions;
use super::{OutsideCurve, Table, Task, curve};
use crate::mechanics::Mechanism;
use crate::mechanics::flexure::{FlexureError, Flexures, State};
use crate::numeric::short;

/// Why the flexures are not known at some position.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StatesError {
    /// The mechanism is not made of flexures.
    #[error(
        "this mechanism has no flexures, only a force; shapes, axial force and stress need `mechanism: \
         Flexures(..)`"
    )]
    NoFlexures,
    /// A position beyond the curve.
    #[error(transparent)]
    Outside(#[from] OutsideCurve),
    /// No solution at a position.
    #[error(transparent)]
    Unsolved(#[from] FlexureError),
    /// It was told to stop.
    #[error("told to stop")]
    Cancelled,
}

/// The flexures of a mechanism, after a check that the positions in m are on its curve.
pub fn flexures_at<'a>(mechanism: &'a Mechanism, positions: &[f64]) -> Result<&'a Flexures, StatesError> {
    let flexures = mechanism.flexures.as_deref().ok_or(StatesError::NoFlexures)?;
    check_positions(mechanism, positions)?;
    Ok(flexures)
}

/// The flexures at these positions in m, in their order, each solved afresh.
pub fn states(mechanism: &Mechanism, positions: &[f64], task: &Task) -> Result<Vec<State>, StatesError> {
    let flexures = flexures_at(mechanism, positions)?;
    let state = |x: &f64| {
        task.go_on().map_err(|_| StatesError::Cancelled)?;
        let state = flexures.state(*x)?;
        (task.tick)();
        Ok(state)
    };
    positions.iter().map(state).collect()
}

/// The table of [`curve`] at the positions of `states`, with `axial_n,bump_m,max_stress_pa`: the compression
/// of all buckling flexures, the height of their bump, the largest bending stress of any flexure.
pub fn full_curve(mechanism: &Mechanism, states: &[State]) -> Result<Table, OutsideCurve> {
    let table = curve(mechanism, states.iter().map(|state| state.x).collect())?;
    let table = table.each("axial_n", states, |state| state.axial).each("bump_m", states, |state| state.bump);
    Ok(table.each("max_stress_pa", states, |state| state.max_stress))
}

/// The table `x_m,flexure,s_m,px_m,py_m`: the centre lines of each state, point after point; `flexure` is
/// `parallel` or `buckling`, one of each standing for its group.
///
/// px and py are coordinates of the frame, drawn with a shuttle of no width: the parallel flexures are
/// clamped at (0, 0) and reach the shuttle at (L_p - u, x), u being their shortening; the buckling ones are
/// clamped at (L_p + L_b - preload, 0) and reach the same point of the shuttle. So px runs along the flexures
/// and py with x. s is the length along a flexure from its clamp in the frame.
pub fn shapes(states: &[State]) -> Table {
    let mut rows = Vec::new();
    for state in states {
        for line in &state.lines {
            // Adding 0 makes -0 a plain 0.
            let row =
                |[s, px, py]: &[f64; 3]| (line.flexure, [state.x, *s, *px, *py].map(|value| value + 0.0));
            rows.extend(line.points.iter().map(row));
        }
    }
    Table::new()
        .each("x_m", &rows, |row| row.1[0])
        .each("flexure", &rows, |row| row.0)
        .each("s_m", &rows, |row| row.1[1])
        .each("px_m", &rows, |row| row.1[2])
        .each("py_m", &rows, |row| row.1[3])
}

/// A warning, one sentence, if the bending stress of some `states` exceeds the limit of the scene: the range
/// of |x|, the largest stress and the limit.
pub fn stress_warning(flexures: &Flexures, states: &[State]) -> Option<String> {
    let limit = flexures.geometry().yield_stress;
    let farthest = states.iter().fold(0.0_f64, |largest, state| largest.max(state.x.abs()));
    let above: Vec<&State> = states.iter().filter(|state| state.max_stress > limit).collect();
    let worst = above.iter().max_by(|a, b| a.max_stress.total_cmp(&b.max_stress))?;
    let from = above.iter().fold(f64::INFINITY, |least, state| least.min(state.x.abs()));
    let to = above.iter().fold(0.0_f64, |largest, state| largest.max(state.x.abs()));
    let end = if to < farthest { format!("to {} mm", short(to * 1e3)) } else { "on".to_owned() };
    let [begin, place] = [from, worst.x].map(|metres| short(metres * 1e3));
    let [limit, largest] = [limit, worst.max_stress].map(|pascal| short(pascal / 1e9));
    Some(format!(
        "from |x| = {begin} mm {end} the bending stress exceeds mechanism.yield_gpa = {limit}: {largest} GPa \
         at x = {place} mm; the model does not follow yielding"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::flexure::CentreLine;
    use crate::scene::{Document, Files};
    use crate::study::Values;

    fn state(x: f64, max_stress: f64) -> State {
        let line = |flexure| CentreLine { flexure, points: vec![[0.0, 0.0, -0.0], [1.0, 2.0, x]] };
        State {
            x,
            force: 0.0,
            potential: 0.0,
            stiffness: 0.0,
            axial: 5.0,
            bump: 1e-3,
            max_stress,
            lines: vec![line("parallel"), line("buckling")],
        }
    }

    #[test]
    fn lines_follow_point_after_point() {
        let table = shapes(&[state(1e-3, 0.0), state(-1e-3, 0.0)]);
        let names: Vec<&str> = table.columns().iter().map(|column| column.name.as_str()).collect();
        assert_eq!(names, ["x_m", "flexure", "s_m", "px_m", "py_m"]);
        let words = ["parallel", "parallel", "buckling", "buckling"];
        assert_eq!(table.column("flexure").unwrap().values, Values::Words([words, words].concat()));
        assert_eq!(table.numbers("x_m").unwrap()[3..5], [1e-3, -1e-3]);
        assert_eq!(table.numbers("px_m").unwrap()[..2], [0.0, 2.0]);
        assert!(table.numbers("py_m").unwrap()[0].is_sign_positive());
        assert_eq!(shapes(&[]).rows(), 0);
    }

    #[test]
    fn a_warning_says_from_where_on() {
        let text = "(title: \"t\", mass_g: 15.2, mechanism: Flexures(preload_mm: 2.7, thickness_mm: 0.1, \
                    young_gpa: 190, yield_gpa: 1.5, parallel: (count: 2, length_mm: 26, width_mm: 20), \
                    buckling: (count: 1, length_mm: 27.7, width_mm: 6.8)), run: (duration_s: 1))";
        let scene = Document::from_text("t", text, Files::default()).unwrap().scene;
        let mechanism = Mechanism::build(&scene.mechanism, &Files::default()).unwrap();
        let flexures = mechanism.flexures.unwrap();
        let warning = |stresses: [(f64, f64); 3]| {
            let states = stresses.map(|(mm, gpa)| state(mm * 1e-3, gpa * 1e9));
            stress_warning(&flexures, &states)
        };
        assert_eq!(warning([(-2.0, 1.4), (0.0, 0.0), (2.0, 1.5)]), None);
        let text = warning([(-6.0, 1.6), (0.0, 1.0), (7.0, 1.75)]).unwrap();
        assert!(text.starts_with("from |x| = 6 mm on ") && text.lines().count() == 1, "{text}");
        assert!(text.contains("mechanism.yield_gpa = 1.5: 1.75 GPa at x = 7 mm"), "{text}");
        let text = warning([(0.0, 1.6), (0.5, 1.55), (7.0, 1.0)]).unwrap();
        assert!(text.starts_with("from |x| = 0 mm to 0.5 mm "), "{text}");
    }
}
