//! Conditions on a scene and on the result of its run.

use serde::{Deserialize, Serialize};

use crate::scene::data::Start;

/// Condition on a scene and its run.
///
/// The prefix of a field tells its source. `scene.` is followed by the path of a field. The other prefixes
/// are followed by a field of a summary: `result.` (the run of the scene), `before.` (the run of the scene at
/// the beginning of the step), `up.` and `down.` (the run at the end of a walk to the scene's value of the
/// walked field), `mean.` and `error.` (mean over the seeds, and its standard error). A whole walk has the
/// fields `walk.up_crosses_from`, `walk.down_crosses_to` and `walk.gap`, the first less the second.
///
/// A comparison with a bound fails if the field has no value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Condition {
    /// The field equals this word or number.
    Is(String, String),
    /// The field is at least this number.
    AtLeast(String, f64),
    /// The field is at most this number.
    AtMost(String, f64),
    /// The field is greater than this number.
    Above(String, f64),
    /// The field is less than this number.
    Below(String, f64),
    /// The field lies between these two numbers, ends included.
    Between(String, f64, f64),
    /// The field has a value.
    Present(String),
    /// The field has no value.
    Absent(String),
    /// All of these conditions hold.
    All(Vec<Condition>),
    /// At least one of these conditions holds.
    Any(Vec<Condition>),
    /// This condition does not hold.
    Not(Box<Condition>),
    /// The condition holds from each of these starts.
    Every(Vec<Start>, Box<Condition>),
    /// The condition holds from at least one of these starts.
    #[serde(rename = "Some")]
    ForSome(Vec<Start>, Box<Condition>),
    /// The field has a value from each of these starts, and the values differ by at most this share
    /// of the largest.
    Same(String, f64, Vec<Start>),
}

impl Condition {
    /// The conditions that this one is composed of.
    pub fn parts(&self) -> &[Self] {
        match self {
            Self::All(parts) | Self::Any(parts) => parts,
            Self::Not(part) | Self::Every(_, part) | Self::ForSome(_, part) => std::slice::from_ref(part),
            _ => &[],
        }
    }

    /// The field of this condition, not of its parts.
    pub fn field(&self) -> Option<&str> {
        match self {
            Self::Is(field, _)
            | Self::AtLeast(field, _)
            | Self::AtMost(field, _)
            | Self::Above(field, _)
            | Self::Below(field, _)
            | Self::Between(field, ..)
            | Self::Present(field)
            | Self::Absent(field)
            | Self::Same(field, ..) => Some(field),
            _ => None,
        }
    }

    /// The starts of this condition, not of its parts.
    pub fn starts(&self) -> &[Start] {
        match self {
            Self::Every(starts, _) | Self::ForSome(starts, _) | Self::Same(_, _, starts) => starts,
            _ => &[],
        }
    }

    /// The starts of this condition and of all its parts.
    pub fn all_starts(&self) -> Vec<&Start> {
        self.starts().iter().chain(self.parts().iter().flat_map(Self::all_starts)).collect()
    }

    /// Calls `each` with every bound and its field, including those of all parts.
    pub fn for_each_bound(&mut self, each: &mut impl FnMut(&str, &mut f64)) {
        match self {
            Self::AtLeast(field, bound)
            | Self::AtMost(field, bound)
            | Self::Above(field, bound)
            | Self::Below(field, bound)
            | Self::Same(field, bound, _) => each(field, bound),
            Self::Between(field, low, high) => {
                each(field, low);
                each(field, high);
            }
            Self::All(parts) | Self::Any(parts) => {
                parts.iter_mut().for_each(|part| part.for_each_bound(each));
            }
            Self::Not(part) | Self::Every(_, part) | Self::ForSome(_, part) => part.for_each_bound(each),
            Self::Is(..) | Self::Present(_) | Self::Absent(_) => {}
        }
    }
}
