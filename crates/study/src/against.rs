//! Single runs held against a scene's reference, for programs that try settings of their own.

use crate::axes::Axes;
use crate::reference::{self, Reference};
use crate::simulate::simulate;
use crate::{Errors, Failure, Sampling, Setting, Source, Warned};
use std::sync::atomic::AtomicBool;
use teeter_scenario::resolve::Resolved;

/// A scene with its reference.
#[derive(Debug)]
pub struct Against<'a> {
    source: &'a Source,
    sampling: Sampling,
    /// What errors are against.
    pub reference: Reference,
}

impl<'a> Against<'a> {
    /// Finds the reference of a scene as [`crate::Tradeoff::of`] does.
    ///
    /// # Errors
    /// If no scheme comes to the end of the scene, or `cancel` is set.
    pub fn new(source: &'a Source, resolved: &Resolved, threads: usize, cancel: &AtomicBool) -> Result<Self, Failure> {
        let sampling = Sampling::of(&resolved.scene);
        let axes = Axes::of(resolved);
        let reference = reference::find(source, resolved, &axes, sampling, threads, cancel, &mut |_, _| {})?;
        Ok(Self { source, sampling, reference })
    }

    /// Runs a setting to its end: its errors before the horizon, and what `check` and `run` warn
    /// of.
    ///
    /// # Errors
    /// If the scene can't be run with it, or the run ends before its time.
    pub fn errors(&self, setting: &Setting, cancel: &AtomicBool) -> Result<(Errors, Vec<Warned>), Failure> {
        let ran = simulate(self.source, setting, 0.0, self.sampling, cancel)?;
        Ok((self.reference.ruler.errors(&ran.motion, &self.reference.motion), ran.warned))
    }

    /// Until when errors are taken, s.
    #[must_use]
    pub fn horizon(&self) -> f64 {
        self.reference.ruler.horizon()
    }
}
