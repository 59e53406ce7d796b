use crate::choosing::choose_places;
use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::print_json;
use clap::{Args, ValueEnum};
use furrow_runner::export::places::export_places;
use std::path::PathBuf;

/// Write the images of experiences and traversals as a set for visual place recognition.
///
/// An experience gives its nodes, a traversal every frame: the left images as stored, JPEG for JPEG, others encoded.
/// Names are @UTM_east@UTM_north@…@.jpg. Positions are the true ones; without them, the chain's. images.txt lists the
/// images' ids, so that a matrix finds the descriptors that VPR-methods-evaluation saves (localiser.descriptors =
/// \"DIR\").
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  furrow export images 3fa8 --form vpr -o vpr/database\n  \
furrow export images 77c1 --form vpr -o vpr/queries\n  \
python3 main.py --database_folder=vpr/database --queries_folder=vpr/queries --save_descriptors   # VPR-methods-evaluation")]
pub struct ExportImages {
    /// Experiences or traversals, by the beginnings of their ids.
    #[arg(required = true, value_name = "EXPERIENCE")]
    wanted: Vec<String>,
    /// The form of the names.
    #[arg(long, value_enum, default_value = "vpr")]
    form: Form,
    /// The folder to write, which must not be there yet.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
}

/// A form of names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Form {
    /// `@UTM_east@UTM_north@zone@letter@latitude@longitude@pano_id@tile@heading@pitch@roll@height@timestamp@note@.jpg`.
    Vpr,
}

impl ExportImages {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let Form::Vpr = self.form;
        let catalog = context.catalog()?;
        let wanted = self.wanted.iter().map(|typed| choose_places(&catalog, typed)).collect::<Result<Vec<_>, _>>()?;
        let done = export_places(&catalog, &wanted, &self.output)?;
        if context.json {
            print_json(&serde_json::json!({
                "folder": self.output,
                "images": done.images,
                "encoded": done.encoded,
                "without_position": done.without_position,
                "positions": done.positions,
            }))?;
        } else {
            eprintln!("{}: {} images, placed by {}", self.output.display(), done.images, done.positions.join("; "));
            if done.without_position > 0 {
                eprintln!("  {} images have no true position and were left out", done.without_position);
            }
        }
        Ok(Ending::Done)
    }
}
