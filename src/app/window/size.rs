//! Size of the window on the screen, kept from one start of the program to the next.
//!
//! What eframe keeps is in points of the zoom of then, and is read before a zoom is set: a window of the
//! projector mode would come back smaller with every start. The size is therefore kept here, in points of the
//! zoom 1.

use eframe::egui::{Context, Vec2, ViewportCommand, vec2};

/// Frames after which sizes are those of the present zoom, and until which the screen tells how large the
/// window's own frame is.
const SETTLED: u32 = 3;
const FRAMED: u32 = 90;

/// Where the window is on its way to its size.
#[derive(Debug, Clone, Default)]
pub(super) struct WindowSize {
    /// The size that it is to have, until it was asked for.
    wanted: Option<Vec2>,
    /// Frames with the zoom that is wanted.
    frames: u32,
    /// It was larger than the screen, and is no longer asked to fit.
    fitted: bool,
    /// The last size that is worth keeping.
    size: Option<Vec2>,
}

impl WindowSize {
    /// A window of a size that was kept; none at the first start.
    pub fn restored(size: Option<[f32; 2]>) -> Self {
        let sane = |size: &Vec2| size.is_finite() && size.min_elem() >= 1.0;
        Self { wanted: size.map(|[x, y]| vec2(x, y)).filter(sane), ..Self::default() }
    }

    pub fn size(&self) -> Option<[f32; 2]> {
        self.size.map(|size| [size.x, size.y])
    }

    /// To be called in every frame with the zoom that is wanted.
    pub fn follow(&mut self, ctx: &Context, zoom: f32) {
        self.frames = if (ctx.zoom_factor() - zoom).abs() < 1e-3 { self.frames.saturating_add(1) } else { 0 };
        if self.frames < SETTLED {
            ctx.request_repaint();
            return;
        }
        let (inner, outer, screen, whole) = ctx.input(|input| {
            let view = input.viewport();
            let whole = view.maximized == Some(true) || view.fullscreen == Some(true);
            (view.inner_rect, view.outer_rect, view.monitor_size, whole)
        });
        let Some(inner) = inner.map(|rect| rect.size()).filter(|_| !whole) else { return };
        if let Some(wanted) = self.wanted.take() {
            if (inner * zoom - wanted).abs().max_elem() > 1.0 {
                ctx.send_viewport_cmd(ViewportCommand::InnerSize(wanted / zoom));
                self.frames = 0;
            }
            return;
        }
        // with its frame it may be larger than the screen, whose edge then cuts the lowest bar
        if let Some(screen) = screen.filter(|_| !self.fitted && self.frames < FRAMED) {
            let outer = outer.map_or(inner, |rect| rect.size()).max(inner);
            if outer.x > screen.x + 1.0 || outer.y > screen.y + 1.0 {
                self.fitted = true;
                ctx.send_viewport_cmd(ViewportCommand::Maximized(true));
            }
        }
        self.size = Some(inner * zoom);
    }
}
