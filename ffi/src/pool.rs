//! Worker threads that end with the work: nothing stays behind in the host's process.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::thread;

use rayon::ThreadPoolBuilder;

use crate::failure::Failure;
use crate::status::Status;

/// Runs `work` with worker threads of its own, as many as the machine has cores, and waits until
/// they have ended.
pub(crate) fn in_pool<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
    let mut threads = Vec::new();
    let built = ThreadPoolBuilder::new()
        .spawn_handler(|worker| {
            let name = format!("wovenfit {}", worker.index());
            threads.push(thread::Builder::new().name(name).spawn(|| worker.run())?);
            Ok(())
        })
        .build();
    let done = built.map(|pool| catch_unwind(AssertUnwindSafe(|| pool.install(work))));
    for thread in threads {
        // A panic of the work comes back by `install`; a worker has none of its own.
        drop(thread.join());
    }
    match done {
        Ok(Ok(value)) => Ok(value),
        Ok(Err(panic)) => resume_unwind(panic),
        Err(error) => {
            let text = format!("the system gives no threads to work with: {error}");
            Err(Failure::new(Status::Internal, text))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_is_done_in_the_pool_and_its_panic_comes_back() {
        assert_eq!(in_pool(rayon::current_thread_index).map(|index| index.is_some()), Ok(true));
        assert!(rayon::current_thread_index().is_none());
        let panic = catch_unwind(|| in_pool(|| panic!("inside"))).unwrap_err();
        assert_eq!(panic.downcast_ref::<&str>(), Some(&"inside"));
    }
}
