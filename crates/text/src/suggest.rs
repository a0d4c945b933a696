//! "Did you mean": the nearest valid word.

/// Longest word that is compared; longer ones are no typing errors.
const LONGEST: usize = 96;

/// The candidate nearest to `word`, if one is close: at most 1 + length/3 edits, ignoring case and
/// `_` against `-`.
#[must_use]
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if word.is_empty() || word.len() > LONGEST {
        return None;
    }
    let fold = |text: &str| text.to_lowercase().replace('_', "-");
    let folded = fold(word);
    let letters = folded.chars().count();
    candidates
        .into_iter()
        .filter(|candidate| *candidate != word && candidate.len() <= LONGEST)
        .map(|candidate| {
            let distance = strsim::damerau_levenshtein(&folded, &fold(candidate));
            (distance, candidate)
        })
        .filter(|(distance, _)| *distance < letters && *distance <= 1 + letters / 3)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn a_near_miss_is_found_and_a_far_one_is_not() {
        let words = ["thickness", "width", "span"];
        assert_eq!(nearest("thicknes", words), Some("thickness"));
        assert_eq!(nearest("Width", words), Some("width"));
        assert_eq!(nearest("gravity", words), None);
        assert_eq!(nearest("x", words), None);
        assert_eq!(nearest(&"x".repeat(1_000_000), words), None);
    }
}
