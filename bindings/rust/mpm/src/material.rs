//! Materials: laws that are built in, and those of the host.
use crate::callback::Owned;
use crate::entry::{Core, Sent};
use crate::error::{c_text, c_texts, text_of};
use crate::law::{on_stress, on_tangent, LawSlots};
use crate::arrays::{fits, pointer};
use crate::{sys, Context, Error, Law, Result};
use std::sync::Arc;

/// A constitutive law with its parameters. A clone is the same material.
#[derive(Clone)]
pub struct Material {
    pub(crate) core: Arc<MaterialCore>,
}

pub(crate) struct MaterialCore {
    pub context: Arc<Core>,
    pub handle: *mut sys::mpm_material,
    state_count: usize,
    /// What C holds on to of a law of the host, from a Box; else NULL.
    law: *mut LawSlots,
}

// SAFETY: the handle is used by an Entry only.
unsafe impl Send for MaterialCore {}
unsafe impl Sync for MaterialCore {}

/// A parameter of a law that is built in.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its unit as a dimension.
    pub unit: String,
    /// What it is.
    pub text: String,
    /// Its default; none if it must be given.
    pub default: Option<f64>,
    /// Its least and its largest value.
    pub range: (f64, f64),
}

/// A state variable of a law that is built in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StateVariable {
    /// Its name.
    pub name: String,
    /// Its unit as a dimension.
    pub unit: String,
    /// What it is.
    pub text: String,
}

/// What a material is to be led through without a grid: `[components][n]` of n items. See [`Material::update`].
#[derive(Clone, Copy, Debug)]
pub struct Path<'a> {
    /// Time at the end of the step.
    pub t: f64,
    /// Size of the step; 0: the state as it is.
    pub dt: f64,
    /// `[9][n]` at the end of the step.
    pub deformation_gradient: &'a [f64],
    /// `[9][n]` of this step alone.
    pub increment: &'a [f64],
    /// `[6][n]` before the step.
    pub stress: &'a [f64],
    /// `[variables][n]` before the step.
    pub state: &'a [f64],
    /// Ids, below 0 for inert items; none: from 0.
    pub ids: Option<&'a [i64]>,
    /// `[3][n]`; none: zeros.
    pub position: Option<&'a [f64]>,
    /// Whether the tangent is wanted.
    pub tangent: bool,
}

/// What became of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Updated {
    /// `[6][n]`.
    pub stress: Vec<f64>,
    /// `[variables][n]`.
    pub state: Vec<f64>,
    /// `[n]`.
    pub wave_speed: Vec<f64>,
    /// `[n]`.
    pub kinematic_viscosity: Vec<f64>,
    /// `[n]` per initial volume; NaN where the law does not know it.
    pub energy: Vec<f64>,
    /// `[81][n]` in the general form, and whether it is symmetric, if it was wanted.
    pub tangent: Option<(Vec<f64>, bool)>,
}

impl Material {
    /// A law that is built in, with parameters by name.
    pub fn new(context: &Context, model: &str, parameters: &[(&str, f64)]) -> Result<Self> {
        let name = c_text(model)?;
        let names: Vec<&str> = parameters.iter().map(|one| one.0).collect();
        let (_held, names) = c_texts(&names)?;
        let list: Vec<sys::mpm_param> =
            names.iter().zip(parameters).map(|(&name, one)| sys::mpm_param { name, value: one.1 }).collect();
        let mut handle = std::ptr::null_mut();
        let entry = context.core.enter()?;
        // SAFETY: all texts end with a zero and outlive the call.
        let status = unsafe {
            sys::mpm_material_create(context.core.handle, name.as_ptr(), list.as_ptr(), list.len() as i32, &mut handle)
        };
        entry.done(status)?;
        // SAFETY: the name ends with a zero.
        let state_count = unsafe { sys::mpm_material_state_count(name.as_ptr()) } as usize;
        let (context, law) = (context.core.clone(), std::ptr::null_mut());
        Ok(Material { core: Arc::new(MaterialCore { context, handle, state_count, law }) })
    }

    /// A law of the host.
    pub fn custom(context: &Context, law: Law) -> Result<Self> {
        let thrown = &context.core.thrown;
        let mut desc = sys::mpm_material_desc {
            state_count: i32::try_from(law.state.len()).unwrap_or(i32::MAX),
            density: law.density,
            stress: Some(on_stress),
            state_initial: law.state.as_ptr(),
            ..Default::default()
        };
        let tangent = law.tangent.map(|(form, function)| {
            desc.tangent_form = form;
            desc.tangent = Some(if form == sys::MPM_TANGENT_GENERAL { on_tangent::<81> } else { on_tangent::<36> });
            Owned::new(thrown, function)
        });
        let slots = Box::into_raw(Box::new(LawSlots { stress: Owned::new(thrown, law.stress), tangent }));
        desc.user = slots.cast();
        let mut handle = std::ptr::null_mut();
        let status = context.core.enter().and_then(|entry| {
            // SAFETY: the descriptor is whole, and the slots outlive the material.
            let status = unsafe { sys::mpm_material_create_custom(context.core.handle, &desc, &mut handle) };
            entry.done(status)
        });
        if let Err(error) = status {
            // SAFETY: there is no material that has it.
            drop(unsafe { Box::from_raw(slots) });
            return Err(error);
        }
        let (context, state_count) = (context.core.clone(), law.state.len());
        Ok(Material { core: Arc::new(MaterialCore { context, handle, state_count, law: slots }) })
    }

