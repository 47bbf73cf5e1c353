//! What functions of the host are shown: arrays of C, component by component.
use crate::error::{c_text, text_of};
use crate::{sys, Element, Error, Result};
use std::marker::PhantomData;
use std::ops::{Index, IndexMut};
use std::os::raw::c_void;

/// Components of items, to be read and written: component `c` of item `i` is `columns[(i, c)]`.
pub struct Columns<'a, T> {
    data: *mut T,
    ld: usize,
    items: usize,
    components: usize,
    what: PhantomData<&'a mut [T]>,
}

impl<'a, T> Columns<'a, T> {
    /// # Safety
    /// `data` is `[components][ld]` and nobody else's for `'a`, or there are no components.
    pub(crate) unsafe fn new(data: *mut T, ld: i64, items: i64, components: usize) -> Self {
        Columns { data, ld: ld as usize, items: items as usize, components, what: PhantomData }
    }
    /// The number of items.
    pub fn len(&self) -> usize {
        self.items
    }
    /// Whether there are no items.
    pub fn is_empty(&self) -> bool {
        self.items == 0
    }
    /// The number of components.
    pub fn components(&self) -> usize {
        self.components
    }
    fn at(&self, component: usize) -> *mut T {
        assert!(component < self.components, "there are {} components", self.components);
        // SAFETY: the component is in range.
        unsafe { self.data.add(component * self.ld) }
    }
    /// A component of all items.
    pub fn column(&self, component: usize) -> &[T] {
        // SAFETY: see new().
        unsafe { std::slice::from_raw_parts(self.at(component), self.items) }
    }
    /// A component of all items, to be written.
    pub fn column_mut(&mut self, component: usize) -> &mut [T] {
        // SAFETY: see new().
        unsafe { std::slice::from_raw_parts_mut(self.at(component), self.items) }
    }
    /// All components at once.
    pub fn columns_mut(&mut self) -> Vec<&mut [T]> {
        // SAFETY: see new(); components do not overlap.
        (0..self.components).map(|c| unsafe { std::slice::from_raw_parts_mut(self.at(c), self.items) }).collect()
    }
}

impl<T> Index<(usize, usize)> for Columns<'_, T> {
    type Output = T;
    fn index(&self, (item, component): (usize, usize)) -> &T {
        &self.column(component)[item]
    }
}

impl<T> IndexMut<(usize, usize)> for Columns<'_, T> {
    fn index_mut(&mut self, (item, component): (usize, usize)) -> &mut T {
        &mut self.column_mut(component)[item]
    }
}

/// A component of an array that C lends for reading.
///
/// # Safety
/// `data` is `[components][ld]` with `n <= ld`, and is not written for `'a`.
pub(crate) unsafe fn column<'a, T>(data: *const T, ld: i64, n: i64, component: usize, components: usize) -> &'a [T] {
    assert!(component < components, "there are {components} components");
    std::slice::from_raw_parts(data.add(component * ld as usize), n as usize)
}

/// A component of a field of the set that a batch belongs to.
///
/// # Safety
/// `lookup` is that of a batch of `n` items under way; the field holds `T` and has the component.
pub(crate) unsafe fn field<'a, T: Element>(
    lookup: *const c_void,
    n: i64,
    field: &str,
    component: usize,
) -> Result<&'a [T]> {
    let name = c_text(field)?;
    let (mut data, mut stride) = (std::ptr::null(), 0);
    let status = sys::mpm_batch_field(lookup, name.as_ptr(), &mut data, &mut stride);
    if status != sys::MPM_OK {
        return Err(Error::new(status, format!("\"{field}\": {}", text_of(sys::mpm_status_text(status)))));
    }
    Ok(std::slice::from_raw_parts(data.cast::<T>().add(component * stride as usize), n as usize))
}

