//! `curve`: force, potential and stiffness of the mechanism, and the state and shape of its flexures.

use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;
use interwell::dynamics::{Model, STANDARD_GRAVITY};
use interwell::mechanics::Mechanism;
use interwell::numeric::extent;
use interwell::output::{
    Chart, Ranges, contact_chart, curve_chart, landscape, measured_force_chart, mechanism_chart,
    shapes_chart, well_chart,
};
use interwell::questions::{Curve, Error, FlexuresAnswer, Simulation, Table};
use interwell::scene::Document;
use interwell_studies::study::{
    CURVE_PICTURE_POINTS, CURVE_POINTS, ForceComparison, default_positions, even_positions, metres,
    stop_positions,
};

use super::measured::MeasuredForceOptions;
use super::support::{beside, if_given, inputs, load_with_mechanism, number, numbers, range};
use super::{ChartOptions, Common, Failure, Output, Outputs, Picture, caption, interrupt, refuse, whole};

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file or built-in scene
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// From A to B in mm [default: a little beyond equilibria and stops, where the curve reaches as far]
    #[arg(long, value_name = "A:B", allow_hyphen_values = true, conflicts_with = "at_mm")]
    pub range_mm: Option<String>,

    /// Number of positions over the range [default: 401, for --shapes 21]
    #[arg(long, value_name = "N", allow_hyphen_values = true, conflicts_with = "at_mm",
          value_parser = whole::<u32>(2..=10_000_000))]
    pub points: Option<u32>,

    /// At these positions in mm, in this order
    #[arg(long, value_name = "X1,X2,..", allow_hyphen_values = true)]
    pub at_mm: Option<String>,

    /// With --mechanism-plot: draw the mechanism of this scene, called A, on its right, with the mass at the
    /// second of the positions that are named, else where its run starts. --set changes the first scene alone
    #[arg(long, value_name = "SCENE", requires = "mechanism_plot")]
    pub beside: Option<String>,

    /// Of flexures: more columns, axial_n (compression of the buckling flexures together), bump_m (height of
    /// their bump) and max_stress_pa (largest bending stress), each row solved afresh; warns where the stress
    /// exceeds mechanism.yield_gpa
    #[arg(long)]
    pub full: bool,

    /// Of flexures: write centre lines as CSV x_m,flexure,s_m,px_m,py_m. In the frame, with a shuttle of no
    /// width: a parallel flexure is clamped at (0, 0) and ends at (its length less the shortening, x); a
    /// buckling one is clamped at (both lengths less the preload, 0) and ends at the same place
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    pub shapes: Option<PathBuf>,

    /// Of flexures: draw their centre lines, at the positions that are named, else at the equilibria; the
    /// name ends in .png, .svg or .pdf
    #[arg(long, value_name = "FILE", allow_hyphen_values = true, group = "picture")]
    pub shapes_plot: Option<PathBuf>,

    /// Draw the mechanism between its stops, with the mass at the first of the positions that are named, else
    /// where a run starts; the name ends in .png, .svg or .pdf
    #[arg(long, value_name = "FILE", allow_hyphen_values = true, group = "picture")]
    pub mechanism_plot: Option<PathBuf>,

    /// With --well-plot: the acceleration of the base in g [default: the largest that the excitation may
    /// have]
    #[arg(long, value_name = "G", allow_hyphen_values = true, requires = "well_plot")]
    pub base_accel_g: Option<String>,

    /// Draw the potential, tipped by the push of an accelerated base, and the mass on it, at the first of the
    /// positions that are named, else where a run starts; the name ends in .png, .svg or .pdf
    #[arg(long, value_name = "FILE", allow_hyphen_values = true, group = "picture")]
    pub well_plot: Option<PathBuf>,

    /// Of a compliant stop: write the effect of one impact over the impact speed as CSV, speed_m_per_s,
    /// restitution, rigid_restitution, contact_time_s, depth_m, peak_force_n, peak_pressure_pa, in closed
    /// form
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    pub contact: Option<PathBuf>,

    /// Draw restitution over impact speed, beside a rigid stop's constant; the name ends in .png, .svg or
    /// .pdf
    #[arg(long, value_name = "FILE", allow_hyphen_values = true, group = "picture")]
    pub contact_plot: Option<PathBuf>,

    /// With --contact and --contact-plot: the restitution of the rigid stop, 0 to 1
    #[arg(long, value_name = "E", allow_hyphen_values = true, default_value = "0.36")]
    pub rigid: String,

    /// Write equilibria, barrier, force extrema and kinks as JSON
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    pub landscape: Option<PathBuf>,

    #[command(flatten)]
    pub measured: MeasuredForceOptions,

    #[command(flatten)]
    pub chart: ChartOptions,
}

