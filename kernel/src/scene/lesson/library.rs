//! Built-in lessons, embedded from the files in `lessons/`.

/// A built-in lesson.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BuiltInLesson {
    /// Name of its file without extension: a number and a few words.
    pub name: &'static str,
    /// The lesson's text.
    pub text: &'static str,
}

macro_rules! lessons {
    ($($name:literal)*) => {
        /// The built-in lessons, in the order of a course.
        pub static LESSONS: &[BuiltInLesson] = &[$(BuiltInLesson {
            name: $name,
            text: include_str!(concat!("../../../../lessons/", $name, ".ron")),
        }),*];
    };
}

lessons! {
    "01-two-wells-and-a-hill"
    "02-shake-it-over"
    "03-a-stop-that-helps"
    "04-letting-go-is-not-crossing"
    "05-the-price-of-a-stop"
    "06-bouncy-or-dead"
    "07-a-coin-toss"
    "08-design-it"
    "09-up-is-not-down"
    "10-noise-has-no-rhythm"
}

/// Template for a new lesson.
pub static TEMPLATE: &str = include_str!("../../../../lessons/template.ron");

impl BuiltInLesson {
    /// The lesson of that name, which may also be its number or its words alone.
    pub fn find(name: &str) -> Option<&'static Self> {
        LESSONS.iter().find(|lesson| {
            let (number, words) = lesson.name.split_once('-').unwrap_or(("", lesson.name));
            lesson.name == name
                || words == name
                || number.trim_start_matches('0') == name.trim_start_matches('0')
        })
    }
}

/// Names of all lessons, separated by commas.
pub(super) fn names() -> String {
    LESSONS.iter().map(|lesson| lesson.name).collect::<Vec<_>>().join(", ")
}
