//! What the commands that draw share: the picture's place and kind, checked before any work is done.

use std::path::Path;

use interwell::output::{Caption, Figure, Format, Sink, Theme};
use interwell::scene::Document;

use super::failure::Failure;
use super::options::PlotOptions;

/// A picture that was asked for.
#[derive(Debug, Clone, Copy)]
pub struct Picture<'a> {
    /// Where it goes.
    pub path: &'a Path,
    /// Light or dark.
    pub theme: &'static Theme,
    option: &'static str,
    format: Format,
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
        Ok(Some(Self { path, theme: Theme::of(options.dark), option, format }))
    }

    /// What an output is opened by.
    pub fn output(&self) -> (&'static str, &'a Path) {
        (self.option, self.path)
    }

    /// Writes the picture.
    pub fn write(&self, sink: &mut Option<Sink>, figure: &Figure) -> Result<(), Failure> {
        let Some(sink) = sink else { return Ok(()) };
        let bytes = self.format.bytes(figure).map_err(|error| Failure::Failed(error.into()))?;
        sink.put_bytes(&bytes).map_err(|error| Failure::writing(sink.name(), error))
    }
}

/// What stands over and under a picture of this scene.
pub fn caption(document: &Document) -> Caption {
    Caption::new(&document.scene, &document.name, env!("CARGO_PKG_VERSION"))
}