macro_rules! batch {
    ($(#[$doc:meta])* $name:ident, $raw:ident, { $($(#[$fdoc:meta])* $method:ident: $type:ty, $kind:ident;)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub struct $name<'a>(pub(crate) &'a sys::$raw);

        // nodes have an "index" in C
        #[allow(clippy::should_implement_trait)]
        impl<'a> $name<'a> {
            /// The number of items.
            pub fn len(&self) -> usize {
                self.0.n as usize
            }
            /// Whether there are no items.
            pub fn is_empty(&self) -> bool {
                self.0.n == 0
            }
            /// The dimension of the grid.
            pub fn dim(&self) -> usize {
                self.0.dim as usize
            }
            /// The time.
            pub fn t(&self) -> f64 {
                self.0.t
            }
            /// The struct of C.
            pub fn raw(&self) -> &'a sys::$raw {
                self.0
            }
            $(batch!(@method $(#[$fdoc])* $method: $type, $kind);)*
        }
    };
    (@method $(#[$fdoc:meta])* $method:ident: $type:ty, axes) => {
        $(#[$fdoc])*
        pub fn $method(&self, component: usize) -> &'a [$type] {
            // SAFETY: the library lends [dim][ld] during the call.
            unsafe { column(self.0.$method, self.0.ld, self.0.n, component, self.dim()) }
        }
    };
    (@method $(#[$fdoc:meta])* $method:ident: $type:ty, one) => {
        $(#[$fdoc])*
        pub fn $method(&self) -> &'a [$type] {
            // SAFETY: the library lends [ld] during the call.
            unsafe { column(self.0.$method, self.0.ld, self.0.n, 0, 1) }
        }
    };
}

batch!(
    /// Particles of a set for which something is wanted.
    ParticleBatch, mpm_particle_batch, {
        /// Ids; below 0 for inert slots.
        id: i64, one;
        /// A component of the position at the start of the step.
        position: f64, axes;
        /// A component of the velocity at the start of the step.
        velocity: f64, axes;
        /// Masses.
        mass: f64, one;
        /// Volumes at the start of the step.
        volume: f64, one;
    }
);

impl<'a> ParticleBatch<'a> {
    /// The size of the step.
    pub fn dt(&self) -> f64 {
        self.0.dt
    }
    /// A component of the reference position, where the stepper keeps it.
    pub fn reference_position(&self, component: usize) -> Option<&'a [f64]> {
        if self.0.reference_position.is_null() {
            return None;
        }
        // SAFETY: the library lends [dim][ld] during the call.
        Some(unsafe { column(self.0.reference_position, self.0.ld, self.0.n, component, self.dim()) })
    }
    /// A stored component of any field of the set, as views have them.
    ///
    /// # Safety
    /// The field holds elements of type `T`, and has the component: nothing checks it here.
    pub unsafe fn field<T: Element>(&self, name: &str, component: usize) -> Result<&'a [T]> {
        field(self.0.lookup, self.0.n, name, component)
    }
}

batch!(
    /// Active nodes of the grid.
    NodeBatch, mpm_node_batch, {
        /// A component of the index of the nodes.
        index: i64, axes;
        /// A component of their position.
        position: f64, axes;
        /// Masses.
        mass: f64, one;
        /// 1 on one of the parts that have the node, which sums of the host count.
        owned: u8, one;
    }
);

impl NodeBatch<'_> {
    /// The size of the step.
    pub fn dt(&self) -> f64 {
        self.0.dt
    }
    /// The velocity field: see [`Stepper::set_body`](crate::Stepper::set_body).
    pub fn body(&self) -> i32 {
        self.0.body
    }
}

batch!(
    /// Nodes at which two bodies touch.
    ContactBatch, mpm_contact_batch, {
        /// A component of the position of the nodes.
        position: f64, axes;
        /// A component of the unit normal, from the first body to the second.
        normal: f64, axes;
        /// Gaps.
        gap: f64, one;
        /// Areas.
        area: f64, one;
        /// A component of the tangential velocity of the second body relative to the first.
        slip: f64, axes;
        /// Normal tractions of the frictionless impulse.
        pressure: f64, one;
    }
);

impl ContactBatch<'_> {
    /// The size of the step.
    pub fn dt(&self) -> f64 {
        self.0.dt
    }
    /// The two bodies, the lower number first.
    pub fn bodies(&self) -> (i32, i32) {
        (self.0.body_a, self.0.body_b)
    }
}

batch!(
    /// Points whose distance from an obstacle is asked for, in axes of the body from its centre.
    DistanceBatch, mpm_distance_batch, {
        /// A component of the position.
        position: f64, axes;
    }
);

batch!(
    /// Markers for which tractions are wanted.
    MarkerBatch, mpm_marker_batch, {
        /// Ids, ascending.
        id: i64, one;
        /// A component of the position.
        position: f64, axes;
        /// A component of the area vectors, which point out of the material.
        area: f64, axes;
        /// Areas when the markers were added.
        reference_area: f64, one;
        /// A component of the displacement since the markers were added.
        displacement: f64, axes;
        /// A component of the velocity of the material there, in the last step.
        velocity: f64, axes;
    }
);

impl MarkerBatch<'_> {
    /// The size of the step.
    pub fn dt(&self) -> f64 {
        self.0.dt
    }
}

/// Particles that are to be split, or pairs that are to be merged.
#[derive(Clone, Copy)]
pub struct AdaptionBatch<'a>(pub(crate) &'a sys::mpm_adaption_batch);

impl<'a> AdaptionBatch<'a> {
    /// How many particles or pairs there are.
    pub fn len(&self) -> usize {
        self.0.n as usize
    }
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.n == 0
    }
    /// The dimension of the grid.
    pub fn dim(&self) -> usize {
        self.0.dim as usize
    }
    /// `MPM_ADAPT_SPLIT` or `MPM_ADAPT_MERGE`.
    pub fn what(&self) -> i32 {
        self.0.what
    }
    /// Ids, ascending; of pairs those of the particles that stay.
    pub fn id(&self) -> &'a [i64] {
        // SAFETY: the library lends [ld] during the call.
        unsafe { column(self.0.id, self.0.ld, self.0.n, 0, 1) }
    }
    /// Of pairs the ids of the particles that go.
    pub fn other(&self) -> Option<&'a [i64]> {
        if self.0.other.is_null() {
            return None;
        }
        // SAFETY: the library lends [ld] during the call.
        Some(unsafe { column(self.0.other, self.0.ld, self.0.n, 0, 1) })
    }
    /// A component of the position of the particle, or of the one that stays.
    pub fn position(&self, component: usize) -> &'a [f64] {
        // SAFETY: the library lends [dim][ld] during the call.
        unsafe { column(self.0.position, self.0.ld, self.0.n, component, self.dim()) }
    }
    /// The struct of C.
    pub fn raw(&self) -> &'a sys::mpm_adaption_batch {
        self.0
    }
}

/// What is to be said of the points.
pub struct Distances<'a> {
    /// Signed distance, above 0 outside: one component.
    pub distance: Columns<'a, f64>,
    /// Unit gradient of the distance: `dim` components.
    pub normal: Columns<'a, f64>,
    /// Velocity of the surface beside the rigid motion, preset to 0, where it is asked for: `dim` components.
    pub velocity: Option<Columns<'a, f64>>,
}
