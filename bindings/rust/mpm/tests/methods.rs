//! Fields, laws, solvers, obstacles, surfaces, files.
mod scene;
use mpm::constants::*;
use mpm::*;
use scene::*;
use std::sync::{Arc, Mutex};

#[test]
fn fields_and_views() {
    let context = Context::new().unwrap();
    let grid = grid(&context).unwrap();
    let jelly = Material::new(&context, "neo_hookean", &JELLY).unwrap();
    let mut set = Particles::new(&grid, &jelly).unwrap();
    assert_eq!(set.fill_ball(&[0.5, 0.5], 0.2, &[2, 2]).unwrap(), Filled { first_id: 0, count: set.len() as i64 });
    assert_eq!(set.fill_ball(&[0.5], 0.2, &[2, 2]).unwrap_err().status(), MPM_E_ARG);
    assert!(set.fill_mesh(&[0.2, 0.8, 0.2, 0.2, 0.2, 0.8], &[0, 1, 1, 2, 2, 0], &[2, 2]).unwrap().count > 0);
    assert_eq!(set.fill_mesh(&[0.2, 0.8, 0.2], &[0, 1], &[2, 2]).unwrap_err().status(), MPM_E_ARG);
    assert_eq!(set.fill_mesh(&[0.2, 0.8], &[0, 1], &[2, 2]).unwrap_err().status(), MPM_E_ARG);
    set.add(&[0.1, 0.2, 0.1, 0.2], &[1e-3; 2], Some(&[1.0, 2.0, 3.0, 4.0]), None, Some(&[900, 901])).unwrap();
    assert_eq!(set.get_of::<f64>("velocity", &[901, 900]).unwrap(), [2.0, 1.0, 4.0, 3.0]);
    assert_eq!(set.get::<f64>("deformation_gradient").unwrap().len(), 9 * set.len());
    assert!(
        set.get::<i64>("velocity").is_err() && set.get::<f64>("velocty").unwrap_err().to_string().contains("velocity")
    );
    set.add_field::<u8>("colour", 3).unwrap();
    set.set_of::<u8>("colour", &[900], &[1, 2, 3]).unwrap();
    assert_eq!(set.set_of::<u8>("colour", &[900], &[1]).unwrap_err().status(), MPM_E_ARG);
    let info = set.fields().unwrap().into_iter().find(|field| field.name == "colour").unwrap();
    assert_eq!((info.r#type, info.components, info.writable), (MPM_U8, 3, true));
    {
        let (x, id) = (set.map::<f64>("position").unwrap(), set.map::<i64>("id").unwrap());
        let at = id.column(0).iter().position(|&id| id == 901).unwrap();
        assert_eq!((x[(at, 0)], x[(at, 1)], x.components()), (0.2, 0.2, 2));
        assert!(x.len() >= set.len());
    }
    set.remove(&[900, 901]).unwrap();
    assert!(set.map_mut::<i64>("id").is_err() && set.map::<u8>("position").is_err());
    let mut v = set.map_mut::<f64>("velocity").unwrap();
    v.column_mut(0).fill(2.0);
    v[(0, 1)] = 7.0;
    v.release().unwrap();
    assert!(set.get::<f64>("velocity").unwrap()[..set.len()].iter().all(|&v| v == 2.0));
    let mut x = set.map_mut::<f64>("position").unwrap();
    x[(0, 0)] = f64::NAN;
    assert_eq!(x.release().unwrap_err().status(), MPM_E_ARG);
}

/// Hooke's law along x for each particle, by the deformation gradient.
fn spring(stiffness: f64) -> Law {
    Law::new(1.0, move |batch, out| {
        for i in 0..batch.len() {
            out.stress[(i, 0)] = stiffness * (batch.deformation_gradient(0)[i] - 1.0);
            for c in 1..6 {
                out.stress[(i, c)] = 0.0;
            }
            out.wave_speed[(i, 0)] = stiffness.sqrt();
            out.state[(i, 0)] = batch.state(0)[i] + batch.dt();
        }
        Ok(())
    })
    .state(&[5.0])
    .tangent(MPM_TANGENT_GENERAL, move |batch, tangent| {
        for (c, column) in tangent.columns_mut().into_iter().enumerate() {
            // tau = J s with s = k (F - 1): only the part along x is filled here, which is all that one axis needs
            for (i, value) in column.iter_mut().enumerate() {
                let f = batch.deformation_gradient(0)[i];
                *value = if c == 0 { stiffness * (2.0 * f - 1.0) * f - 2.0 * stiffness * (f - 1.0) * f } else { 0.0 };
            }
        }
        Ok(true)
    })
}

#[test]
fn laws_of_the_host() {
    let context = Context::new().unwrap();
    let law = Material::custom(&context, spring(4.0)).unwrap();
    let mut f = [0.0; 9];
    (f[0], f[4], f[8]) = (1.5, 1.0, 1.0);
    let path = Path {
        t: 1.0,
        dt: 0.5,
        deformation_gradient: &f,
        increment: &f,
        stress: &[0.0; 6],
        state: &[5.0],
        ids: None,
        position: None,
        tangent: true,
    };
    let out = law.update(&path).unwrap();
    assert_eq!((out.stress[0], out.state[0], out.wave_speed[0]), (2.0, 5.5, 2.0));
    assert!((out.tangent.unwrap().0[0] - (4.0 * 2.0 * 1.5 - 2.0 * 2.0 * 1.5)).abs() < 1e-12);
    assert_eq!(law.update(&Path { state: &[], ..path }).unwrap_err().status(), MPM_E_ARG);

    let desc = GridDesc { dim: 1, cells: [20, 0, 0], spacing: [0.1, 0.0, 0.0], ..Default::default() };
    let grid = Grid::new(&context, &desc).unwrap();
    let mut set = Particles::new(&grid, &law).unwrap();
    drop(law);
    set.fill_box(&[0.5], &[1.5], &[2]).unwrap();
    let mut stepper = Stepper::new(&grid, &StepperDesc { scheme: MPM_NEWMARK, ..Default::default() }).unwrap();
    let key = stepper.add(set).unwrap();
    stepper
        .set_force(|batch, add| {
            for i in 0..batch.len() {
                add[(i, 0)] += batch.mass()[i] * (batch.position(0)[i] - 1.0);
            }
            Ok(())
        })
        .unwrap();
    stepper.step(0.05).unwrap();
    assert!(stepper.info().unwrap().newton_iterations > 0);
    let state = stepper.particles(key).get::<f64>("state").unwrap();
    assert!(state.iter().all(|&s| (s - 5.05).abs() < 1e-12));
    let error = Material::custom(&context, Law::new(-1.0, |_, _| Ok(()))).err().unwrap();
    assert!(error.to_string().contains("density"));
}

#[test]
fn solver_of_the_host() {
    let desc = StepperDesc { scheme: MPM_NEWMARK, linear_tolerance: 1e-12, ..Default::default() };
    let (mut by_library, _) = falling(&Context::new().unwrap(), desc).unwrap();
    let (mut by_host, _) =
        falling(&Context::new().unwrap(), StepperDesc { linear_solver: MPM_SOLVER_HOST, ..desc }).unwrap();
    by_host
        .set_linear_solver(|system| {
            assert!(system.symmetric() && system.component().len() == system.rows() && system.node()[0] >= 0);
            let n = system.rows();
            let rows = system.csr()?;
            let of_row = |r: usize| rows.start[r] as usize..rows.start[r + 1] as usize;
            let mut ax = vec![0.0; n];
            system.apply(system.rhs, &mut ax)?;
            let by_rows: f64 = of_row(0).map(|k| rows.value[k] * system.rhs[rows.column[k] as usize]).sum();
            assert!((by_rows - ax[0]).abs() <= 1e-9 * ax[0].abs().max(1.0));
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let mut x = vec![0.0; n];
            let mut r = system.rhs.to_vec();
            let mut p = r.clone();
            let (mut rr, goal) = (dot(&r, &r), 1e-24 * dot(&r, &r));
            let mut iterations = 0;
            while rr > goal && iterations < 2000 {
                system.apply(&p, &mut ax)?;
                let alpha = rr / dot(&p, &ax);
                for i in 0..n {
                    x[i] += alpha * p[i];
                    r[i] -= alpha * ax[i];
                }
                let next = dot(&r, &r);
                (0..n).for_each(|i| p[i] = r[i] + next / rr * p[i]);
                (rr, iterations) = (next, iterations + 1);
            }
            system.solution.copy_from_slice(&x);
            Ok(iterations)
        })
        .unwrap();
    for stepper in [&mut by_library, &mut by_host] {
        stepper.set_wall(MPM_Y_MIN, MPM_WALL_FIXED, 0.0).unwrap();
        (0..3).for_each(|_| stepper.step(0.05).unwrap());
    }
    let (a, b) = (by_library.info().unwrap(), by_host.info().unwrap());
    assert!((a.strain_energy - b.strain_energy).abs() <= 1e-7 * a.kinetic_energy);
    assert!(b.linear_iterations > 0 && !by_host.residuals().unwrap().is_empty());
    by_host.set_linear_solver(|_| Err(Refusal::stop("not today"))).unwrap();
    assert_eq!(by_host.step(0.05).unwrap_err().status(), MPM_E_CALLBACK);
}

#[test]
fn obstacles_and_contact() {
    let context = Context::new().unwrap();
    let (mut stepper, key) = falling(&context, StepperDesc::default()).unwrap();
    let desc = ObstacleDesc { motion: MPM_MOTION_PRESCRIBED, ..ObstacleDesc::new(MPM_SHAPE_DISTANCE) };
    let floor = ObstacleDesc { pose: Pose { position: [0.5, 0.28, 0.0], ..Default::default() }, ..desc }.distance(
        |points, out| {
            for i in 0..points.len() {
                out.distance[(i, 0)] = points.position(1)[i];
                out.normal[(i, 0)] = 0.0;
                out.normal[(i, 1)] = 1.0;
            }
            Ok(())
        },
    );
    let floor = stepper.add_obstacle(Obstacle::new(&context, floor).unwrap()).unwrap();
    stepper
        .obstacle_mut(floor)
        .set_motion(|_, _, velocity, _| {
            velocity[1] = 0.1;
            Ok(())
        })
        .unwrap();
    stepper.advance(0.2).unwrap();
    let pose = stepper.obstacle(floor).pose().unwrap();
    assert!((pose.position[1] - 0.3).abs() < 1e-12 && (pose.velocity[1] - 0.1).abs() < 1e-12);
    let info = stepper.obstacle(floor).contact_info(MPM_BODY_ANY).unwrap();
    assert!(info.closed > 0 && info.impulse[1] > 0.0);
    stepper.set_body(key, 3).unwrap();
    assert_eq!(stepper.body(key).unwrap(), 3);
    stepper.set_contact(3, 4, Some(&ContactDesc { friction: 0.4, ..Default::default() })).unwrap();
    stepper.set_contact(3, 4, None).unwrap();
    stepper
        .set_friction(|_, friction| {
            friction.fill(0.2);
            Ok(())
        })
        .unwrap();
    stepper.obstacle_mut(floor).set_motion(|_, _, _, _| Err(Refusal::stop("stuck"))).unwrap();
    assert_eq!(stepper.step(1e-3).unwrap_err().status(), MPM_E_CALLBACK);
    let mut floor = stepper.remove_obstacle(floor).unwrap();
    floor.clear_motion().unwrap();
    assert_eq!(floor.set_load([0.0; 3], [0.0; 3]).unwrap_err().status(), MPM_E_UNSUPPORTED);
}

#[test]
fn splitting_and_merging() {
    let context = Context::new().unwrap();
    let (mut stepper, set) = falling(&context, StepperDesc::default()).unwrap();
    let halves = AdaptionDesc { every: 0, split_edge: 0.4, ..Default::default() };
    stepper.set_adaption(set, Some(&halves)).unwrap();
    let first = stepper.particles(set).len();
    stepper.adapt().unwrap();
    let info = stepper.adaption_info(set).unwrap();
    assert_eq!(
        (stepper.particles(set).len(), info.splits as usize, info.added as usize),
        (4 * first, first, 3 * first)
    );

    // one pair of those that are to be merged stays two particles
    let seen = Arc::new(Mutex::new((0, -1)));
    let merging = AdaptionDesc { every: 0, max_per_cell: 1, merge_distance: 0.3, ..Default::default() };
    let shown = seen.clone();
    stepper
        .set_adaption_with(set, &merging, move |batch, accept| {
            assert_eq!((batch.what(), batch.len(), batch.dim()), (MPM_ADAPT_MERGE, accept.len(), 2));
            assert!(!batch.is_empty() && batch.position(1)[0] > 0.3 && batch.raw().n == batch.len() as i64);
            accept[0] = 0;
            *shown.lock().unwrap() = (batch.len(), batch.other().unwrap()[0]);
            Ok(())
        })
        .unwrap();
    stepper.adapt().unwrap();
    let (pairs, stays) = *seen.lock().unwrap();
    assert_eq!(stepper.adaption_info(set).unwrap().merges as usize, pairs - 1);
    assert!(pairs > 10 && stepper.particles(set).get::<i64>("id").unwrap().contains(&stays));
    let before = stepper.hash().unwrap();
    stepper.set_adaption_with(set, &merging, |_, _| Err(Refusal::stop("as they are"))).unwrap();
    let error = stepper.adapt().unwrap_err();
    assert_eq!((error.status(), stepper.hash().unwrap()), (MPM_E_CALLBACK, before));

    let refused = AdaptionDesc { split_edge: 0.2, ..halves };
    assert_eq!(stepper.set_adaption(set, Some(&refused)).unwrap_err().status(), MPM_E_ARG);
    stepper.set_adaption(set, None).unwrap();
    stepper.adapt().unwrap();
    assert_eq!(stepper.hash().unwrap(), before);
    stepper.remove(set).unwrap();
    assert_eq!(stepper.adaption_info(set).unwrap_err().status(), MPM_E_NOT_FOUND);
}

#[test]
fn surfaces() {
    let sum = |values: &[f64]| values.iter().sum::<f64>();
    let context = Context::new().unwrap();
    let (mut stepper, _) = falling(&context, StepperDesc::default()).unwrap();
    stepper.configure(&StepperDesc::default()).unwrap();
    let mut face = Surface::new(stepper.grid(), &SurfaceDesc { pressure: 40.0, ..Default::default() }).unwrap();
    assert!(face.is_empty() && face.dim() == 2);
    let made = face.add_polyline(&[0.7, 0.7, 0.3, 0.7], false, 0.051).unwrap();
    assert_eq!((made, face.len()), (Filled { first_id: 0, count: 8 }, 8));
    assert_eq!(face.add(&[0.5, 0.6, 0.5, 0.6], Some(&[0.0, 0.1, 0.2, 0.3])).unwrap(), 8);
    assert_eq!(face.add(&[0.5, 0.5], None).unwrap(), 10);
    assert_eq!(face.get::<i64>("id").unwrap(), (0..11).collect::<Vec<_>>());
    assert_eq!(face.get_of::<f64>("area", &[9, 8, 10]).unwrap(), [0.1, 0.0, 0.0, 0.3, 0.2, 0.0]);
    face.remove(&[8, 9, 10]).unwrap();
    assert_eq!(face.remove(&[8]).unwrap_err().status(), MPM_E_NOT_FOUND);
    face.set("pressure", &[2.0; 8]).unwrap();
    face.set_of("pressure", &[3, 1], &[5.0, 7.0]).unwrap();
    assert_eq!(face.get::<f64>("pressure").unwrap()[..4], [2.0, 7.0, 2.0, 5.0]);
    face.set("pressure", &[0.0; 8]).unwrap();
    assert_eq!(face.refine(0.026).unwrap(), 8);
    assert!((sum(&face.get::<f64>("area").unwrap()[..16]) - 0.4).abs() < 1e-15);
    for (error, status, text) in [
        (face.add(&[0.5; 3], None).unwrap_err(), MPM_E_ARG, "position"),
        (face.add(&[0.5; 2], Some(&[0.0; 4])).unwrap_err(), MPM_E_ARG, "area"),
        (face.add(&[-0.5; 2], None).unwrap_err(), MPM_E_ARG, "inside the grid"),
        (face.add_triangles(&[0.5; 9], &[0, 1, 2], 0.1).unwrap_err(), MPM_E_UNSUPPORTED, ""),
        (face.get::<f64>("forse").unwrap_err(), MPM_E_NOT_FOUND, "force"),
        (face.get::<i64>("force").unwrap_err(), MPM_E_ARG, "force"),
        (face.set("force", &[0.0; 32]).unwrap_err(), MPM_E_ARG, "force"),
        (face.set("traction", &[0.0; 16]).unwrap_err(), MPM_E_ARG, "traction"),
        (face.refine(-1.0).unwrap_err(), MPM_E_ARG, "spacing"),
        (face.configure(&SurfaceDesc { pressure: f64::NAN, ..Default::default() }).unwrap_err(), MPM_E_ARG, "pressure"),
    ] {
        assert!(error.status() == status && error.to_string().contains(text), "{error}");
    }

    let face = stepper.add_surface(face).unwrap();
    stepper.step(1e-4).unwrap();
    let force = stepper.surface(face).get::<f64>("force").unwrap();
    assert!((sum(&force[..16]) + 16.0).abs() < 1e-12 && sum(&force[16..]).abs() < 1e-12, "{force:?}");
    assert!((stepper.info().unwrap().momentum[0] + 16e-4).abs() < 1e-12);
    let dead = SurfaceDesc { dead_traction: [0.0, 30.0, 0.0], ..Default::default() };
    stepper.surface_mut(face).configure(&dead).unwrap();
    stepper.step(1e-4).unwrap();
    let force = stepper.surface(face).get::<f64>("force").unwrap();
    assert!(sum(&force[..16]).abs() < 1e-12 && (sum(&force[16..]) - 12.0).abs() < 1e-12, "{force:?}");

    let mut face = stepper.remove_surface(face).unwrap();
    assert!(face.len() == 16 && face.get::<f64>("displacement").unwrap()[0] < 0.0);
    let before = stepper.info().unwrap().momentum;
    stepper.step(1e-4).unwrap();
    assert!((stepper.info().unwrap().momentum[1] - before[1]).abs() < 1e-12, "what was taken out pulls");
    face.configure(&SurfaceDesc::default()).unwrap();
    face.set_traction(|_, _| Ok(())).unwrap();
    face.clear_traction().unwrap();
    let key = stepper.add_surface(face).unwrap();
    stepper.remove_surface(key).unwrap();
    assert_eq!(stepper.remove_surface(key).err().unwrap().status(), MPM_E_NOT_FOUND);
}

#[test]
fn surfaces_of_triangles() {
    let context = Context::new().unwrap();
    let desc = GridDesc { dim: 3, cells: [8; 3], spacing: [0.125; 3], ..Default::default() };
    let grid = Grid::new(&context, &desc).unwrap();
    let jelly = Material::new(&context, "neo_hookean", &JELLY).unwrap();
    let mut set = Particles::new(&grid, &jelly).unwrap();
    set.fill_box(&[0.25; 3], &[0.75; 3], &[2; 3]).unwrap();
    let mut stepper = Stepper::new(&grid, &StepperDesc::default()).unwrap();
    stepper.add(set).unwrap();
    let mut top = Surface::new(&grid, &SurfaceDesc { pressure: 8.0, ..Default::default() }).unwrap();
    let (low, high) = (0.25, 0.75);
    let corners = [low, high, high, low, low, low, high, high, high, high, high, high];
    let made = top.add_triangles(&corners, &[0, 1, 2, 0, 2, 3], 0.2).unwrap();
    assert_eq!(made.count as usize, top.len());
    assert_eq!(top.add_triangles(&corners, &[0, 1, 4], 0.2).unwrap_err().status(), MPM_E_ARG);
    assert_eq!(top.add_triangles(&corners, &[0, 1], 0.2).unwrap_err().status(), MPM_E_ARG);
    let top = stepper.add_surface(top).unwrap();
    stepper.step(1e-4).unwrap();
    let force = stepper.surface(top).get::<f64>("force").unwrap();
    let total = force[2 * stepper.surface(top).len()..].iter().sum::<f64>();
    assert!((total + 2.0).abs() < 1e-12, "{total}");
}

#[test]
fn steps_in_parts() {
    let (mut whole, _) = falling(&Context::new().unwrap(), StepperDesc::default()).unwrap();
    let (mut parts, _) = falling(&Context::new().unwrap(), StepperDesc::default()).unwrap();
    let before = parts.hash().unwrap();
    {
        let mut step = parts.begin(1e-3).unwrap();
        step.map_mut(0, "velocity").unwrap().column_mut(0).fill(1.0);
    }
    assert_eq!(parts.hash().unwrap(), before, "a step that goes is dropped");
    whole.step(1e-3).unwrap();
    let mut step = parts.begin(1e-3).unwrap();
    assert!(step.map(0, "mass").unwrap().column(0).iter().sum::<f64>() > 0.0);
    step.grid().unwrap();
    step.end().unwrap();
    assert_eq!(parts.hash().unwrap(), whole.hash().unwrap());
    assert!(!parts.map::<i64>(0, "index").unwrap().is_empty());
}

#[test]
fn states_and_files() {
    let folder = std::env::temp_dir().join(format!("mpm-rust-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = |name: &str| folder.join(name).to_str().unwrap().to_string();
    let context = Context::new().unwrap();
    let (mut stepper, key) = falling(&context, StepperDesc::default()).unwrap();
    stepper.advance(0.01).unwrap();
    let state = stepper.save().unwrap();
    stepper.save_file(&path("state")).unwrap();
    let hash = stepper.hash().unwrap();
    stepper.advance(0.02).unwrap();
    assert!(stepper.hash().unwrap() != hash);
    stepper.load(&state).unwrap();
    assert_eq!(stepper.hash().unwrap(), hash);
    assert_eq!(stepper.load(&state[..50]).unwrap_err().status(), MPM_E_FORMAT);
    stepper.load_file(&path("state")).unwrap();
    stepper.particles(key).write(&path("a.vtp"), &["velocity"]).unwrap();
    stepper.step(1e-3).unwrap();
    stepper.write_grid(0, &path("a.vti"), &["mass"]).unwrap();
    let mut series = Series::open(&context, &path("a.pvd")).unwrap();
    series.append(0.01, "a.vtp").unwrap();
    drop(series);
    assert!(std::fs::read_to_string(path("a.pvd")).unwrap().contains("a.vtp"));
    assert_eq!(stepper.particles(key).write("/nowhere/a.vtp", &[]).unwrap_err().status(), MPM_E_IO);
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Takes so many bytes, then none.
struct Full(Vec<u8>, usize);
impl std::io::Write for Full {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if self.0.len() + bytes.len() > self.1 {
            return Err(std::io::Error::new(std::io::ErrorKind::Other, "the disk of the test is full"));
        }
        self.0.extend(bytes);
        Ok(bytes.len())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn floats_and_writers() {
    let folder = std::env::temp_dir().join(format!("mpm-rust-to-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = |name: &str| folder.join(name).to_str().unwrap().to_string();
    let context = Context::new().unwrap();
    let (mut stepper, key) = falling(&context, StepperDesc::default()).unwrap();
    stepper.advance(0.01).unwrap();

    let set = stepper.particles(key);
    let (n, v, m) = (set.len(), set.get::<f64>("velocity").unwrap(), set.get::<f64>("mass").unwrap());
    let by_id = set.get_f32(&["velocity", "mass"], MPM_BY_ID).unwrap();
    assert_eq!(by_id.len(), 3 * n);
    for (i, one) in by_id.chunks(3).enumerate() {
        assert_eq!(one, [v[i] as f32, v[n + i] as f32, m[i] as f32]);
    }
    let mut ids = set.get_f32(&["id"], MPM_LIBRARY_ORDER).unwrap();
    ids.sort_by(|a, b| a.partial_cmp(b).unwrap());
    assert!(ids.iter().enumerate().all(|(i, &id)| id == i as f32), "no inert slots, each particle once");
    assert_eq!(set.get_f32(&["velocty"], MPM_BY_ID).unwrap_err().status(), MPM_E_NOT_FOUND);
    assert_eq!(set.get_f32(&["mass"], 7).unwrap_err().status(), MPM_E_ARG);

    let (all, mut some) = (set.pack(None).unwrap(), set.pack(Some(&[3, 1])).unwrap());
    let set = stepper.particles_mut(key);
    assert_eq!(set.unpack(&some).unwrap_err().status(), MPM_E_ARG);
    set.remove(&[1, 3]).unwrap();
    set.unpack(&some).unwrap();
    assert_eq!(set.pack(None).unwrap(), all);
    *some.last_mut().unwrap() ^= 1;
    assert_eq!(set.unpack(&some).unwrap_err().status(), MPM_E_FORMAT);

    let (mut state, mut vtp, mut vti) = (Vec::new(), Vec::new(), Vec::new());
    stepper.save_to(&mut state).unwrap();
    assert_eq!(state, stepper.save().unwrap());
    stepper.particles(key).write_to(&mut vtp, &["velocity"]).unwrap();
    stepper.particles(key).write(&path("a.vtp"), &["velocity"]).unwrap();
    assert_eq!(vtp, std::fs::read(path("a.vtp")).unwrap());
    stepper.write_grid_to(0, &mut vti, &["mass"]).unwrap();
    stepper.write_grid(0, &path("a.vti"), &["mass"]).unwrap();
    assert_eq!(vti, std::fs::read(path("a.vti")).unwrap());
    let mut file = std::io::BufWriter::with_capacity(1 << 20, std::fs::File::create(path("state")).unwrap());
    stepper.save_to(&mut file).unwrap();
    assert_eq!(std::fs::read(path("state")).unwrap(), state, "the writer is flushed");
    drop(file);

    let refused = stepper.save_to(Full(Vec::new(), 100)).unwrap_err();
    assert_eq!(refused.status(), MPM_E_CALLBACK);
    let source = std::error::Error::source(&refused).unwrap().to_string();
    assert!(source.contains("of the test is full"), "{source}");
    assert_eq!(stepper.save().unwrap(), state, "nothing has changed");
    assert_eq!(stepper.write_grid_to(0, &mut vti, &["mas"]).unwrap_err().status(), MPM_E_NOT_FOUND);
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn models() {
    let models = Material::models();
    assert!(models.iter().any(|name| name == "drucker_prager"));
    let parameters = Material::parameters("neo_hookean").unwrap();
    assert!(parameters.iter().any(|one| one.name == "density" && one.default.is_none() && one.unit.contains("mass")));
    assert_eq!(Material::state_variables("j2").unwrap()[0].name, "plastic_strain");
    assert_eq!(Material::parameters("sponge").unwrap_err().status(), MPM_E_NOT_FOUND);
    let mut sand = Particles::new(
        &grid(&Context::new().unwrap()).unwrap(),
        &Material::new(&Context::new().unwrap(), "neo_hookean", &JELLY).unwrap(),
    );
    assert!(sand.is_err(), "grid and material are of two contexts");
    let context = Context::new().unwrap();
    let jelly = Material::new(&context, "linear_elastic", &JELLY).unwrap();
    sand = block(&grid(&context).unwrap(), &jelly);
    let mut sand = sand.unwrap();
    sand.set_geostatic(1, -9.81, 0.7, 0.5, 0.0).unwrap();
    sand.reset_reference().unwrap();
    let stress = sand.get::<f64>("stress").unwrap();
    assert!(stress[sand.len()..2 * sand.len()].iter().all(|&s| s < 0.0));
}
