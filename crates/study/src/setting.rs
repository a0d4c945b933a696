//! A setting: changes to a scene, as `--set` arguments.

use std::collections::BTreeMap;
use std::fmt;

/// Keys of a scene with their values, as texts for `--set`. Settings with the same pairs are equal.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Setting(BTreeMap<String, String>);

impl Setting {
    /// The unchanged scene.
    #[must_use]
    pub fn none() -> Self {
        Self::default()
    }

    /// The same with one more key; an existing value is replaced.
    #[must_use]
    pub fn set(mut self, key: impl Into<String>, value: impl Into<String>) -> Self {
        self.0.insert(key.into(), value.into());
        self
    }

    /// The same with all of `other`, whose values take precedence.
    #[must_use]
    pub fn with(mut self, other: &Self) -> Self {
        self.0.extend(other.0.iter().map(|(key, value)| (key.clone(), value.clone())));
        self
    }

    /// The same without these keys.
    #[must_use]
    pub fn without(mut self, keys: &[String]) -> Self {
        self.0.retain(|key, _| !keys.contains(key));
        self
    }

    /// The value of a key; `None` if the scene's own applies.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<&str> {
        self.0.get(key).map(String::as_str)
    }

    /// Whether nothing is changed.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.0.is_empty()
    }

    /// Number of changed keys.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// The same as [`Setting::is_none`].
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.is_none()
    }

    /// The pairs, for the loader.
    #[must_use]
    pub fn pairs(&self) -> Vec<(String, String)> {
        self.0.iter().map(|(key, value)| (key.clone(), value.clone())).collect()
    }
}

/// As arguments for a shell: `--set time.step="50 us"`; nothing for the unchanged scene.
impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        arguments(self.0.iter().map(|(key, value)| (key.as_str(), value.as_str())), f)
    }
}

/// Pairs as `--set` arguments, quoted for a shell.
fn arguments<'a>(pairs: impl Iterator<Item = (&'a str, &'a str)>, f: &mut dyn fmt::Write) -> fmt::Result {
    for (number, (key, value)) in pairs.enumerate() {
        let gap = if number == 0 { "" } else { " " };
        let plain = |c: char| c.is_ascii_alphanumeric() || "._-+".contains(c);
        if !value.is_empty() && value.chars().all(plain) {
            write!(f, "{gap}--set {key}={value}")?;
        } else if value.contains(['"', '$', '`', '\\', '!']) {
            write!(f, "{gap}--set {key}='{}'", value.replace('\'', "'\\''"))?;
        } else {
            write!(f, "{gap}--set {key}=\"{value}\"")?;
        }
    }
    Ok(())
}

/// A word as it must be typed in a shell.
pub(crate) fn as_word(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/._-+,:@%=".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

/// The user's own settings, in their order, as arguments.
pub(crate) fn as_arguments(pairs: &[(String, String)]) -> String {
    let mut text = String::new();
    // Writing to a String can't fail.
    let _ = arguments(pairs.iter().map(|(key, value)| (key.as_str(), value.as_str())), &mut text);
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_quoted_where_a_shell_needs_it() {
        let setting = Setting::none().set("time.step", "50 us").set("solver.method", "pgs");
        assert_eq!(setting.to_string(), "--set solver.method=pgs --set time.step=\"50 us\"");
        assert_eq!(Setting::none().set("a", "\"x\"").to_string(), "--set a='\"x\"'");
        assert_eq!(Setting::none().to_string(), "");
    }

    #[test]
    fn paths_are_words_of_a_shell() {
        assert_eq!(as_word("scenes/a-1.toml"), "scenes/a-1.toml");
        assert_eq!(as_word("my scenes/it's.toml"), "'my scenes/it'\\''s.toml'");
        assert_eq!(as_word("a$b"), "'a$b'");
    }

    #[test]
    fn the_order_in_which_keys_were_set_does_not_matter() {
        let ab = Setting::none().set("a", "1").set("b", "2");
        assert_eq!(ab, Setting::none().set("b", "2").with(&Setting::none().set("a", "1")));
        assert_eq!(ab.clone().without(&["b".to_owned()]), Setting::none().set("a", "1"));
        assert_eq!((ab.get("b"), ab.len(), ab.is_none()), (Some("2"), 2, false));
    }
}
