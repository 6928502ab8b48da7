//! Hard cases: problems that break integrators of impacts, each with its answer and what its
//! conditioning allows.
//!
//! The texts of a case state the problem, where the answer comes from, and the bound of its error.
//! Throughout, d is the error that one step may make ([`STEP_ERROR`](super::STEP_ERROR)), relative to the
//! scene's length L and speed V, and n the number of steps. All run at the tolerance 1e-14; at 1e-9 some
//! sixty of their checks fail, so the bounds are tight enough to matter.

mod ball;
mod case;
mod chatter;
mod circuit;
mod circuit_events;
mod curves;
mod drives;
mod long;
mod release;
mod scales;
mod touch;
mod well;

pub use case::HardCase;

/// All of them, in the order in which they are shown.
pub const HARD_CASES: &[HardCase] = &[
    well::SEPARATRIX,
    long::ELASTIC_BOX,
    ball::BOUNCING_BALL,
    ball::BUDGET,
    chatter::COMPLETE,
    chatter::INCOMPLETE,
    chatter::ENDS_WITH_THE_PRESS,
    release::THRESHOLD,
    release::ZERO_SLOPE,
    release::BIAS,
    release::PLASTIC,
    touch::GRAZING,
    touch::EXCURSION,
    touch::GAP,
    touch::COINCIDENT,
    drives::RIPPLE,
    drives::RAMP,
    drives::FAST,
    drives::SHOCK,
    drives::NOISE,
    drives::RECORD,
    curves::KINK,
    curves::STOP_ON_A_BREAK,
    curves::STOP_AT_THE_EQUILIBRIUM,
    curves::STOP_AT_THE_FORCE_MAXIMUM,
    curves::BOTH_STOPS_ON_ONE_SIDE,
    circuit::STIFF,
    circuit::STRONG,
    circuit::NO_INDUCTANCE,
    circuit::OPEN_AND_SHORT,
    circuit_events::AT_REST,
    circuit_events::RELEASE,
    circuit_events::AT_IMPACTS,
    long::CHAOS,
    scales::UNITS,
];
