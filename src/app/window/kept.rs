//! What the window keeps from one start of the program to the next.

use eframe::{Storage, get_value, set_value};

use super::Window;
use super::size::WindowSize;

/// Names under which are kept: the scene files opened last, the window's size in points at the zoom 1, a
/// person's own arrangement, and what was done in lessons.
const RECENT: &str = "recent";
const SIZE: &str = "size";
const OWN: &str = "arrangement";
const LESSONS: &str = "lessons";

impl Window {
    /// Takes over what was kept, apart from the settings.
    pub fn restore(&mut self, storage: &dyn Storage) {
        self.recent = get_value(storage, RECENT).unwrap_or_default();
        self.restore_size(get_value(storage, SIZE));
        self.own = get_value(storage, OWN);
        self.set_records(get_value(storage, LESSONS).unwrap_or_default());
    }

    pub(super) fn keep(&self, storage: &mut dyn Storage) {
        set_value(storage, eframe::APP_KEY, &self.settings);
        set_value(storage, RECENT, &self.recent);
        set_value(storage, LESSONS, &self.records());
        if let Some(size) = self.size() {
            set_value(storage, SIZE, &size);
        }
        if let Some(own) = &self.own {
            set_value(storage, OWN, own);
        }
    }

    /// Has the window be of a size that was kept: none at the first start.
    pub fn restore_size(&mut self, size: Option<[f32; 2]>) {
        self.place = WindowSize::restored(size);
    }

    /// The size in points at the zoom 1 that is to be kept.
    pub fn size(&self) -> Option<[f32; 2]> {
        self.place.size()
    }
}
