//! Pace of the frames while something plays: as fast as the screen, or 30 a second where painting takes long.

use std::time::Duration;

use eframe::egui::Context;

/// Time in s of a frame above which painting takes long: slightly more than a 60th of a second.
const LONG: f32 = 0.0175;
/// Number of frames over which the time of a frame is measured.
const MEASURED: u32 = 30;
/// Number of frames after which it is measured again.
const SLOW: u32 = 300;
/// Time between two frames where painting takes long.
const INTERVAL: Duration = Duration::from_millis(33);
/// Longest time in s that a motion plays in one frame, after a pause of the window.
const LONGEST: f32 = 0.5;

/// Whether frames are slow; the number of frames since that was measured, or since its measurement began, and
/// the time in s that they took.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pace {
    is_slow: bool,
    frames: u32,
    time: f32,
}

impl Pace {
    /// The time in s since the last frame, by which the motion is to advance.
    pub fn seconds(&self, ctx: &Context) -> f64 {
        // egui takes a frame that was not requested immediately for the first one after a pause
        let seconds = ctx.input(|input| if self.is_slow { input.unstable_dt } else { input.stable_dt });
        f64::from(if self.is_slow { seconds.min(LONGEST) } else { seconds })
    }

    /// Requests the next frame while a motion plays.
    pub fn ask(&mut self, ctx: &Context) {
        self.frames += 1;
        self.time += ctx.input(|input| input.stable_dt);
        match self.is_slow {
            true if self.frames >= SLOW => *self = Self::default(),
            false if self.frames >= MEASURED => {
                let is_slow = self.time > LONG * MEASURED as f32;
                *self = Self { is_slow, ..Self::default() };
            }
            _ => {}
        }
        match self.is_slow {
            true => ctx.request_repaint_after(INTERVAL),
            false => ctx.request_repaint(),
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{RawInput, ViewportId};

    use super::*;

    /// The least and the greatest delay that is asked for between frames of so many seconds.
    fn delays(frame: f64) -> (Duration, Duration) {
        let (ctx, mut pace, mut time) = (Context::default(), Pace::default(), 0.0);
        let mut delays = (Duration::MAX, Duration::ZERO);
        let mut played = 0.0;
        for i in 0..400 {
            let input = RawInput { time: Some(time), ..RawInput::default() };
            let mut output = ctx.run_ui(input, |ui| {
                played += pace.seconds(ui.ctx());
                pace.ask(ui.ctx());
            });
            // no graphics want them
            output.textures_delta.clear();
            let delay = output.viewport_output[&ViewportId::ROOT].repaint_delay;
            // the first frames settle sizes and ask for more
            if i > 5 {
                delays = (delays.0.min(delay), delays.1.max(delay));
            }
            time += frame.max(delay.as_secs_f64());
        }
        assert!((played / time - 1.0).abs() < 0.02, "{played} of {time}");
        delays
    }

    #[test]
    fn frames_that_take_long_are_fewer_and_the_motion_is_as_fast() {
        assert_eq!(delays(1.0 / 144.0), (Duration::ZERO, Duration::ZERO));
        assert_eq!(delays(1.0 / 60.0), (Duration::ZERO, Duration::ZERO));
        // now and then it is measured anew
        assert_eq!(delays(0.025), (Duration::ZERO, INTERVAL));
    }
}
