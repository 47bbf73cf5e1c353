//! Functions of the host: what they are shown, and what they raise.
mod scene;
use mpm::constants::*;
use mpm::*;
use scene::*;
use std::error::Error as _;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};
use std::sync::Arc;

fn serial() -> (Stepper, SetKey) {
    falling(&Context::new().unwrap(), StepperDesc::default()).unwrap()
}

fn panics(mut run: impl FnMut()) -> String {
    let payload = catch_unwind(AssertUnwindSafe(&mut run)).expect_err("nothing panicked");
    payload
        .downcast_ref::<&str>()
        .map(|text| text.to_string())
        .unwrap_or_else(|| *payload.downcast::<String>().unwrap())
}

#[test]
fn panics_arrive_in_the_caller() {
    let (mut stepper, _) = serial();
    stepper.set_force(|_, _| panic!("no force today")).unwrap();
    let before = stepper.hash().unwrap();
    assert_eq!(panics(|| stepper.step(1e-3).unwrap()), "no force today");
    assert_eq!(stepper.hash().unwrap(), before);
    assert_eq!(stepper.info().unwrap().cause, MPM_E_CALLBACK);
    stepper.clear_force().unwrap();
    stepper.step(1e-3).unwrap();

    assert_eq!(panics(|| drop(Context::with(ContextDesc::new().log(|_, _| panic!("no log"))))), "no log");
    let context = Context::new().unwrap();
    let (mut stepper, _) = falling(&context, StepperDesc::default()).unwrap();
    stepper.set_progress(|_| panic!("no progress")).unwrap();
    assert_eq!(panics(|| stepper.advance(0.1).unwrap()), "no progress");
    let mut set = Particles::new(&grid(&context).unwrap(), &Material::new(&context, "j2", &PLASTIC).unwrap()).unwrap();
    let text = panics(|| drop(set.fill(&[0.1; 2], &[0.9; 2], &[1; 2], |_, _| panic!("no shape"))));
    assert_eq!((text.as_str(), set.len()), ("no shape", 0));
}

const PLASTIC: [(&str, f64); 5] =
    [("E", 1e4), ("nu", 0.3), ("density", 1e3), ("yield_stress", 10.0), ("hardening", 0.0)];

#[test]
fn errors_of_the_host_are_sources() {
    let (mut stepper, _) = serial();
    stepper
        .set_acceleration(|_, _| {
            "seven".parse::<f64>()?;
            Ok(())
        })
        .unwrap();
    let error = stepper.step(1e-3).unwrap_err();
    assert_eq!((error.status(), error.name(), error.wants_smaller_step()), (MPM_E_CALLBACK, "MPM_E_CALLBACK", false));
    assert!(error.source().unwrap().is::<std::num::ParseFloatError>());
    stepper.set_acceleration(|_, _| Err(Refusal::SmallerStep)).unwrap();
    let error = stepper.step(1e-3).unwrap_err();
    assert_eq!((error.status(), error.wants_smaller_step(), error.source().is_none()), (MPM_CUT_DT, true, true));
    let error = Material::new(&Context::new().unwrap(), "neo_hookian", &JELLY).err().unwrap();
    assert!(error.to_string().contains("neo_hookean"), "{error}");
    assert!(Context::with(ContextDesc::new().concurrency(-1)).err().unwrap().to_string().contains("-1"));
}

