//! Refusals and panics as texts, and worker threads that end with the work.

use std::any::Any;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

use rayon::ThreadPoolBuilder;

/// Why a call failed: a text for people that says what, where and what to do. It becomes the text of
/// the C++ exception.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure(pub String);

impl Failure {
    pub(crate) fn new(text: impl fmt::Display) -> Self {
        Self(text.to_string())
    }

    fn of_panic(panic: &(dyn Any + Send)) -> Self {
        let said = panic
            .downcast_ref::<&str>()
            .copied()
            .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
            .unwrap_or("without a text");
        Self(format!(
            "a fault of WovenFit, please report it with the mesh and the settings: {said}"
        ))
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Runs a call's body; its panic becomes a failure.
pub(crate) fn guarded<T>(body: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|panic| Err(Failure::of_panic(&*panic)))
}

/// The same with worker threads of its own, as many as the machine has cores, that end before it does:
/// nothing stays behind in the host.
pub(crate) fn guarded_in_pool<T: Send>(
    body: impl FnOnce() -> Result<T, Failure> + Send,
) -> Result<T, Failure> {
    guarded(|| {
        ThreadPoolBuilder::new()
            .build_scoped(|thread| thread.run(), |pool| pool.install(body))
            .unwrap_or_else(|error| {
                Err(Failure(format!("the system gives no threads to work with: {error}")))
            })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_failure_with_its_text_in_the_pool_too() {
        for failed in [
            guarded::<()>(|| panic!("the answer is {}", 42)),
            guarded_in_pool::<()>(|| panic!("the answer is {}", 42)),
        ] {
            assert!(failed.unwrap_err().0.ends_with("settings: the answer is 42"));
        }
        assert_eq!(guarded(|| Ok(1)), Ok(1));
        let inside = guarded_in_pool(|| Ok(rayon::current_thread_index().is_some()));
        assert_eq!(inside, Ok(true));
        assert!(rayon::current_thread_index().is_none());
    }
}
