//! Surfaces: markers without mass that move with the material and carry loads on its boundary.
use crate::arrays::{fits, pointer, Field};
use crate::callback::{alone, Owned};
use crate::entry::{owns, Core, Sent};
use crate::{sys, Columns, Element, Filled, Flow, Grid, MarkerBatch, Result, SurfaceDesc};
use std::os::raw::c_void;
use std::sync::Arc;

/// Adds to rows of the markers: tractions, or velocities.
type MarkerFn = dyn FnMut(&MarkerBatch<'_>, &mut Columns<'_, f64>) -> Flow + Send;

/// Markers that the material carries along, and that load it. A stepper takes it over, and lends it as [`LentSurface`],
/// which has what there is to be done with it.
///
/// Vectors have as many components as the grid has dimensions. Area vectors, area times normal, point out of the material;
/// they and forces are per thickness in 2-D, and of one radian on a grid that is `MPM_AXISYMMETRIC`. Pressures and tractions
/// are forces per area.
///
/// A bad value is `MPM_E_ARG`, a field or an id that there is not `MPM_E_NOT_FOUND`, and what the dimension of the grid does
/// not have `MPM_E_UNSUPPORTED`; then nothing has changed.
pub struct Surface(Box<LentSurface>);

/// A surface where it is. It has no size, so that nobody exchanges the surface of a stepper for another.
pub struct LentSurface<S: ?Sized = [()]> {
    pub(crate) context: Arc<Core>,
    pub(crate) handle: *mut sys::mpm_surface,
    grid: Grid,
    traction: Option<Owned<MarkerFn>>,
    velocity: Option<Owned<MarkerFn>>,
    _sizeless: S,
}

// SAFETY: the handle is used by an Entry only, and so are its functions.
unsafe impl Send for LentSurface {}
unsafe impl Sync for LentSurface {}

owns!(Surface, LentSurface);

impl Surface {
    /// Makes a surface without markers.
    pub fn new(grid: &Grid, desc: &SurfaceDesc) -> Result<Self> {
        let (context, desc) = (grid.core.context.clone(), sized(desc));
        let mut handle = std::ptr::null_mut();
        let entry = context.enter()?;
        // SAFETY: the descriptor is whole, and the surface keeps the grid.
        let status = unsafe { sys::mpm_surface_create(context.handle, grid.as_ptr(), &desc, &mut handle) };
        entry.done(status)?;
        let (grid, traction, velocity) = (grid.clone(), None, None);
        Ok(Surface(Box::new(LentSurface { context, handle, grid, traction, velocity, _sizeless: [] })))
    }
}

impl LentSurface {
    /// Replaces loads and options between steps. Loads of all markers come on top of those that markers carry by themselves.
    pub fn configure(&mut self, desc: &SurfaceDesc) -> Result<()> {
        let desc = sized(desc);
        let entry = self.context.enter()?;
        // SAFETY: the descriptor is whole.
        let status = unsafe { sys::mpm_surface_configure(self.handle, &desc) };
        entry.done(status)
    }

    /// Sets what adds forces per present area of the markers: component `c` of marker `i` is `add[(i, c)]`. It runs once per
    /// step, on the thread of the call. A panic goes on in the caller of the step, and a value that is not finite ends the
    /// step with `MPM_NONFINITE`.
    pub fn set_traction(
        &mut self,
        traction: impl FnMut(&MarkerBatch<'_>, &mut Columns<'_, f64>) -> Flow + Send + 'static,
    ) -> Result<()> {
        let slot = Owned::<MarkerFn>::new(&self.context.thrown, Box::new(traction));
        let entry = self.context.enter()?;
        // SAFETY: the old function goes only once the library has taken the new one.
        let status = unsafe { sys::mpm_surface_set_traction(self.handle, Some(on_markers), slot.user()) };
        entry.done(status)?;
        self.traction = Some(slot);
        Ok(())
    }

    /// Takes the function away.
    pub fn clear_traction(&mut self) -> Result<()> {
        let entry = self.context.enter()?;
        // SAFETY: the handle lives.
        let status = unsafe { sys::mpm_surface_set_traction(self.handle, None, std::ptr::null_mut()) };
        entry.done(status)?;
        self.traction = None;
        Ok(())
    }

