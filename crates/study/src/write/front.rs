//! The figure of the page: error over CPU time, large, of one quantity at a time.

use super::figure::{schemes, themed};
use super::percent;
use crate::Tradeoff;
use std::fmt::Write;
use teeter_plot::{AxisError, escaped};

/// The shapes of marks beside the names of schemes, as teeter-plot draws them in turn.
const SHAPES: [&str; 4] = [
    "<circle cx=\"6\" cy=\"6\" r=\"4\"/>",
    "<path d=\"M2.5 2.5h7v7h-7z\"/>",
    "<path d=\"M6 1.5l5 8.5h-10z\"/>",
    "<path d=\"M6 1l5 5l-5 5l-5 -5z\"/>",
];

/// The style of the figure.
pub(super) const STYLE: &str = "\
#front svg[role] { max-width: 62rem; margin: 0 auto; }\n\
#front .legend { margin: .5rem 0; padding: 0; list-style: none; }\n\
#front .legend svg { width: 12px; height: 12px; }\n\
#choice { flex-wrap: wrap; gap: .3rem 1.1rem; margin: .5rem 0; padding: 0; border: 0; }\n\
#choice legend { float: left; padding: 0; margin-right: .2rem; }\n\
#choice label { white-space: nowrap; }\n\
#front figcaption { display: block; color: var(--muted); font-size: .8125rem; max-width: 62rem; margin: .4rem auto; }\n\
@media print { #front .wide { display: none; } #front .narrow { display: block; } #front .narrow svg { max-width: 10cm; } }\n";

/// Writes the section with the figures of all quantities that the scene has, one of them shown.
pub(super) fn section(html: &mut String, study: &Tradeoff) -> Result<(), AxisError> {
    let figures = themed(study, None)?;
    let Some((first, _)) = figures.first() else { return Ok(()) };
    html.push_str(
        "<section id=\"front\" class=\"panel\" aria-labelledby=\"front-title\"><h2 id=\"front-title\">Error over CPU time</h2>\n\
         <p class=\"note\">A point is a setting whose time was measured; the line is the smallest error within a time. Ringed: what is \
         advised, for which accuracy.</p>\n",
    );
    // By style alone, without a script; where a browser can't, all figures are seen.
    html.push_str(
        "<style>\n@media screen { @supports selector(:has(a)) {\n#front [data-quantity] { display: none; }\n",
    );
    for (quantity, _) in &figures {
        let word = quantity.word();
        let _ = writeln!(html, "#front:has(#show-{word}:checked) [data-quantity=\"{word}\"] {{ display: block; }}");
    }
    html.push_str("} }\n@media print { #choice { display: none; } }\n</style>\n<fieldset id=\"choice\"><legend>Error of</legend>\n");
    for (quantity, _) in &figures {
        let (word, checked) = (quantity.word(), if quantity == first { " checked" } else { "" });
        let _ = writeln!(
            html,
            "<label><input type=\"radio\" name=\"quantity\" id=\"show-{word}\"{checked}> {}</label>",
            quantity.title()
        );
    }
    html.push_str("</fieldset>\n");
    legend(html, study);
    for (quantity, figure) in &figures {
        let bar = study.reference.bar_of(*quantity);
        let below = if bar > 0.0 {
            format!(" Grey: below what the reference is known to, {}.", percent(bar))
        } else {
            String::new()
        };
        let _ = writeln!(
            html,
            "<figure data-quantity=\"{}\">\n{figure}<figcaption>{}: {}.{below}</figcaption></figure>",
            quantity.word(),
            quantity.title(),
            escaped(quantity.norm())
        );
    }
    html.push_str("</section>\n");
    Ok(())
}

fn legend(html: &mut String, study: &Tradeoff) {
    html.push_str("<ul class=\"legend\">\n");
    for (number, name) in schemes(study).into_iter().enumerate() {
        let _ = writeln!(
            html,
            "<li class=\"key\"><svg viewBox=\"0 0 12 12\" aria-hidden=\"true\" style=\"fill: var(--c{})\">{}</svg>{}</li>",
            number % 7,
            SHAPES[number % SHAPES.len()],
            escaped(name)
        );
    }
    if study.rows.iter().any(|row| row.measured().is_some() && study.is_warned(row)) {
        html.push_str(
            "<li class=\"key\"><svg viewBox=\"0 0 12 12\" aria-hidden=\"true\" style=\"fill: var(--fg); fill-opacity: .3\"><circle cx=\"6\" cy=\"6\" \
             r=\"4\"/></svg>pale: with warnings, not advised</li>\n",
        );
    }
    html.push_str(
        "<li class=\"key\"><svg viewBox=\"0 0 12 12\" aria-hidden=\"true\" style=\"fill: none; stroke: var(--fg)\"><circle cx=\"6\" cy=\"6\" \
         r=\"4\"/></svg>hollow: other keys changed too</li>\n</ul>\n",
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_plot::Mark;

    #[test]
    fn the_shapes_are_in_the_order_of_the_marks() {
        let order = (0..SHAPES.len()).map(Mark::of);
        assert!(order.eq([Mark::Circle, Mark::Square, Mark::Triangle, Mark::Diamond]));
        assert!(crate::Quantity::ALL.iter().all(|quantity| !quantity.word().contains(' ')), "words are ids");
    }
}
