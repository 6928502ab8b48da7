//! Cost of a frame of the window: `cargo bench --bench frames`. The interface is stepped without a window,
//! 1400 by 900 points, playing in real time at 60 frames a second, with everything that the program itself
//! does for a frame: the motion, the layout, the shapes, and their triangles. What the graphics do with
//! these is not in it, but their number is told.

mod shared;

use std::sync::Arc;
use std::time::Duration;

use eframe::egui::epaint::Primitive;
use eframe::egui::{Context, Pos2, RawInput, Rect, vec2};
use interwell::app::ui::settings::Settings;
use interwell::app::views::View;
use interwell::app::window::Command;
use interwell::app::window::{Window, prepare};
use interwell::scene::{Excitation, Layout, Mechanism, SweepAxis};

/// Frames that are measured, after some in which windows find their sizes and glyphs their places.
const FRAMES: usize = 400;
const SETTLING: usize = 30;

/// Frames that are played beside the reference: until its trail is as long as it gets.
const COMPARED: usize = 200;

/// What a frame may take in ms: in the layout that the program opens with, and with every view open.
const LOOK_MS: f64 = 8.0;
const ALL_MS: f64 = 12.0;

/// Cells of the map along an axis, and the run of one in s.
const CELLS: f64 = 40.0;
const CELL_RUN: (f64, f64) = (4.0, 2.0);

/// How long the ramp has been played before it is looked at, in s.
const PLAYED: f64 = 7200.0;

/// Long enough for a map.
const LONG: Duration = Duration::from_secs(600);

/// A scene that is played: what it is called, where it comes from, and what is done to it first.
type Played = (&'static str, &'static str, fn(&mut Window));

const SCENES: [Played; 4] = [
    ("first-look", "first-look", |_| ()),
    ("first-look, stops at 1.5 mm", "first-look", |window| {
        window.session.switch_stops(true);
    }),
    ("paper-ramp after two hours", "paper-ramp", |window| {
        let player = &mut window.session.player;
        player.speed = 100.0;
        for _ in 0..shared::rounds((PLAYED / 10.0) as usize) {
            player.tick(0.1);
        }
    }),
    ("random-shaking", "random-shaking", |_| ()),
];

/// What is open.
#[derive(Clone, Copy)]
enum Open {
    Layout(Layout),
    All,
    Only(Option<View>),
}

/// A window on a scene, without a display.
struct Screen {
    ctx: Context,
    window: Window,
    frame: u32,
    /// Shapes and corners of triangles of the last frame.
    drawn: (usize, usize),
}

impl Screen {
    fn new(preset: &str, first: impl Fn(&mut Window), open: Open) -> Self {
        let window = Window::open(Some(preset), Settings::default(), Arc::new(|| ())).unwrap();
        let ctx = Context::default();
        prepare(&ctx);
        let mut screen = Self { ctx, window, frame: 0, drawn: (0, 0) };
        first(&mut screen.window);
        screen.window.session.player.speed = 1.0;
        if matches!(open, Open::All | Open::Only(Some(View::Map)) | Open::Layout(Layout::Map)) {
            // among other views it may lie behind them, and is not computed then
            screen.open(Open::Only(Some(View::Map)));
            screen.fill_map();
        }
        screen.open(open);
        for _ in 0..SETTLING {
            screen.step();
        }
        screen.window.session.wait(LONG);
        screen.fill_explored();
        screen
    }

    /// Waits for what views of the layout Explore work out, where any is open.
    fn fill_explored(&mut self) {
        let is_running = |window: &Window| {
            let explore = &window.session.explore;
            explore.walks.found.is_running()
                || explore.basins.is_running()
                || explore.spectra.found.is_running()
        };
        while shared::is_measured() && is_running(&self.window) {
            std::thread::sleep(Duration::from_millis(20));
            self.step();
        }
    }

    /// Changes the scene, and has the motion go on for a while beside the reference.
    fn compare(&mut self) {
        shake(&mut self.window, 1.1);
        self.window.session.end_gesture();
        (0..COMPARED).for_each(|_| self.step());
        self.window.session.wait(LONG);
        self.fill_explored();
        assert!(self.window.session.reference.apart().is_some());
    }

    fn open(&mut self, open: Open) {
        match open {
            Open::Layout(layout) => self.ask(Command::Arrange(layout)),
            Open::All => {
                self.open(Open::Only(None));
                View::ALL.into_iter().for_each(|view| self.ask(Command::Show(view, true)));
            }
            Open::Only(only) => {
                View::ALL.into_iter().for_each(|view| self.ask(Command::Show(view, only == Some(view))));
            }
        }
    }

    fn ask(&mut self, command: Command) {
        self.window.carry_out(&self.ctx, command);
    }

    /// Has a map of runs made that are shorter than the scene's own, which costs the view the same.
    fn fill_map(&mut self) {
        let session = &mut self.window.session;
        session
            .edit_once(|scene| (scene.run.duration_s, scene.run.settle_s) = (CELL_RUN.0, Some(CELL_RUN.1)));
        let cells = if shared::is_measured() { CELLS } else { 2.0 };
        let axes = session.map_axes().map(|axes| {
            axes.map(|axis| {
                let step = (axis.to - axis.from) / cells;
                // a seed is whole
                let step = if axis.field.ends_with("seed") { step.ceil() } else { step };
                SweepAxis { step, ..axis }
            })
        });
        session.map.choose(axes);
        self.step();
        assert!(self.window.session.wait_for_map(LONG), "{:?}", self.window.session.map.problem);
    }

