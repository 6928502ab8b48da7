//! What is made of the declarations of studies: methods of Python, tables of columns in the documents.

use std::any::TypeId;
use std::fs;
use std::path::Path;

use clap::{Arg, ArgAction, Command};
use interwell::questions::{Basins, Escape, Exponents, Section, Spectrum, Threshold};
use interwell_studies::study::{Heading, PICTURE, Study};

/// What is made of one study.
struct Made {
    name: &'static str,
    method: String,
    has_method: bool,
    tables: Vec<Vec<Heading>>,
}

fn made<S: Study>() -> Made {
    Made { name: S::NAME, method: method::<S>(), has_method: !S::PYTHON.is_empty(), tables: S::columns() }
}

fn all() -> [Made; 6] {
    let section = made::<Section>();
    [
        made::<Basins>(),
        made::<Escape>(),
        made::<Exponents>(),
        section,
        made::<Spectrum>(),
        made::<Threshold>(),
    ]
}

/// Compares a file with what is made of the declarations; with UPDATE set, writes it.
#[track_caller]
fn is_made(file: &str, made: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    if std::env::var_os("UPDATE").is_some() {
        fs::write(&path, made).unwrap();
    }
    let found = fs::read_to_string(&path).unwrap();
    let differs = found.lines().zip(made.lines()).position(|(found, made)| found != made);
    assert!(
        found == made,
        "{file}, line {differs:?}: write it with UPDATE=1 cargo test --test suite declared"
    );
}

/// A text in lines of at most 110 characters after an indentation.
fn wrapped(text: &str, indent: usize) -> String {
    let (mut lines, mut line) = (Vec::new(), String::new());
    for word in text.split_whitespace() {
        if !line.is_empty() && indent + line.chars().count() + 1 + word.chars().count() > 110 {
            lines.push(std::mem::take(&mut line));
        }
        line += &format!("{}{word}", if line.is_empty() { "" } else { " " });
    }
    lines.push(line);
    lines.iter().map(|line| format!("{:indent$}{line}\n", "")).collect()
}

/// Code as in docstrings.
fn double_quoted(text: &str) -> String {
    text.replace('`', "``")
}

/// An argument in Python: its type, its default, and the call that checks its value.
fn argument(argument: &Arg) -> (String, String, String) {
    let name = argument.get_id().as_str();
    let default = argument.get_default_values().first().map(|value| value.to_string_lossy().into_owned());
    let words = argument.get_possible_values();
    let is = |id: TypeId| argument.get_value_parser().type_id() == id;
    let (kind, value, check) = if matches!(argument.get_action(), ArgAction::SetTrue) {
        return ("bool".into(), "False".into(), format!("bool({name})"));
    } else if !words.is_empty() {
        let all: Vec<String> = words.iter().map(|word| format!("{:?}", word.get_name())).collect();
        (
            "str",
            default.map(|word| format!("{word:?}")),
            format!("_word({name:?}, {name}, ({}))", all.join(", ")),
        )
    } else if is(TypeId::of::<f64>()) {
        ("float", default, format!("_real({name:?}, {name})"))
    } else if is(TypeId::of::<u64>()) || is(TypeId::of::<u32>()) {
        ("int", default, format!("_count({name:?}, {name})"))
    } else {
        ("str", default.map(|text| format!("{text:?}")), name.to_owned())
    };
    match value {
        Some(value) => (kind.to_owned(), value, check),
        None => (format!("{kind} | None"), "None".to_owned(), check),
    }
}

/// The help of an argument, with the words that it takes, and without the default, which the signature has.
fn meaning(argument: &Arg) -> String {
    let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
    let (text, default) = help.split_once(" [default: ").unwrap_or((&help, ""));
    let default = default.trim_end_matches(']');
    let mut text = format!(
        "{text}{}",
        if default.is_empty() { String::new() } else { format!("; by default {default}") }
    );
    for word in argument.get_possible_values() {
        let help = word.get_help().map(ToString::to_string).unwrap_or_default();
        text += &format!(". `{:?}`: {}", word.get_name(), help.trim_end_matches('.'));
    }
    text + "."
}

/// The paragraphs of a section of a documentation.
fn section(text: &str, heading: &str) -> Option<String> {
    let begin = text.split_once(heading)?.1;
    Some(begin.split("# ").next()?.trim().to_owned())
}

