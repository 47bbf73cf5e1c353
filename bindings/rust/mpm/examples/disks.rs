//! Two elastic disks that collide under a force of the host: the scene that the example of every language makes, with the
//! same bits. It prints the number of particles, the time and the hash of the state.
use mpm::constants::*;
use mpm::{Context, ContextDesc, Grid, GridDesc, Material, Particles, Stepper, StepperDesc};

fn main() -> Result<(), mpm::Error> {
    let services = ContextDesc::new().isa(MPM_ISA_PORTABLE).concurrency(2).serial_callbacks();
    let context = Context::with(services)?;
    let (cells, spacing) = ([40, 40, 0], [0.025, 0.025, 0.0]);
    let grid = Grid::new(&context, &GridDesc { dim: 2, cells, spacing, ..Default::default() })?;
    let jelly = Material::new(&context, "neo_hookean", &[("E", 1e3), ("nu", 0.3), ("density", 1e3)])?;
    let disk = |centre: f64, velocity: f64| -> Result<Particles, mpm::Error> {
        let mut set = Particles::new(&grid, &jelly)?;
        set.fill_ball(&[centre, centre], 0.15, &[2, 2])?;
        set.set_all("velocity", &[velocity, velocity])?;
        Ok(set)
    };

    let mut stepper = Stepper::new(&grid, &StepperDesc { scheme: MPM_MUSL, projected_positions: 1, ..Default::default() })?;
    let left = stepper.add(disk(0.2, 0.5)?)?;
    let right = stepper.add(disk(0.8, -0.5)?)?;
    // bends the way of particles: the force is 0.05 x downwards per mass
    stepper.set_force(|batch, add| {
        let terms = batch.mass().iter().zip(batch.position(0));
        for (sum, (mass, x)) in add.column_mut(1).iter_mut().zip(terms) {
            *sum += mass * (-0.05 * x);
        }
        Ok(())
    })?;
    for _ in 0..400 {
        stepper.step(2e-3)?;
    }

    println!("particles {}", stepper.particles(left).len() + stepper.particles(right).len());
    println!("time {:.6}\nhash {:016x}", stepper.info()?.t, stepper.hash()?);
    Ok(())
}
