//! What calls and callbacks cost from Rust: the scene of `bindings/costs/costs.c`.
use mpm::constants::*;
use mpm::{Context, Error, Grid, GridDesc, Law, Material, Particles, SetKey, Stepper, StepperDesc};
use std::time::Instant;

const MU: f64 = 1e3 / 2.6;
const LAMBDA: f64 = 300.0 / (1.3 * 0.4);

fn neo_hookean() -> Law {
    Law::new(1e3, |batch, out| {
        let n = batch.len();
        let f: [&[f64]; 9] = std::array::from_fn(|c| &batch.deformation_gradient(c)[..n]);
        let of = |p: usize| {
            let jacobian = (f[0][p] * f[4][p] - f[1][p] * f[3][p]) * f[8][p];
            (jacobian, LAMBDA * jacobian.ln() - MU)
        };
        let pressures: Vec<(f64, f64)> = (0..n).map(of).collect();
        for (c, (i, j)) in [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)].into_iter().enumerate() {
            let (i, j) = (3 * i, 3 * j);
            for (p, stress) in out.stress.column_mut(c).iter_mut().enumerate() {
                let (jacobian, pressure) = pressures[p];
                let sum = f[i][p] * f[j][p] + f[i + 1][p] * f[j + 1][p] + f[i + 2][p] * f[j + 2][p];
                *stress = (MU * sum + if c < 3 { pressure } else { 0.0 }) / jacobian;
            }
        }
        out.wave_speed.column_mut(0).fill(1.16);
        Ok(())
    })
}

fn make(kind: usize) -> Result<(Stepper, SetKey), Error> {
    let context = Context::new()?;
    let (cells, spacing) = ([200, 200, 0], [1.0 / 200.0, 1.0 / 200.0, 0.0]);
    let grid = Grid::new(&context, &GridDesc { dim: 2, cells, spacing, ..Default::default() })?;
    let material = match kind {
        2 => Material::custom(&context, neo_hookean())?,
        _ => Material::new(&context, "neo_hookean", &[("E", 1e3), ("nu", 0.3), ("density", 1e3)])?,
    };
    let mut set = Particles::new(&grid, &material)?;
    set.fill_box(&[0.1, 0.1], &[0.45, 0.45], &[2, 2])?;
    let mut stepper = Stepper::new(&grid, &StepperDesc { transfer: MPM_APIC_MLS, ..Default::default() })?;
    let key = stepper.add(set)?;
    if kind == 1 {
        stepper.set_force(|batch, add| {
            let terms = batch.mass().iter().zip(batch.position(0));
            for (sum, (mass, x)) in add.column_mut(1).iter_mut().zip(terms) {
                *sum += mass * (-0.05 * x);
            }
            Ok(())
        })?;
    }
    for _ in 0..20 {
        stepper.step(1e-4)?;
    }
    Ok((stepper, key))
}

/// The least seconds of `tries`, in each of which so many calls are made.
fn best(tries: usize, calls: usize, mut work: impl FnMut() -> Result<(), Error>) -> Result<f64, Error> {
    let mut least = f64::INFINITY;
    for _ in 0..tries {
        let start = Instant::now();
        for _ in 0..calls {
            work()?;
        }
        least = least.min(start.elapsed().as_secs_f64() / calls as f64);
    }
    Ok(least)
}

fn main() -> Result<(), Error> {
    let mut kinds = [make(0)?, make(1)?, make(2)?];
    let set = kinds[0].0.particles(kinds[0].1);
    let (n, mut sum) = (set.len(), 0);
    let count = best(200, 1000, || {
        sum += set.len();
        Ok(())
    })?;
    let view = best(200, 100, || set.map::<f64>("position").map(drop))?;
    assert!(sum == 200_000 * n);
    let mut times = [f64::INFINITY; 3];
    for _ in 0..40 {
        for (time, (stepper, _)) in times.iter_mut().zip(&mut kinds) {
            *time = time.min(best(5, 1, || stepper.step(1e-4).map(drop))?);
        }
    }
    let [step, force, law] = times.map(|t| 1e6 * t);
    println!(
        "{n} particles: count {:.1} ns, view {:.0} ns, step {step:.0} us, force {:+.0} us, law {:+.0} us",
        1e9 * count,
        1e9 * view,
        force - step,
        law - step
    );
    Ok(())
}
