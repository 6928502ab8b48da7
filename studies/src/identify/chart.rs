//! Pictures of a measured record: with a fit or a computed curve, and a lower panel of the residuals or of
//! numbers with their intervals; or over a computed motion.

use super::{Identified, Identity};
use crate::curve::{telling, wall};
use crate::dynamics::STANDARD_GRAVITY;
use crate::numeric::{extent, short};
use crate::output::{
    BASE_ACCELERATION, Chart, DISPLACEMENT, Drawn, HOLDING_FORCE, Marks, Panel, PlotAxis, Point, Ranges,
    Role, TIME, VELOCITY, axis_name, suited_unit,
};
use crate::scene::{Quantity, Timing};
use crate::study::{Comparison, ForceComparison, Table, Trace};

/// Number of samples below which they are drawn as dots.
const DOTS: usize = 400;

/// The height of the lower panel over that of the upper one.
const LOWER: f64 = 0.5;

/// A line or points over the record.
struct Series {
    /// In the legend; empty for a line that belongs to the series before.
    name: &'static str,
    /// In the table of drawn data.
    series: &'static str,
    points: Vec<Point>,
    role: Role,
    /// How they are drawn.
    marks: fn(Vec<Point>) -> Marks,
}

impl Series {
    /// The points of a line next to its first and its last zero, between them.
    fn zeros(&self) -> Option<(f64, f64)> {
        let zeros = || self.points.windows(2).filter(|pair| pair[0].1 * pair[1].1 <= 0.0);
        Some((zeros().next()?[1].0, zeros().next_back()?[0].0))
    }
}

