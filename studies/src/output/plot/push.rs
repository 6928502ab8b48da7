//! The arrow of the push on the mass of a drawn mechanism.

use super::figure::{Area, Point};
use super::role::Role;
use super::sketch::{HALF_MASS, Pen, STOP};
use crate::numeric::extent;

/// Longest arrow as a share of the width of the drawing; one between the stops may be as short as the second
/// number of it.
const ARROW: (f64, f64) = (0.16, 0.5);
/// Length and half width of the head of an arrow.
const HEAD: (f64, f64) = (26.0, 13.0);
/// Distance of an arrow from the mass and from a stop, and the shortest one that is drawn.
const ARROW_GAP: (f64, f64) = (13.0, 6.0);

impl Pen<'_> {
    /// The place of the longest arrow: between the stops where half of it has room on either side of the
    /// mass, else above the stops and beside the flexures, or beyond a stop; without two stops on the inner
    /// side of the mass. Except above the stops its height is that of the mass, where no flexure comes, and
    /// clear of a spring.
    pub fn arrow_place(&self, flexures: &[Vec<Point>]) -> Option<Area> {
        let (area, mass) = (self.area(), self.mass);
        let length = ARROW.0 * (area.right - area.left);
        let half = 0.5 * (mass.bottom - mass.top);
        let lift = if self.of.stiffness == 0.0 { 0.0 } else { 0.4 * half };
        let y = 0.5 * (mass.top + mass.bottom) - lift;
        let place =
            |near: f64, far: f64, y: f64| Area::new(near.min(far), y - HEAD.1, near.max(far), y + HEAD.1);
        let from = |edge: f64, side: f64, length: f64| {
            let near = edge + side * ARROW_GAP.0;
            place(near, near + side * length, y)
        };
        let face = |side: f64| if side < 0.0 { mass.left } else { mass.right };
        let middle = 0.5 * (mass.left + mass.right);
        let place = match self.stops {
            [Some(left), Some(right)] => {
                let room = 0.5 * (right.left - left.right) - HALF_MASS - 2.0 * ARROW_GAP.0;
                let side = if middle > 0.5 * (left.right + right.left) { -1.0 } else { 1.0 };
                let all = self.outlined.into_iter().flatten().chain([left, right]);
                let (outer_left, outer_right) = extent(all.flat_map(|stop| [stop.left, stop.right]));
                let over = mass.top - STOP.1 - ARROW_GAP.0 - HEAD.1;
                let above = |side: f64| place(face(side), face(side) + side * length, over);
                let is_free = |place: &Area| {
                    let crosses = |pair: &[Point]| place.clip(pair[0], pair[1]).is_some();
                    let is_inside = place.left > area.left && place.right < area.right;
                    is_inside
                        && place.top > self.top
                        && !flexures.iter().any(|line| line.windows(2).any(crosses))
                };
                let free = || [-1.0, 1.0].map(above).into_iter().find(is_free);
                match self.of.flexures.as_ref().and_then(|_| free()) {
                    _ if room >= ARROW.1 * length && self.of.outlined.is_none() => {
                        from(face(side), side, length.min(room))
                    }
                    Some(above) => above,
                    None if outer_left - length - 2.0 * ARROW_GAP.0 > area.left => {
                        from(outer_left, -1.0, length)
                    }
                    None => from(outer_right, 1.0, length),
                }
            }
            [Some(_), None] => from(mass.right, 1.0, length),
            [None, Some(_)] => from(mass.left, -1.0, length),
            [None, None] => {
                let side = if middle > self.zero { -1.0 } else { 1.0 };
                from(face(side), side, length)
            }
        };
        (self.of.push != 0.0).then_some(place)
    }

    /// The arrow of the push, from or to the end of its place next to the mass.
    pub fn arrow(&mut self, place: Area) {
        let middle = 0.5 * (self.mass.left + self.mass.right);
        let push = self.of.push.clamp(-1.0, 1.0) * (place.right - place.left);
        if push.abs() < ARROW_GAP.1 {
            return;
        }
        let (near, out) = if place.left > middle { (place.left, 1.0) } else { (place.right, -1.0) };
        let (from, tip) = if push * out > 0.0 { (near, near + push) } else { (near - push, near) };
        let y = 0.5 * (place.top + place.bottom);
        let look = self.theme.look(Role::Push);
        let head = HEAD.0.min(push.abs()) * push.signum();
        let canvas = self.figure.canvas;
        self.figure.line(&[(from, y), (tip - 0.5 * head, y)], look.width, look.ink, canvas);
        let corners = vec![(tip, y), (tip - head, y - HEAD.1), (tip - head, y + HEAD.1)];
        self.figure.polygon(corners, look.ink);
    }
}
