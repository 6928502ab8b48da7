//! Input on the mass: dragging it, and moving it by the arrow keys.

use eframe::egui::{self, CursorIcon, Pos2, Rect, Sense, Ui};

use crate::app::ui::style::{BALL, GRAB};
use crate::app::ui::widgets::arrows;

use super::ViewContext;
use super::stops::key_step;

/// Distance that an arrow key moves the mass, in steps of a stop's slider; ten times as far with Shift.
const KEY_STEPS: f64 = 2.0;

/// Distance in points of the outline from a mass under the pointer.
pub const OUTLINE: f32 = 2.5;

/// Lets the mass be dragged: it is held at the pointer, and time stands still. With the keyboard focus, the
/// arrow keys hold and move it, and Enter lets it go.
pub fn mass_ui(ui: &mut Ui, context: &mut ViewContext<'_>, at: Pos2, rect: Rect) {
    let grab = Rect::from_center_size(at, egui::Vec2::splat(2.0 * GRAB));
    if body_ui(ui, context, (at, grab), rect) {
        ui.painter().circle_stroke(at, BALL + OUTLINE, context.style.pointing_stroke());
    }
}

/// Like [`mass_ui`], for a mass at `at` that fills `grab`. Returns whether the pointer is over or drags it.
pub fn body_ui(ui: &mut Ui, context: &mut ViewContext<'_>, (at, grab): (Pos2, Rect), rect: Rect) -> bool {
    let response = ui
        .interact(grab.intersect(rect.expand(GRAB)), ui.scope_id().with("mass"), Sense::drag())
        .on_hover_and_drag_cursor(CursorIcon::Grab);
    let mm = context.session.player.state().x * 1e3;
    response.widget_info(|| egui::WidgetInfo::slider(true, mm, "proof mass"));
    if std::mem::take(&mut context.memory.grab) {
        response.request_focus();
        context.session.hold(mm / 1e3);
    }
    if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
        context.session.hold(context.span.world_from_screen(pointer.x, rect));
    }
    if response.drag_started() {
        ui.data_mut(|data| data.insert_temp(dragged(), true));
    }
    let is_left = response.lost_focus() && context.session.player.is_held() && !response.dragged();
    if response.drag_stopped() || is_left {
        context.session.player.let_go();
        context.session.moved_by_hand();
    } else if !response.dragged() && response.has_focus() {
        ui.painter().circle_stroke(at, BALL + 5.0, context.style.focus_stroke());
        let moved = arrows(ui, response.id);
        if moved != 0.0 {
            // rounded to multiples of the step
            let step = KEY_STEPS * key_step(context.session);
            let place = (mm / step).round() + moved;
            context.session.hold(place * step / 1e3);
        }
        if ui.input(|input| input.key_pressed(egui::Key::Enter)) {
            response.surrender_focus();
        }
    }
    ui.is_enabled() && (response.hovered() || response.dragged())
}

fn dragged() -> egui::Id {
    egui::Id::unique("the mass has been dragged")
}

pub fn was_dragged(ui: &Ui) -> bool {
    ui.data(|data| data.get_temp::<bool>(dragged())).is_some()
}
