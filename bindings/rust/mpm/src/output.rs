//! What goes out for renderers, archives and sockets: floats, and bytes into a writer.
use crate::callback::{alone, Owned};
use crate::entry::Core;
use crate::error::c_texts;
use crate::{sys, Error, LentParticles, Result, Stepper};
use std::io::Write;
use std::os::raw::c_void;
use std::sync::Arc;

/// Lends a writer to a call of C, which hands it bytes. Errors of the writer are the source of the one that comes out.
fn written(
    context: &Arc<Core>,
    mut out: impl Write,
    call: impl FnOnce(sys::mpm_write_fn, *mut c_void) -> i32,
) -> Result<()> {
    unsafe extern "C" fn on_write(user: *mut c_void, data: *const c_void, bytes: i64) -> i32 {
        let slot = alone::<&mut dyn Write>(user);
        let out = &mut slot.function;
        slot.thrown.guard(|| Ok(out.write_all(std::slice::from_raw_parts(data.cast(), bytes as usize))?))
    }
    let slot = Owned::<&mut dyn Write>::new(&context.thrown, Box::new(&mut out));
    let entry = context.enter()?;
    let status = call(Some(on_write), slot.user());
    entry.done(status)?;
    drop(slot);
    out.flush().map_err(|error| {
        Error::new(sys::MPM_E_CALLBACK, format!("the writer could not be flushed: {error}"))
            .with_source(Some(error.into()))
    })
}

impl LentParticles {
    /// Copies fields of all particles as floats, `[particle][component]`: one particle after the other, without inert
    /// slots. `order` is `MPM_BY_ID`, or `MPM_LIBRARY_ORDER`, which is faster: see `mpm_particles_get_f32()`.
    pub fn get_f32(&self, fields: &[&str], order: i32) -> Result<Vec<f32>> {
        let all = self.fields()?;
        // an unknown name goes on to the library, which lists the nearest
        let components = |name: &&str| all.iter().find(|one| one.name == *name).map_or(1, |one| one.components);
        let (n, width) = (self.len(), fields.iter().map(components).sum::<usize>());
        let (_held, names) = c_texts(fields)?;
        let mut out = vec![0f32; n * width];
        let entry = self.context.enter()?;
        // SAFETY: there is room for all components of all particles, and texts end with a zero.
        let status = unsafe {
            let count = names.len() as i32;
            sys::mpm_particles_get_f32(self.as_ptr(), count, names.as_ptr(), order, n as i64, out.as_mut_ptr())
        };
        entry.done(status)?;
        Ok(out)
    }

    /// Gives a writer the bytes of the file that [`Self::write`] would write.
    pub fn write_to(&self, out: impl Write, fields: &[&str]) -> Result<()> {
        let (_held, names) = c_texts(fields)?;
        // SAFETY: all texts end with a zero, and the writer is used during the call.
        written(&self.context, out, |write, user| unsafe {
            sys::mpm_write_particles_to(self.as_ptr(), write, user, names.len() as i32, names.as_ptr())
        })
    }
}

impl Stepper {
    /// Gives a writer the bytes of [`Stepper::save`], without holding them all.
    pub fn save_to(&self, out: impl Write) -> Result<()> {
        // SAFETY: the handle lives, and the writer is used during the call.
        written(&self.context, out, |write, user| unsafe { sys::mpm_state_save_to(self.as_ptr(), write, user) })
    }

    /// Gives a writer the bytes of the file that [`Stepper::write_grid`] would write.
    pub fn write_grid_to(&mut self, body: i32, out: impl Write, fields: &[&str]) -> Result<()> {
        let (_held, names) = c_texts(fields)?;
        // SAFETY: all texts end with a zero, and the writer is used during the call.
        written(&self.context, out, |write, user| unsafe {
            sys::mpm_write_grid_to(self.as_ptr(), body, write, user, names.len() as i32, names.as_ptr())
        })
    }
}
