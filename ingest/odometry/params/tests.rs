//! The stored names and the defaults: keys hash this JSON.

use super::{OdometryParams, TwoViewParams, VerifyParams};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Checks that `expected` is the JSON of the defaults, and that it can be read.
fn check<T: Serialize + DeserializeOwned + Default + PartialEq>(expected: &str) {
    assert_eq!(serde_json::to_string(&T::default()).unwrap(), expected);
    assert!(serde_json::from_str::<T>(expected).unwrap() == T::default());
}

const MATCHER: &str = r#"{"scale":"auto","nms_radius_px":3,"nms_threshold":50,"sparse_radius_px":9}"#;
const STEREO: &str = r#"{"epipolar_tolerance_px":1,"near_m":0.5,"max_disparity_px":200.0,"min_disparity_px":0.8}"#;

#[test]
fn odometry_parameters_keep_their_stored_names() {
    check::<OdometryParams>(&format!(
        "{}{MATCHER}{}{STEREO}{}{}{}{}{}{}",
        r#"{"matcher":"#,
        r#","stereo":"#,
        r#","search_radius_px":200.0,"guided_radius_px":12.0,"support":{"neighbours":8,"supporters":2,"#,
        r#""flow_tolerance_px":5.0,"disparity_tolerance_px":5.0},"bucket":{"side_px":50,"matches":3},"#,
        r#""ransac":{"seed":0,"max_rounds":200,"confidence":0.9999,"inlier_px":2.0,"min_inliers":10},"#,
        r#""near_disparity_px":8.0,"min_inlier_share":0.2,"max_step_m":15.0,"max_turn_rad":0.8,"#,
        r#""calibration_error":0.005,"max_sigma_m":0.5,"second_try":{"#,
        r#""sure_inliers":40,"sure_share":0.4,"doubtful_inliers":30,"min_inlier_share":0.12}}"#,
    ));
}

#[test]
fn verification_parameters_keep_their_stored_names() {
    check::<VerifyParams>(&format!(
        "{}{MATCHER}{}{STEREO}{}{}{}",
        r#"{"matcher":"#,
        r#","stereo":"#,
        r#","search_columns":0.33,"search_rows":0.25,"ratio":0.95,"bucket":{"side_px":25,"matches":2},"#,
        r#""ransac":{"seed":0,"max_rounds":1000,"confidence":0.999,"inlier_px":2.0,"min_inliers":6},"#,
        r#""min_likeness":0.8,"max_distance_m":4.0,"max_yaw_rad":0.7853981633974483,"max_sigma_m":0.5}"#,
    ));
    check::<TwoViewParams>(&format!(
        "{}{}",
        r#"{"bucket":{"side_px":25,"matches":2},"#,
        r#""ransac":{"seed":0,"max_rounds":2000,"confidence":0.999,"inlier_px":1.5,"min_inliers":8}}"#,
    ));
}
