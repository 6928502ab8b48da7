//! The hands on the flexures: preload, thickness, lengths, widths.
//!
//! A change is solved before it is made: one that has no solution leaves the mechanism as it is, and says so at its
//! own slider.

use eframe::egui::{self, RichText, Ui};

use crate::scene::{FlexureGroup, Mechanism};

use super::session::Session;
use super::style::Style;
use super::widgets::Knob;

/// The preload that the slider reaches, as a share of the shorter flexure; beyond a quarter the stable branch may end.
const MOST_PRELOAD: f64 = 0.2;

/// A number of a mechanism of flexures.
type Place = fn(&mut Mechanism) -> Option<&mut f64>;

/// The slider of the preload; for a mechanism without one greyed, with the reason. Whether something changed.
pub fn preload_ui(ui: &mut Ui, session: &mut Session, style: &Style, width: f32) -> bool {
    let shorter = match &session.scene().mechanism {
        Mechanism::Flexures { parallel, buckling, .. } => parallel.length_mm.min(buckling.length_mm),
        Mechanism::Table { .. } => {
            return absent_ui(ui, "preload", "The force comes from a table, which was made at one preload.");
        }
        _ => return absent_ui(ui, "preload", "The force is given by a formula without a preload."),
    };
    let knob = Knob {
        name: "preload",
        unit: " mm",
        range: (0.0, ((MOST_PRELOAD * shorter) * 20.0).round() / 20.0),
        step: 0.05,
        decimals: 2,
        hover: "Increase: the flexures are pushed together further. The wells move apart and get deeper, so that it takes \
                more shaking to cross; at 0 there is one well.",
        width,
    };
    size_ui(ui, session, style, &knob, |mechanism| match mechanism {
        Mechanism::Flexures { preload_mm, .. } => Some(preload_mm),
        _ => None,
    })
}

/// The sliders of the other sizes. Whether something changed.
pub fn sizes_ui(ui: &mut Ui, session: &mut Session, style: &Style, width: f32) -> bool {
    if !matches!(session.scene().mechanism, Mechanism::Flexures { .. }) {
        let why = "The mechanism of this scene is a force without flexures behind it.";
        return absent_ui(ui, "sizes of flexures", why);
    }
    let knob = |name, hover, (from, to): (f64, f64), step, decimals| Knob {
        name,
        unit: " mm",
        range: (from, to),
        step,
        decimals,
        hover,
        width,
    };
    let thicker = "Increase: forces grow with the third power of it, and the wells stay where they are.";
    let longer =
        "Increase: the parallel flexures give way more easily: the barrier grows, the wells move apart.";
    let wider = "Increase: the parallel flexures are stiffer, which works against the two wells.";
    let buckling =
        "Increase: the buckling flexure bulges more easily and pushes less: the barrier gets lower.";
    let broader = "Increase: the buckling flexure pushes harder: the barrier grows.";
    let knobs: [(Knob<'_>, Place); 5] = [
        (knob("thickness", thicker, (0.02, 0.5), 0.005, 3), |mechanism| match mechanism {
            Mechanism::Flexures { thickness_mm, .. } => Some(thickness_mm),
            _ => None,
        }),
        (knob("parallel flexures, length", longer, (10.0, 60.0), 0.1, 1), |mechanism| {
            parallel(mechanism).map(|group| &mut group.length_mm)
        }),
        (knob("parallel flexures, width", wider, (1.0, 60.0), 0.1, 1), |mechanism| {
            parallel(mechanism).map(|group| &mut group.width_mm)
        }),
        (knob("buckling flexure, length", buckling, (10.0, 60.0), 0.1, 1), |mechanism| {
            bulging(mechanism).map(|group| &mut group.length_mm)
        }),
        (knob("buckling flexure, width", broader, (1.0, 60.0), 0.1, 1), |mechanism| {
            bulging(mechanism).map(|group| &mut group.width_mm)
        }),
    ];
    let mut changed = false;
    for (knob, place) in &knobs {
        changed |= size_ui(ui, session, style, knob, *place);
    }
    changed
}

fn parallel(mechanism: &mut Mechanism) -> Option<&mut FlexureGroup> {
    match mechanism {
        Mechanism::Flexures { parallel, .. } => Some(parallel),
        _ => None,
    }
}

fn bulging(mechanism: &mut Mechanism) -> Option<&mut FlexureGroup> {
    match mechanism {
        Mechanism::Flexures { buckling, .. } => Some(buckling),
        _ => None,
    }
}

fn size_ui(ui: &mut Ui, session: &mut Session, style: &Style, knob: &Knob<'_>, place: Place) -> bool {
    let mut present = session.scene().mechanism.clone();
    let Some(value) = place(&mut present).map(|value| *value) else { return false };
    let done = knob.ui(ui, value);
    let refused = ui.scope_id().with(("refused", knob.name));
    let mut changed = false;
    if let Some(wanted) = done.value {
        changed = session.edit_mechanism(|mechanism| {
            if let Some(own) = place(mechanism) {
                *own = wanted;
            }
        });
        ui.data_mut(|data| data.insert_temp(refused, session.refused().map(|_| wanted)));
    }
    if done.ended {
        session.end_gesture();
    }
    // said at the slider that asked for it, until something else can be solved
    if let (Some(why), Some(Some(wanted))) =
        (session.refused(), ui.data(|data| data.get_temp::<Option<f64>>(refused)))
    {
        let text = format!("{wanted:.*}{} was not taken: {why}", knob.decimals, knob.unit);
        ui.add(egui::Label::new(RichText::new(text).small().color(style.impact())).wrap());
    }
    changed
}

fn absent_ui(ui: &mut Ui, name: &str, why: &str) -> bool {
    ui.add_enabled(false, egui::Label::new(name)).on_disabled_hover_text(why);
    false
}
