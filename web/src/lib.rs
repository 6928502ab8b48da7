//! The window in a web page, and the worker that answers its questions.
//!
//! `page/page.js` opens the window and has the workers; `page/worker.js` calls [`answer`]. Both load the same
//! module, each into a memory of its own.

#![cfg(target_arch = "wasm32")]

mod tables;

pub(crate) use interwell;

use std::cell::{Cell, RefCell};
use std::sync::atomic::AtomicBool;

use eframe::egui;
use interwell::app::window::leave::Next;
use interwell::app::window::{Command, Window};
use interwell::app::{begin, export, task};
use interwell::scene::lesson::LESSONS;
use interwell::scene::linked_lesson;
use interwell::system::page;
use wasm_bindgen::prelude::*;

#[wasm_bindgen(js_namespace = interwell)]
extern "C" {
    fn ask(name: &str, question: &[u8]) -> u32;
    fn cancel(id: u32);
    fn download(name: &str, bytes: &[u8]);
    fn share() -> usize;
    fn show(link: Option<&str>, title: &str, status: &str, is_step: bool);
}

/// Shortest time in s between two looks at the scene for the address and the status.
const LOOK: f64 = 0.5;

thread_local! {
    static CONTEXT: RefCell<Option<egui::Context>> = const { RefCell::new(None) };
    /// A link that the address has become.
    static LINK: Cell<Option<String>> = const { Cell::new(None) };
    /// What takes the parts of the answer in a worker.
    static EACH: RefCell<Option<js_sys::Function>> = const { RefCell::new(None) };
}

/// The window, whose scene the address follows.
struct Page {
    window: Window,
    looked_at: f64,
    /// The link of what is open; empty without one.
    link: String,
}

impl Page {
    /// Goes to what the address has become: undoes or redoes changes where that leads there, and opens
    /// another scene or lesson where not.
    fn follow_address(&mut self, ctx: &egui::Context) {
        let asked = LINK.take().filter(|link| *link != self.link && !link.is_empty());
        if let Some(link) = asked {
            if linked_lesson(&link).is_none() && self.window.lesson().is_some() {
                self.window.carry_out(ctx, Command::LeaveLesson);
            }
            let session = &mut self.window.session;
            if session.editor.document().link().as_ref() == Ok(&link) || session.go_to(&link) {
                self.link = link;
            } else {
                self.link.clear();
                self.window.leave_for(ctx, Next::Open(link));
            }
        }
    }

    /// Shows the link of the scene as the address, its title and what it does.
    fn show(&mut self, ctx: &egui::Context) {
        let now = ctx.input(|input| input.time);
        if now - self.looked_at < LOOK || self.window.session.editor.in_gesture() {
            return;
        }
        self.looked_at = now;
        let (title, spoken) = (self.window.title(), self.window.spoken());
        // the address that a message or a question may be about stays
        if self.window.waits_for_answer() {
            return show(None, title, spoken, false);
        }
        let link = match self.window.lesson() {
            Some(open) if LESSONS.iter().any(|lesson| lesson.name == open.key()) => {
                format!("?lesson={}", open.key())
            }
            Some(_) => String::new(),
            // a scene with a large file has no link
            None => self.window.session.editor.document().link().unwrap_or_default(),
        };
        // the first scene is no step of the browser's history, nor is what a link opens
        show(Some(&link), title, spoken, !self.link.is_empty());
        self.link = link;
    }
}

impl eframe::App for Page {
    fn logic(&mut self, ctx: &egui::Context, frame: &mut eframe::Frame) {
        self.follow_address(ctx);
        eframe::App::logic(&mut self.window, ctx, frame);
        self.show(ctx);
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        eframe::App::ui(&mut self.window, ui, frame);
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        self.window.clear_color(visuals)
    }

    fn raw_input_hook(&mut self, ctx: &egui::Context, input: &mut egui::RawInput) {
        self.window.raw_input_hook(ctx, input);
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        self.window.save(storage);
    }

    fn persist_egui_memory(&self) -> bool {
        self.window.persist_egui_memory()
    }
}

/// Opens the window in a canvas, on the scene or lesson of a link, which may be empty. `address` is that of
/// the page without a link. The first time it is `dark` or light.
#[wasm_bindgen]
pub async fn open_window(
    canvas: web_sys::HtmlCanvasElement,
    address: String,
    link: String,
    dark: bool,
) -> Result<(), JsValue> {
    page::set_address(address);
    page::set_download(hand_on);
    task::set_workers(task::Workers { ask, cancel, share: share() });
    let options = eframe::WebOptions { dithering: false, ..eframe::WebOptions::default() };
    let start = move |creation: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
        CONTEXT.set(Some(creation.egui_ctx.clone()));
        let window = begin(creation, Some(link.as_str()).filter(|link| !link.is_empty()), dark)?;
        Ok(Box::new(Page { window, looked_at: f64::NEG_INFINITY, link: String::new() }))
    };
    eframe::WebRunner::new().start(canvas, options, Box::new(start)).await
}

/// Hands a file to the page, which hands it to the user.
fn hand_on(name: &str, bytes: &[u8]) -> Result<(), String> {
    download(name, bytes);
    Ok(())
}

/// Opens another scene or lesson, as the address has changed.
#[wasm_bindgen]
pub fn open_link(link: String) {
    LINK.set(Some(link));
    CONTEXT.with_borrow(|context| context.as_ref().map(egui::Context::request_repaint));
}

/// Takes a part of the answer to a question from a worker; without a message there are no more.
#[wasm_bindgen]
pub fn answer_part(id: u32, message: Option<Box<[u8]>>) {
    task::take_part(id, message.as_deref());
}

/// Answers a question in a worker, and passes each part to `each`. Returns what is wrong with the question.
#[wasm_bindgen]
pub fn answer(name: &str, question: &[u8], each: js_sys::Function) -> Option<String> {
    EACH.set(Some(each));
    page::set_download(hand_on);
    let pass = |part: Vec<u8>| {
        let part = js_sys::Uint8Array::from(part.as_slice());
        EACH.with_borrow(|each| each.as_ref().map(|each| each.call1(&JsValue::NULL, &part)));
    };
    export::asked::answer(name, question, &AtomicBool::new(false), &pass).err()
}

/// Tables of a built-in scene as CSV, to be compared with those of a desktop.
#[wasm_bindgen]
pub fn tables_of(preset: &str) -> String {
    tables::tables(preset).unwrap_or_else(|error| error.to_string())
}

/// The sweep that a built-in scene names, as CSV.
#[wasm_bindgen]
pub fn map_of(preset: &str) -> String {
    tables::map(preset).unwrap_or_else(|error| error.to_string())
}
