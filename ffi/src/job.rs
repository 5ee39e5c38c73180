//! A computation on a thread of its own, that any thread polls, cancels and waits for.

use std::ffi::{CStr, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use wovenfit_core::Prepared as Limb;
use wovenfit_core::design::Design as Wishes;
use wovenfit_core::parameters::Parameters as Values;
use wovenfit_core::progress::{Progress as Watcher, Stage};

use crate::design::Design;
use crate::failure::{Error, Failure};
use crate::guard::{Out, borrow, borrow_if_any, free, guard};
use crate::mesh::Mesh;
use crate::parameters::Parameters;
use crate::pool::in_pool;
use crate::prepared::{Prepared, Ready, agree};
use crate::result::{Computed, FitResult};
use crate::status::Status;

/// A computation under way or ended. All its functions but wovenfit_job_free may be called from any
/// thread at any time.
pub struct Job {
    shared: Arc<Shared>,
    /// Until it was waited for at the end.
    thread: Option<JoinHandle<()>>,
}

/// Where a job is.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JobState {
    /// It runs.
    Running = 0,
    /// It has a result.
    Done = 1,
    /// It ended without; wovenfit_job_result says why.
    Failed = 2,
    /// It was cancelled.
    Cancelled = 3,
}

/// A stage of a job, in the order in which they come. Stages that are not needed are left out.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JobStage {
    /// It has not begun.
    Waiting = 0,
    /// Checking and repairing the surface.
    Surface = 1,
    /// Keeping the region that the brace covers.
    Region = 2,
    /// Cutting the region open into a disk.
    Cut = 3,
    /// The initial planar parameterization.
    Parameterization = 4,
    /// Curvature at the wanted pressures.
    Curvature = 5,
    /// Moving the fabric to its place.
    Fit = 6,
    /// Interpolating the surface-plane mapping (the method "diffusion" alone).
    Mapping = 7,
    /// Outline, seams, and the judgement of what was reached.
    Report = 8,
}

impl From<Stage> for JobStage {
    fn from(stage: Stage) -> Self {
        match stage {
            Stage::Surface => Self::Surface,
            Stage::Region => Self::Region,
            Stage::Cut => Self::Cut,
            Stage::Parameterization => Self::Parameterization,
            Stage::Curvature => Self::Curvature,
            Stage::Fit => Self::Fit,
            Stage::Mapping => Self::Mapping,
            Stage::Report => Self::Report,
        }
    }
}

/// How far a job is.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JobProgress {
    /// A wovenfit_job_state.
    pub state: i32,
    /// A wovenfit_job_stage.
    pub stage: i32,
    /// How much of the stage is done, from 0 to 1.
    pub fraction: f64,
    /// The fit's energy in N mm; NaN before the fit.
    pub energy: f64,
}

/// What the job's thread and its handle share.
struct Shared {
    cancel: AtomicBool,
    state: Mutex<State>,
    ended: Condvar,
}

struct State {
    progress: JobProgress,
    prepared: Option<Arc<Ready>>,
    /// Once it has ended.
    outcome: Option<Result<Arc<Computed>, Failure>>,
}

impl Shared {
    fn new(prepared: Option<Arc<Ready>>) -> Self {
        let progress = JobProgress {
            state: JobState::Running as i32,
            stage: JobStage::Waiting as i32,
            fraction: 0.0,
            energy: f64::NAN,
        };
        let state = State { progress, prepared, outcome: None };
        Self { cancel: AtomicBool::new(false), state: Mutex::new(state), ended: Condvar::new() }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn end(&self, outcome: Result<Arc<Computed>, Failure>) {
        let mut state = self.state();
        let ended = match &outcome {
            Ok(_) => JobState::Done,
            Err(failure) if failure.status == Status::Cancelled => JobState::Cancelled,
            Err(_) => JobState::Failed,
        };
        state.progress.state = ended as i32;
        state.outcome = Some(outcome);
        drop(state);
        self.ended.notify_all();
    }
}

impl Watcher for Shared {
    fn report(&self, stage: Stage, fraction: f64, energy: Option<f64>) {
        let progress = &mut self.state().progress;
        progress.stage = JobStage::from(stage) as i32;
        progress.fraction = fraction;
        progress.energy = energy.unwrap_or(progress.energy);
    }

    fn cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }
}

/// What a job is to do.
struct Task {
    /// The mesh, if it has to be prepared first.
    mesh: Option<Mesh>,
    earlier: Option<Arc<Computed>>,
    wishes: Wishes,
    values: Values,
}