/// Default number of positions at which the flexures are drawn; each gives some hundred rows.
const SHAPES: u32 = 21;

/// The pictures that are asked for: of the curve, the shapes, the mechanism, the well and the contact.
fn pictures<'a>(options: &'a Arguments, common: &Common) -> Result<[Option<Picture<'a>>; 5], Failure> {
    let of =
        |output, path: &'a Option<PathBuf>| Picture::of(output, path.as_deref(), &options.chart.plot, common);
    let mut all = [
        Picture::of_chart(&options.chart, common)?,
        of(Output::SHAPES_PLOT, &options.shapes_plot)?,
        of(Output::MECHANISM_PLOT, &options.mechanism_plot)?,
        of(Output::WELL_PLOT, &options.well_plot)?,
        of(Output::CONTACT_PLOT, &options.contact_plot)?,
    ];
    // --plot-data holds the numbers of the first of them
    all.iter_mut().flatten().skip(1).for_each(|picture| picture.data = None);
    Ok(all)
}

/// The curve of a mechanism at the positions that the options name.
struct Asked<'a> {
    options: &'a Arguments,
    document: Document,
    mechanism: Arc<Mechanism>,
    /// Ends in mm.
    range: Option<(f64, f64)>,
    /// Positions in m.
    listed: Option<Vec<f64>>,
}

impl<'a> Asked<'a> {
    fn new(options: &'a Arguments, common: &Common) -> Result<Self, Failure> {
        let (document, mechanism) = load_with_mechanism(&options.scene, common)?;
        let range = |text| range("--range-mm", text, "A:B in mm with A below B, such as -8:8");
        let range = options.range_mm.as_deref().map(range).transpose()?;
        let listed = options.at_mm.as_deref().map(|text| numbers("--at-mm", text, ',')).transpose()?;
        let listed: Option<Vec<f64>> = listed.map(|mm| mm.into_iter().map(metres).collect());
        if let (Some([_, _, _, ..]), Some(text), Some(other)) =
            (listed.as_deref(), &options.at_mm, &options.beside)
        {
            refuse!(
                "--at-mm {text}: with --beside {other} two masses are drawn, at two positions: give two, or \
                 leave --beside out"
            );
        }
        Ok(Self { options, document, mechanism, range, listed })
    }

    /// So many positions over the range.
    fn even(&self, points: usize) -> Vec<f64> {
        match self.range {
            Some(range) => even_positions(range, points).into_iter().map(metres).collect(),
            None => default_positions(&self.document.scene, &self.mechanism, points),
        }
    }

    /// The positions, by default so many.
    fn positions(&self, points: u32) -> Vec<f64> {
        let even = || self.even(self.options.points.unwrap_or(points) as usize);
        self.listed.clone().unwrap_or_else(even)
    }

    /// The position that is named at this place.
    fn named(&self, place: usize) -> Option<f64> {
        self.listed.as_ref()?.get(place).copied()
    }

