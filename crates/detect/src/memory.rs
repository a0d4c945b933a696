//! What a detector keeps from one configuration to the next.

use std::any::Any;

/// What a detector keeps from one configuration to the next, such as the order of bodies along an
/// axis. The detector decides what is in it. It is a hint only: whatever decides a result belongs
/// in the state of a run.
///
/// ```
/// let mut memory = teeter_detect::DetectorMemory::default();
/// memory.of(Vec::<u32>::new).push(3);
/// assert_eq!(*memory.of(Vec::<u32>::new), [3]);
/// ```
#[derive(Default)]
pub struct DetectorMemory(Option<Box<dyn Any + Send + Sync>>);

impl DetectorMemory {
    /// What is kept, if it is of this type; otherwise what `fresh` returns, which replaces it.
    pub fn of<T: Any + Send + Sync>(&mut self, fresh: impl FnOnce() -> T) -> &mut T {
        if !self.0.as_ref().is_some_and(|kept| kept.is::<T>()) {
            self.0 = None;
        }
        let kept = self.0.get_or_insert_with(|| Box::new(fresh()));
        match kept.downcast_mut() {
            Some(kept) => kept,
            None => unreachable!("it was made of this type"),
        }
    }
}

impl std::fmt::Debug for DetectorMemory {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("DetectorMemory").field("kept", &self.0.is_some()).finish()
    }
}
