//! Clocks.

use std::time::{Duration, Instant};

use cpu_time::{ProcessTime, ThreadTime};

macro_rules! clocks {
    ($($(#[$doc:meta])* $name:ident($inner:ident);)*) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, Copy)]
        pub struct $name($inner);

        impl $name {
            /// Begins now.
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
    /// The time that passes.
    WallClock(Instant);
    /// The time that this thread works.
    ThreadClock(ThreadTime);
    /// The time that all threads of the program work.
    ProcessClock(ProcessTime);
}

impl WallClock {
    /// The time since the start.
    pub fn elapsed(self) -> Duration {
        self.0.elapsed()
    }
}