    /// An error about positions, with the option that gave them.
    fn failure(&self, error: Error) -> Failure {
        let given = self.options.at_mm.as_ref().map(|text| ("--at-mm", text));
        let given = given.or(self.options.range_mm.as_ref().map(|text| ("--range-mm", text)));
        match (error, given) {
            (error @ Error::Argument { .. }, Some((option, text))) => {
                Failure::argument(format!("{option} {text}: {}", error.problem()))
            }
            (error, _) => error.into(),
        }
    }

    fn curve(&self, positions: Vec<f64>) -> Result<Table, Failure> {
        let curve = Curve { positions: Some(positions) };
        curve.of_mechanism(&self.document, &self.mechanism).map_err(|error| self.failure(error))
    }

    /// The flexures there; an error if the mechanism has none names the `option` that asks for them.
    fn flexures(&self, positions: Vec<f64>, option: &str) -> Result<FlexuresAnswer, Failure> {
        let curve = Curve { positions: Some(positions) };
        let found = curve.flexures_of(&self.document, &self.mechanism, &interrupt::progress());
        found.map_err(|error| match error {
            Error::Unfit { .. } => Failure::argument(format!("{option}: {}", error.message())),
            error => self.failure(error),
        })
    }

    /// A mechanism without flexures is refused where an option needs some.
    fn check_flexures(&self) -> Result<(), Failure> {
        let needed = [
            self.options.full.then_some("--full"),
            self.options.shapes.is_some().then_some("--shapes"),
            self.options.shapes_plot.is_some().then_some("--shapes-plot"),
        ];
        needed.into_iter().flatten().try_for_each(|option| self.flexures(Vec::new(), option).map(drop))
    }

    /// The chart of the curve, which is whole even if few positions were requested, or of a measured one.
    fn chart(&self, measured: Option<&ForceComparison>, ranges: Ranges) -> Result<Chart, Failure> {
        let Some(found) = measured else {
            let table = self.curve(self.even(CURVE_PICTURE_POINTS))?;
            return Ok(curve_chart(&table, &self.mechanism, stop_positions(&self.document.scene), ranges));
        };
        let range = extent(found.positions.iter().copied());
        let table = Curve::drawn(Some(range), &self.document, &self.mechanism);
        Ok(measured_force_chart(found, &table.map_err(|error| self.failure(error))?, ranges))
    }

    fn shapes_chart(&self) -> Result<Chart, Failure> {
        let is_named = self.listed.is_some() || self.options.points.is_some() || self.range.is_some();
        let equilibria = self.mechanism.landscape.equilibria.iter().map(|equilibrium| equilibrium.x);
        let at = if is_named { self.positions(SHAPES) } else { equilibria.collect() };
        let states = self.flexures(at, "--shapes-plot")?.states;
        Ok(shapes_chart(&states, &self.mechanism, stop_positions(&self.document.scene)))
    }

    /// The chart of the mechanism, and of that of the other model beside it.
    fn mechanism_chart(&self, model: &Model, other: Option<&Model>) -> Result<Chart, Failure> {
        let models = std::iter::once(model).chain(other).enumerate();
        let at: Vec<(&Model, f64)> =
            models.map(|(place, model)| (model, self.named(place).unwrap_or(model.start().0))).collect();
        let name = &self.document.name;
        mechanism_chart(&at)
            .map_err(|problem| Failure::argument(format!("--mechanism-plot: {name}: {problem}")))
    }

    /// The chart of the well while the base has this acceleration in g, by default its bound.
    fn well_chart(&self, model: &Model, accel_g: Option<f64>) -> Chart {
        let accel =
            accel_g.map_or_else(|| model.extreme_base_acceleration(), |accel| accel * STANDARD_GRAVITY);
        let ends = self.even(2);
        well_chart(model, self.named(0).unwrap_or(model.start().0), accel, (ends[0], ends[1]))
    }
}

