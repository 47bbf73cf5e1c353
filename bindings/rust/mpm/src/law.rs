//! Laws of the host.
use crate::batch::{column, field};
use crate::callback::{shared, Owned};
use crate::{sys, Columns, Element, Flow, Result};
use std::os::raw::c_void;

pub(crate) type StressFn = dyn Fn(&MaterialBatch<'_>, &mut Response<'_>) -> Flow + Send + Sync;
pub(crate) type TangentFn =
    dyn Fn(&MaterialBatch<'_>, &mut Columns<'_, f64>) -> std::result::Result<bool, crate::Refusal> + Send + Sync;

/// A constitutive law of the host.
pub struct Law {
    /// Mass per initial volume.
    pub density: f64,
    /// State of a new particle: as many variables as it has.
    pub state: Vec<f64>,
    pub(crate) stress: Box<StressFn>,
    pub(crate) tangent: Option<(i32, Box<TangentFn>)>,
}

impl Law {
    /// A law without state (mt): see `mpm_stress_fn`.
    pub fn new(
        density: f64,
        stress: impl Fn(&MaterialBatch<'_>, &mut Response<'_>) -> Flow + Send + Sync + 'static,
    ) -> Self {
        Law { density, state: Vec::new(), stress: Box::new(stress), tangent: None }
    }
    /// With state variables, which start with these values.
    pub fn state(mut self, initial: &[f64]) -> Self {
        self.state = initial.to_vec();
        self
    }
    /// With a tangent (mt) of the form `MPM_TANGENT_MINOR_SYMMETRIC` or `MPM_TANGENT_GENERAL`, for implicit steps. The
    /// function tells whether it is symmetric: see `mpm_tangent_fn`. Its outputs for stress are not shown again: it works
    /// from the same inputs.
    pub fn tangent(
        mut self,
        form: i32,
        tangent: impl Fn(&MaterialBatch<'_>, &mut Columns<'_, f64>) -> std::result::Result<bool, crate::Refusal>
            + Send
            + Sync
            + 'static,
    ) -> Self {
        self.tangent = Some((form, Box::new(tangent)));
        self
    }
}

/// Particles that a law is asked about.
#[derive(Clone, Copy)]
pub struct MaterialBatch<'a>(&'a sys::mpm_material_batch);

macro_rules! inputs {
    ($($(#[$doc:meta])* $method:ident = $field:ident[$components:expr];)*) => {$(
        $(#[$doc])*
        pub fn $method(&self, component: usize) -> &'a [f64] {
            // SAFETY: the library lends the array during the call.
            unsafe { column(self.0.$field, self.0.ld, self.0.n, component, $components(self)) }
        }
    )*};
}

impl<'a> MaterialBatch<'a> {
    /// The number of particles, inert slots included.
    pub fn len(&self) -> usize {
        self.0.n as usize
    }
    /// Whether there are no particles.
    pub fn is_empty(&self) -> bool {
        self.0.n == 0
    }
    /// The time at the end of the step.
    pub fn t(&self) -> f64 {
        self.0.t
    }
    /// The size of the step; 0: the state as it is.
    pub fn dt(&self) -> f64 {
        self.0.dt
    }
    /// Ids; below 0 for inert slots.
    pub fn id(&self) -> &'a [i64] {
        // SAFETY: the library lends [ld] during the call.
        unsafe { column(self.0.id, self.0.ld, self.0.n, 0, 1) }
    }
    /// The struct of C.
    pub fn raw(&self) -> &'a sys::mpm_material_batch {
        self.0
    }
    inputs!(
        /// Component `3 * row + column` of the deformation gradient at the end of the step.
        deformation_gradient = F[|_: &Self| 9];
        /// The same of that of this step alone.
        increment = F_inc[|_: &Self| 9];
        /// The same of the velocity gradient.
        velocity_gradient = L[|_: &Self| 9];
        /// Of the stress before the step xx, yy, zz, xy, yz or xz.
        stress = stress[|_: &Self| 6];
        /// A state variable before the step.
        state = state[|batch: &Self| batch.0.state_count as usize];
    );
    /// A stored component of any field of the set, as views have them.
    ///
    /// # Safety
    /// The field holds elements of type `T`, and has the component: nothing checks it here.
    pub unsafe fn field<T: Element>(&self, name: &str, component: usize) -> Result<&'a [T]> {
        field(self.0.lookup, self.0.n, name, component)
    }
}

/// What a law writes, of each particle.
pub struct Response<'a> {
    /// Stress after the step: xx yy zz xy yz xz.
    pub stress: Columns<'a, f64>,
    /// State variables after the step.
    pub state: Columns<'a, f64>,
    /// Speed of the fastest elastic wave.
    pub wave_speed: Columns<'a, f64>,
    /// Preset 0: length^2/time, limits the explicit dt.
    pub kinematic_viscosity: Columns<'a, f64>,
    /// Preset NaN, which is not known: strain energy per initial volume.
    pub energy: Columns<'a, f64>,
}

pub(crate) struct LawSlots {
    pub stress: Owned<StressFn>,
    pub tangent: Option<Owned<TangentFn>>,
}

/// C has one user pointer for both functions.
pub(crate) unsafe extern "C" fn on_stress(user: *mut c_void, batch: *const sys::mpm_material_batch) -> i32 {
    let slot = shared::<StressFn>((*user.cast::<LawSlots>()).stress.user());
    let raw = &*batch;
    slot.thrown.guard(|| {
        let columns = |data, components| Columns::new(data, raw.ld, raw.n, components);
        let mut response = Response {
            stress: columns(raw.stress_new, 6),
            state: columns(raw.state_new, raw.state_count as usize),
            wave_speed: columns(raw.wave_speed, 1),
            kinematic_viscosity: columns(raw.kinematic_viscosity, 1),
            energy: columns(raw.energy, 1),
        };
        (slot.function)(&MaterialBatch(raw), &mut response)
    })
}

pub(crate) unsafe extern "C" fn on_tangent<const COMPONENTS: usize>(
    user: *mut c_void,
    batch: *const sys::mpm_material_batch,
    tangent: *mut f64,
    symmetric: *mut i32,
) -> i32 {
    let slots = &*user.cast::<LawSlots>();
    let slot = shared::<TangentFn>(slots.tangent.as_ref().map_or(std::ptr::null_mut(), Owned::user));
    let raw = &*batch;
    slot.thrown.guard(|| {
        let mut columns = Columns::new(tangent, raw.ld, raw.n, COMPONENTS);
        *symmetric = (slot.function)(&MaterialBatch(raw), &mut columns)?.into();
        Ok(())
    })
}
