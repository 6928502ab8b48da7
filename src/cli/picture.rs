//! Options of pictures: place, kind and size, checked before any work is done.

use std::path::Path;

use interwell::output::{Caption, Figure, Format, Ranges, Sink, Theme};
use interwell::scene::Document;

use super::failure::Failure;
use super::options::{PlotOptions, RangeOptions};
use super::support::numbers;

/// A picture that was asked for.
#[derive(Debug, Clone, Copy)]
pub struct Picture<'a> {
    /// Where it goes.
    pub path: &'a Path,
    /// Light or dark.
    pub theme: &'static Theme,
    option: &'static str,
    format: Format,
    size: Option<(u32, u32)>,
    titled: bool,
}

impl<'a> Picture<'a> {
    /// The picture that `options` ask for; an error where its name does not end like one.
    pub fn asked(options: &'a PlotOptions) -> Result<Option<Self>, Failure> {
        Self::of("--plot", options.plot.as_deref(), options)
    }

    /// The picture at `path`, which `option` gave; light or dark as `options` say.
    pub fn of(
        option: &'static str,
        path: Option<&'a Path>,
        options: &PlotOptions,
    ) -> Result<Option<Self>, Failure> {
        let Some(path) = path else { return Ok(None) };
        let format = Format::of(path)
            .map_err(|problem| Failure::argument(format!("{option} {}: {problem}", path.display())))?;
        let size = options.plot_size.as_deref().map(size).transpose()?;
        Ok(Some(Self {
            path,
            theme: Theme::of(options.dark),
            option,
            format,
            size,
            titled: !options.no_title,
        }))
    }

    /// What an output is opened by.
    pub fn output(&self) -> (&'static str, &'a Path) {
        (self.option, self.path)
    }

    /// Writes the picture.
    pub fn write(&self, sink: &mut Option<Sink>, figure: Figure) -> Result<(), Failure> {
        let Some(sink) = sink else { return Ok(()) };
        let figure = if self.titled { figure } else { figure.without_title() };
        let bytes = self
            .format
            .bytes(&Figure { size: self.size, ..figure })
            .map_err(|error| Failure::Failed(error.into()))?;
        sink.put_bytes(&bytes).map_err(|error| Failure::writing(sink.name(), error))
    }
}

/// What stands over and under a picture of this scene.
pub fn caption(document: &Document) -> Caption {
    Caption::new(document, env!("CARGO_PKG_VERSION"))
}

/// The ranges of the axes that `options` ask for; errors call the one to the right `across`.
pub fn ranges(options: &RangeOptions, across: &'static str) -> Result<Ranges, Failure> {
    let of = |option, text: &Option<String>| text.as_deref().map(|text| range(option, text)).transpose();
    Ok(Ranges { x: of(across, &options.plot_x)?, y: of("--plot-y", &options.plot_y)? })
}

/// A range `A:B` as given to `option`.
fn range(option: &str, text: &str) -> Result<(f64, f64), Failure> {
    match numbers(option, text, ':')?[..] {
        [from, to] if from < to && from.is_finite() && to.is_finite() => Ok((from, to)),
        _ => Err(Failure::argument(format!("{option} {text}: write A:B with A below B, such as 0:2"))),
    }
}

/// A size `WxH` in pixels.
fn size(text: &str) -> Result<(u32, u32), Failure> {
    let side = |text: &str| text.trim().parse::<u32>().ok().filter(|own| (200..=4000).contains(own));
    let sides = text.split_once(['x', 'X']).and_then(|(width, height)| side(width).zip(side(height)));
    sides.ok_or_else(|| {
        let message = "write WxH in pixels, 200 to 4000 each, such as 2400x1500";
        Failure::argument(format!("--plot-size {text}: {message}"))
    })
}
