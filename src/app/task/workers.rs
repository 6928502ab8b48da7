//! Workers of a web page, which share no memory with the window: a question and the parts of its
//! answer travel as text.

use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::OnceLock;
use std::sync::mpsc::{Receiver, Sender, channel};

use super::{Question, Wake, from_text, to_text};

/// How the page reaches its workers.
pub struct Workers {
    /// Asks the question of this name; returns its number.
    pub ask: fn(&str, &str) -> u32,
    /// Cancels the question of this number.
    pub cancel: fn(u32),
}

static WORKERS: OnceLock<Workers> = OnceLock::new();

/// What takes the text of a part.
type Take = Box<dyn Fn(&str)>;

thread_local! {
    /// What takes the parts of the questions under way.
    static UNDER_WAY: RefCell<HashMap<u32, (Take, Wake)>> = RefCell::default();
}

/// Sets the workers; to be called once, before the window opens.
pub fn set_workers(workers: Workers) {
    let _ = WORKERS.set(workers);
}

/// Takes a part of an answer from a worker; without text there are no more.
pub fn take_part(number: u32, text: Option<&str>) {
    let wake = UNDER_WAY.with_borrow_mut(|under_way| match text {
        Some(text) => under_way.get(&number).map(|(take, wake)| {
            take(text);
            Arc::clone(wake)
        }),
        None => under_way.remove(&number).map(|(_, wake)| wake),
    });
    if let Some(wake) = wake {
        wake();
    }
}

/// A question under way; dropping it cancels it.
#[derive(Debug)]
pub(super) struct Asked(u32);

impl Asked {
    /// Asks a question. Returns it with the parts of its answer as they come; `None` if it cannot be sent.
    pub fn new<Q: Question>(question: &Q, wake: &Wake) -> Option<(Self, Receiver<Q::Part>)> {
        let (workers, text) = (WORKERS.get()?, to_text(question).ok()?);
        let (sender, parts): (Sender<Q::Part>, _) = channel();
        let take = move |text: &str| {
            if let Ok(part) = from_text(text) {
                // the receiver is gone once the question is dropped
                let _ = sender.send(part);
            }
        };
        let number = (workers.ask)(Q::NAME, &text);
        UNDER_WAY.with_borrow_mut(|under_way| {
            under_way.insert(number, (Box::new(take), Arc::clone(wake)));
        });
        Some((Self(number), parts))
    }
}

impl Drop for Asked {
    fn drop(&mut self) {
        let was_under_way = UNDER_WAY.with_borrow_mut(|under_way| under_way.remove(&self.0)).is_some();
        if let Some(workers) = WORKERS.get().filter(|_| was_under_way) {
            (workers.cancel)(self.0);
        }
    }
}