#[test]
fn the_first_of_several_comes_out_whatever_the_threads() {
    for threads in [1, 4] {
        let context = Context::with(ContextDesc::new().concurrency(threads)).unwrap();
        let grid = Grid::new(
            &context,
            &GridDesc { dim: 2, cells: [100, 100, 0], spacing: [0.1, 0.1, 0.0], ..Default::default() },
        );
        let mut stepper = Stepper::new(grid.as_ref().unwrap(), &StepperDesc::default()).unwrap();
        let jelly = Material::new(&context, "neo_hookean", &JELLY).unwrap();
        let mut set = Particles::new(grid.as_ref().unwrap(), &jelly).unwrap();
        set.fill_box(&[1.0, 1.0], &[9.0, 9.0], &[2, 2]).unwrap();
        stepper.add(set).unwrap();
        stepper
            .set_force(|batch, _| {
                let least = batch.id().iter().filter(|id| **id >= 0).min().unwrap();
                Err(Refusal::stop(format!("{least}")))
            })
            .unwrap();
        let texts: Vec<String> =
            (0..5).map(|_| stepper.step(1e-3).unwrap_err().source().unwrap().to_string()).collect();
        assert!(texts.iter().all(|text| *text == texts[0] && *text == "0"), "{threads} threads: {texts:?}");
    }
}

#[test]
fn forces_hooks_and_prescribed_velocities() {
    let (mut stepper, key) = serial();
    stepper.configure(&StepperDesc::default()).unwrap();
    stepper
        .set_force(|batch, add| {
            assert_eq!((batch.dim(), add.components(), add.len()), (2, 2, batch.len()));
            for i in 0..batch.len() {
                add[(i, 0)] += 3.0 * batch.mass()[i];
            }
            Ok(())
        })
        .unwrap();
    stepper
        .set_acceleration(|batch, add| {
            add.columns_mut()[1].iter_mut().for_each(|sum| *sum -= 1.0);
            assert!(batch.reference_position(0).is_none() && batch.volume().len() == batch.len());
            Ok(())
        })
        .unwrap();
    stepper.step(1e-2).unwrap();
    let momentum = stepper.info().unwrap().momentum;
    assert!((momentum[0] - 0.16 * 1e3 * 3e-2).abs() < 1e-9 && (momentum[1] + 0.16 * 1e3 * 1e-2).abs() < 1e-9);

    stepper
        .set_node_hook(MPM_AFTER_FORCES, |nodes, _velocity, force| {
            assert_eq!((nodes.body(), force.len()), (0, nodes.len()));
            force.column_mut(0).fill(0.0);
            Ok(())
        })
        .unwrap();
    assert_eq!(stepper.set_node_hook(9, |_, _, _| Ok(())).unwrap_err().status(), MPM_E_ARG);
    stepper.step(1e-2).unwrap();
    assert!((stepper.info().unwrap().momentum[0] - momentum[0]).abs() < 1e-9);
    stepper.clear_node_hook(MPM_AFTER_FORCES).unwrap();

    stepper
        .set_velocity_bc(|nodes, prescribed, velocity| {
            for i in 0..nodes.len() {
                prescribed[(i, 1)] = 1;
                velocity[(i, 1)] = 0.25;
            }
            Ok(())
        })
        .unwrap();
    stepper.configure(&StepperDesc { flip: 0.0, ..Default::default() }).unwrap();
    stepper.step(1e-2).unwrap();
    let velocities = stepper.particles(key).get::<f64>("velocity").unwrap();
    assert!(velocities[64..].iter().all(|v| (v - 0.25).abs() < 1e-12));
}

#[test]
fn motions_of_prescribed_particles() {
    let (mut stepper, key) = serial();
    stepper.particles_mut(key).set_all::<u8>("prescribed", &[1, 1]).unwrap();
    stepper
        .set_motion(key, |batch, add| {
            let t = batch.t();
            add.column_mut(0).iter_mut().for_each(|sum| *sum += 1.0 + t);
            Ok(())
        })
        .unwrap();
    stepper.step(1e-2).unwrap();
    assert!(stepper
        .particles(key)
        .get_of::<f64>("velocity", &[5])
        .unwrap()
        .iter()
        .zip([1.0, 0.0])
        .all(|(a, b)| *a == b));
    // they hold nothing but themselves
    assert!(stepper.particles_reaction(key).unwrap().iter().all(|force| force.abs() < 1e-9));
    assert!(stepper.particles_impulse(key).unwrap().iter().all(|impulse| impulse.abs() < 1e-9));
    stepper.clear_motion(key).unwrap();
}

