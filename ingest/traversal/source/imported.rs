//! A dataset of loose images, laid out by a profile, as a source.

use super::image_source::{ImageSource, Item};
use crate::import::{Layout, LayoutImages, LayoutSide};
use crate::traversal::error::IngestError;
use crate::traversal::notes::Notes;
use crate::traversal::picture::Picture;
use crate::traversal::request::IngestRequest;
use crate::traversal::sensors::SensorRow;
use furrow_catalog::images::Side;
use furrow_catalog::records::{Cameras, ViewsRecord};
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A dataset of loose images.
pub(super) struct ImportedSource {
    layout: Arc<Layout>,
}

impl ImportedSource {
    /// The layout's images; what was unusual about it is noted.
    pub(super) fn new(layout: Arc<Layout>, notes: &Notes) -> Self {
        layout.notes.iter().for_each(|note| notes.add(note));
        Self { layout }
    }

    fn side(&self, side: Side) -> &LayoutSide {
        if side == Side::Left { &self.layout.left } else { &self.layout.right }
    }

    fn picture(&self, side: Side, path: &Path) -> Result<Picture, IngestError> {
        let bytes = fs::read(path).map_err(IngestError::file(path))?;
        let LayoutSide { bayer, table } = self.side(side);
        Ok(match table {
            Some(table) => Picture::Distorted { bytes, bayer: *bayer, table: Arc::clone(table) },
            None => Picture::Compressed(bytes),
        })
    }
}

impl ImageSource for ImportedSource {
    fn path(&self) -> &Path {
        &self.layout.root
    }

    fn left_name(&self) -> String {
        match &self.layout.cameras {
            Cameras::Pair(_) => format!("{}, left", self.layout.profile),
            Cameras::Single(_) => self.layout.profile.clone(),
        }
    }

    fn right_name(&self) -> Option<String> {
        matches!(self.layout.cameras, Cameras::Pair(_)).then(|| format!("{}, right", self.layout.profile))
    }

    fn file_of(&self, side: Side, stamp_ns: i64) -> PathBuf {
        let file = match (&self.layout.images, side) {
            (LayoutImages::Single(images), _) => {
                images.iter().find(|image| image.stamp_ns == stamp_ns).map(|image| &image.path)
            }
            (LayoutImages::Pairs(pairs, _), Side::Left) => {
                pairs.iter().find(|pair| pair.stamp_ns == stamp_ns).map(|pair| &pair.left)
            }
            (LayoutImages::Pairs(pairs, _), Side::Right) => {
                pairs.iter().find(|pair| pair.right_stamp_ns == stamp_ns).map(|pair| &pair.right)
            }
        };
        file.unwrap_or(&self.layout.root).clone()
    }

    fn calibrate(&self, _request: &IngestRequest, _notes: &Notes) -> Result<ViewsRecord, IngestError> {
        // What a table undistorts is stored in colour.
        let mosaic = |side: &LayoutSide| if side.table.is_some() { None } else { side.bayer };
        Ok(ViewsRecord {
            calibration: self.layout.cameras.clone(),
            left_bayer: mosaic(&self.layout.left),
            right_bayer: mosaic(&self.layout.right),
        })
    }

    /// Other sensors first, then the images in order, those without a partner last.
    fn stream(
        &self,
        progress: &mut dyn FnMut(u64, u64),
        each: &mut dyn FnMut(Item) -> Result<ControlFlow<()>, IngestError>,
    ) -> Result<(), IngestError> {
        for series in &self.layout.sensors {
            let imu = series.imu.iter().map(|(stamp_ns, values)| SensorRow::imu_of_table(*stamp_ns, values));
            let fixes = series.fixes.iter().map(|(stamp_ns, values)| SensorRow::fix_of_table(*stamp_ns, values));
            for row in imu.chain(fixes) {
                if each(Item::Sensor { topic: series.name.clone(), row })?.is_break() {
                    return Ok(());
                }
            }
        }
        let mut hand_over = |side, pair_ns, stamp_ns, path: &Path| {
            each(Item::Image { side, pair_ns, stamp_ns, receive_ns: None, picture: self.picture(side, path)? })
        };
        match &self.layout.images {
            LayoutImages::Single(images) => {
                for (i, image) in images.iter().enumerate() {
                    if hand_over(Side::Left, image.stamp_ns, image.stamp_ns, &image.path)?.is_break() {
                        return Ok(());
                    }
                    progress(i as u64 + 1, images.len() as u64);
                }
            }
            LayoutImages::Pairs(pairs, unpaired) => {
                for (i, pair) in pairs.iter().enumerate() {
                    let left = hand_over(Side::Left, pair.stamp_ns, pair.stamp_ns, &pair.left)?;
                    if left.is_break()
                        || hand_over(Side::Right, pair.stamp_ns, pair.right_stamp_ns, &pair.right)?.is_break()
                    {
                        return Ok(());
                    }
                    progress(i as u64 + 1, pairs.len() as u64);
                }
                for image in unpaired {
                    if hand_over(image.side, image.stamp_ns, image.stamp_ns, &image.path)?.is_break() {
                        return Ok(());
                    }
                }
            }
        }
        Ok(())
    }
}
