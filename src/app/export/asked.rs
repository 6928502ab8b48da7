//! Answers to all questions in messages, which are told apart by their names.

use std::sync::atomic::AtomicBool;

use crate::app::session::asked::{self, answered};
use crate::app::task::{Each, Question};

use super::RunQuestion;
use super::figure::FigureOrder;

/// Answers the question of a name in a message, and passes on each part of its answer as a message.
pub fn answer(name: &str, question: &[u8], cancel: &AtomicBool, each: Each<Vec<u8>>) -> Result<(), String> {
    match name {
        FigureOrder::NAME => answered::<FigureOrder>(question, cancel, each),
        RunQuestion::NAME => answered::<RunQuestion>(question, cancel, each),
        _ => asked::answer(name, question, cancel, each),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::PathBuf;
    use std::sync::{Arc, Mutex};

    use super::*;
    use crate::app::export::WriteResult;
    use crate::app::export::figure::{Place, Subject};
    use crate::app::session::Session;
    use crate::app::session::editor::Editor;
    use crate::app::task::{from_message, to_message};
    use crate::output::{Cut, Format, RunPanel, Sheet, SheetText, View};
    use crate::scene::SweepAxis;

    fn session(of: &str) -> Session {
        Session::new(Editor::open(of).unwrap(), Arc::new(|| ())).unwrap()
    }

    /// The answer to a question that has travelled as a message.
    fn by_message<Q: Question<Part = WriteResult>>(question: &Q) -> Vec<WriteResult> {
        let parts = Mutex::new(Vec::new());
        let take = |part: Vec<u8>| parts.lock().unwrap().push(from_message(&part).unwrap());
        answer(Q::NAME, &to_message(question).unwrap(), &AtomicBool::new(false), &take).unwrap();
        parts.into_inner().unwrap()
    }

    /// Has the question answered here and by a message, and compares the files.
    fn compare<Q: Question<Part = WriteResult>>(question: &Q, written: &[PathBuf]) {
        let bytes = || written.iter().map(|path| fs::read(path).unwrap()).collect::<Vec<_>>();
        let here = question.answer(&AtomicBool::new(false), &|_| ());
        let first = bytes();
        written.iter().for_each(|path| fs::remove_file(path).unwrap());
        assert_eq!(by_message(question), here.into_iter().collect::<Vec<_>>());
        assert!(bytes() == first && !first.iter().any(Vec::is_empty), "{written:?}");
    }

    #[test]
    fn figures_by_messages_are_the_same_files() {
        let folder = tempfile::tempdir().unwrap();
        let [path, data] = ["a.pdf", "a.csv"].map(|name| folder.path().join(name));
        let axis = |field: &str, values: [f64; 2]| {
            let [from, to] = values;
            SweepAxis { field: field.to_owned(), from, to, step: to - from, ..SweepAxis::default() }
        };
        let axes = [axis("stops.travel_limit_mm", [1.0, 2.0]), axis("excitation.amplitude_g", [0.5, 1.0])];
        let cut = Cut { column: "travel_limit_mm".to_owned(), value: 1.0 };
        let subjects = [
            Subject::Curve,
            Subject::Run(Some((0.1, 0.7)), vec![RunPanel::ALL[0]]),
            Subject::Sweep(axes.to_vec(), "rms_velocity_m_per_s".to_owned(), View::Cuts(vec![cut])),
            Subject::Section,
        ];
        for of in ["paper", "paper-table"] {
            for subject in &subjects {
                let text =
                    SheetText { width_mm: "85", height_mm: None, font_pt: "8", dpi: None, titled: true };
                let sheet = Sheet::read(&text, false).unwrap();
                let data = Some(data.clone());
                let place = Place { path: path.clone(), format: Format::Pdf, sheet, data };
                let order = FigureOrder::new(&session(of), subject.clone(), place).unwrap();
                compare(&order, &[path.clone(), folder.path().join("a.csv")]);
            }
        }
    }

    #[test]
    fn a_run_by_a_message_is_the_same_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        for of in ["paper", "walking", "paper-table"] {
            let model = session(of).model.clone();
            compare(&RunQuestion { model, path: path.clone() }, std::slice::from_ref(&path));
        }
    }
}
