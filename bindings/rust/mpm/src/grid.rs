//! The grid.
use crate::entry::{Core, Sent};
use crate::{sys, Context, GridDesc, Result};
use std::sync::Arc;

/// The background grid. A clone is the same grid.
#[derive(Clone)]
pub struct Grid {
    pub(crate) core: Arc<GridCore>,
}

pub(crate) struct GridCore {
    pub context: Arc<Core>,
    pub handle: *mut sys::mpm_grid,
    pub dim: usize,
    /// Whether it is of `MPM_PLANE_STRESS`.
    pub sheet: bool,
}

// SAFETY: the handle is used by an Entry only.
unsafe impl Send for GridCore {}
unsafe impl Sync for GridCore {}

impl Grid {
    /// Makes a grid.
    pub fn new(context: &Context, desc: &GridDesc) -> Result<Self> {
        let mut desc = *desc;
        desc.struct_size = std::mem::size_of_val(&desc) as u32;
        let mut handle = std::ptr::null_mut();
        let entry = context.core.enter()?;
        // SAFETY: the descriptor is whole.
        let status = unsafe { sys::mpm_grid_create(context.core.handle, &desc, &mut handle) };
        entry.done(status)?;
        let (context, dim, sheet) = (context.core.clone(), desc.dim as usize, desc.geometry == sys::MPM_PLANE_STRESS);
        Ok(Grid { core: Arc::new(GridCore { context, handle, dim, sheet }) })
    }

    /// The dimension, 1 to 3.
    pub fn dim(&self) -> usize {
        self.core.dim
    }

    /// The handle of C.
    pub fn as_ptr(&self) -> *mut sys::mpm_grid {
        self.core.handle
    }
}

impl Drop for GridCore {
    fn drop(&mut self) {
        let handle = Sent(self.handle);
        // SAFETY: nobody else has the handle.
        self.context.bury(move || {
            unsafe { sys::mpm_grid_destroy(handle.get()) };
        });
    }
}
