//! `tradeoff.html`: a self-contained page in the style of a run's report.

use super::front;
use super::html::{capitalised, command_words, with_code};
use super::sentences::{NOTHING_MOVES, advised, command};
use super::{duration, findings, percent, pruning, short};
use crate::row::unbeaten;
use crate::{Quantity, Row, Tradeoff};
use std::fmt::Write;
use teeter_plot::{AxisError, escaped};
use teeter_report::document;

const OWN_STYLE: &str = "\
main > section { margin-top: 1.75rem; }\nh2 { font-size: 1.15rem; }\n\
.advised { margin-top: .9rem; }\n.advised p { margin-top: .25rem; max-width: 60rem; overflow-wrap: anywhere; }\n\
code { font-size: .9em; overflow-wrap: anywhere; white-space: pre-wrap; }\n\
.command { background: var(--soft); border-radius: 5px; padding: .3rem .6rem; }\n\
li { margin: .3rem 0; overflow-wrap: anywhere; }\n\
td:first-child { text-align: left; }\n\
tbody th.setting { text-align: left; white-space: normal; padding-top: .6rem; }\n\
th.setting > div { position: sticky; left: 0; width: min(100%, calc(100vw - 2.5rem)); }\n\
tbody.on th.setting, tbody.on td { font-weight: 600; }\n\
th.setting small { font-weight: 400; }\n\
@media (max-width: 520px) { .cards th.setting { display: block; } .cards td:first-child { font-weight: inherit; } \
 .cards tbody tr + tr { border-top: 0; padding-top: 0; } .cards table, .cards tbody { display: block; } }\n\
@media print { .panel { break-inside: auto; } figure { max-width: 15cm; } th.setting > div { width: auto; } table { font-size: 7pt; } th, td { padding-right: .3rem; } }\n";

/// The page. `scene` are the words that name the scene after `teeter run`, for the commands that
/// run its settings.
///
/// # Errors
/// As [`figures`](super::figures).
pub fn page(study: &Tradeoff, scene: &[&str]) -> Result<String, AxisError> {
    let title = format!("Speed against accuracy: {}", study.title);
    let subtitle =
        format!("{} settings tried · t = {} s · teeter {}", study.rows.len(), study.end, env!("CARGO_PKG_VERSION"));
    let mut html = String::new();
    let page = Page { study, scene };
    page.advice(&mut html);
    front::section(&mut html, study)?;
    page.pareto_front(&mut html);
    html.push_str("<section id=\"findings\" class=\"panel\" aria-labelledby=\"findings-title\"><h2 id=\"findings-title\">How the numbers are obtained</h2>\n<ul>\n");
    for sentence in findings(study).iter().chain(&pruning(study)) {
        let _ = writeln!(html, "<li>{}</li>", with_code(&capitalised(sentence)));
    }
    let _ = writeln!(
        html,
        "</ul>\n<p class=\"note\">Motions are compared every {} s; where a step doesn’t end there, by the cubic through positions and velocities \
         at its ends. CPU time is that of the steps on one thread, output off, the median of runs in turns. What is tried and advised goes by \
         counted work, so that it is the same in every run.</p></section>",
        study.sampling.every
    );
    page.candidates(&mut html);
    page.checks(&mut html);
    Ok(document(&title, &subtitle, &format!("{OWN_STYLE}{}", front::STYLE), &html))
}

/// What the parts of the page need.
struct Page<'a> {
    study: &'a Tradeoff,
    scene: &'a [&'a str],
}

