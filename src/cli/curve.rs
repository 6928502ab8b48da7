//! `curve`: force, potential and stiffness of the mechanism.

use interwell::output::{curve_figure, landscape};
use interwell::study::{curve, default_positions, even_positions, metres, stop_positions};

use super::failure::Failure;
use super::options::CurveOptions;
use super::picture::{Picture, caption};
use super::support::{finish, inputs, load_with_mechanism, numbers, open, write_table, write_text};

const POINTS: u32 = 401;

/// Points of the picture: more than it has columns.
const PICTURE_POINTS: usize = 3001;

/// Writes the curve as CSV and, where asked for, the landscape as JSON.
pub fn run(options: &CurveOptions) -> Result<(), Failure> {
    let common = &options.common;
    let picture = Picture::asked(&options.plot)?;
    let (document, mechanism) = load_with_mechanism(&options.scene, common)?;
    let points = options.points.unwrap_or(POINTS) as usize;
    let range = options.range_mm.as_deref().map(range).transpose()?;
    let even = |points: usize| match range {
        Some(range) => even_positions(range, points).into_iter().map(metres).collect(),
        None => default_positions(&document.scene, &mechanism, points),
    };
    let positions = match &options.at_mm {
        Some(text) => numbers("--at-mm", text, ',')?.into_iter().map(metres).collect(),
        None => even(points),
    };
    let table = curve(&mechanism, positions)?;
    let landscape_path = options.landscape.as_deref().map(|path| ("--landscape", path));
    let mut sinks = open(
        &inputs(&options.scene, &document),
        [Some(("--out", &common.out)), landscape_path, picture.map(|own| own.output())],
    )?;
    write_table(&mut sinks[0], &table)?;
    write_text(&mut sinks[1], &landscape(&mechanism, document.scene.mass_g / 1e3))?;
    if let Some(picture) = picture {
        // The picture shows the curve however few positions were asked for.
        let table = curve(&mechanism, even(PICTURE_POINTS))?;
        let stops = stop_positions(&document.scene);
        let figure = curve_figure(&table, &mechanism, stops, &caption(&document), picture.theme);
        picture.write(&mut sinks[2], &figure)?;
    }
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
