//! Options of pictures: path, format and size, checked before any work is done.

use std::path::Path;

use interwell::output::{
    Caption, Chart, Format, MAX_PICTURE_CELLS, MAX_SURFACE_CELLS, NoPicture, Ranges, Sheet, SheetError,
    SheetText, Theme, picture_arguments,
};
use interwell::scene::Document;

use super::support::{arguments, range};
use super::{ChartOptions, Common, Failure, Output, Outputs, PlotOptions, given, refuse, say};

/// A requested picture.
#[derive(Debug, Clone, Copy)]
pub struct Picture<'a> {
    /// Where it goes.
    pub output: Output,
    pub path: &'a Path,
    /// Where its numbers go.
    pub data: Option<&'a Path>,
    /// Sheet of paper, and light or dark colours.
    pub theme: Theme,
    /// The ranges of its axes.
    pub ranges: Ranges,
    format: Format,
    size: Option<(u32, u32)>,
    titled: bool,
    quiet: bool,
}

impl<'a> Picture<'a> {
    /// The picture that `options` ask for; an error if its name does not end like one.
    pub fn new(options: &'a PlotOptions, common: &Common) -> Result<Option<Self>, Failure> {
        Self::of(Output::PLOT, options.plot.as_deref(), options, common)
    }

    /// Like [`new`](Self::new), with the ranges of its axes.
    pub fn of_chart(options: &'a ChartOptions, common: &Common) -> Result<Option<Self>, Failure> {
        let picture = Self::new(&options.plot, common)?;
        let of = |option, text: &Option<String>| {
            let form = "A:B with A below B, such as 0:2";
            text.as_deref().map(|text| range(option, text, form)).transpose()
        };
        let ranges = Ranges { x: of(range_option(), &options.plot_x)?, y: of("--plot-y", &options.plot_y)? };
        Ok(picture.map(|picture| Self { ranges, ..picture }))
    }

    /// The picture at the `path` of an output, laid out as `options` say.
    pub fn of(
        output: Output,
        path: Option<&'a Path>,
        options: &'a PlotOptions,
        common: &Common,
    ) -> Result<Option<Self>, Failure> {
        let (Some(path), option) = (path, output.option()) else { return Ok(None) };
        let format = Format::of(path)
            .map_err(|problem| Failure::argument(format!("{option} {}: {problem}", path.display())))?;
        if let Some(dpi) = options.dpi.as_deref().filter(|_| format != Format::Png) {
            let name = path.display();
            refuse!("--dpi {dpi}: {option} {name} has no pixels; name a .png, or leave it out");
        }
        Ok(Some(Self {
            output,
            path,
            data: options.plot_data.as_deref(),
            theme: Theme::of(options.dark, sheet(options, format)?),
            ranges: Ranges::default(),
            format,
            size: options.plot_size.as_deref().map(size).transpose()?,
            titled: !options.no_title,
            quiet: common.quiet,
        }))
    }

    /// Writes the picture, and its numbers if they are requested.
    pub fn write(&self, outputs: &mut Outputs, chart: &Chart, caption: &Caption) -> Result<(), Failure> {
        let figure = chart.figure(caption, &self.theme);
        let mut figure = if self.titled { figure } else { figure.without_title() };
        figure.size = self.size;
        let (command, given) = given::arguments();
        figure.origin.insert("arguments".into(), picture_arguments(&command, given).into());
        if let Some(words) = figure.grown().filter(|_| !self.quiet) {
            say(&format!("warning: --plot-height-mm: {words}"));
        }
        if self.data.is_some() {
            outputs.table(Output::PLOT_DATA, &figure.data)?;
        }
        let bytes = self.format.bytes(&figure).map_err(|error| Failure::Failed(error.into()))?;
        outputs.write(self.output, &bytes)
    }
}

impl Outputs {
    /// Opens the outputs of a picture and of its numbers, if they are requested.
    pub fn with_picture(self, picture: Option<Picture>) -> Result<Self, Failure> {
        let Some(picture) = picture else { return Ok(self) };
        self.with(picture.output, Some(picture.path))?.with(Output::PLOT_DATA, picture.data)
    }

