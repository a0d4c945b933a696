//! `tradeoff.html`: a self-contained page in the style of a run's report.

use super::figure::themed;
use super::{advice, duration, findings, percent, pruning, short};
use crate::{Quantity, Tradeoff};
use std::fmt::Write;
use teeter_plot::{AxisError, Theme, escaped};
use teeter_report::STYLE;

const OWN_STYLE: &str = "\
main { display: block; }\nmain > section { margin-top: 1.5rem; }\n\
#front { display: grid; grid-template-columns: repeat(auto-fit, minmax(20rem, 1fr)); gap: 1rem; }\n\
#front svg { display: block; width: 100%; height: auto; max-width: 40rem; margin: 0 auto; }\n\
#advice li { margin: .3rem 0; overflow-wrap: anywhere; }\ncode { font-size: .9em; }\n\
tbody tr.on { background: var(--soft); font-weight: 600; }\n\
td:first-child, td:last-child { text-align: left; }\n";

/// The page.
///
/// # Errors
/// As [`figures`](super::figures).
pub fn page(study: &Tradeoff) -> Result<String, AxisError> {
    let title = escaped(&format!("Speed against accuracy: {}", study.title));
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n\
         <title>{title}</title>\n<style>\n{STYLE}{OWN_STYLE}</style>\n</head>\n<body>\n<header>\n<h1>{title}</h1>\n\
         <p id=\"subtitle\">{} candidates · t = {} s · teeter {}</p>\n</header>\n<main>\n",
        study.rows.len(),
        study.end,
        env!("CARGO_PKG_VERSION")
    );
    html.push_str("<section id=\"advice\" class=\"panel\"><h3>Advice</h3>\n<ul>\n");
    for sentence in advice(study) {
        let _ = writeln!(html, "<li>{}</li>", with_code(&sentence));
    }
    html.push_str(
        "</ul></section>\n<section id=\"findings\" class=\"panel\"><h3>How the numbers are obtained</h3>\n<ul>\n",
    );
    for sentence in findings(study) {
        let _ = writeln!(html, "<li>{}</li>", with_code(&sentence));
    }
    html.push_str(
        "</ul></section>\n<section class=\"panel\"><h3>Error over CPU time</h3>\n<p class=\"note\">A point is a candidate with a measured time, the line the smallest error within a time; grey: \
         below what the reference is known to.</p>\n<div id=\"front\">\n",
    );
    for (_, svg) in themed(study, Theme::Page)? {
        html.push_str(&svg);
    }
    html.push_str("</div></section>\n");
    checks(&mut html, study);
    candidates(&mut html, study);
    html.push_str("<section class=\"panel\"><h3>The errors and their norms</h3>\n<dl>\n");
    for quantity in Quantity::ALL {
        let _ = writeln!(html, "<dt>{}</dt><dd>{}</dd>", quantity.title(), escaped(quantity.norm()));
    }
    html.push_str("</dl></section>\n<section class=\"panel\"><h3>Settings tried</h3>\n<ul>\n");
    for sentence in pruning(study) {
        let _ = writeln!(html, "<li>{}</li>", escaped(&sentence));
    }
    let _ = writeln!(
        html,
        "</ul>\n<p class=\"note\">Motions are compared every {} s; where a step doesn’t end there, by the cubic through positions and velocities \
         at its ends. CPU time is that of the steps on one thread, output off, the median of runs in turns. What is tried and advised goes by \
         counted work, so that it is the same in every run.</p></section>\n</main>\n</body>\n</html>",
        study.sampling.every
    );
    Ok(html)
}

/// The settings in a sentence, between backquotes, as code.
fn with_code(sentence: &str) -> String {
    let mut html = String::new();
    for (number, piece) in sentence.split('`').enumerate() {
        let piece = escaped(piece);
        html.push_str(&if number % 2 == 1 { format!("<code>{piece}</code>") } else { piece });
    }
    html
}

fn header(html: &mut String, first: &[&str], last: &[&str]) {
    html.push_str("<thead><tr>");
    let cells = first.iter().copied().chain(Quantity::ALL.map(Quantity::title)).chain(last.iter().copied());
    for cell in cells {
        let _ = write!(html, "<th scope=\"col\">{cell}</th>");
    }
    html.push_str("</tr></thead>\n<tbody>\n");
}

fn errors(html: &mut String, errors: &crate::Errors) {
    for quantity in Quantity::ALL {
        let text = errors.of(quantity).map_or("–".to_owned(), short);
        let _ = write!(html, "<td>{}</td>", text.replace('-', "\u{2212}"));
    }
}

fn checks(html: &mut String, study: &Tradeoff) {
    html.push_str(
        "<section id=\"checks\" class=\"panel\"><h3>Accuracy of the reference</h3>\n<div class=\"scroll\" tabindex=\"0\"><table>\n",
    );
    header(html, &["ReferenceComparison the reference", "agrees until"], &["Setting"]);
    for check in &study.reference.checks {
        let _ = write!(html, "<tr><td>{}</td><td>{} s</td>", escaped(check.what), short(check.agrees_until));
        errors(html, &check.errors);
        let _ = writeln!(html, "<td><code>{}</code></td></tr>", escaped(&check.setting.to_string()));
    }
    html.push_str("</tbody></table></div></section>\n");
}

fn candidates(html: &mut String, study: &Tradeoff) {
    html.push_str(
        "<section id=\"candidates\" class=\"panel\"><h3>The candidates</h3>\n<p class=\"note\">Bold: on the Pareto front of accuracy over counted work. Of the later stages, those that \
         were near the front; tradeoff.csv has all. A setting that `check` or `run` \
         warns of is not advised.</p>\n\
         <div class=\"scroll\" tabindex=\"0\"><table>\n",
    );
    header(html, &["Stage"], &["CPU time", "by counted work", "Setting"]);
    // Only the informative ones of hundreds; the table in the file has all.
    let shown = |number: usize, row: &crate::Row| {
        row.stage <= 2 || row.cpu.is_some() || row.result.is_err() || study.front.contains(&number)
    };
    for (number, row) in study.rows.iter().enumerate().filter(|(number, row)| shown(*number, row)) {
        let class = if study.front.contains(&number) { " class=\"on\"" } else { "" };
        let _ = write!(html, "<tr{class}><td>{}</td>", row.stage);
        let setting =
            if row.setting.is_none() { "the unchanged scene".to_owned() } else { escaped(&row.setting.to_string()) };
        match &row.result {
            Ok(done) => {
                errors(html, &done.errors);
                let _ = write!(
                    html,
                    "<td>{}</td><td>{}</td>",
                    row.measured().map_or("–".to_owned(), duration),
                    duration(done.work.seconds())
                );
            }
            Err(failure) => {
                let columns = Quantity::ALL.len() + 2;
                let _ = write!(html, "<td colspan=\"{columns}\" class=\"bad\">{}</td>", escaped(&failure.to_string()));
            }
        }
        let warned = row
            .warned()
            .iter()
            .map(|warned| format!("<br><span class=\"bad\">warned: {}</span>", escaped(&warned.text)));
        let _ = writeln!(html, "<td><code>{setting}</code>{}</td></tr>", warned.collect::<String>());
    }
    let _ = writeln!(
        html,
        "</tbody></table></div><p class=\"note\">Accuracies below {} can't be measured.</p></section>",
        percent(study.bar())
    );
}
