//! Datasets of others: a profile, which is a TOML file, tells where images, stamps, calibration and true poses lie
//! below a folder and how they are written. What it tells is found here and checked; nothing is stored, no pixel is
//! moved.
//!
//! In the order of the work:
//! - [`profile`], [`profile_world`]: the keys of such a file; [`builtin`]: the files that furrow brings, in
//!   `profiles/`; `check`: what no file may ask;
//! - `paths`: files below the folder, and nothing outside it; `table`: rows of numbers; `stamps`: moments in any unit;
//! - `images`, `calibration`, `truth`, `truth_rows`, `sensors`: one part of a profile each; `utm`, `posture`:
//!   positions and orientations in the world with x east, y north, z up;
//! - `layout`, `layout_parts`: all of it together, as an ingest takes it; `recording`: bags that belong together;
//! - [`vpr`]: the names that sets for place recognition give their images.

pub mod builtin;
mod calibration;
mod check;
mod error;
mod images;
mod layout;
mod layout_parts;
mod paths;
mod posture;
pub mod profile;
mod profile_unit;
pub mod profile_world;
mod recording;
mod sensors;
mod stamps;
mod table;
mod truth;
mod truth_rows;
mod utm;
pub mod vpr;

pub use builtin::find_profile;
pub use error::ImportError;
pub use layout::{Layout, LayoutImages, LayoutSide, resolve_layout};
pub use profile::Profile;
pub use recording::{RecordingFiles, resolve_recording};
pub use sensors::SensorSeries;
pub use truth::{ImportedTruth, tum_text};
pub use utm::{Utm, utm_of};
