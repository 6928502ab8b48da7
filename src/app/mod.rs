//! The window: views of a scene, and the controls that change it.
//!
//! No physics is computed here. [`session`] holds the open scene with undo, its live motion and the answers
//! to background questions, and works without a window; the other modules draw it. A view is a function of
//! a [`views::ViewContext`].
//!
//! `docs/architecture.md` says what each module holds. They come in an order, `task`, `words`, `session`,
//! `export`, `ui`, `panels`, `views`, `window`, `desktop`, and each uses only those before it, which
//! `tests/suite/layers.rs` checks. A web page has no `desktop`: the crate `interwell-web` calls [`begin`].

#[cfg(not(target_arch = "wasm32"))]
mod desktop;
pub mod export;
pub mod panels;
pub mod session;
pub mod task;
pub mod ui;
pub mod views;
pub mod window;
pub mod words;

#[cfg(not(target_arch = "wasm32"))]
pub use desktop::{AppError, run};
pub use window::begin;
