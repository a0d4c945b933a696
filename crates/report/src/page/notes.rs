//! What is said of a plot, on the page and in its figure.

/// What a note is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum About {
    /// What its pale curves show: not said where these are left out.
    Pale,
    /// The plot.
    Plot,
}

/// Something that is to be known to read a plot: a clause without a full stop.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Note {
    pub(crate) about: About,
    pub(crate) text: String,
}

impl Note {
    pub(crate) fn of_plot(text: impl Into<String>) -> Self {
        Self { about: About::Plot, text: text.into() }
    }

    pub(crate) fn of_pale(text: impl Into<String>) -> Self {
        Self { about: About::Pale, text: text.into() }
    }
}

/// Notes as one; none without any.
pub(crate) fn joined<'a>(notes: impl IntoIterator<Item = &'a Note>) -> Option<String> {
    let texts: Vec<&str> = notes.into_iter().map(|note| note.text.as_str()).collect();
    (!texts.is_empty()).then(|| texts.join("; "))
}
