//! Whatever goes first, all is freed in the end; calls that meet are refused.
mod scene;
use mpm::constants::*;
use mpm::{Context, ContextDesc, Grid, GridDesc, Material, Stepper, StepperDesc, Surface, SurfaceDesc};
use scene::*;
use std::sync::{Arc, Mutex};

/// A context that tells by the count of the token whether it is gone: its functions go with it.
fn watched(token: &Arc<()>) -> Context {
    let held = token.clone();
    Context::with(ContextDesc::new().log(move |_, _| drop(held.clone()))).unwrap()
}

#[test]
fn any_order() {
    for first in 0..5 {
        let token = Arc::new(());
        let context = watched(&token);
        let grid = grid(&context).unwrap();
        let jelly = Material::new(&context, "neo_hookean", &JELLY).unwrap();
        let mut stepper = Stepper::new(&grid, &StepperDesc::default()).unwrap();
        stepper.add(block(&grid, &jelly).unwrap()).unwrap();
        let spare = block(&grid, &jelly).unwrap();
        let mut things: Vec<Option<Box<dyn std::any::Any>>> = vec![
            Some(Box::new(context)),
            Some(Box::new(grid)),
            Some(Box::new(jelly)),
            Some(Box::new(stepper)),
            Some(Box::new(spare)),
        ];
        for k in 0..things.len() {
            assert_eq!(Arc::strong_count(&token), 2);
            let at = (first + k) % things.len();
            things[at] = None;
        }
        assert_eq!(Arc::strong_count(&token), 1, "starting with {first} the context was not freed");
    }
}

#[test]
fn removed_sets_come_back() {
    let token = Arc::new(());
    let (mut stepper, key) = falling(&watched(&token), StepperDesc::default()).unwrap();
    stepper.step(1e-3).unwrap();
    let set = stepper.remove(key).unwrap();
    assert_eq!(stepper.remove(key).err().unwrap().status(), MPM_E_NOT_FOUND);
    drop(stepper);
    assert_eq!(set.len(), 64);
    drop(set);
    assert_eq!(Arc::strong_count(&token), 1);
}

#[test]
fn what_goes_in_a_callback_is_freed_after_it() {
    let token = Arc::new(());
    let context = watched(&token);
    let (mut stepper, _) = falling(&context, StepperDesc::default()).unwrap();
    let unused = Mutex::new(Some(grid(&context).unwrap()));
    let (before, seen) = (context.memory().0, Arc::new(Mutex::new(0)));
    let (inside, again) = (seen.clone(), context.clone());
    stepper
        .set_progress(move |_| {
            *inside.lock().unwrap() = grid(&again).err().expect("a call in a callback was not refused").status();
            drop(unused.lock().unwrap().take());
            Ok(())
        })
        .unwrap();
    stepper.step(1e-3).unwrap();
    assert_eq!(*seen.lock().unwrap(), MPM_E_STATE);
    stepper.clear_progress().unwrap();
    let (mut other, _) = falling(&Context::new().unwrap(), StepperDesc::default()).unwrap();
    other.step(1e-3).unwrap();
    assert!(context.memory().0 != before);
    drop((stepper, context));
    assert_eq!(Arc::strong_count(&token), 1);
}

#[test]
fn a_step_that_goes_in_a_callback_is_dropped_after_it() {
    let context = Context::new().unwrap();
    let (mut stepper, _) = falling(&context, StepperDesc::default()).unwrap();
    let grid = grid(&context).unwrap();
    let jelly = Material::new(&context, "neo_hookean", &JELLY).unwrap();
    let mut other = block(&grid, &jelly).unwrap();
    let mut staged = Some(stepper.begin(1e-3).unwrap());
    other
        .fill(&[0.3, 0.3], &[0.5, 0.5], &[2, 2], |_, inside| {
            staged.take();
            inside.fill(0);
            Ok(())
        })
        .unwrap();
    drop(staged);
    stepper.step(1e-3).unwrap();
}

#[test]
fn forgotten_views_and_steps_leak_and_harm_nothing() {
    let token = Arc::new(());
    let (mut stepper, _) = falling(&watched(&token), StepperDesc::default()).unwrap();
    std::mem::forget(stepper.begin(1e-3).unwrap());
    assert_eq!(stepper.step(1e-3).unwrap_err().status(), MPM_E_STATE);
    drop(stepper);
    assert_eq!(Arc::strong_count(&token), 1, "a step that was forgotten is dropped with its stepper");

    let (mut stepper, key) = falling(&watched(&token), StepperDesc::default()).unwrap();
    let held = token.clone();
    stepper
        .set_force(move |_, _| {
            drop(held.clone());
            Ok(())
        })
        .unwrap();
    std::mem::forget(stepper.particles(key).map::<f64>("position").unwrap());
    assert_eq!(stepper.step(1e-3).unwrap_err().status(), MPM_E_STATE);
    drop(stepper);
    assert_eq!(Arc::strong_count(&token), 3, "what C still has was freed");
}

#[test]
fn a_surface_that_was_never_taken_keeps_its_context() {
    let token = Arc::new(());
    let (mut stepper, _) = falling(&watched(&token), StepperDesc::default()).unwrap();
    let face = Surface::new(stepper.grid(), &SurfaceDesc::default()).unwrap();
    let spare = Surface::new(stepper.grid(), &SurfaceDesc::default()).unwrap();
    stepper.add_surface(face).unwrap();
    drop(stepper);
    assert_eq!((spare.len(), Arc::strong_count(&token)), (0, 2));
    drop(spare);
    assert_eq!(Arc::strong_count(&token), 1);
}

#[test]
fn what_is_seen_through_a_view_stays() {
    let context = Context::new().unwrap();
    let (cells, spacing) = ([10, 10, 0], [0.1, 0.1, 0.0]);
    let desc = GridDesc { dim: 2, cells, spacing, geometry: MPM_PLANE_STRESS, ..Default::default() };
    let grid = Grid::new(&context, &desc).unwrap();
    let mut set = block(&grid, &Material::new(&context, "neo_hookean", &JELLY).unwrap()).unwrap();
    set.set_all::<f64>("deformation_gradient", &[1.1, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]).unwrap();
    let strain = set.map::<f64>("deformation_gradient").unwrap();
    let seen = strain.column(4).to_vec();
    set.get::<f64>("stress").unwrap(); // with which the library finds the strain across
    assert!(seen[0] < 1.0 && strain.column(4) == seen, "the memory of a view was written");
}

#[test]
fn threads() {
    let context = Context::new().unwrap();
    let (mut stepper, _) = falling(&context, StepperDesc::default()).unwrap();
    let (mut mine, _) = falling(&context, StepperDesc::default()).unwrap();
    let there = std::thread::spawn(move || {
        (0..200).filter(|_| stepper.step(1e-3).map_or_else(|e| e.status() == MPM_E_STATE, |_| false)).count()
    });
    let refused = (0..200).filter(|_| mine.step(1e-3).map_or_else(|e| e.status() == MPM_E_STATE, |_| false)).count();
    let theirs = there.join().unwrap();
    assert!(refused + theirs < 400);
    assert_eq!(mine.info().unwrap().step, 200 - refused as i64);
}
