//! File in which a search for the best design keeps the results of its runs, a row for each.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Mutex;

use super::{BestQuestion, DesignRun, Memory, Results};
use crate::numeric::number_text;
use crate::scene::PROGRAM;
use crate::system::checksum::checksum;
use crate::system::lines::Lines;

/// A run by the bits of its values and the number of its environment.
type Key = (Vec<u64>, usize);

/// The results of runs of one question that an earlier search kept, and the file to which others are added.
#[derive(Debug)]
pub(super) struct Kept {
    lines: Lines,
    /// Checksum of all that decides the results of a run.
    question: String,
    known: HashMap<Key, Results>,
    /// Numbers of the columns of fields, of fields that vary, and of results.
    lengths: (usize, usize, usize),
    /// Why a row could not be written.
    unwritten: Mutex<Option<String>>,
}

fn key(run: DesignRun<'_>) -> Key {
    (run.at.iter().chain(run.varied).map(|value| value.to_bits()).collect(), run.environment)
}

impl Kept {
    /// Opens the file for a question; the error is a clause. Rows of other questions are left as they are.
    pub fn open(path: &Path, question: &BestQuestion) -> Result<Self, String> {
        let BestQuestion { over, maximise, subject_to, environments, vary, until_settled, .. } = question;
        let fields: Vec<&str> = over.iter().map(|range| &*range.field).collect();
        let varied: Vec<&str> = vary.iter().map(|tolerance| &*tolerance.field).collect();
        let results: Vec<&str> = subject_to.iter().map(|constraint| constraint.of.name).collect();
        let decides = format!(
            "{PROGRAM} {} {fields:?} {varied:?} {} {results:?} {environments:?} {until_settled:?}",
            env!("CARGO_PKG_VERSION"),
            maximise.name
        );
        let question = checksum(decides.as_bytes())[..DIGITS].to_owned();
        let (lines, text) = Lines::open(path).map_err(|problem| problem.to_string())?;
        let lengths = (fields.len(), varied.len(), 1 + results.len());
        let rows = text.lines().filter_map(|line| row(line.strip_suffix(&*question)?, lengths));
        let known = rows.collect();
        let kept = Self { known, lengths, lines, question, unwritten: Mutex::default() };
        let varied: Vec<String> = varied.iter().map(|field| format!("varied.{field}")).collect();
        let columns = fields.into_iter().chain(varied.iter().map(String::as_str));
        let columns = columns.chain(["environment", "done", maximise.name]).chain(results);
        let header = columns.chain(["question"]).collect::<Vec<_>>().join(",");
        match text.lines().next() {
            None => kept.write(&header),
            Some(first) if first == header => {}
            Some(_) => return Err("is no file of runs with these columns; name another".to_owned()),
        }
        Ok(kept)
    }

    /// Why a row could not be written, if one could not.
    pub fn unwritten(&self) -> Option<String> {
        self.unwritten.lock().ok().and_then(|problem| problem.clone())
    }

    fn write(&self, line: &str) {
        if let (Err(problem), Ok(mut unwritten)) = (self.lines.append(line), self.unwritten.lock()) {
            unwritten.get_or_insert(problem.to_string());
        }
    }
}

/// Number of digits of the checksum in a row.
const DIGITS: usize = 16;

/// The run and the results of a row without its checksum; `None` if it is not whole.
fn row(line: &str, (fields, varied, results): (usize, usize, usize)) -> Option<(Key, Results)> {
    let cells: Vec<&str> = line.strip_suffix(',')?.split(',').collect();
    let (design, rest) = cells.split_at_checked(fields)?;
    let (varied, rest) = rest.split_at_checked(varied)?;
    let [environment, done, numbers @ ..] = rest else { return None };
    let number = |cell: &&str| cell.parse::<f64>().ok();
    let own = design.iter().map(number).collect::<Option<Vec<f64>>>()?;
    let others = match varied.iter().all(|cell| cell.is_empty()) {
        true => Vec::new(),
        false => varied.iter().map(number).collect::<Option<Vec<f64>>>()?,
    };
    let read = |cell: &&str| if cell.is_empty() { Some(None) } else { cell.parse().ok().map(Some) };
    let numbers = numbers.iter().map(read).collect::<Option<Vec<Option<f64>>>>()?;
    let results = match *done {
        "true" if numbers.len() == results => Some(numbers),
        "false" if numbers.len() == results => None,
        _ => return None,
    };
    let run = DesignRun { at: &own, varied: &others, environment: environment.parse().ok()? };
    Some((key(run), results))
}

impl Memory for Kept {
    fn recall(&self, run: DesignRun<'_>) -> Option<Results> {
        self.known.get(&key(run)).cloned()
    }

    fn keep(&self, run: DesignRun<'_>, results: &Results) {
        let numbers = |values: &[f64]| values.iter().map(|value| number_text(*value)).collect::<Vec<_>>();
        let varied = match run.varied {
            [] => vec![String::new(); self.lengths.1],
            varied => numbers(varied),
        };
        let found = match results {
            Some(found) => found.iter().map(|value| value.map_or_else(String::new, number_text)).collect(),
            None => vec![String::new(); self.lengths.2],
        };
        let own = [run.environment.to_string(), results.is_some().to_string()];
        let cells = [&numbers(run.at)[..], &varied, &own, &found, std::slice::from_ref(&self.question)];
        self.write(&cells.concat().join(","));
    }
}
