//! A row of the table: a base scene and the keys that it changes.

use crate::case::Result;
use teeter_integrator::{MoreauJean, MoreauJeanClosed, MoreauJeanLocated, schemes};
use teeter_scenario::resolve::Resolved;

/// A scene that rows start from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Base {
    /// The slender block on rigid ground.
    Ground,
    /// The same on the paper's beam.
    Beam,
    /// Two blocks on one beam.
    Two,
}

impl Base {
    /// Its word in names of rows; `validation/extremes/` has the file of that name.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Ground => "ground",
            Self::Beam => "beam",
            Self::Two => "two",
        }
    }

    pub(crate) fn text(self) -> &'static str {
        match self {
            Self::Ground => include_str!("../../extremes/ground.toml"),
            Self::Beam => include_str!("../../extremes/beam.toml"),
            Self::Two => include_str!("../../extremes/two.toml"),
        }
    }

    /// The contacts of the scene.
    pub(crate) fn contacts(self) -> &'static [&'static str] {
        match self {
            Self::Ground | Self::Beam => &["feet"],
            Self::Two => &["feet", "neighbours-feet"],
        }
    }
}

/// Which scheme a row is stepped by: its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Scheme(pub(crate) &'static str);

impl Scheme {
    /// `moreau-jean`.
    pub(crate) const OPEN: Self = Self(MoreauJean::<2>::NAME);
    /// `moreau-jean-closed`, whose contacts give no energy.
    pub(crate) const CLOSED: Self = Self(MoreauJeanClosed::<2>::NAME);

    /// All that the registry knows.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        schemes().iter().map(|entry| Self(entry.name))
    }

    /// The word for it in scenes.
    pub(crate) fn word(self) -> &'static str {
        self.0
    }

    /// The word for it in names of rows.
    pub(crate) fn short(self) -> &'static str {
        if self == Self::OPEN { "open" } else { self.0.trim_start_matches("moreau-jean-") }
    }

    /// Whether no step of it gains energy.
    pub(crate) fn keeps_energy(self) -> bool {
        self == Self::CLOSED || self.0 == MoreauJeanLocated::<2>::NAME
    }
}

/// Keys by path, with their values as in `--set`.
pub(crate) type Sets = Vec<(String, String)>;

/// One scene of the table.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// `family/value/base/scheme/restitution`: by this it is asked for, and its bounds are stored.
    pub(crate) name: String,
    pub(crate) base: Base,
    pub(crate) scheme: Scheme,
    pub(crate) sets: Sets,
    /// Whether it takes too long for a continuous build.
    pub(crate) long: bool,
}

impl Row {
    /// The row's scene, read as a user's file is.
    pub(crate) fn load(&self) -> std::result::Result<Resolved, teeter_scenario::diagnostic::Diagnostics> {
        let word = self.base.word();
        teeter_scenario::load(self.base.text().as_bytes(), &format!("{word}.toml"), word, &self.sets)
    }

    /// The scene as TOML that runs by itself, every default written out; where the scene itself is refused, the base's
    /// text below the command that asks for the rest.
    pub(crate) fn scene(&self) -> Result<String> {
        let head = format!("# {}\n# {}\n", self.name, self.command());
        Ok(match self.load() {
            Ok(resolved) => format!("{head}{}", resolved.document.to_toml()),
            Err(_) => format!("{head}{}", self.base.text()),
        })
    }

    /// The command that runs it.
    pub(crate) fn command(&self) -> String {
        let sets = self.sets.iter().map(|(key, value)| format!(" --set {key}='{value}'"));
        format!("teeter run validation/extremes/{}.toml{}", self.base.word(), sets.collect::<String>())
    }
}
