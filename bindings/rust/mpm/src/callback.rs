//! Functions of the host, and what comes of them.
use crate::sys;
use std::any::Any;
use std::fmt;
use std::os::raw::c_void;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
use std::sync::{Arc, Mutex};

/// What a function of the host returns.
pub type Flow = std::result::Result<(), Refusal>;

/// Why a function of the host does not go on. Errors of other types become refusals by `?`.
#[derive(Debug)]
pub enum Refusal {
    /// A smaller step may do; for [`Stepper::set_progress`](crate::Stepper::set_progress): the end of the call.
    SmallerStep,
    /// The call stops; the error is the source of the one that it gives.
    Stop(Box<dyn std::error::Error + Send + Sync>),
}

impl Refusal {
    /// A stop with a sentence.
    pub fn stop(text: impl Into<String>) -> Self {
        Refusal::Stop(text.into().into())
    }
}

impl<E: std::error::Error + Send + Sync + 'static> From<E> for Refusal {
    fn from(error: E) -> Self {
        Refusal::Stop(Box::new(error))
    }
}

/// What a function raised.
pub(crate) enum Raised {
    Panic(Box<dyn Any + Send>),
    Refused(Box<dyn std::error::Error + Send + Sync>),
}

impl fmt::Debug for Raised {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(if matches!(self, Raised::Panic(_)) { "panic" } else { "refused" })
    }
}

/// What functions raised in the call under way, on any thread. Each has a number, which the library carries as the status
/// of the callback: what comes out does not depend on threads.
#[derive(Debug, Default)]
pub(crate) struct Thrown {
    any: AtomicBool,
    kept: Mutex<Vec<Raised>>,
}

const FIRST: i32 = -1_000_000_000;

impl Thrown {
    pub fn any(&self) -> bool {
        self.any.load(SeqCst)
    }
    /// Keeps what was raised and gives the status that stands for it.
    pub fn keep(&self, raised: Raised) -> i32 {
        let mut kept = self.kept.lock().unwrap();
        kept.push(raised);
        self.any.store(true, SeqCst);
        FIRST - (kept.len() as i32 - 1)
    }
    /// Forgets all and gives that for which a status stands, else the first.
    pub fn take(&self, status: i32) -> Option<Raised> {
        let mut kept = std::mem::take(&mut *self.kept.lock().unwrap());
        self.any.store(false, SeqCst);
        if kept.is_empty() {
            return None;
        }
        let number = if status <= FIRST { (FIRST - status) as usize } else { 0 };
        let wanted = if number < kept.len() { number } else { 0 };
        Some(kept.swap_remove(wanted))
    }
    /// Runs a function for C, through which nothing may unwind.
    pub fn guard(&self, run: impl FnOnce() -> Flow) -> i32 {
        match catch_unwind(AssertUnwindSafe(run)) {
            Ok(Ok(())) => sys::MPM_OK,
            Ok(Err(Refusal::SmallerStep)) => sys::MPM_CUT_DT,
            Ok(Err(Refusal::Stop(error))) => self.keep(Raised::Refused(error)),
            Err(payload) => self.keep(Raised::Panic(payload)),
        }
    }
}

/// A function where C finds it.
pub(crate) struct Slot<F: ?Sized> {
    pub thrown: Arc<Thrown>,
    pub function: Box<F>,
}

/// Owns a slot to whose address C holds on. Unlike a Box it may be moved while C does.
pub(crate) struct Owned<F: ?Sized>(*mut Slot<F>);

// SAFETY: the slot is sent where its function may be.
unsafe impl<F: ?Sized + Send> Send for Owned<F> {}
unsafe impl<F: ?Sized + Sync> Sync for Owned<F> {}

impl<F: ?Sized> Owned<F> {
    pub fn new(thrown: &Arc<Thrown>, function: Box<F>) -> Self {
        Owned(Box::into_raw(Box::new(Slot { thrown: thrown.clone(), function })))
    }
    /// The first argument of the callback.
    pub fn user(&self) -> *mut c_void {
        self.0.cast()
    }
}

impl<F: ?Sized> Drop for Owned<F> {
    fn drop(&mut self) {
        // SAFETY: it came from a Box, and C has let go of it.
        drop(unsafe { Box::from_raw(self.0) });
    }
}

/// The first argument for an optional function; NULL for none.
pub(crate) fn user_of<F: ?Sized>(slot: &Option<Owned<F>>) -> *mut c_void {
    slot.as_ref().map_or(std::ptr::null_mut(), Owned::user)
}

/// The slot to which the first argument of a callback (mt) leads.
///
/// # Safety
/// `user` is that of an Owned<F> that lives.
pub(crate) unsafe fn shared<'a, F: ?Sized>(user: *mut c_void) -> &'a Slot<F> {
    &*user.cast::<Slot<F>>()
}

/// The slot to which the first argument of a callback leads that runs on the calling thread only.
///
/// # Safety
/// `user` is that of an Owned<F> that lives, and no other call of the function is under way.
pub(crate) unsafe fn alone<'a, F: ?Sized>(user: *mut c_void) -> &'a mut Slot<F> {
    &mut *user.cast::<Slot<F>>()
}
