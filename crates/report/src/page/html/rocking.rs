//! The table of half cycles.

use crate::page::recorder::PageRecorder;
use crate::page::rocking::{HalfCycle, LeftOutCycles, WhyLeftOut};
use std::fmt::Write;
use teeter_plot::escaped;

/// Rows of the table; the rest is in `summary.json`.
const ROWS: usize = 300;

/// Rows that are seen without unfolding the others.
const UNFOLDED: usize = 20;

/// Decimals with which the largest of the values of a column has so many digits.
pub(super) fn decimals(values: impl Iterator<Item = f64>, digits: i32) -> usize {
    let largest = values.fold(0.0, |most: f64, x| most.max(x.abs()));
    if largest > 0.0 { (digits - 1 - largest.log10().floor() as i32).clamp(0, 12) as usize } else { 0 }
}

/// Of which blocks the table has no half cycles, and why.
fn not_listed(left_out: &[LeftOutCycles]) -> String {
    let passed = |of: &LeftOutCycles| format!("{} passed {} through φ = 0", escaped(&of.body), times(of.count));
    let few = left_out.iter().filter_map(|of| match of.why {
        WhyLeftOut::FewLandings(hits) => {
            let near = if hits == 0 { "none".to_owned() } else { hits.to_string() };
            Some(format!("{}, with a corner landing near {near} of these", passed(of)))
        }
        WhyLeftOut::HardlySwings | WhyLeftOut::NotSettled => None,
    });
    let few = few.collect::<Vec<_>>().join("; ");
    let all = |why: WhyLeftOut| left_out.iter().filter(|of| of.why == why).map(passed).collect::<Vec<_>>().join("; ");
    let told = [
        (few, "where a corner lands near fewer than half of the passages through φ = 0, as of what bounces or tumbles"),
        (
            all(WhyLeftOut::HardlySwings),
            "of a block that swings by less than a hundredth of its critical angle against the line between its feet on its beam, though it passes φ = 0 \
             as the summary counts, against the beam’s undeformed axis",
        ),
        (
            all(WhyLeftOut::NotSettled),
            "of what turns to and fro only before it has settled on its beam, as what bounces does",
        ),
    ];
    let told = told.into_iter().filter(|(bodies, _)| !bodies.is_empty());
    let told: String = told.map(|(bodies, why)| format!("No half cycles are listed {why}: {bodies}. ")).collect();
    if told.is_empty() { told } else { format!("<p id=\"no-half-cycles\" class=\"note\">{}</p>", told.trim_end()) }
}

fn times(count: usize) -> String {
    if count == 1 { "once".to_owned() } else { format!("{count} times") }
}

