//! A window that is stepped frame by frame with nothing between: no graphics, no queries, a clock of its own.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use eframe::egui::{Context, Event, FullOutput, Pos2, RawInput, Rect, Vec2, ViewportId, accesskit::Node};
use interwell::app::ui::settings::Settings;
use interwell::app::window::Command;
use interwell::app::window::{Window, prepare};

/// A frame at the usual rate.
const FRAME: f64 = 1.0 / 60.0;

/// A window and what drives it.
pub struct Screen {
    pub ctx: Context,
    pub window: Window,
    /// In pixels of the screen.
    pub size: Vec2,
    /// In s.
    pub time: f64,
    /// What can be pressed, as a screen reader is told it in the last frame.
    pub nodes: Vec<Node>,
    /// How long the last frame may stand.
    pub stands: Duration,
    woken: Arc<AtomicUsize>,
}

impl Screen {
    pub fn new(spec: &str, size: [f32; 2]) -> Self {
        let woken = Arc::new(AtomicUsize::new(0));
        let count = Arc::clone(&woken);
        let wake = Arc::new(move || {
            count.fetch_add(1, Ordering::Relaxed);
        });
        let mut window = Window::open(Some(spec), Settings::default(), wake).unwrap();
        window.without_dialogs();
        let ctx = Context::default();
        prepare(&ctx);
        Self { ctx, window, size: size.into(), time: 0.0, nodes: Vec::new(), stands: Duration::ZERO, woken }
    }

    /// One frame in which these events have come.
    pub fn step(&mut self, events: Vec<Event>) {
        self.time += FRAME;
        let points = self.size / self.ctx.pixels_per_point();
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, points)),
            time: Some(self.time),
            events,
            ..RawInput::default()
        };
        let window = &mut self.window;
        let mut output: FullOutput = self.ctx.run_ui(input, |ui| {
            window.logic(&ui.ctx().clone());
            window.ui(ui);
        });
        // no graphics want them
        output.textures_delta.clear();
        self.stands = output.viewport_output[&ViewportId::ROOT].repaint_delay;
        if let Some(update) = output.platform_output.accesskit_update {
            self.nodes.clear();
            self.nodes.extend(update.nodes.into_iter().map(|entry| entry.1));
        }
    }

    pub fn steps(&mut self, count: usize) {
        (0..count).for_each(|_| self.step(Vec::new()));
    }

    pub fn ask(&mut self, command: Command) {
        self.window.carry_out(&self.ctx, command);
    }

    /// How often another thread has asked for a frame.
    pub fn woken(&self) -> usize {
        self.woken.load(Ordering::Relaxed)
    }
}
