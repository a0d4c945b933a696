//! What beams bore: deflected shapes, stress, envelopes, reactions.

use super::rocking::decimals;
use crate::own_weight;
use crate::page::content::largest;
use crate::page::panels::{Units, after_impacts, length_unit, prefix};
use crate::page::recorder::PageRecorder;
use crate::page::span;
use crate::sections::ReactionRange;
use crate::summary::BorneSummary;
use crate::verdict::percent;
use crate::{Summary, shortest, with_digits};
use std::fmt::Write;
use teeter_plot::escaped;

/// The deflected shapes at chosen times.
pub(super) fn shapes(recorder: &PageRecorder, units: &Units) -> String {
    let figure = span::shapes(recorder, units, "shapes").map(span::on_page);
    figure.map_or_else(String::new, |figure| {
        format!(
            "<section id=\"shapes\" class=\"panel\" aria-labelledby=\"shapes-title\">\n\
             <h3 id=\"shapes-title\">Deflected shape at chosen times</h3>\n{figure}</section>"
        )
    })
}

/// What is said of envelopes of a beam that blocks strike (`docs/section-forces.md`).
const UNBOUNDED: &str = "<p class=\"note\">With impacts both depend on the step and on the elements: a blow of a rigid body is an impulse, whose \
    peak of the transverse force near the contact grows without bound as these shrink. Compare with shorter steps and more elements before it is \
    used.</p>\n";

/// A part of the yield strength in percent, marked where it is beyond that.
fn judged(part: f64, summary: &Summary) -> String {
    let class = if part > 1.0 { " class=\"bad\"" } else { "" };
    format!("<span{class}>{}</span>", percent(part, summary.impact_count > 0))
}

/// That forces are without the own weight of the beams whose scene leaves it out, where `shown` says that the beam has some.
fn without_weight(summary: &Summary, shown: impl Fn(&BorneSummary) -> bool) -> Option<String> {
    let shown: Vec<&BorneSummary> = summary.beams.iter().filter(|beam| shown(beam)).collect();
    let without: Vec<&str> =
        shown.iter().filter(|beam| beam.is_without_weight).map(|beam| beam.beam.as_str()).collect();
    own_weight::told(&without, shown.len())
}

/// What beams bore: largest stress, reactions, envelopes.
pub(super) fn borne(recorder: &PageRecorder, units: &Units, summary: &Summary) -> String {
    let mut html = String::new();
    let several = summary.beams.len() > 1;
    let stresses = summary.beams.iter().filter_map(|borne| {
        let largest = borne.largest_stress?;
        let weight = borne.about_weight(|part| judged(part, summary));
        let weight = if weight.is_empty() { weight } else { format!(",{weight}") };
        let part = borne.part_of_yield_strength;
        let part = part.map(|part| format!(", {} of the yield strength", judged(part, summary)));
        let name = if several { format!("{}: largest", escaped(&borne.beam)) } else { "Largest".to_owned() };
        Some(format!(
            "<p data-beam=\"{}\" data-stress=\"{}\">{name} normal stress {} at x = {}, t = {}{}{weight}</p>\n",
            escaped(&borne.beam),
            largest.stress,
            with_digits(largest.stress, "Pa", 4),
            place(recorder, largest.x),
            with_digits(largest.t, "s", 6),
            part.unwrap_or_default()
        ))
    });
    let stresses: String = stresses.collect();
    let depends = if summary.impact_count > 0 {
        "<p class=\"note\">With impacts it depends on the step and on the elements: compare with shorter steps and more \
         elements before it is used.</p>\n"
    } else {
        ""
    };
    if !stresses.is_empty() {
        let _ = writeln!(
            html,
            "<section id=\"stress\" class=\"panel\" aria-labelledby=\"stress-title\">\n<h3 id=\"stress-title\">Stress</h3>\n\
             {stresses}{depends}</section>"
        );
    }
    if let Some(figure) = span::envelopes(recorder, units, "envelopes").map(span::on_page) {
        let _ = writeln!(
            html,
            "<section id=\"envelopes\" class=\"panel\" aria-labelledby=\"envelopes-title\">\n<h3 id=\"envelopes-title\">Moment \
             and transverse force over the span, least and largest of all steps</h3>\n{figure}{}</section>",
            after_impacts(recorder).map_or("", |_| UNBOUNDED)
        );
    }
    html.push_str(&reactions(recorder, summary));
    html
}

/// A place along a beam in the unit of the plots.
fn place(recorder: &PageRecorder, x: f64) -> String {
    let unit = recorder.scenery.display.length;
    format!("{} {}", shortest(x * unit.per_metre(), 4), unit.word())
}

