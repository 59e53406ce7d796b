//! minijinja, set up once: every value is escaped, and a name that does not exist is an error.

use crate::chart::Chart;
use crate::input::ReportError;
use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, UndefinedBehavior};
use serde::Serialize;

const TEMPLATES: [(&str, &str); 7] = [
    ("claims.html", include_str!("templates/claims.html")),
    ("page.html", include_str!("templates/page.html")),
    ("summary.html", include_str!("templates/summary.html")),
    ("lineage.html", include_str!("templates/lineage.html")),
    ("page.css", include_str!("templates/page.css")),
    ("chart.svg", include_str!("templates/chart.svg")),
    ("tile.svg", include_str!("templates/tile.svg")),
];

/// The crate's templates.
pub(crate) struct Templates(Environment<'static>);

#[derive(Serialize)]
struct ChartContext<'a> {
    c: &'a Chart,
}

impl Templates {
    pub fn new() -> Result<Self, ReportError> {
        let mut environment = Environment::new();
        environment.set_auto_escape_callback(|_| AutoEscape::Html);
        environment.set_undefined_behavior(UndefinedBehavior::Strict);
        for (name, source) in TEMPLATES {
            environment.add_template(name, source)?;
        }
        Ok(Self(environment))
    }

    /// A chart as an SVG element that also stands alone in a file.
    pub fn chart(&self, chart: &Chart) -> Result<String, ReportError> {
        self.render("chart.svg", ChartContext { c: chart })
    }

    /// The whole page.
    pub fn page(&self, view: impl Serialize) -> Result<String, ReportError> {
        self.render("page.html", view)
    }

    /// The page of claims.
    pub fn claims(&self, view: impl Serialize) -> Result<String, ReportError> {
        self.render("claims.html", view)
    }

    fn render(&self, name: &str, context: impl Serialize) -> Result<String, ReportError> {
        Ok(self.0.get_template(name)?.render(Serde(context))?)
    }
}
