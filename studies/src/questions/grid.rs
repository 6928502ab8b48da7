//! What the studies of grids share.

use std::sync::Arc;

use super::error::check_until_settled;
use super::{Error, Progress, Sweep};
use crate::dynamics::Model;
use crate::mechanics::{ForceCurve, Mechanism};
use crate::scene::Mechanism::Linear;
use crate::scene::{Damping, Document, Scene, Start, Stops, Transducer};
use crate::study::{GridStudy, Question, Table, over_fields};

over_fields!(Sweep);

/// Checks the time up to which runs of `model` may continue, if one is given.
pub(crate) fn check_until(until: Option<f64>, document: &Document, model: &Model) -> Result<(), Error> {
    until.map_or(Ok(()), |until| check_until_settled(until, document, model))
}

/// The study, once the time up to which its runs may continue is checked with the model of the first cell.
pub(crate) fn settles<Q: Question>(
    study: GridStudy<Q>,
    until: Option<f64>,
    document: &Document,
    progress: &Progress,
) -> Result<GridStudy<Q>, Error> {
    if until.is_some()
        && let Some(model) = study.first_model(&progress.silent())
    {
        check_until(until, document, &model)?;
    }
    // the faults of a first cell without a model are found with those of the others
    Ok(study)
}

/// Checks all cells; then runs these and returns all rows.
pub(crate) fn all_rows<Q: Question>(
    study: &GridStudy<Q>,
    document: &Document,
    progress: &Progress,
) -> Result<Table, Error> {
    let silent = progress.silent();
    let mut all = study.empty_table();
    progress.pool(|pool| {
        study.validate(pool, &silent).map_err(|cell| Error::cells_of(document, vec![cell]))?;
        let write = |rows: &Table| {
            all.append(rows);
            Ok::<_, std::convert::Infallible>(true)
        };
        let runs = study.rows() * study.runs_per_row();
        let end = progress.task(Some(runs), |task| study.run(pool, task, write));
        // rows in memory can always be written
        end.map_err(|_| Error::Cancelled)
    })??;
    Ok(all)
}

/// A model for the check of `until_settled`, which depends only on the drive and the run of `scene`: a mass
/// on a linear spring with these. So the check needs no mechanism, which a grid or a design may replace.
pub(crate) fn drive_alone(document: &Document, scene: Scene) -> Result<Model, Error> {
    let alone = Scene {
        mass_g: 1.0,
        mechanism: Linear { n_per_m: 1.0 },
        damping: Damping::None,
        stops: Stops::None,
        transducer: Transducer::None,
        start: Start::Rest,
        ..scene
    };
    let mechanism = Mechanism::new(ForceCurve::polynomial(&[0.0, 1.0]));
    Model::build(&alone, Arc::new(mechanism)).map_err(|faults| Error::faults_of(document, faults))
}
