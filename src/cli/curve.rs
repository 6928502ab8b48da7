//! `curve`: force, potential and stiffness of the mechanism, and the state and shape of its flexures.

use std::path::PathBuf;

use clap::Args;
use interwell::dynamics::{Model, STANDARD_GRAVITY};
use interwell::numeric::extent;
use interwell::output::{
    contact_chart, curve_chart, landscape, measured_force_chart, mechanism_chart, shapes_chart, well_chart,
};
use interwell::questions::{Curve, Error, Simulation};
use interwell_studies::study::{
    CURVE_PICTURE_POINTS, CURVE_POINTS, default_positions, even_positions, metres, stop_positions,
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

    /// With --well-plot: the acceleration of the base in g [default: the largest of the excitation]
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

/// Writes the curve as CSV and, if requested, the landscape as JSON and the shapes of the flexures as CSV.
pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let pictures = pictures(options, common)?;
    let [of_curve, of_shapes, of_mechanism, of_well, of_contact] = pictures;
    let remedy = "give a coefficient of restitution, 0 to 1, such as 0.36";
    let rigid = number("--rigid", &options.rigid, |value: &f64| (0.0..=1.0).contains(value), remedy)?;
    let remedy = "give an acceleration in g, such as 0.8 or -0.8";
    let accel = if_given("--base-accel-g", options.base_accel_g.as_deref(), remedy)?;
    let (document, mechanism) = load_with_mechanism(&options.scene, common)?;
    let range = |text| range("--range-mm", text, "A:B in mm with A below B, such as -8:8");
    let range = options.range_mm.as_deref().map(range).transpose()?;
    let even = |points: usize| match range {
        Some(range) => even_positions(range, points).into_iter().map(metres).collect(),
        None => default_positions(&document.scene, &mechanism, points),
    };
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
    let positions = |points: u32| match &listed {
        Some(listed) => listed.clone(),
        None => even(options.points.unwrap_or(points) as usize),
    };
    let given = options.at_mm.as_ref().map(|text| ("--at-mm", text));
    let given = given.or(options.range_mm.as_ref().map(|text| ("--range-mm", text)));
    let told = |error: Error| match (error, given) {
        (Error::Argument { problem, .. }, Some((option, text))) => {
            Failure::argument(format!("{option} {text}: {problem}"))
        }
        (error, _) => error.into(),
    };
    let curve = |positions: Vec<f64>| {
        Curve { positions: Some(positions) }.of_mechanism(&document, &mechanism).map_err(told)
    };
    let flexures = |positions: Vec<f64>, option: &str| {
        let found = Curve { positions: Some(positions) };
        found.flexures_of(&document, &mechanism, &interrupt::progress()).map_err(|error| match error {
            Error::Unfit { .. } => Failure::argument(format!("{option}: {}", error.message())),
            error => told(error),
        })
    };
    let table = curve(positions(CURVE_POINTS))?;
    let of_flexures = [
        options.full.then_some("--full"),
        options.shapes.is_some().then_some("--shapes"),
        of_shapes.is_some().then_some("--shapes-plot"),
    ];
    // a mechanism without flexures is refused before files are opened
    of_flexures.into_iter().flatten().try_for_each(|option| flexures(Vec::new(), option).map(drop))?;
    let contact_output = options.contact.as_ref().map(|_| Output::CONTACT);
    let contact_output = contact_output.or(of_contact.map(|picture| picture.output));
    let needs_model = contact_output.is_some() || of_mechanism.is_some() || of_well.is_some();
    let simulation = needs_model.then(|| Simulation::new(&document)).transpose()?;
    let impact = |(simulation, output): (&Simulation, Output)| {
        let wrong = |error: Error| Failure::argument(format!("{}: {}", output.option(), error.message()));
        simulation.impact(rigid).map_err(wrong)
    };
    let impacts = simulation.as_ref().zip(contact_output).map(impact).transpose()?;
    let mut read = inputs(&options.scene, &document);
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
    let measured = options.measured.compare(&document, &mechanism, common)?;
    if let Some(found) = &measured {
        outputs.table(Output::COMPARISON, &found.table)?;
    }
    if options.full {
        let found = flexures(positions(CURVE_POINTS), "--full")?;
        let warning = found.warning();
        warning.iter().for_each(|words| common.say(&format!("warning: {}: {words}", document.name)));
        outputs.table(Output::DATA, &found.table())?;
    } else {
        outputs.table(Output::DATA, &table)?;
    }
    outputs.write(Output::LANDSCAPE, landscape(&mechanism, document.scene.mass_g / 1e3))?;
    // The picture shows the whole curve, even if few positions were requested.
    let stops = stop_positions(&document.scene);
    outputs.draw(of_curve, &document, |ranges| match &measured {
        Some(found) => {
            let range = extent(found.positions.iter().copied());
            let table = Curve::drawn(Some(range), &document, &mechanism).map_err(told)?;
            Ok(measured_force_chart(found, &table, ranges))
        }
        None => {
            let table = curve(even(CURVE_PICTURE_POINTS))?;
            Ok(curve_chart(&table, &mechanism, stops, ranges))
        }
    })?;
    if outputs.has(Output::SHAPES) {
        outputs.table(Output::SHAPES, &flexures(positions(SHAPES), "--shapes")?.shapes())?;
    }
    outputs.draw(of_shapes, &document, |_| {
        let is_named = listed.is_some() || options.points.is_some() || range.is_some();
        let equilibria = || mechanism.landscape.equilibria.iter().map(|equilibrium| equilibrium.x).collect();
        let at = if is_named { positions(SHAPES) } else { equilibria() };
        Ok(shapes_chart(&flexures(at, "--shapes-plot")?.states, &mechanism, stops))
    })?;
    let named = |place: usize| listed.as_ref().and_then(|at| at.get(place)).copied();
    let Some(model) = simulation.as_ref().map(Simulation::model) else {
        return outputs.finish_rows(&document, 1);
    };
    if let Some(picture) = of_mechanism {
        let models = [Some(model), other.as_ref().map(Simulation::model)].into_iter().flatten();
        let at = |(place, model): (usize, _)| (model, named(place).unwrap_or(Model::start(model).0));
        let chart = mechanism_chart(&models.enumerate().map(at).collect::<Vec<_>>()).map_err(|problem| {
            Failure::argument(format!("--mechanism-plot: {}: {problem}", document.name))
        })?;
        let caption = caption(&document).with_others(other.iter().map(Simulation::document));
        picture.write(&mut outputs, &chart, &caption)?;
    }
    outputs.draw(of_well, &document, |_| {
        let largest = if model.is_shaken() { model.largest_base_acceleration() } else { 0.0 };
        let accel = accel.map_or(largest, |accel| accel * STANDARD_GRAVITY);
        let ends: Vec<f64> = even(2);
        Ok(well_chart(model, named(0).unwrap_or(model.start().0), accel, (ends[0], ends[1])))
    })?;
    if let Some(table) = &impacts {
        outputs.table(Output::CONTACT, table)?;
        if let Some(stop) = model.compliant() {
            outputs.draw(of_contact, &document, |_| Ok(contact_chart(table, &stop, model.mass())))?;
        }
    }
    outputs.finish_rows(&document, 1)
}
