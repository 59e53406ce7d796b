//! An image in the form that training and generators work on, and the memory for it.

use crate::GenerateError;
use crate::bands::Pyramid;
use crate::cells::Stretches;
use crate::colour::{Tables, opponent, tables};
use furrow_model::ColourImage;
use furrow_model::widest;

/// An image in log-opponent colours and at four scales. Its memory is used again.
#[derive(Debug, Default)]
pub struct Planes {
    pub(crate) width: usize,
    pub(crate) l: Vec<f32>,
    pub(crate) o1: Vec<f32>,
    pub(crate) o2: Vec<f32>,
    pub(crate) pyramid: Pyramid,
    pub(crate) stretches: Stretches,
    pub(crate) lift: Vec<f32>,
}

impl Planes {
    /// Takes an image whose pixels fill its size.
    pub(crate) fn fill(&mut self, image: &ColourImage) {
        self.width = image.width;
        for plane in [&mut self.l, &mut self.o1, &mut self.o2] {
            plane.resize(image.width * image.height, 0.0);
        }
        split(tables(), &image.rgb, &mut self.l, &mut self.o1, &mut self.o2);
        self.pyramid.of(&self.l, image.width);
        self.stretches.fit(image.width);
    }
}

widest!(fn split(tables: &Tables, rgb: &[u8], l: &mut [f32], o1: &mut [f32], o2: &mut [f32]) -> () = split_anywhere);

#[inline(always)]
fn split_anywhere(tables: &Tables, rgb: &[u8], l: &mut [f32], o1: &mut [f32], o2: &mut [f32]) {
    let planes = l.iter_mut().zip(o1).zip(o2);
    for (pixel, ((l, o1), o2)) in rgb.as_chunks::<3>().0.iter().zip(planes) {
        [*l, *o1, *o2] = opponent(pixel.map(|level| tables.log[usize::from(level)]));
    }
}

/// Memory of one worker, used again from image to image.
#[derive(Debug, Default)]
pub struct Workspace {
    planes: Planes,
}

impl Workspace {
    /// An image in log-opponent colours and scales.
    pub(crate) fn planes_of(&mut self, image: &ColourImage) -> Result<&mut Planes, GenerateError> {
        check_size(image)?;
        self.planes.fill(image);
        Ok(&mut self.planes)
    }
}

/// Whether the pixels fill the image.
pub(crate) fn check_size(image: &ColourImage) -> Result<(), GenerateError> {
    let (width, height, values) = (image.width, image.height, image.rgb.len());
    if values == 0 || width.checked_mul(height).and_then(|pixels| pixels.checked_mul(3)) != Some(values) {
        return Err(GenerateError::Size { width, height, values });
    }
    Ok(())
}
