//! Values read back from a page.

use furrow_model::Outcome;

/// The value of an attribute in the first tag after `from` in which it occurs.
pub fn attribute<'a>(text: &'a str, name: &str) -> &'a str {
    let from = text.split_once(&format!(" {name}=\"")).unwrap_or_else(|| panic!("no {name}")).1;
    from.split_once('"').unwrap().0
}

pub fn between<'a>(text: &'a str, from: &str, to: &str) -> &'a str {
    text.split_once(from).unwrap_or_else(|| panic!("no {from}")).1.split_once(to).unwrap_or_else(|| panic!("no {to}")).0
}

pub fn row_value(html: &str, outcome: &Outcome, name: &str) -> String {
    let row = between(html, &format!("<tr id=\"cell-{}\"", outcome.key.short()), "</tr>");
    between(row, &format!("<data class=\"{name}\" value=\""), "\"").to_owned()
}

/// Leaves the page where a person can look at it.
pub fn keep(name: &str, html: &str) {
    std::fs::write(std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name), html).unwrap();
}
