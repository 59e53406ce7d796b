use crate::choosing::choose_experience;
use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::{print, print_json};
use crate::views::generators::{gate_json, gate_text, generator_json, generator_line, read_gates};
use furrow_catalog::records::GeneratorRecord;
use furrow_catalog::{Catalog, write_file};
use furrow_runner::generation;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Show a generator: what it was trained on, and what the quality gate measured.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow generator show 'otf:10:00>16:00'\n  \
furrow generator show 'otf:10:00>16:00' --sheet sheet.jpg --of 3fa8 --z 0,0.5,1")]
pub struct ShowGenerator {
    /// Its name, or the beginning of its id.
    name: String,
    /// Write a contact sheet: images of rising domainness between real ones of the source and target slots.
    #[arg(long, value_name = "FILE.jpg")]
    sheet: Option<PathBuf>,
    /// The experience on the sheet, by the beginning of its id. [default: the generator's own training images]
    #[arg(long, requires = "sheet", value_name = "EXPERIENCE")]
    of: Option<String>,
    /// The domainnesses on the sheet.
    #[arg(
        long,
        value_delimiter = ',',
        default_value = "0,0.33,0.66,1,1.5",
        requires = "sheet",
        value_name = "Z,Z,..."
    )]
    z: Vec<f64>,
}

impl ShowGenerator {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let (id, record) = generation::find_generator(&catalog, &self.name)?;
        let gates = read_gates(&catalog, id, |_| true)?;
        if let Some(file) = &self.sheet {
            self.write_sheet(&catalog, &record, file)?;
        }
        if context.json {
            let mut shown = generator_json(id, &record);
            shown["parameters"] = json!(record.parameters);
            shown["training"] = json!({ "source": record.source, "target": record.target });
            shown["gates"] = gates.iter().map(|(parent, curve)| gate_json(parent, curve)).collect();
            print_json(&shown)?;
        } else {
            let mut text = generator_line(id, &record);
            for (parent, curve) in &gates {
                text += &gate_text(&parent.short(), curve);
            }
            if gates.is_empty() {
                text += "not measured yet: `furrow generate` measures it\n";
            }
            print(&text)?;
        }
        Ok(Ending::Done)
    }

    fn write_sheet(&self, catalog: &Catalog, record: &GeneratorRecord, file: &Path) -> Result<(), Failure> {
        let of = match &self.of {
            Some(typed) => Some(catalog.experience(choose_experience(catalog, typed)?)?),
            None => None,
        };
        write_file(file, &generation::contact_sheet(catalog, record, of.as_ref(), &self.z)?)?;
        eprintln!("contact sheet: {}", file.display());
        Ok(())
    }
}
