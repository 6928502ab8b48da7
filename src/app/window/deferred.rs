//! Deferral of input that follows the release of a pointer button.
//!
//! All events between two frames arrive together in the next frame, and a slider takes the last position of
//! the pointer as the one at which it was released. If a frame takes long, a pointer that moves on after the
//! release would drag the slider along. Events after a release are therefore deferred by one more frame.

use eframe::egui::{Event, RawInput};

/// Events that wait for the next frame.
#[derive(Debug, Default)]
pub struct DeferredInput {
    events: Vec<Event>,
}

impl DeferredInput {
    /// Leaves in `input` the deferred and new events up to the first release. Returns whether more wait.
    pub fn hold_back(&mut self, input: &mut RawInput) -> bool {
        let mut events = std::mem::take(&mut self.events);
        events.append(&mut input.events);
        let released = |event: &Event| matches!(event, Event::PointerButton { pressed: false, .. });
        if let Some(at) = events.iter().position(released) {
            self.events = events.split_off(at + 1);
        }
        input.events = events;
        !self.events.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Modifiers, PointerButton, pos2};

    use super::*;

    #[test]
    fn what_follows_a_release_comes_in_the_next_frame() {
        let button = |pressed| Event::PointerButton {
            pos: pos2(3.0, 0.0),
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        let moved = |x| Event::PointerMoved(pos2(x, 0.0));
        let all =
            [moved(1.0), button(true), moved(3.0), button(false), moved(9.0), button(true), button(false)];
        let mut deferred = DeferredInput::default();
        let mut input = RawInput { events: all.to_vec(), ..RawInput::default() };
        assert!(deferred.hold_back(&mut input));
        assert_eq!(input.events, all[..4]);
        let mut input = RawInput { events: vec![moved(10.0)], ..RawInput::default() };
        assert!(deferred.hold_back(&mut input));
        assert_eq!(input.events, all[4..]);
        let mut input = RawInput::default();
        assert!(!deferred.hold_back(&mut input));
        assert_eq!(input.events, [moved(10.0)]);
    }
}
