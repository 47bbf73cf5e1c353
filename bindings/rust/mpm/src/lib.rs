//! The Material Point Method for solids and fluids, by libmpm.
//!
//! ```
//! use mpm::constants::*;
//! use mpm::{Context, Grid, GridDesc, Material, Particles, Stepper, StepperDesc};
//!
//! # fn main() -> Result<(), mpm::Error> {
//! let context = Context::new()?;
//! let grid = Grid::new(&context, &GridDesc {
//!     dim: 2, cells: [40, 20, 0], spacing: [0.05, 0.05, 0.0], ..GridDesc::default()
//! })?;
//! let jelly = Material::new(&context, "neo_hookean", &[("E", 1e6), ("nu", 0.3), ("density", 1e3)])?;
//! let mut block = Particles::new(&grid, &jelly)?;
//! block.fill_box(&[0.5, 0.2], &[1.0, 0.7], &[2, 2])?;
//!
//! let mut stepper = Stepper::new(&grid, &StepperDesc { gravity: [0.0, -9.81, 0.0], ..Default::default() })?;
//! let block = stepper.add(block)?;
//! stepper.set_wall(MPM_Y_MIN, MPM_WALL_FRICTION, 0.3)?;
//! stepper.advance(0.1)?;
//! let top = stepper.particles(block).map::<f64>("position")?.column(1).iter().cloned().fold(0.0, f64::max);
//! assert!(top < 0.7);
//! # Ok(())
//! # }
//! ```
//!
//! # Who owns what
//!
//! Grids and materials are shared: a clone is another name for the same one. A [`Stepper`] owns the sets, obstacles and
//! surfaces that it was given, and gives them back by [`Stepper::remove`] and its like. What an object was made with lives as
//! long as it does, so the order in which values go does not matter.
//!
//! What a stepper owns it lends as [`LentParticles`], [`LentObstacle`] and [`LentSurface`], in which a [`Particles`], an
//! [`Obstacle`] or a [`Surface`] has its methods. They have no size: a set is changed where it is, and not exchanged for
//! another, whose functions the stepper does not know.
//!
//! ```compile_fail,E0277
//! # use mpm::*;
//! # fn exchange(stepper: &mut Stepper, set: SetKey, mut other: Particles) {
//! std::mem::swap(stepper.particles_mut(set), &mut other);
//! # }
//! ```
//!
//! ```compile_fail,E0277
//! # use mpm::*;
//! # fn exchange(stepper: &mut Stepper, obstacle: ObstacleKey, mut other: Obstacle) {
//! std::mem::swap(stepper.obstacle_mut(obstacle), &mut other);
//! # }
//! ```
//!
//! ```compile_fail,E0277
//! # use mpm::*;
//! # fn exchange(stepper: &mut Stepper, surface: SurfaceKey, mut other: Surface) {
//! std::mem::swap(stepper.surface_mut(surface), &mut other);
//! # }
//! ```
//!
//! # Views
//!
//! A [`View`] borrows the set that it looks into. A step while one is out does not compile:
//!
//! ```compile_fail,E0502
//! # use mpm::*;
//! # fn step(stepper: &mut Stepper, set: SetKey) -> Result<()> {
//! let x = stepper.particles(set).map::<f64>("position")?;
//! stepper.step(1e-3)?; // the stepper is borrowed by x
//! println!("{}", x[(0, 0)]);
//! # Ok(())
//! # }
//! ```
//!
//! The view goes before the step:
//!
//! ```no_run
//! # use mpm::*;
//! # fn step(stepper: &mut Stepper, set: SetKey) -> Result<()> {
//! let x = stepper.particles(set).map::<f64>("position")?;
//! println!("{}", x[(0, 0)]);
//! stepper.step(1e-3)?;
//! # Ok(())
//! # }
//! ```
//!
//! Neither do two views of a set of which one is for writing:
//!
//! ```compile_fail,E0502
//! # use mpm::*;
//! # fn mapped(set: &mut Particles) -> Result<()> {
//! let x = set.map::<f64>("position")?;
//! let mut v = set.map_mut::<f64>("velocity")?;
//! v[(0, 0)] = x[(0, 0)];
//! # Ok(())
//! # }
//! ```
//!
//! For reading there may be several:
//!
//! ```no_run
//! # use mpm::*;
//! # fn mapped(set: &mut Particles) -> Result<()> {
//! let x = set.map::<f64>("position")?;
//! let v = set.map::<f64>("velocity")?;
//! println!("{} {}", v[(0, 0)], x[(0, 0)]);
//! drop((x, v));
//! let mut v = set.map_mut::<f64>("velocity")?;
//! v[(0, 0)] = 1.0;
//! # Ok(())
//! # }
//! ```
//!
//! # Threads
//!
//! Objects may be sent to other threads, but a context makes one call at a time: one that comes while another is under way,
//! from another thread or in a callback, is refused with `MPM_E_STATE`. Functions that C marks (mt) run on several threads
//! at once, and so are `Fn + Send + Sync`.
//!
//! # Callbacks
//!
//! A function of the host returns a [`Flow`]: `Ok(())`, or a [`Refusal`]. What it refuses with comes out of the call that ran
//! it, as [`Error::source`](std::error::Error::source); a panic goes on in the caller of that call.
//!
//! # The rest
//!
//! [`sys`] is the interface of C, with all comments of the headers; `as_ptr()` of each object gives its handle there. What
//! there is there alone: problems in several parts, memory of the host, and fields of other sizes in callbacks.
#![warn(missing_docs)]

