//! Hint line of the first minute: what to try next, and what the last try showed.

use eframe::egui::{Align, FontFamily, Layout, RichText, Role, Ui, UiBuilder, vec2};

use crate::app::session::Session;
use crate::app::ui::style::{BODY, Style, strong_family};
use crate::app::ui::widgets::{fitting, tell};
use crate::app::words::Guide;
use crate::app::words::numbers::unbroken;
use crate::app::words::status::{as_set, in_unit};
use crate::dynamics::EventKind;

/// Distance in mm by which the stops have to be moved before the trade-off counts as tried.
const TRIED_MM: f64 = 0.3;

/// Factor up to which a shaking counts as that which the scene was opened with.
const NEARLY: f64 = 1.02;

/// How stops between two wells act.
const MIDDLE: &str = "near the middle they hold the mass high on the barrier, so a weaker push carries it \
                      over, but less far; farther out they may hinder it.";

/// What the line asks the user to try.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Stage {
    Cross,
    /// The mass has crossed by shaking: try it with stops.
    Compare,
    /// It has crossed without more shaking than at the start, between stops at `from_mm`: move the stops.
    Move {
        from_mm: f64,
    },
    /// The stops have been moved: explain what that showed.
    Answer,
    Done,
}

/// State of the hint line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hint {
    stage: Stage,
    /// Whether the scene was opened with a hint, shown or not.
    pub has_line: bool,
    /// The shaking in g that the scene was opened with.
    opened_g: f64,
}

impl Hint {
    /// The hint of a scene; shown only if there is a barrier, an amplitude to change, and stops to switch on.
    pub fn for_scene(session: &Session) -> Self {
        let offered = session.scene().app.as_ref().is_some_and(|app| app.stops_when_on.is_some());
        let barrier = session.model().mechanism().landscape.barrier.is_some();
        let opened_g = session.amplitude_g().filter(|_| offered && barrier);
        let stage = if opened_g.is_some() { Stage::Cross } else { Stage::Done };
        Self { stage, has_line: opened_g.is_some(), opened_g: opened_g.unwrap_or(0.0) }
    }

    /// Whether the line is shown. Also advances to the next stage once the present one is done.
    pub fn is_shown(&mut self, session: &Session) -> bool {
        if self.stage == Stage::Done || session.model().mechanism().landscape.barrier.is_none() {
            return false;
        }
        // A new crossing is recent: the last 50 events are enough. A crossing by hand does not count.
        let since = session.changed_at;
        let mut last = session.player.watch().events().iter().rev().take(50);
        let crossed = since > 0.0
            && !session.by_hand
            && last.any(|event| event.kind == EventKind::Crossing && event.t >= since);
        let as_opened = self.is_as_opened(session);
        let is_tried = |from: f64, to: f64| (to - from).abs() >= TRIED_MM && !session.editor.in_gesture();
        self.stage = match (self.stage, session.scene().stops.travel_limit_mm()) {
            (Stage::Cross | Stage::Compare, Some(from_mm)) if crossed && as_opened => Stage::Move { from_mm },
            (Stage::Cross, _) if crossed => Stage::Compare,
            (Stage::Move { .. }, None) => Stage::Compare,
            (Stage::Answer, None) => Stage::Done,
            (Stage::Move { from_mm }, Some(mm)) if is_tried(from_mm, mm) => Stage::Answer,
            (stage, _) => stage,
        };
        self.stage != Stage::Done
    }

    /// Whether the shaking is no stronger than when the scene was opened, but for a point of the slider.
    fn is_as_opened(&self, session: &Session) -> bool {
        self.is_at_most(session, NEARLY)
    }

    /// Whether the shaking is at most so many times as strong as when the scene was opened.
    fn is_at_most(&self, session: &Session, factor: f64) -> bool {
        session.amplitude_g().is_some_and(|g| g.abs() <= self.opened_g.abs() * factor)
    }

