//! A recorded acceleration: straight lines between its samples, and where it is smooth at their spacing,
//! polynomials that replace many lines ([`pieces`](crate::numeric::pieces)). The base acceleration that is
//! reported is that of the lines.

use std::sync::Arc;

use crate::dynamics::clock::{Clock, Instant};
use crate::numeric::pieces::{DEGREE, Piece};
use crate::numeric::{Scalar, shift};
use crate::scene;

/// A straight line between two samples, or a polynomial over many.
#[derive(Debug, Clone)]
pub(crate) struct Line<T> {
    /// The segment of the drive in which this line begins, ascending.
    pub first_segment: usize,
    pub at: Instant<T>,
    /// Its value at `at`, kernel units.
    pub value: T,
    /// Its slope, kernel units.
    pub slope: T,
    /// The number of the piece whose polynomial replaces the lines.
    pub piece: Option<usize>,
}

/// The lines of one record in order of time; the last one is zero, as is the record before the first.
#[derive(Debug, Clone)]
pub(crate) struct Record<T> {
    pub lines: Vec<Line<T>>,
    pub source: Arc<scene::Record>,
    pub pieces: Arc<Vec<Piece>>,
    pub clock: Clock<T>,
}

/// The coefficients of a drive's records in kernel units, and how many there are.
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

/// The part of a record at an instant.
enum Place<'a, T> {
    /// The record has not begun.
    Before,
    Line(&'a Line<T>),
    /// A polynomial, the position in it from -1 to 1, and half its length in s.
    Piece(&'a Piece, T, f64),
}

impl<T: Scalar> Record<T> {
    fn place(&self, at: &Instant<T>, segment: usize) -> Place<'_, T> {
        let last = self.lines.partition_point(|line| line.first_segment <= segment);
        let Some(line) = last.checked_sub(1).map(|last| &self.lines[last]) else { return Place::Before };
        let Some(piece) = line.piece.map(|piece| &self.pieces[piece]) else { return Place::Line(line) };
        let times = &self.source.times;
        let (begin, end) = (times[piece.first], times[piece.first + piece.lines]);
        let half = 0.5 * (end - begin);
        // a run may begin within the piece
        let before = begin.min(0.0) / -half - 1.0;
        Place::Piece(
            piece,
            T::of(before) + self.clock.between(&line.at, at) * T::of(self.clock.unit / half),
            half,
        )
    }

    /// The value that acts on the motion: that of a polynomial if one replaces the line.
    pub fn value(&self, at: &Instant<T>, segment: usize) -> T {
        match self.place(at, segment) {
            Place::Before => T::zero(),
            Place::Line(line) => line.value + line.slope * self.clock.between(&line.at, at),
            Place::Piece(piece, s, _) => {
                let coefficients = piece.polynomial.iter().flat_map(|all| all.iter().rev());
                let value = coefficients.fold(T::zero(), |sum, c| sum * s + T::of(*c));
                value * T::of(self.clock.unit * self.clock.unit)
            }
        }
    }

    /// The value of the lines: that of the last sample at its time, and zero after it.
    pub fn exact(&self, at: &Instant<T>, segment: usize) -> T {
        match self.place(at, segment) {
            Place::Line(_) if self.is_last_sample(at) => {
                T::of(self.source.accelerations.last().copied().unwrap_or_default())
                    * T::of(self.clock.unit * self.clock.unit)
            }
            Place::Piece(piece, ..) => self.by_line(at, piece),
            _ => self.value(at, segment),
        }
    }

    fn is_last_sample(&self, at: &Instant<T>) -> bool {
        let end = self.source.times.last().filter(|end| **end >= 0.0);
        end.is_some_and(|end| self.clock.at(*end) == *at)
    }

    /// The value at an instant of the line that a piece replaces.
    fn by_line(&self, at: &Instant<T>, piece: &Piece) -> T {
        let (times, values) = (&self.source.times, &self.source.accelerations);
        let t = self.clock.seconds(at);
        let begun = times[piece.first..piece.first + piece.lines].partition_point(|time| *time <= t);
        let sample = piece.first + begun.saturating_sub(1);
        let slope = T::of(values[sample + 1] - values[sample]) / T::of(times[sample + 1] - times[sample]);
        let begin = self.clock.at(times[sample].max(0.0));
        let since = self.clock.between(&begin, at) * T::of(self.clock.unit) - T::of(times[sample].min(0.0));
        (T::of(values[sample]) + slope * since) * T::of(self.clock.unit * self.clock.unit)
    }

    /// Adds its coefficients to those of other records.
    pub fn seed(&self, at: &Instant<T>, segment: usize, series: &mut RecordSeries<T>) {
        let (value, slope) = match self.place(at, segment) {
            Place::Before => return,
            Place::Line(line) => (line.value + line.slope * self.clock.between(&line.at, at), line.slope),
            Place::Piece(piece, s, half) => {
                let mut about = [T::zero(); DEGREE + 1];
                let coefficients = piece.polynomial.iter().flat_map(|all| all.iter());
                about.iter_mut().zip(coefficients).for_each(|(about, c)| *about = T::of(*c));
                shift(&mut about, s);
                let (mut scale, unit) =
                    (T::of(self.clock.unit * self.clock.unit), T::of(self.clock.unit / half));
                for (sum, c) in series.a.iter_mut().zip(about) {
                    *sum += c * scale;
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
}