    /// Sets what adds velocities of the markers, where the surface prescribes: component `c` of marker `i` is
    /// `add[(i, c)]`. It runs as that of tractions does.
    pub fn set_velocity(
        &mut self,
        velocity: impl FnMut(&MarkerBatch<'_>, &mut Columns<'_, f64>) -> Flow + Send + 'static,
    ) -> Result<()> {
        let slot = Owned::<MarkerFn>::new(&self.context.thrown, Box::new(velocity));
        let entry = self.context.enter()?;
        // SAFETY: the old function goes only once the library has taken the new one.
        let status = unsafe { sys::mpm_surface_set_velocity(self.handle, Some(on_markers), slot.user()) };
        entry.done(status)?;
        self.velocity = Some(slot);
        Ok(())
    }

    /// Takes the function away.
    pub fn clear_velocity(&mut self) -> Result<()> {
        let entry = self.context.enter()?;
        // SAFETY: the handle lives.
        let status = unsafe { sys::mpm_surface_set_velocity(self.handle, None, std::ptr::null_mut()) };
        entry.done(status)?;
        self.velocity = None;
        Ok(())
    }

    /// Heats what lies below: `flux + film * (ambient - temperature)`, power per area into the material; all 0 as made.
    pub fn set_heat(&mut self, flux: f64, film: f64, ambient: f64) -> Result<()> {
        let entry = self.context.enter()?;
        // SAFETY: the handle lives.
        let status = unsafe { sys::mpm_surface_set_heat(self.handle, flux, film, ambient) };
        entry.done(status)
    }

    /// Adds markers at `position`, which is `[dim][n]` as the area vectors are; without area they follow the material and
    /// carry nothing. Gives the first id.
    pub fn add(&mut self, position: &[f64], area: Option<&[f64]>) -> Result<i64> {
        let n = position.len() / self.dim();
        fits("position", position.len(), n * self.dim())?;
        area.map_or(Ok(()), |area| fits("area", area.len(), position.len()))?;
        let mut first = 0;
        let entry = self.context.enter()?;
        // SAFETY: all lengths were checked.
        let status =
            unsafe { sys::mpm_surface_add(self.handle, n as i64, position.as_ptr(), pointer(area), &mut first) };
        entry.done(status)?;
        Ok(first)
    }

    /// Adds markers along the line through points, `[2][n]`, with the material on its left; closed: back to the first.
    /// Edges are divided into equal parts no longer than the spacing; half a spacing of the grid is right. 2-D only.
    pub fn add_polyline(&mut self, position: &[f64], closed: bool, spacing: f64) -> Result<Filled> {
        let n = position.len() / 2;
        fits("position", position.len(), n * 2)?;
        let mut made = Filled { first_id: 0, count: 0 };
        let entry = self.context.enter()?;
        // SAFETY: the length was checked.
        let status = unsafe {
            sys::mpm_surface_add_polyline(
                self.handle,
                n as i64,
                position.as_ptr(),
                closed.into(),
                spacing,
                &mut made.first_id,
                &mut made.count,
            )
        };
        entry.done(status)?;
        Ok(made)
    }

    /// Adds markers on triangles: points are `[3][n]`, corners `[triangles][3]` with numbers of points, counter-clockwise as
    /// seen from outside. Each is divided into equal ones with edges no longer than the spacing. 3-D only.
    pub fn add_triangles(&mut self, position: &[f64], corner: &[i64], spacing: f64) -> Result<Filled> {
        let (n, triangles) = (position.len() / 3, corner.len() / 3);
        fits("position", position.len(), n * 3)?;
        fits("corner", corner.len(), triangles * 3)?;
        let mut made = Filled { first_id: 0, count: 0 };
        let entry = self.context.enter()?;
        // SAFETY: all lengths were checked.
        let status = unsafe {
            sys::mpm_surface_add_triangles(
                self.handle,
                n as i64,
                position.as_ptr(),
                triangles as i64,
                corner.as_ptr(),
                spacing,
                &mut made.first_id,
                &mut made.count,
            )
        };
        entry.done(status)?;
        Ok(made)
    }

    /// Removes markers by id: all or none.
    pub fn remove(&mut self, ids: &[i64]) -> Result<()> {
        let entry = self.context.enter()?;
        // SAFETY: the ids are as many as is said.
        let status = unsafe { sys::mpm_surface_remove(self.handle, ids.len() as i64, ids.as_ptr()) };
        entry.done(status)
    }