impl Task {
    fn run(self, shared: &Shared) -> Result<Arc<Computed>, Failure> {
        let Self { mesh, earlier, wishes, values } = self;
        if let Some(Mesh(mesh)) = mesh {
            let limb = Limb::new(&mesh.raw, &wishes, &values, shared)?;
            shared.state().prepared = Some(Arc::new(Ready { limb, mesh }));
        }
        let ready = shared.state().prepared.clone();
        let ready = ready.ok_or_else(|| {
            Failure::new(Status::Internal, "a job without a limb: please report it")
        })?;
        let earlier = earlier.as_ref().map(|earlier| &earlier.flattening);
        let flattening = ready.limb.solve(&wishes, &values, earlier, shared)?;
        Ok(Arc::new(Computed::new(ready, flattening, wishes)))
    }

    fn start(self, prepared: Option<Arc<Ready>>) -> Result<Job, Failure> {
        /// As a program's main thread has.
        const STACK: usize = 8 << 20;
        let shared = Arc::new(Shared::new(prepared));
        let own = Arc::clone(&shared);
        let work = move || {
            let done = catch_unwind(AssertUnwindSafe(|| in_pool(|| self.run(&own))));
            own.end(match done {
                Ok(Ok(outcome)) => outcome,
                Ok(Err(failure)) => Err(failure),
                Err(panic) => Err(Failure::of_panic(&*panic)),
            });
        };
        let thread = thread::Builder::new()
            .name("wovenfit job".to_owned())
            .stack_size(STACK)
            .spawn(work)
            .map_err(|error| {
                let text = format!("the system gives no thread to work with: {error}");
                Failure::new(Status::Internal, text)
            })?;
        Ok(Job { shared, thread: Some(thread) })
    }
}

impl Drop for Job {
    fn drop(&mut self) {
        self.shared.cancel.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // Its panic was caught inside.
            drop(thread.join());
        }
    }
}

/// Starts the way from a mesh and a design to a pattern, on a thread of its own.
///
/// `parameters` may be NULL for the defaults. What cannot be seen at once ends the job later: poll
/// or wait, then ask wovenfit_job_result. The objects given may be changed and freed meanwhile.
///
/// Any thread, while nobody changes `design` and `parameters`. Free `job` with wovenfit_job_free.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_job_start(
    mesh: *const Mesh,
    design: *const Design,
    parameters: *const Parameters,
    job: *mut *mut Job,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let mesh = &borrow(mesh, "mesh")?.0;
            let design = borrow(design, "design")?;
            let out = Out::new(job, "job")?;
            let values = borrow_if_any(parameters).map(|p| p.0.clone()).unwrap_or_default();
            agree(&values, mesh)?;
            let wishes = design.wishes_for(mesh)?;
            let task = Task { mesh: Some(Mesh(Arc::clone(mesh))), earlier: None, wishes, values };
            out.give(task.start(None)?)
        })
    }
}

/// Starts a job on a limb that was prepared by an earlier one, after a changed pressure, fabric or
/// orientation: a part of the time.
///
/// `earlier` may be NULL, or a result on this prepared limb: the fit then starts from it. A design or
/// parameters that need another preparation (region, seams, facing, unit, or a parameter of the
/// stages before the fit) end the job with WOVENFIT_STATUS_PREPARED_FOR_ANOTHER. `parameters` may be
/// NULL for the defaults.
///
/// Any thread, while nobody changes `design` and `parameters`. Free `job` with wovenfit_job_free.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_job_start_prepared(
    prepared: *const Prepared,
    earlier: *const FitResult,
    design: *const Design,
    parameters: *const Parameters,
    job: *mut *mut Job,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let ready = Arc::clone(&borrow(prepared, "prepared")?.0);
            let design = borrow(design, "design")?;
            let out = Out::new(job, "job")?;
            let values = borrow_if_any(parameters).map(|p| p.0.clone()).unwrap_or_default();
            agree(&values, &ready.mesh)?;
            let earlier = borrow_if_any(earlier).map(|earlier| Arc::clone(&earlier.0));
            if earlier.as_ref().is_some_and(|earlier| !Arc::ptr_eq(&earlier.ready, &ready)) {
                return Err(Failure::invalid(
                    "`earlier` is the result of another prepared limb: give one of this, or NULL",
                ));
            }
            let wishes = design.wishes_for(&ready.mesh)?;
            let task = Task { mesh: None, earlier, wishes, values };
            out.give(task.start(Some(ready))?)
        })
    }
}

/// How far a job is. Never waits for the work.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_job_poll(
    job: *const Job,
    progress: *mut JobProgress,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let now = borrow(job, "job")?.shared.state().progress;
            Out::new(progress, "progress")?.put(now)
        })
    }
}