    /// What the line says: what happened, and what to try. Statements about the motion concern what the
    /// present scene settles to; while that is not known, there are none.
    pub fn guide(&self, session: &Session) -> Guide {
        let opened = in_unit(session.scene(), as_set, self.opened_g);
        let crosses = session.crosses();
        let (as_opened, fair) = (self.is_as_opened(session), self.is_fair_comparison(session));
        let wait = "Wait for it, or press X to go there.";
        let outward = "Then move the stops outward: how far does that help?";
        let two_things = "Two things help: shake harder, or put stops near the middle.";
        let undo = "What did your last change do? Undo it (Ctrl+Z), or move the stops.";
        let has_limit = session.scene().stops.travel_limit_mm().is_some();
        let (first, then): (_, &str) = match (self.stage, has_limit, as_opened, crosses) {
            (Stage::Cross, _, _, Some(true)) => ("Now it will cross.", wait),
            (Stage::Cross, ..) => ("Make it cross to the other side.", two_things),
            (Stage::Compare | Stage::Move { .. }, false, false, _) => {
                let (first, now) = match crosses {
                    Some(true) if fair => ("Harder shaking made it cross.", "Now go"),
                    _ => ("Now with stops.", "Go"),
                };
                let then = "switch the stops on: what is gained, what does it cost?";
                return Guide::new(first, format!("{now} back to {opened} and {then}"));
            }
            (Stage::Compare | Stage::Move { .. }, false, true, _) => {
                ("Now with stops.", "Switch them on at this shaking: does it cross, and what does it cost?")
            }
            (Stage::Compare | Stage::Move { .. }, true, false, _) => {
                let still = if crosses == Some(true) { " still" } else { "" };
                let then = format!("Go back to {opened} and leave the stops on: does it{still} cross?");
                return Guide::new("Now with less shaking.", then);
            }
            (Stage::Compare, true, true, Some(true)) => ("Between these stops it will cross.", wait),
            (Stage::Compare, true, true, Some(false)) => {
                ("Now move the stops.", "Where must they stand so that it crosses at this shaking?")
            }
            (Stage::Compare, true, true, None) => {
                ("Now with stops.", "Does it cross, and what does it cost?")
            }
            (Stage::Move { .. }, true, true, Some(false)) => ("Now it does not cross.", undo),
            (Stage::Move { .. }, true, true, crosses) => {
                let first = match crosses {
                    Some(_) if fair && self.is_at_most(session, 1.0 + 1e-9) => {
                        "Between these stops it crossed, without more shaking."
                    }
                    Some(_) => "Between these stops it crosses.",
                    None => "Now with stops.",
                };
                return Guide::new(first, format!("Compare the start and now. {outward}"));
            }
            (Stage::Answer, ..) => {
                return Guide { more: particulars(session), ..Guide::new("What stops do:", MIDDLE) };
            }
            (Stage::Done, ..) => ("", ""),
        };
        Guide::new(first, then)
    }

    /// Whether only the shaking and the stops differ from the scene as it was opened.
    fn is_fair_comparison(&self, session: &Session) -> bool {
        let (scene, mut opened) = (session.scene(), session.editor.saved().clone());
        opened.stops = scene.stops;
        if let (Some(amplitude), Some(drive)) = (opened.excitation.amplitude_mut(), scene.harmonic()) {
            *amplitude = drive.amplitude();
        }
        *scene == opened
    }

    pub fn dismiss(&mut self) {
        self.stage = Stage::Done;
    }
}

/// Draws the guide line at the left, in rows that fit, and at the right `buttons`, the last one first.
/// Returns the answer of the buttons.
pub fn guide_ui<R>(ui: &mut Ui, style: &Style, guide: &Guide, buttons: impl FnOnce(&mut Ui) -> R) -> R {
    let right_to_left = Layout::right_to_left(Align::Center);
    let row = ui.allocate_ui_with_layout(ui.available_size(), right_to_left, |ui| {
        let answer = buttons(ui);
        let room = ui.available_rect_before_wrap();
        let (strong, usual) = (strong_family(), FontFamily::Proportional);
        let whole = format!("{} {}", guide.text, guide.more);
        let texts =
            |text| [(guide.heading.as_str(), strong.clone()), ("  ", usual.clone()), (text, usual.clone())];
        let one_row = vec2(room.width(), 0.0);
        let has_room = fitting(ui, &texts(&whole), one_row, BODY).0 == BODY;
        let text = if has_room { whole.trim_end() } else { &guide.text };
        let (size, taken) = fitting(ui, &texts(text), room.size(), BODY);
        let top = ui.max_rect().center().y - 0.5 * taken;
        // a first row is as high as its place
        let place = room.with_min_y(top).with_max_y(top + size);
        let rows = Layout::left_to_right(Align::Min).with_main_wrap(true);
        ui.spacing_mut().interact_size.y = 0.0;
        let mut ui = ui.new_child(UiBuilder::new().max_rect(place).layout(rows));
        ui.spacing_mut().item_spacing = vec2(6.0, 0.0);
        if !guide.heading.is_empty() {
            ui.label(RichText::new(&guide.heading).heading().size(size));
        }
        let color = if guide.is_faint { style.faint() } else { style.ink() };
        let label = ui.label(RichText::new(unbroken(text)).size(size).color(color));
        // a screen reader says all of it
        tell(&label, Role::Label, whole.trim());
        if !has_room && !guide.more.is_empty() {
            label.on_hover_text(&guide.more);
        }
        answer
    });
    row.inner
}

/// What stops do in the present scene, for any travel limit.
fn particulars(session: &Session) -> String {
    let hardest = hardest_mm(session).map(|mm| format!("At \u{b1}{mm:.1} mm it presses hardest."));
    let weak =
        (session.crosses() == Some(false)).then(|| "Here this push does not carry it over.".to_owned());
    hardest.into_iter().chain(weak).collect::<Vec<_>>().join(" ")
}

/// Distance in mm from the middle where the force outwards is largest; `None` if the two sides differ.
fn hardest_mm(session: &Session) -> Option<f64> {
    let landscape = &session.model().mechanism().landscape;
    let barrier = landscape.barrier?;
    let side = |low: f64, high: f64| {
        let between = landscape.extrema.iter().filter(|extremum| extremum.x > low && extremum.x < high);
        let mut places = between.map(|extremum| extremum.x.abs() * 1e3);
        places.next().filter(|_| places.next().is_none())
    };
    let (left, right) = (side(barrier.left_well, barrier.x)?, side(barrier.x, barrier.right_well)?);
    ((left - right).abs() < 0.01 * right).then_some(right)
}
