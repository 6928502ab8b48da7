//! Memory of a window that plays for an hour.

use allocation_counter::measure;
use interwell::app::views::View;
use interwell::app::window::Command;

use crate::screen::Screen;
use crate::support::session;

/// Frames of an hour, and those after which every buffer has its size.
const HOUR: usize = 216_000;
const FULL: usize = 170_000;

/// Bytes that may come and stay without being a leak: a table that grows once more.
const SLACK: i64 = 4096;

#[test]
fn an_hour_of_playing_is_flat() {
    let mut session = session("paper", &[]);
    session.player.speed = 1.0;
    let mut play = |frames: usize| {
        let info = measure(|| {
            for _ in 0..frames {
                session.poll();
                session.player.want_ledgers();
                session.player.tick(1.0 / 60.0);
                session.player.end_frame();
            }
        });
        let watch = session.player.watch();
        (info, watch.samples().len(), watch.events().len(), watch.ledger_count(), watch.time())
    };
    let (first, ..) = play(FULL);
    let (rest, samples, events, ledgers, time) = play(HOUR - FULL);
    assert!((time - 3600.0).abs() < 1e-3, "{time}");
    assert_eq!((samples, events, ledgers), (200_000, 50_000, 10_000));
    assert!(rest.bytes_current <= SLACK, "{rest:?}");
    // and what is held is the path, at most twice as much room as it needs
    assert!(first.bytes_current < 40_000_000, "{first:?}");
}

/// The whole of the past is there, every view is open, and the frames go on.
#[test]
fn frames_keep_nothing() {
    let mut screen = Screen::new("paper", [1400.0, 900.0]);
    for view in View::ALL {
        screen.ask(Command::Show(view, view != View::Map));
    }
    screen.steps(3);
    let player = &mut screen.window.session.player;
    player.speed = 100.0;
    (0..400).for_each(|_| _ = player.tick(0.1));
    player.speed = 1.0;
    assert!(player.watch().samples().len() == 200_000 && player.watch().events().len() == 50_000);
    screen.window.session.wait(crate::support::LONG);
    screen.steps(100);
    let first = measure(|| screen.steps(200));
    let second = measure(|| screen.steps(600));
    // new glyphs and new widths of numbers come now and then, and ever more seldom
    assert!(second.bytes_current < 64_000, "{first:?} {second:?}");
}
