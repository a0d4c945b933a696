//! What was modelled.

use super::with_code;
use crate::Summary;
use crate::summary::{BeamSummary, RemovedSummary};
use std::fmt::Write;
use teeter_plot::escaped;
use teeter_scenario::physical::PhysicalTable;

/// Tables of more columns have on a telephone a list for each row.
const MOST_COLUMNS: usize = 6;

/// The physical data of blocks, beams and contacts.
pub(super) fn physical(tables: &[PhysicalTable]) -> String {
    let mut html = String::new();
    for table in tables {
        let id = format!("data-{}", table.title.to_lowercase());
        let cards = if table.head.len() > MOST_COLUMNS { " cards" } else { "" };
        let _ = write!(
            html,
            "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"{}\"><table id=\"{id}\" class=\"physical{cards}\">\n<thead><tr>",
            table.title
        );
        table.head.iter().for_each(|name| _ = write!(html, "<th scope=\"col\">{name}</th>"));
        html.push_str("</tr></thead>\n<tbody>\n");
        for row in &table.rows {
            let cells = row.iter().zip(&table.head).enumerate().map(|(k, (cell, of))| match (k, escaped(cell)) {
                (0, cell) => format!("<th scope=\"row\">{cell}</th>"),
                (_, cell) => format!("<td data-of=\"{}\">{cell}</td>", escaped(of)),
            });
            let _ = writeln!(html, "<tr>{}</tr>", cells.collect::<String>());
        }
        html.push_str("</tbody></table></div>\n");
        if table.more > 0 {
            let _ = writeln!(html, "<p class=\"note\">and {} more, in the settings</p>", table.more);
        }
        if !table.note.is_empty() {
            let _ = writeln!(html, "<p class=\"note\">{}</p>", escaped(&table.note));
        }
    }
    html
}

pub(super) fn model(summary: &Summary) -> String {
    let model = &summary.model;
    let list = |words: &[String]| {
        if words.is_empty() { "none".to_owned() } else { escaped(&words.join(", ")) }
    };
    let beams: Vec<String> = model
        .beams
        .iter()
        .map(|beam| {
            let BeamSummary { name, elements, dofs, theory, backend, shapes } = beam;
            let shapes = shapes.map_or_else(String::new, |shapes| {
                let corrections = match shapes.corrections {
                    0 => String::new(),
                    n => format!(" and {n} static corrections"),
                };
                format!(" in {} modes{corrections}", shapes.modes)
            });
            format!("{name} ({theory}, {elements} elements{shapes}, {dofs} dofs, {backend})")
        })
        .collect();
    let mut html = String::new();
    let mut row = |name: &str, text: &str| _ = writeln!(html, "<div><dt>{name}</dt><dd>{text}</dd></div>");
    row("Blocks", &list(&model.blocks));
    row("Beams", &list(&beams));
    row("Ground", if model.ground { "rigid" } else { "none" });
    let plural = if model.possible_contacts == 1 { "" } else { "s" };
    let sides = if model.has_sides { ", and those of ends and humps of beams with sides of blocks" } else { "" };
    row("Contacts", &format!("{}; {} possible contact{plural}{sides}", list(&model.contacts), model.possible_contacts));
    if !model.loads.is_empty() {
        row("Loads", &model.loads.iter().map(|text| escaped(text)).collect::<Vec<_>>().join("<br>"));
    }
    row("Degrees of freedom", &model.dofs.to_string());
    if !model.left_out.is_empty() {
        row("Left out", &model.left_out.iter().map(|text| escaped(text)).collect::<Vec<_>>().join("<br>"));
    }
    if !model.removed.is_empty() {
        let told = |removed: &RemovedSummary| format!("{}: {}", with_code(&removed.what), with_code(&removed.why));
        row("Not needed", &model.removed.iter().map(told).collect::<Vec<_>>().join("<br>"));
    }
    html
}
