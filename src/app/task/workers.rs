//! Workers of a web page, which share no memory with the window: a question and the parts of its
//! answer travel as messages.

use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::OnceLock;
use std::sync::mpsc::{Receiver, Sender, channel};

use super::{Question, Wake, from_message, to_message};

/// How the page reaches its workers.
pub struct Workers {
    /// Asks the question of this name; returns its number.
    pub ask: fn(&str, &[u8]) -> u32,
    /// Cancels the question of this number.
    pub cancel: fn(u32),
    /// Number of questions into which a long question is divided.
    pub share: usize,
}

static WORKERS: OnceLock<Workers> = OnceLock::new();

/// Callback for a part of an answer.
type Take = Box<dyn Fn(&[u8])>;

thread_local! {
    /// Callbacks for the parts of the questions that are being answered.
    static UNDER_WAY: RefCell<HashMap<u32, (Take, Wake)>> = RefCell::default();
}

/// Sets the workers; to be called once, before the window opens.
pub fn set_workers(workers: Workers) {
    let _ = WORKERS.set(workers);
}

/// Passes on a part of an answer from a worker; without a message the answer is complete.
pub fn take_part(number: u32, message: Option<&[u8]>) {
    let wake = UNDER_WAY.with_borrow_mut(|under_way| match message {
        Some(message) => under_way.get(&number).map(|(take, wake)| {
            take(message);
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

/// Asks a question of as many workers as it can be divided over. Returns the questions with the parts of
/// their answers as they come; `None` if one cannot be sent.
pub(super) fn ask<Q: Question>(question: &Q, wake: &Wake) -> Option<(Vec<Asked>, Receiver<Q::Part>)> {
    let workers = WORKERS.get()?;
    let (sender, parts) = channel();
    let ask = |question: &Q| {
        let message = to_message(question).ok()?;
        let sender: Sender<Q::Part> = sender.clone();
        let take = move |message: &[u8]| {
            if let Ok(part) = from_message(message) {
                // the receiver is gone once the question is dropped
                let _ = sender.send(part);
            }
        };
        let number = (workers.ask)(Q::NAME, &message);
        UNDER_WAY.with_borrow_mut(|under_way| {
            under_way.insert(number, (Box::new(take), Arc::clone(wake)));
        });
        Some(Asked(number))
    };
    let asked: Option<Vec<Asked>> = question.divide(workers.share).iter().map(ask).collect();
    Some((asked?, parts))
}

impl Drop for Asked {
    fn drop(&mut self) {
        let was_under_way = UNDER_WAY.with_borrow_mut(|under_way| under_way.remove(&self.0)).is_some();
        if let Some(workers) = WORKERS.get().filter(|_| was_under_way) {
            (workers.cancel)(self.0);
        }
    }
}