/// Asks a job to stop; it ends soon after with WOVENFIT_STATUS_CANCELLED, unless it had ended already.
/// Does not wait.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_job_cancel(job: *const Job, error: *mut *mut Error) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            borrow(job, "job")?.shared.cancel.store(true, Ordering::Relaxed);
            Ok(())
        })
    }
}

/// Waits until a job has ended, however it did: WOVENFIT_STATUS_OK, or WOVENFIT_STATUS_TIMEOUT if it
/// still runs after `seconds`. Negative seconds wait without end.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_job_wait(
    job: *const Job,
    seconds: f64,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let shared = &borrow(job, "job")?.shared;
            if seconds.is_nan() {
                return Err(Failure::invalid("`seconds` is NaN: give a number, negative for ever"));
            }
            // More than the clock can count is for ever, too.
            let patience = Duration::try_from_secs_f64(seconds).ok();
            let until = patience.and_then(|patience| Instant::now().checked_add(patience));
            let mut state = shared.state();
            while state.outcome.is_none() {
                let Some(until) = until else {
                    state = shared.ended.wait(state).unwrap_or_else(PoisonError::into_inner);
                    continue;
                };
                let left = until.saturating_duration_since(Instant::now());
                if left.is_zero() {
                    let text = format!("the job still runs after {seconds} s");
                    return Err(Failure::new(Status::Timeout, text));
                }
                let woken = shared.ended.wait_timeout(state, left);
                state = woken.unwrap_or_else(PoisonError::into_inner).0;
            }
            Ok(())
        })
    }
}

/// The result of a job, or why it has none: WOVENFIT_STATUS_NOT_READY while it runs, else its own
/// status and text. May be asked again; each object is freed on its own.
///
/// Any thread. Free `result` with wovenfit_result_free.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_job_result(
    job: *const Job,
    result: *mut *mut FitResult,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let job = borrow(job, "job")?;
            let out = Out::new(result, "result")?;
            let outcome = job.shared.state().outcome.clone();
            let running = || Failure::new(Status::NotReady, "the job still runs: wait for it");
            out.give(FitResult(outcome.ok_or_else(running)??))
        })
    }
}

/// The prepared limb of a job, to solve again on; WOVENFIT_STATUS_NOT_READY before it is there, also if
/// the job ended before. There even where the fit failed.
///
/// Any thread. Free `prepared` with wovenfit_prepared_free.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_job_prepared(
    job: *const Job,
    prepared: *mut *mut Prepared,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let job = borrow(job, "job")?;
            let out = Out::new(prepared, "prepared")?;
            let ready = job.shared.state().prepared.clone();
            let not_yet = || Failure::new(Status::NotReady, "the job has not prepared its limb");
            out.give(Prepared(ready.ok_or_else(not_yet)?))
        })
    }
}

/// Frees a job; NULL is fine. One that runs is cancelled, and the call waits until it has stopped.
/// Results and prepared limbs taken from it stay.
///
/// No other thread may be using the handle.
///
/// # Safety
/// `job` is NULL or a job that was not freed before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_job_free(job: *mut Job) {
    // SAFETY: the caller gives NULL or a living object and never uses it again.
    unsafe { free(job) }
}

/// A stage's short name, such as "surface"; "unknown" for other numbers. It is never freed.
///
/// Any thread.
#[unsafe(no_mangle)]
pub extern "C" fn wovenfit_stage_name(stage: i32) -> *const c_char {
    const NAMES: [&CStr; 9] = [
        c"waiting",
        c"surface",
        c"region",
        c"cut",
        c"parameterization",
        c"curvature",
        c"fit",
        c"mapping",
        c"report",
    ];
    let name = usize::try_from(stage).ok().and_then(|stage| NAMES.get(stage));
    name.copied().unwrap_or(c"unknown").as_ptr()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_have_the_cores_names() {
        for stage in [
            Stage::Surface,
            Stage::Region,
            Stage::Cut,
            Stage::Parameterization,
            Stage::Curvature,
            Stage::Fit,
            Stage::Mapping,
            Stage::Report,
        ] {
            // SAFETY: a static text with its NUL.
            let name = unsafe { CStr::from_ptr(wovenfit_stage_name(JobStage::from(stage) as i32)) };
            assert_eq!(name.to_str(), Ok(stage.name()));
        }
    }

    #[test]
    fn a_panic_in_a_job_ends_it_as_an_internal_error() {
        let shared = Shared::new(None);
        // A job without mesh and prepared limb is a fault of ours.
        let (wishes, values) = (Wishes::default(), Values::default());
        let task = Task { mesh: None, earlier: None, wishes, values };
        let outcome = task.run(&shared);
        assert_eq!(outcome.err().map(|failure| failure.status), Some(Status::Internal));
    }
}