fn reactions(recorder: &PageRecorder, summary: &Summary) -> String {
    let supports: Vec<_> =
        summary.beams.iter().flat_map(|borne| borne.reactions.iter().map(|range| (&borne.beam, range))).collect();
    if supports.is_empty() {
        return String::new();
    }
    let several = summary.beams.len() > 1;
    let mut html = "<section id=\"reactions\" class=\"panel\" aria-labelledby=\"reactions-title\">\n\
        <h3 id=\"reactions-title\">Reactions of the supports</h3>\n<div class=\"scroll\" tabindex=\"0\" role=\"group\" \
        aria-labelledby=\"reactions-title\"><table>\n<thead><tr>"
        .to_owned();
    html.push_str(if several { "<th scope=\"col\">Beam</th>" } else { "" });
    let farthest = supports.iter().fold(0.0, |most: f64, (_, range)| most.max(range.x.abs()));
    let (unit, factor) = length_unit(recorder.scenery.display.length, farthest);
    let _ = write!(html, "<th scope=\"col\">x<br><small>{unit}</small></th>");
    // Pinned ends have none.
    let turned = supports.iter().any(|(_, range)| range.couple != [0.0; 2]);
    let most = |of: fn(&ReactionRange) -> [f64; 2]| {
        largest(supports.iter().flat_map(|(_, range)| of(range)).collect::<Vec<_>>().iter())
    };
    let [force_unit, couple_unit] = [most(|range| range.force), most(|range| range.couple)].map(prefix);
    let columns = [("Force", force_unit, "N"), ("Couple", couple_unit, "N m")];
    for (what, (prefix, _), unit) in &columns[..if turned { 2 } else { 1 }] {
        for when in ["at the start", "least", "largest"] {
            let _ = write!(html, "<th scope=\"col\">{what} {when}<br><small>{prefix}{unit}</small></th>");
        }
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    let shown = if turned { 7 } else { 4 };
    let rows = supports.iter().map(|(_, range)| {
        let ([force, couple], [low, high], [least, most]) = (range.start, range.force, range.couple);
        let [force, low, high] = [force, low, high].map(|force| force_unit.1 * force);
        let [couple, least, most] = [couple, least, most].map(|couple| couple_unit.1 * couple);
        [factor * range.x, force, low, high, couple, least, most]
    });
    let rows: Vec<[f64; 7]> = rows.collect();
    let columns: Vec<Vec<String>> = (0..shown).map(|k| aligned(rows.iter().map(|row| row[k]).collect())).collect();
    for (number, (beam, range)) in supports.iter().enumerate() {
        let name = escaped(beam);
        let head = if several { format!("<th scope=\"row\">{name}</th>") } else { String::new() };
        let cells: String = columns.iter().map(|column| format!("<td>{}</td>", column[number])).collect();
        let _ = writeln!(html, "<tr data-beam=\"{name}\" data-x=\"{}\">{head}{cells}</tr>", range.x);
    }
    let grows = if summary.impact_count > 0 { ": an impact\u{2019}s peak grows as the step shrinks" } else { "" };
    let weight = without_weight(summary, |beam| !beam.reactions.is_empty());
    let weight = weight.map_or_else(String::new, |weight| format!(", {}", escaped(&weight)));
    let _ = write!(
        html,
        "</tbody></table></div>\n<p class=\"note\">Of the support on the beam: force upwards, couple counter-clockwise{weight}. Means over \
         a step{grows}.</p>\n</section>"
    );
    html
}

/// The values of a column, with as many decimals as give the largest four digits and no more than one of them needs; no negative zero.
fn aligned(values: Vec<f64>) -> Vec<String> {
    let most = decimals(values.iter().copied(), 4);
    let needed = |x: &f64| {
        let text = format!("{x:.most$}");
        text.split_once('.').map_or(0, |(_, part)| part.trim_end_matches('0').len())
    };
    let decimals = values.iter().map(needed).max().unwrap_or(0);
    let text = |x: f64| {
        let text = format!("{x:.decimals$}");
        let zero = text.trim_start_matches('-').trim_matches(['0', '.']).is_empty();
        if zero { text.trim_start_matches('-').to_owned() } else { text.replace('-', "\u{2212}") }
    };
    values.into_iter().map(text).collect()
}

#[cfg(test)]
mod tests {
    use super::aligned;

    #[test]
    fn values_of_a_column_have_the_same_decimals() {
        assert_eq!(aligned(vec![38.5, 77.01]), ["38.50", "77.01"]);
        assert_eq!(aligned(vec![-4942.3, 0.001]), ["\u{2212}4942", "0"]);
        assert_eq!(aligned(vec![0.0, 0.6]), ["0.0", "0.6"]);
        assert_eq!(aligned(vec![0.0, -0.0]), ["0", "0"]);
    }
}
