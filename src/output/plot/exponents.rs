//! Picture of Lyapunov exponents over a field: both of them, each with its standard error as a band.

use super::axis::{PlotAxis, Ranges};
use super::drawn::Drawn;
use super::figure::{Figure, Point};
use super::frame::Frame;
use super::mark::{Caption, Sample};
use super::style::{self, Ink, Theme};
use super::sweep::{MAX_PICTURE_CELLS, NoPicture};
use super::swept::{LEAST, LEFT, below_legend, swept_axis};
use crate::numeric::short;
use crate::scene::{Excitation, Scene};
use crate::study::{Grid, Table};

/// What the picture is drawn from.
#[derive(Debug, Clone, Copy)]
pub struct ExponentPicture<'a> {
    /// All rows.
    pub rows: &'a Table,
    /// Of which grid, of one field.
    pub grid: &'a Grid,
    /// Over which scene.
    pub scene: &'a Scene,
    /// The axes.
    pub ranges: Ranges,
}

/// Whether exponents over this grid can be shown.
pub fn can_show_exponents(grid: &Grid) -> Result<(), NoPicture> {
    match grid.axes().len() {
        1 if grid.cells() > MAX_PICTURE_CELLS => Err(NoPicture::Cells(grid.cells())),
        1 => Ok(()),
        n => Err(NoPicture::Exponents(n)),
    }
}

/// Both exponents over the field of the grid.
pub fn exponents_figure(
    picture: &ExponentPicture,
    caption: &Caption,
    theme: &Theme,
) -> Result<Figure, NoPicture> {
    can_show_exponents(picture.grid)?;
    let ExponentPicture { rows, grid, ranges, .. } = *picture;
    let mut figure = Figure::new(theme, caption, LEAST);
    let x = &grid.columns()[0];
    let numbers = |name: &str| rows.numbers(name).unwrap_or_default();
    let places = numbers(x);
    let lines = [
        Line { name: "first exponent", of: "exponent_1", ink: theme.regimes[3], dash: None },
        Line { name: "second exponent", of: "exponent_2", ink: theme.regimes[1], dash: Some(style::DASH) },
    ];
    let both = numbers("exponent_1_per_s").iter().chain(numbers("exponent_2_per_s"));
    let across = swept_axis(rows, x, ranges.x);
    let y_label = "Lyapunov exponent, 1/s";
    let up = PlotAxis::around(both.copied().chain([0.0]), 0.06, 6, y_label).or_given(ranges.y, 6, y_label);

    let first = numbers("exponent_1_per_s");
    let mut entries: Vec<(Sample, &str)> = Vec::new();
    if first.iter().any(|value| value.is_finite()) {
        entries.extend(lines.iter().map(|line| (Sample::Line(line.ink, style::LINE, line.dash), line.name)));
        entries.push((Sample::Patch(lines[0].band(theme), None), "standard error"));
    }
    let resting = first.contains(&f64::NEG_INFINITY);
    if resting {
        entries.push((Sample::Ticks(theme.ink), "both \u{2212}\u{221e} (rests on a stop)"));
    }
    if first.iter().any(|value| value.is_nan()) {
        entries.push((Sample::Ticks(theme.soft), "no value"));
    }
    let top = below_legend(&mut figure, theme, &entries);
    let frame = Frame::whole(&figure, (LEFT, top), across, up);
    let bottom = frame.area.bottom;
    frame.grid(&mut figure, theme);
    frame.horizontal(&mut figure, 0.0, style::THIN, theme.ink, None);
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_by(|a, b| places[*a].total_cmp(&places[*b]));
    for line in &lines {
        line.draw(&mut figure, &frame, rows, places, &order, theme);
    }
    for (place, value) in places.iter().zip(first).filter(|(_, value)| !value.is_finite()) {
        let ink = if value.is_nan() { theme.soft } else { theme.ink };
        let at = frame.across(*place);
        figure.line(&[(at, bottom - TICK), (at, bottom)], style::FINE_LINE, ink, frame.area);
    }
    frame.axes(&mut figure, theme);
    let names = ["exponent_1_per_s", "exponent_1_se", "exponent_2_per_s", "exponent_2_se"];
    let columns = names.map(numbers);
    let mut drawn = Drawn::new([x.as_str()].into_iter().chain(names), &[]);
    for (row, at) in places.iter().enumerate().filter(|place| (frame.x.low..=frame.x.high).contains(place.1))
    {
        let [a, b, c, d] = columns.map(|column| column[row]);
        drawn.put("exponents", &[*at, a, b, c, d], &[]);
    }
    figure.data = drawn.table();
    caption.draw(&mut figure, theme, &about(picture), LEFT);
    Ok(figure)
}

/// Length of the tick of a value without exponents.
const TICK: f64 = 18.0;

/// What is shown, in one line.
fn about(picture: &ExponentPicture) -> String {
    let swept = picture.grid.axes().iter().map(|axis| axis.values.len()).sum::<usize>();
    let shaken = match picture.scene.excitation {
        Excitation::Sine { frequency_hz, .. }
            if !picture.grid.axes().iter().any(|axis| axis.field == "excitation.frequency_hz") =>
        {
            format!(", shaken at {} Hz", short(frequency_hz))
        }
        _ => String::new(),
    };
    format!("rates at which small changes of the settled motion grow, {swept} motions{shaken}")
}

struct Line {
    name: &'static str,
    of: &'static str,
    ink: Ink,
    dash: Option<(f64, f64)>,
}

impl Line {
    /// The colour of its standard error.
    fn band(&self, theme: &Theme) -> Ink {
        self.ink.over(theme.paper, 0.3)
    }

    /// Draws it through the rows in this order, over its band; a row without a value parts it.
    fn draw(
        &self,
        figure: &mut Figure,
        frame: &Frame,
        rows: &Table,
        places: &[f64],
        order: &[usize],
        theme: &Theme,
    ) {
        let values = rows.numbers(&format!("{}_per_s", self.of)).unwrap_or_default();
        let errors = rows.numbers(&format!("{}_se", self.of)).unwrap_or_default();
        for part in order.split(|row| !values[*row].is_finite()) {
            let at = |row: &usize, sign: f64| {
                let error = if errors[*row].is_finite() { errors[*row] } else { 0.0 };
                (places[*row], values[*row] + sign * error)
            };
            for pair in part.windows(2) {
                let corners = [at(&pair[0], 1.0), at(&pair[1], 1.0), at(&pair[1], -1.0), at(&pair[0], -1.0)];
                if corners.iter().all(|corner| frame.area.contains(frame.place(*corner))) {
                    figure.polygon(
                        corners.iter().map(|corner| frame.place(*corner)).collect(),
                        self.band(theme),
                    );
                }
            }
            let line: Vec<Point> = part.iter().map(|row| at(row, 0.0)).collect();
            match (self.dash, line.as_slice()) {
                (_, [(x, y)]) => {
                    let (x, y) = frame.place((*x, *y));
                    figure.line(&[(x - 4.0, y), (x + 4.0, y)], style::LINE, self.ink, frame.area);
                }
                (Some(dash), _) => frame.dashed(figure, &line, style::LINE, self.ink, dash),
                (None, _) => frame.line(figure, &line, style::LINE, self.ink),
            }
        }
    }
}
