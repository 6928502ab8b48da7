//! Conditions on a scene and on what its run comes to.

use serde::Deserialize;

use crate::scene::data::Start;

/// What holds of a scene and its run. A field is named with what it is of: `scene.` and the path of a field,
/// or, each with the name of a summary's field, `result.` (the scene's own run), `before.` (the run of the
/// scene with which the step began), `up.` and `down.` (the run at the end of a walk to the scene's value of
/// the walked field), `mean.` and `error.` (mean over the seeds, and its standard error). Of the whole walk
/// there are `walk.up_crosses_from`, `walk.down_crosses_to` and `walk.gap`, the first less the second.
///
/// Nothing that is missing is at least or at most anything.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub enum Condition {
    /// The field is this word or number.
    Is(String, String),
    /// The field is at least this.
    AtLeast(String, f64),
    /// The field is at most this.
    AtMost(String, f64),
    /// The field is greater than this.
    Above(String, f64),
    /// The field is less than this.
    Below(String, f64),
    /// The field lies between these two, or is one of them.
    Between(String, f64, f64),
    /// The field has a value.
    Present(String),
    /// The field has none.
    Absent(String),
    /// All of these hold.
    All(Vec<Condition>),
    /// One of these holds, or more.
    Any(Vec<Condition>),
    /// This does not hold.
    Not(Box<Condition>),
    /// It holds from every one of these starts.
    Every(Vec<Start>, Box<Condition>),
    /// It holds from one of these starts, or more.
    #[serde(rename = "Some")]
    ForSome(Vec<Start>, Box<Condition>),
    /// The field has a value from each of these starts, and the values differ by no more than this share of
    /// the largest.
    Same(String, f64, Vec<Start>),
}

impl Condition {
    /// The conditions of which this one is made.
    pub fn parts(&self) -> &[Self] {
        match self {
            Self::All(parts) | Self::Any(parts) => parts,
            Self::Not(part) | Self::Every(_, part) | Self::ForSome(_, part) => std::slice::from_ref(part),
            _ => &[],
        }
    }

    /// The field that it names itself.
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

    /// The starts that it names itself.
    pub fn starts(&self) -> &[Start] {
        match self {
            Self::Every(starts, _) | Self::ForSome(starts, _) | Self::Same(_, _, starts) => starts,
            _ => &[],
        }
    }

    /// Calls `each` with every bound and the field that it is of, those of its parts among them.
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
