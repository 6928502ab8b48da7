//! Background questions of the window.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::channel;
use std::time::Duration;

use interwell::app::task::{Background, Each, Wake};

use crate::support::LONG;

fn wake() -> Wake {
    Arc::new(|| ())
}

fn wait_for(flag: &AtomicBool) {
    while !flag.load(Ordering::Relaxed) {
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// The numbers below `count`.
fn numbers(count: &u32, _: &AtomicBool, each: Each<u32>) -> Option<u32> {
    (0..*count).for_each(each);
    None
}

#[test]
fn a_question_that_is_replaced_or_dropped_is_cancelled() {
    let (sender, cancelled) = channel();
    let mut background = Background::<u32, ()>::default();
    for question in [1, 2] {
        let sender = sender.clone();
        background.ask_job(question, &wake(), move |question, cancel, _| {
            wait_for(cancel);
            sender.send(*question).ok();
            None
        });
    }
    assert_eq!(cancelled.recv_timeout(LONG), Ok(1));
    drop(background);
    assert_eq!(cancelled.recv_timeout(LONG), Ok(2));
}

#[test]
fn an_answer_to_an_older_question_is_not_current() {
    let mut background = Background::default();
    background.ask_job(1, &wake(), |_, _, _| Some(10));
    assert!(background.wait(LONG));
    assert_eq!(background.answer(), Some(&10));
    let (sender, gate) = channel::<()>();
    background.ask_job(2, &wake(), move |_, _, _| gate.recv().ok().map(|()| 20));
    assert_eq!((background.answer(), background.newest()), (None, Some(&10)));
    assert_eq!(background.take(), None);
    sender.send(()).unwrap();
    assert!(background.wait(LONG));
    assert_eq!((background.answer(), background.newest()), (Some(&20), Some(&20)));
    assert_eq!((background.take(), background.take()), (Some(20), None));
    // an answer may have no parts
    background.ask_job(3, &wake(), |_, _, _| None);
    assert!(!background.wait(LONG) && !background.is_running());
    assert_eq!(background.parts(), (&[][..], true));
}

#[test]
fn a_job_that_panics_leaves_no_answer() {
    let mut background = Background::<(), i32>::default();
    background.ask_job((), &wake(), |_, _, _| std::panic::resume_unwind(Box::new("stop")));
    assert!(!background.wait(LONG) && !background.is_running());
}

#[test]
fn the_previous_parts_stay_until_new_ones_come() {
    let mut background = Background::default();
    background.want_job(2, true, &wake(), numbers);
    background.wait(LONG);
    assert_eq!((background.parts(), background.is_whole()), ((&[0, 1][..], true), true));
    background.want_job(3, false, &wake(), |_, _, _| panic!("the scene is being changed"));
    assert_eq!(background.question(), Some(&2));
    let gate = Arc::new(AtomicBool::new(false));
    let passed = Arc::clone(&gate);
    background.want_job(3, true, &wake(), move |_, cancel, each| {
        wait_for(&passed);
        each(7);
        each(8);
        wait_for(cancel);
        None
    });
    assert_eq!((background.parts(), background.is_whole()), ((&[0, 1][..], false), false));
    gate.store(true, Ordering::Relaxed);
    while background.parts() != (&[7, 8][..], true) {
        background.poll();
    }
    // a question that no view asks for is paused, and begins again when a view asks
    background.end_frame();
    assert!(background.is_running());
    background.end_frame();
    assert!(background.is_paused());
    let (sender, gate) = channel::<()>();
    background.want_job(3, true, &wake(), move |count, cancel, each| {
        gate.recv().ok();
        numbers(count, cancel, each)
    });
    // the parts of the same question stay too
    background.poll();
    assert_eq!(background.parts(), (&[7, 8][..], true));
    sender.send(()).unwrap();
    background.wait(LONG);
    assert_eq!(background.parts(), (&[0, 1, 2][..], true));
}

#[test]
fn a_stopped_question_is_begun_again_once_it_may_be() {
    let mut background = Background::default();
    background.want_job(4, true, &wake(), |_, cancel, _| {
        wait_for(cancel);
        None
    });
    assert!(background.running_for().is_some());
    background.stop();
    background.want_job(4, true, &wake(), |_, _, _| panic!("the user has stopped it"));
    assert!(background.is_whole() && background.running_for().is_none());
    background.resume();
    background.want_job(4, true, &wake(), numbers);
    background.wait(LONG);
    assert_eq!(background.parts(), (&[0, 1, 2, 3][..], true));
}
