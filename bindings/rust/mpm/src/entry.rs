//! What all objects of a context share: one call at a time, what callbacks raised, and what is still to be freed.
use crate::callback::{Raised, Thrown};
use crate::error::text_of;
use crate::{sys, Error, Result};
use std::any::Any;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst};
use std::sync::{Arc, Mutex};

type Burial = Box<dyn FnOnce() + Send>;

/// The context of C.
pub(crate) struct Core {
    pub handle: *mut sys::mpm_context,
    pub thrown: Arc<Thrown>,
    /// Functions that the context calls; their types do not matter here.
    pub kept: Vec<Box<dyn Any + Send + Sync>>,
    busy: AtomicBool,
    burials: Mutex<Vec<Burial>>,
    waiting: AtomicUsize,
}

// SAFETY: calls are made by an Entry, of which there is one at a time.
unsafe impl Send for Core {}
unsafe impl Sync for Core {}

impl Core {
    pub fn new(handle: *mut sys::mpm_context, thrown: Arc<Thrown>, kept: Vec<Box<dyn Any + Send + Sync>>) -> Arc<Self> {
        Arc::new(Core {
            handle,
            thrown,
            kept,
            busy: AtomicBool::new(false),
            burials: Mutex::new(Vec::new()),
            waiting: AtomicUsize::new(0),
        })
    }

    /// Begins a call.
    pub fn enter(self: &Arc<Self>) -> Result<Entry> {
        if self.busy.swap(true, SeqCst) {
            return Err(Error::new(
                sys::MPM_E_STATE,
                "another call on the context is under way: this one was made in a callback, or on another thread",
            ));
        }
        let entry = Entry { core: self.clone() };
        // a view that was given back while another thread called is no more
        entry.bury_waiting();
        Ok(entry)
    }

    /// Frees something: now, or after the call that is under way. What it needs must be part of it.
    pub fn bury(self: &Arc<Self>, burial: impl FnOnce() + Send + 'static) {
        // behind what is waiting, which may need that it still is there
        {
            let mut burials = self.burials.lock().unwrap();
            burials.push(Box::new(burial));
            self.waiting.store(burials.len(), SeqCst);
        }
        drop(self.enter());
    }
}

impl Drop for Core {
    fn drop(&mut self) {
        // SAFETY: nobody else has the handle. Where objects were leaked the library refuses, and the context is, too: its
        // functions must not go before it.
        if unsafe { sys::mpm_context_destroy(self.handle) } != sys::MPM_OK {
            std::mem::forget(std::mem::take(&mut self.kept));
        }
    }
}

/// A call on a context. When it goes, what was waiting is freed.
pub(crate) struct Entry {
    pub core: Arc<Core>,
}

/// What owns something that a stepper may take over derefs to it.
macro_rules! owns {
    ($owner:ident, $lent:ident) => {
        impl std::ops::Deref for $owner {
            type Target = $lent;
            fn deref(&self) -> &$lent {
                &self.0
            }
        }

        impl std::ops::DerefMut for $owner {
            fn deref_mut(&mut self) -> &mut $lent {
                &mut self.0
            }
        }
    };
}
pub(crate) use owns;

impl Entry {
    /// The outcome of a call that runs no callbacks of a stepper.
    pub fn done(self, status: i32) -> Result<()> {
        self.done_in(status, std::ptr::null())
    }

    /// The outcome of a call; what comes out is what the callback raised whose status the stepper reports.
    pub fn done_in(self, status: i32, stepper: *const sys::mpm_stepper) -> Result<()> {
        if status == sys::MPM_OK && !self.core.thrown.any() {
            return Ok(());
        }
        // SAFETY: the text is copied before any other call.
        let text = text_of(unsafe { sys::mpm_last_error(self.core.handle) });
        let mut info = sys::mpm_step_info::default();
        if status == sys::MPM_E_CALLBACK && !stepper.is_null() {
            // SAFETY: the stepper is one of this context. It may refuse, and then leaves info as it is.
            unsafe { sys::mpm_stepper_info(stepper, &mut info) };
        }
        let raised = self.core.thrown.take(info.callback_status);
        drop(self);
        match raised {
            Some(Raised::Panic(payload)) => resume_unwind(payload),
            _ if status == sys::MPM_OK => Ok(()),
            Some(Raised::Refused(source)) => Err(Error::new(status, text).with_source(Some(source))),
            None => Err(Error::new(status, text)),
        }
    }
}

impl Entry {
    fn bury_waiting(&self) {
        while self.core.waiting.load(SeqCst) > 0 {
            let burials = {
                let mut waiting = self.core.burials.lock().unwrap();
                self.core.waiting.store(0, SeqCst);
                std::mem::take(&mut *waiting)
            };
            for burial in burials {
                burial();
            }
        }
    }
}

impl Drop for Entry {
    fn drop(&mut self) {
        loop {
            self.bury_waiting();
            self.core.busy.store(false, SeqCst);
            if self.core.waiting.load(SeqCst) == 0 || self.core.busy.swap(true, SeqCst) {
                return;
            }
        }
    }
}

/// A pointer that goes along with a burial.
pub(crate) struct Sent<T>(pub *mut T);
// SAFETY: who has the Sent has the object.
unsafe impl<T> Send for Sent<T> {}
impl<T> Sent<T> {
    pub fn get(&self) -> *mut T {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_waits_is_freed_before_the_next_call() {
        let core = Core::new(std::ptr::null_mut(), Arc::default(), Vec::new());
        let freed = Arc::new(AtomicBool::new(false));
        let done = freed.clone();
        core.busy.store(true, SeqCst); // as while another thread calls
        core.bury(move || done.store(true, SeqCst));
        assert!(!freed.load(SeqCst));
        core.busy.store(false, SeqCst);
        let entry = core.enter().unwrap();
        assert!(freed.load(SeqCst), "a view that was given back was still lent in the next call");
        drop(entry);
    }
}
