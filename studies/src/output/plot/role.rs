//! Roles of layers, and the look of each: colour, width, dash and marker.

use serde::{Deserialize, Serialize};

use super::mark::Marker;
use super::style::{self, Ink, Theme};

/// The meaning of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Role {
    /// The computed motion, and what follows from it.
    Motion,
    /// A second quantity of the same motion.
    Second,
    /// The shaking.
    Drive,
    /// Force and potential of the mechanism.
    Curve,
    /// A stop.
    Stop,
    /// An impact.
    Impact,
    /// Time or a cell at rest.
    Rest,
    /// A well.
    Well,
    /// A stable equilibrium.
    Stable,
    /// An unstable equilibrium.
    Unstable,
    /// A kink of the force.
    Kink,
    /// States with the energy of the top of the barrier.
    Separatrix,
    /// States once a forcing period.
    Strobe,
    /// A line to compare with, such as 0.
    Reference,
    /// A measured record.
    Measured,
    /// The end of a rebound.
    Rebound,
    /// A number with its interval.
    Interval,
    /// A band around a line: an interval, a standard error.
    Around,
    /// The curve identified from a record, dashed.
    Envelope,
    /// A regime by its place: rest, intrawell, irregular, interwell, crossing.
    Regime(usize),
    /// One of several lines, by its share from 0 to 1 of a colour scale.
    Step(f64),
    /// A line that only joins markers.
    Joined,
    /// The way down of a field that is walked.
    Down,
    /// The range between the way up and the way down.
    Hysteresis,
    /// One of several kinds without a colour of their own, such as an attractor.
    Kind(usize),
    /// The same kind where it is not sure, paler.
    Unsure(usize),
    /// An event of a branch, or of a motion, by its place.
    Event(usize),
    /// An unstable motion.
    UnstableMotion,
    /// The release in closed form, over a map.
    Release,
    /// The first crossing cells, over a map.
    FirstCrossing,
    /// A cut through a map.
    Cut,
    /// No value.
    Missing,
    /// A motion that may be a transient.
    Transient,
    /// The best of several.
    Best,
    /// One of several that is not the best.
    Other,
    /// The design that a search found.
    Found,
    /// A safer design beside it.
    SteppedBack,
    /// A design that breaks a constraint.
    Broken,
    /// Motions with impacts.
    Impacts,
    /// A threshold above which there are gaps.
    Gaps,
    /// The method of this program, Taylor series.
    Taylor,
    /// The method of Dormand and Prince.
    DormandPrince,
    /// Semi-implicit Euler in fixed steps.
    Euler,
    /// Velocity Verlet in fixed steps.
    Verlet,
    /// The method of Runge and Kutta in fixed steps.
    RungeKutta,
    /// Several kinds together.
    Several,
    /// The part that another panel shows closer.
    Closer,
    /// Potential energy.
    Potential,
    /// Potential and kinetic energy.
    Total,
    /// The energy of the top of the barrier.
    Barrier,
    /// A curve beyond the stops, where the mass cannot go.
    Beyond,
    /// The inertial force of the base motion.
    Push,
    /// The difference of the inertial force and the curve.
    Apart,
    /// A motion as it was: from 0, which is now, to 1, the oldest that is shown.
    Past(f64),
    /// An impact of that age, which turns the velocity round.
    Jump(f64),
    /// The motion with which the present one is compared.
    Compared,
    /// The mass at rest.
    Resting,
    /// The frame.
    Frame,
    /// The proof mass.
    Mass,
    /// A travel limit.
    Limit,
    /// A stop where it would be best.
    BestStop,
    /// A coil or a piezoelectric layer.
    Transducer,
    /// Energy that a person put in.
    ByHand,
    /// Energy that damping took.
    Taken,
}

/// Strength of the oldest part of a motion that fades.
const FAINTEST: f64 = 0.12;

/// How a role looks.
#[doc(hidden)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// Colour.
    pub ink: Ink,
    /// Width of its lines.
    pub width: f64,
    /// Dash and gap of its lines.
    pub dash: Option<(f64, f64)>,
    /// Outline under its lines.
    pub halo: Option<Ink>,
    /// Marker.
    pub marker: Marker,
    /// Half the height of its markers.
    pub size: f64,
    /// Whether its markers are empty.
    pub hollow: bool,
    /// Hatching over filled areas.
    pub hatch: Option<Ink>,
}

const KINDS: [Marker; 4] = [Marker::Disc, Marker::Square, Marker::Triangle, Marker::Diamond];
const EVENTS: [Marker; 4] = [Marker::Triangle, Marker::Diamond, Marker::Square, Marker::DoubleArrow];

