//! Thousands of random acts of a hand. The window has to survive all of them with numbers that are numbers,
//! a scene that is what its text says, and a motion that goes on when it is told to.
//!
//! `INTERWELL_SEED` and `INTERWELL_INTERACTIONS` ask for another or a longer stream.

use std::collections::VecDeque;

use eframe::egui::{
    Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, Rect, TouchPhase, Vec2, accesskit::Role,
    pos2, vec2,
};
use interwell::app::session::editor::Editor;
use interwell::app::session::player::SPEEDS;
use interwell::app::ui::settings::Setting;
use interwell::app::views::View;
use interwell::app::window::{Command, Wanted};
use interwell::scene::lesson::LESSONS;
use interwell::scene::{Layout, PRESETS, Scene, SweepAxis};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

use crate::screen::Screen;

const SEED: u64 = 20;
const INTERACTIONS: usize = 10_000;

/// Interactions after which the motion has to go on when it is told to.
const EVERY: usize = 500;

/// The most cells of a map along an axis, so that making it takes no longer than looking at it.
const CELLS: f64 = 3.0;

/// In pixels: from what a tiling desktop may leave of a window to a large screen.
const SIZES: [[f32; 2]; 8] = [
    [1280.0, 720.0],
    [1920.0, 1080.0],
    [853.0, 480.0],
    [640.0, 400.0],
    [1400.0, 900.0],
    [2560.0, 1440.0],
    [300.0, 700.0],
    [70.0, 50.0],
];

const KEYS: [Key; 28] = [
    Key::Space,
    Key::Period,
    Key::Home,
    Key::PageUp,
    Key::PageDown,
    Key::Z,
    Key::C,
    Key::G,
    Key::Y,
    Key::S,
    Key::O,
    Key::Q,
    Key::F1,
    Key::F11,
    Key::Num1,
    Key::Num2,
    Key::Num3,
    Key::Num4,
    Key::Num5,
    Key::Num7,
    Key::R,
    Key::X,
    Key::End,
    Key::Tab,
    Key::Enter,
    Key::Escape,
    Key::ArrowLeft,
    Key::ArrowRight,
];

const TYPED: [&str; 18] = [
    "0", "1", "-1", "0.5", "2.2", "7", "30", "1e3", "1e9", "1e-9", "-1e300", "1e300", "inf", "nan", "-", "",
    "abc", "0,5",
];

/// What is done, and what is still to be done of a longer gesture.
struct Hand {
    random: ChaCha8Rng,
    seed: u64,
    done: usize,
    at: Pos2,
    coming: VecDeque<Vec<Event>>,
    last: VecDeque<String>,
}

impl Drop for Hand {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let last: Vec<&str> = self.last.iter().map(String::as_str).collect();
            eprintln!("INTERWELL_SEED={} failed at {} after\n{}", self.seed, self.done, last.join("\n"));
        }
    }
}

impl Hand {
    fn new(seed: u64) -> Self {
        let random = ChaCha8Rng::seed_from_u64(seed);
        Self { random, seed, done: 0, at: pos2(0.0, 0.0), coming: VecDeque::new(), last: VecDeque::new() }
    }

    fn below(&mut self, count: usize) -> usize {
        self.random.next_u32() as usize % count
    }

