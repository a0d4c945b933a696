//! Comparison of single runs with a scene's reference, for programs that try their own settings.

use crate::axes::Axes;
use crate::reference::{self, Reference};
use crate::simulate::simulate;
use crate::{Errors, Failure, Sampling, Setting, SettingWarning, StudyScene};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use teeter_scenario::resolve::Resolved;

/// A scene with its reference.
#[derive(Debug)]
pub struct ReferenceComparison<'a> {
    source: &'a StudyScene,
    sampling: Sampling,
    /// The reference for errors.
    pub reference: Reference,
}

impl<'a> ReferenceComparison<'a> {
    /// Finds the reference of a scene as [`crate::Tradeoff::of`] does.
    ///
    /// # Errors
    /// If no scheme comes to the end of the scene, or `cancel` is set.
    pub fn new(
        source: &'a StudyScene,
        resolved: &Resolved,
        threads: usize,
        cancel: &Arc<AtomicBool>,
    ) -> Result<Self, Failure> {
        let sampling = Sampling::of(&resolved.scene);
        let axes = Axes::of(resolved);
        let reference = reference::find(source, resolved, &axes, sampling, threads, cancel, &mut |_, _| {})?;
        Ok(Self { source, sampling, reference })
    }

    /// Runs a setting to its end: returns its errors before the horizon, and the warnings of
    /// `check` and `run`.
    ///
    /// # Errors
    /// If the scene can't be run with it, or the run ends before its time.
    pub fn errors(
        &self,
        setting: &Setting,
        cancel: &Arc<AtomicBool>,
    ) -> Result<(Errors, Vec<SettingWarning>), Failure> {
        let ran = simulate(self.source, setting, 0.0, self.sampling, cancel)?;
        Ok((self.reference.norms.errors(&ran.motion, &self.reference.motion), ran.warned))
    }

    /// The end of the comparison, s.
    #[must_use]
    pub fn horizon(&self) -> f64 {
        self.reference.norms.horizon()
    }
}
