//! A recorded acceleration: straight lines between its samples, and polynomials that stand for many of them.
//!
//! Where a record is smooth at the spacing of its samples, a polynomial stands for many lines in flight, to a
//! share of the tolerance of the motion ([`pieces`](crate::numeric::pieces)); it is made once for all runs
//! that share the record. What is told of the base, and the search for a release, are those of the lines.
//! From a release to the next sample a flight follows its line too, so that its net force begins at 0.

use std::ops::RangeInclusive;
use std::sync::Arc;

use crate::dynamics::clock::{Clock, Instant};
use crate::numeric::Scalar;
use crate::numeric::pieces::{DEGREE, Piece};
use crate::scene;

/// Segments from here on are single lines within a polynomial, by the number of their first sample.
const INSIDE: usize = 1 << 40;

/// A straight line between two samples, or a polynomial over many.
#[derive(Debug, Clone)]
pub(crate) struct Line<T> {
    /// The segment of the drive in which this line begins, ascending.
    pub first_segment: usize,
    /// When it begins.
    pub at: Instant<T>,
    /// The sample with which it begins.
    pub sample: usize,
    /// Its value there and its slope, kernel units.
    pub value: T,
    pub slope: T,
    /// The number of the piece whose polynomial is there in place of lines.
    pub piece: Option<usize>,
}

/// The lines of one record in their order; the last one is zero. Before the first the record is zero too.
#[derive(Debug, Clone)]
pub(crate) struct Record<T> {
    pub lines: Vec<Line<T>>,
    pub source: Arc<scene::Record>,
    pub pieces: Arc<Vec<Piece>>,
    pub clock: Clock<T>,
}

/// The coefficients of a drive's record in kernel units, and how many there are.
#[derive(Debug, Clone)]
pub(crate) struct RecordSeries<T> {
    pub a: [T; DEGREE + 1],
    pub known: usize,
}

impl<T: Scalar> Default for RecordSeries<T> {
    fn default() -> Self {
        Self { a: [T::zero(); DEGREE + 1], known: 0 }
    }
}

