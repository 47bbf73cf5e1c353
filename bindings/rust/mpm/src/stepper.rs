//! The time loop.
use crate::batch::{AdaptionBatch, ContactBatch, NodeBatch, ParticleBatch};
use crate::callback::{alone, shared, user_of, Owned};
use crate::entry::{Core, Sent};
use crate::error::{c_text, c_texts};
use crate::obstacle::sized;
use crate::view::Lent;
use crate::{
    sys, AdaptionDesc, AdaptionInfo, AdvanceDesc, Columns, ContactDesc, ContactInfo, Element, Error, Flow, Grid,
    HeatDesc, HeatInfo, LentObstacle, LentParticles, LentSurface, LinearSystem, Obstacle, Particles, Profile, Refusal,
    Result, StagedStep, StepInfo, StepperDesc, Surface, View,
};
use std::mem::size_of;
use std::os::raw::c_void;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::Arc;

type ParticleFn = dyn Fn(&ParticleBatch<'_>, &mut Columns<'_, f64>) -> Flow + Send + Sync;
type VelocityFn = dyn Fn(&NodeBatch<'_>, &mut Columns<'_, u8>, &mut Columns<'_, f64>) -> Flow + Send + Sync;
type NodeFn = dyn Fn(&NodeBatch<'_>, &mut Columns<'_, f64>, &mut Columns<'_, f64>) -> Flow + Send + Sync;
type FrictionFn = dyn Fn(&ContactBatch<'_>, &mut [f64]) -> Flow + Send + Sync;
type HeatFn = dyn Fn(&ParticleBatch<'_>, &mut [f64]) -> Flow + Send + Sync;
type AcceptFn = dyn FnMut(&AdaptionBatch<'_>, &mut [u8]) -> Flow + Send;
type SolveFn = dyn FnMut(&mut LinearSystem<'_>) -> std::result::Result<i64, Refusal> + Send;
type ProgressFn = dyn FnMut(&StepInfo) -> Flow + Send;

/// A set of a stepper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SetKey(u64);

/// An obstacle of a stepper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ObstacleKey(u64);

/// A surface of a stepper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SurfaceKey(u64);

fn fresh() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Relaxed)
}

/// What a stepper keeps for C.
#[derive(Default)]
struct Kept {
    sets: Vec<(SetKey, Particles)>,
    obstacles: Vec<(ObstacleKey, Obstacle)>,
    surfaces: Vec<(SurfaceKey, Surface)>,
    motions: Vec<(SetKey, Owned<ParticleFn>)>,
    accepting: Vec<(SetKey, Owned<AcceptFn>)>,
    heating: Vec<(SetKey, Owned<HeatFn>)>,
    acceleration: Option<Owned<ParticleFn>>,
    force: Option<Owned<ParticleFn>>,
    velocity_bc: Option<Owned<VelocityFn>>,
    hooks: [Option<Owned<NodeFn>>; 3],
    friction: Option<Owned<FrictionFn>>,
    solver: Option<Owned<SolveFn>>,
    progress: Option<Owned<ProgressFn>>,
}

/// A time loop with a grid, sets of particles, a scheme, walls and forces.
pub struct Stepper {
    pub(crate) context: Arc<Core>,
    pub(crate) handle: *mut sys::mpm_stepper,
    grid: Grid,
    kept: Kept,
}

// SAFETY: handles are used by an Entry only, and functions in calls.
unsafe impl Send for Stepper {}
unsafe impl Sync for Stepper {}

macro_rules! call {
    ($self:ident, $function:ident($($argument:expr),*)) => {{
        let entry = $self.context.enter()?;
        // SAFETY: the handle lives, and arguments are as C wants them.
        let status = unsafe { sys::$function($self.handle, $($argument),*) };
        entry.done_in(status, $self.handle)
    }};
}

macro_rules! callback {
    ($(#[$doc:meta])* $set:ident, $clear:ident, $place:ident: $type:ty, $c:ident, $trampoline:ident, $bound:ty) => {
        $(#[$doc])*
        pub fn $set(&mut self, function: $bound) -> Result<()> {
            let slot = Owned::<$type>::new(&self.context.thrown, Box::new(function));
            call!(self, $c(Some($trampoline), slot.user()))?;
            self.kept.$place = Some(slot);
            Ok(())
        }
        /// Takes the function away.
        pub fn $clear(&mut self) -> Result<()> {
            call!(self, $c(None, std::ptr::null_mut()))?;
            self.kept.$place = None;
            Ok(())
        }
    };
}

impl Stepper {
    /// Makes a stepper at t = 0.
    pub fn new(grid: &Grid, desc: &StepperDesc) -> Result<Self> {
        let desc = StepperDesc { struct_size: size_of::<StepperDesc>() as u32, ..*desc };
        let context = grid.core.context.clone();
        let mut handle = std::ptr::null_mut();
        let entry = context.enter()?;
        // SAFETY: the descriptor is whole, and the stepper keeps the grid.
        let status = unsafe { sys::mpm_stepper_create(context.handle, grid.as_ptr(), &desc, &mut handle) };
        entry.done(status)?;
        Ok(Stepper { context, handle, grid: grid.clone(), kept: Kept::default() })
    }

    /// Replaces the options.
    pub fn configure(&mut self, desc: &StepperDesc) -> Result<()> {
        let desc = StepperDesc { struct_size: size_of::<StepperDesc>() as u32, ..*desc };
        call!(self, mpm_stepper_configure(&desc))
    }

    /// Takes a set over, which [`Stepper::remove`] gives back. A set that is refused is lost with its particles.
    pub fn add(&mut self, set: Particles) -> Result<SetKey> {
        call!(self, mpm_stepper_add(set.as_ptr()))?;
        let key = SetKey(fresh());
        self.kept.sets.push((key, set));
        Ok(key)
    }

    /// Gives a set back.
    pub fn remove(&mut self, set: SetKey) -> Result<Particles> {
        let k = self.find(set)?;
        call!(self, mpm_stepper_remove(self.kept.sets[k].1.as_ptr()))?;
        self.kept.motions.retain(|one| one.0 != set);
        self.kept.accepting.retain(|one| one.0 != set);
        self.kept.heating.retain(|one| one.0 != set);
        Ok(self.kept.sets.remove(k).1)
    }

    /// A set. Panics where it is not in this stepper.
    pub fn particles(&self, set: SetKey) -> &Particles {
        let k = self.find(set).unwrap_or_else(|error| panic!("{error}"));
        &self.kept.sets[k].1
    }

    /// A set, to be changed. Panics where it is not in this stepper.
    pub fn particles_mut(&mut self, set: SetKey) -> &mut LentParticles {
        let k = self.find(set).unwrap_or_else(|error| panic!("{error}"));
        &mut self.kept.sets[k].1
    }

    fn find(&self, set: SetKey) -> Result<usize> {
        let found = self.kept.sets.iter().position(|one| one.0 == set);
        found.ok_or_else(|| Error::new(sys::MPM_E_NOT_FOUND, "the set is not in this stepper"))
    }

    /// Takes an obstacle over.
    pub fn add_obstacle(&mut self, obstacle: Obstacle) -> Result<ObstacleKey> {
        call!(self, mpm_stepper_add_obstacle(obstacle.as_ptr()))?;
        let key = ObstacleKey(fresh());
        self.kept.obstacles.push((key, obstacle));
        Ok(key)
    }

    /// Gives an obstacle back.
    pub fn remove_obstacle(&mut self, obstacle: ObstacleKey) -> Result<Obstacle> {
        let k = self.find_obstacle(obstacle)?;
        call!(self, mpm_stepper_remove_obstacle(self.kept.obstacles[k].1.as_ptr()))?;
        Ok(self.kept.obstacles.remove(k).1)
    }

    /// An obstacle. Panics where it is not in this stepper.
    pub fn obstacle(&self, obstacle: ObstacleKey) -> &Obstacle {
        let k = self.find_obstacle(obstacle).unwrap_or_else(|error| panic!("{error}"));
        &self.kept.obstacles[k].1
    }

    /// An obstacle, to be changed. Panics where it is not in this stepper.
    pub fn obstacle_mut(&mut self, obstacle: ObstacleKey) -> &mut LentObstacle {
        let k = self.find_obstacle(obstacle).unwrap_or_else(|error| panic!("{error}"));
        &mut self.kept.obstacles[k].1
    }

    fn find_obstacle(&self, obstacle: ObstacleKey) -> Result<usize> {
        let found = self.kept.obstacles.iter().position(|one| one.0 == obstacle);
        found.ok_or_else(|| Error::new(sys::MPM_E_NOT_FOUND, "the obstacle is not in this stepper"))
    }

    /// Takes a surface over, which has to be on the same grid; [`Stepper::remove_surface`] gives it back. One that is
    /// refused is lost. Steps end with `MPM_OFF_GRID` where a marker would leave the grid, and with `MPM_E_STATE` where
    /// one with a load has no material around it.
    pub fn add_surface(&mut self, surface: Surface) -> Result<SurfaceKey> {
        call!(self, mpm_stepper_add_surface(surface.as_ptr()))?;
        let key = SurfaceKey(fresh());
        self.kept.surfaces.push((key, surface));
        Ok(key)
    }

    /// Gives a surface back, with its markers.
    pub fn remove_surface(&mut self, surface: SurfaceKey) -> Result<Surface> {
        let k = self.find_surface(surface)?;
        call!(self, mpm_stepper_remove_surface(self.kept.surfaces[k].1.as_ptr()))?;
        Ok(self.kept.surfaces.remove(k).1)
    }

    /// A surface. Panics where it is not in this stepper.
    pub fn surface(&self, surface: SurfaceKey) -> &Surface {
        let k = self.find_surface(surface).unwrap_or_else(|error| panic!("{error}"));
        &self.kept.surfaces[k].1
    }

    /// A surface, to be changed. Panics where it is not in this stepper.
    pub fn surface_mut(&mut self, surface: SurfaceKey) -> &mut LentSurface {
        let k = self.find_surface(surface).unwrap_or_else(|error| panic!("{error}"));
        &mut self.kept.surfaces[k].1
    }

    fn find_surface(&self, surface: SurfaceKey) -> Result<usize> {
        let found = self.kept.surfaces.iter().position(|one| one.0 == surface);
        found.ok_or_else(|| Error::new(sys::MPM_E_NOT_FOUND, "the surface is not in this stepper"))
    }

    /// Sets the time and the number of steps counted.
    pub fn set_time(&mut self, t: f64, step: i64) -> Result<()> {
        call!(self, mpm_stepper_set_time(t, step))
    }

    /// Sets what a face does.
    pub fn set_wall(&mut self, face: i32, kind: i32, friction: f64) -> Result<()> {
        call!(self, mpm_stepper_set_wall(face, kind, friction))
    }

    /// Puts a set into a body.
    pub fn set_body(&mut self, set: SetKey, body: i32) -> Result<()> {
        let k = self.find(set)?;
        call!(self, mpm_stepper_set_body(self.kept.sets[k].1.as_ptr(), body))
    }

    /// The body of a set.
    pub fn body(&self, set: SetKey) -> Result<i32> {
        let k = self.find(set)?;
        let mut body = 0;
        call!(self, mpm_stepper_body(self.kept.sets[k].1.as_ptr(), &mut body))?;
        Ok(body)
    }

    /// Sets how two bodies meet; none takes the rule back.
    pub fn set_contact(&mut self, body_a: i32, body_b: i32, desc: Option<&ContactDesc>) -> Result<()> {
        let desc = desc.map(|desc| sized(*desc));
        let pointer = desc.as_ref().map_or(std::ptr::null(), |desc| desc);
        call!(self, mpm_stepper_set_contact(body_a, body_b, pointer))
    }

    /// What two bodies did in the last step.
    pub fn contact_info(&self, body_a: i32, body_b: i32) -> Result<ContactInfo> {
        let mut info = ContactInfo::default();
        call!(self, mpm_stepper_contact_info(body_a, body_b, &mut info))?;
        Ok(info)
    }

    /// Describes how a set is split and merged; none: no longer. A function in the descriptor is not called: see
    /// [`Stepper::set_adaption_with`].
    pub fn set_adaption(&mut self, set: SetKey, desc: Option<&AdaptionDesc>) -> Result<()> {
        self.describe(set, desc, None)
    }

    /// The same with a function that keeps particles as they are, by 0 in place of the 1 that is there.
    pub fn set_adaption_with(
        &mut self,
        set: SetKey,
        desc: &AdaptionDesc,
        accept: impl FnMut(&AdaptionBatch<'_>, &mut [u8]) -> Flow + Send + 'static,
    ) -> Result<()> {
        let slot = Owned::<AcceptFn>::new(&self.context.thrown, Box::new(accept));
        self.describe(set, Some(desc), Some(slot))
    }

    fn describe(&mut self, set: SetKey, desc: Option<&AdaptionDesc>, accept: Option<Owned<AcceptFn>>) -> Result<()> {
        let k = self.find(set)?;
        let desc = desc.map(|desc| AdaptionDesc {
            struct_size: size_of::<AdaptionDesc>() as u32,
            accept: accept.as_ref().map(|_| on_adaption as _),
            user: user_of(&accept),
            ..*desc
        });
        let pointer = desc.as_ref().map_or(std::ptr::null(), |desc| desc);
        call!(self, mpm_stepper_set_adaption(self.kept.sets[k].1.as_ptr(), pointer))?;
        self.kept.accepting.retain(|one| one.0 != set);
        self.kept.accepting.extend(accept.map(|slot| (set, slot)));
        Ok(())
    }

    /// Splits and merges now, whatever the descriptors say of steps.
    pub fn adapt(&mut self) -> Result<()> {
        call!(self, mpm_stepper_adapt())
    }

    /// What splitting and merging have done to a set.
    pub fn adaption_info(&self, set: SetKey) -> Result<AdaptionInfo> {
        let k = self.find(set)?;
        let mut info = AdaptionInfo::default();
        call!(self, mpm_stepper_adaption_info(self.kept.sets[k].1.as_ptr(), &mut info))?;
        Ok(info)
    }

    /// Describes the heat of a set, which has the field `"temperature"` from then on; none: it has no heat any more. A
    /// function in the descriptor is not called: see [`Stepper::set_heat_with`].
    pub fn set_heat(&mut self, set: SetKey, desc: Option<&HeatDesc>) -> Result<()> {
        self.heat(set, desc, None)
    }

    /// The same with a source (mt), which writes the power per present volume of each particle.
    pub fn set_heat_with(
        &mut self,
        set: SetKey,
        desc: &HeatDesc,
        source: impl Fn(&ParticleBatch<'_>, &mut [f64]) -> Flow + Send + Sync + 'static,
    ) -> Result<()> {
        let slot = Owned::<HeatFn>::new(&self.context.thrown, Box::new(source));
        self.heat(set, Some(desc), Some(slot))
    }

    fn heat(&mut self, set: SetKey, desc: Option<&HeatDesc>, source: Option<Owned<HeatFn>>) -> Result<()> {
        let k = self.find(set)?;
        let desc = desc.map(|desc| HeatDesc {
            struct_size: size_of::<HeatDesc>() as u32,
            source: source.as_ref().map(|_| on_heat as _),
            user: user_of(&source),
            ..*desc
        });
        let pointer = desc.as_ref().map_or(std::ptr::null(), |desc| desc);
        call!(self, mpm_stepper_set_heat(self.kept.sets[k].1.as_ptr(), pointer))?;
        self.kept.heating.retain(|one| one.0 != set);
        self.kept.heating.extend(source.map(|slot| (set, slot)));
        Ok(())
    }

    /// Chooses how the nodes conduct: `MPM_CONDUCTION_EXPLICIT`, or `MPM_CONDUCTION_IMPLICIT` to a tolerance.
    pub fn set_conduction(&mut self, conduction: i32, tolerance: f64) -> Result<()> {
        call!(self, mpm_stepper_set_conduction(conduction, tolerance))
    }

    /// Says what a face does to heat: `MPM_HEAT_WALL_INSULATED`, or `MPM_HEAT_WALL_TEMPERATURE` with its temperature.
    pub fn set_heat_wall(&mut self, face: i32, kind: i32, temperature: f64) -> Result<()> {
        call!(self, mpm_stepper_set_heat_wall(face, kind, temperature))
    }

    /// Where heat came from, in the last step and in all.
    pub fn heat_info(&self) -> Result<HeatInfo> {
        let mut info = HeatInfo::default();
        call!(self, mpm_stepper_heat_info(&mut info))?;
        Ok(info)
    }

    /// Sets the mean velocity (mt) of a set's prescribed particles, which is added to zeros.
    pub fn set_motion(
        &mut self,
        set: SetKey,
        mean_velocity: impl Fn(&ParticleBatch<'_>, &mut Columns<'_, f64>) -> Flow + Send + Sync + 'static,
    ) -> Result<()> {
        let k = self.find(set)?;
        let slot = Owned::<ParticleFn>::new(&self.context.thrown, Box::new(mean_velocity));
        call!(self, mpm_stepper_set_motion(self.kept.sets[k].1.as_ptr(), Some(on_particles), slot.user()))?;
        self.kept.motions.retain(|one| one.0 != set);
        self.kept.motions.push((set, slot));
        Ok(())
    }

    /// Takes the motion of a set away.
    pub fn clear_motion(&mut self, set: SetKey) -> Result<()> {
        let k = self.find(set)?;
        call!(self, mpm_stepper_set_motion(self.kept.sets[k].1.as_ptr(), None, std::ptr::null_mut()))?;
        self.kept.motions.retain(|one| one.0 != set);
        Ok(())
    }

    callback!(
        /// Sets what adds accelerations of particles (mt).
        set_acceleration, clear_acceleration, acceleration: ParticleFn, mpm_stepper_set_acceleration, on_particles,
        impl Fn(&ParticleBatch<'_>, &mut Columns<'_, f64>) -> Flow + Send + Sync + 'static
    );
    callback!(
        /// Sets what adds forces on particles (mt).
        set_force, clear_force, force: ParticleFn, mpm_stepper_set_force, on_particles,
        impl Fn(&ParticleBatch<'_>, &mut Columns<'_, f64>) -> Flow + Send + Sync + 'static
    );
    callback!(
        /// Sets what prescribes nodal velocities (mt): `prescribed` is 1 where a velocity is.
        set_velocity_bc, clear_velocity_bc, velocity_bc: VelocityFn, mpm_stepper_set_velocity_bc, on_velocity,
        impl Fn(&NodeBatch<'_>, &mut Columns<'_, u8>, &mut Columns<'_, f64>) -> Flow + Send + Sync + 'static
    );
    callback!(
        /// Sets the coefficients of friction (mt) at nodes where bodies touch.
        set_friction, clear_friction, friction: FrictionFn, mpm_stepper_set_friction, on_friction,
        impl Fn(&ContactBatch<'_>, &mut [f64]) -> Flow + Send + Sync + 'static
    );
    callback!(
        /// Sets the solver of `MPM_SOLVER_HOST`, which gives the number of iterations. Where it has not solved the system
        /// it refuses with [`Refusal::SmallerStep`].
        set_linear_solver, clear_linear_solver, solver: SolveFn, mpm_stepper_set_linear_solver, on_solve,
        impl FnMut(&mut LinearSystem<'_>) -> std::result::Result<i64, Refusal> + Send + 'static
    );
    callback!(
        /// Sets what watches steps. [`Refusal::SmallerStep`] ends the call with `MPM_CANCELLED`.
        set_progress, clear_progress, progress: ProgressFn, mpm_stepper_set_progress, on_progress,
        impl FnMut(&StepInfo) -> Flow + Send + 'static
    );

    /// Sets the hook (mt) of a stage, `MPM_AFTER_P2G` to `MPM_AFTER_VELOCITY`: it changes nodal velocity and force.
    pub fn set_node_hook(
        &mut self,
        stage: i32,
        hook: impl Fn(&NodeBatch<'_>, &mut Columns<'_, f64>, &mut Columns<'_, f64>) -> Flow + Send + Sync + 'static,
    ) -> Result<()> {
        let slot = Owned::<NodeFn>::new(&self.context.thrown, Box::new(hook));
        call!(self, mpm_stepper_set_node_hook(stage, Some(on_nodes), slot.user()))?;
        self.kept.hooks[(stage - sys::MPM_AFTER_P2G) as usize] = Some(slot);
        Ok(())
    }

    /// Takes the hook of a stage away.
    pub fn clear_node_hook(&mut self, stage: i32) -> Result<()> {
        call!(self, mpm_stepper_set_node_hook(stage, None, std::ptr::null_mut()))?;
        self.kept.hooks[(stage - sys::MPM_AFTER_P2G) as usize] = None;
        Ok(())
    }

    /// The stable dt of an explicit step, at CFL number 1.
    pub fn stable_dt(&mut self) -> Result<f64> {
        let mut dt = 0.0;
        call!(self, mpm_stable_dt(&mut dt))?;
        Ok(dt)
    }

    /// Makes a step. After any error particles and time are as before, to the bit.
    pub fn step(&mut self, dt: f64) -> Result<()> {
        call!(self, mpm_step(dt, std::ptr::null_mut()))
    }

    /// Steps to a time exactly, with sub-steps of the library's choice.
    pub fn advance(&mut self, t_end: f64) -> Result<()> {
        self.advance_by(&AdvanceDesc { t_end, ..Default::default() })
    }

    /// Steps to `desc.t_end`.
    pub fn advance_by(&mut self, desc: &AdvanceDesc) -> Result<()> {
        let desc = AdvanceDesc { struct_size: size_of::<AdvanceDesc>() as u32, ..*desc };
        call!(self, mpm_advance(&desc, std::ptr::null_mut()))
    }

    /// Makes the first part of a step in parts.
    pub fn begin(&mut self, dt: f64) -> Result<StagedStep<'_>> {
        StagedStep::begin(self, dt)
    }

    /// The state as it is, and what belongs to the last step, also where that has failed.
    pub fn info(&self) -> Result<StepInfo> {
        let mut info = StepInfo::default();
        call!(self, mpm_stepper_info(&mut info))?;
        Ok(info)
    }

    /// Seconds spent in steps, by stage, since the start or the last reset.
    pub fn profile(&mut self, reset: bool) -> Result<Profile> {
        let mut times = Profile::default();
        call!(self, mpm_stepper_profile(reset.into(), &mut times))?;
        Ok(times)
    }

    /// The residuals of the last implicit step.
    pub fn residuals(&self) -> Result<Vec<f64>> {
        let mut count = 0;
        call!(self, mpm_stepper_residuals(0, std::ptr::null_mut(), &mut count))?;
        let mut out = vec![0.0; count as usize];
        call!(self, mpm_stepper_residuals(count, out.as_mut_ptr(), &mut count))?;
        Ok(out)
    }

    /// Lends a nodal field of the last step, of one body, for reading.
    pub fn map<T: Element>(&self, body: i32, field: &str) -> Result<View<'_, T>> {
        Ok(View::of(self.lend::<T>(body, field, sys::MPM_READ)?))
    }

    pub(crate) fn lend<T: Element>(&self, body: i32, field: &str, access: i32) -> Result<Lent> {
        let name = c_text(field)?;
        // SAFETY: the name ends with a zero, and the view is given back.
        Lent::new::<T>(&self.context, field, access, |access, view| unsafe {
            sys::mpm_grid_map(self.handle, body, name.as_ptr(), access, view)
        })
    }

    /// The force of a wall on the material in the last step; 0 on axes that the grid has not.
    pub fn wall_reaction(&self, face: i32) -> Result<[f64; 3]> {
        let mut out = [0.0; 3];
        call!(self, mpm_stepper_wall_reaction(face, out.as_mut_ptr()))?;
        Ok(out)
    }

    /// The impulse of a wall over all steps.
    pub fn wall_impulse(&self, face: i32) -> Result<[f64; 3]> {
        let mut out = [0.0; 3];
        call!(self, mpm_stepper_wall_impulse(face, out.as_mut_ptr()))?;
        Ok(out)
    }

    /// The force of what a surface prescribes on the material in the last step.
    pub fn surface_reaction(&self, surface: SurfaceKey) -> Result<[f64; 3]> {
        let (k, mut out) = (self.find_surface(surface)?, [0.0; 3]);
        call!(self, mpm_stepper_surface_reaction(self.kept.surfaces[k].1.as_ptr(), out.as_mut_ptr()))?;
        Ok(out)
    }

    /// The impulse of what a surface prescribes over all steps.
    pub fn surface_impulse(&self, surface: SurfaceKey) -> Result<[f64; 3]> {
        let (k, mut out) = (self.find_surface(surface)?, [0.0; 3]);
        call!(self, mpm_stepper_surface_impulse(self.kept.surfaces[k].1.as_ptr(), out.as_mut_ptr()))?;
        Ok(out)
    }

    /// The force of a set's prescribed particles on the material in the last step.
    pub fn particles_reaction(&self, set: SetKey) -> Result<[f64; 3]> {
        let (k, mut out) = (self.find(set)?, [0.0; 3]);
        call!(self, mpm_stepper_particles_reaction(self.kept.sets[k].1.as_ptr(), out.as_mut_ptr()))?;
        Ok(out)
    }

    /// The impulse of a set's prescribed particles over all steps.
    pub fn particles_impulse(&self, set: SetKey) -> Result<[f64; 3]> {
        let (k, mut out) = (self.find(set)?, [0.0; 3]);
        call!(self, mpm_stepper_particles_impulse(self.kept.sets[k].1.as_ptr(), out.as_mut_ptr()))?;
        Ok(out)
    }

    /// The saved state.
    pub fn save(&self) -> Result<Vec<u8>> {
        let mut bytes = 0;
        call!(self, mpm_state_size(&mut bytes))?;
        let mut state = vec![0u8; bytes as usize];
        call!(self, mpm_state_save(state.as_mut_ptr().cast(), bytes))?;
        Ok(state)
    }

    /// Replaces the state by a saved one.
    pub fn load(&mut self, state: &[u8]) -> Result<()> {
        call!(self, mpm_state_load(state.as_ptr().cast(), state.len() as i64))
    }

    /// Saves the state into a file.
    pub fn save_file(&self, path: &str) -> Result<()> {
        let path = c_text(path)?;
        call!(self, mpm_state_save_file(path.as_ptr()))
    }

    /// Replaces the state by one from a file.
    pub fn load_file(&mut self, path: &str) -> Result<()> {
        let path = c_text(path)?;
        call!(self, mpm_state_load_file(path.as_ptr()))
    }

    /// A hash of the state.
    pub fn hash(&self) -> Result<u64> {
        let mut hash = 0;
        call!(self, mpm_state_hash(&mut hash))?;
        Ok(hash)
    }

    /// Writes a .vti file (with open knots a .vtr file) with nodal fields of a body; with none named all that there are.
    pub fn write_grid(&mut self, body: i32, path: &str, fields: &[&str]) -> Result<()> {
        let path = c_text(path)?;
        let (_held, names) = c_texts(fields)?;
        call!(self, mpm_write_body_grid(body, path.as_ptr(), names.len() as i32, names.as_ptr()))
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The handle of C.
    pub fn as_ptr(&self) -> *mut sys::mpm_stepper {
        self.handle
    }
}

impl Drop for Stepper {
    fn drop(&mut self) {
        let (handle, kept, grid) = (Sent(self.handle), std::mem::take(&mut self.kept), self.grid.clone());
        let kept = SentKept(kept);
        self.context.bury(move || {
            let kept = kept.get();
            // SAFETY: nobody else has the handle. A step in parts that was forgotten bars the first try.
            let gone = unsafe {
                sys::mpm_stepper_destroy(handle.get()) == sys::MPM_OK || {
                    sys::mpm_step_abort(handle.get());
                    sys::mpm_stepper_destroy(handle.get()) == sys::MPM_OK
                }
            };
            if !gone {
                // a view of nodal fields was forgotten: C holds on to all of it
                std::mem::forget(kept);
            }
            drop(grid);
        });
    }
}

/// What a stepper keeps, on its way to be freed.
struct SentKept(Kept);
// SAFETY: functions are Send, and the others are used by an Entry only.
unsafe impl Send for SentKept {}
impl SentKept {
    fn get(self) -> Kept {
        self.0
    }
}

unsafe extern "C" fn on_particles(user: *mut c_void, batch: *const sys::mpm_particle_batch, add: *mut f64) -> i32 {
    let slot = shared::<ParticleFn>(user);
    let raw = &*batch;
    slot.thrown.guard(|| (slot.function)(&ParticleBatch(raw), &mut Columns::new(add, raw.ld, raw.n, raw.dim as usize)))
}

unsafe extern "C" fn on_velocity(
    user: *mut c_void,
    batch: *const sys::mpm_node_batch,
    prescribed: *mut u8,
    velocity: *mut f64,
) -> i32 {
    let slot = shared::<VelocityFn>(user);
    let (raw, dim) = (&*batch, (*batch).dim as usize);
    slot.thrown.guard(|| {
        let mut prescribed = Columns::new(prescribed, raw.ld, raw.n, dim);
        (slot.function)(&NodeBatch(raw), &mut prescribed, &mut Columns::new(velocity, raw.ld, raw.n, dim))
    })
}

unsafe extern "C" fn on_nodes(
    user: *mut c_void,
    batch: *const sys::mpm_node_batch,
    velocity: *mut f64,
    force: *mut f64,
) -> i32 {
    let slot = shared::<NodeFn>(user);
    let (raw, dim) = (&*batch, (*batch).dim as usize);
    slot.thrown.guard(|| {
        let mut velocity = Columns::new(velocity, raw.ld, raw.n, dim);
        (slot.function)(&NodeBatch(raw), &mut velocity, &mut Columns::new(force, raw.ld, raw.n, dim))
    })
}

unsafe extern "C" fn on_friction(user: *mut c_void, batch: *const sys::mpm_contact_batch, friction: *mut f64) -> i32 {
    let slot = shared::<FrictionFn>(user);
    let raw = &*batch;
    slot.thrown.guard(|| (slot.function)(&ContactBatch(raw), Columns::new(friction, raw.ld, raw.n, 1).column_mut(0)))
}

unsafe extern "C" fn on_heat(user: *mut c_void, batch: *const sys::mpm_particle_batch, power: *mut f64) -> i32 {
    let slot = shared::<HeatFn>(user);
    let raw = &*batch;
    slot.thrown.guard(|| (slot.function)(&ParticleBatch(raw), Columns::new(power, raw.ld, raw.n, 1).column_mut(0)))
}

unsafe extern "C" fn on_adaption(user: *mut c_void, batch: *const sys::mpm_adaption_batch, accept: *mut u8) -> i32 {
    let slot = alone::<AcceptFn>(user);
    let (raw, function) = (&*batch, &mut slot.function);
    slot.thrown.guard(|| function(&AdaptionBatch(raw), Columns::new(accept, raw.ld, raw.n, 1).column_mut(0)))
}

unsafe extern "C" fn on_solve(
    user: *mut c_void,
    matrix: *const sys::mpm_operator,
    rhs: *const f64,
    solution: *mut f64,
    tolerance: f64,
    iterations: *mut i64,
) -> i32 {
    let slot = alone::<SolveFn>(user);
    let function = &mut slot.function;
    slot.thrown.guard(|| {
        *iterations = function(&mut LinearSystem::new(matrix, rhs, solution, tolerance)?)?;
        Ok(())
    })
}

unsafe extern "C" fn on_progress(user: *mut c_void, info: *const sys::mpm_step_info) -> i32 {
    let slot = alone::<ProgressFn>(user);
    let function = &mut slot.function;
    slot.thrown.guard(|| function(&*info))
}
