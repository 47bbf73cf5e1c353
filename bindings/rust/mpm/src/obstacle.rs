//! Obstacles: rigid bodies without particles.
use crate::callback::{alone, shared, user_of, Owned};
use crate::entry::{owns, Core, Sent};
use crate::{sys, Columns, ContactDesc, ContactInfo, Context, DistanceBatch, Distances, Flow, Result};
use std::os::raw::c_void;
use std::sync::Arc;

/// Distances (mt) of points from an obstacle.
pub type DistanceFn = dyn Fn(&DistanceBatch<'_>, &mut Distances<'_>) -> Flow + Send + Sync;
type MotionFn = dyn FnMut(f64, f64, &mut [f64; 3], &mut [f64; 3]) -> Flow + Send;

/// What an obstacle is made from: the fields of `mpm_obstacle_desc`.
pub struct ObstacleDesc {
    /// An `MPM_SHAPE_...`.
    pub shape: i32,
    /// An `MPM_MOTION_...`.
    pub motion: i32,
    /// Whether the material is inside.
    pub inside: bool,
    /// Lengths of the shape.
    pub size: [f64; 3],
    /// Where it is, and how it moves.
    pub pose: Pose,
    /// Mass of a free one.
    pub mass: f64,
    /// Inertia of a free one, row by row.
    pub inertia: [f64; 9],
    /// How it meets the material.
    pub contact: Option<ContactDesc>,
    /// Lower corner of the box of `MPM_SHAPE_DISTANCE`.
    pub lower: [f64; 3],
    /// Its upper corner.
    pub upper: [f64; 3],
    /// The distances of `MPM_SHAPE_DISTANCE`.
    pub distance: Option<Box<DistanceFn>>,
}

/// Where an obstacle is, and how it moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Of the centre.
    pub position: [f64; 3],
    /// Unit quaternion w, x, y, z.
    pub orientation: [f64; 4],
    /// Of the centre.
    pub velocity: [f64; 3],
    /// In space.
    pub angular_velocity: [f64; 3],
}

impl Default for Pose {
    fn default() -> Self {
        let zeros = [0.0; 3];
        Pose { position: zeros, orientation: [1.0, 0.0, 0.0, 0.0], velocity: zeros, angular_velocity: zeros }
    }
}

impl ObstacleDesc {
    /// The defaults, and a shape.
    pub fn new(shape: i32) -> Self {
        let raw = sys::mpm_obstacle_desc::default();
        ObstacleDesc {
            shape,
            motion: raw.motion,
            inside: raw.inside != 0,
            size: raw.size,
            pose: Pose::default(),
            mass: raw.mass,
            inertia: raw.inertia,
            contact: None,
            lower: raw.lower,
            upper: raw.upper,
            distance: None,
        }
    }
    /// With the distances (mt) of `MPM_SHAPE_DISTANCE`.
    pub fn distance(
        mut self,
        distance: impl Fn(&DistanceBatch<'_>, &mut Distances<'_>) -> Flow + Send + Sync + 'static,
    ) -> Self {
        self.distance = Some(Box::new(distance));
        self
    }
}

/// A rigid body without particles. A stepper takes it over, and lends it as [`LentObstacle`], which has what there is to
/// be done with it.
pub struct Obstacle(Box<LentObstacle>);

/// An obstacle where it is. It has no size, so that nobody exchanges the obstacle of a stepper for another.
pub struct LentObstacle<S: ?Sized = [()]> {
    pub(crate) context: Arc<Core>,
    pub(crate) handle: *mut sys::mpm_obstacle,
    distance: Option<Owned<DistanceFn>>,
    motion: Option<Owned<MotionFn>>,
    _sizeless: S,
}

// SAFETY: the handle is used by an Entry only, and so is the function of the motion.
unsafe impl Send for LentObstacle {}
unsafe impl Sync for LentObstacle {}

owns!(Obstacle, LentObstacle);

impl Obstacle {
    /// Makes an obstacle.
    pub fn new(context: &Context, desc: ObstacleDesc) -> Result<Self> {
        let core = &context.core;
        let distance = desc.distance.map(|function| Owned::<DistanceFn>::new(&core.thrown, function));
        let contact = desc.contact.map(sized);
        let raw = sys::mpm_obstacle_desc {
            shape: desc.shape,
            motion: desc.motion,
            inside: desc.inside.into(),
            size: desc.size,
            position: desc.pose.position,
            orientation: desc.pose.orientation,
            velocity: desc.pose.velocity,
            angular_velocity: desc.pose.angular_velocity,
            mass: desc.mass,
            inertia: desc.inertia,
            contact: contact.as_ref().map_or(std::ptr::null(), |contact| contact),
            distance: distance.as_ref().and(Some(on_distance)),
            user: user_of(&distance),
            lower: desc.lower,
            upper: desc.upper,
            ..Default::default()
        };
        let mut handle = std::ptr::null_mut();
        let entry = core.enter()?;
        // SAFETY: the descriptor is whole, and the function outlives the obstacle.
        let status = unsafe { sys::mpm_obstacle_create(core.handle, &raw, &mut handle) };
        entry.done(status)?;
        let (context, motion) = (core.clone(), None);
        Ok(Obstacle(Box::new(LentObstacle { context, handle, distance, motion, _sizeless: [] })))
    }
}

