//! Generated experiences (thesis 5.4, Fig 5.9): a recorded experience's left images moved to another time of day, on
//! its own chain and with its own timestamps. A tour, in the order of the work:
//! - [`training`]: two slots' images become a generator;
//! - [`registry`]: finds generators by name; the built-in ones are declared in [`furrow_generator::kinds`];
//! - [`translator`], [`adding`]: generators of other programs, by `translator.json`, and how they enter the store;
//! - [`painter`]: a generator ready to paint, whatever it is: built in, a `command`, or an `onnx` model;
//! - [`relighting`]: the sun, the compass and the right images that relighting needs;
//! - [`making`]: the whole procedure: a parent, a generator and a domainness become an experience, image by image;
//! - `stage`: all that a run needs of these;
//! - [`gate`]: the quality gate, which measures a generator before anyone localises with it;
//! - [`sheet`]: contact sheets, for the eye.
//!
//! A generated image is remembered under all that determines it, so a killed generation goes on where it was.
//! Reads the store and writes objects and rows of generators; knows no plan and no stage.

pub mod adding;
mod command;
mod compass;
pub mod gate;
pub(crate) mod images;
pub mod making;
mod onnx;
pub mod painter;
pub mod registry;
pub mod relighting;
pub mod sheet;
pub(crate) mod stage;
mod sun;
pub mod training;
pub mod translator;

pub use crate::inputs::making::{Generated, Request};
pub use making::generate;
pub(crate) use registry::own_files;
pub use registry::{find_generator, mimicked_slot, named_examples, register_named};
pub use sheet::contact_sheet;
pub use training::{TrainingRequest, train};
