//! Parameters identified from measured records: damping, restitution, force curve.

mod chart;
mod clipped;
mod damping;
mod force;
mod found;
mod outliers;
mod peaks;
mod restitution;
mod rests;

use std::fmt::Display;
use std::path::Path;

use crate::numeric::{Turn, turns};
use crate::questions::{Error, Progress};
use crate::scene::{Channel, ColumnRequest, Measured, Quantity, Timing, read_measured};
use crate::study::{Said, Table, named};
pub use chart::{identified_chart, measured_chart, measured_force_chart};
pub use damping::damping;
pub use force::{FORCE_POINTS, force};
pub use found::{Identified, Identity, Unidentified};
pub(crate) use found::{median, noise, reach};
use found::{noise_between_impacts, with_interval};
pub use restitution::{restitution, restitution_of_times};

words! {
    /// What is identified from a record.
    WhatToIdentify {
        /// The damping ratio, of a free decay.
        Damping = "damping",
        /// The coefficient of restitution, of impacts on stops.
        Restitution = "restitution",
        /// The force over position, of a slow pull.
        Force = "force",
    }
}

/// Damping, restitution or force curve of a measured record, a CSV file with a header.
///
/// The table of the answer has, of damping, one row per some eight turning points (`turns`, `from_s`, `to_s`,
/// `amplitude_m` or that of a velocity or acceleration, then `damping_ratio`, `frequency_hz`, `decay_per_s`);
/// of restitution one row per impact (`t_s`, `side`, `v_in_m_per_s`, `v_out_m_per_s`, `restitution`); of a
/// force one row per position (`x_m`, `force_n`, `force_rising_n`, `force_falling_n`). Estimates have columns
/// with `low` and `high` in their names, the 95 % interval. The numbers of the whole record are in
/// `found.summary`.
///
/// # Method
///
/// Of damping an exponential envelope through the turning points, each weighted by its own error,
/// which gives the logarithmic decrement; of restitution polynomials through the flights on both sides of an
/// impact; of a force the mean of both directions of the pull. With more `points` a force curve follows the
/// samples more closely and averages fewer of them. A decay needs some ten samples per period, an impact some
/// eight in the flight after it.
///
/// # Errors
///
/// [`Error::Argument`] for an option that does not belong to the quantity or is out of its range;
/// [`Error::Unfit`] for a file that cannot be read, a column that is not found, or a record from which
/// nothing can be identified, with the reason.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Identify, Progress, WhatToIdentify};
///
/// // A free decay of 10 Hz with a damping ratio of 2 %, sampled at 1 kHz.
/// let rate = std::f64::consts::TAU * 10.0;
/// let damped = rate * (1.0 - 0.02_f64.powi(2)).sqrt();
/// let row = |t: f64| format!("{t},{}\n", (-0.02 * rate * t).exp() * (damped * t).cos());
/// let rows: String = (0..2000).map(|i| row(f64::from(i) * 1e-3)).collect();
/// let path = std::env::temp_dir().join(format!("interwell-decay-{}.csv", std::process::id()));
/// std::fs::write(&path, format!("t_s,x_mm\n{rows}")).unwrap();
/// let answer = Identify::of(WhatToIdentify::Damping).run(&path, &Progress::none());
/// std::fs::remove_file(&path).unwrap();
/// let ratio = answer?.found.summary[0];
/// assert_eq!(ratio.name, "damping_ratio");
/// assert!((ratio.value - 0.02).abs() < 1e-5);
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Identify {
    /// The quantity.
    pub of: WhatToIdentify,
    /// Column of the times and its unit; by default the column whose name ends with a unit of time.
    pub time: [Option<String>; 2],
    /// Column of the values and its unit; by default the column whose name ends with a unit of the measured
    /// quantity.
    pub column: [Option<String>; 2],
    /// For a force: column of the positions and its unit.
    pub position: [Option<String>; 2],
    /// For restitution: column of the acceleration of the base and its unit.
    pub base: [Option<String>; 2],
    /// Uses only the samples between these times in s.
    pub between: [Option<f64>; 2],
    /// For restitution: the record contains only the times of impacts, one per row.
    pub impact_times: bool,
    /// For a force: number of points of the curve, 4 to 100000; by default 101, or as many as the
    /// samples allow.
    pub points: Option<u32>,
}

