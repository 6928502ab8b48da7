//! State of the window that is kept from one start of the program to the next.

use eframe::{Storage, get_value, set_value};

use super::Window;
use super::size::WindowSize;

/// Key of the recently opened files.
const RECENT: &str = "recent";
/// Key of the window's size in points at zoom 1.
const SIZE: &str = "size";
/// Key of the custom arrangement.
const CUSTOM: &str = "arrangement";
/// Key of the progress in lessons.
const LESSONS: &str = "lessons";

impl Window {
    /// Restores the saved state except the settings.
    pub fn restore(&mut self, storage: &dyn Storage) {
        self.recent = get_value(storage, RECENT).unwrap_or_default();
        self.restore_size(get_value(storage, SIZE));
        self.custom = get_value(storage, CUSTOM);
        self.set_records(get_value(storage, LESSONS).unwrap_or_default());
    }

    pub(super) fn save_state(&self, storage: &mut dyn Storage) {
        set_value(storage, eframe::APP_KEY, &self.settings);
        set_value(storage, RECENT, &self.recent);
        set_value(storage, LESSONS, &self.records());
        if let Some(size) = self.size() {
            set_value(storage, SIZE, &size);
        }
        if let Some(tree) = &self.custom {
            set_value(storage, CUSTOM, tree);
        }
    }

    /// Restores a saved size; `None` at the first start.
    pub fn restore_size(&mut self, size: Option<[f32; 2]>) {
        self.window_size = WindowSize::restored(size);
    }

    /// The size to save, in points at zoom 1.
    pub fn size(&self) -> Option<[f32; 2]> {
        self.window_size.size()
    }
}