/// What is there of a record.
enum Place<'a, T> {
    /// Nothing yet.
    Before,
    Line(&'a Line<T>),
    /// A single line within a polynomial, from this sample.
    Single(usize),
    /// A polynomial, at a place from -1 to 1, and half its length in s.
    Piece(&'a Piece, T, f64),
}

impl<T: Scalar> Record<T> {
    /// The line of a segment.
    fn line(&self, segment: usize) -> Option<&Line<T>> {
        let last = match segment.checked_sub(INSIDE) {
            Some(sample) => self.lines.partition_point(|line| line.sample <= sample),
            None => self.lines.partition_point(|line| line.first_segment <= segment),
        };
        last.checked_sub(1).map(|last| &self.lines[last])
    }

    fn place(&self, at: &Instant<T>, segment: usize) -> Place<'_, T> {
        if let Some(sample) = segment.checked_sub(INSIDE) {
            return Place::Single(sample);
        }
        let Some(line) = self.line(segment) else { return Place::Before };
        let Some(piece) = line.piece.map(|piece| &self.pieces[piece]) else { return Place::Line(line) };
        let times = &self.source.times;
        let (begin, end) = (times[piece.first], times[piece.first + piece.lines]);
        let half = 0.5 * (end - begin);
        // (a run may begin within it)
        let before = begin.min(0.0) / -half - 1.0;
        Place::Piece(
            piece,
            T::of(before) + self.clock.between(&line.at, at) * T::of(self.clock.unit() / half),
            half,
        )
    }

    /// The value in flight.
    pub fn value(&self, at: &Instant<T>, segment: usize) -> T {
        match self.place(at, segment) {
            Place::Before => T::zero(),
            Place::Line(line) => line.value + line.slope * self.clock.between(&line.at, at),
            Place::Single(sample) => self.single(at, sample).0,
            Place::Piece(piece, s, _) => {
                let coefficients = piece.polynomial.iter().flat_map(|own| own.iter().rev());
                let value = coefficients.fold(T::zero(), |sum, c| sum * s + T::of(*c));
                value * T::of(self.clock.unit() * self.clock.unit())
            }
        }
    }

    /// The value by the lines.
    pub fn exact(&self, at: &Instant<T>, segment: usize) -> T {
        match self.place(at, segment) {
            Place::Piece(piece, ..) => self.single(at, self.sample(at, piece)).0,
            _ => self.value(at, segment),
        }
    }

    /// The value and the slope of the line from a sample.
    fn single(&self, at: &Instant<T>, sample: usize) -> (T, T) {
        let (times, values) = (&self.source.times, &self.source.accelerations);
        let slope = T::of(values[sample + 1] - values[sample]) / T::of(times[sample + 1] - times[sample]);
        let begin = self.clock.at(times[sample].max(0.0));
        let since = self.clock.between(&begin, at) * T::of(self.clock.unit()) - T::of(times[sample].min(0.0));
        let square = self.clock.unit() * self.clock.unit();
        ((T::of(values[sample]) + slope * since) * T::of(square), slope * T::of(square * self.clock.unit()))
    }

    /// The sample of a piece whose line is there at an instant.
    fn sample(&self, at: &Instant<T>, piece: &Piece) -> usize {
        let t = self.clock.seconds(at);
        let times = &self.source.times[piece.first..piece.first + piece.lines];
        piece.first + times.partition_point(|time| *time <= t).saturating_sub(1)
    }

    /// Adds its series to that of other records.
    pub fn seed(&self, at: &Instant<T>, segment: usize, series: &mut RecordSeries<T>) {
        let (value, slope) = match self.place(at, segment) {
            Place::Before => return,
            Place::Line(line) => (line.value + line.slope * self.clock.between(&line.at, at), line.slope),
            Place::Single(sample) => self.single(at, sample),
            Place::Piece(piece, s, half) => {
                let mut own = [T::zero(); DEGREE + 1];
                let coefficients = piece.polynomial.iter().flat_map(|all| all.iter());
                own.iter_mut().zip(coefficients).for_each(|(own, c)| *own = T::of(*c));
                // about s in place of 0
                for k in 0..DEGREE {
                    for power in (k..DEGREE).rev() {
                        let above = own[power + 1];
                        own[power] += s * above;
                    }
                }
                let (mut scale, unit) =
                    (T::of(self.clock.unit() * self.clock.unit()), T::of(self.clock.unit() / half));
                for (sum, own) in series.a.iter_mut().zip(own) {
                    *sum += own * scale;
                    scale = scale * unit;
                }
                series.known = DEGREE + 1;
                return;
            }
        };
        series.a[0] += value;
        series.a[1] += slope;
        series.known = series.known.max(2);
    }

    /// In a polynomial, the samples whose lines it stands for, from the one before an instant on.
    pub fn samples_from(&self, at: &Instant<T>, segment: usize) -> Option<RangeInclusive<usize>> {
        let piece = self.line(segment)?.piece.map(|piece| &self.pieces[piece])?;
        Some(self.sample(at, piece)..=piece.first + piece.lines)
    }

    /// The line from a sample within a polynomial: its segment, and when it begins and ends.
    pub fn single_line(&self, sample: usize) -> (usize, [Instant<T>; 2]) {
        let at = |sample: usize| self.clock.at(self.source.times[sample].max(0.0));
        (INSIDE + sample, [at(sample), at(sample + 1)])
    }

    /// The segment of the line that is there within a polynomial; the same one elsewhere.
    pub fn single_segment(&self, at: &Instant<T>, segment: usize) -> usize {
        match self.place(at, segment) {
            Place::Piece(piece, ..) => INSIDE + self.sample(at, piece),
            _ => segment,
        }
    }

    /// The segment that follows a single line within a polynomial, and when that line ends.
    pub fn after_single(&self, segment: usize) -> Option<(usize, Instant<T>)> {
        let end = segment.checked_sub(INSIDE)? + 1;
        let line = self.line(segment)?;
        let piece = line.piece.map(|piece| &self.pieces[piece])?;
        let last = piece.first + piece.lines == end;
        Some((line.first_segment + usize::from(last), self.clock.at(self.source.times[end])))
    }
}