/// Writes the curve as CSV and, if requested, the landscape as JSON and the shapes of the flexures as CSV.
pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let pictures = pictures(options, common)?;
    let [of_curve, of_shapes, of_mechanism, of_well, of_contact] = pictures;
    let remedy = "give a coefficient of restitution, 0 to 1, such as 0.36";
    let rigid = number("--rigid", &options.rigid, |value: &f64| (0.0..=1.0).contains(value), remedy)?;
    let remedy = "give an acceleration in g, such as 0.8 or -0.8";
    let accel_g = if_given("--base-accel-g", options.base_accel_g.as_deref(), remedy)?;
    let asked = Asked::new(options, common)?;
    let (document, table) = (&asked.document, asked.curve(asked.positions(CURVE_POINTS))?);
    // before files are opened
    asked.check_flexures()?;
    let contact_output = options.contact.as_ref().map(|_| Output::CONTACT);
    let contact_output = contact_output.or(of_contact.map(|picture| picture.output));
    let needs_model = contact_output.is_some() || of_mechanism.is_some() || of_well.is_some();
    let simulation = needs_model.then(|| Simulation::new(document)).transpose()?;
    let impact = |(simulation, output): (&Simulation, Output)| {
        let wrong = |error: Error| Failure::argument(format!("{}: {}", output.option(), error.message()));
        simulation.impact(rigid).map_err(wrong)
    };
    let impacts = simulation.as_ref().zip(contact_output).map(impact).transpose()?;
    let mut read = inputs(&options.scene, document);
    read.extend(options.measured.measured.clone());
    let other = options.beside.as_deref().map(beside).transpose()?;
    read.extend(options.beside.iter().zip(&other).flat_map(|(spec, other)| inputs(spec, other.document())));
    let outputs = Outputs::new(&read)
        .with_rows(Some(common.out()))?
        .with(Output::LANDSCAPE, options.landscape.as_deref())?
        .with(Output::SHAPES, options.shapes.as_deref())?
        .with(Output::CONTACT, options.contact.as_deref())?;
    let outputs = pictures.into_iter().try_fold(outputs, Outputs::with_picture)?;
    let mut outputs = outputs.with(Output::COMPARISON, options.measured.comparison.as_deref())?;
    let measured = options.measured.compare(document, &asked.mechanism, common)?;
    if let Some(found) = &measured {
        outputs.table(Output::COMPARISON, &found.table)?;
    }
    if options.full {
        let found = asked.flexures(asked.positions(CURVE_POINTS), "--full")?;
        let warning = found.warning();
        warning.iter().for_each(|words| common.say(&format!("warning: {}: {words}", document.name)));
        outputs.table(Output::DATA, &found.table())?;
    } else {
        outputs.table(Output::DATA, &table)?;
    }
    outputs.write(Output::LANDSCAPE, landscape(&asked.mechanism, document.scene.mass_g / 1e3))?;
    outputs.draw(of_curve, document, |ranges| asked.chart(measured.as_ref(), ranges))?;
    if outputs.has(Output::SHAPES) {
        outputs.table(Output::SHAPES, &asked.flexures(asked.positions(SHAPES), "--shapes")?.shapes())?;
    }
    outputs.draw(of_shapes, document, |_| asked.shapes_chart())?;
    let Some(model) = simulation.as_ref().map(Simulation::model) else {
        return outputs.finish_rows(document, 1);
    };
    if let Some(picture) = of_mechanism {
        let chart = asked.mechanism_chart(model, other.as_ref().map(Simulation::model))?;
        let caption = caption(document).with_others(other.iter().map(Simulation::document));
        picture.write(&mut outputs, &chart, &caption)?;
    }
    outputs.draw(of_well, document, |_| Ok(asked.well_chart(model, accel_g)))?;
    if let Some(table) = &impacts {
        outputs.table(Output::CONTACT, table)?;
        if let Some(stop) = model.compliant() {
            outputs.draw(of_contact, document, |_| Ok(contact_chart(table, &stop, model.mass())))?;
        }
    }
    outputs.finish_rows(document, 1)
}
