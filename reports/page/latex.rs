//! A run's numbers as LaTeX tables.

use super::cells::{self, Table};
use super::contrasts;
use super::datum::Datum;
use crate::error::ReportError;
use crate::figures::arrange::arrange;
use crate::input::ReportInput;
use crate::wording;

/// What a thesis' table has room for, of the page's columns.
const COLUMNS: [&str; 11] = [
    "frames",
    "good",
    "percent_of_frames",
    "percent_good",
    "lost_fraction",
    "max_lost_m",
    "correct",
    "wrong",
    "precision",
    "recall",
    "average_precision",
];

/// The numbers of every cell and the contrasts as LaTeX tables (booktabs, longtable); names are escaped.
///
/// # Errors
/// As for the page.
pub fn latex(input: &ReportInput) -> Result<String, ReportError> {
    let mut text = format!(
        "% Run {} by furrow {}. In the preamble: \\usepackage{{booktabs,longtable}}; \
         names beyond Latin letters need LuaLaTeX or XeLaTeX.\n",
        input.run,
        wording::shown(&input.furrow_version)
    );
    for (i, table) in cells::tables(&arrange(&input.cells)?).iter().enumerate() {
        text.push_str(&cells_table(table, i, input));
    }
    if !input.contrasts.found.is_empty() {
        text.push_str(&contrasts_table(input));
    }
    Ok(text)
}

fn cells_table(table: &Table, index: usize, input: &ReportInput) -> String {
    let kept = |numbers: &[Datum]| -> Vec<usize> {
        (0..numbers.len()).filter(|i| COLUMNS.contains(&numbers[*i].name)).collect()
    };
    let columns = table.rows.first().map(|row| kept(&row.numbers)).unwrap_or_default();
    let headings = columns.iter().map(|i| escaped(table.headings[*i].text));
    let words = if table.by_setting { 3 } else { 2 };
    let named = ["setting", "live", "experience"].into_iter().skip(3 - words).map(str::to_owned);
    let head: Vec<String> = named.chain(headings).collect();
    let rows = table.rows.iter().map(|row| {
        let numbers = columns.iter().map(|i| escaped(&row.numbers[*i].text));
        let names = [&row.setting, &row.live, &row.experience].into_iter().skip(3 - words).map(|name| escaped(name));
        names.chain(numbers).collect()
    });
    let title = if table.title.is_empty() { String::new() } else { format!(" ({})", escaped(&table.title)) };
    let caption = format!(
        "Every cell of \\emph{{{}}}{title}. Lost is the fraction of the route travelled while lost; longest lost in \
         metres. Counts of single traversals.",
        escaped(&wording::shown(&input.matrix_name))
    );
    longtable(&caption, &format!("tab:cells-{index}"), words, &head, rows.collect())
}

fn contrasts_table(input: &ReportInput) -> String {
    let head = ["contender", "over", "live", "right", "good", "lost", "lost-distance area"].map(str::to_owned);
    let found = contrasts::table(&input.contrasts);
    let rows = found.iter().flat_map(|table| &table.rows).map(|row| {
        let numbers = row.numbers.iter().map(|number| match number {
            Some(n) if n.interval.is_empty() => escaped(&format!("{}, {}", n.text, n.verdict)),
            Some(n) => escaped(&format!("{} ({}), {}, {}", n.text, n.interval, n.verdict, n.chances.join(", "))),
            None => "--".to_owned(),
        });
        [&row.of, &row.over, &row.live].into_iter().map(|text| escaped(text)).chain(numbers).collect()
    });
    let caption = "Differences between contenders on the same live frames, with their 95\\,\\% intervals by Student's t, p, and \
        p corrected for the number of contrasts (Holm). More localisations are better, less lost distance is better.";
    longtable(caption, "tab:contrasts", 3, &head, rows.collect())
}

/// A table that may run over pages; the first `words` columns are to the left.
fn longtable(caption: &str, label: &str, words: usize, head: &[String], rows: Vec<Vec<String>>) -> String {
    let columns = "l".repeat(words) + &"r".repeat(head.len().saturating_sub(words));
    let head = head.join(" & ");
    let body: String = rows.iter().map(|row| format!("{} \\\\\n", row.join(" & "))).collect();
    format!(
        "\\begin{{longtable}}{{{columns}}}\n\\caption{{{caption}}}\\label{{{label}}}\\\\\n\
         \\toprule\n{head} \\\\\n\\midrule\n\\endfirsthead\n\
         \\toprule\n{head} \\\\\n\\midrule\n\\endhead\n\\bottomrule\n\\endfoot\n{body}\\end{{longtable}}\n"
    )
}

/// A text, escaped for LaTeX.
fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => {
                safe.push('\\');
                safe.push(c);
            }
            '\\' => safe.push_str("\\textbackslash{}"),
            '~' => safe.push_str("\\textasciitilde{}"),
            '^' => safe.push_str("\\textasciicircum{}"),
            '<' => safe.push_str("\\textless{}"),
            '>' => safe.push_str("\\textgreater{}"),
            '|' => safe.push_str("\\textbar{}"),
            '"' => safe.push_str("{\\char34}"),
            '\u{2212}' => safe.push_str("$-$"),
            '\u{202f}' => safe.push_str("\\,"),
            '–' => safe.push_str("--"),
            '\u{fffd}' => safe.push('?'),
            c => safe.push(c),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::escaped;

    #[test]
    fn no_name_is_a_command_of_latex() {
        assert_eq!(
            escaped("\\input{x} 50% $a_b$ ~^ #1 & <b>|\""),
            "\\textbackslash{}input\\{x\\} 50\\% \\$a\\_b\\$ \\textasciitilde{}\\textasciicircum{} \\#1 \\& \
             \\textless{}b\\textgreater{}\\textbar{}{\\char34}"
        );
    }
}
