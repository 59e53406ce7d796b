//! What the camera promises: raw images bent as their calibration says, motion blur as long as the exposure, settings
//! that are checked.

use furrow_field::camera::optics::Optics;
use furrow_field::camera::rig;
use furrow_field::render::hills::Hills;
use furrow_field::render::shadow::ShadowMap;
use furrow_field::render::{Radiance, Stage, render_pair};
use furrow_field::sky::Sky;
use furrow_field::texture::set::WOOD;
use furrow_field::vector::v3;
use furrow_field::world::World;
use furrow_field::world::route::RouteLine;
use furrow_field::world::scene::{Facet, Scene};
use furrow_field::world::terrain::{Soil, Terrain};
use furrow_field::{BadTraversal, CameraSettings, Simulation, Site, Traversal};
use furrow_model::{CameraCalibration, Se3};

fn traversal(slot: &str) -> Traversal {
    Traversal { size: (128, 72), length_m: 1.0, ..Traversal::new(Site::Backsburg, slot.parse().expect("a slot")) }
}

/// OpenCV's `projectPoints`: where a raw camera sees a point of its rectified camera's frame.
fn distorted(calibration: &CameraCalibration, rectified: [f64; 3]) -> [f64; 2] {
    let (r, k, d) = (&calibration.rectification, &calibration.intrinsics, &calibration.coefficients);
    let raw = [0, 1, 2].map(|column| (0..3).map(|row| r[3 * row + column] * rectified[row]).sum::<f64>());
    let (x, y) = (raw[0] / raw[2], raw[1] / raw[2]);
    let [k1, k2, p1, p2, k3] = d[..] else { panic!("five coefficients of plumb_bob: {d:?}") };
    let r2 = x * x + y * y;
    let radial = 1.0 + k1 * r2 + k2 * r2.powi(2) + k3 * r2.powi(3);
    let bent_x = x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x);
    let bent_y = y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
    [k[0] * bent_x + k[2], k[4] * bent_y + k[5]]
}

/// The centre of what shines: columns and rows, weighted by radiance above `floor`.
fn centre(image: &Radiance, floor: f32) -> [f64; 2] {
    let mut sums = [0.0_f64; 3];
    for (i, pixel) in image.pixels.iter().enumerate() {
        let light = f64::from((pixel[1] - floor).max(0.0));
        sums[0] += light * (i as u32 % image.width) as f64;
        sums[1] += light * (i as u32 / image.width) as f64;
        sums[2] += light;
    }
    [sums[0] / sums[2], sums[1] / sums[2]]
}