/// The answer of [`Identify::run`]: the identified quantity, and the record from which it was identified.
///
/// The numbers that a scene takes are in [`found.summary`](Identified::summary), each with its 95 % interval.
/// [`identified_chart`](crate::output::identified_chart) draws the record with what was found.
#[derive(Debug, Clone)]
pub struct IdentifyAnswer {
    /// The result.
    pub found: Identified,
    /// The sampling of a record over time.
    pub timing: Option<Timing>,
    /// Times in s or positions in m; empty for impact times.
    pub across: Vec<f64>,
    /// The measured values; empty for impact times.
    pub values: Channel,
    /// A description of the columns that were read.
    pub columns: String,
}

impl IdentifyAnswer {
    /// One row per range of amplitude, impact or position.
    pub fn table(&self) -> &Table {
        &self.found.rows
    }
}

/// A description of the columns from which a record was read.
#[doc(hidden)]
pub fn columns_read<const N: usize>(record: &Measured<N>) -> String {
    let from = |channel: &Channel| format!("{} from `{}`", channel.quantity.name(), channel.column);
    let commas = if record.decimal_commas { ", with decimal commas" } else { "" };
    format!("{}{commas}", record.channels.each_ref().map(from).join(", "))
}

impl Identify {
    /// The question about a record whose columns are found by the units in their names.
    pub fn of(of: WhatToIdentify) -> Self {
        let [time, column, position, base] = [const { [None, None] }; 4];
        Self { of, time, column, position, base, between: [None; 2], impact_times: false, points: None }
    }

    /// Reads the record at `path` and identifies the quantity. Once it is cancelled, what it has begun is
    /// left to a thread that nobody waits for.
    pub fn run(&self, path: &Path, progress: &Progress) -> Result<IdentifyAnswer, Error> {
        self.check()?;
        let (question, path) = (self.clone(), path.to_owned());
        progress.unless_stopped(move || question.answer(&path))
    }

    /// Refuses options that do not belong to the quantity, and impossible values.
    pub fn check(&self) -> Result<(), Error> {
        use WhatToIdentify::{Force, Restitution};
        let of = self.of;
        for (name, given, only) in [
            ("impact_times", self.impact_times.then(String::new), Restitution),
            ("base", self.base[0].clone(), Restitution),
            ("base_unit", self.base[1].clone(), Restitution),
            ("points", self.points.map(|points| points.to_string()), Force),
            ("position", self.position[0].clone(), Force),
            ("position_unit", self.position[1].clone(), Force),
        ] {
            if let Some(value) = given.filter(|_| of != only) {
                let problem =
                    format!("belongs to {0} {1}, not to {0} {2}", named!("of"), only.name(), of.name());
                return Err(Error::argument(name, value, problem));
            }
        }
        for (name, given) in ["from", "to"].into_iter().zip(self.between) {
            if let Some(time) = given.filter(|_| of == Force) {
                let problem = format!("cuts a record over time; {} force has none", named!("of"));
                return Err(Error::number(name, time, problem));
            }
        }
        for (name, time) in ["from", "to"].into_iter().zip(self.between) {
            if let Some(time) = time.filter(|time| time.is_nan()) {
                return Err(Error::argument(name, time, "give a time in s"));
            }
        }
        if let [Some(from), Some(to)] = self.between
            && !(from < to)
        {
            let problem = format!("must lie before {}, which is {to}", named!("to"));
            return Err(Error::argument("from", from, problem));
        }
        if let Some(points) = self.points.filter(|points| !(4..=100_000).contains(points)) {
            return Err(Error::argument("points", points, "give 4 to 100000 points"));
        }
        self.check_restitution()
    }

    /// Refuses a unit without its column, and options that contradict `impact_times`.
    fn check_restitution(&self) -> Result<(), Error> {
        if let [None, Some(unit)] = &self.base {
            let problem = format!("is the unit of a column: name the column by {}", named!("base"));
            return Err(Error::argument("base_unit", unit, problem));
        }
        if let Some(base) = self.base[0].as_ref().filter(|_| self.impact_times) {
            let problem =
                format!("a record of {} has no displacement; leave one of them out", named!("impact_times"));
            return Err(Error::argument("base", base, problem));
        }
        Ok(())
    }

