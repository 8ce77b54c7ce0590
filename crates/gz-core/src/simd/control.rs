//! The floating-point control register: rounding and flushing as Rust assumes them.

/// Runs `work` with round-to-nearest and without flushing of subnormal numbers, and gives the caller its own setting back.
///
/// A host program may have set flush-to-zero; the error bounds of the certified test do not hold under it.
pub fn with_default_float_control<T>(work: impl FnOnce() -> T) -> T {
    let _restore = Control::set_default();
    work()
}

struct Control {
    #[cfg(target_arch = "x86_64")]
    before: u32,
}

#[cfg(target_arch = "x86_64")]
impl Control {
    /// All exceptions masked, round to nearest, nothing flushed: the state in which a process starts.
    const DEFAULT: u32 = 0x1f80;
    /// Sticky exception flags, of no matter here.
    const FLAGS: u32 = 0x3f;

    fn set_default() -> Self {
        let mut before = 0u32;
        // SAFETY: `stmxcsr` writes the 4 bytes of `before`, which outlives the call.
        unsafe { std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut before, options(nostack, preserves_flags)) };
        let control = Self { before };
        if before & !Self::FLAGS != Self::DEFAULT {
            load(Self::DEFAULT);
        }
        control
    }
}

#[cfg(target_arch = "x86_64")]
impl Drop for Control {
    fn drop(&mut self) {
        if self.before & !Self::FLAGS != Self::DEFAULT {
            load(self.before);
        }
    }
}

#[cfg(target_arch = "x86_64")]
fn load(value: u32) {
    // SAFETY: `ldmxcsr` reads the 4 bytes of `value`; no reserved bit is set, as the value is the default or was read from the register.
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const value, options(nostack, preserves_flags)) };
}

#[cfg(not(target_arch = "x86_64"))]
impl Control {
    fn set_default() -> Self {
        Self {}
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;

    fn current() -> u32 {
        let mut value = 0u32;
        // SAFETY: `stmxcsr` writes the 4 bytes of `value`.
        unsafe { std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut value, options(nostack, preserves_flags)) };
        value & !Control::FLAGS
    }

    #[test]
    fn flushing_is_off_inside_and_back_on_afterwards() {
        let before = current();
        let flushing = Control::DEFAULT | 1 << 15 | 1 << 6;
        load(flushing);
        let inside = with_default_float_control(current);
        let after = current();
        load(before);
        assert_eq!((inside, after), (Control::DEFAULT, flushing));
    }
}
