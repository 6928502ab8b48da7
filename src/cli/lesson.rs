//! `lesson`: list of the lessons, the text of a lesson, its check, and a template for a new one.

use std::path::PathBuf;

use clap::Args;
use interwell::numeric::visible;
use interwell::questions::check_lessons;
use interwell::scene::Fault;
use interwell::scene::lesson::{Choice, LESSONS, LessonDocument, LessonError, Step, TEMPLATE};
use interwell::system::files;
use interwell_studies::study::{LessonFinding, result_fields};

use super::support::counted;
use super::{Common, Failure, Output, Outputs, interrupt, refuse, write_alone};

const EXAMPLES: &str = "\
Examples:
  interwell --headless lesson
  interwell --headless lesson 3
  interwell --headless lesson --check
  interwell --headless lesson --new my-lesson.ron
  interwell --headless lesson my-lesson.ron --check";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Lesson file, or name or number of a built-in lesson, whose text is printed [default: list them all]
    #[arg(value_name = "LESSON")]
    pub lesson: Option<String>,

    /// Run it, or all built-in ones: every start must fail its task, every solution pass, and of every
    /// prediction exactly one option hold. A bound whose change by 1 % changes a verdict is a warning
    #[arg(long)]
    pub check: bool,

    /// Write a template of a lesson
    #[arg(long, value_name = "FILE", conflicts_with_all = ["lesson", "check"])]
    pub new: Option<PathBuf>,
}

pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    if common.jobs.is_some() && !options.check {
        refuse!("--jobs: nothing runs without --check; leave it out");
    }
    if let Some(path) = &options.new {
        if files::exists(path) {
            refuse!("--new {}: the file is there already; name another", path.display());
        }
        return write_alone(Output::LESSON, path, TEMPLATE);
    }
    let input: Vec<PathBuf> = options.lesson.iter().map(PathBuf::from).collect();
    let mut outputs = Outputs::new(&input).with(Output::DATA, Some(common.out()))?;
    let (text, wrong) = match &options.lesson {
        _ if options.check => checked(options, common)?,
        Some(spec) => (full_text(&load(spec)?), None),
        None => (list()?, None),
    };
    outputs.write(Output::DATA, &text)?;
    outputs.finish()?;
    wrong.map_or(Ok(()), Err)
}

fn load(spec: &str) -> Result<LessonDocument, LessonError> {
    LessonDocument::load(spec, &result_fields())
}

fn list() -> Result<String, Failure> {
    let width = LESSONS.iter().map(|lesson| lesson.name.len()).max().unwrap_or(0);
    let line = |name: &str| {
        let lesson = load(name)?.lesson;
        Ok(format!("{name:width$}  {} min  {}\n", lesson.minutes, lesson.goal))
    };
    LESSONS.iter().map(|lesson| line(lesson.name)).collect()
}

/// A lesson as text: the student's part, then the lecturer's.
fn full_text(document: &LessonDocument) -> String {
    let lesson = &document.lesson;
    let mut text = format!("{} ({} min)\nGoal: {}\n\n", lesson.title, lesson.minutes, lesson.goal);
    for (number, step) in lesson.steps.iter().enumerate() {
        let (word, more): (&str, String) = match step {
            Step::Say(_) => ("", String::new()),
            Step::Predict { options, .. } => {
                let lettered = ('a'..).zip(options);
                let reply = |option: &Choice| {
                    option.reply.iter().map(|reply| format!("       Reply: {reply}\n")).collect::<String>()
                };
                let line = |(letter, option): (char, &Choice)| {
                    format!("   ({letter}) {}\n{}", option.text, reply(option))
                };
                ("Predict: ", lettered.map(line).collect())
            }
            Step::Do { hint, .. } => ("Do: ", hint.iter().map(|hint| format!("   Hint: {hint}\n")).collect()),
            Step::Explain(_) => ("Explained: ", String::new()),
        };
        text += &format!("{}. {word}{}\n{more}", number + 1, step.text());
    }
    text += &format!("\nMisconception: {}\nLecturer: {}\n", lesson.misconception, lesson.lecturer);
    visible(&text).into_owned()
}

/// Checks the lessons. Returns one line for each, and the error of the command if a lesson is wrong.
fn checked(options: &Arguments, common: &Common) -> Result<(String, Option<Failure>), Failure> {
    let specs: Vec<&str> = match &options.lesson {
        Some(spec) => vec![spec],
        None => LESSONS.iter().map(|lesson| lesson.name).collect(),
    };
    let documents = specs.iter().map(|spec| load(spec)).collect::<Result<Vec<_>, _>>()?;
    let reports = check_lessons(&documents, &interrupt::progress().threads(common.jobs()))?;
    let mut text = String::new();
    let mut wrong: Vec<String> = Vec::new();
    for (document, report) in documents.iter().zip(&reports) {
        let verdict = if report.wrong.is_empty() { "holds" } else { "is wrong" };
        let predictions = counted(report.predictions as u64, "prediction");
        let tasks = counted(report.tasks as u64, "task");
        text += &format!("{}: {verdict} ({predictions}, {tasks})\n", document.name);
        lines(document, &report.warnings).iter().for_each(|line| common.say(&format!("warning: {line}")));
        wrong.extend(lines(document, &report.wrong));
    }
    let wrong = (!wrong.is_empty()).then(|| Failure::failed(wrong.join("\n")));
    Ok((text, wrong))
}

/// Findings with their places, one line each.
fn lines(document: &LessonDocument, findings: &[LessonFinding]) -> Vec<String> {
    if findings.is_empty() {
        return Vec::new();
    }
    let fault = |LessonFinding { field, problem, .. }: &LessonFinding| Fault {
        field: field.clone(),
        value: String::new(),
        problem: problem.clone(),
    };
    let error = document.error_from(findings.iter().map(fault).collect());
    error.to_string().lines().map(str::to_owned).collect()
}
