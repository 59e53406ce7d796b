//! What is drawn over images: inliers where they are and where the other image has them, and the decision in words.

use super::message::{BLUE, ORANGE, SHADE, WHITE, stamp};
use crate::RunError;
use foxglove::messages::points_annotation::Type;
use foxglove::messages::{Color, ImageAnnotations, Point2, PointsAnnotation, TextAnnotation};

/// Text and points are this share of the image's height large.
const TEXT_SHARE: f64 = 0.04;
const POINT_SHARE: f64 = 0.008;

/// Inliers over one image.
pub(super) struct Drawing<'a> {
    pub stamp_ns: i64,
    /// Rows of the image.
    pub height: u32,
    /// Each inlier here and in the other image, in pixels of either.
    pub inliers: Vec<(Point2, Point2)>,
    pub colour: Color,
    pub text: &'a str,
}

impl Drawing<'_> {
    /// A point at each inlier, a line from there to where the other image has it, and a line of text on top.
    pub fn annotations(&self) -> Result<ImageAnnotations, RunError> {
        let timestamp = Some(stamp(self.stamp_ns)?);
        let height = f64::from(self.height);
        let marks = |kind: Type, points: Vec<Point2>, colour: Color, thickness: f64| PointsAnnotation {
            timestamp,
            r#type: kind as i32,
            points,
            outline_color: Some(colour),
            fill_color: Some(colour),
            thickness,
            ..PointsAnnotation::default()
        };
        let mut points = Vec::new();
        if !self.inliers.is_empty() {
            let ends = self.inliers.iter().flat_map(|(here, there)| [*here, *there]).collect();
            points.push(marks(Type::LineList, ends, WHITE, 1.0));
            let here = self.inliers.iter().map(|(here, _)| *here).collect();
            points.push(marks(Type::Points, here, self.colour, (POINT_SHARE * height).max(2.0)));
        }
        let font_size = (TEXT_SHARE * height).max(10.0);
        let text = TextAnnotation {
            timestamp,
            position: Some(Point2 { x: font_size / 2.0, y: 1.5 * font_size }),
            text: self.text.to_owned(),
            font_size,
            text_color: Some(WHITE),
            background_color: Some(SHADE),
            ..TextAnnotation::default()
        };
        Ok(ImageAnnotations { timestamp, points, texts: vec![text], ..ImageAnnotations::default() })
    }
}

/// The colour of inliers in the live image.
pub(super) const LIVE: Color = BLUE;
/// The colour of inliers in the matched one.
pub(super) const MATCHED: Color = ORANGE;
