//! The simulated field.

pub mod camera;
pub mod chance;
pub mod drive;
pub mod pass;
pub mod plants;
pub mod record;
pub mod render;
pub mod route;
pub mod scene;
pub mod simulate;
pub mod sky;
pub mod structures;
pub mod sun;
pub mod terrain;
pub mod texture;
pub mod vector;
pub mod world;

pub use pass::{BadName, Date, Pass, Site, Weather};
pub use record::{RecordError, Summary, record};
pub use simulate::{BadPass, Frame, Outing, simulate};
