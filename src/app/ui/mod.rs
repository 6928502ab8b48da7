//! Building blocks of the user interface: colours and widths, small widgets, sliders with a number, settings.

pub(super) mod knob;
pub mod settings;
pub mod style;
pub(super) mod widgets;
