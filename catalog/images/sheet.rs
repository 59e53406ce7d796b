//! Contact sheets: rows of pictures under their titles.

use crate::images::{ColourImage, ImageError, Picture, encode_jpeg, resize::resized, threads::single_threaded};
use opencv::core::{Mat, Point, Scalar, Vec3b};
use opencv::imgproc;

/// A row of a sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct SheetRow {
    /// What stands above it.
    pub title: String,
    /// Its pictures.
    pub pictures: Vec<ColourImage>,
}

/// Columns of a picture, and rows of a title.
const TILE_WIDTH: usize = 320;
const TITLE: usize = 22;
const GAP: usize = 4;
const PAPER: u8 = 250;

/// A sheet of rows as JPEG; pictures are scaled to one width.
///
/// # Errors
/// No picture at all, pictures that do not fill their size, and failures of OpenCV.
pub fn contact_sheet(rows: &[SheetRow], quality: u8) -> Result<Vec<u8>, ImageError> {
    single_threaded();
    let height_of = |picture: &ColourImage| (picture.height * TILE_WIDTH / picture.width.max(1)).max(1);
    let tile_height = rows.iter().flat_map(|row| &row.pictures).map(height_of).max().unwrap_or(0);
    let columns = rows.iter().map(|row| row.pictures.len()).max().unwrap_or(0);
    let (width, height) = (columns * (TILE_WIDTH + GAP) + GAP, rows.len() * (TITLE + tile_height + GAP));
    crate::images::header::check_size(columns * tile_height, height)?;
    let mut sheet = ColourImage { width, height, rgb: vec![PAPER; 3 * width * height] };
    for (i, row) in rows.iter().enumerate() {
        let top = i * (TITLE + tile_height + GAP);
        for (j, picture) in row.pictures.iter().enumerate() {
            let tile = resized(picture, TILE_WIDTH, height_of(picture))?;
            paste(&tile, &mut sheet, GAP + j * (TILE_WIDTH + GAP), top + TITLE);
        }
        write(&row.title, &mut sheet, top).map_err(|source| ImageError::OpenCv { doing: "write a title", source })?;
    }
    encode_jpeg(Picture::Colour(&sheet), width, quality)
}

fn paste(tile: &ColourImage, sheet: &mut ColourImage, left: usize, top: usize) {
    for (y, row) in tile.rgb.chunks_exact(3 * tile.width).enumerate() {
        let at = 3 * ((top + y) * sheet.width + left);
        sheet.rgb[at..at + row.len()].copy_from_slice(row);
    }
}

fn write(title: &str, sheet: &mut ColourImage, top: usize) -> opencv::Result<()> {
    let (width, height) = (sheet.width as i32, sheet.height as i32);
    let mut paper = Mat::new_rows_cols_with_bytes_mut::<Vec3b>(height, width, &mut sheet.rgb)?;
    let (at, ink) = (Point::new(GAP as i32, (top + TITLE - 6) as i32), Scalar::new(30.0, 30.0, 30.0, 0.0));
    imgproc::put_text(&mut paper, title, at, imgproc::FONT_HERSHEY_SIMPLEX, 0.5, ink, 1, imgproc::LINE_AA, false)
}
