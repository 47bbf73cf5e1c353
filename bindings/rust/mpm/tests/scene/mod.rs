//! The scene that the tests share: a block of jelly that falls.
use mpm::{Context, Grid, GridDesc, Material, Particles, Result, SetKey, Stepper, StepperDesc};

pub const JELLY: [(&str, f64); 3] = [("E", 1e4), ("nu", 0.3), ("density", 1e3)];

pub fn grid(context: &Context) -> Result<Grid> {
    let (cells, spacing) = ([10, 10, 0], [0.1, 0.1, 0.0]);
    Grid::new(context, &GridDesc { dim: 2, cells, spacing, ..Default::default() })
}

pub fn block(grid: &Grid, material: &Material) -> Result<Particles> {
    let mut set = Particles::new(grid, material)?;
    set.fill_box(&[0.3, 0.3], &[0.7, 0.7], &[2, 2])?;
    Ok(set)
}

#[allow(dead_code)]
pub fn falling(context: &Context, desc: StepperDesc) -> Result<(Stepper, SetKey)> {
    let grid = grid(context)?;
    let jelly = Material::new(context, "neo_hookean", &JELLY)?;
    let mut stepper = Stepper::new(&grid, &StepperDesc { gravity: [0.0, -9.81, 0.0], ..desc })?;
    let set = stepper.add(block(&grid, &jelly)?)?;
    Ok((stepper, set))
}