/// The method of a study in Python.
fn method<S: Study>() -> String {
    let command = S::augment_args(Command::new(S::NAME));
    let about = command.get_long_about().map(ToString::to_string).unwrap_or_default();
    let of_picture = |argument: &&Arg| argument.get_help_heading() != Some(PICTURE);
    let arguments: Vec<&Arg> = command.get_arguments().filter(of_picture).collect();
    let mut text = format!("    def {}(\n        self,\n", S::NAME);
    if S::GRID {
        text += "        over: Over | None = None,\n        *,\n";
    }
    for (place, one) in arguments.iter().enumerate() {
        let (kind, value, _) = argument(one);
        text += &format!("        {}: {kind} = {value},\n", one.get_id());
        // the first argument of a study without a grid may be given by its place
        text += if place == 0 && !S::GRID { "        *,\n" } else { "" };
    }
    if S::GRID {
        text += "        threads: int | None = None,\n        progress: Progress = False,\n";
    }
    text += "    ) -> Table:\n";
    let before = about.split("# ").next().unwrap_or_default();
    let mut paragraphs = before.split("\n\n").map(str::trim).filter(|one| !one.is_empty());
    let summary = paragraphs.next().unwrap_or_default().trim_end_matches('.');
    text += &format!("        \"\"\"{}.\n\n", double_quoted(summary));
    for paragraph in paragraphs {
        text += &format!("{}\n", wrapped(&double_quoted(paragraph), 8));
    }
    text += "        Parameters\n        ----------\n";
    if S::GRID {
        text += "        over : mapping of str to array_like of float, optional\n";
        text += "            Fields and their values: a row for each cell.\n";
    }
    for one in &arguments {
        let (kind, value, _) = argument(one);
        let kind = kind.trim_end_matches(" | None");
        let value = if value == "None" { "optional".to_owned() } else { format!("default {value}") };
        text += &format!("        {} : {kind}, {value}\n", one.get_id());
        text += &wrapped(&double_quoted(&meaning(one)), 12);
    }
    if S::GRID {
        text += "        threads, progress\n            See :meth:`sweep`.\n";
    }
    text += "\n        Returns\n        -------\n";
    text += if S::GRID && S::ROW_A_CELL { "        Table or Grid\n" } else { "        Table\n" };
    let names: Vec<String> =
        S::columns().iter().flatten().map(|column| format!("``{}``", column.name)).collect();
    let names = if names.is_empty() { "The columns of docs/output.md".to_owned() } else { names.join(", ") };
    let grid = if S::GRID && S::ROW_A_CELL { "; a :class:`Grid` with ``over``" } else { "" };
    text += &wrapped(&format!("{names}{grid}."), 12);
    if let Some(method) = section(&about, "# Method") {
        text += "\n        Notes\n        -----\n";
        let notes: Vec<String> = method.split("\n\n").map(|one| wrapped(&double_quoted(one), 8)).collect();
        text += &notes.join("\n");
    }
    text += "\n        Examples\n        --------\n";
    text += &S::PYTHON.lines().map(|line| format!("        {line}\n")).collect::<String>();
    text += "        \"\"\"\n        arguments = {\n";
    for one in &arguments {
        text += &format!("            \"{}\": {},\n", one.get_id(), argument(one).2);
    }
    text += "        }\n";
    text += &format!(
        "        return self._ask({:?}, {:?}, {}, arguments, {})\n",
        S::NAME,
        S::PARTS,
        if S::GRID { "over, threads, progress" } else { "None, None, False" },
        if S::ROW_A_CELL { "True" } else { "False" }
    );
    text
}

#[test]
fn the_methods_of_python_are_those_of_the_declarations() {
    let head = "\
\"\"\"The methods of a scene that ask studies, made of their declarations by a test.\"\"\"

from __future__ import annotations

from typing import Any

from ._check import Over, Progress, _count, _real, _word
from ._table import Table


class Studies:
    \"\"\"The studies of a scene.\"\"\"

    __slots__ = ()

    def _ask(
        self,
        study: str,
        parts: str,
        over: Over | None,
        threads: int | None,
        progress: Progress,
        arguments: dict[str, Any],
        cells: bool,
    ) -> Table:
        raise NotImplementedError
";
    let is_generated = |study: &Made| study.has_method;
    let methods: Vec<String> =
        all().into_iter().filter(is_generated).map(|study| format!("\n{}", study.method)).collect();
    is_made("python/interwell/_studies.py", &format!("{head}{}", methods.concat()));
}

/// The rows of a table of columns; those without words stand beside the next one.
fn rows(columns: &[Heading]) -> String {
    let (mut text, mut names) = (String::new(), Vec::new());
    for column in columns {
        names.push(format!("`{}`", column.name));
        if !column.words.is_empty() {
            text += &format!("| {} | {} |\n", names.join(", "), column.words);
            names.clear();
        }
    }
    text
}

#[test]
fn the_tables_of_columns_are_those_of_the_declarations() {
    const RULE: &str = "| --- | --- |\n";
    let mut page = super::OUTPUT.to_owned();
    for study in all() {
        let mut begin = page.find(&format!("\n## `{}`", study.name)).unwrap();
        for columns in &study.tables {
            begin += page[begin..].find(RULE).unwrap() + RULE.len();
            let end = begin + page[begin..].find("\n\n").unwrap() + 1;
            page.replace_range(begin..end, &rows(columns));
        }
    }
    is_made("docs/output.md", &page);
}