#[test]
fn a_raw_camera_sees_a_lamp_where_opencv_s_formula_says() {
    let sky = Sky::over(&traversal("10:00"));
    let route = RouteLine::through(&[[0.0, 0.0], [0.0, 5.0]], false);
    let terrain =
        Terrain::build(&route, 12.0, |_, _, _| Soil { height_m: 0.0, shares: [0.0, 1.0, 0.0, 0.0], tint: 0.2 });
    let world_from_left = Se3::from_quaternion([-0.74, 0.06, 0.05, 0.67], [0.3, -0.4, 0.9]);
    let rig = rig((640, 360));
    let optics = Optics::raw(&rig);
    // Points of the rectified left camera: the middle, near every corner, and beyond the rectified image.
    for point in
        [[0.1, 0.05, 3.0], [-3.1, -1.6, 3.0], [3.1, -1.7, 3.0], [-3.2, 1.6, 3.0], [3.0, 1.7, 3.0], [-4.2, 0.2, 3.0]]
    {
        let middle = world_from_left.apply(point);
        let mut scene = Scene::new(1);
        // A lamp of 12 cm, turned against the camera so that its edges cut across the pixels: so bright that nothing
        // else counts.
        let side = |x: f64, y: f64| {
            let along = Se3 { translation_m: [0.0; 3], ..world_from_left }.apply([0.12 * x, 0.12 * y, 0.0]);
            v3(along[0] as f32, along[1] as f32, along[2] as f32)
        };
        let (u, v) = (side(0.8, 0.6), side(-0.6, 0.8));
        let middle = v3(middle[0] as f32, middle[1] as f32, middle[2] as f32);
        scene.add(Facet {
            tint: v3(5e4, 5e4, 5e4),
            uv: [0.5, 0.5, 0.001, 0.001],
            ..Facet::solid(middle - (u + v) * 0.5, u, v, WOOD.first())
        });
        let (facets, squares) = scene.into_squares();
        let world =
            World { route: route.clone(), terrain: terrain.clone(), facets, squares, net: None, horizon_seed: 1 };
        let shadows = ShadowMap::bake(&world, sky.to_sun, [-10.0; 2], [10.0; 2]);
        let hills = Hills::paint(1);
        let stage = Stage { world: &world, sky: &sky, shadows: &shadows, hills: &hills, wind: 0.0 };
        let seen = optics.focus(render_pair(&stage, optics.rendered(), &world_from_left, 0.0));
        for (side, image) in seen.iter().enumerate() {
            assert_eq!((image.width, image.height), (640, 360));
            let of_side = [point[0] - rig.baseline_m * side as f64, point[1], point[2]];
            let expected = distorted(&optics.calibrations()[side], of_side);
            let plain = [0, 1].map(|k| rig.focal_px * of_side[k] / of_side[2] + [rig.cu_px, rig.cv_px][k]);
            let found = centre(image, 2e3);
            let off = [0, 1].map(|k| (found[k] - expected[k]).abs());
            assert!(off[0] < 0.15 && off[1] < 0.15, "side {side}, {point:?}: {found:?}, expected {expected:?}");
            // The lens is worth the name: off the axis it moves points by far more than the tolerance.
            let bent = libm::hypot(expected[0] - plain[0], expected[1] - plain[1]);
            assert!(bent > 1.5, "side {side}, {point:?}: bent by {bent} px");
        }
    }
}

#[test]
fn rectifying_a_raw_image_leads_to_the_rectified_rig_and_leaves_no_black() {
    for size in [(128, 72), (640, 360), (640, 480), (1280, 720)] {
        let rig = rig(size);
        for (side, calibration) in Optics::raw(&rig).calibrations().iter().enumerate() {
            let shift = [0.0, -rig.focal_px * rig.baseline_m][side];
            let p = [rig.focal_px, 0.0, rig.cu_px, shift, 0.0, rig.focal_px, rig.cv_px, 0.0, 0.0, 0.0, 1.0, 0.0];
            assert_eq!(calibration.projection, p);
            assert_ne!(calibration.intrinsics[0], calibration.intrinsics[4], "fx and fy differ");
            // `initUndistortRectifyMap`: the raw pixel of every pixel of the rectified image's border lies in the raw
            // image.
            let (width, height) = (f64::from(size.0) - 1.0, f64::from(size.1) - 1.0);
            let across = (0..size.0).flat_map(|u| [(f64::from(u), 0.0), (f64::from(u), height)]);
            let along = (0..size.1).flat_map(|v| [(0.0, f64::from(v)), (width, f64::from(v))]);
            for (u, v) in across.chain(along) {
                let ray = [(u - rig.cu_px) / rig.focal_px, (v - rig.cv_px) / rig.focal_px, 1.0];
                let [x, y] = distorted(calibration, ray);
                assert!((0.0..=width).contains(&x) && (0.0..=height).contains(&y), "{size:?} ({u}, {v}): ({x}, {y})");
            }
        }
    }
}