    fn pick<T: Clone>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())].clone()
    }

    fn share(&mut self) -> f32 {
        self.below(1 << 16) as f32 / 65536.0
    }

    /// Half a point in any direction.
    fn anywhere(&mut self) -> Vec2 {
        let x = self.share() - 0.5;
        vec2(x, self.share() - 0.5)
    }

    fn note(&mut self, what: String) {
        self.last.push_back(what);
        if self.last.len() > 30 {
            self.last.pop_front();
        }
    }

    /// A place in the window, or in something that can be pressed.
    fn place(&mut self, screen: &Screen, wanted: impl Fn(Role) -> bool) -> Pos2 {
        let nodes: Vec<Rect> =
            screen.nodes.iter().filter(|node| wanted(node.role())).filter_map(bounds).collect();
        let points = screen.size / screen.ctx.pixels_per_point();
        let within = if nodes.is_empty() || self.below(4) == 0 {
            Rect::from_min_size(Pos2::ZERO, points).expand(5.0)
        } else {
            self.pick(&nodes)
        };
        within.min + vec2(self.share(), self.share()) * within.size()
    }

    fn button(&self, at: Pos2, button: PointerButton, pressed: bool) -> Event {
        Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::NONE }
    }

    fn modifiers(&mut self) -> Modifiers {
        self.pick(&[Modifiers::NONE, Modifiers::NONE, Modifiers::COMMAND, Modifiers::SHIFT])
    }

    /// The next thing that is done. What is more than an event is done to the window at once.
    fn act(&mut self, screen: &mut Screen) -> Vec<Event> {
        if let Some(next) = self.coming.pop_front() {
            return next;
        }
        let (kind, button) = (self.below(100), PointerButton::Primary);
        match kind {
            0..=14 => {
                self.at = self.place(screen, |_| true);
                vec![Event::PointerMoved(self.at)]
            }
            15..=39 => {
                self.at = self.place(screen, |role| role != Role::Label);
                let button = if self.below(8) == 0 { PointerButton::Secondary } else { button };
                for _ in 0..=self.below(2) {
                    self.coming.push_back(vec![self.button(self.at, button, true)]);
                    self.coming.push_back(vec![self.button(self.at, button, false)]);
                }
                vec![Event::PointerMoved(self.at)]
            }
            40..=59 => {
                self.at = self.place(screen, |role| role == Role::Slider || role == Role::Splitter);
                self.coming.push_back(vec![self.button(self.at, button, true)]);
                for _ in 0..=self.below(4) {
                    let step = 120.0 * self.anywhere();
                    self.at += step;
                    self.coming.push_back(vec![Event::PointerMoved(self.at)]);
                }
                self.coming.push_back(vec![self.button(self.at, button, false)]);
                vec![Event::PointerMoved(self.at)]
            }
            60..=69 => self.type_number(screen),
            70..=73 => self.wheel(),
            74..=88 => {
                let (key, modifiers) = (self.pick(&KEYS), self.modifiers());
                self.press(key, modifiers)
            }
            89 => vec![self.pick(&[Event::Copy, Event::PointerGone, Event::WindowFocused(false)])],
            90 => {
                let text = self.pick(PRESETS).text;
                let cut = if self.below(2) == 0 { text.len() } else { self.below(text.len()) };
                vec![Event::Paste(text.chars().take(cut).collect())]
            }
            91..=92 => {
                screen.size = self.pick(&SIZES).into();
                vec![]
            }
            _ => {
                let command = self.command(screen);
                self.note(format!("{command:?}"));
                screen.ask(command);
                vec![]
            }
        }
    }

    fn press(&mut self, key: Key, modifiers: Modifiers) -> Vec<Event> {
        let event = |pressed| Event::Key { key, physical_key: None, pressed, repeat: false, modifiers };
        vec![
            Event::ModifiersChanged(modifiers),
            event(true),
            event(false),
            Event::ModifiersChanged(Modifiers::NONE),
        ]
    }

    /// A number typed into a field, and left in one of the ways in which one leaves a field.
    fn type_number(&mut self, screen: &Screen) -> Vec<Event> {
        self.at = self.place(screen, |role| matches!(role, Role::SpinButton | Role::TextInput));
        let (button, text) = (PointerButton::Primary, self.pick(&TYPED));
        self.coming.push_back(vec![self.button(self.at, button, true)]);
        self.coming.push_back(vec![self.button(self.at, button, false)]);
        let all = self.press(Key::A, Modifiers::COMMAND);
        self.coming.push_back(all);
        self.coming.push_back(vec![Event::Text(text.to_owned())]);
        let leave = self.pick(&[Key::Enter, Key::Tab, Key::Escape]);
        let leave = self.press(leave, Modifiers::NONE);
        self.coming.push_back(leave);
        vec![Event::PointerMoved(self.at)]
    }

    fn wheel(&mut self) -> Vec<Event> {
        let delta = 600.0 * self.anywhere();
        let (unit, phase) = (MouseWheelUnit::Point, TouchPhase::Move);
        let source = eframe::egui::MouseWheelSource::Wheel;
        let modifiers = self.modifiers();
        vec![Event::MouseWheel { unit, delta, phase, source, modifiers }]
    }

    fn command(&mut self, screen: &Screen) -> Command {
        let settings = [Setting::Dark, Setting::Projector, Setting::ReduceMotion];
        match self.below(24) {
            0..=3 => Command::OpenPreset(self.pick(PRESETS).name),
            4 => Command::OpenRecent(self.pick(PRESETS).name.to_owned()),
            5 => Command::Toggle(self.pick(&settings)),
            6..=9 => Command::Show(self.pick(&View::ALL), self.below(2) == 0),
            10 => Command::Arrange(self.pick(&[Layout::Look, Layout::Study, Layout::Map])),
            11 => self.pick(&[Command::KeepOwn, Command::ArrangeOwn]),
            12 => Command::Speed(self.below(SPEEDS.len() + 1)),
            13 => Command::Undo,
            14 => Command::Redo,
            15 => Command::Grab,
            16 => Command::Fill,
            17 => Command::Cover,
            18 => Command::CopyCommand,
            19 => Command::CopyMapCommand,
            20 if self.below(4) == 0 => Command::OpenLesson(self.pick(LESSONS).name),
            20 => self.pick(&[
                Command::Notes,
                Command::NextTab,
                Command::Choose(Wanted::Run),
                Command::Save,
                Command::Choose(Wanted::Save),
                Command::Choose(Wanted::Map),
                Command::Choose(Wanted::Picture),
                Command::LeaveLesson,
                Command::LessonAnew,
                Command::CopyAnswers,
                Command::LecturerNotes,
                Command::Glossary,
            ]),
            21 => self.pick(&[Command::About, Command::Shortcuts, Command::Quit]),
            22 if screen.window.session.player.is_playing() => Command::Step,
            _ => Command::PlayPause,
        }
    }
}