enum Lower {
    /// Residuals about 0: label, and name of the series in the drawn data.
    Rest(&'static str, &'static str, Vec<Point>),
    /// Numbers with their intervals over the same axis, and the one for all: their label, their column and
    /// what each is of.
    Intervals([&'static str; 3], Vec<(f64, [f64; 3])>, Option<Identity>),
}

/// A picture in the units of its axes.
struct RecordPicture {
    across: &'static str,
    up: &'static str,
    unit: &'static str,
    /// Names of both columns in the drawn data, and the factors from SI to the axes.
    columns: [String; 2],
    scales: [f64; 2],
    record: Vec<Point>,
    /// Whether its x rises from sample to sample.
    rises: bool,
    over: Vec<Series>,
    lower: Lower,
}

/// The picture of what was identified `of` a record, from the two columns that it was identified from in SI,
/// the second one of this quantity; of impact times alone there is one column.
///
/// `of` is the name of the quantity; the others are fields of an
/// [`IdentifyAnswer`](crate::questions::IdentifyAnswer).
pub fn identified_chart(
    of: &str,
    found: &Identified,
    (across, values): (&[f64], &[f64]),
    quantity: Quantity,
    ranges: Ranges,
) -> Chart {
    let (scale, up, unit) = axis_of(quantity, values);
    let column = |table: &'_ Table, name: &str| table.numbers(name).unwrap_or_default().to_vec();
    let fitted = |x: &str, y: &str, k: f64| -> Vec<Point> {
        let (x, y) = (column(&found.fitted, x), column(&found.fitted, y));
        x.into_iter().zip(y).map(|(x, y)| (x * k, y * scale)).collect()
    };
    let intervals = |x: Vec<f64>, name: &str| -> Vec<(f64, [f64; 3])> {
        let all = ["", "_low", "_high"].map(|end| column(&found.rows, &format!("{name}{end}")));
        x.into_iter().enumerate().map(|(i, x)| (x, [0, 1, 2].map(|k| all[k][i]))).collect()
    };
    let first = found.summary.first().copied();
    let line = |role, name, series, points| Series { name, series, points, role, marks: Marks::Path };
    let markers = |role, name, series, points| Series { name, series, points, role, marks: Marks::Points };
    let (over, lower) = match of {
        "force" => (
            vec![line(Role::Curve, "identified curve", "identified", pairs(&found.rows, scale))],
            Lower::Rest("residual", "residual", fitted("x_m", "residual_n", 1e3)),
        ),
        "damping" => {
            let (from, to) = (column(&found.rows, "from_s"), column(&found.rows, "to_s"));
            let middle = from.iter().zip(&to).map(|(a, b)| 0.5 * (a + b)).collect();
            let envelope = |name, of, end| line(Role::Envelope, name, of, fitted("t_s", end, 1.0));
            let upper = envelope("identified envelope", "upper_envelope", "upper");
            let rows = intervals(middle, "damping_ratio");
            (
                vec![upper, envelope("", "lower_envelope", "lower")],
                Lower::Intervals(["damping ratio", "damping_ratio", "of eight turning points"], rows, first),
            )
        }
        _ => {
            let (impacts, rebounds) = (fitted("t_s", "x_m", 1.0), fitted("rebound_t_s", "rebound_x_m", 1.0));
            let rows = intervals(column(&found.rows, "t_s"), "restitution");
            (
                vec![
                    markers(Role::Impact, "impact", "impact", impacts),
                    markers(Role::Rebound, "end of a rebound", "rebound", rebounds),
                ],
                Lower::Intervals(["restitution", "restitution", "of one impact"], rows, first),
            )
        }
    };
    let is_force = of == "force";
    let (label, name, k) = if is_force { (DISPLACEMENT, "x_m", 1e3) } else { (TIME, "t_s", 1.0) };
    let picture = RecordPicture {
        across: label,
        up,
        unit,
        columns: [name.to_owned(), column_of(quantity)],
        scales: [k, scale],
        record: across.iter().zip(values).map(|(x, y)| (x * k, y * scale)).collect(),
        rises: !is_force,
        over,
        lower,
    };
    picture.chart(&summary_words(&found.summary), ranges)
}

/// The picture of the answer of [`Simulation::compared_force`](crate::questions::Simulation::compared_force)
/// over the computed curve, of which `curve` is the table: forces in N or mN over the displacement in mm, and
/// below them the difference, computed minus measured. `ranges` are those of the upper panel, in the units of
/// its axes.
pub fn measured_force_chart(found: &ForceComparison, curve: &Table, ranges: Ranges) -> Chart {
    let (scale, up, unit) = axis_of(Quantity::Force, &found.measured);
    let mm = |values: &[f64]| -> Vec<Point> {
        found.positions.iter().zip(values).map(|(x, value)| (x * 1e3, value * scale)).collect()
    };
    let apart: Vec<f64> = found.measured.iter().zip(&found.computed).map(|(m, c)| c - m).collect();
    let (low, high) = extent(found.positions.iter().copied());
    let near = pairs(curve, scale).into_iter().filter(|point| (low * 1e3..=high * 1e3).contains(&point.0));
    let name = "computed";
    let computed =
        Series { name, series: name, points: near.collect(), role: Role::Curve, marks: Marks::Path };
    let picture = RecordPicture {
        across: DISPLACEMENT,
        up,
        unit,
        columns: ["x_m".to_owned(), column_of(Quantity::Force)],
        scales: [1e3, scale],
        record: mm(&found.measured),
        rises: false,
        over: vec![computed],
        lower: Lower::Rest("difference", "difference", mm(&apart)),
    };
    let (at, largest) = found.largest;
    let mut words = rms_difference(found.rms, scale, unit);
    let (most, at) = (short((largest * scale).abs()), short(at * 1e3).replace('-', "\u{2212}"));
    words += &format!("; at most {most} {unit}, at {at} mm");
    picture.chart(&words, ranges)
}

/// The first number with its interval and the second one; of a force curve the wells, the barrier and the
/// hysteresis.
fn summary_words(summary: &[Identity]) -> String {
    let of = |name: &str| summary.iter().find(|number| number.name == name).map(|number| number.value);
    let known = |name: &str, unit: f64| of(name).map(|value| short(value * unit));
    let mut parts = Vec::new();
    if let (Some(left), Some(right)) = (known("left_well_m", 1e3), known("right_well_m", 1e3)) {
        parts.push(format!("wells at {left} and {right} mm"));
    }
    let barrier = (known("barrier_from_left_j", 1e3), known("barrier_from_right_j", 1e3));
    if let (Some(left), Some(right)) = barrier {
        parts.push(format!("barrier of {left} mJ from the left, {right} mJ from the right"));
    }
    parts.extend(known("hysteresis_n", 1.0).map(|force| format!("hysteresis {force} N")));
    if parts.is_empty() {
        parts.extend(summary.first().map(Identity::describe));
        parts.extend(of("frequency_hz").map(|frequency| format!("{} Hz", short(frequency))));
    }
    parts.join(", ").replace('-', "\u{2212}")
}

/// The column of a quantity in the table of drawn data.
fn column_of(quantity: Quantity) -> String {
    let name = match quantity {
        Quantity::Velocity => "v",
        Quantity::Acceleration => "accel",
        Quantity::Force => "force",
        _ => "x",
    };
    format!("{name}{}", quantity.ending())
}

/// Position and force of a table, in mm and scaled.
fn pairs(table: &Table, scale: f64) -> Vec<Point> {
    let [x, force] = ["x_m", "force_n"].map(|name| table.numbers(name).unwrap_or_default());
    x.iter().zip(force).map(|(x, force)| (x * 1e3, force * scale)).collect()
}

/// The factor from SI to the unit of an axis, what the axis is called, and that unit.
fn axis_of(quantity: Quantity, values: &[f64]) -> (f64, &'static str, &'static str) {
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    match quantity {
        Quantity::Velocity => {
            let (scale, unit) = suited_unit("m/s", values.iter().copied());
            (scale, VELOCITY, unit)
        }
        Quantity::Acceleration => (1.0 / STANDARD_GRAVITY, BASE_ACCELERATION, "g"),
        Quantity::Force if largest < 0.1 => (1e3, HOLDING_FORCE, "mN"),
        Quantity::Force => (1.0, HOLDING_FORCE, "N"),
        _ => (1e3, "displacement", "mm"),
    }
}

/// The root mean square of a difference in words, with its share in percent where it is known.
fn rms_difference((rms, percent): (f64, f64), scale: f64, unit: &str) -> String {
    let words = format!("RMS difference {} {unit}", short(rms * scale));
    if percent.is_finite() { format!("{words}, {} % of the RMS measured", short(percent)) } else { words }
}

impl RecordPicture {
    fn chart(&self, words: &str, ranges: Ranges) -> Chart {
        let inside = |point: &&Point| ranges.x.is_none_or(|(a, b)| (a..=b).contains(&point.0));
        let shown = || self.record.iter().filter(inside);
        let (label, lower, places) = match &self.lower {
            Lower::Rest(label, _, points) => {
                let label = format!("{label} ({})", self.unit);
                (label, points.iter().map(|point| point.1).chain([0.0]).collect(), Vec::new())
            }
            Lower::Intervals([label, ..], rows, all) => {
                let ends = all.iter().flat_map(|number| [number.interval.0, number.interval.1]);
                let places = rows.iter().map(|row| row.0).collect();
                let rows = rows.iter().flat_map(|row| row.1);
                ((*label).to_owned(), rows.chain(ends).collect::<Vec<f64>>(), places)
            }
        };
        let places = self.record.iter().map(|point| point.0).chain(places);
        let across = PlotAxis::around(places, 0.0, self.across).or_given(ranges.x);
        let drawn = self.over.iter().flat_map(|series| &series.points).filter(inside);
        let seen: Vec<Point> = shown().chain(drawn).copied().collect();
        let (low, high) = telling(&seen, self.over.first().filter(|_| !self.rises).and_then(Series::zeros));
        let up_label = axis_name(self.up, self.unit);
        let up = PlotAxis::around([low, high], 0.08, &up_label).or_given(ranges.y);
        let mut upper = Panel::new(across.clone(), up);
        let is_cloud = shown().count() < DOTS;
        if !self.record.is_empty() {
            let marks = match (is_cloud, self.rises) {
                (true, _) => Marks::Cloud(self.record.clone()),
                (_, true) => Marks::Trace(parted(&self.record)),
                (_, false) => Marks::Path(self.record.clone()),
            };
            upper.layer(Role::Measured, "measured", marks);
        }
        for series in &self.over {
            upper.layer(series.role, series.name, (series.marks)(series.points.clone()));
        }
        let below = PlotAxis::around(lower, 0.12, &label);
        let mut lower = Panel { height: LOWER, ..Panel::new(across, below) };
        match &self.lower {
            Lower::Rest(_, _, points) => {
                lower.draw(Role::Reference, Marks::Horizontals(vec![0.0]));
                lower.draw(Role::Measured, Marks::Cloud(points.clone()));
            }
            Lower::Intervals([.., each], rows, all) => {
                if let Some(number) = all {
                    let (low, high) = number.interval;
                    let band = [lower.x.low, lower.x.high].map(|x| [x, low, high]);
                    lower.layer(Role::Around, "of all, with its 95 % interval", Marks::Band(band.into()));
                    lower.draw(Role::Reference, Marks::Horizontals(vec![number.value]));
                }
                let bars = rows.iter().filter(|row| row.1[1].is_finite() && row.1[2].is_finite());
                let bars = bars.map(|(x, [_, low, high])| [*x, *low, *high]).collect();
                lower.layer_if_any(Role::Measured, "95 % interval", Marks::Intervals(bars));
                let points = rows.iter().map(|(x, [value, ..])| (*x, *value)).collect();
                lower.layer(Role::Interval, *each, Marks::Points(points));
            }
        }
        let beyond = wall(&seen, &upper, self.scales[1]).filter(|_| !self.rises);
        Chart::stack(vec![upper, lower], words.to_owned() + &beyond.unwrap_or_default(), self.data())
    }

    /// The drawn data, in SI.
    fn data(&self) -> Table {
        let below = match &self.lower {
            Lower::Rest(..) => Vec::new(),
            Lower::Intervals([_, name, _], ..) => {
                ["", "_low", "_high"].map(|end| format!("{name}{end}")).into()
            }
        };
        let mut drawn = Drawn::new(self.columns.iter().chain(&below).map(String::as_str), &[]);
        let [k, scale] = self.scales;
        let mut put = |series, points: &[Point]| {
            points.iter().for_each(|(x, y)| drawn.put(series, &[x / k, y / scale], &[]));
        };
        put("measured", &self.record);
        self.over.iter().for_each(|series| put(series.series, &series.points));
        match &self.lower {
            Lower::Rest(_, series, points) => put(series, points),
            Lower::Intervals([_, name, _], rows, _) => {
                for (x, [y, low, high]) in rows {
                    drawn.put(name, &[x / k, f64::NAN, *y, *low, *high], &[]);
                }
            }
        }
        drawn.table()
    }
}

/// A record over time, parted where samples are missing.
fn parted(record: &[Point]) -> Vec<Point> {
    let timing = Timing::of(&record.iter().map(|point| point.0).collect::<Vec<_>>());
    let parts = record.chunk_by(|a, b| !timing.is_gap(b.0 - a.0));
    parts.flat_map(|part| part.iter().copied().chain([(f64::NAN, f64::NAN)])).collect()
}

/// The picture of a run from its trace, with the measured values over it; `inset` are the times in s that a
/// second panel shows closer, `ranges` those of the first.
#[doc(hidden)]
pub fn measured_chart(trace: &Trace, found: &Comparison, inset: Option<(f64, f64)>, ranges: Ranges) -> Chart {
    let column = |name: &str| trace.path.numbers(name).unwrap_or_default();
    let quantity = found.quantity;
    let (scale, words, unit) = axis_of(quantity, &found.measured);
    let label = axis_name(words, unit);
    let name = match quantity {
        Quantity::Velocity => "v_m_per_s",
        Quantity::Acceleration => "base_accel_m_per_s2",
        _ => "x_m",
    };
    let scaled = |times: &[f64], values: &[f64]| -> Vec<Point> {
        times.iter().zip(values).map(|(t, value)| (*t, value * scale)).collect()
    };
    let computed = scaled(column("t_s"), column(name));
    let measured = scaled(&found.times, &found.measured);
    let panel = |(from, to): (f64, f64), given: Option<(f64, f64)>, closer: Option<(f64, f64)>| {
        let seen = |data: &[Point]| -> Vec<Point> {
            data.iter().copied().filter(|point| (from..=to).contains(&point.0)).collect()
        };
        let (seen_computed, seen_measured) = (seen(&computed), seen(&measured));
        let all = seen_computed.iter().chain(&seen_measured).map(|point| point.1);
        let up = PlotAxis::around(all, 0.09, &label).or_given(given);
        let mut panel = Panel::new(PlotAxis::between(from, to, TIME), up);
        if let Some(times) = closer {
            panel.layer(Role::Closer, "shown closer below", Marks::Spans(vec![times]));
        }
        if quantity == Quantity::Displacement {
            panel.level_stops((trace.stops.0 * 1e3, trace.stops.1 * 1e3));
        }
        // many samples lie below the computed line, few over it
        let is_cloud = seen_measured.len() < DOTS;
        if !is_cloud {
            panel.layer(Role::Measured, "measured", Marks::Trace(parted(&measured)));
        }
        panel.layer(Role::Motion, "computed", Marks::Trace(computed.clone()));
        if is_cloud {
            panel.layer(Role::Measured, "measured", Marks::Cloud(measured.clone()));
        }
        panel
    };
    let mut panels = vec![panel(ranges.x.unwrap_or((0.0, trace.end)), ranges.y, inset)];
    panels.extend(inset.map(|times| panel(times, None, None)));
    let mut drawn = Drawn::new(["t_s", name], &[]);
    for (series, points) in [("computed", &computed), ("measured", &measured)] {
        points.iter().for_each(|(t, value)| drawn.put(series, &[*t, value / scale], &[]));
    }
    let mut words = rms_difference(found.rms, scale, unit);
    if found.shift != 0.0 {
        words += &format!("; record shifted by {} s", short(found.shift)).replace('-', "\u{2212}");
    }
    Chart::stack(panels, words, drawn.table())
}
