//! `curve`: force, potential and stiffness of the mechanism.

use interwell::output::landscape;
use interwell::study::{curve, default_positions, even_positions, metres};

use super::failure::Failure;
use super::options::CurveOptions;
use super::support::{finish, load_with_mechanism, numbers, open, write_table, write_text};

const POINTS: u32 = 401;

/// Writes the curve as CSV and, where asked for, the landscape as JSON.
pub fn run(options: &CurveOptions) -> Result<(), Failure> {
    let common = &options.common;
    let (document, mechanism) = load_with_mechanism(&options.scene, common)?;
    let points = options.points.unwrap_or(POINTS) as usize;
    let positions = match (&options.at_mm, &options.range_mm) {
        (Some(text), _) => numbers("--at-mm", text, ',')?.into_iter().map(metres).collect(),
        (None, Some(text)) => {
            let range = range(text)?;
            even_positions(range, points).into_iter().map(metres).collect()
        }
        (None, None) => default_positions(&document.scene, &mechanism, points),
    };
    let table = curve(&mechanism, positions)?;
    let landscape_path = options.landscape.as_deref().map(|path| ("--landscape", path));
    let mut sinks = open(&[&options.scene], [Some(("--out", &common.out)), landscape_path])?;
    write_table(&mut sinks[0], &table)?;
    write_text(&mut sinks[1], &landscape(&mechanism, document.scene.mass_g * 1e-3))?;
    finish(sinks)
}

fn range(text: &str) -> Result<(f64, f64), Failure> {
    match numbers("--range-mm", text, ':')?[..] {
        [from, to] if from < to && from.is_finite() && to.is_finite() => Ok((from, to)),
        _ => {
            Err(Failure::argument(format!("--range-mm {text}: write A:B in mm with A below B, such as -8:8")))
        }
    }
}
