//! Wall, thread and process clocks.

use std::time::{Duration, Instant};

use cpu_time::{ProcessTime, ThreadTime};

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
