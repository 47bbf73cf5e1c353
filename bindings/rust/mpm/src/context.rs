//! The context.
use crate::callback::{alone, shared, Owned, Raised, Refusal, Thrown};
use crate::entry::Core;
use crate::error::text_of;
use crate::{sys, Error, Result};
use std::any::Any;
use std::os::raw::{c_char, c_void};
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
use std::sync::Arc;

type LogFn = dyn FnMut(i32, &str) + Send;
type ExecutorFn = dyn Fn(usize, &(dyn Fn(usize) + Sync)) + Send + Sync;

/// Services of the host.
#[derive(Default)]
pub struct ContextDesc {
    /// Number of threads; 0: one per processor. Default 1.
    pub concurrency: Option<i32>,
    /// An `MPM_ISA_...`; default `MPM_ISA_BEST`.
    pub isa: i32,
    /// Whether all functions of the host are called from the calling thread only.
    pub serial_callbacks: bool,
    log: Option<Box<LogFn>>,
    executor: Option<Box<ExecutorFn>>,
}

impl ContextDesc {
    /// The defaults.
    pub fn new() -> Self {
        Self::default()
    }
    /// Sets the number of threads.
    pub fn concurrency(mut self, threads: i32) -> Self {
        self.concurrency = Some(threads);
        self
    }
    /// Sets the instruction set.
    pub fn isa(mut self, isa: i32) -> Self {
        self.isa = isa;
        self
    }
    /// Keeps functions of the host on the calling thread.
    pub fn serial_callbacks(mut self) -> Self {
        self.serial_callbacks = true;
        self
    }
    /// Takes texts, with a level `MPM_LOG_...`.
    pub fn log(mut self, log: impl FnMut(i32, &str) + Send + 'static) -> Self {
        self.log = Some(Box::new(log));
        self
    }
    /// Runs the library's tasks in the place of its own threads: `executor(count, task)` calls `task(k)` once for each
    /// `k < count`, on any threads, and returns when all are done. A task that runs twice panics; one that was left out
    /// makes the call fail with `MPM_E_CALLBACK`. `concurrency` says for how many threads the work is cut.
    pub fn executor(mut self, executor: impl Fn(usize, &(dyn Fn(usize) + Sync)) + Send + Sync + 'static) -> Self {
        self.executor = Some(Box::new(executor));
        self
    }
}

/// Memory, threads and log, which all other objects need. A clone is the same context.
#[derive(Clone)]
pub struct Context {
    pub(crate) core: Arc<Core>,
}

impl Context {
    /// A context on one thread.
    pub fn new() -> Result<Self> {
        Self::with(ContextDesc::new())
    }

    /// A context with services of the host.
    pub fn with(desc: ContextDesc) -> Result<Self> {
        let thrown = Arc::new(Thrown::default());
        let mut kept: Vec<Box<dyn Any + Send + Sync>> = Vec::new();
        let mut text = vec![0 as c_char; 1024];
        let mut raw = sys::mpm_context_desc {
            isa: desc.isa,
            serial_callbacks: desc.serial_callbacks.into(),
            error_text: text.as_mut_ptr(),
            error_bytes: text.len() as u64,
            ..Default::default()
        };
        raw.concurrency = desc.concurrency.unwrap_or(raw.concurrency);
        if let Some(function) = desc.log {
            let slot = OnCallingThread(Owned::<LogFn>::new(&thrown, function));
            raw.log = Some(on_log);
            raw.log_user = slot.0.user();
            kept.push(Box::new(slot));
        }
        if let Some(function) = desc.executor {
            let slot = Owned::<ExecutorFn>::new(&thrown, function);
            raw.parallel_for = Some(on_parallel_for);
            raw.parallel_user = slot.user();
            kept.push(Box::new(slot));
        }
        let mut handle = std::ptr::null_mut();
        // SAFETY: the descriptor is whole, and what it points to outlives the call, the slots the context.
        let status = unsafe { sys::mpm_context_create(&raw, &mut handle) };
        let raised = thrown.take(0);
        let context = Context { core: Core::new(handle, thrown, kept) };
        if let Some(Raised::Panic(payload)) = raised {
            drop(context);
            resume_unwind(payload);
        }
        if status != sys::MPM_OK {
            return Err(Error::new(status, text_of(text.as_ptr())));
        }
        Ok(context)
    }

    /// Bytes that the context and its objects hold now, and the most that they ever held. May be called in callbacks.
    pub fn memory(&self) -> (i64, i64) {
        let (mut bytes, mut peak) = (0, 0);
        // SAFETY: free to be called at any time while the context lives.
        unsafe { sys::mpm_context_memory(self.core.handle, &mut bytes, &mut peak) };
        (bytes, peak)
    }

    /// The handle of C.
    pub fn as_ptr(&self) -> *mut sys::mpm_context {
        self.core.handle
    }
}

pub(crate) struct OnCallingThread(Owned<LogFn>);
// SAFETY: the function runs during calls only, of which there is one at a time.
unsafe impl Sync for OnCallingThread {}

unsafe extern "C" fn on_log(user: *mut c_void, level: i32, text: *const c_char) {
    let slot = alone::<LogFn>(user);
    let function = &mut slot.function;
    slot.thrown.guard(|| {
        function(level, &text_of(text));
        Ok(())
    });
}

unsafe extern "C" fn on_parallel_for(user: *mut c_void, count: i64, task: sys::mpm_task_fn, data: *mut c_void) -> i32 {
    let slot = shared::<ExecutorFn>(user);
    slot.thrown.guard(|| {
        let task = task.expect("the library gives a task");
        let begun: Vec<AtomicBool> = (0..count).map(|_| AtomicBool::new(false)).collect();
        let ended: Vec<AtomicBool> = (0..count).map(|_| AtomicBool::new(false)).collect();
        let data = data as usize;
        let run = |k: usize| {
            assert!(!begun[k].swap(true, SeqCst), "the executor ran task {k} twice");
            // k is in range and runs once, and tasks may run on any thread
            task(data as *mut c_void, k as i64);
            ended[k].store(true, SeqCst);
        };
        (slot.function)(count as usize, &run);
        match ended.iter().position(|done| !done.load(SeqCst)) {
            Some(k) => Err(Refusal::stop(format!("the executor left out task {k}"))),
            None => Ok(()),
        }
    })
}
