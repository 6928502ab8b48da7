//! Wall, thread and process clocks. A web page can read no clock of the processor; there all three are the
//! wall clock.
//!
//! Times are in s from the start of a clock. That of a thread is read by the thread that started it; that
//! of the program sums all threads, so that with two of them at work it goes twice as fast as the wall
//! clock.

use std::time::Duration;

#[cfg(not(target_arch = "wasm32"))]
use cpu_time::{ProcessTime, ThreadTime};
use web_time::Instant;
#[cfg(target_arch = "wasm32")]
use web_time::{Instant as ProcessTime, Instant as ThreadTime};

macro_rules! clocks {
    ($($(#[$doc:meta])* $name:ident($inner:ident);)*) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, Copy)]
        pub struct $name($inner);

        impl $name {
            /// Starts the clock.
            pub fn start() -> Self {
                Self($inner::now())
            }

            /// Seconds since the start.
            pub fn seconds(self) -> f64 {
                self.0.elapsed().as_secs_f64()
            }
        }
    )*};
}

clocks! {
    /// Wall-clock time.
    WallClock(Instant);
    /// Processor time of this thread.
    ThreadClock(ThreadTime);
    /// Processor time of all threads of the program.
    ProcessClock(ProcessTime);
}

impl WallClock {
    /// The time since the start.
    pub fn elapsed(self) -> Duration {
        self.0.elapsed()
    }
}