#[test]
fn tractions_of_surfaces() {
    let (mut stepper, _) = serial();
    let mut face = Surface::new(stepper.grid(), &SurfaceDesc::default()).unwrap();
    face.add(&[0.7, 0.7, 0.4, 0.6], Some(&[0.2, 0.2, 0.0, 0.0])).unwrap();
    let mut calls = 0;
    face.set_traction(move |batch, add| {
        calls += 1;
        assert_eq!((batch.len(), batch.dim(), batch.t(), batch.dt()), (2, 2, (calls - 1) as f64 * 1e-3, 1e-3));
        assert_eq!((batch.id(), batch.reference_area()), ([0, 1].as_slice(), [0.2, 0.2].as_slice()));
        assert!(batch.area(0)[1] > 0.1 && batch.position(1)[1] > 0.5 && batch.displacement(0).len() == 2);
        assert!(calls > 1 || batch.velocity(1) == [0.0, 0.0]);
        add[(1, 0)] += 100.0;
        Ok(())
    })
    .unwrap();
    let face = stepper.add_surface(face).unwrap();
    stepper.step(1e-3).unwrap();
    let force = stepper.surface(face).get::<f64>("force").unwrap();
    assert!(force[0] == 0.0 && (force[1] - 20.0).abs() < 1e-12, "{force:?}");
    let before = stepper.hash().unwrap();
    stepper.surface_mut(face).set_traction(|_, _| panic!("no traction today")).unwrap();
    assert_eq!(panics(|| stepper.step(1e-3).unwrap()), "no traction today");
    assert_eq!(stepper.hash().unwrap(), before);
    stepper.surface_mut(face).set_traction(|_, _| Err(Refusal::stop("torn"))).unwrap();
    let error = stepper.step(1e-3).unwrap_err();
    assert!(error.status() == MPM_E_CALLBACK && error.source().unwrap().to_string() == "torn");
    stepper.surface_mut(face).set_traction(|_, _| Err(Refusal::SmallerStep)).unwrap();
    assert!(stepper.step(1e-3).unwrap_err().wants_smaller_step());
    stepper.surface_mut(face).clear_traction().unwrap();
    stepper.step(1e-3).unwrap();
}

#[test]
fn progress_cancels() {
    let (mut stepper, _) = serial();
    let mut calls = 0;
    stepper
        .set_progress(move |info| {
            calls += 1;
            if calls > 3 || info.step > 100 {
                return Err(Refusal::SmallerStep);
            }
            Ok(())
        })
        .unwrap();
    assert_eq!(stepper.advance(0.1).unwrap_err().status(), MPM_CANCELLED);
    assert_eq!(stepper.info().unwrap().step, 3);
}

#[test]
fn executors() {
    let run = |desc: ContextDesc| -> Result<u64> {
        let (mut stepper, _) = falling(&Context::with(desc)?, StepperDesc::default())?;
        stepper.advance(0.05)?;
        stepper.hash()
    };
    let tasks = Arc::new(AtomicUsize::new(0));
    let count = tasks.clone();
    let threads = move |n: usize, task: &(dyn Fn(usize) + Sync)| {
        count.fetch_add(n, SeqCst);
        std::thread::scope(|scope| {
            for first in 0..2 {
                scope.spawn(move || (first..n).step_by(2).for_each(task));
            }
        });
    };
    let by_host = run(ContextDesc::new().concurrency(3).executor(threads)).unwrap();
    assert_eq!(by_host, run(ContextDesc::new()).unwrap());
    assert!(tasks.load(SeqCst) > 0);
    let lazy = run(ContextDesc::new().concurrency(3).executor(|n, task| (1..n).for_each(task))).unwrap_err();
    assert!(lazy.source().unwrap().to_string().contains("left out task 0"));
    let text =
        panics(|| drop(run(ContextDesc::new().concurrency(3).executor(|_, task| [0, 0].into_iter().for_each(task)))));
    assert!(text.contains("ran task 0 twice"));
}
