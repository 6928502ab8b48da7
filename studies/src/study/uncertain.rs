//! Uncertain inputs: fields with normal distributions, their draws, and the bands of results.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::grid::is_of_mechanism;
use super::{Cell, Grid, Read, Row, SummaryField, Table, Values};
use crate::numeric::{normal_probability, normal_quantile, number_text};
use crate::scene::{FieldPath, Range, Scene, Uncertain, field_info};

/// Number of draws if none is given.
pub const DRAWS: u64 = 100;
/// Largest number of draws.
pub const MAX_DRAWS: u64 = 100_000;
/// Seed of the draws if none is given.
const SEED: u64 = 1;

/// The quantiles at the ends of a band in fortieths: 2.5 % and 97.5 %.
const ENDS: [usize; 2] = [1, 39];

const COUNT: &str = "draws";

/// A field that is known with a standard deviation.
#[derive(Debug, Clone, PartialEq)]
pub struct Variation {
    /// Dotted path of the field.
    pub field: String,
    /// The standard deviation: a share of the value, or in the field's unit.
    pub by: f64,
    /// Whether it is a share.
    pub relative: bool,
}

/// The draws of uncertain fields, from independent normal distributions about the value of each field, which
/// are truncated to its range. The k-th draw is at the same probabilities in every cell.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Draws {
    fields: Vec<DrawnField>,
    count: u64,
    seed: u64,
}

#[derive(Debug, Clone, PartialEq)]
struct DrawnField {
    law: Variation,
    path: FieldPath,
    range: Range,
    /// The axis of the grid that has the field.
    axis: Option<usize>,
    value: f64,
    probabilities: Vec<f64>,
}

fn sigma(law: &Variation, value: f64) -> f64 {
    if law.relative { law.by * value.abs() } else { law.by }
}

/// The probabilities below the least and below the largest value of the range of a field.
fn within(law: &Variation, range: Range, value: f64) -> [f64; 2] {
    let sigma = sigma(law, value);
    [range.low, range.high].map(|end| normal_probability((end - value) / sigma))
}

/// The share of the normal distribution of a field about a value that lies in the range of the field.
pub fn share_in_range(law: &Variation, value: f64) -> f64 {
    let Some(field) = field_info(&law.field).filter(|_| sigma(law, value) > 0.0) else { return 1.0 };
    let [below_low, below_high] = within(law, field.range, value);
    below_high - below_low
}

impl DrawnField {
    /// The standard deviation, in the unit of the field or as a percentage of its value.
    fn deviation(&self) -> String {
        // 15 digits, so that 7 % is 7 and not 7.000000000000001, and is read as the same share
        let percent = || format!("{:.14e}", self.law.by * 100.0).parse().unwrap_or(self.law.by * 100.0);
        if self.law.relative { format!("{}%", number_text(percent())) } else { number_text(self.law.by) }
    }

    /// The value at a probability, about a value of the field.
    fn at(&self, probability: f64, value: f64) -> f64 {
        let sigma = sigma(&self.law, value);
        if sigma == 0.0 {
            return value;
        }
        let [below_low, below_high] = within(&self.law, self.range, value);
        let drawn = value + sigma * normal_quantile(below_low + probability * (below_high - below_low));
        drawn.clamp(self.range.low, self.range.high)
    }
}