    /// A frame as the program does it, and its triangles.
    fn step(&mut self) {
        self.frame += 1;
        let time = f64::from(self.frame) / 60.0;
        let screen_rect = Some(Rect::from_min_size(Pos2::ZERO, vec2(1400.0, 900.0)));
        let input = RawInput { screen_rect, time: Some(time), ..RawInput::default() };
        let window = &mut self.window;
        let mut output = self.ctx.run_ui(input, |ui| {
            let ctx = ui.ctx().clone();
            window.logic(&ctx);
            window.ui(ui);
        });
        // no graphics want them
        output.textures_delta.clear();
        let shapes = output.shapes.len();
        let meshes = std::hint::black_box(self.ctx.tessellate(output.shapes, output.pixels_per_point));
        let corners = meshes.iter().map(|clipped| match &clipped.primitive {
            Primitive::Mesh(mesh) => mesh.vertices.len(),
            Primitive::Callback(_) => 0,
        });
        self.drawn = (shapes, corners.sum());
        assert!(window.session.player.is_playing(), "it plays");
    }
}

fn main() {
    println!("CPU time of the window's own thread for a frame, in ms; 1400 x 900, playing in real time.\n");
    println!("| scene | open | median | 95 % | worst | allowed | shapes | corners |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    let layouts = [
        ("Look", Open::Layout(Layout::Look), Some(LOOK_MS)),
        ("Study", Open::Layout(Layout::Study), Some(ALL_MS)),
        ("Map, filled", Open::Layout(Layout::Map), Some(ALL_MS)),
        ("all views", Open::All, Some(ALL_MS)),
    ];
    for (name, preset, first) in SCENES {
        for (what, open, allowed) in layouts {
            let mut screen = Screen::new(preset, first, open);
            row((name, what, allowed), &mut screen, |_, _| ());
        }
    }
    let (_, preset, stops_on) = SCENES[1];
    let mut none = Screen::new(preset, stops_on, Open::Only(None));
    row((SCENES[1].0, "no view", None), &mut none, |_, _| ());
    for view in View::ALL {
        let mut screen = Screen::new(preset, stops_on, Open::Only(Some(view)));
        row((SCENES[1].0, &format!("only {}", view.name()), None), &mut screen, |_, _| ());
    }
    for (what, open, allowed) in [
        ("Study, reference", Open::Layout(Layout::Study), Some(LOOK_MS)),
        ("Explore, reference", Open::Layout(Layout::Explore), Some(LOOK_MS)),
        ("all views, reference", Open::All, Some(ALL_MS)),
        ("only Compare, reference", Open::Only(Some(View::Compare)), None),
        ("only Displacement, reference", Open::Only(Some(View::Displacement)), None),
        ("only Phase portrait, reference", Open::Only(Some(View::PhasePortrait)), None),
    ] {
        let mut screen = Screen::new(preset, stops_on, open);
        screen.compare();
        row((SCENES[1].0, what, allowed), &mut screen, |_, _| ());
    }
    let shaken = |window: &mut Window, frame: usize| shake(window, 0.6 + 1e-3 * (frame % 500) as f64);
    let preloaded = |window: &mut Window, frame: usize| {
        let changed = window.session.edit_mechanism(|mechanism| {
            if let Mechanism::Flexures { preload_mm, .. } = mechanism {
                *preload_mm = 2.5 + 1e-3 * (frame % 400) as f64;
            }
        });
        changed.unwrap();
    };
    for (open, what, allowed) in [
        (Open::Layout(Layout::Look), "Look", LOOK_MS),
        (Open::Layout(Layout::Study), "Study", ALL_MS),
        (Open::All, "all views", ALL_MS),
    ] {
        let mut screen = Screen::new(preset, stops_on, open);
        row((SCENES[1].0, &format!("{what}, shaking dragged"), Some(allowed)), &mut screen, shaken);
        let mut screen = Screen::new(preset, stops_on, open);
        row((SCENES[1].0, &format!("{what}, preload dragged"), Some(allowed)), &mut screen, preloaded);
    }
}

/// Turns the shaking of a sine, as a drag does.
fn shake(window: &mut Window, amplitude: f64) {
    window.session.edit(|scene| {
        if let Excitation::Sine { amplitude_g, .. } = &mut scene.excitation {
            *amplitude_g = amplitude;
        }
    });
}

/// Measures frames, before each of which something is done that belongs to it, and writes a row.
fn row(
    (scene, what, allowed): (&str, &str, Option<f64>),
    screen: &mut Screen,
    mut each: impl FnMut(&mut Window, usize),
) {
    let mut times: Vec<f64> = (0..shared::rounds(FRAMES))
        .map(|frame| {
            1e3 * shared::cpu(|| {
                each(&mut screen.window, frame);
                screen.step();
            })
        })
        .collect();
    let [median, most, worst] = [0.5, 0.95, 1.0].map(|share| shared::quantile(&mut times, share));
    let allowed =
        allowed.map_or_else(String::new, |ms| format!("{ms:.0}{}", if most > ms { ", over" } else { "" }));
    let (shapes, corners) = screen.drawn;
    println!(
        "| {scene} | {what} | {median:.2} | {most:.2} | {worst:.2} | {allowed} | {shapes} | {corners} |"
    );
}
