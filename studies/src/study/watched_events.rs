//! Events of a motion that is watched, as a table.

use std::ops::Range;

use crate::dynamics::{Event, EventKind};

use super::simulate::events_table;
use super::table::Table;
use super::watch::Watch;

/// Some of the events that are remembered, by their places, in the columns of
/// [`events_table`](super::events_table) and two more: `phase_deg`, the phase of the drive, missing where it
/// does not repeat; and `lost_j`, the kinetic energy that an event takes, m (v_in^2 - v_out^2) / 2 with the
/// mass at that time. That is missing for a touch of a compliant stop, whose loss is spread over the contact.
pub fn watched_events(watch: &Watch, which: Range<usize>) -> Table {
    let count = watch.events().len();
    let which = which.start.min(count)..which.end.min(count);
    let events: Vec<Event> = watch.events().range(which).copied().collect();
    let phase =
        |event: &Event| watch.model_at(event.t).drive_phase(event.t).map_or(f64::NAN, |turns| 360.0 * turns);
    let lost = |event: &Event| match event.kind {
        EventKind::Contact | EventKind::Separate => f64::NAN,
        // the sum of the speeds times their difference: exact where they are nearly equal
        _ => 0.5 * watch.model_at(event.t).mass() * (event.v_in + event.v_out) * (event.v_in - event.v_out),
    };
    events_table(&events).each("phase_deg", &events, phase).each("lost_j", &events, lost)
}
