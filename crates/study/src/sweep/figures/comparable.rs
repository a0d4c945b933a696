//! Whether figures of several studies may be put side by side: under one label stands one quantity.

use super::super::criterion::Criterion;
use super::label::{label, quantity};
use super::{Ensemble, Wanted};
use crate::sweep::Sweep;
use teeter_scenario::keys::find;

/// Something that has to be the same in all studies.
struct Compared {
    /// What it is, for messages.
    what: String,
    /// Equal for quantities that may stand under one label, whatever block or motion they belong to.
    meaning: String,
    /// For messages.
    shown: String,
}

/// What of a figure has to be the same; `None` where a study doesn't ask for it.
type Figure = fn(&Ensemble) -> Option<Vec<Compared>>;

/// Why figures that all studies ask for can't be put side by side; `None` if they can.
#[must_use]
pub fn incomparable(studies: &[Ensemble]) -> Option<String> {
    let (first, others) = studies.split_first()?;
    let figures: [Figure; 3] = [fragility, distribution, bands];
    for compared in figures {
        let all: Option<Vec<_>> = others.iter().map(|study| Some((study, compared(study)?))).collect();
        let (Some(ours), Some(all)) = (compared(first), all) else { continue };
        for (study, theirs) in all {
            let differs = ours.iter().zip(&theirs).find(|(ours, theirs)| ours.meaning != theirs.meaning);
            if let Some((ours, theirs)) = differs {
                return Some(format!(
                    "{} is {} in `{}`, but {} in `{}`",
                    ours.what, ours.shown, first.name, theirs.shown, study.name
                ));
            }
        }
    }
    None
}

fn fragility(study: &Ensemble) -> Option<Vec<Compared>> {
    let asked = wanted(study).fragility.as_ref()?;
    let event = match &asked.event {
        Criterion::Overturned => asked.event.clause(),
        Criterion::Above { output, value } => format!("{} is above {value}", meaning(&study.sweep, output)),
    };
    let shown = match &asked.event {
        Criterion::Overturned => format!("that {}", asked.event.clause()),
        Criterion::Above { output, value } => format!("that {} is above {value}", label(&study.sweep, output)),
    };
    let count = asked.intensities.len();
    let mut all = vec![Compared { what: "the event of [fragility]".to_owned(), meaning: event, shown }];
    all.extend(asked.intensities.iter().map(|column| of_column("the intensity of [fragility]", study, column)));
    let number = Compared {
        what: "the number of intensities of [fragility]".to_owned(),
        meaning: count.to_string(),
        shown: count.to_string(),
    };
    all.insert(1, number);
    Some(all)
}

fn distribution(study: &Ensemble) -> Option<Vec<Compared>> {
    let asked = wanted(study).distribution.as_ref()?;
    let by = match &asked.by {
        Some(column) => of_column("`by` of [distribution]", study, column),
        None => Compared {
            what: "`by` of [distribution]".to_owned(),
            meaning: String::new(),
            shown: "not given".to_owned(),
        },
    };
    let at_most = asked.at_most.map_or_else(|| "not given".to_owned(), |most| most.to_string());
    let at_most = Compared { what: "`at_most` of [distribution]".to_owned(), meaning: at_most.clone(), shown: at_most };
    Some(vec![of_column("the quantity of [distribution]", study, &asked.of), by, at_most])
}

fn bands(study: &Ensemble) -> Option<Vec<Compared>> {
    let asked = wanted(study).bands.as_ref()?;
    let meaning = last(&asked.of).to_owned();
    Some(vec![Compared { what: "the quantity of [bands]".to_owned(), meaning, shown: quantity(&asked.of) }])
}

fn wanted(study: &Ensemble) -> &Wanted {
    study.sweep.wanted()
}

fn of_column(what: &str, study: &Ensemble, column: &str) -> Compared {
    let meaning = meaning(&study.sweep, column);
    let shown = match label(&study.sweep, column) {
        named if named == column => format!("`{column}` ({meaning})"),
        named => named,
    };
    Compared { what: what.to_owned(), meaning, shown }
}

/// What a column of the results is, without the block, beam or motion that it belongs to.
fn meaning(sweep: &Sweep, column: &str) -> String {
    let output = sweep.outputs().iter().find(|output| output.name() == column);
    match output {
        None if find(column).is_some() => last(column).to_owned(),
        None => column.to_owned(),
        Some(output) => match (output.summary_path(), output.period(), output.column()) {
            (Some(path), ..) => path.to_owned(),
            (_, Some(period), _) => format!("spectral acceleration at {period} s"),
            (.., Some(column)) => output.reduced(last(column), "a body").unwrap_or_default(),
            _ => "overturned".to_owned(),
        },
    }
}

/// The last part of a path: a key or a column without what it belongs to.
fn last(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::StudyTable;

    fn study(name: &str, more: &str) -> Ensemble {
        let text = format!(
            "scene = \"s.toml\"\n[grid]\nblock.a.tilt = [\"1 deg\", \"2 deg\"]\nblock.b.tilt = [\"1 deg\"]\n[outputs]\n\
             end = {{ final = \"a.phi\" }}\nlast = {{ final = \"b.phi\" }}\nmost = {{ max_abs = \"a.omega\" }}\n{more}"
        );
        let sweep = Sweep::read(&text, "f", &|_, _| Err("none".to_owned())).unwrap();
        let table = StudyTable::read(&b"case,status\n0,complete\n"[..], &sweep).unwrap();
        Ensemble { name: name.to_owned(), sweep, table }
    }

    #[test]
    fn one_label_stands_for_one_quantity() {
        let why = |one: &str, other: &str| incomparable(&[study("one", one), study("two", other)]);
        let bands = |of: &str| format!("[bands]\nof = \"{of}\"\nuntil = \"1 s\"\n");
        assert_eq!(why(&bands("a.phi"), &bands("b.phi")), None, "the same of another block");
        let told = why(&bands("a.phi"), &bands("a.omega")).unwrap();
        assert_eq!(told, "the quantity of [bands] is φ of a (rad) in `one`, but ω of a (rad/s) in `two`");
        let of = |of: &str| format!("[distribution]\nof = \"{of}\"\n");
        assert_eq!(why(&of("end"), &of("last")), None);
        let told = why(&of("end"), &of("most")).unwrap();
        assert_eq!(
            told,
            "the quantity of [distribution] is Final φ of a (rad) in `one`, but Largest |ω| of a (rad/s) in `two`"
        );
        assert_eq!(why(&of("end"), &bands("a.omega")), None, "no figure in common");
        let fragility = |event: &str, over: &str| format!("[fragility]\nevent = {event}\nintensity = \"{over}\"\n");
        let above = "{ output = \"end\", above = 0.1 }";
        let events = why(&fragility("\"overturned\"", "block.a.tilt"), &fragility(above, "block.a.tilt")).unwrap();
        assert_eq!(
            events,
            "the event of [fragility] is that a block overturns in `one`, but that Final φ of a (rad) is above 0.1 in `two`"
        );
        assert_eq!(why(&fragility(above, "block.a.tilt"), &fragility(above, "block.b.tilt")), None);
        assert!(why(&fragility(above, "block.a.tilt"), &fragility(above, "most")).is_some());
        let of = |of: &str, more: &str| format!("[distribution]\nof = \"{of}\"\n{more}");
        assert!(why(&of("end", "at_most = 1\n"), &of("end", "")).is_some());
    }
}
