//! Resolves the ground: a line with a slope, or a profile.

use super::Resolver;
use crate::number_table;
use crate::placement::carried_by;
use crate::scene::{BeamScene, BlockScene, ContactScene, GroundScene, SignalScene, SupportingBody};
use crate::words::LengthUnit;
use nalgebra::Vector2;
use std::sync::Arc;
use teeter_detect::{Profile, ShapeError};

/// Most points of a profile: each block that touches it has a place in the report for a contact at
/// each of them.
const MOST_POINTS: usize = 5_000;

impl Resolver<'_, '_> {
    /// The ground, if there is any; `None` on error.
    pub(super) fn ground(&mut self, signals: &[Option<SignalScene>]) -> Option<Option<GroundScene>> {
        if !self.doc.has_table("ground") {
            return Some(None);
        }
        let (incline, motion) = (self.quantity("ground.incline"), self.motion("ground", signals));
        let profile = if self.doc.has_table("ground.profile") { Some(self.ground_profile()?) } else { None };
        // A written scene has all defaults, that of incline too.
        if profile.is_some() && self.doc.is_given("ground.incline") && incline != Some(0.0) {
            let remedy = "leave out incline, and let the points of the profile rise instead";
            self.error("ground.incline", "the profile already gives the slope of the ground", remedy);
            return None;
        }
        Some(Some(GroundScene { incline: incline?, profile: profile.map(Arc::new), motion: motion? }))
    }

    fn ground_profile(&mut self) -> Option<Profile> {
        let doc = self.doc;
        let at = |key: &str| format!("ground.profile.{key}");
        let given = |key: &str| doc.has(&at(key)) || doc.is_refused(&at(key));
        match (given("points"), given("file")) {
            (true, true) => {
                self.error(&at("file"), "points already gives the profile", "keep points or file");
                return None;
            }
            (false, false) => {
                let remedy = "add points = [[\"0 m\", \"0 m\"], [\"1 m\", \"0.1 m\"]], or file = \"ground.csv\"";
                self.error("ground.profile", "the profile is missing", remedy);
                return None;
            }
            (true, false) => {
                if let Some(key) = ["columns", "unit"].into_iter().find(|key| given(key)) {
                    self.error(&at(key), "it applies only with file", "leave it out");
                    return None;
                }
                let points = doc.points(&at("points"))?.iter().map(|point| Vector2::from(*point)).collect();
                return self.checked(&at("points"), points, &[]);
            }
            (false, true) => {}
        }
        let file = self.word(&at("file"))?;
        let columns = doc.text_pair(&at("columns"));
        let bytes = match self.file(&file) {
            Ok(bytes) => bytes,
            Err(why) => {
                self.error(&at("file"), why, "paths are relative to the scene's file");
                return None;
            }
        };
        let unit = match given("unit") {
            true => {
                let unit: LengthUnit = self.choice(&at("unit"))?;
                doc.text(&at("unit")).map(|word| (word, unit.per_metre()))
            }
            false => None,
        };
        match number_table::points(&bytes, columns, unit) {
            Ok(number_table::NumberColumns { columns, lines }) => {
                let [x, y] = <[Vec<f64>; 2]>::try_from(columns).unwrap_or_default();
                let points = x.into_iter().zip(y).map(|(x, y)| Vector2::new(x, y)).collect();
                self.checked(&at("file"), points, &lines)
            }
            Err(why) => {
                let remedy = "give x and y in two columns, with one row for each point, from left to right";
                self.error(&at("file"), why, remedy);
                None
            }
        }
    }

    /// Refuses a static start of a beam under a block that also touches ground with a profile: the
    /// equilibrium is found among straight surfaces.
    pub(super) fn check_static_starts_beside_profile(
        &mut self,
        ground: &Option<Option<GroundScene>>,
        beams: &[Option<BeamScene>],
        blocks: &[Option<BlockScene>],
        contacts: &[Option<ContactScene>],
    ) {
        let has_profile = matches!(ground, Some(Some(ground)) if ground.profile.is_some());
        let is_static = |beam: &usize| matches!(beams.get(*beam), Some(Some(beam)) if beam.static_start);
        let placement = |block: usize| Some(&blocks.get(block)?.as_ref()?.placement);
        let on_ground = |block: usize| {
            contacts.iter().flatten().any(|of| of.block == block && of.surface == SupportingBody::Ground)
        };
        for (number, beam) in beams.iter().enumerate().filter(|(number, _)| has_profile && is_static(number)) {
            let Some(beam) = beam else { continue };
            if (0..blocks.len())
                .any(|block| on_ground(block) && carried_by(blocks.len(), block, placement) == Some(number))
            {
                let rule = "a block on this beam also touches the profile of the ground, where no equilibrium can be found yet";
                self.error(
                    &format!("beam.{}.start", beam.name),
                    rule,
                    "start undeformed, or leave out one of the contacts",
                );
            }
        }
    }

    /// The profile through points, which come from these lines of a file, if from one.
    fn checked(&mut self, path: &str, points: Vec<Vector2<f64>>, lines: &[u64]) -> Option<Profile> {
        if points.len() > MOST_POINTS {
            let rule = format!("{} points, more than {MOST_POINTS}, the limit of a profile", points.len());
            self.error(
                path,
                rule,
                "leave out points that lie on a line with their neighbours, or are too close to matter",
            );
            return None;
        }
        match Profile::new(points) {
            Ok(profile) => Some(profile),
            Err(error) => {
                let line = match &error {
                    ShapeError::NotRising { point } => lines.get(*point).map(|line| format!("line {line}: ")),
                    _ => None,
                };
                let rule = match error {
                    // Points are counted from 1 by users.
                    ShapeError::NotRising { point } => format!(
                        "{}point {} is not to the right of the one before it",
                        line.unwrap_or_default(),
                        point + 1
                    ),
                    error => error.to_string(),
                };
                let remedy = "give two points or more from left to right; a step needs a short slope";
                self.error(path, rule, remedy);
                None
            }
        }
    }
}

impl LengthUnit {
    fn per_metre(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 100.0,
            Self::Millimetre => 1000.0,
            Self::Kilometre => 0.001,
        }
    }
}
