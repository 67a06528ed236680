//! SIGINT (Ctrl+C) and SIGTERM: the first one ends the exploration as a limit does, so that what was found is reported; a
//! second one ends the process.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use stillpoint_model::Interrupt;

use super::Failure;

/// As long as it lives, a first signal only raises the interrupt.
pub struct Interruptible(Arc<AtomicBool>);

impl Interruptible {
    /// Begins to listen.
    pub fn begin() -> Result<Self, Failure> {
        let raised = Arc::new(AtomicBool::new(false));
        for signal in [SIGINT, SIGTERM] {
            // In this order: the signal that raises the flag does not find it raised.
            flag::register_conditional_default(signal, Arc::clone(&raised))
                .and_then(|_| flag::register(signal, Arc::clone(&raised)))
                .map_err(|e| Failure::Other(format!("signals cannot be listened to: {e}")))?;
        }
        Ok(Self(raised))
    }

    /// What a signal raises.
    pub fn handle(&self) -> Interrupt {
        Interrupt::of(Arc::clone(&self.0))
    }
}

impl Drop for Interruptible {
    fn drop(&mut self) {
        // From now on a signal ends the process.
        self.0.store(true, Ordering::Relaxed);
    }
}
