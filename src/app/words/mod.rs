//! Text of the window: names of the fields, explanations of terms, the sentence that describes the motion.

pub mod best_stops;
pub mod columns;
pub mod fields;
pub mod kind;
pub mod lesson;
pub mod meanings;
pub mod numbers;
pub mod parts;
pub mod status;
pub mod wells;

pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// What the guide line says.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Guide {
    pub heading: String,
    pub text: String,
    /// Particulars: behind the text where they fit into its row, or else shown under the pointer.
    pub more: String,
    /// Whether the text matters less than the views.
    pub is_faint: bool,
}

impl Guide {
    /// Names keys that help; `stays` if the mass does not cross a barrier that there is.
    pub fn keys(stays: bool) -> Self {
        let ways = if stays { "H says what it would take to cross, " } else { "" };
        Self { is_faint: true, ..Self::new("", format!("{ways}F1 lists all keys.")) }
    }

    pub fn new(heading: impl Into<String>, text: impl Into<String>) -> Self {
        Self { heading: heading.into(), text: text.into(), ..Self::default() }
    }
}
