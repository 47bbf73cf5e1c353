//! Time series of files.
use crate::entry::{Core, Sent};
use crate::error::c_text;
use crate::{sys, Context, Result};
use std::sync::Arc;

/// A time series of output files (.pvd), whole on disk after every append.
pub struct Series {
    context: Arc<Core>,
    handle: *mut sys::mpm_series,
}

// SAFETY: the handle is used by an Entry only.
unsafe impl Send for Series {}

impl Series {
    /// Starts a series in a new file.
    pub fn open(context: &Context, path: &str) -> Result<Self> {
        let path = c_text(path)?;
        let mut handle = std::ptr::null_mut();
        let entry = context.core.enter()?;
        // SAFETY: the path ends with a zero.
        let status = unsafe { sys::mpm_series_open(context.core.handle, path.as_ptr(), &mut handle) };
        entry.done(status)?;
        Ok(Series { context: context.core.clone(), handle })
    }

    /// Appends a file at time `t`, by its path relative to the series' own.
    pub fn append(&mut self, t: f64, file: &str) -> Result<()> {
        let file = c_text(file)?;
        let entry = self.context.enter()?;
        // SAFETY: the handle lives, and the path ends with a zero.
        let status = unsafe { sys::mpm_series_append(self.handle, t, file.as_ptr()) };
        entry.done(status)
    }
}

impl Drop for Series {
    fn drop(&mut self) {
        let handle = Sent(self.handle);
        // SAFETY: nobody else has the handle.
        self.context.bury(move || {
            unsafe { sys::mpm_series_close(handle.get()) };
        });
    }
}