impl Page<'_> {
    fn command(&self, row: &Row) -> String {
        command_words(&command(self.study, self.scene, &row.setting))
    }

    fn advice(&self, html: &mut String) {
        html.push_str("<section id=\"advice\" class=\"panel\" aria-labelledby=\"advice-title\"><h2 id=\"advice-title\">Advice</h2>\n");
        if self.study.best().is_none() {
            let _ = writeln!(html, "<p>{}.</p></section>", capitalised(NOTHING_MOVES));
            return;
        }
        let all = advised(self.study);
        // What is enough for one accuracy is often the cheapest for the next one, too: it is said once.
        for same in
            all.chunk_by(|a, b| a.text == b.text && a.row.map(std::ptr::from_ref) == b.row.map(std::ptr::from_ref))
        {
            let Some((advised, others)) = same.split_last() else { continue };
            let others = match others.iter().map(|other| percent(other.accuracy)).collect::<Vec<_>>() {
                none if none.is_empty() => String::new(),
                others => format!(" (and so within {})", others.join(", ")),
            };
            let target = format!("{}{others}", capitalised(&advised.target));
            let _ = writeln!(html, "<div class=\"advised\"><h3>{}</h3>", escaped(&target));
            if let Some(row) = advised.row {
                let _ = writeln!(html, "<p class=\"command\"><code>{}</code></p>", self.command(row));
            }
            let _ = writeln!(html, "<p>{}</p></div>", with_code(&capitalised(&advised.text)));
        }
        html.push_str("</section>\n");
    }

    /// The points of the Pareto front, and how to run each.
    fn pareto_front(&self, html: &mut String) {
        if self.study.front.is_empty() {
            return;
        }
        html.push_str(
            "<section id=\"pareto\" class=\"panel\" aria-labelledby=\"pareto-title\"><h2 id=\"pareto-title\">The Pareto front, and what to run for each of its points</h2>\n\
             <p class=\"note\">Settings that none tried beats in both accuracy and counted work, without those that another of them beats in both of the numbers below; \
             cheapest first.</p>\n<ol>\n",
        );
        for number in unbeaten(&self.study.front, &self.study.rows, self.study.bar()) {
            let row = &self.study.rows[number];
            let time = row.measured().or(row.modelled()).map_or_else(String::new, duration);
            let kind = if row.measured().is_some() { "of CPU time" } else { "by counted work" };
            // No error smaller than that of the reference is known.
            let bar = self.study.bar();
            let accuracy = match row.accuracy() {
                Some(error) if error < bar => format!("less than {} off, ", percent(bar)),
                Some(error) => format!("{} off, ", percent(error)),
                None => String::new(),
            };
            let warned = if self.study.is_warned(row) { ", with warnings" } else { "" };
            let _ = writeln!(html, "<li>{accuracy}{time} {kind}{warned}: <code>{}</code></li>", self.command(row));
        }
        html.push_str("</ol></section>\n");
    }

    fn checks(&self, html: &mut String) {
        html.push_str(
            "<section id=\"checks\" class=\"panel\" aria-labelledby=\"checks-title\"><details><summary id=\"checks-title\">Accuracy of the reference</summary>\n\
             <div class=\"scroll cards\" tabindex=\"0\" role=\"group\" aria-labelledby=\"checks-title\"><table>\n",
        );
        let checks = &self.study.reference.checks;
        let quantities = measured(checks.iter().map(|check| &check.errors));
        let columns = header(html, &[AGREES], &quantities, &[]);
        for check in checks {
            let _ = write!(
                html,
                "<tbody><tr><th scope=\"rowgroup\" colspan=\"{columns}\" class=\"setting\"><div>{}: <code>{}</code></div></th></tr>\n<tr><td data-of=\"{AGREES}\">{} s</td>",
                escaped(&capitalised(check.what)),
                command_words(&check.setting.to_string()),
                short(check.agrees_until)
            );
            errors(html, &quantities, &check.errors);
            html.push_str("</tr></tbody>\n");
        }
        html.push_str("</table></div></details></section>\n");
    }

    fn candidates(&self, html: &mut String) {
        let study = self.study;
        let _ = write!(
            html,
            "<section id=\"candidates\" class=\"panel\" aria-labelledby=\"candidates-title\"><details><summary id=\"candidates-title\">All settings, with all errors</summary>\n\
             <p class=\"note\">Bold: on the Pareto front. Of the later stages, those that were near it; tradeoff.csv has all. A setting that \
             <code>check</code> or <code>run</code> warns of is not advised. Accuracies below {} can’t be measured.</p>\n\
             <div class=\"scroll cards\" tabindex=\"0\" role=\"group\" aria-labelledby=\"candidates-title\"><table>\n",
            percent(study.bar())
        );
        let done = study.rows.iter().filter_map(|row| row.result.as_ref().ok());
        let quantities = measured(done.map(|done| &done.errors));
        let columns = header(html, &[STAGE], &quantities, &TIMES);
        // Only the informative ones of hundreds; the table in the file has all.
        let shown = |number: usize, row: &Row| {
            row.stage <= 2 || row.cpu.is_some() || row.result.is_err() || study.front.contains(&number)
        };
        for (number, row) in study.rows.iter().enumerate().filter(|(number, row)| shown(*number, row)) {
            let class = if study.front.contains(&number) { " class=\"on\"" } else { "" };
            let warned = row.warned().iter().map(|warned| format!("<br>warned: {}", escaped(&warned.text)));
            let _ = write!(
                html,
                "<tbody{class}><tr><th scope=\"rowgroup\" colspan=\"{columns}\" class=\"setting\"><div><code>{}</code><small>{}</small></div></th></tr>\n<tr><td data-of=\"{STAGE}\">{}</td>",
                self.command(row),
                warned.collect::<String>(),
                row.stage
            );
            match &row.result {
                Ok(done) => {
                    errors(html, &quantities, &done.errors);
                    let times = [row.measured().map_or("–".to_owned(), duration), duration(done.work.seconds())];
                    for (of, time) in TIMES.iter().zip(times) {
                        let _ = write!(html, "<td data-of=\"{of}\">{time}</td>");
                    }
                }
                Err(failure) => {
                    let _ = write!(
                        html,
                        "<td colspan=\"{}\" class=\"bad\">{}</td>",
                        columns - 1,
                        escaped(&failure.to_string())
                    );
                }
            }
            html.push_str("</tr></tbody>\n");
        }
        html.push_str("</table></div></details></section>\n");
    }
}

/// Headings of columns beside those of the quantities.
const STAGE: &str = "Stage";
const AGREES: &str = "Agrees until";
const TIMES: [&str; 2] = ["CPU time", "By counted work"];

/// The quantities of which any of these errors is known: the others would be columns of dashes.
fn measured<'a>(all: impl Iterator<Item = &'a crate::Errors>) -> Vec<Quantity> {
    let all: Vec<_> = all.collect();
    Quantity::ALL.into_iter().filter(|quantity| all.iter().any(|errors| errors.of(*quantity).is_some())).collect()
}

/// The head of a table of errors; returns its number of columns.
fn header(html: &mut String, first: &[&str], quantities: &[Quantity], last: &[&str]) -> usize {
    html.push_str("<thead><tr>");
    let titles = quantities.iter().map(|quantity| quantity.title());
    for cell in first.iter().copied().chain(titles).chain(last.iter().copied()) {
        let _ = write!(html, "<th scope=\"col\">{cell}</th>");
    }
    html.push_str("</tr></thead>\n");
    first.len() + quantities.len() + last.len()
}

/// Cells with errors, each with its column's heading for narrow windows, where a row is a list.
fn errors(html: &mut String, quantities: &[Quantity], errors: &crate::Errors) {
    for quantity in quantities {
        let text = errors.of(*quantity).map_or("–".to_owned(), short);
        let _ = write!(html, "<td data-of=\"{}\">{}</td>", quantity.title(), text.replace('-', "\u{2212}"));
    }
}
