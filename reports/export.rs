//! A run's figures as files of their own, and its numbers as tables of a thesis.

use crate::arrange::arrange;
use crate::chart::Chart;
use crate::figures::{self, Figure};
use crate::input::{ReportError, ReportInput};
use crate::palette::Tones;
use crate::table::{self, Datum, Table};
use crate::template::Templates;
use crate::wording;
use polars::prelude::{DataFrame, PolarsResult};

/// A figure of the page as files: its charts, its words and its numbers.
#[derive(Debug, Clone)]
pub struct FigureFiles {
    /// A file name without an ending: letters, digits and hyphens.
    pub name: String,
    /// The figure's number on the page, its title, its caption, and the command that makes it.
    pub caption: String,
    /// Name (as above) and SVG of each chart; an SVG stands alone, in the light page's colours.
    pub charts: Vec<(String, String)>,
    data: crate::data::Data,
}

impl FigureFiles {
    /// The numbers drawn, as RFC 4180 has it, all digits kept.
    pub fn csv(&self) -> String {
        self.data.csv()
    }

    /// The numbers drawn, as a frame.
    ///
    /// # Errors
    /// What polars says of columns that do not fit together, which would be a fault of furrow.
    pub fn frame(&self) -> PolarsResult<DataFrame> {
        self.data.frame()
    }
}

/// Every figure of the page that [`page`](crate::page()) draws, in its order.
///
/// # Errors
/// As for the page.
pub fn figure_files(input: &ReportInput) -> Result<Vec<FigureFiles>, ReportError> {
    let settings = arrange(&input.cells)?;
    let templates = Templates::new()?;
    let drawn = figures::of_page(input, &settings, &Tones::of_settings(&settings))?;
    drawn.into_iter().enumerate().map(|(i, figure)| files(i + 1, figure, &templates, &input.command)).collect()
}

fn files(number: usize, figure: Figure, templates: &Templates, command: &str) -> Result<FigureFiles, ReportError> {
    let more = figure.more.iter().flat_map(|(_, charts)| charts);
    let chart = |chart: &Chart| Ok((chart.id.clone(), alone(&templates.chart(chart)?)));
    Ok(FigureFiles {
        name: figure.id.trim_end_matches("-figure").to_owned(),
        caption: format!(
            "Figure {number}. {}\n\n{}\n\nMade by: {} --figures svg\n",
            figure.title,
            figure.caption,
            wording::shown(command)
        ),
        charts: figure.panels.iter().chain(more).map(chart).collect::<Result<_, ReportError>>()?,
        data: figure.data,
    })
}

/// The page's system font becomes fonts that drawing programs find by name.
fn alone(svg: &str) -> String {
    let fonts = "font-family=\"'Liberation Sans', 'DejaVu Sans', Arial, Helvetica, sans-serif\"";
    let page = "font-family=\"system-ui, -apple-system, 'Segoe UI', 'Liberation Sans', Arial, sans-serif\"";
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}\n", svg.replacen(page, fonts, 1).trim_start())
}

/// What a thesis' table has room for, of the page's columns.
const COLUMNS: [&str; 10] = [
    "frames",
    "good",
    "percent_good",
    "lost_fraction",
    "max_lost_m",
    "correct",
    "wrong",
    "precision",
    "recall",
    "average_precision",
];

/// The numbers of every cell and the contrasts as LaTeX tables (booktabs, longtable), names escaped.
///
/// # Errors
/// As for the page.
pub fn latex(input: &ReportInput) -> Result<String, ReportError> {
    let mut text = format!(
        "% Run {} by furrow {}. In the preamble: \\usepackage{{booktabs,longtable}}; names beyond Latin letters need LuaLaTeX or XeLaTeX.\n",
        input.run,
        wording::shown(&input.furrow_version)
    );
    for (i, table) in table::of_settings(&arrange(&input.cells)?).iter().enumerate() {
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
        "Every cell of \\emph{{{}}}{title}. Lost is the share of the route driven lost; longest lost in metres. Counts of single passes.",
        escaped(&wording::shown(&input.matrix_name))
    );
    longtable(&caption, &format!("tab:cells-{index}"), words, &head, rows.collect())
}

fn contrasts_table(input: &ReportInput) -> String {
    let head = ["contender", "over", "live", "right", "good", "lost", "lost-distance area"].map(str::to_owned);
    let found = crate::contrasts::table(&input.contrasts);
    let rows = found.iter().flat_map(|table| &table.rows).map(|row| {
        let numbers = row.numbers.iter().map(|number| match number {
            Some(n) => escaped(&format!("{} ({}), {}", n.text, n.interval, n.verdict)),
            None => "--".to_owned(),
        });
        [&row.of, &row.over, &row.live].into_iter().map(|text| escaped(text)).chain(numbers).collect()
    });
    let caption = "Differences between contenders on the same live frames, with their 95\\,\\% paired bootstrap intervals. \
        Of localisations more is better, of lost road less.";
    longtable(caption, "tab:contrasts", 3, &head, rows.collect())
}

/// A table that may run over pages; the first `words` columns are to the left.
fn longtable(caption: &str, label: &str, words: usize, head: &[String], rows: Vec<Vec<String>>) -> String {
    let columns = "l".repeat(words) + &"r".repeat(head.len().saturating_sub(words));
    let head = head.join(" & ");
    let body: String = rows.iter().map(|row| format!("{} \\\\\n", row.join(" & "))).collect();
    format!(
        "\\begin{{longtable}}{{{columns}}}\n\\caption{{{caption}}}\\label{{{label}}}\\\\\n\\toprule\n{head} \\\\\n\\midrule\n\\endfirsthead\n\
         \\toprule\n{head} \\\\\n\\midrule\n\\endhead\n\\bottomrule\n\\endfoot\n{body}\\end{{longtable}}\n"
    )
}

/// A text that LaTeX sets as it is.
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