fn bounds(node: &eframe::egui::accesskit::Node) -> Option<Rect> {
    let bounds = node.bounds()?;
    let rect = Rect::from_min_max(
        pos2(bounds.x0 as f32, bounds.y0 as f32),
        pos2(bounds.x1 as f32, bounds.y1 as f32),
    );
    (rect.is_finite() && rect.size() != Vec2::ZERO).then_some(rect)
}

/// A map that takes no longer than it must.
fn keep_map_small(screen: &mut Screen) {
    let session = &mut screen.window.session;
    let Some(axes) = session.map_axes() else { return };
    let few = |axis: &SweepAxis| axis.to - axis.from <= axis.step * CELLS;
    let fewer = |axis: SweepAxis| {
        let step = (axis.to - axis.from) / CELLS;
        SweepAxis { step: if axis.field.ends_with("seed") { step.ceil() } else { step }, ..axis }
    };
    if !axes.iter().all(few) {
        session.map.choose(Some(axes.map(fewer)));
    }
}

/// What holds whatever was done.
fn holds(screen: &Screen, seen: &mut Scene) {
    let session = &screen.window.session;
    let (player, state) = (&session.player, session.player.state());
    let numbers =
        [state.t, state.x, state.v, state.base_accel, player.time(), player.speed, session.changed_at];
    assert!(numbers.iter().all(|number| number.is_finite()), "{state:?}\n{:?}", session.editor.text());
    let ledger = player.watch().ledger();
    let energies = [ledger.work_j, ledger.by_hand_j, ledger.damping_j, ledger.impact_j, ledger.stored_j];
    assert!(energies.iter().all(|joule| joule.is_finite()), "{ledger:?}\n{:?}", session.editor.text());
    let runnable = &session.editor.runnable().scene;
    if runnable != seen {
        let text = session.editor.text().unwrap();
        let again = Editor::from_text(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(again.scene(), runnable, "{text}");
        runnable.clone_into(seen);
    }
}

/// Told to go on from the start, the motion goes on.
fn goes_on(screen: &mut Screen, hand: &mut Hand) {
    let up = hand.button(hand.at, PointerButton::Primary, false);
    screen.step(vec![up, hand.button(hand.at, PointerButton::Secondary, false), Event::WindowFocused(true)]);
    screen.ask(Command::LeaveLesson);
    screen.ask(Command::BackToStart);
    let mut time = 0.0;
    for frame in 0..4 {
        screen.step(Vec::new());
        let player = &screen.window.session.player;
        assert!(player.time() > time, "stuck in frame {frame}: {:?}", screen.window.session.fault());
        time = player.time();
    }
}

fn asked<T: std::str::FromStr>(name: &str, otherwise: T) -> T {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(otherwise)
}

#[test]
fn the_window_stands_what_hands_do() {
    // a figure that the hands save lies in the folder of the process
    std::env::set_current_dir(env!("CARGO_TARGET_TMPDIR")).unwrap();
    let mut hand = Hand::new(asked("INTERWELL_SEED", SEED));
    let mut screen = Screen::new("first-look", SIZES[0]);
    screen.ctx.enable_accesskit();
    let mut seen = screen.window.session.scene().clone();
    let mut scenes = 0;
    for done in 1..=asked("INTERWELL_INTERACTIONS", INTERACTIONS) {
        hand.done = done;
        keep_map_small(&mut screen);
        let events = hand.act(&mut screen);
        if !events.is_empty() {
            hand.note(format!("{events:?}"));
        }
        screen.step(events);
        scenes += usize::from(*screen.window.session.scene() != seen);
        holds(&screen, &mut seen);
        if done % EVERY == 0 {
            goes_on(&mut screen, &mut hand);
        }
    }
    assert!(scenes > hand.done / 50, "the hands hardly reach the scene: {scenes} changes");
}
