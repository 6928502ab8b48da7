//! `spectrum`: amplitude and power spectral density of a settled motion.

use clap::Args;
use interwell::numeric::Taper;
use interwell::output::{SpectrumQuantity, spectrum_chart};
use interwell::questions::{Signal, Spectrum};

use super::support::{load_simulation, number, outputs, settle_limit};
use super::{ChartOptions, Common, Failure, Output, Picture, interrupt, refuse};

const EXAMPLES: &str = "\
Examples:
  interwell --headless spectrum paper --out lines.csv --plot lines.png
  interwell --headless spectrum duffing-chaos --of v --plot chaos.png --quantity psd --plot-x 0:1
  interwell --headless spectrum paper-unconstrained --set excitation.amplitude_g=1.2 --until-settled 300
  interwell --headless spectrum random-shaking --of accel --taper none --rate-hz 4096

Frequencies above half the rate are folded back below it; impacts excite all frequencies, so compare with a
higher --rate-hz.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene file or built-in scene
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// Signal: displacement x, velocity v, or acceleration of the base
    #[arg(long, value_name = "SIGNAL", default_value = "x", value_parser = ["x", "v", "accel"])]
    pub of: String,

    /// Weights of the samples: hann, none, or auto, which is none where the motion repeats (then the
    /// samples are whole periods of it, and a periodic motion has exact lines) and hann elsewhere
    #[arg(long, value_name = "TAPER", default_value = "auto", value_parser = ["auto", "hann", "none"])]
    pub taper: String,

    /// Samples a second, increased until a forcing period has a whole number of them [default: 128 or more
    /// in the shortest period of excitation and mechanism]
    #[arg(long, value_name = "HZ", allow_hyphen_values = true)]
    pub rate_hz: Option<String>,

    /// Follow the motion, window after window, until it repeats, or up to this time in s; the spectrum is of
    /// the last window. Needs a drive that repeats
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    pub until_settled: Option<String>,

    /// With --plot: the column that is shown
    #[arg(long, value_name = "COLUMN", requires = "plot", default_value = "amplitude",
          value_parser = ["amplitude", "psd"])]
    pub quantity: String,

    #[command(flatten)]
    pub chart: ChartOptions,
}

pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let picture = Picture::of_chart(&options.chart, common)?;
    if let Some((low, high)) = picture.and_then(|picture| picture.ranges.y).filter(|(low, _)| !(*low > 0.0)) {
        refuse!(
            "--plot-y {low}:{high}: the axis is logarithmic; give two numbers above 0, such as 1e-9:1e-2"
        );
    }
    let remedy = "give a number of samples a second above 0, such as 2048";
    let is_positive = |rate: &f64| *rate > 0.0 && rate.is_finite();
    let rate_hz = |text| number("--rate-hz", text, is_positive, remedy);
    let question = Spectrum {
        of: Signal::named(&options.of).unwrap_or(Signal::Displacement),
        taper: match options.taper.as_str() {
            "hann" => Some(Taper::Hann),
            "none" => Some(Taper::None),
            _ => None,
        },
        rate_hz: options.rate_hz.as_deref().map(rate_hz).transpose()?,
        until_settled: settle_limit(options.until_settled.as_deref())?,
    };
    let simulation = load_simulation(&options.scene, common)?;
    let document = simulation.document();
    let mut outputs = outputs(&options.scene, document, common)?.with_picture(picture)?;
    let found = question.run(&simulation, &interrupt::progress())?;
    outputs.table(Output::DATA, found.table())?;
    let quantity = SpectrumQuantity::named(&options.quantity).unwrap_or(SpectrumQuantity::Amplitude);
    outputs.draw(picture, document, |ranges| Ok(spectrum_chart(&found, quantity, ranges)))?;
    outputs.finish_rows(document, 1)?;
    common.say(&format!("{}: {}", document.name, found.describe()));
    Ok(())
}
