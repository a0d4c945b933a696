//! Panels with what is said of them.

use crate::page::notes::{Note, joined};
use teeter_plot::Panel;

/// A panel of a figure, and what is said of it.
pub(super) type Noted = (Panel, Vec<Note>);

/// What notes of panels say at length stands once below a figure, where more than one says such: of which panels, unless it is of most of them. A short
/// one that all have, as the name of the only pair, stays at the first.
pub(super) fn noted_once(panels: Vec<Noted>) -> (Vec<Panel>, Option<String>) {
    let is_long = |note: &&Note| note.text.chars().count() > SHORT;
    let noted: Vec<usize> = (0..panels.len()).filter(|k| panels[*k].1.iter().any(|note| is_long(&note))).collect();
    if noted.len() < 2 {
        return (panels.into_iter().map(|(panel, notes)| panel.note(joined(&notes))).collect(), None);
    }
    // What is said, of which panels.
    let mut said: Vec<(&Note, Vec<usize>)> = Vec::new();
    for k in &noted {
        for note in panels[*k].1.iter().filter(is_long) {
            match said.iter_mut().find(|(known, _)| *known == note) {
                Some((_, of)) => of.push(*k),
                None => said.push((note, vec![*k])),
            }
        }
    }
    let mut sentences: Vec<(Vec<usize>, Vec<&Note>)> = Vec::new();
    for (note, of) in said {
        let of = if 2 * of.len() > noted.len() { Vec::new() } else { of };
        match sentences.iter_mut().find(|(known, _)| *known == of) {
            Some((_, notes)) => notes.push(note),
            None => sentences.push((of, vec![note])),
        }
    }
    // What holds of most comes first.
    sentences.sort_by_key(|(of, _)| of.first().map_or(0, |first| first + 1));
    let sentence = |(of, notes): (Vec<usize>, Vec<&Note>)| {
        let text = joined(notes).unwrap_or_default();
        let mut names: Vec<&str> = of.iter().map(|k| panels[*k].0.quantity()).collect();
        names.dedup();
        if names.is_empty() { capitalised(&text) } else { format!("{} – {text}", names.join(", ")) }
    };
    let note = sentences.into_iter().map(sentence).collect::<Vec<_>>().join(". ");
    let plots = panels.iter().filter(|(panel, _)| !panel.quantity().is_empty()).count();
    let of_all = |note: &Note| plots > 1 && panels.iter().filter(|(_, notes)| notes.contains(note)).count() == plots;
    let short = panels
        .iter()
        .enumerate()
        .map(|(k, (_, notes))| joined(notes.iter().filter(|note| !is_long(note) && (k == 0 || !of_all(note)))));
    let short: Vec<Option<String>> = short.collect();
    (panels.into_iter().zip(short).map(|((panel, _), note)| panel.note(note)).collect(), Some(note))
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A part of a note of up to so many characters stays above its panel.
const SHORT: usize = 46;

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_plot::Axis;

    #[test]
    fn what_several_panels_say_at_length_stands_once_below_the_figure() {
        let panel = |quantity: &str, notes: &[&str]| {
            let panel = Panel::new(Axis::between(format!("{quantity} (N)"), 0.0, 1.0));
            (panel, notes.iter().copied().map(Note::of_plot).collect::<Vec<_>>())
        };
        let of_most = "strong: without vibrations of periods below 20 ms, not across impacts";
        let own = "strong: through the largest of every 20 ms, not across impacts";
        let panels = vec![
            panel("Moment", &["book on shelf", of_most]),
            panel("Stress", &["book on shelf", own]),
            panel("Reactions", &["book on shelf", of_most, "peaks cut, up to 3 N"]),
        ];
        let (panels, note) = noted_once(panels);
        let notes: Vec<Option<&str>> = panels.iter().map(Panel::own_note).collect();
        assert_eq!(notes, [Some("book on shelf"), None, Some("peaks cut, up to 3 N")]);
        let capital = capitalised(of_most);
        assert_eq!(note.unwrap(), format!("{capital}. Stress \u{2013} {own}"));
        // A single panel keeps its own.
        let alone = vec![panel("Moment", &[of_most]), panel("Stress", &[])];
        let (panels, note) = noted_once(alone);
        assert_eq!((panels[0].own_note(), note), (Some(of_most), None));
    }
}
