//! Texts that name arguments of a study, which each surface spells in its own way.

use std::fmt;

/// The name of an argument, as it is written into a text of [`Said`].
macro_rules! named {
    ($name:literal) => {
        concat!("\u{2}", $name, "\u{3}")
    };
}

pub(crate) use named;

/// The characters before and after a name, which occur in no text that a person writes.
const MARKS: [char; 2] = ['\u{2}', '\u{3}'];

/// How the arguments of a study are called.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spelling {
    /// As options: --until-settled.
    CommandLine,
    /// As in a program: `until_settled`.
    Program,
}

impl Spelling {
    /// The argument of this name.
    fn of(self, name: &str) -> String {
        match self {
            Self::CommandLine => format!("--{}", name.replace('_', "-")),
            Self::Program => format!("`{name}`"),
        }
    }
}

/// A sentence or a part of one; displayed, it names arguments as a program does.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Said(String);

impl Said {
    /// A text, in which names of arguments are marked.
    pub fn new(text: impl fmt::Display) -> Self {
        Self(text.to_string())
    }

    /// The text with arguments spelled like this.
    pub fn spelled(&self, spelling: Spelling) -> String {
        self.with_names(|name| spelling.of(name))
    }

    /// The same text with another name for an argument.
    pub(crate) fn renamed(&self, from: &str, to: &'static str) -> Self {
        let marked = |name: &str| format!("{}{name}{}", MARKS[0], MARKS[1]);
        Self(self.with_names(|name| marked(if name == from { to } else { name })))
    }

    /// The text with its names, which are every other part of it, replaced.
    fn with_names(&self, of: impl Fn(&str) -> String) -> String {
        let parts = self.0.split(MARKS).enumerate();
        parts.map(|(place, part)| if place % 2 == 1 { of(part) } else { part.to_owned() }).collect()
    }
}

impl fmt::Display for Said {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.spelled(Spelling::Program))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_surface_spells_the_names() {
        let said = Said::new(format!("give {} or {}", named!("until_settled"), named!("at")));
        assert_eq!(said.spelled(Spelling::CommandLine), "give --until-settled or --at");
        assert_eq!(said.renamed("at", "times").to_string(), "give `until_settled` or `times`");
    }
}
