//! Worlds: the ground and what stands on it, site by site, the same in every traversal of a route but for litter and
//! weeds. Nothing here knows the camera.

pub mod backsburg;
pub mod build;
pub mod layout;
pub mod lindenhof;
pub mod litter;
pub mod old_zoo;
pub mod plan;
pub mod plants;
pub mod route;
pub mod scene;
pub mod structures;
pub mod terrain;

pub use build::{World, build};
pub use plan::{Net, Plan};