    /// Splits markers until no edge is longer than the spacing; total area and loads are kept. Gives how many came.
    pub fn refine(&mut self, spacing: f64) -> Result<i64> {
        let mut added = 0;
        let entry = self.context.enter()?;
        // SAFETY: the handle lives.
        let status = unsafe { sys::mpm_surface_refine(self.handle, spacing, &mut added) };
        entry.done(status)?;
        Ok(added)
    }

    /// The dimension of the grid.
    pub fn dim(&self) -> usize {
        self.grid.dim()
    }

    /// The number of markers. May be called in callbacks.
    pub fn len(&self) -> usize {
        // SAFETY: free to be called at any time while the surface lives.
        unsafe { sys::mpm_surface_count(self.handle) as usize }
    }

    /// Whether there are no markers.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Copies a field of all markers by ascending id: `[components][n]`. `"id"` is of `i64`, all others are of `f64`:
    /// `"reference_area"` and `"pressure"` with one component; `"position"`, `"area"`, `"displacement"`, `"velocity"`,
    /// `"force"`, `"traction"`, `"dead_traction"`, `"prescribed_velocity"`, `"reaction"` and `"gap"` with one for each axis.
    /// Force, reaction and velocity are those of the last step.
    pub fn get<T: Element>(&self, field: &str) -> Result<Vec<T>> {
        self.copy(field, self.len(), None)
    }

    /// Copies a field of markers by id.
    pub fn get_of<T: Element>(&self, field: &str, ids: &[i64]) -> Result<Vec<T>> {
        self.copy(field, ids.len(), Some(ids))
    }

    fn copy<T: Element>(&self, field: &str, n: usize, ids: Option<&[i64]>) -> Result<Vec<T>> {
        let of = Field { name: field, components: self.components(field), n, ids };
        of.copied(&self.context, sys::mpm_surface_get, self.handle)
    }

    /// Sets a field of all markers, laid out as in [`Self::get`]: all or none. Ids, reference areas, velocities and forces
    /// cannot be set; areas that are become those of reference.
    pub fn set<T: Element>(&mut self, field: &str, values: &[T]) -> Result<()> {
        self.overwrite(field, self.len(), None, values)
    }

    /// Sets a field of markers by id.
    pub fn set_of<T: Element>(&mut self, field: &str, ids: &[i64], values: &[T]) -> Result<()> {
        self.overwrite(field, ids.len(), Some(ids), values)
    }

    fn overwrite<T: Element>(&mut self, field: &str, n: usize, ids: Option<&[i64]>, values: &[T]) -> Result<()> {
        let of = Field { name: field, components: self.components(field), n, ids };
        of.overwritten(&self.context, sys::mpm_surface_set, self.handle, values)
    }

    fn components(&self, field: &str) -> usize {
        match field {
            "id" | "reference_area" | "pressure" => 1,
            _ => self.dim(),
        }
    }

    /// The handle of C.
    pub fn as_ptr(&self) -> *mut sys::mpm_surface {
        self.handle
    }
}

impl<S: ?Sized> Drop for LentSurface<S> {
    fn drop(&mut self) {
        let (handle, grid) = (Sent(self.handle), self.grid.clone());
        let functions = (self.traction.take(), self.velocity.take());
        self.context.bury(move || {
            // SAFETY: nobody else has the handle. While a stepper holds on to it, so it does to the functions, and the grid
            // refuses, too.
            if unsafe { sys::mpm_surface_destroy(handle.get()) } != sys::MPM_OK {
                std::mem::forget(functions);
            }
            drop(grid);
        });
    }
}

/// The descriptor with the size that the library is to read.
fn sized(desc: &SurfaceDesc) -> SurfaceDesc {
    SurfaceDesc { struct_size: std::mem::size_of::<SurfaceDesc>() as u32, ..*desc }
}

unsafe extern "C" fn on_markers(user: *mut c_void, batch: *const sys::mpm_marker_batch, add: *mut f64) -> i32 {
    let slot = alone::<MarkerFn>(user);
    let (raw, function) = (&*batch, &mut slot.function);
    slot.thrown.guard(|| function(&MarkerBatch(raw), &mut Columns::new(add, raw.ld, raw.n, raw.dim as usize)))
}