impl Draws {
    /// Draws of these fields of a scene, of which `grid` may sweep some: as many as `asked`, or 100.
    ///
    /// Method: the inverse of the distribution function at uniform numbers by ChaCha8 with the seed `asked`
    /// or 1: for each draw one for each field in this order, the middle of one of 2^52 intervals by the upper
    /// 52 bits of 64. So the first draws are the same for any number of them.
    ///
    /// Precondition: the scene has these numbers, and at least half of each distribution lies in the
    /// [range](share_in_range) of its field.
    pub fn new(fields: Vec<Variation>, asked: &Uncertain, scene: &Scene, grid: &Grid) -> Self {
        let (count, seed) = (asked.draws.unwrap_or(DRAWS), asked.seed.unwrap_or(SEED));
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut probability = || ((random.next_u64() >> 12) as f64 + 0.5) / (1_u64 << 52) as f64;
        let any = Range { low: f64::NEG_INFINITY, high: f64::INFINITY, whole: false };
        let drawn = |law: Variation| {
            let path = FieldPath::new(&law.field);
            DrawnField {
                range: field_info(&law.field).map_or(any, |field| field.range),
                axis: grid.axes().iter().position(|axis| axis.field == law.field),
                value: path.get(scene).unwrap_or(f64::NAN),
                probabilities: Vec::with_capacity(count as usize),
                law,
                path,
            }
        };
        let mut fields: Vec<DrawnField> = fields.into_iter().map(drawn).collect();
        for _ in 0..count {
            fields.iter_mut().for_each(|field| field.probabilities.push(probability()));
        }
        Self { fields, count, seed }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Number of runs of a cell: one without a draw, and one for each draw.
    pub fn runs(&self) -> u64 {
        1 + self.count
    }

    pub(super) fn change_mechanism(&self) -> bool {
        self.fields.iter().any(|field| is_of_mechanism(&field.law.field))
    }

    /// Sets the uncertain fields of a scene to draw number `draw`, or for 0 to their own values, in a cell
    /// whose axes have the values `cell`.
    pub(super) fn apply(&self, draw: u64, cell: impl Iterator<Item = f64> + Clone, scene: &mut Scene) {
        for field in &self.fields {
            let swept = field.axis.and_then(|axis| cell.clone().nth(axis));
            let mut value = swept.unwrap_or(field.value);
            if let Some(place) = draw.checked_sub(1) {
                value = field.at(field.probabilities[place as usize], value);
            }
            let known = field.path.set(scene, value);
            debug_assert!(known, "draws belong to a scene that has their fields");
        }
    }

    /// The request with all defaults: it gives the same draws for a scene with the values of the fields.
    pub fn with_defaults(&self) -> Uncertain {
        let fields = self.fields.iter().map(|field| format!("{}=+-{}", field.law.field, field.deviation()));
        Uncertain { fields: fields.collect(), draws: Some(self.count), seed: Some(self.seed) }
    }

    /// A description in one line, `95 % of 100 draws of damping.xi=0.023±0.002`; empty if there are none.
    pub fn about(&self) -> String {
        if self.is_empty() {
            return String::new();
        }
        let text = |field: &DrawnField| {
            // a swept field has another value in each cell
            let value = field.axis.is_none().then(|| format!("={}", number_text(field.value)));
            let value = value.unwrap_or_default();
            format!("{}{value}\u{b1}{}", field.law.field, field.deviation())
        };
        let fields: Vec<String> = self.fields.iter().map(text).collect();
        format!("95 % of {} draws of {}", self.count, fields.join(", "))
    }

    /// These columns of a sweep, with those of the band of each behind it, and `draws` at the end.
    pub fn columns(&self, names: &[String]) -> Vec<String> {
        if self.is_empty() {
            return names.to_vec();
        }
        let each = names.iter().flat_map(|name| {
            let more = SummaryField::find(name).map_or(&[][..], endings);
            std::iter::once(name.clone()).chain(more.iter().map(move |ending| format!("{name}{ending}")))
        });
        each.chain([COUNT.to_owned()]).collect()
    }

    /// The rows of the cells themselves among those of all runs.
    pub(super) fn cells(&self, rows: &[Row<Cell>]) -> Vec<Row<Cell>> {
        rows.iter().step_by(self.runs() as usize).cloned().collect()
    }

    /// Adds the columns of the band of `field` to a table with a row for each cell. `word` is how the column
    /// is read if it has words.
    pub(super) fn with_band(
        &self,
        table: Table,
        field: &SummaryField,
        rows: &[Row<Cell>],
        word: impl Fn(&Cell) -> &'static str,
    ) -> Table {
        let cells = rows.chunks(self.runs() as usize);
        let bands = cells.map(|runs| match field.read {
            Read::Number(_) | Read::Count(_) => {
                let mut values: Vec<f64> =
                    ended(&runs[1..]).filter_map(|cell| field.number(cell.summary()?)).collect();
                values.sort_by(f64::total_cmp);
                ENDS.map(|end| quantile(&values, end)).to_vec()
            }
            Read::Word(_) | Read::Flag(_) => {
                let nominal = word(&runs[0].answer);
                let all: Vec<&Cell> = match field.name {
                    // a draw that ends early has another outcome, which counts
                    super::sweep::OUTCOME => runs[1..].iter().map(|row| &row.answer).collect(),
                    _ => ended(&runs[1..]).collect(),
                };
                let same = all.iter().filter(|cell| word(cell) == nominal).count();
                let share = same as f64 / all.len() as f64;
                vec![if nominal.is_empty() { f64::NAN } else { share }]
            }
        });
        let bands: Vec<Vec<f64>> = bands.collect();
        endings(field).iter().enumerate().fold(table, |table, (place, ending)| {
            let values = bands.iter().map(|band| band[place]).collect();
            table.with(format!("{}{ending}", field.name), Values::Numbers(values))
        })
    }

    /// Adds the column of the number of draws that came to their end.
    pub(super) fn with_count(&self, table: Table, rows: &[Row<Cell>]) -> Table {
        let count = |runs: &[Row<Cell>]| Some(ended(&runs[1..]).count() as u64);
        table.with(COUNT, rows.chunks(self.runs() as usize).map(count).collect())
    }
}

/// The endings of the names of the columns of the band of a field.
fn endings(field: &SummaryField) -> &'static [&'static str] {
    match field.read {
        Read::Number(_) | Read::Count(_) => &["_low", "_high"],
        Read::Word(_) | Read::Flag(_) => &["_share"],
    }
}

/// The runs that came to their end.
fn ended(runs: &[Row<Cell>]) -> impl Iterator<Item = &Cell> {
    let cells = runs.iter().map(|row| &row.answer);
    cells.filter(|cell| cell.summary().is_some_and(|summary| summary.outcome.ended_at().is_none()))
}

/// A quantile, in fortieths, of values in ascending order; NaN if there are none.
///
/// Method: the k-th of n values is the quantile k/(n + 1), with straight lines between (Hyndman and Fan 1996,
/// definition 6), so that between two quantiles lies the share of the distribution that they name, on
/// average. Below the first and above the last value it is that value.
fn quantile(values: &[f64], fortieths: usize) -> f64 {
    let [first, .., last] = values else { return values.first().copied().unwrap_or(f64::NAN) };
    // a whole number of values and a rest, so that the quantile of equal values is that value
    let (number, rest) = (fortieths * (values.len() + 1) / 40, fortieths * (values.len() + 1) % 40);
    match number {
        0 => *first,
        _ if number >= values.len() => *last,
        _ => values[number - 1] + (values[number] - values[number - 1]) * rest as f64 / 40.0,
    }
}