    /// The number of state variables of a particle.
    pub fn state_count(&self) -> usize {
        self.core.state_count
    }

    /// Leads items through a step without a grid: see `mpm_material_update()`.
    pub fn update(&self, path: &Path<'_>) -> Result<Updated> {
        let n = path.deformation_gradient.len() / 9;
        let variables = self.state_count();
        fits("deformation_gradient", path.deformation_gradient.len(), 9 * n)?;
        fits("increment", path.increment.len(), 9 * n)?;
        fits("stress", path.stress.len(), 6 * n)?;
        fits("state", path.state.len(), variables * n)?;
        path.ids.map_or(Ok(()), |ids| fits("ids", ids.len(), n))?;
        path.position.map_or(Ok(()), |position| fits("position", position.len(), 3 * n))?;
        let zeros = |components: usize| vec![0.0; components * n];
        let mut out = Updated {
            stress: zeros(6),
            state: zeros(variables),
            wave_speed: zeros(1),
            kinematic_viscosity: zeros(1),
            energy: vec![f64::NAN; n],
            tangent: None,
        };
        let mut tangent = if path.tangent { zeros(81) } else { Vec::new() };
        let mut symmetric = 0;
        let batch = sys::mpm_material_batch {
            state_count: variables as i32,
            n: n as i64,
            ld: n as i64,
            t: path.t,
            dt: path.dt,
            id: pointer(path.ids),
            F: path.deformation_gradient.as_ptr(),
            F_inc: path.increment.as_ptr(),
            stress: path.stress.as_ptr(),
            state: path.state.as_ptr(),
            stress_new: out.stress.as_mut_ptr(),
            state_new: out.state.as_mut_ptr(),
            wave_speed: out.wave_speed.as_mut_ptr(),
            kinematic_viscosity: out.kinematic_viscosity.as_mut_ptr(),
            energy: out.energy.as_mut_ptr(),
            position: pointer(path.position),
            ..Default::default()
        };
        let wanted = if path.tangent { tangent.as_mut_ptr() } else { std::ptr::null_mut() };
        let entry = self.core.context.enter()?;
        // SAFETY: all lengths were checked.
        let status = unsafe { sys::mpm_material_update(self.core.handle, &batch, wanted, &mut symmetric) };
        entry.done(status)?;
        if path.tangent {
            out.tangent = Some((tangent, symmetric != 0));
        }
        Ok(out)
    }

    /// The names of the laws that are built in.
    pub fn models() -> Vec<String> {
        // SAFETY: texts are static.
        (0..unsafe { sys::mpm_material_model_count() })
            .map(|k| text_of(unsafe { sys::mpm_material_model_name(k) }))
            .collect()
    }

    /// The parameters of a law that is built in.
    pub fn parameters(model: &str) -> Result<Vec<Parameter>> {
        let name = known(model)?;
        let mut out = Vec::new();
        loop {
            let (mut of, mut unit, mut text) = (std::ptr::null(), std::ptr::null(), std::ptr::null());
            let (mut default, mut low, mut high) = (0.0, 0.0, 0.0);
            let index = out.len() as i32;
            // SAFETY: texts are static.
            let status = unsafe {
                sys::mpm_material_model_param(
                    name.as_ptr(),
                    index,
                    &mut of,
                    &mut unit,
                    &mut text,
                    &mut default,
                    &mut low,
                    &mut high,
                )
            };
            if status != sys::MPM_OK {
                return Ok(out);
            }
            let default = if default.is_nan() { None } else { Some(default) };
            let (name, unit, text) = (text_of(of), text_of(unit), text_of(text));
            out.push(Parameter { name, unit, text, default, range: (low, high) });
        }
    }

    /// The state variables of a law that is built in.
    pub fn state_variables(model: &str) -> Result<Vec<StateVariable>> {
        let name = known(model)?;
        let mut out = Vec::new();
        loop {
            let (mut of, mut unit, mut text) = (std::ptr::null(), std::ptr::null(), std::ptr::null());
            let index = out.len() as i32;
            // SAFETY: texts are static.
            let status = unsafe { sys::mpm_material_state_name(name.as_ptr(), index, &mut of, &mut unit, &mut text) };
            if status != sys::MPM_OK {
                return Ok(out);
            }
            out.push(StateVariable { name: text_of(of), unit: text_of(unit), text: text_of(text) });
        }
    }

    /// The handle of C.
    pub fn as_ptr(&self) -> *mut sys::mpm_material {
        self.core.handle
    }
}

fn known(model: &str) -> Result<std::ffi::CString> {
    let name = c_text(model)?;
    // SAFETY: the name ends with a zero.
    if unsafe { sys::mpm_material_state_count(name.as_ptr()) } < 0 {
        return Err(Error::new(sys::MPM_E_NOT_FOUND, format!("no model \"{model}\"")));
    }
    Ok(name)
}

impl Drop for MaterialCore {
    fn drop(&mut self) {
        let (handle, law) = (Sent(self.handle), Sent(self.law));
        self.context.bury(move || {
            // SAFETY: nobody else has the handle. While it is refused C holds on to the law.
            unsafe {
                if sys::mpm_material_destroy(handle.get()) == sys::MPM_OK && !law.get().is_null() {
                    drop(Box::from_raw(law.get()));
                }
            }
        });
    }
}
