//! A document as a self-contained page of HTML.

use super::{Described, in_a_line};
use crate::html::Html;
use catchment_core::document::{Section, SectionPart, Table};

/// The page up to its title.
const HEAD: &str = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/><style>\
    body{font:15px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em}table{border-collapse:collapse;margin:.5em 0}\
    th,td{text-align:left;padding:.15em 1.2em .15em 0;vertical-align:top}.n{text-align:right}.warning{color:#8a5a00}\
    </style><title>";

/// A document as a page; ends with a line break.
pub fn html(described: &Described<'_>) -> String {
    let title = &described.title;
    let mut page = Html::default().fixed(HEAD).text(title).fixed("</title></head><body>\n<h1>");
    page = page.text(title).fixed("</h1>\n");
    for section in &described.document.sections {
        if let Some(title) = &section.title {
            page = page.fixed("<h2>").text(title).fixed("</h2>\n");
        }
        page = parts(page, section);
    }
    for warning in &described.warnings {
        let [severity, words] = in_a_line(warning);
        page = page.fixed("<p class=\"warning\">").text(&format!("{severity} {words}")).fixed("</p>\n");
    }
    page.fixed("</body></html>\n").into_string()
}

fn parts(mut page: Html, section: &Section) -> Html {
    let mut in_rows = false;
    for part in &section.parts {
        let is_row = matches!(part, SectionPart::Row { .. });
        if is_row != in_rows {
            page = page.fixed(if is_row { "<table>\n" } else { "</table>\n" });
            in_rows = is_row;
        }
        page = match part {
            SectionPart::Row { name, value } => {
                let named = page.fixed("<tr><th>").text(name.trim());
                named.fixed("</th><td>").text(value).fixed("</td></tr>\n")
            }
            SectionPart::Table(shown) if shown.is_shown() => table(page, shown),
            SectionPart::Table(_) => page,
            SectionPart::Paragraph(words) => page.fixed("<p>").text(words).fixed("</p>\n"),
        };
    }
    if in_rows { page.fixed("</table>\n") } else { page }
}

fn table(mut page: Html, table: &Table) -> Html {
    page = page.fixed("<table>\n<tr>");
    let columns = || table.columns.iter().enumerate().filter(|(_, column)| column.title.is_some());
    for (_, column) in columns() {
        page = page.fixed(if column.left { "<th>" } else { "<th class=\"n\">" });
        page = page.text(column.title.as_deref().unwrap_or_default()).fixed("</th>");
    }
    page = page.fixed("</tr>\n");
    for row in &table.rows {
        page = page.fixed("<tr>");
        for (k, column) in columns() {
            page = page.fixed(if column.left { "<td>" } else { "<td class=\"n\">" });
            page = page.text(&column.shown(&row[k])).fixed("</td>");
        }
        page = page.fixed("</tr>\n");
    }
    page.fixed("</table>\n")
}
