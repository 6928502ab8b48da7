//! Uncertain inputs: fields with normal distributions, their draws, and the bands of results.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::cells::OUTCOME;
use crate::numeric::{normal_probability, normal_quantile, number_text};
use crate::questions::Error;
use crate::scene::{
    Axis, Document, FieldPath, Range, Scene, SceneError, Uncertain, field_info, is_whole, read_number,
};
use crate::study::grid::is_of_mechanism;
use crate::study::{Carry, Cell, Grid, MAX_CELLS, Read, Row, SummaryField, Table, Values, named};

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

    pub(crate) fn change_mechanism(&self) -> bool {
        self.fields.iter().any(|field| is_of_mechanism(&field.law.field))
    }

    /// Sets the uncertain fields of a scene to draw number `draw`, or for 0 to their own values, in a cell
    /// whose axes have the values `cell`.
    pub(crate) fn apply(&self, draw: u64, cell: impl Iterator<Item = f64> + Clone, scene: &mut Scene) {
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
                    OUTCOME => runs[1..].iter().map(|row| &row.answer).collect(),
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

const FORM: &str = "write FIELD=VALUE+-SIGMA, FIELD=+-SIGMA or FIELD=+-5%, such as damping.xi=0.023+-0.002";

/// The least share of a normal distribution that must lie in the range of its field: a half, as at an end of
/// the range, up to rounding.
const LEAST_SHARE: f64 = 0.5 - 1e-9;

/// The field of an uncertain input, its value, which may be empty, and its standard deviation.
fn parts(input: &str) -> Result<[&str; 3], Error> {
    let parts = input.split_once('=').and_then(|(field, law)| {
        let (value, sigma) = law.split_once("+-").or_else(|| law.split_once('\u{b1}'))?;
        Some([field, value, sigma].map(str::trim))
    });
    parts.ok_or_else(|| Error::argument("uncertain", input, FORM))
}

/// Gives the fields of a document the values of the uncertain inputs, and says whether there are any. The
/// document is to be checked afterwards.
#[doc(hidden)]
pub fn assign(uncertain: &Uncertain, document: &mut Document) -> Result<bool, Error> {
    let mut assigned = false;
    for input in &uncertain.fields {
        let [field, value, _] = parts(input)?;
        if !value.is_empty() {
            let done = document.assign(field, value, &format!("--uncertain {input}"));
            done.map_err(|error| Error::Scene(SceneError::Argument(error)))?;
            assigned = true;
        }
    }
    Ok(assigned)
}

/// The draws of the uncertain inputs of a sweep of `grid` over a document, whose fields have been
/// [assigned](assign).
pub(super) fn draws(
    uncertain: &Uncertain,
    document: &Document,
    grid: &Grid,
    carry: Option<Carry>,
) -> Result<Draws, Error> {
    let Uncertain { fields, draws, seed } = uncertain;
    if fields.is_empty() {
        let given = draws.map(|draws| ("draws", draws)).or(seed.map(|seed| ("seed", seed)));
        let problem = format!(
            "nothing is uncertain; name a field with {}, such as damping.xi=+-0.002",
            named!("uncertain")
        );
        return given
            .map_or(Ok(Draws::default()), |(name, value)| Err(Error::argument(name, value, problem)));
    }
    let mut laws: Vec<Variation> = Vec::new();
    for input in fields {
        let wrong = |problem: String| Error::argument("uncertain", input, problem);
        let [field, value, sigma] = parts(input)?;
        let law = variation(field, sigma, FORM, document).map_err(wrong)?;
        let axis = grid.axes().iter().find(|axis| axis.field == field);
        if axis.is_some() && !value.is_empty() {
            let problem = "the field is swept: leave VALUE out, and SIGMA is that of each value of the sweep";
            return Err(wrong(problem.to_owned()));
        }
        if laws.iter().any(|known| known.field == field) {
            return Err(wrong("the field is given twice; give it once".to_owned()));
        }
        let of_scene = FieldPath::new(field).get(&document.scene).unwrap_or(f64::NAN);
        let values = axis.map_or_else(|| vec![of_scene], |axis| axis.values.clone());
        if axis.is_none() && law.relative && values[0] == 0.0 {
            let problem = "a percentage of 0 is nothing; give SIGMA in the unit of the field";
            return Err(wrong(problem.to_owned()));
        }
        values.iter().try_for_each(|value| check_share(&law, *value).map_err(wrong))?;
        laws.push(law);
    }
    if carry.is_some() {
        let problem = format!("a walk with {} has no bands; leave one of the two out", named!("carry"));
        return Err(Error::argument("uncertain", &fields[0], problem));
    }
    if let Some(draws) = draws.filter(|draws| !(1..=MAX_DRAWS).contains(draws)) {
        let problem = format!("give a whole number from 1 to {MAX_DRAWS}");
        return Err(Error::argument("draws", draws, problem));
    }
    let made = Draws::new(laws, uncertain, &document.scene, grid);
    match grid.cells().checked_mul(made.runs()) {
        Some(runs) if runs <= MAX_CELLS => Ok(made),
        _ => {
            let (cells, runs) = (grid.cells(), made.runs());
            let problem = format!(
                "{cells} cells of {runs} runs are more than the {MAX_CELLS} runs of one sweep; take longer \
                 steps or fewer draws"
            );
            Err(Error::argument("draws", runs - 1, problem))
        }
    }
}

/// Checks that a normal distribution about a value lies mostly in the range of its field.
fn check_share(law: &Variation, value: f64) -> Result<(), String> {
    if !value.is_finite() {
        return Err(format!(
            "nothing lies about {}; give the field a finite value or leave it out",
            number_text(value)
        ));
    }
    let share = share_in_range(law, value);
    if share >= LEAST_SHARE {
        return Ok(());
    }
    let range = field_info(&law.field).map_or_else(String::new, |field| field.range.to_string());
    Err(format!(
        "about {} only {:.1} % of the distribution lie in {range}, where the field is valid; give a smaller \
         SIGMA",
        number_text(value),
        100.0 * share
    ))
}

/// The variation of `field` by `by`, a number in its unit or a percentage of its value; `form` is how both
/// are written. The error is a clause.
fn variation(field: &str, by: &str, form: &str, document: &Document) -> Result<Variation, String> {
    can_vary(field, document)?;
    let (by, relative) = deviation(by, form)?;
    if by < 0.0 {
        let given = if relative { 100.0 * by } else { by };
        return Err(format!("{} is negative; give 0 or more", number_text(given)));
    }
    Ok(Variation { field: field.to_owned(), by, relative })
}

/// Whether a field can have values a little beside its own; the error is a clause.
pub(crate) fn can_vary(field: &str, document: &Document) -> Result<(), String> {
    if FieldPath::new(field).get(&document.scene).is_none() {
        // the error of `parse` lists the fields
        Axis::parse(&format!("{field}=1"), &document.scene)?;
        return Err(format!("the scene leaves this field out; give it a value with {}", named!("set")));
    }
    if is_whole(&document.scene, field) {
        let problem = "holds whole numbers, which do not come out a little otherwise; vary another field";
        return Err(problem.to_owned());
    }
    Ok(())
}

/// A number in the unit of a field, or the share of its value that a percentage is, and whether it is one.
pub(crate) fn deviation(text: &str, form: &str) -> Result<(f64, bool), String> {
    let text = text.trim();
    let (number, relative) = text.strip_suffix('%').map_or((text, false), |share| (share, true));
    let number = read_number(number).map_err(|_| form)?;
    if !number.is_finite() {
        return Err(format!("{} is not finite; give a finite number", number_text(number)));
    }
    Ok((if relative { number / 100.0 } else { number }, relative))
}