pub(super) fn rocking(
    (cycles, left_out): &(Vec<HalfCycle>, Vec<LeftOutCycles>),
    recorder: &PageRecorder,
    dt: f64,
) -> String {
    if cycles.is_empty() {
        return not_listed(left_out);
    }
    let mut html = "<section id=\"rocking\" class=\"panel\" aria-labelledby=\"rocking-title\">\n\
        <h3 id=\"rocking-title\">Rocking, half cycle by half cycle</h3>\n"
        .to_owned();
    let scenery = &recorder.scenery;
    // With one block its name would be a column of repetitions.
    let several = scenery.blocks.len() > 1;
    let (angle_unit, per_radian) = (scenery.display.angle.symbol(), scenery.display.angle.per_radian());
    // A step is told from the next.
    let of_times = decimals(std::iter::once(dt), 2).max(5);
    let of_rates = decimals(cycles.iter().filter_map(|cycle| cycle.omega).flatten(), 5);
    let of_peaks = decimals(cycles.iter().filter_map(|cycle| cycle.peak_after).map(|peak| peak * per_radian), 4);
    // A column without a value says nothing: of a dropped block no corner comes down while the other one stands.
    let number = |cycle: &HalfCycle| scenery.blocks.iter().position(|block| block.name == cycle.body);
    // The velocities at one of the bounces of a beam give no restitution, with which rigid ground could be compared.
    let is_on_beam = |cycle: &HalfCycle| number(cycle).is_some_and(|block| scenery.is_on_beam(block));
    let ratio = |cycle: &HalfCycle| cycle.ratio().filter(|_| !is_on_beam(cycle));
    let housner = |cycle: &HalfCycle| cycle.housner.filter(|_| !is_on_beam(cycle));
    let hits = cycles.iter().any(|cycle| cycle.omega.is_some());
    let (ratios, ideal) = (cycles.iter().any(|of| ratio(of).is_some()), cycles.iter().any(|of| housner(of).is_some()));
    // On a beam that slopes the peaks to the two sides can't be compared, but the lifts can.
    let decay = |cycle: &HalfCycle| cycle.decay().filter(|_| !cycle.on_beam);
    let square = |cycle: &HalfCycle| cycle.housner.filter(|_| cycle.on_beam).map(|ratio| ratio * ratio);
    let (decays, lifts) = (cycles.iter().any(|of| !of.on_beam), cycles.iter().any(|of| of.on_beam));
    let squares = cycles.iter().any(|of| square(of).is_some());
    let mut head =
        "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-labelledby=\"rocking-title\"><table>\n<thead><tr>"
            .to_owned();
    head.push_str(if several { "<th scope=\"col\">Block</th>" } else { "" });
    head.push_str("<th scope=\"col\">φ = 0 at<br><small>s</small></th>");
    head.push_str(if hits {
        "<th scope=\"col\" class=\"wide\">ω⁻<br><small>rad/s</small></th><th scope=\"col\" class=\"wide\">ω⁺<br><small>rad/s</small></th>"
    } else {
        ""
    });
    // Narrow windows have room for those that tell the decay.
    let (any, wide) = ("", " class=\"wide\"");
    let of_ratios = if decays && lifts { wide } else { any };
    if ratios {
        let _ = write!(head, "<th scope=\"col\"{of_ratios}>ω⁺/ω⁻</th>");
    }
    head.push_str(if ideal { "<th scope=\"col\" class=\"wide\">Housner</th>" } else { "" });
    let _ = write!(head, "<th scope=\"col\">Next peak<br><small>{angle_unit}</small></th>");
    head.push_str(if decays { "<th scope=\"col\">Next peak / previous</th>" } else { "" });
    head.push_str(if lifts { "<th scope=\"col\">Next lift / previous</th>" } else { "" });
    head.push_str(if squares { "<th scope=\"col\" class=\"wide\">Housner²</th>" } else { "" });
    head.push_str("</tr></thead>\n<tbody>\n");
    let fixed = |x: Option<f64>, digits: usize| {
        // No negative zero.
        x.map_or("–".to_owned(), |x| {
            let text = format!("{x:.digits$}");
            if text.trim_start_matches('-').trim_matches(['0', '.']).is_empty() {
                text.trim_start_matches('-').to_owned()
            } else {
                text.replace('-', "\u{2212}")
            }
        })
    };
    html.push_str(&head);
    for (number, cycle) in cycles.iter().take(ROWS).enumerate() {
        if number == UNFOLDED {
            let more = cycles.len().min(ROWS) - UNFOLDED;
            let rows = if more == 1 { "row" } else { "rows" };
            let _ = write!(html, "</tbody></table></div>\n<details><summary>{more} more {rows}</summary>\n{head}");
        }
        let name = escaped(&cycle.body);
        let row_head = if several { format!("<th scope=\"row\">{name}</th>") } else { String::new() };
        let rates = [0, 1].map(|k| fixed(cycle.omega.map(|omega| omega[k]), of_rates));
        let cells = [
            (true, any, fixed(Some(cycle.t), of_times)),
            (hits, wide, rates[0].clone()),
            (hits, wide, rates[1].clone()),
            (ratios, of_ratios, fixed(ratio(cycle), 4)),
            (ideal, wide, fixed(housner(cycle), 4)),
            (true, any, fixed(cycle.peak_after.map(|peak| peak * per_radian), of_peaks)),
            (decays, any, fixed(decay(cycle), 4)),
            (lifts, any, fixed(cycle.lift, 4)),
            (squares, wide, fixed(square(cycle), 4)),
        ];
        let cells: String = cells
            .iter()
            .filter(|(shown, ..)| *shown)
            .map(|(_, class, cell)| format!("<td{class}>{cell}</td>"))
            .collect();
        let _ = writeln!(html, "<tr data-body=\"{name}\" data-t=\"{}\">{row_head}{cells}</tr>", cycle.t);
    }
    html.push_str("</tbody></table></div>\n");
    html.push_str(if cycles.len() > UNFOLDED { "</details>\n" } else { "" });
    if cycles.len() > ROWS {
        let _ = writeln!(html, "<p>… and {} more; all are in summary.json.</p>", cycles.len() - ROWS);
    }
    if hits || ideal || squares {
        let left_out =
            [(hits, "ω⁻ and ω⁺"), (ratios && of_ratios == wide, "ω⁺/ω⁻"), (ideal, "Housner"), (squares, "Housner²")];
        let left_out: Vec<&str> = left_out.into_iter().filter(|(shown, _)| *shown).map(|(_, what)| what).collect();
        let _ = writeln!(
            html,
            "<p class=\"note narrow\">In a wider window the table has {}, too.</p>",
            left_out.join(", ")
        );
    }
    html.push_str("<p class=\"note\">");
    html.push_str(if hits {
        "ω⁻ and ω⁺ are the angular velocities right before and right after the step in which the corner that comes down hits; a step of \
         gravity is in them, too; a dash stands where no corner landed near φ = 0, or other contacts of the block struck within the next three steps. "
    } else {
        "Angular velocities before and after an impact are told where one corner stands as the other comes down. "
    });
    html.push_str(if ideal {
        "Housner: 1\u{a0}−\u{a0}(3/2)\u{a0}sin²α, for rigid ground without slip or bounce. "
    } else {
        ""
    });
    let is_on_block = |cycle: &HalfCycle| number(cycle).is_some_and(|block| scenery.is_on_block(block));
    let touch_blocks = cycles.iter().filter_map(number).any(|number| scenery.touches_blocks(number));
    let on_blocks = cycles.iter().any(is_on_block);
    html.push_str(match cycles.iter().any(|cycle| is_on_block(cycle) && cycle.omega.is_some()) {
        true => {
            "Of a block that stands on another one, φ, ω⁻ and ω⁺ are relative to that one, which the impact moves, too: their ratio is not one of \
             the block alone. "
        }
        false if on_blocks => "Of a block that stands on another one, φ is relative to that one. ",
        false => "",
    });
    let on_beams = cycles.iter().any(is_on_beam);
    html.push_str(if lifts {
        "Of a block on a beam, φ counts from the line between its feet on the bent beam, about which it rocks. As a deck that slopes lets it swing farther \
         downhill than uphill with the same energy, the lift tells the decay: how high its mass centre is at a peak over where it is flat on that line. "
    } else {
        ""
    });
    html.push_str(if squares {
        "Housner²: what an impact on rigid ground would leave of the lift, (1\u{a0}−\u{a0}(3/2)\u{a0}sin²α)². "
    } else {
        ""
    });
    html.push_str(if on_blocks || lifts { "Plots have φ from the horizontal. " } else { "" });
    html.push_str(match (decays, lifts) {
        (_, false) => "Next peak / previous has a dash",
        (false, true) => "Next lift / previous has a dash",
        (true, true) => "Next peak / previous and next lift / previous have a dash",
    });
    html.push_str(
        " after a previous peak of less than a hundredth of the critical angle, and where one of the two isn’t known. ",
    );
    html.push_str(match (decays, lifts) {
        (_, false) => "Passages between two peaks below a thousandth of the critical angle are left out. ",
        (false, true) => "Swings of less than a hundredth of the critical angle don’t count. ",
        (true, true) => {
            "Passages between two peaks below a thousandth of the critical angle are left out, on a beam swings of less than a hundredth. "
        }
    });
    if hits && on_beams {
        // A ratio beside it is that of another block.
        let mut bodies: Vec<&str> =
            cycles.iter().filter(|cycle| is_on_beam(cycle)).map(|of| of.body.as_str()).collect();
        bodies.sort_unstable();
        bodies.dedup();
        let whose = if ratios {
            format!("Of {}, on a beam, no", escaped(&bodies.join(", ")))
        } else {
            "On a beam no".to_owned()
        };
        let what = if lifts { "lift" } else { "peaks" };
        let _ = write!(
            html,
            "{whose} ω⁺/ω⁻ is given: the beam springs back, so that what is one impact on rigid ground goes on over several bounces, and the velocities \
         before and after one of them don’t tell what is lost. The decay of the {what} does, but for loads that act meanwhile and what a beam that vibrates gives back."
        );
    }
    html.push_str(if touch_blocks || on_beams {
        ""
    } else if hits && !scenery.driven.is_empty() {
        "A base that gives way spreads the loss over the half cycle: the ratio is then nearer to 1."
    } else if hits {
        "A base that gives way spreads the loss over the half cycle: the ratio is then nearer to 1, and the decay from peak to peak tells \
         what is lost."
    } else {
        ""
    });
    html.push_str(if scenery.incline != 0.0 {
        " Here φ is measured from the incline, in the plots from the horizontal; the swings to the two sides differ, as gravity isn’t \
         normal to the incline."
    } else {
        ""
    });
    html.push_str("</p>\n");
    html.push_str(&not_listed(left_out));
    html.push_str("</section>");
    html
}
