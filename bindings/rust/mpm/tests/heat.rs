//! Heat: bars that conduct, sources, surfaces, what is refused.
mod scene;
use mpm::constants::*;
use mpm::*;
use scene::*;
use std::f64::consts::PI;
use std::sync::Arc;

/// Its specific heat 3 and its density 2 make the diffusivity 0.2.
fn conducting() -> HeatDesc {
    HeatDesc { specific_heat: 3.0, conductivity: 1.2, ..Default::default() }
}

/// A bar from 0 to 1 along one axis that the grid insulates, so soft that sound bounds no step.
fn bar() -> Result<(Stepper, SetKey)> {
    let context = Context::new()?;
    let desc = GridDesc { dim: 1, cells: [20, 0, 0], spacing: [0.05, 0.0, 0.0], ..Default::default() };
    let grid = Grid::new(&context, &desc)?;
    let soft = Material::new(&context, "neo_hookean", &[("E", 1e-6), ("nu", 0.3), ("density", 2.0)])?;
    let mut set = Particles::new(&grid, &soft)?;
    set.fill_box(&[0.0], &[1.0], &[2])?;
    let mut stepper = Stepper::new(&grid, &StepperDesc::default())?;
    let key = stepper.add(set)?;
    Ok((stepper, key))
}

#[test]
fn a_cosine_decays() {
    let (mut stepper, bar) = bar().unwrap();
    assert!(stepper.heat_info().unwrap_err().to_string().contains("no set has heat"));
    stepper.set_heat(bar, Some(&conducting())).unwrap();
    let set = stepper.particles_mut(bar);
    let cosine: Vec<f64> = set.get::<f64>("position").unwrap().iter().map(|x| (PI * x).cos()).collect();
    set.set("temperature", &cosine).unwrap();
    let (t, before) = (0.5, stepper.heat_info().unwrap().heat);
    stepper.advance(t).unwrap();
    let decay = (-0.2 * PI * PI * t).exp();
    let found = stepper.particles(bar).get::<f64>("temperature").unwrap();
    for (found, start) in found.iter().zip(&cosine) {
        assert!((found - decay * start).abs() < 0.01, "{found} is not {}", decay * start);
    }
    assert!((stepper.heat_info().unwrap().heat - before).abs() < 1e-12, "insulated ends let heat through");
}

#[test]
fn what_goes_in_comes_out() {
    let (mut stepper, bar) = bar().unwrap();
    stepper.set_heat(bar, Some(&conducting())).unwrap();
    stepper.set_conduction(MPM_CONDUCTION_IMPLICIT, 1e-12).unwrap();
    assert_eq!(stepper.set_conduction(MPM_CONDUCTION_IMPLICIT, 2.0).unwrap_err().status(), MPM_E_ARG);
    stepper.set_heat_wall(MPM_X_MIN, MPM_HEAT_WALL_TEMPERATURE, 10.0).unwrap();
    stepper.set_heat_wall(MPM_X_MAX, MPM_HEAT_WALL_TEMPERATURE, 20.0).unwrap();
    (0..200).for_each(|_| stepper.step(0.1).unwrap());
    let set = stepper.particles(bar);
    let (x, found) = (set.get::<f64>("position").unwrap(), set.get::<f64>("temperature").unwrap());
    for (x, found) in x.iter().zip(&found) {
        assert!((found - (10.0 + 10.0 * x)).abs() < 1e-6, "{found} at {x}");
    }
    let info = stepper.heat_info().unwrap();
    let flow = 1.2 * 10.0 * 0.1; // Fourier's law for the time of a step
    assert!((info.walls[0] + flow).abs() < 1e-6 && (info.walls[1] - flow).abs() < 1e-6, "{:?}", info.walls);
    assert!(info.iterations > 0);
}

#[test]
fn sources_heat_evenly_and_are_let_go() {
    let (mut stepper, bar) = bar().unwrap();
    let token = Arc::new(());
    let held = token.clone();
    let source = move |batch: &ParticleBatch<'_>, power: &mut [f64]| {
        assert!(Arc::strong_count(&held) > 1 && power.len() == batch.len());
        power.fill(12.0);
        Ok(())
    };
    stepper.set_heat_with(bar, &conducting(), source).unwrap();
    (0..10).for_each(|_| stepper.step(5e-3).unwrap());
    let found = stepper.particles(bar).get::<f64>("temperature").unwrap();
    assert!(found.iter().all(|t| (t - 12.0 * 0.05 / 6.0).abs() < 1e-12));
    assert!((stepper.heat_info().unwrap().sources_total - 12.0 * 0.05).abs() < 1e-12);
    stepper.set_heat_with(bar, &conducting(), |_, _| Err(Refusal::stop("burnt"))).unwrap();
    assert_eq!(Arc::strong_count(&token), 1);
    let error = stepper.step(5e-3).unwrap_err();
    assert_eq!(std::error::Error::source(&error).unwrap().to_string(), "burnt");
    let held = token.clone();
    let holding = move |_: &ParticleBatch<'_>, _: &mut [f64]| {
        drop(held.clone());
        Ok(())
    };
    stepper.set_heat_with(bar, &conducting(), holding).unwrap();
    let set = stepper.remove(bar).unwrap();
    assert_eq!(Arc::strong_count(&token), 1);
    let bar = stepper.add(set).unwrap();
    stepper.step(5e-3).unwrap();
    stepper.set_heat(bar, None).unwrap();
}

#[test]
fn surfaces_heat_what_is_below() {
    let context = Context::new().unwrap();
    let (mut stepper, block) = falling(&context, StepperDesc::default()).unwrap();
    stepper.set_heat(block, Some(&conducting())).unwrap();
    let mut face = Surface::new(stepper.grid(), &SurfaceDesc::default()).unwrap();
    face.add(&[0.7, 0.5], Some(&[0.4, 0.0])).unwrap();
    let face = stepper.add_surface(face).unwrap();
    stepper.surface_mut(face).set_heat(5.0, 0.0, 0.0).unwrap();
    assert_eq!(stepper.surface_mut(face).set_heat(0.0, -1.0, 0.0).unwrap_err().status(), MPM_E_ARG);
    stepper.step(1e-3).unwrap();
    let info = stepper.heat_info().unwrap();
    assert!((info.surfaces - 5.0 * 0.4 * 1e-3).abs() < 1e-12 && (info.gained - info.surfaces).abs() < 1e-12);
}

#[test]
fn refusals_are_the_library_s() {
    let context = Context::new().unwrap();
    let grid = grid(&context).unwrap();
    let law = Law::new(1e3, |_, _| Ok(()));
    let mut stepper = Stepper::new(&grid, &StepperDesc::default()).unwrap();
    let set = stepper.add(Particles::new(&grid, &Material::custom(&context, law).unwrap()).unwrap()).unwrap();
    let error = stepper.set_heat(set, Some(&HeatDesc { dissipated_share: 0.5, ..conducting() })).unwrap_err();
    assert_eq!(error.status(), MPM_E_UNSUPPORTED);
    assert!(error.to_string().contains("what a law of the host dissipates is not known"));
    assert_eq!(stepper.set_heat(set, Some(&HeatDesc::default())).unwrap_err().status(), MPM_E_ARG);
}
