//! Sets of particles.
use crate::arrays::{fits, pointer, Field};
use crate::entry::{owns, Core, Sent};
use crate::error::{c_text, c_texts, text_of};
use crate::view::Lent;
use crate::{callback::Slot, Flow};
use crate::{sys, Element, Error, Grid, Material, Result, View, ViewMut};
use std::os::raw::c_void;
use std::sync::Arc;

/// A set of particles of one material on one grid. A stepper takes it over, and lends it as [`LentParticles`], which has
/// what there is to be done with it.
pub struct Particles(Box<LentParticles>);

/// A set of particles where it is. It has no size, so that nobody exchanges the set of a stepper for another.
pub struct LentParticles<S: ?Sized = [()]> {
    pub(crate) context: Arc<Core>,
    pub(crate) handle: *mut sys::mpm_particles,
    grid: Grid,
    material: Material,
    _sizeless: S,
}

// SAFETY: the handle is used by an Entry only.
unsafe impl Send for LentParticles {}
unsafe impl Sync for LentParticles {}

owns!(Particles, LentParticles);

/// What a fill has added.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Filled {
    /// Id of the first of the new particles; the others follow.
    pub first_id: i64,
    /// How many there are.
    pub count: i64,
}

/// A field of a set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldInfo {
    /// Its name.
    pub name: String,
    /// `MPM_F64`, `MPM_I64` or `MPM_U8`.
    pub r#type: i32,
    /// Components of copies.
    pub components: usize,
    /// Whether the host may write it.
    pub writable: bool,
}

impl Particles {
    /// Makes an empty set.
    pub fn new(grid: &Grid, material: &Material) -> Result<Self> {
        let context = grid.core.context.clone();
        if !Arc::ptr_eq(&context, &material.core.context) {
            return Err(Error::argument("grid and material are of different contexts"));
        }
        let mut handle = std::ptr::null_mut();
        let entry = context.enter()?;
        // SAFETY: grid and material outlive the set, which keeps them.
        let status =
            unsafe { sys::mpm_particles_create(context.handle, grid.as_ptr(), material.as_ptr(), &mut handle) };
        entry.done(status)?;
        let (grid, material) = (grid.clone(), material.clone());
        Ok(Particles(Box::new(LentParticles { context, handle, grid, material, _sizeless: [] })))
    }
}

impl LentParticles {
    /// The dimension of the grid.
    pub fn dim(&self) -> usize {
        self.grid.dim()
    }

    /// The number of particles. May be called in callbacks.
    pub fn len(&self) -> usize {
        // SAFETY: free to be called at any time while the set lives.
        unsafe { sys::mpm_particles_count(self.handle) as usize }
    }

    /// Whether there are no particles.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Adds particles at `position`, which is `[dim][n]`, of so many volumes; the others may be left out. Gives the first id.
    pub fn add(
        &mut self,
        position: &[f64],
        volume: &[f64],
        velocity: Option<&[f64]>,
        size: Option<&[f64]>,
        ids: Option<&[i64]>,
    ) -> Result<i64> {
        let (n, all) = (volume.len(), volume.len() * self.dim());
        fits("position", position.len(), all)?;
        velocity.map_or(Ok(()), |v| fits("velocity", v.len(), all))?;
        size.map_or(Ok(()), |s| fits("size", s.len(), all))?;
        ids.map_or(Ok(()), |i| fits("ids", i.len(), n))?;
        let mut first = 0;
        let entry = self.context.enter()?;
        // SAFETY: all lengths were checked.
        let status = unsafe {
            sys::mpm_particles_add(
                self.handle,
                n as i64,
                position.as_ptr(),
                pointer(velocity),
                volume.as_ptr(),
                pointer(size),
                pointer(ids),
                &mut first,
            )
        };
        entry.done(status)?;
        Ok(first)
    }

