//! Words of scenes that make a choice: each list is defined once, here, and used by both the table
//! of keys and the decoding. A new word is a new variant, which every match on it must handle.

use crate::scene::SchemeName;
use teeter_integrator::{
    EventDriven, GeneralizedAlpha, MoreauJean, MoreauJeanClosed, MoreauJeanLocated, MoreauJeanProjected, Resolved,
};

/// One of some words.
pub(crate) trait Word: Copy + Sized + 'static {
    /// All of them, in the order of the table of keys.
    const ALL: &'static [(&'static str, Self)];

    /// The choice of a word; `None` for other words.
    fn of(word: &str) -> Option<Self> {
        Self::ALL.iter().find(|(name, _)| *name == word).map(|(_, meant)| *meant)
    }
}

macro_rules! words {
    ($($(#[$doc:meta])* $name:ident { $($variant:ident = $word:literal),* $(,)? })*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum $name { $($variant),* }

        impl $name {
            pub(crate) const WORDS: &'static [&'static str] = &[$($word),*];
        }

        impl Word for $name {
            const ALL: &'static [(&'static str, Self)] = &[$(($word, Self::$variant)),*];
        }
    )*};
}

words! {
    /// What ends a run before its time.
    StopWord { Overturned = "overturned", Rest = "rest", Sunk = "sunk" }
    /// Law along the normal of a contact.
    Law {
        Newton = "newton",
        Poisson = "poisson",
        Energetic = "energetic",
        KelvinVoigt = "kelvin-voigt",
        HuntCrossley = "hunt-crossley",
    }
    /// Whether contact frames follow the deformed beam.
    ContactFrames { Deformed = "deformed", Linear = "linear" }
    /// Where contacts of a beam are.
    ContactSurface { Axis = "axis", Top = "top" }
    /// From which side a block touches a beam.
    Face { Upper = "upper", Lower = "lower" }
    /// What of a block can touch a beam.
    TouchingPoints { All = "all", Corners = "corners" }
    /// Axial model of a beam.
    AxialModel { Free = "free", Held = "held", Elastic = "elastic" }
    /// How W of a beam is applied.
    Backend { Auto = "auto", Banded = "banded", Sparse = "sparse", CachedColumns = "cached-columns" }
    /// A beam's theory.
    Theory { EulerBernoulli = "euler-bernoulli", Timoshenko = "timoshenko" }
    /// Kind of a block's shape.
    ShapeKind { Regular = "regular", Trapezoid = "trapezoid", Voussoir = "voussoir", Stadium = "stadium" }
    /// Shape of a section.
    Shape {
        Rectangle = "rectangle",
        Circle = "circle",
        Tube = "tube",
        ISection = "i-section",
        Direct = "direct",
    }
    /// Baseline of a record that is subtracted.
    Baseline {
        None = "none",
        Mean = "mean",
        Linear = "linear",
        Quadratic = "quadratic",
        Cubic = "cubic",
        Quartic = "quartic",
        Quintic = "quintic",
    }
    /// Unit of the accelerations of a record.
    RecordUnit {
        MetrePerSecondSquared = "m/s^2",
        CentimetrePerSecondSquared = "cm/s^2",
        MillimetrePerSecondSquared = "mm/s^2",
        Gal = "gal",
        StandardGravity = "gn",
        G = "g",
    }
    /// Unit of the points of a profile.
    LengthUnit { Metre = "m", Centimetre = "cm", Millimetre = "mm", Kilometre = "km" }
    /// Shape of a signal.
    History {
        Constant = "constant",
        Ramp = "ramp",
        Harmonic = "harmonic",
        OneSine = "one-sine",
        HalfSine = "half-sine",
        Ricker = "ricker",
        Chirp = "chirp",
        Table = "table",
        Sum = "sum",
        Product = "product",
    }
    /// Unit of the times of a table.
    TimeUnit { Second = "s", Millisecond = "ms", Microsecond = "us", Minute = "min" }
    /// The values of a table before its first row and after its last.
    Outside { Hold = "hold", Zero = "zero" }
    /// How the frequency of a chirp grows.
    Growth { Linear = "linear", Logarithmic = "logarithmic" }
}

/// The words of the schemes.
pub(crate) const SCHEMES: &[&str] = &[
    "auto",
    MoreauJean::<2>::NAME,
    MoreauJeanClosed::<2>::NAME,
    MoreauJeanLocated::<2>::NAME,
    EventDriven::NAME,
    Resolved::<2>::NAME,
    MoreauJeanProjected::<2>::NAME,
    GeneralizedAlpha::<2>::NAME,
];

/// A scheme by name, or the automatic choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SchemeChoice {
    Auto,
    Named(SchemeName),
}

impl Word for SchemeChoice {
    const ALL: &'static [(&'static str, Self)] = &[
        (SCHEMES[0], Self::Auto),
        (SCHEMES[1], Self::Named(SchemeName::MoreauJean)),
        (SCHEMES[2], Self::Named(SchemeName::MoreauJeanClosed)),
        (SCHEMES[3], Self::Named(SchemeName::MoreauJeanLocated)),
        (SCHEMES[4], Self::Named(SchemeName::EventDriven)),
        (SCHEMES[5], Self::Named(SchemeName::Resolved)),
        (SCHEMES[6], Self::Named(SchemeName::MoreauJeanProjected)),
        (SCHEMES[7], Self::Named(SchemeName::GeneralizedAlpha)),
    ];
}

#[cfg(test)]
mod tests {
    use super::*;

    fn each_means_something_of_its_own<W: Word + PartialEq>() {
        for (k, (word, meant)) in W::ALL.iter().enumerate() {
            assert!(W::of(word) == Some(*meant) && W::ALL[..k].iter().all(|(_, other)| other != meant), "{word}");
        }
        assert!(["", "other", "moreau", "newton "].iter().all(|word| W::of(word).is_none()));
    }

    #[test]
    fn no_word_is_taken_for_another() {
        each_means_something_of_its_own::<SchemeChoice>();
        each_means_something_of_its_own::<Law>();
        each_means_something_of_its_own::<ContactFrames>();
        each_means_something_of_its_own::<ContactSurface>();
        each_means_something_of_its_own::<Face>();
        each_means_something_of_its_own::<TouchingPoints>();
        each_means_something_of_its_own::<AxialModel>();
        each_means_something_of_its_own::<Backend>();
        each_means_something_of_its_own::<Theory>();
        each_means_something_of_its_own::<Shape>();
        each_means_something_of_its_own::<History>();
        each_means_something_of_its_own::<Growth>();
        each_means_something_of_its_own::<TimeUnit>();
        each_means_something_of_its_own::<Outside>();
        each_means_something_of_its_own::<Baseline>();
        each_means_something_of_its_own::<RecordUnit>();
        each_means_something_of_its_own::<LengthUnit>();
    }
}
