//! What a best design owes to the seeds of the noises under which it was searched.
//!
//! Environments that differ in their seeds alone are a sample of the noise, and a mean over them has a
//! standard error. Since all designs are run with the same seeds, the difference of two designs is that of
//! the pairs, and the designs that are not surely worse than the best one are those whose mean difference is
//! below Student's quantile times its standard error. The interval of a field is that of its values among
//! them. For a value that changes smoothly it holds the best place in more than 95 of 100 cases, since the
//! error of the place is the error of the slope, and for one that jumps from place to place too, where more
//! of the places are as good.

use serde::{Deserialize, Serialize};

use super::{BestQuestion, Optimum};
use crate::numeric::regression::student;
use crate::scene::{Excitation, Scene};

/// What the best place and its value owe to the seeds of noises.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum Seeds {
    /// No environment has a noise: they owe nothing to chance.
    #[default]
    None,
    /// An environment has a noise of one seed, so that the error is not known.
    Alone,
    /// The noises have several seeds each.
    Averaged {
        /// The least number of seeds of a noise.
        count: usize,
        /// Standard error of the value.
        standard_error: f64,
        /// For each field the least and the largest value at which a design that was tried is not surely
        /// worse (95 %) than the best one.
        intervals: Vec<[f64; 2]>,
    },
}

/// The environments as a sample of noises: a group has those that differ in their seeds alone.
#[derive(Debug)]
pub(super) struct Sample {
    /// Indices of the environments of each group with a noise.
    groups: Vec<Vec<usize>>,
    /// The weights of all environments; their sum is 1.
    weights: Vec<f64>,
}

impl Sample {
    pub fn new(question: &BestQuestion) -> Self {
        let mut kinds: Vec<(Scene, Vec<usize>)> = Vec::new();
        for (number, environment) in question.environments.iter().enumerate() {
            let mut scene = environment.scene.clone();
            if !forget_seeds(&mut scene.excitation) {
                continue;
            }
            match kinds.iter_mut().find(|kind| kind.0 == scene) {
                Some((_, group)) => group.push(number),
                None => kinds.push((scene, vec![number])),
            }
        }
        let weights = question.environments.iter().map(|environment| environment.weight);
        let sum: f64 = weights.clone().sum();
        Self {
            groups: kinds.into_iter().map(|kind| kind.1).collect(),
            weights: weights.map(|weight| weight / sum).collect(),
        }
    }

    /// Whether the values of all designs are needed, since there is an error to be known.
    pub fn is_averaged(&self) -> bool {
        self.least() > 1
    }

    /// The least number of seeds of a noise; 0 without one.
    fn least(&self) -> usize {
        self.groups.iter().map(Vec::len).min().unwrap_or(0)
    }

    /// The mean of a value of each environment, and its standard error.
    fn mean(&self, value: impl Fn(usize) -> f64) -> (f64, f64) {
        let mean = self.weights.iter().enumerate().map(|(i, weight)| weight * value(i)).sum();
        let of_group = |group: &Vec<usize>| {
            let count = group.len() as f64;
            let middle = group.iter().map(|i| value(*i)).sum::<f64>() / count;
            let squares: f64 = group.iter().map(|i| (value(*i) - middle).powi(2)).sum();
            squares / (count - 1.0) * group.iter().map(|i| self.weights[*i].powi(2)).sum::<f64>()
        };
        (mean, self.groups.iter().map(of_group).sum::<f64>().sqrt())
    }

    /// What `best` owes to the seeds, beside the designs that were tried, with their values.
    pub fn seeds(&self, best: &Optimum, tried: &[Optimum]) -> Seeds {
        let count = self.least();
        match count {
            0 => return Seeds::None,
            1 => return Seeds::Alone,
            _ => {}
        }
        let limit = student(count - 1);
        let mut intervals: Vec<[f64; 2]> = best.at.iter().map(|at| [*at, *at]).collect();
        for other in tried {
            let (less, error) = self.mean(|i| best.of_each[i] - other.of_each[i]);
            if less <= limit * error {
                for (interval, at) in intervals.iter_mut().zip(&other.at) {
                    *interval = [interval[0].min(*at), interval[1].max(*at)];
                }
            }
        }
        Seeds::Averaged { count, standard_error: self.mean(|i| best.of_each[i]).1, intervals }
    }
}

/// Sets the seeds of an excitation to 0; whether it has any.
fn forget_seeds(excitation: &mut Excitation) -> bool {
    match excitation {
        Excitation::Noise { seed, .. } => {
            *seed = 0;
            true
        }
        Excitation::Sum(all) => all.iter_mut().fold(false, |any, one| forget_seeds(one) | any),
        _ => false,
    }
}
