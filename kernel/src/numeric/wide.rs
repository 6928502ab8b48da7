//! Run-time selection of the processor's widest vector instructions.

/// Runs `work` with the widest vector instructions of this processor. Nothing is fused, so the bits are the
/// same on every processor. Everything that `work` calls must be inlined into it.
#[inline]
pub(crate) fn widest<R>(work: impl FnOnce() -> R) -> R {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        if let Some(wide) = pulp::x86::V4::try_new() {
            return wide.vectorize(Wide(work));
        }
        if let Some(wide) = pulp::x86::V3::try_new() {
            return wide.vectorize(Wide(work));
        }
    }
    work()
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
struct Wide<F>(F);

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
impl<R, F: FnOnce() -> R> pulp::NullaryFnOnce for Wide<F> {
    type Output = R;

    #[inline(always)]
    fn call(self) -> R {
        (self.0)()
    }
}
