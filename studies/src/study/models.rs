//! History of the models of a motion.
//!
//! While a slider is dragged, every frame has a new model. A model that was in use too briefly to be seen is
//! replaced by the next one; if there are too many, the one in use for the shortest time is dropped.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::dynamics::Model;

const MAX_MODELS: usize = 200;

/// First and last time in s during which a model was in use, and that model.
pub type ModelUse<'a> = (f64, f64, &'a Arc<Model>);

#[derive(Debug, Clone)]
pub(super) struct Models {
    /// The present model, and the time in s from which it is in use.
    now: (f64, Arc<Model>),
    /// Those before it, each with its first time.
    before: VecDeque<(f64, Arc<Model>)>,
}

impl Models {
    pub fn new(model: Arc<Model>) -> Self {
        Self { now: (0.0, model), before: VecDeque::new() }
    }

    /// Uses `model` from the time `t` in s on. A model in use for less than `brief` seconds is not kept.
    pub fn change(&mut self, t: f64, model: Arc<Model>, brief: f64) {
        if t - self.now.0 < brief {
            self.now.1 = model;
            return;
        }
        self.before.push_back(std::mem::replace(&mut self.now, (t, model)));
        if self.before.len() > MAX_MODELS {
            let ends = self.before.iter().skip(1).chain([&self.now]);
            let lengths = self.before.iter().zip(ends).map(|(entry, next)| next.0 - entry.0);
            let shortest = lengths.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |found| found.0);
            self.before.remove(shortest);
        }
    }

    /// The model in use at a time in s, with its first time; for earlier times the first model.
    fn entry(&self, t: f64) -> &(f64, Arc<Model>) {
        let after = self.before.partition_point(|entry| entry.0 <= t);
        let before = self.before.get(after.saturating_sub(1)).filter(|_| t < self.now.0);
        before.unwrap_or(&self.now)
    }

    /// The model in use at a time in s; for earlier times the first model.
    pub fn at(&self, t: f64) -> &Arc<Model> {
        &self.entry(t).1
    }

    /// The first time in s of the model in use at a time in s.
    pub fn since(&self, t: f64) -> f64 {
        self.entry(t).0
    }

    /// Drops models that were in use only before a time in s.
    pub fn forget(&mut self, t: f64) {
        while self.before.get(1).map_or(self.now.0, |next| next.0) <= t && self.before.pop_front().is_some() {
        }
    }

    /// The models in use from `from` to `to` in s, in order of time, with their times limited to this range.
    pub fn between(&self, from: f64, to: f64) -> impl Iterator<Item = ModelUse<'_>> {
        let first = self.before.partition_point(|entry| entry.0 <= from).saturating_sub(1);
        let all = self.before.iter().skip(first).chain([&self.now]);
        let ends =
            self.before.iter().chain([&self.now]).skip(first + 1).map(|next| next.0).chain([f64::INFINITY]);
        all.zip(ends)
            .map(move |(entry, end)| (entry.0.max(from), end.min(to), &entry.1))
            .filter(|span| span.1 > span.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::Mechanism;
    use crate::scene::Document;

    /// A model that is identified by its mass.
    fn of(grams: f64) -> Arc<Model> {
        let mut document = Document::load("nominal-cubic").unwrap();
        document.scene.mass_g = grams;
        let mechanism = Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
        Arc::new(Model::build(&document.scene, Arc::new(mechanism)).unwrap())
    }

    fn mass(models: &Models, t: f64) -> f64 {
        (models.at(t).mass() * 1e3).round()
    }

    #[test]
    fn each_time_has_its_model() {
        let mut models = Models::new(of(1.0));
        models.change(2.0, of(2.0), 0.1);
        models.change(5.0, of(3.0), 0.1);
        assert_eq!(
            [-1.0, 0.0, 1.999, 2.0, 4.0, 5.0, 9.0].map(|t| mass(&models, t)),
            [1.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0]
        );
        assert_eq!([1.0, 3.0, 7.0].map(|t| models.since(t)), [0.0, 2.0, 5.0]);
        let spans: Vec<(f64, f64)> = models.between(1.0, 6.0).map(|span| (span.0, span.1)).collect();
        assert_eq!(spans, [(1.0, 2.0), (2.0, 5.0), (5.0, 6.0)]);
        assert_eq!(models.between(2.5, 3.0).count(), 1);
        // models in use for no time, or for too short a time, are gone
        models.change(5.0, of(4.0), 0.1);
        models.change(5.05, of(5.0), 0.1);
        assert_eq!((models.before.len(), mass(&models, 5.0)), (2, 5.0));
        models.forget(1.0);
        assert_eq!(models.before.len(), 2);
        models.forget(2.0);
        assert_eq!((models.before.len(), mass(&models, 0.0)), (1, 2.0));
        models.forget(100.0);
        assert_eq!((models.before.len(), mass(&models, 0.0)), (0, 5.0));
    }

    #[test]
    fn memory_is_bounded_and_the_briefest_go_first() {
        let (long, brief, last) = (of(1.0), of(2.0), of(3.0));
        let mut models = Models::new(Arc::clone(&long));
        let mut t = 10.0;
        for _ in 0..3 * MAX_MODELS {
            t += 0.2;
            models.change(t, Arc::clone(&brief), 0.1);
        }
        models.change(t + 5.0, last, 0.1);
        assert_eq!(models.before.len(), MAX_MODELS);
        assert_eq!((mass(&models, 4.0), mass(&models, t + 4.0), mass(&models, t + 5.0)), (1.0, 2.0, 3.0));
    }
}
