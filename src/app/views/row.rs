//! The row of a card that its titles, a legend or the choices of a view, and its tools share.

use eframe::egui::{Rect, Ui};

/// The part of a card's row that is free for a legend or choices, between the titles and the tools.
#[derive(Debug, Clone, Copy)]
pub struct LegendRow {
    pub left: f32,
    pub right: f32,
}

impl LegendRow {
    /// Height in points of the row of a legend.
    pub const HEIGHT: f32 = 22.0;

    /// The tag of a [`Ui`] in which views have their legends in the row of the card.
    pub const TAG: &'static str = "legend row";

    /// The free part of the row of the card, if it is the upper row of the view.
    pub fn given(ui: &Ui) -> Option<Self> {
        ui.stack().iter().find_map(|ui| ui.tags().get_downcast::<Self>(Self::TAG).copied())
    }

    /// The free part of the upper row of `area`, which is the row of the card if a legend fits there.
    pub fn of(ui: &Ui, area: Rect) -> Self {
        let row = Self::given(ui);
        let whole = Self { left: area.left(), right: area.right() };
        row.map_or(whole, |row| Self { left: row.left.max(whole.left), right: row.right.min(whole.right) })
    }
}