    /// Draws a picture of this scene, where it is requested: the chart over the ranges of its axes.
    pub fn draw(
        &mut self,
        picture: Option<Picture>,
        document: &Document,
        chart: impl FnOnce(Ranges) -> Result<Chart, Failure>,
    ) -> Result<(), Failure> {
        let Some(picture) = picture else { return Ok(()) };
        picture.write(self, &chart(picture.ranges)?, &caption(document))
    }
}

/// The option that gives the range of the horizontal axis, by the name with which it was given.
pub fn range_option() -> &'static str {
    let is_time = |argument: &String| argument.split('=').next() == Some("--plot-time");
    if arguments().iter().any(is_time) { "--plot-time" } else { "--plot-x" }
}

fn sheet(options: &PlotOptions, format: Format) -> Result<Option<Sheet>, Failure> {
    let Some(width_mm) = &options.plot_width_mm else { return Ok(None) };
    let PlotOptions { plot_height_mm, font_pt, dpi, no_title, .. } = options;
    let (height_mm, dpi, titled) = (plot_height_mm.as_deref(), dpi.as_deref(), !no_title);
    let text = SheetText { width_mm, height_mm, font_pt, dpi, titled };
    Sheet::read(&text, format == Format::Png).map(Some).map_err(|SheetError { argument, value, problem }| {
        let option = match argument {
            "width_mm" => "plot-width-mm",
            "height_mm" => "plot-height-mm",
            "font_pt" => "font-pt",
            other => other,
        };
        Failure::argument(format!("--{option} {value}: {problem}"))
    })
}

impl From<NoPicture> for Failure {
    fn from(error: NoPicture) -> Self {
        Self::argument(match error {
            NoPicture::Fields(count) => format!(
                "--plot shows a sweep over one field (a line) or two (a map), not over {count}: take the \
                 others out, or sweep without --plot"
            ),
            NoPicture::SingleThreshold => "--plot shows thresholds over another field (a line) or two (a \
                                           map), and there is one threshold: add --over \
                                           FIELD=FROM:TO:STEP, or leave --plot out"
                .to_owned(),
            NoPicture::SingleMotion => {
                "--plot shows a branch; add --branch FIELD=A:B, or leave it out".to_owned()
            }
            NoPicture::OneField(what, count) => format!(
                "--plot shows {what} over one field, not over {count}: name it with --over \
                 FIELD=FROM:TO:STEP"
            ),
            NoPicture::Cells(count) => format!(
                "--plot shows at most {MAX_PICTURE_CELLS} cells, not {count}: take longer steps, or sweep \
                 without --plot"
            ),
            NoPicture::Starts(count) => format!(
                "--plot shows at most {MAX_PICTURE_CELLS} starts, not {count}: take fewer, or leave --plot \
                 out"
            ),
            NoPicture::NoMap => "--surface and --cut show a sweep over two fields, each of two values or \
                                 more, without --carry: give two --over"
                .to_owned(),
            NoPicture::NoSuchCut(column, columns) => {
                format!("--cut {column}: the map is over {columns}; cut it at a value of one of them")
            }
            NoPicture::FlatWords(quantity) => format!(
                "--surface shows heights, and --quantity {quantity} has words: name a column of numbers"
            ),
            NoPicture::SurfaceCells(count) => format!(
                "--surface shows at most {MAX_SURFACE_CELLS} cells, not {count}: take longer steps, or \
                 leave it out"
            ),
            NoPicture::Quantity { name, problem } => format!("--quantity {name}: {problem}"),
            NoPicture::NoSuchColumn(_) => error.to_string(),
        })
    }
}

/// The caption of a picture of this scene.
pub fn caption(document: &Document) -> Caption {
    Caption::new(document, env!("CARGO_PKG_VERSION"))
}

fn size(text: &str) -> Result<(u32, u32), Failure> {
    let side = |text: &str| text.trim().parse::<u32>().ok().filter(|pixels| (200..=4000).contains(pixels));
    let sides = text.split_once(['x', 'X']).and_then(|(width, height)| side(width).zip(side(height)));
    sides.ok_or_else(|| {
        let message = "write WxH in pixels, 200 to 4000 each, such as 2400x1500";
        Failure::argument(format!("--plot-size {text}: {message}"))
    })
}
