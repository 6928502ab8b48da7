//! Answers to the questions of a session in messages, which are told apart by their names.

use std::sync::atomic::AtomicBool;

use crate::app::task::{Each, Question, from_message, to_message};

use super::accuracy::{LiveRun, PathQuestion, StepQuestion, TolerancesQuestion};
use super::ask::{StopsQuestion, ThresholdsQuestion};
use super::best::Search;
use super::explore::{BasinsQuestion, SpectrumQuestion, WalkQuestion};
use super::lesson::{GoalQuestion, OptionsQuestion};
use super::map::CellsQuestion;
use super::measured::{FitQuestion, MeasuredQuestion};

/// Answers the question of a name in a message, and passes on each part of its answer as a message.
pub fn answer(name: &str, question: &[u8], cancel: &AtomicBool, each: Each<Vec<u8>>) -> Result<(), String> {
    macro_rules! answer_as {
        ($($question:ty),+ $(,)?) => {
            match name {
                $(<$question>::NAME => answered::<$question>(question, cancel, each),)+
                _ => Err(format!("no question is called {name}")),
            }
        };
    }
    answer_as! {
        LiveRun, PathQuestion, TolerancesQuestion, StepQuestion,
        ThresholdsQuestion, StopsQuestion,
        SpectrumQuestion, WalkQuestion, BasinsQuestion,
        CellsQuestion, Search,
        MeasuredQuestion, FitQuestion,
        OptionsQuestion, GoalQuestion,
    }
}

