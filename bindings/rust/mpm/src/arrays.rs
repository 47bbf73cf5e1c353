//! Arrays of the caller for C, and copies of the fields of handles whose items have some.
use crate::entry::Core;
use crate::error::c_text;
use crate::{Element, Error, Result};
use std::os::raw::{c_char, c_void};
use std::sync::Arc;

/// A pointer to an optional array; NULL for none.
pub(crate) fn pointer<T>(values: Option<&[T]>) -> *const T {
    values.map_or(std::ptr::null(), <[T]>::as_ptr)
}

/// Sees that an array has the length that C will read.
pub(crate) fn fits(what: &str, length: usize, should: usize) -> Result<()> {
    if length == should {
        return Ok(());
    }
    Err(Error::argument(format!("\"{what}\" has {length} values, not {should}")))
}

type Get<H> = unsafe extern "C" fn(*const H, *const c_char, i32, i32, i64, *const i64, *mut c_void) -> i32;
type Set<H> = unsafe extern "C" fn(*mut H, *const c_char, i32, i32, i64, *const i64, *const c_void) -> i32;

/// A field by its name, with as many components as it has, of n items: all, or those with the ids.
pub(crate) struct Field<'a> {
    pub name: &'a str,
    pub components: usize,
    pub n: usize,
    pub ids: Option<&'a [i64]>,
}

impl Field<'_> {
    /// Copies the field by `mpm_X_get`: `[components][n]`.
    pub fn copied<H, T: Element>(&self, context: &Arc<Core>, get: Get<H>, handle: *const H) -> Result<Vec<T>> {
        let name = c_text(self.name)?;
        let mut out = vec![T::default(); self.components * self.n];
        let entry = context.enter()?;
        let (components, n, ids) = (self.components as i32, self.n as i64, pointer(self.ids));
        // SAFETY: the library compares type, components and n with those of the field.
        let status = unsafe { get(handle, name.as_ptr(), T::TYPE, components, n, ids, out.as_mut_ptr().cast()) };
        entry.done(status)?;
        Ok(out)
    }

    /// Sets the field by `mpm_X_set`.
    pub fn overwritten<H, T: Element>(
        &self,
        context: &Arc<Core>,
        set: Set<H>,
        handle: *mut H,
        values: &[T],
    ) -> Result<()> {
        let name = c_text(self.name)?;
        fits(self.name, values.len(), self.components * self.n)?;
        let entry = context.enter()?;
        let (components, n, ids) = (self.components as i32, self.n as i64, pointer(self.ids));
        // SAFETY: the library compares type, components and n with those of the field.
        let status = unsafe { set(handle, name.as_ptr(), T::TYPE, components, n, ids, values.as_ptr().cast()) };
        entry.done(status)
    }
}
