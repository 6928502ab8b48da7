//! Steady tones side by side: the lines of a noise.
//!
//! Sixteen tones are advanced by the same vector instructions, of whatever width the processor has. The sums
//! are taken in sixteen columns, which are added at the end, so that they have the same bits for any width.

use super::tone::{Tone, TurnsPerCycle};
use crate::dynamics::clock::Instant;
use crate::dynamics::series::{ROOM, SEEDED};
use crate::numeric::{Scalar, widest};

const GROUP_SIZE: usize = 16;

type Columns<T> = [T; GROUP_SIZE];

/// Sixteen tones; unused places have amplitude 0.
#[derive(Debug, Clone)]
struct Group<T> {
    amplitude: Columns<T>,
    frequency: Columns<T>,
    omega: Columns<T>,
    phase: Columns<T>,
    ratio: [TurnsPerCycle; GROUP_SIZE],
}

/// Tones of constant amplitude.
#[derive(Debug, Clone, Default)]
pub(crate) struct Lines<T> {
    groups: Vec<Group<T>>,
    count: usize,
}

/// State that continues the series of the tones.
#[derive(Debug, Clone)]
pub(crate) struct LinesCursor<T> {
    /// The cycle of the clock for which `starts` holds.
    cycle: Option<i64>,
    /// The turns of the tones at the beginning of that cycle.
    starts: Vec<Columns<T>>,
    /// The last coefficients of even and of odd order.
    terms: [Vec<Columns<T>>; 2],
}

impl<T> Default for LinesCursor<T> {
    fn default() -> Self {
        Self { cycle: None, starts: Vec::new(), terms: [Vec::new(), Vec::new()] }
    }
}

impl<T: Scalar> Lines<T> {
    /// From tones without a ramp and not a quarter turn ahead.
    pub fn new(tones: &[Tone<T>]) -> Self {
        let group = |tones: &[Tone<T>]| {
            let of =
                |value: fn(&Tone<T>) -> T| std::array::from_fn(|i| tones.get(i).map_or_else(T::zero, value));
            Group {
                amplitude: of(|tone| tone.amplitude),
                frequency: of(|tone| tone.frequency),
                omega: of(|tone| T::tau() * tone.frequency),
                phase: of(|tone| tone.phase),
                ratio: std::array::from_fn(|i| {
                    tones.get(i).map_or(TurnsPerCycle::Rounded(0.0), |tone| tone.ratio)
                }),
            }
        };
        Self { groups: tones.chunks(GROUP_SIZE).map(group).collect(), count: tones.len() }
    }

    pub fn count(&self) -> usize {
        self.count
    }

    /// Adds their first coefficients at an instant.
    pub fn seed(&self, at: &Instant<T>, sums: &mut [T; SEEDED], cursor: &mut LinesCursor<T>) {
        if self.count == 0 {
            return;
        }
        if cursor.cycle != Some(at.cycle) {
            cursor.cycle = Some(at.cycle);
            cursor.starts.clear();
            cursor.starts.extend(self.groups.iter().map(|group| group.starts(at.cycle)));
        }
        let zero = [T::zero(); GROUP_SIZE];
        cursor.terms.iter_mut().for_each(|term| term.resize(self.groups.len(), zero));
        let [even, odd] = &mut cursor.terms;
        let column_sums = widest(
            #[inline(always)]
            || {
                let mut columns = [zero; SEEDED];
                let terms = even.iter_mut().zip(odd.iter_mut());
                for ((group, start), (even, odd)) in self.groups.iter().zip(&cursor.starts).zip(terms) {
                    let Group { amplitude, frequency, omega, phase, .. } = group;
                    // column by column, so that each is one instruction
                    let [mut value, mut slope, mut second, mut third] = [zero; SEEDED];
                    for i in 0..GROUP_SIZE {
                        let (s, c) = T::sin_cos_turns(at.phase * frequency[i] + (start[i] + phase[i]));
                        value[i] = amplitude[i] * s;
                        slope[i] = amplitude[i] * (c * omega[i]);
                    }
                    for i in 0..GROUP_SIZE {
                        let curvature = -(omega[i] * omega[i]);
                        second[i] = curvature * value[i] * T::of(0.5);
                        third[i] = curvature * slope[i] * T::of(1.0 / 6.0);
                    }
                    (*even, *odd) = (second, third);
                    for (column, more) in columns.iter_mut().zip([value, slope, second, third]) {
                        for i in 0..GROUP_SIZE {
                            column[i] += more[i];
                        }
                    }
                }
                columns
            },
        );
        for (sum, columns) in sums.iter_mut().zip(column_sums) {
            *sum += total(columns);
        }
    }

    /// Their coefficient of order `k`; the one of order `k - 1` must have been computed before.
    pub fn next(&self, k: usize, inverse: &[T; ROOM], cursor: &mut LinesCursor<T>) -> T {
        if self.count == 0 {
            return T::zero();
        }
        let (terms, share) = (&mut cursor.terms[k % 2], inverse[k]);
        let column_sums = widest(
            #[inline(always)]
            || {
                let mut columns = [T::zero(); GROUP_SIZE];
                for (group, term) in self.groups.iter().zip(terms.iter_mut()) {
                    let mut next = *term;
                    for i in 0..GROUP_SIZE {
                        next[i] = -(group.omega[i] * group.omega[i]) * next[i] * share;
                        columns[i] += next[i];
                    }
                    *term = next;
                }
                columns
            },
        );
        total(column_sums)
    }

    /// Their acceleration at an instant, the first coefficient bit for bit.
    pub fn value(&self, at: &Instant<T>) -> T {
        let mut sums = [T::zero(); SEEDED];
        self.seed(at, &mut sums, &mut LinesCursor::default());
        sums[0]
    }
}

impl<T: Scalar> Group<T> {
    /// The turns of the tones at the beginning of a cycle, without whole turns.
    fn starts(&self, cycle: i64) -> Columns<T> {
        self.ratio.map(|ratio| T::of(ratio.fraction(cycle)))
    }
}

/// The sum of the columns, by halves.
fn total<T: Scalar>(mut columns: Columns<T>) -> T {
    let mut half = GROUP_SIZE / 2;
    while half > 0 {
        for i in 0..half {
            columns[i] += columns[i + half];
        }
        half /= 2;
    }
    columns[0]
}