    fn answer(&self, path: &Path) -> Result<IdentifyAnswer, Error> {
        let request = |quantities: &[Quantity], [column, unit]: &[Option<String>; 2], names| {
            ColumnRequest::by_options(quantities, column, unit, names)
        };
        let times = request(&[Quantity::Time], &self.time, [named!("time"), named!("time_unit")]);
        let values_request =
            |quantities: &[_]| request(quantities, &self.column, [named!("column"), named!("unit")]);
        let answer = |found: Result<Identified, Unidentified>, timing, across, values, columns| {
            let found = found.map_err(|problem| about(path, problem))?;
            Ok(IdentifyAnswer { found, timing, across, values, columns })
        };
        match self.of {
            WhatToIdentify::Force => {
                let names = [named!("position"), named!("position_unit")];
                let positions = request(&[Quantity::Displacement], &self.position, names);
                let (record, columns) = read(path, &[positions, values_request(&[Quantity::Force])])?;
                let [x, values] = record.channels;
                let points = self.points.map(|points| points as usize);
                let found = force(&x.values, &values.values, points);
                answer(found, None, x.values, values, columns)
            }
            WhatToIdentify::Damping => {
                let any = [Quantity::Displacement, Quantity::Velocity, Quantity::Acceleration];
                let (record, columns) = read(path, &[times, values_request(&any)])?;
                let [times, values] = self.cut(record, path)?.channels;
                let found = damping(&times.values, &values);
                answer(found, Some(Timing::of(&times.values)), times.values, values, columns)
            }
            WhatToIdentify::Restitution if self.impact_times => {
                let (record, columns) = read(path, &[times])?;
                let [times] = self.cut(record, path)?.channels;
                let found = restitution_of_times(&times.values);
                let values = Channel { quantity: Quantity::Displacement, values: Vec::new(), ..times };
                answer(found, None, Vec::new(), values, columns)
            }
            WhatToIdentify::Restitution => {
                let values = values_request(&[Quantity::Displacement]);
                let ([times, values], base, columns) = if self.base[0].is_some() {
                    let base = {
                        let names = [named!("base"), named!("base_unit")];
                        request(&[Quantity::Acceleration], &self.base, names)
                    };
                    let (record, columns) = read(path, &[times, values, base])?;
                    let [times, values, base] = self.cut(record, path)?.channels;
                    ([times, values], Some(base.values), columns)
                } else {
                    let (record, columns) = read(path, &[times, values])?;
                    (self.cut(record, path)?.channels, None, columns)
                };
                let found = restitution(&times.values, &values.values, base.as_deref());
                answer(found, Some(Timing::of(&times.values)), times.values, values, columns)
            }
        }
    }

    /// Keeps only the rows in the time range of the question; the first channel is the time.
    fn cut<const N: usize>(&self, mut record: Measured<N>, path: &Path) -> Result<Measured<N>, Error> {
        let times = &record.channels[0].values;
        let [from, to] = self.between;
        let from = times.partition_point(|t| *t < from.unwrap_or(f64::NEG_INFINITY));
        let to = times.partition_point(|t| *t <= to.unwrap_or(f64::INFINITY));
        if to < from + 2 {
            let (first, last) = (times[0], times[times.len() - 1]);
            let (from, to) = (named!("from"), named!("to"));
            let few = format!("less than 2 samples from {from} to {to}");
            return Err(about(path, format!("{few}; the record goes from {first} to {last} s")));
        }
        for channel in &mut record.channels {
            channel.values = channel.values[from..to].to_vec();
        }
        Ok(record)
    }
}

fn read<const N: usize>(path: &Path, requests: &[ColumnRequest; N]) -> Result<(Measured<N>, String), Error> {
    let record = read_measured(path, requests).map_err(|problem| about(path, problem))?;
    let columns = columns_read(&record);
    Ok((record, columns))
}

fn about(path: &Path, problem: impl Display) -> Error {
    Error::Unfit { scene: path.display().to_string(), problem: Said::new(problem) }
}
