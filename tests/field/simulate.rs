//! Driving a pass: frame by frame, from the world to images.

use crate::camera::{Camera, Exposure, rig};
use crate::chance::derive;
use crate::drive::Drive;
use crate::pass::Pass;
use crate::render::backdrop::Hills;
use crate::render::shadow::ShadowMap;
use crate::render::{Radiance, Stage, render_pair};
use crate::sky::Sky;
use crate::vector::V3;
use crate::world::{World, build};
use furrow_model::{Se3, StereoRig};

/// Frames per second.
pub const FRAMES_PER_S: f64 = 8.0;

/// A stereo pair as the camera took it.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Number of the frame in the pass, from 0.
    pub index: u64,
    /// Stamp in nanoseconds since 1970, UTC; the same for both images.
    pub stamp_ns: i64,
    /// Pose of the left camera: world (x east, y north, z up) from camera (x right, y down, z forward).
    pub world_from_left: Se3,
    /// Left image: blue green red, row by row.
    pub left: Vec<u8>,
    /// Right image.
    pub right: Vec<u8>,
    /// How both were exposed.
    pub exposure: Exposure,
}

/// Why a pass cannot be driven.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BadPass {
    /// The image size.
    #[error(
        "cannot render images of {0}x{1}: expected even numbers from 64x36 to 2560x1440; choose 640x360 for the field's usual size"
    )]
    Size(u32, u32),
    /// The length.
    #[error("cannot drive {0} m: expected a length from 1 m on")]
    Length(f64),
}

/// A world made ready for one pass.
pub struct Outing {
    pass: Pass,
    world: World,
    drive: Drive,
    sky: Sky,
    shadows: ShadowMap,
    hills: Hills,
    rig: StereoRig,
}

impl Outing {
    /// Builds the world of `pass` and bakes its light; seconds of work.
    pub fn prepare(pass: &Pass) -> Result<Outing, BadPass> {
        let (width, height) = pass.size;
        let sound = |n: u32, least: u32, most: u32| n.is_multiple_of(2) && (least..=most).contains(&n);
        if !sound(width, 64, 2560) || !sound(height, 36, 1440) {
            return Err(BadPass::Size(width, height));
        }
        if !(pass.length_m >= 1.0 && pass.length_m.is_finite()) {
            return Err(BadPass::Length(pass.length_m));
        }
        let world = build(pass);
        let drive = Drive::new(pass, &world.route);
        let sky = Sky::over(pass);
        let (low, high) = world.route.extent(pass.length_m + 30.0);
        let shadows = ShadowMap::bake(&world, sky.to_sun, low.map(|v| v - 14.0), high.map(|v| v + 14.0));
        let hills = Hills::paint(world.horizon_seed);
        Ok(Outing { pass: pass.clone(), world, drive, sky, shadows, hills, rig: rig(pass.size) })
    }

    /// The rectified pair that takes the images.
    pub fn rig(&self) -> StereoRig {
        self.rig
    }

    /// The pass that is driven.
    pub fn pass(&self) -> &Pass {
        &self.pass
    }

    /// Frames of the pass.
    pub fn frames(&self) -> u64 {
        (self.drive.duration_s() * FRAMES_PER_S).floor() as u64 + 1
    }

    /// When frame `index` is taken: seconds after the first.
    pub fn time_s(&self, index: u64) -> f64 {
        index as f64 / FRAMES_PER_S
    }

    /// The left camera's pose at `time_s` after the first frame: world from camera.
    pub fn world_from_left(&self, time_s: f64) -> Se3 {
        self.drive.pose(&self.world.route, &self.world.terrain, time_s)
    }

    /// What an IMU without faults measures at `time_s`, in the left camera's axes: m/s^2 and rad/s.
    pub fn imu(&self, time_s: f64) -> ([f64; 3], [f64; 3]) {
        self.drive.imu(&self.world.route, &self.world.terrain, time_s)
    }

    /// The radiance that arrives at both eyes at `time_s`.
    pub fn radiance(&self, time_s: f64) -> [Radiance; 2] {
        let afternoon = ((self.pass.start_s() / 3600.0 - 8.0) / 6.0).clamp(0.0, 1.0) as f32;
        let stage = Stage {
            world: &self.world,
            sky: &self.sky,
            shadows: &self.shadows,
            hills: &self.hills,
            wind: 0.25 + 0.75 * afternoon,
        };
        render_pair(&stage, &self.rig, &self.world_from_left(time_s), time_s as f32)
    }

    /// The camera as it is when the pass begins.
    pub fn camera(&self) -> Camera {
        let light = if self.sky.headlights {
            V3 { x: 1.0, y: 0.97, z: 0.9 }
        } else {
            self.sky.ambient(V3::UP) + self.sky.sun * self.sky.to_sun.z.max(0.0)
        };
        Camera::new(derive(self.pass.drive_seed(), 5), light.array())
    }

    /// Takes the frame `index`; `camera` must have taken the ones before.
    pub fn take(&self, camera: &mut Camera, index: u64) -> Frame {
        let time_s = self.time_s(index);
        let [left, right] = self.radiance(time_s);
        let exposure = camera.expose(&left);
        let (left, right) =
            rayon::join(|| camera.develop(&left, exposure, index, 0), || camera.develop(&right, exposure, index, 1));
        let stamp_ns = self.pass.start_ns() + (index as f64 * 1e9 / FRAMES_PER_S) as i64;
        Frame { index, stamp_ns, world_from_left: self.world_from_left(time_s), left, right, exposure }
    }
}

/// Drives `pass` and hands every frame to `sink`, in order, until the end or the sink's first error.
pub fn simulate<E: From<BadPass>>(pass: &Pass, mut sink: impl FnMut(Frame) -> Result<(), E>) -> Result<(), E> {
    let outing = Outing::prepare(pass)?;
    let mut camera = outing.camera();
    for index in 0..outing.frames() {
        sink(outing.take(&mut camera, index))?;
    }
    Ok(())
}