    /// Fills a box, with so many particles along each axis of a cell.
    pub fn fill_box(&mut self, lower: &[f64], upper: &[f64], per_cell: &[i32]) -> Result<Filled> {
        self.axes(&[lower.len(), upper.len(), per_cell.len()])?;
        let mut out = Filled { first_id: 0, count: 0 };
        let entry = self.context.enter()?;
        // SAFETY: all lengths were checked.
        let status = unsafe {
            sys::mpm_particles_fill_box(
                self.handle,
                lower.as_ptr(),
                upper.as_ptr(),
                per_cell.as_ptr(),
                &mut out.first_id,
                &mut out.count,
            )
        };
        entry.done(status)?;
        Ok(out)
    }

    /// Fills a ball; in 2-D a disc, in 1-D an interval.
    pub fn fill_ball(&mut self, centre: &[f64], radius: f64, per_cell: &[i32]) -> Result<Filled> {
        self.axes(&[centre.len(), per_cell.len()])?;
        let mut out = Filled { first_id: 0, count: 0 };
        let entry = self.context.enter()?;
        // SAFETY: all lengths were checked.
        let status = unsafe {
            sys::mpm_particles_fill_ball(
                self.handle,
                centre.as_ptr(),
                radius,
                per_cell.as_ptr(),
                &mut out.first_id,
                &mut out.count,
            )
        };
        entry.done(status)?;
        Ok(out)
    }

    /// Fills what a mesh encloses: `position` is `[dim][n]`, `corner` `[elements][dim]` with numbers of points.
    pub fn fill_mesh(&mut self, position: &[f64], corner: &[i64], per_cell: &[i32]) -> Result<Filled> {
        self.axes(&[per_cell.len()])?;
        let (n, elements) = (position.len() / self.dim(), corner.len() / self.dim());
        fits("position", position.len(), n * self.dim())?;
        fits("corner", corner.len(), elements * self.dim())?;
        let mut out = Filled { first_id: 0, count: 0 };
        let entry = self.context.enter()?;
        // SAFETY: all lengths were checked, and the library sees that corners exist.
        let status = unsafe {
            sys::mpm_particles_fill_mesh(
                self.handle,
                n as i64,
                position.as_ptr(),
                elements as i64,
                corner.as_ptr(),
                per_cell.as_ptr(),
                &mut out.first_id,
                &mut out.count,
            )
        };
        entry.done(status)?;
        Ok(out)
    }

    /// Fills that part of a box which a function accepts: it is shown positions, and sets `inside[i]` to 1 or 0.
    pub fn fill(
        &mut self,
        lower: &[f64],
        upper: &[f64],
        per_cell: &[i32],
        mut inside: impl FnMut(&[&[f64]], &mut [u8]) -> Flow,
    ) -> Result<Filled> {
        self.axes(&[lower.len(), upper.len(), per_cell.len()])?;
        type InsideFn<'a> = dyn FnMut(&[&[f64]], &mut [u8]) -> Flow + 'a;
        unsafe extern "C" fn on_inside(
            user: *mut c_void,
            dim: i32,
            n: i64,
            ld: i64,
            position: *const f64,
            inside: *mut u8,
        ) -> i32 {
            let slot = &mut *user.cast::<Slot<InsideFn>>();
            let function = &mut slot.function;
            slot.thrown.guard(|| {
                let axes: Vec<&[f64]> =
                    (0..dim as usize).map(|c| crate::batch::column(position, ld, n, c, dim as usize)).collect();
                function(&axes, std::slice::from_raw_parts_mut(inside, n as usize))
            })
        }
        let mut slot: Slot<InsideFn> = Slot { thrown: self.context.thrown.clone(), function: Box::new(&mut inside) };
        let user: *mut Slot<InsideFn> = &mut slot;
        let mut out = Filled { first_id: 0, count: 0 };
        let entry = self.context.enter()?;
        // SAFETY: all lengths were checked, and the function is used during the call.
        let status = unsafe {
            sys::mpm_particles_fill(
                self.handle,
                lower.as_ptr(),
                upper.as_ptr(),
                per_cell.as_ptr(),
                Some(on_inside),
                user.cast(),
                &mut out.first_id,
                &mut out.count,
            )
        };
        entry.done(status)?;
        Ok(out)
    }

    /// Removes particles by id: all or none.
    pub fn remove(&mut self, ids: &[i64]) -> Result<()> {
        let entry = self.context.enter()?;
        // SAFETY: the ids are as many as is said.
        let status = unsafe { sys::mpm_particles_remove(self.handle, ids.len() as i64, ids.as_ptr()) };
        entry.done(status)
    }

