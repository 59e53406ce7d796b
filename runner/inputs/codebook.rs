//! Which codebook a matrix asks for: the images it is trained on, and how.

use crate::inputs::key::{CODEBOOK, key_of};
use crate::inputs::sampling::spread;
use crate::inputs::traversals::LiveTraversal;
use crate::matrix::{Matrix, Trainer};
use furrow_catalog::CatalogError;
use furrow_catalog::records::FeatureParameters;
use furrow_model::ObjectId;

/// The trainers, as records name them.
pub(crate) const KMEANS: &str = "k-means/2";
pub(crate) const SEQUENTIAL: &str = "sequential/1";

/// The images that a codebook is trained on, and how.
#[derive(Debug, Clone)]
pub struct CodebookPlan {
    /// The site.
    pub site: String,
    /// The vocabulary route.
    pub route: String,
    /// Words; 0 where the trainer finds out.
    pub words: u32,
    /// How words are found.
    pub trainer: Trainer,
    /// Sequential: descriptors farther than this from every word become a word.
    pub radius: f64,
    /// Seed of the training.
    pub seed: u64,
    /// SURF's parameters.
    pub features: FeatureParameters,
    /// The images, in order.
    pub images: Vec<VocabularyImage>,
}

/// An image that a codebook is trained on.
#[derive(Debug, Clone, Copy)]
pub struct VocabularyImage {
    /// The left image.
    pub left: ObjectId,
    /// Its calibration record.
    pub calibration: ObjectId,
}

/// The key under which a trained codebook is remembered.
pub(crate) fn codebook_key(plan: &CodebookPlan) -> Result<ObjectId, CatalogError> {
    let images: Vec<(ObjectId, ObjectId)> = plan.images.iter().map(|image| (image.left, image.calibration)).collect();
    match plan.trainer {
        Trainer::KMeans => key_of(CODEBOOK, &(KMEANS, plan.words, plan.seed, plan.features, images)),
        // Nothing is drawn at random.
        Trainer::Sequential => key_of(CODEBOOK, &(SEQUENTIAL, plan.radius, plan.features, images)),
    }
}

/// The images of the vocabulary traversals, evenly spread where there are more than the matrix wants.
pub(crate) fn codebook_plan(matrix: &Matrix, vocabulary: &[LiveTraversal]) -> CodebookPlan {
    let all: Vec<VocabularyImage> = vocabulary
        .iter()
        .flat_map(|traversal| {
            traversal
                .frames
                .iter()
                .map(|frame| VocabularyImage { left: frame.left, calibration: traversal.record.calibration })
        })
        .collect();
    CodebookPlan {
        site: matrix.site.clone(),
        route: matrix.codebook.route.clone(),
        words: matrix.codebook.words,
        trainer: matrix.codebook.trainer,
        radius: matrix.codebook.radius,
        seed: matrix.seed,
        features: FeatureParameters { hessian: matrix.features.hessian, upright: matrix.features.upright },
        images: spread(&all, matrix.codebook.images.max(1)),
    }
}
