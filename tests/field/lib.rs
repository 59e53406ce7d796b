//! The simulated field: worlds that stay as they are, light that follows the sun, a camera with a camera's faults, and
//! ground truth.
//!
//! A [`Traversal`] says what is simulated; [`record`](mod@record) writes it as a robot would have recorded it,
//! [`simulate`](fn@simulate) hands out its frames. A tour, in the way of the data:
//! - [`traversal`]: site, route, slot, date, weather, seed, camera; the world depends on site and route alone;
//! - [`sun`] and [`sky`]: where the sun stands, and the light of sun, sky, clouds and headlights;
//! - [`texture`]: leaves, grass, bark, stones, walls and soils, painted from fixed seeds;
//! - [`world`]: the route's line, the ground, and what stands on it, site by site;
//! - [`robot`]: where the left camera is at any time;
//! - [`render`]: facets to radiance; [`camera`]: radiance to eight bits;
//! - [`simulation`]: frame by frame; [`mod@record`]: MCAP and ROS 1 bags, ground truth beside them;
//! - [`campaign`]: many traversals out of one file.
//!
//! World axes are x east, y north, z up; camera axes x right, y down, z forward; metres, seconds, radians where not
//! named otherwise. Equal traversals give equal bytes on any number of threads and any x86-64 machine: chance is
//! hashed, functions beyond square roots come from `libm`, and nothing depends on the order in which threads finish.

pub mod camera;
pub mod campaign;
pub mod chance;
pub mod lanes;
pub mod record;
pub mod render;
pub mod robot;
pub mod simulation;
pub mod sky;
pub mod sun;
pub mod texture;
pub mod traversal;
pub mod vector;
pub mod world;

pub use camera::settings::CameraSettings;
pub use campaign::{Campaign, CampaignError, Planned};
pub use record::{RecordError, Summary, record};
pub use simulation::{Frame, Simulation, simulate};
pub use traversal::{BadName, BadTraversal, Date, Site, Traversal, Weather};