impl LentObstacle {
    /// Sets what gives velocity and angular velocity of the step from `t` over `dt`, both preset to the present ones.
    pub fn set_motion(
        &mut self,
        motion: impl FnMut(f64, f64, &mut [f64; 3], &mut [f64; 3]) -> Flow + Send + 'static,
    ) -> Result<()> {
        let slot = Owned::<MotionFn>::new(&self.context.thrown, Box::new(motion));
        let entry = self.context.enter()?;
        // SAFETY: the old function goes only once the library has taken the new one.
        let status = unsafe { sys::mpm_obstacle_set_motion(self.handle, Some(on_motion), slot.user()) };
        entry.done(status)?;
        self.motion = Some(slot);
        Ok(())
    }

    /// Takes the function away: the obstacle keeps its velocities.
    pub fn clear_motion(&mut self) -> Result<()> {
        let entry = self.context.enter()?;
        // SAFETY: the handle lives.
        let status = unsafe { sys::mpm_obstacle_set_motion(self.handle, None, std::ptr::null_mut()) };
        entry.done(status)?;
        self.motion = None;
        Ok(())
    }

    /// Sets how the obstacle meets the material.
    pub fn set_contact(&mut self, contact: &ContactDesc) -> Result<()> {
        let contact = sized(*contact);
        let entry = self.context.enter()?;
        // SAFETY: the descriptor is whole.
        let status = unsafe { sys::mpm_obstacle_set_contact(self.handle, &contact) };
        entry.done(status)
    }

    /// Puts the obstacle somewhere.
    pub fn set_pose(&mut self, pose: &Pose) -> Result<()> {
        let entry = self.context.enter()?;
        // SAFETY: arrays have the lengths that C reads.
        let status = unsafe {
            sys::mpm_obstacle_set_pose(
                self.handle,
                pose.position.as_ptr(),
                pose.orientation.as_ptr(),
                pose.velocity.as_ptr(),
                pose.angular_velocity.as_ptr(),
            )
        };
        entry.done(status)
    }

    /// Where the obstacle is, and how it moves.
    pub fn pose(&self) -> Result<Pose> {
        let mut pose = Pose::default();
        let entry = self.context.enter()?;
        // SAFETY: arrays have the lengths that C writes.
        let status = unsafe {
            sys::mpm_obstacle_get_pose(
                self.handle,
                pose.position.as_mut_ptr(),
                pose.orientation.as_mut_ptr(),
                pose.velocity.as_mut_ptr(),
                pose.angular_velocity.as_mut_ptr(),
            )
        };
        entry.done(status)?;
        Ok(pose)
    }

    /// Sets the force and the torque on a free obstacle.
    pub fn set_load(&mut self, force: [f64; 3], torque: [f64; 3]) -> Result<()> {
        let entry = self.context.enter()?;
        // SAFETY: arrays have the lengths that C reads.
        let status = unsafe { sys::mpm_obstacle_set_load(self.handle, force.as_ptr(), torque.as_ptr()) };
        entry.done(status)
    }

    /// What a body and the obstacle did to each other in the last step; `MPM_BODY_ANY`: all bodies.
    pub fn contact_info(&self, body: i32) -> Result<ContactInfo> {
        let mut info = ContactInfo::default();
        let entry = self.context.enter()?;
        // SAFETY: the struct is whole.
        let status = unsafe { sys::mpm_obstacle_contact_info(self.handle, body, &mut info) };
        entry.done(status)?;
        Ok(info)
    }

    /// The handle of C.
    pub fn as_ptr(&self) -> *mut sys::mpm_obstacle {
        self.handle
    }
}

impl<S: ?Sized> Drop for LentObstacle<S> {
    fn drop(&mut self) {
        let (handle, keep) = (Sent(self.handle), (self.distance.take(), self.motion.take()));
        self.context.bury(move || {
            // SAFETY: nobody else has the handle. While a stepper holds on to it, so it does to the functions.
            if unsafe { sys::mpm_obstacle_destroy(handle.get()) } != sys::MPM_OK {
                std::mem::forget(keep);
            }
        });
    }
}

/// The descriptor with the size that the library is to read.
pub(crate) fn sized(mut desc: ContactDesc) -> ContactDesc {
    desc.struct_size = std::mem::size_of::<ContactDesc>() as u32;
    desc
}

unsafe extern "C" fn on_distance(user: *mut c_void, batch: *const sys::mpm_distance_batch) -> i32 {
    let slot = shared::<DistanceFn>(user);
    let raw = &*batch;
    slot.thrown.guard(|| {
        let dim = raw.dim as usize;
        let columns = |data, components| Columns::new(data, raw.ld, raw.n, components);
        let velocity = if raw.velocity.is_null() { None } else { Some(columns(raw.velocity, dim)) };
        let mut out = Distances { distance: columns(raw.distance, 1), normal: columns(raw.normal, dim), velocity };
        (slot.function)(&DistanceBatch(raw), &mut out)
    })
}

unsafe extern "C" fn on_motion(
    user: *mut c_void,
    t: f64,
    dt: f64,
    velocity: *mut f64,
    angular_velocity: *mut f64,
) -> i32 {
    let slot = alone::<MotionFn>(user);
    let function = &mut slot.function;
    slot.thrown.guard(|| function(t, dt, &mut *velocity.cast::<[f64; 3]>(), &mut *angular_velocity.cast::<[f64; 3]>()))
}
