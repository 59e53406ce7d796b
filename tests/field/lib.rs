//! The simulated field: worlds that stay as they are, light that follows the sun, a camera with a camera's faults, and ground truth.
//!
//! A [`Pass`] says what is driven; [`record`](mod@record) writes it as a robot would have recorded it, [`simulate`](fn@simulate) hands out its frames.
//! A tour, in the way of the data:
//! - [`pass`]: site, route, slot, date, weather, seed, camera; the world depends on site and route alone, all else on the drive;
//! - [`sun`] and [`sky`]: where the sun stands, and the light of sun, sky, clouds and headlights;
//! - [`texture`]: leaves, grass, bark, stones, walls and soils, painted from fixed seeds;
//! - [`route`], [`terrain`], [`scene`], [`plants`], [`litter`], [`structures`], [`world`]: the line driven, the ground, and what stands on it, site by site;
//! - [`drive`]: where the left camera is at any time;
//! - [`render`]: facets to radiance; [`camera`]: radiance to eight bits;
//! - [`mod@simulate`]: frame by frame; [`mod@record`]: MCAP and ROS 1 bags, ground truth beside them;
//! - [`campaign`]: many passes out of one file.
//!
//! World axes are x east, y north, z up; camera axes x right, y down, z forward; metres, seconds, radians where not named otherwise.
//! Equal passes give equal bytes on any number of threads and any x86-64 machine: chance is hashed, functions beyond square roots
//! come from `libm`, and nothing depends on the order in which threads finish.

pub mod camera;
pub mod campaign;
pub mod chance;
pub mod drive;
pub mod lanes;
pub mod litter;
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

pub use camera::settings::CameraSettings;
pub use campaign::{Campaign, CampaignError, Planned};
pub use pass::check::BadPass;
pub use pass::{BadName, Date, Pass, Site, Weather};
pub use record::{RecordError, Summary, record};
pub use simulate::{Frame, Outing, simulate};