#[test]
fn a_long_exposure_is_the_mean_of_its_moments() {
    let simulation =
        Simulation::prepare(&Traversal { size: (320, 180), ..traversal("10:00") }).expect("a sound traversal");
    // The ground in the lower half, where the image moves.
    let values = |time_s: f64, exposure_s: f64| -> Vec<f64> {
        let pictures = simulation.radiance(time_s, exposure_s);
        pictures
            .iter()
            .flat_map(|picture| picture.pixels[320 * 100..].iter().map(|pixel| f64::from(pixel[1])))
            .collect()
    };
    // As far as 10 ms and 6 ms go at 640x360, the longest exposure and a common one. Nine pictures over the exposure,
    // each sharp, are what the sensor adds up. What changes by that is regressed on what the blur changes: 1 where they
    // agree, whatever else flickers.
    for exposure_s in [0.020, 0.012] {
        let sharp = values(0.5, 0.0);
        let moments: Vec<Vec<f64>> =
            (0..9).map(|k| values(0.5 + exposure_s * ((f64::from(k) + 0.5) / 9.0 - 0.5), 0.0)).collect();
        let (mut together, mut alone) = (0.0, 0.0);
        for (i, smeared) in values(0.5, exposure_s).into_iter().enumerate() {
            let mean = moments.iter().map(|moment| moment[i]).sum::<f64>() / 9.0;
            together += (smeared - sharp[i]) * (mean - sharp[i]);
            alone += (smeared - sharp[i]) * (smeared - sharp[i]);
        }
        assert!((together / alone - 1.0).abs() < 0.2, "{exposure_s}: {}", together / alone);
    }
}

#[test]
fn night_is_blurred_more_than_noon() {
    let motion_px = |slot: &str| {
        let simulation =
            Simulation::prepare(&Traversal { size: (640, 360), ..traversal(slot) }).expect("a sound traversal");
        let mut camera = simulation.camera();
        let frame = simulation.take(&mut camera, 0);
        assert_eq!(frame.left.map(|image| image.len()), Some(3 * 640 * 360));
        frame.motion_px
    };
    let (night, noon) = (motion_px("04:30"), motion_px("12:00"));
    // The longest exposure, 10 ms, at 0.6 m/s and more: the ground's nearest corner moves by three pixels.
    assert!(night > 3.0 && noon < 0.6 * night, "{night} {noon}");
}

#[test]
fn the_exposure_of_a_frame_is_set_by_the_frames_before_it() {
    let simulation = Simulation::prepare(&traversal("08:00")).expect("a sound traversal");
    let mut camera = simulation.camera();
    let first = simulation.take(&mut camera, 0);
    let next = camera.exposure().expect("an exposure");
    let second = simulation.take(&mut camera, 1);
    assert_eq!(second.exposure, next);
    assert_ne!(camera.exposure(), Some(next), "the second frame is metered as well");
    assert!((first.exposure.time_s / second.exposure.time_s - 1.0).abs() < 0.1);
}

#[test]
fn settings_out_of_range_are_refused_with_what_is_expected() {
    let fine = CameraSettings::default();
    let refused = |camera: CameraSettings| {
        Simulation::prepare(&Traversal { camera, ..traversal("08:00") }).err().expect("refused")
    };
    for rate_hz in [0.9, 61.0, f64::NAN, -8.0] {
        assert!(matches!(refused(CameraSettings { rate_hz, ..fine }), BadTraversal::Rate(_)), "{rate_hz}");
    }
    for dropped in [-0.1, 0.51, f64::NAN] {
        assert!(matches!(refused(CameraSettings { dropped, ..fine }), BadTraversal::Dropped(_)), "{dropped}");
    }
    for clock_skew_ppm in [1001.0, f64::INFINITY] {
        assert!(
            matches!(refused(CameraSettings { clock_skew_ppm, ..fine }), BadTraversal::Skew(_)),
            "{clock_skew_ppm}"
        );
    }
    let error = refused(CameraSettings { rate_hz: 20.0, clock_offset_ms: 25.0, ..fine });
    assert_eq!(error, BadTraversal::Offset { found: 25.0, most: 20.0 });
    assert!(error.to_string().contains("25 ms") && error.to_string().contains("expected -20 to 20"), "{error}");
    assert!(refused(CameraSettings { rate_hz: 90.0, ..fine }).to_string().contains("90"));
}

#[test]
fn raw_images_do_not_depend_on_the_number_of_threads() {
    let camera = CameraSettings { distorted: true, ..CameraSettings::default() };
    let taken = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let simulation =
                Simulation::prepare(&Traversal { camera, ..traversal("04:30") }).expect("a sound traversal");
            let mut camera = simulation.camera();
            (0..2).map(|index| simulation.take(&mut camera, index)).collect::<Vec<_>>()
        })
    };
    assert!(taken(1) == taken(3));
}
