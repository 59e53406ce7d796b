//! ROS1 bags, format 2.0 (<http://wiki.ros.org/Bags/Format/2.0>): the walk over a bag's structure and the decoding of
//! its chunks, within bounds. Nothing outside this folder knows the format.

mod bag;
mod decode;
mod record;
mod walk;

pub(crate) use bag::{Bag, MAGIC};