    /// Packs the particles with the given ids in this order, or all by ascending id, for [`Self::unpack`]: see
    /// `mpm_particles_pack()`.
    pub fn pack(&self, ids: Option<&[i64]>) -> Result<Vec<u8>> {
        let (n, first) = ids.map_or((self.len(), std::ptr::null()), |ids| (ids.len(), ids.as_ptr()));
        let mut bytes = 0;
        let entry = self.context.enter()?;
        // SAFETY: the handle lives, and the number is written during the call.
        let status = unsafe { sys::mpm_particles_packed_size(self.handle, n as i64, &mut bytes) };
        entry.done(status)?;
        let mut out = vec![0u8; bytes as usize];
        let entry = self.context.enter()?;
        // SAFETY: the ids are as many as is said, and so are the bytes.
        let status =
            unsafe { sys::mpm_particles_pack(self.handle, n as i64, first, out.as_mut_ptr().cast(), bytes) };
        entry.done(status)?;
        Ok(out)
    }

    /// Adds particles that [`Self::pack`] has given, of this set or of another: all or none.
    pub fn unpack(&mut self, packed: &[u8]) -> Result<()> {
        let entry = self.context.enter()?;
        // SAFETY: the bytes are as many as is said.
        let status =
            unsafe { sys::mpm_particles_unpack(self.handle, packed.as_ptr().cast(), packed.len() as i64) };
        entry.done(status)
    }

    /// All fields.
    pub fn fields(&self) -> Result<Vec<FieldInfo>> {
        let mut out = Vec::new();
        loop {
            let (mut name, mut kind, mut components, mut writable) = (std::ptr::null(), 0, 0, 0);
            let entry = self.context.enter()?;
            // SAFETY: the name is copied at once.
            let status = unsafe {
                sys::mpm_particles_field_info(
                    self.handle,
                    out.len() as i32,
                    &mut name,
                    &mut kind,
                    &mut components,
                    &mut writable,
                )
            };
            match entry.done(status) {
                Err(error) if error.status() == sys::MPM_E_NOT_FOUND => return Ok(out),
                other => other?,
            }
            let (name, components) = (text_of(name), components as usize);
            out.push(FieldInfo { name, r#type: kind, components, writable: writable != 0 });
        }
    }

    /// Adds a field of the host, zero in every particle.
    pub fn add_field<T: Element>(&mut self, name: &str, components: usize) -> Result<()> {
        let name = c_text(name)?;
        let components = i32::try_from(components).unwrap_or(i32::MAX);
        let entry = self.context.enter()?;
        // SAFETY: the name ends with a zero.
        let status = unsafe { sys::mpm_particles_add_field(self.handle, name.as_ptr(), T::TYPE, components) };
        entry.done(status)
    }

    /// Lends a field for reading. Several may be out.
    pub fn map<T: Element>(&self, field: &str) -> Result<View<'_, T>> {
        if self.grid.core.sheet && field == "deformation_gradient" {
            // a sheet's strain across follows from its stress, which the library may find when it is asked for: not
            // while a view shows the strain
            self.lend::<f64>("volume", sys::MPM_READ)?;
        }
        Ok(View::of(self.lend::<T>(field, sys::MPM_READ)?))
    }

    /// Lends a field for reading and writing.
    pub fn map_mut<T: Element>(&mut self, field: &str) -> Result<ViewMut<'_, T>> {
        Ok(ViewMut::of(self.lend::<T>(field, sys::MPM_READ | sys::MPM_WRITE)?))
    }

    fn lend<T: Element>(&self, field: &str, access: i32) -> Result<Lent> {
        let name = c_text(field)?;
        // SAFETY: the name ends with a zero, and the view is given back.
        Lent::new::<T>(&self.context, field, access, |access, view| unsafe {
            sys::mpm_particles_map(self.handle, name.as_ptr(), access, view)
        })
    }

    /// Copies a field of all particles by ascending id: `[components][n]`, tensors in full.
    pub fn get<T: Element>(&self, field: &str) -> Result<Vec<T>> {
        self.copy(field, self.len(), None)
    }