impl Theme {
    /// The look of a role.
    pub fn look(&self, role: Role) -> Look {
        let plain = Look {
            ink: self.ink,
            width: style::LINE,
            dash: None,
            halo: None,
            marker: Marker::Disc,
            size: style::MARKER,
            hollow: false,
            hatch: None,
        };
        let of = |ink: Ink| Look { ink, ..plain };
        let fine = |ink: Ink| Look { ink, width: style::FINE_LINE, ..plain };
        let dashed = |ink: Ink| Look { ink, dash: Some(style::DASH), ..plain };
        let dotted = |ink: Ink| Look { ink, dash: Some(style::DOT), ..plain };
        let marked = |ink: Ink, marker: Marker| Look { ink, marker, ..plain };
        let method = |ink: Ink, marker: Marker| Look {
            size: 0.75 * style::MARKER,
            width: style::FINE_LINE,
            ..marked(ink, marker)
        };
        let design = |marker: Marker| Look { halo: Some(self.paper), ..marked(self.stable, marker) };
        match role {
            Role::Motion => fine(self.ink),
            Role::Second => fine(self.second),
            Role::Drive => fine(self.shaking),
            Role::Curve => Look { width: style::LINE + 0.8, ..plain },
            Role::Stop => Look { hatch: Some(self.wall.over(self.paper, 0.6)), ..of(self.wall) },
            Role::Impact => fine(self.impact),
            Role::Rest => Look { hatch: Some(self.rest_hatch), ..of(self.rest) },
            Role::Well => dashed(self.stable),
            Role::Stable => Look { size: style::MARKER + 2.0, halo: Some(self.paper), ..of(self.ink) },
            Role::Unstable => Look { hollow: true, size: style::MARKER + 2.0, ..of(self.ink) },
            // reaches out from under an equilibrium
            Role::Kink => {
                Look { hollow: true, size: 2.0 * style::MARKER, ..marked(self.ink, Marker::Diamond) }
            }
            Role::Separatrix => Look { width: style::FINE_LINE, ..dashed(self.soft) },
            Role::Strobe => Look { hollow: true, size: 4.9, ..of(self.shaking) },
            Role::Reference => Look { width: style::THIN, ..of(self.soft) },
            Role::Measured => Look { size: 4.0, width: style::LINE + 1.0, ..of(self.regimes[2]) },
            Role::Rebound => Look { size: 6.0, ..marked(self.second, Marker::Triangle) },
            Role::Interval => Look { size: 7.0, ..of(self.regimes[2]) },
            Role::Around => of(self.ink.over(self.paper, 0.14)),
            Role::Envelope => Look { width: style::FINE_LINE, ..dashed(self.ink) },
            Role::Regime(place) => marked(self.regimes[place % 5], super::mark::REGIMES[place % 5].1),
            Role::Step(share) => of(self.step(share)),
            Role::Joined => fine(self.soft),
            Role::Down => Look { marker: Marker::Diamond, hollow: true, ..dashed(self.second) },
            Role::Hysteresis => of(self.shaking.over(self.paper, 0.3)),
            Role::Kind(place) => Look {
                hatch: style::kind_hatch(place),
                halo: Some(style::WHITE),
                ..marked(style::KINDS[place % style::KINDS.len()], KINDS[(place + 2 * (place / 4)) % 4])
            },
            Role::Unsure(place) => {
                let kind = self.look(Role::Kind(place));
                Look { ink: kind.ink.over(self.paper, style::PALER), ..kind }
            }
            Role::Event(place) => marked(self.soft, EVENTS[place % 4]),
            Role::UnstableMotion => dashed(self.unstable),
            Role::Release => Look { width: style::GUIDE, halo: Some(style::BLACK), ..dashed(style::WHITE) },
            Role::FirstCrossing => {
                Look { width: style::GUIDE, halo: Some(style::WHITE), ..of(style::OVER_MAP) }
            }
            Role::Cut => Look { halo: Some(style::BLACK), ..dotted(style::WHITE) },
            Role::Missing => dotted(self.soft),
            Role::Transient => of(self.rest_hatch),
            Role::Best => of(self.stable),
            Role::Other => of(self.soft.over(self.paper, 0.35)),
            Role::Found => Look { size: style::MARKER + 2.0, ..design(Marker::Diamond) },
            Role::SteppedBack => design(Marker::Square),
            Role::Broken => marked(self.unstable, Marker::Cross),
            Role::Taylor => Look { width: style::LINE, ..method(self.regimes[3], Marker::Disc) },
            Role::DormandPrince => method(self.regimes[1], Marker::Square),
            Role::Euler => method(self.unstable, Marker::Triangle),
            Role::Verlet => method(self.regimes[2], Marker::Diamond),
            Role::RungeKutta => method(self.second, Marker::DoubleArrow),
            Role::Gaps => marked(self.unstable, Marker::Triangle),
            Role::Impacts => marked(self.regimes[3], Marker::Triangle),
            Role::Several => of(self.paper),
            Role::Closer => of(self.rest),
            Role::Potential => fine(self.unstable),
            Role::ByHand | Role::Mass => of(self.unstable),
            Role::Frame => Look { hatch: Some(self.rest_hatch), ..of(self.rest) },
            Role::Limit => of(self.wall),
            Role::BestStop => Look { dash: Some(style::SHORT_DASH), ..fine(self.wall.over(self.paper, 0.7)) },
            Role::Transducer => of(self.second),
            Role::Taken => of(self.soft),
            Role::Total => of(self.energy),
            Role::Barrier => dotted(self.soft),
            Role::Resting => marked(self.unstable, Marker::Square),
            Role::Beyond => Look { width: style::FINE_LINE, ..dashed(self.soft) },
            Role::Push => Look { width: style::LINE + 1.0, ..of(self.shaking) },
            Role::Apart => Look { dash: Some(style::SHORT_DASH), ..fine(self.shaking) },
            Role::Past(age) => fine(self.faded(self.ink, age)),
            Role::Jump(age) => Look { dash: Some(style::SHORT_DASH), ..fine(self.faded(self.impact, age)) },
            Role::Compared => Look { dash: Some((22.0, 8.0)), ..of(self.second) },
        }
    }

    /// A colour that fades with its age.
    fn faded(&self, ink: Ink, age: f64) -> Ink {
        ink.over(self.paper, 1.0 - (1.0 - FAINTEST) * age)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kink_is_seen_around_an_equilibrium() {
        let [kink, stable] = [Role::Kink, Role::Stable].map(|role| Theme::LIGHT.look(role));
        // the distance of the edge of a diamond, and the outline of a disc
        assert!(1.25 * kink.size / 2.0_f64.sqrt() + 2.0 > stable.size + 5.0);
    }
}
