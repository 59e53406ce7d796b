//! Where images come from: a recording's topics, a folder of stereo pairs, a folder of a single camera's images, or a
//! dataset that a profile lays out.
//! Sources read; they neither store anything nor compute with pixels.

mod camera_infos;
mod first_images;
mod image_message;
mod image_source;
mod imported;
mod info_watch;
mod open;
mod recording;
mod single_folder;
mod stereo_folder;

pub(crate) use image_source::{ImageSource, Item};
pub(crate) use open::open_source;
