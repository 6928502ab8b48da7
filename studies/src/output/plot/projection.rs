//! Surface over a grid in parallel projection: places, lines of its box, faces from back to front.
//!
//! The view is turned by 37.5 degrees and seen from 30 degrees above, with the least values of both fields in
//! front. Faces are in the order from back to front, which for a height over a grid is exact.

use super::figure::{Area, Point};
use crate::numeric::elementary;

/// Turn and elevation of the view in degrees, and height of the box over the length of its sides.
const TURN: f64 = 37.5;
const ELEVATION: f64 = 30.0;
const HEIGHT: f64 = 0.72;

/// Approximate number of lines over the surface in each direction.
const LINES: usize = 40;

/// A place in the box: to the right, to the back, upward, each from 0 to 1.
pub type BoxPlace = (f64, f64, f64);

/// A line in the box.
pub type BoxLine = (BoxPlace, BoxPlace);

/// Where a place in the box stands on the canvas, if the box fills this area.
pub fn placed(Area { left, top, right, bottom }: Area, at: BoxPlace) -> Point {
    let (least, most) = (flat((0.0, 1.0, 0.0)).0, flat((1.0, 0.0, 0.0)).0);
    let highest = flat((1.0, 1.0, 1.0)).1;
    let (across, up) = flat(at);
    (left + (across - least) / (most - least) * (right - left), bottom - up / highest * (bottom - top))
}

/// Where a place in the box stands, before it is fitted: to the right, upward.
fn flat((u, v, w): BoxPlace) -> (f64, f64) {
    let ((sin, cos), (up, flat)) =
        (elementary::sin_cos(TURN.to_radians()), elementary::sin_cos(ELEVATION.to_radians()));
    (u * cos - v * sin, (u * sin + v * cos) * up + w * HEIGHT * flat)
}

/// The edges of the box behind the surface.
pub const BACK_EDGES: [BoxLine; 6] = [
    ((1.0, 0.0, 0.0), (1.0, 1.0, 0.0)),
    ((0.0, 1.0, 0.0), (1.0, 1.0, 0.0)),
    ((1.0, 1.0, 0.0), (1.0, 1.0, 1.0)),
    ((0.0, 1.0, 1.0), (1.0, 1.0, 1.0)),
    ((1.0, 1.0, 1.0), (1.0, 0.0, 1.0)),
    ((1.0, 0.0, 0.0), (1.0, 0.0, 1.0)),
];

/// The edges that bear the ticks of the three axes.
pub const AXIS_EDGES: [BoxLine; 3] = [
    ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0)),
    ((0.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    ((0.0, 1.0, 0.0), (0.0, 1.0, 1.0)),
];

/// The lines of ticks at these shares over floor and back walls.
pub fn wall_lines([x, y, z]: [Vec<f64>; 3]) -> Vec<BoxLine> {
    let (x, y, z) = (x.into_iter(), y.into_iter(), z.into_iter());
    let across = x.flat_map(|x| [((x, 0.0, 0.0), (x, 1.0, 0.0)), ((x, 1.0, 0.0), (x, 1.0, 1.0))]);
    let back = y.flat_map(|y| [((0.0, y, 0.0), (1.0, y, 0.0)), ((1.0, y, 0.0), (1.0, y, 1.0))]);
    let up = z.flat_map(|z| [((0.0, 1.0, z), (1.0, 1.0, z)), ((1.0, 1.0, z), (1.0, 0.0, z))]);
    across.chain(back).chain(up).collect()
}

/// A face between the values of four neighbours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Face {
    /// Its column and row: those of its first corner.
    pub cell: (usize, usize),
    /// Its corners, one after the other around it. They need not lie in a plane: it is the triangles of the
    /// corners 0, 1, 2 and 0, 2, 3.
    pub corners: [BoxPlace; 4],
    /// The share of the scale that its mean value has.
    pub share: f64,
    /// Whether all of its corners are at rest.
    pub resting: bool,
    /// Which of its [`SIDES`] bear a line.
    pub lined: [bool; 4],
}

/// The sides of a face, as places of its corners.
pub const SIDES: [[usize; 2]; 4] = [[0, 1], [2, 3], [3, 0], [1, 2]];

/// The faces over columns and rows at these shares of the floor, the farthest first; none where one of the
/// four values is missing. `height` is a value and whether it is that of a motion at rest; `share` is where a
/// value stands upward.
pub fn faces(
    across: &[f64],
    up: &[f64],
    height: impl Fn(usize, usize) -> Option<(f64, bool)>,
    share: impl Fn(f64) -> f64,
) -> Vec<Face> {
    let every = |count: usize| count.div_ceil(LINES).max(1);
    let (step_across, step_up) = (every(across.len()), every(up.len()));
    let mut faces = Vec::new();
    for column in (0..across.len().saturating_sub(1)).rev() {
        for row in (0..up.len().saturating_sub(1)).rev() {
            let around = [(column, row), (column + 1, row), (column + 1, row + 1), (column, row + 1)];
            let [Some(a), Some(b), Some(c), Some(d)] = around.map(|(i, j)| height(i, j)) else { continue };
            let heights = [a, b, c, d];
            let corner = |i: usize| (across[around[i].0], up[around[i].1], share(heights[i].0));
            faces.push(Face {
                cell: (column, row),
                corners: [0, 1, 2, 3].map(corner),
                share: share(heights.iter().map(|height| height.0).sum::<f64>() / 4.0),
                resting: heights.iter().all(|height| height.1),
                lined: [
                    row % step_up == 0,
                    (row + 1) % step_up == 0 || row + 2 == up.len(),
                    column % step_across == 0,
                    (column + 1) % step_across == 0 || column + 2 == across.len(),
                ],
            });
        }
    }
    faces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_fills_its_rectangle() {
        let area = Area::new(10.0, 20.0, 110.0, 80.0);
        let close = |at: BoxPlace, x: Option<f64>, y: Option<f64>| {
            let point = placed(area, at);
            x.is_none_or(|x| (point.0 - x).abs() < 1e-12) && y.is_none_or(|y| (point.1 - y).abs() < 1e-12)
        };
        assert!(close((0.0, 1.0, 0.3), Some(10.0), None) && close((1.0, 0.0, 0.7), Some(110.0), None));
        assert!(close((0.0, 0.0, 0.0), None, Some(80.0)) && close((1.0, 1.0, 1.0), None, Some(20.0)));
    }

    #[test]
    fn faces_come_from_back_to_front_without_those_of_a_missing_value() {
        let shares = [0.0, 0.5, 1.0];
        let height = |i: usize, j: usize| (i + j < 4).then_some(((i + j) as f64, i + j == 0));
        let faces = faces(&shares, &shares, height, |value| value / 4.0);
        assert_eq!(faces.iter().map(|face| face.cell).collect::<Vec<_>>(), [(1, 0), (0, 1), (0, 0)]);
        assert_eq!(faces[2].corners[2], (0.5, 0.5, 0.5));
        assert_eq!((faces[2].share, faces[2].resting), (0.25, false));
    }
}
