//! The step in parts.
use crate::entry::Sent;
use crate::{sys, Result, Stepper, View, ViewMut};

/// A step in parts, after its first one. It borrows the stepper until it ends; if it goes before, the step is dropped.
pub struct StagedStep<'a> {
    stepper: &'a mut Stepper,
    under_way: bool,
}

impl<'a> StagedStep<'a> {
    pub(crate) fn begin(stepper: &'a mut Stepper, dt: f64) -> Result<Self> {
        let entry = stepper.context.enter()?;
        // SAFETY: the handle lives.
        let status = unsafe { sys::mpm_step_begin(stepper.handle, dt) };
        entry.done_in(status, stepper.handle)?;
        Ok(StagedStep { stepper, under_way: true })
    }

    /// Lends a nodal field for reading.
    pub fn map(&self, body: i32, field: &str) -> Result<View<'_, f64>> {
        Ok(View::of(self.stepper.lend::<f64>(body, field, sys::MPM_READ)?))
    }

    /// Lends "velocity" or "force" for reading and writing.
    pub fn map_mut(&mut self, body: i32, field: &str) -> Result<ViewMut<'_, f64>> {
        Ok(ViewMut::of(self.stepper.lend::<f64>(body, field, sys::MPM_READ | sys::MPM_WRITE)?))
    }

    /// The second part: nodal velocities, walls, prescribed velocities.
    pub fn grid(&mut self) -> Result<()> {
        let entry = self.stepper.context.enter()?;
        // SAFETY: the handle lives.
        let status = unsafe { sys::mpm_step_grid(self.stepper.handle) };
        entry.done_in(status, self.stepper.handle)
    }

    /// The last part: grid to particles, stress, commit.
    pub fn end(mut self) -> Result<()> {
        let entry = self.stepper.context.enter()?;
        // SAFETY: the handle lives.
        let status = unsafe { sys::mpm_step_end(self.stepper.handle, std::ptr::null_mut()) };
        self.under_way = status != sys::MPM_OK;
        entry.done_in(status, self.stepper.handle)
    }
}

impl Drop for StagedStep<'_> {
    fn drop(&mut self) {
        if !self.under_way {
            return;
        }
        let stepper = Sent(self.stepper.handle);
        self.stepper.context.bury(move || {
            // SAFETY: the stepper's own burial comes after this. A part that failed has ended the step itself, and then this
            // is refused.
            unsafe { sys::mpm_step_abort(stepper.get()) };
        });
    }
}