/// Answers a question in a message likewise.
pub fn answered<Q: Question>(
    question: &[u8],
    cancel: &AtomicBool,
    each: Each<Vec<u8>>,
) -> Result<(), String> {
    // a part that cannot be written is left out
    let send = |part: Q::Part| to_message(&part).map_or((), each);
    if let Some(last) = from_message::<Q>(question)?.answer(cancel, &send) {
        send(last);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::sync::{Arc, Mutex};

    use super::*;
    use crate::app::session::Session;
    use crate::app::session::editor::Editor;
    use crate::app::session::lesson::{OpenLesson, Turn};
    use crate::app::session::measured::MeasuredRecord;
    use crate::scene::lesson::{LESSONS, LessonDocument};
    use crate::scene::{Channel, Document, Quantity, SweepAxis};
    use interwell_studies::study::result_fields;

    /// Questions that take longer than a second about these presets; others are asked the same.
    const SLOW: [(&str, &str); 4] = [
        ("first-look", BasinsQuestion::NAME),
        ("first-look", ThresholdsQuestion::NAME),
        ("paper", Search::NAME),
        ("paper-table", Search::NAME),
    ];

    /// A text without the computing times, which differ from run to run.
    fn without_times(text: &str) -> String {
        let mut parts = text.split("cpu_s:");
        let first = parts.next().unwrap_or_default().to_owned();
        parts.fold(first, |text, part| text + &part[part.find([',', ')']).unwrap()..])
    }

    /// A value as text, which tells apart what a message need not.
    fn text_of<T: serde::Serialize>(value: &T) -> String {
        without_times(&ron::to_string(value).unwrap())
    }

    /// Compares the answer of a question with those, by messages, of the three into which it can be divided.
    /// `compares` says whether the question that has come as a message is equal to it: a model is not, since
    /// it has another address.
    fn compare<Q: Question>(question: Option<&Q>, compares: bool) {
        let question = question.unwrap_or_else(|| panic!("{} was not asked", Q::NAME));
        let again: Q = from_message(&to_message(question).unwrap()).unwrap();
        assert_eq!(text_of(&again), text_of(question), "{}", Q::NAME);
        assert_eq!(again == *question, compares, "{}", Q::NAME);
        let cancel = AtomicBool::new(false);
        let (here, there) = (Mutex::new(Vec::new()), Mutex::new(Vec::new()));
        let keep = |part: Q::Part| here.lock().unwrap().push(text_of(&part));
        question.answer(&cancel, &keep).into_iter().for_each(keep);
        let take = |part: Vec<u8>| {
            let part: Q::Part = from_message(&part).unwrap();
            there.lock().unwrap().push(text_of(&part));
        };
        for part in question.divide(3) {
            answer(Q::NAME, &to_message(&part).unwrap(), &cancel, &take).unwrap();
        }
        let [mut here, mut there] = [here, there].map(|parts| parts.into_inner().unwrap());
        // threads pass on parts in any order
        here.sort();
        there.sort();
        assert_eq!(here, there, "{}", Q::NAME);
        assert!(!here.is_empty(), "{}", Q::NAME);
    }

    /// A session on a short run of a preset that has been moved to another frequency under way.
    fn session(preset: &str) -> Session {
        let mut document = Document::preset(preset).unwrap();
        for change in ["run.settle_s=0.5", "run.duration_s=1.5"] {
            document.set(change).unwrap();
        }
        let mut session = Session::new(Editor::new(document), Arc::new(|| ())).unwrap();
        session.player.speed = 1.0;
        session.player.set_playing(true);
        (0..4).for_each(|_| _ = session.player.tick(0.09));
        let field = "excitation.frequency_hz";
        if let Some(hz) = session.number(field) {
            session.set_number(field, 1.1 * hz).unwrap();
            session.end_gesture();
        }
        (0..4).for_each(|_| _ = session.player.tick(0.07));
        session.moved_by_hand();
        session
    }

    /// Three values of a field around that of the scene.
    fn axis(session: &Session, field: &str) -> SweepAxis {
        let value = session.number(field).unwrap();
        let values = Vec::new();
        SweepAxis { field: field.to_owned(), from: value, to: 1.5 * value, step: 0.25 * value, values }
    }

    fn record(values: Quantity, across: Quantity) -> MeasuredRecord {
        let channel = |quantity: Quantity, scale: f64, shift: f64| Channel {
            quantity,
            column: "column".to_owned(),
            values: (0..200).map(|i| scale * (f64::from(i) * 0.01 + shift)).collect(),
        };
        let (across, values) = (channel(across, 1.0, -0.1), channel(values, 1e-3, 0.0));
        let (path, units, range) = ("a.csv".into(), ["s", "m"], (0.0, 2e-3));
        MeasuredRecord { path, units, across, values, decimal_commas: false, timing: None, range }
    }

    /// All questions about a scene that it can be asked.
    fn compare_all(preset: &str) {
        let mut session = session(preset);
        let is_slow = |name: &str| SLOW.contains(&(preset, name));
        compare(session.settled.question(), false);
        session.accuracy.follow(session.player.watch().time(), &session.wake.clone());
        if session.player.watch().from_here().is_some() {
            compare(session.accuracy.trust.question(), false);
        }
        session.want_accuracy();
        compare(session.accuracy.tolerances.question(), false);
        compare(session.accuracy.stepped.question(), false);
        session.want_spectrum();
        compare(session.explore.spectra.found.question(), false);
        session.want_basins((-1e-3, 1e-3), (-0.1, 0.1));
        let basins = session.explore.basins.question().cloned();
        if !is_slow(BasinsQuestion::NAME) {
            compare(basins.map(|basins| BasinsQuestion { starts: 3, ..basins }).as_ref(), true);
        }
        for (values, across) in
            [(Quantity::Displacement, Quantity::Time), (Quantity::Force, Quantity::Displacement)]
        {
            session.measured.lay(record(values, across));
            session.want_differences();
            compare(session.measured.found.question(), false);
            session.fit_shift();
            compare(session.measured.fit.question(), false);
        }
        session.ways();
        if session.can_search() {
            // the second answer is the first one, which is kept, if scene and mechanism are the same
            if !is_slow(ThresholdsQuestion::NAME) {
                compare(session.thresholds.question(), true);
            }
            compare(session.stops_that_cross.question(), true);
        }
        let fields = session.map_fields();
        let axes = [0, 1].map(|i| axis(&session, &fields[i]));
        if session.model().repeats() {
            session.explore.walks.chosen = Some(axes[0].clone());
            session.want_walks().unwrap();
            compare(session.explore.walks.found.question(), true);
        }
        session.map.show(interwell_studies::study::SummaryField::find("work_j").unwrap());
        session.map.choose(Some(axes));
        session.want_map(0.0);
        compare(session.map.cells.question(), true);
        session.find_best_stops();
        if let Some(search) = session.best.search.question().filter(|_| !is_slow(Search::NAME)) {
            let mut search = search.clone();
            search.over += &format!(":{}", (search.range.1 - search.range.0) / 4.0);
            compare(Some(&search), true);
        }
    }

    #[test]
    fn questions_by_messages_have_the_same_answers() {
        let presets = ["paper", "first-look", "harvester", "random-shaking", "paper-ramp", "bouncing-ball"];
        // with a table and with a record
        presets.into_iter().chain(["paper-table", "walking"]).for_each(compare_all);
    }

    #[test]
    fn questions_of_lessons_by_messages_have_the_same_answers() {
        let document = LessonDocument::load(LESSONS[0].name, &result_fields()).unwrap();
        let (mut lesson, scene) = OpenLesson::open(document, None, Arc::new(|| ()));
        let mut session = Session::new(Editor::new(*scene), Arc::new(|| ())).unwrap();
        let mut asked = (0, 0);
        loop {
            lesson.follow(&session, 0.0);
            if lesson.options.question().is_some() {
                compare(lesson.options.question(), true);
                asked.0 += 1;
            }
            if lesson.goal.question().is_some() {
                compare(lesson.goal.question(), true);
                asked.1 += 1;
            }
            lesson.reveal();
            if lesson.is_last() {
                break;
            }
            if let Turn::Show(scene, _) = lesson.go_on() {
                session = Session::new(Editor::new(*scene), Arc::new(|| ())).unwrap();
            }
        }
        assert!(asked.0 > 0 && asked.1 > 0, "{asked:?}");
    }

    #[test]
    fn an_unknown_name_or_a_broken_message_is_an_error() {
        let asked = |name: &str, message: &[u8]| answer(name, message, &AtomicBool::new(false), &|_| ());
        assert_eq!(asked("weather", &[]).unwrap_err(), "no question is called weather");
        assert!(asked(LiveRun::NAME, &[0x93, 0x01]).is_err());
    }
}
