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
