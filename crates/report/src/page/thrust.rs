//! The lines of thrust on the page: the drawing, and the joints as a table.

use super::recorder::PageRecorder;
use super::widths::drawing_for_any_width;
use super::{Joint, rounded};
use super::{content, drawings};
use std::fmt::Write;
use teeter_plot::escaped;

/// The section; `many`: whether the contact forces are one of many sets at the end. Empty without a chain of blocks.
pub(super) fn section(recorder: &PageRecorder, many: bool) -> String {
    let lines = drawings::lines_of(recorder);
    let Some(drawing) = drawings::thrust(recorder, &lines, many) else { return String::new() };
    let joints: usize = lines.iter().map(|line| line.joints.len()).sum();
    let mut html = format!(
        "<section id=\"thrust\" class=\"panel\" aria-labelledby=\"thrust-title\">\n<h3 id=\"thrust-title\">Line of \
         thrust at the end</h3>\n{}<details><summary>Eccentricity of the {joints} \
         joints</summary><div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-labelledby=\"thrust-title\"><table>\n\
         <thead><tr><th scope=\"col\">Joint</th><th scope=\"col\">e<br><small>mm</small></th><th scope=\"col\">e / depth\
         </th><th scope=\"col\">Normal<br><small>N</small></th><th scope=\"col\">Shear<br><small>N</small></th></tr></thead>\n\
         <tbody>\n",
        drawing_for_any_width(&drawing)
    );
    for joint in lines.iter().flat_map(|line| &line.joints) {
        let Joint { between: [one, other], .. } = joint;
        let [normal, shear] = joint.normal_and_shear.map_or([None; 2], |forces| forces.map(Some));
        let depth = joint.depth.unwrap_or(f64::INFINITY);
        let e = joint.eccentricity.map(|e| drawings::above_rounding(e, joint.depth.unwrap_or(0.0)));
        let shear = shear
            .zip(normal)
            .map(|(shear, normal)| if content::holds(shear.abs(), normal.abs()) { shear } else { 0.0 });
        let cells = [e.map(|e| 1e3 * e), e.map(|e| e / depth), normal, shear].map(cell);
        let _ =
            writeln!(html, "<tr><th scope=\"row\">{} – {}</th>{}</tr>", escaped(one), escaped(other), cells.concat());
    }
    html.push_str(
        "</tbody></table></div></details>\n<p class=\"note\">e: distance of the centre of pressure from the middle of the joint, \
         positive to the left as one goes along the chain, in an arch from the left towards the extrados. The depth of a joint is the length over which its two blocks lie against each other. ± 1/2 of it \
         are its edges, beyond ± 1/6 a joint of elastic stone would open.</p>\n</section>",
    );
    html
}

fn cell(x: Option<f64>) -> String {
    let text = x.map_or("–".to_owned(), |x| rounded(x, 4).to_string().replace('-', "\u{2212}"));
    format!("<td>{text}</td>")
}