pub use mpm_sys as sys;
pub use mpm_sys::constants;

mod arrays;
mod batch;
mod callback;
mod context;
mod entry;
mod error;
mod grid;
mod law;
mod linear;
mod material;
mod obstacle;
mod output;
mod particles;
mod series;
mod staged;
mod stepper;
mod surface;
mod view;

pub use batch::{
    AdaptionBatch, Columns, ContactBatch, DistanceBatch, Distances, MarkerBatch, NodeBatch, ParticleBatch,
};
pub use callback::{Flow, Refusal};
pub use context::{Context, ContextDesc};
pub use error::Error;
pub use grid::Grid;
pub use law::{Law, MaterialBatch, Response};
pub use linear::{LinearSystem, Rows};
pub use material::{Material, Parameter, Path, StateVariable, Updated};
pub use obstacle::{DistanceFn, LentObstacle, Obstacle, ObstacleDesc, Pose};
pub use particles::{FieldInfo, Filled, LentParticles, Particles};
pub use series::Series;
pub use staged::StagedStep;
pub use stepper::{ObstacleKey, SetKey, Stepper, SurfaceKey};
pub use surface::{LentSurface, Surface};
pub use view::{Element, View, ViewMut};

/// Box, cells and basis of a grid.
pub type GridDesc = sys::mpm_grid_desc;
/// Options of a stepper.
pub type StepperDesc = sys::mpm_stepper_desc;
/// How [`Stepper::advance_by`] chooses its sub-steps.
pub type AdvanceDesc = sys::mpm_advance_desc;
/// Loads and options of a surface.
pub type SurfaceDesc = sys::mpm_surface_desc;
/// How two bodies meet.
pub type ContactDesc = sys::mpm_contact_desc;
/// How a set is split and merged.
pub type AdaptionDesc = sys::mpm_adaption_desc;
/// What splitting and merging have done to a set.
pub type AdaptionInfo = sys::mpm_adaption_info;
/// The heat of a set.
pub type HeatDesc = sys::mpm_heat_desc;
/// Where heat came from.
pub type HeatInfo = sys::mpm_heat_info;
/// What a step did, or the state as it is.
pub type StepInfo = sys::mpm_step_info;
/// What two bodies did to each other.
pub type ContactInfo = sys::mpm_contact_info;
/// Times of the stages.
pub type Profile = sys::mpm_profile;
/// What calls give.
pub type Result<T> = std::result::Result<T, Error>;