    /// Copies a field of particles by id.
    pub fn get_of<T: Element>(&self, field: &str, ids: &[i64]) -> Result<Vec<T>> {
        self.copy(field, ids.len(), Some(ids))
    }

    fn copy<T: Element>(&self, field: &str, n: usize, ids: Option<&[i64]>) -> Result<Vec<T>> {
        let of = Field { name: field, components: self.components(field)?, n, ids };
        of.copied(&self.context, sys::mpm_particles_get, self.handle)
    }

    /// Sets a field of all particles, laid out as in [`Self::get`].
    pub fn set<T: Element>(&mut self, field: &str, values: &[T]) -> Result<()> {
        self.overwrite(field, self.len(), None, values)
    }

    /// Sets a field of particles by id.
    pub fn set_of<T: Element>(&mut self, field: &str, ids: &[i64], values: &[T]) -> Result<()> {
        self.overwrite(field, ids.len(), Some(ids), values)
    }

    fn overwrite<T: Element>(&mut self, field: &str, n: usize, ids: Option<&[i64]>, values: &[T]) -> Result<()> {
        let of = Field { name: field, components: self.components(field)?, n, ids };
        of.overwritten(&self.context, sys::mpm_particles_set, self.handle, values)
    }

    /// Sets a field to one value in every particle.
    pub fn set_all<T: Element>(&mut self, field: &str, value: &[T]) -> Result<()> {
        let name = c_text(field)?;
        let entry = self.context.enter()?;
        // SAFETY: the library compares type and components with those of the field.
        let status = unsafe {
            sys::mpm_particles_set_all(self.handle, name.as_ptr(), T::TYPE, value.len() as i32, value.as_ptr().cast())
        };
        entry.done(status)
    }

    fn components(&self, field: &str) -> Result<usize> {
        let found = self.fields()?.into_iter().find(|one| one.name == field);
        // an unknown name goes on to the library, which lists the nearest
        Ok(found.map_or(1, |one| one.components))
    }

    /// Gives all particles the stress of ground at rest: see `mpm_particles_set_geostatic()`.
    #[allow(non_snake_case)]
    pub fn set_geostatic(&mut self, axis: i32, gravity: f64, surface: f64, K0: f64, surcharge: f64) -> Result<()> {
        let entry = self.context.enter()?;
        // SAFETY: the handle lives.
        let status = unsafe { sys::mpm_particles_set_geostatic(self.handle, axis, gravity, surface, K0, surcharge) };
        entry.done(status)
    }

    /// Makes the present state the one from which all deformation counts: see `mpm_particles_reset_reference()`.
    pub fn reset_reference(&mut self) -> Result<()> {
        let entry = self.context.enter()?;
        // SAFETY: the handle lives.
        let status = unsafe { sys::mpm_particles_reset_reference(self.handle) };
        entry.done(status)
    }

    /// Writes a .vtp file with the named fields; with none all that are in use.
    pub fn write(&self, path: &str, fields: &[&str]) -> Result<()> {
        let path = c_text(path)?;
        let (_held, names) = c_texts(fields)?;
        let entry = self.context.enter()?;
        // SAFETY: all texts end with a zero.
        let status =
            unsafe { sys::mpm_write_particles(self.handle, path.as_ptr(), names.len() as i32, names.as_ptr()) };
        entry.done(status)
    }

    /// The handle of C.
    pub fn as_ptr(&self) -> *mut sys::mpm_particles {
        self.handle
    }

    fn axes(&self, lengths: &[usize]) -> Result<()> {
        lengths.iter().try_for_each(|&length| fits("vector", length, self.dim()))
    }
}

impl<S: ?Sized> Drop for LentParticles<S> {
    fn drop(&mut self) {
        let (handle, keep) = (Sent(self.handle), (self.grid.clone(), self.material.clone()));
        self.context.bury(move || {
            // SAFETY: nobody else has the handle. Where it is refused the grid and the material refuse, too.
            unsafe { sys::mpm_particles_destroy(handle.get()) };
            drop(keep);
        });
    }
}
