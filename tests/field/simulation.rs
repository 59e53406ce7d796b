//! Simulating a traversal: frame by frame, from the world to images.

use crate::camera::blur::{Motion, smear};
use crate::camera::delivery::Delivery;
use crate::camera::optics::Optics;
use crate::camera::{Camera, Exposure, rig};
use crate::chance::derive;
use crate::render::hills::Hills;
use crate::render::shadow::ShadowMap;
use crate::render::{Radiance, Stage, render_pair};
use crate::robot::Robot;
use crate::sky::Sky;
use crate::texture::set::textures;
use crate::traversal::BadTraversal;
use crate::traversal::Traversal;
use crate::vector::V3;
use crate::world::{World, build};
use furrow_model::{CameraCalibration, Se3, StereoRig};
use std::sync::mpsc::sync_channel;
use std::thread;

/// A stereo pair as the camera took it.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Number of the frame in the traversal, from 0.
    pub index: u64,
    /// When it was taken, the middle of the exposure: nanoseconds of true time since 1970, UTC.
    pub true_ns: i64,
    /// Stamps of the left and right image by the camera's clock, in nanoseconds since 1970. The left one names the
    /// frame.
    pub stamps_ns: [i64; 2],
    /// True pose of the rectified left camera at `true_ns`: world (x east, y north, z up) from camera (x right, y down,
    /// z forward).
    pub world_from_left: Se3,
    /// Left image: blue green red, row by row; `None` where it was lost.
    pub left: Option<Vec<u8>>,
    /// Right image.
    pub right: Option<Vec<u8>>,
    /// How both were exposed.
    pub exposure: Exposure,
    /// How far the fastest pixel of the left image moved during the exposure, in pixels; 0 where both images were lost.
    pub motion_px: f32,
}

/// A traversal with its world, ready to be taken frame by frame.
pub struct Simulation {
    traversal: Traversal,
    world: World,
    robot: Robot,
    sky: Sky,
    shadows: ShadowMap,
    hills: Hills,
    rig: StereoRig,
    optics: Optics,
    delivery: Delivery,
}

impl Simulation {
    /// Builds the world of `traversal` and bakes its light; seconds of work.
    pub fn prepare(traversal: &Traversal) -> Result<Simulation, BadTraversal> {
        traversal.check()?;
        // The textures take as long as the world and are wanted after it.
        let world = thread::scope(|scope| {
            scope.spawn(textures);
            build(traversal)
        });
        let robot = Robot::new(traversal, &world.route);
        let sky = Sky::over(traversal);
        let (low, high) = world.route.extent(traversal.length_m + 30.0);
        let shadows = ShadowMap::bake(&world, sky.to_sun, low.map(|v| v - 14.0), high.map(|v| v + 14.0));
        let hills = Hills::paint(world.horizon_seed);
        let rig = rig(traversal.size);
        let optics = if traversal.camera.distorted { Optics::raw(&rig) } else { Optics::rectified(&rig) };
        let delivery = Delivery::of(traversal);
        Ok(Simulation { traversal: traversal.clone(), world, robot, sky, shadows, hills, rig, optics, delivery })
    }

    /// The rectified pair: what takes the images, or what rectifying them leads to.
    pub fn rig(&self) -> StereoRig {
        self.rig
    }

    /// What `sensor_msgs/CameraInfo` says of the left and the right camera.
    pub fn calibrations(&self) -> &[CameraCalibration; 2] {
        self.optics.calibrations()
    }

    /// The traversal that is simulated.
    pub fn traversal(&self) -> &Traversal {
        &self.traversal
    }

    /// Frames of the traversal.
    pub fn frames(&self) -> u64 {
        (self.robot.duration_s() * self.traversal.camera.rate_hz).floor() as u64 + 1
    }

    /// When frame `index` is taken: seconds of true time after the first.
    pub fn time_s(&self, index: u64) -> f64 {
        index as f64 / self.traversal.camera.rate_hz
    }

    /// The left camera's pose at `time_s` after the first frame: world from camera.
    pub fn world_from_left(&self, time_s: f64) -> Se3 {
        self.robot.pose(&self.world.route, &self.world.terrain, time_s)
    }

    /// What an IMU without faults measures at `time_s`, in the left camera's axes: m/s^2 and rad/s.
    pub fn imu(&self, time_s: f64) -> ([f64; 3], [f64; 3]) {
        self.robot.imu(&self.world.route, &self.world.terrain, time_s)
    }

    /// The radiance that falls on both sensors, averaged over an exposure of `exposure_s` round `time_s` as far as the
    /// image moves in it.
    pub fn radiance(&self, time_s: f64, exposure_s: f64) -> [Radiance; 2] {
        self.optics.focus(self.expose(time_s, exposure_s, self.render(time_s)).0)
    }

    /// What the optics need of `sharp`, the pictures of `time_s`, smeared by the exposure; and how far the left image
    /// moved.
    fn expose(&self, time_s: f64, exposure_s: f64, sharp: [Radiance; 2]) -> ([Radiance; 2], f32) {
        let [from, to] = [-0.5, 0.5].map(|share| self.world_from_left(time_s + share * exposure_s));
        let motion = Motion::between(&from, &to);
        let rig = self.optics.rendered();
        let [left, right] = sharp;
        let (left, moved_px) = smear(left, rig, &motion);
        let (right, _) = smear(right, rig, &motion.aside(rig.baseline_m));
        ([left, right], moved_px)
    }

    fn render(&self, time_s: f64) -> [Radiance; 2] {
        let afternoon = ((self.traversal.start_s() / 3600.0 - 8.0) / 6.0).clamp(0.0, 1.0) as f32;
        let stage = Stage {
            world: &self.world,
            sky: &self.sky,
            shadows: &self.shadows,
            hills: &self.hills,
            wind: 0.45 + 0.55 * afternoon,
        };
        render_pair(&stage, self.optics.rendered(), &self.world_from_left(time_s), time_s as f32)
    }

    /// The camera as it is when the traversal begins.
    pub fn camera(&self) -> Camera {
        let light = if self.sky.headlights {
            V3 { x: 1.0, y: 0.97, z: 0.9 }
        } else {
            self.sky.ambient(V3::UP) + self.sky.sun * self.sky.to_sun.z.max(0.0)
        };
        Camera::new(derive(self.traversal.traversal_seed(), 5), light.array())
    }

    /// Takes the frame `index`; `camera` must have taken the ones before. A frame whose images are all lost is not
    /// rendered, and the camera's exposure stays as it is.
    pub fn take(&self, camera: &mut Camera, index: u64) -> Frame {
        let sharp = self.seen(index, camera.exposure().is_none());
        self.develop(camera, index, sharp)
    }

    /// Takes all frames on threads of their own and hands them to `sink`, in order, until its first error: while it has
    /// one, the next is developed and the one after that rendered.
    pub fn take_all<E>(&self, sink: impl FnMut(Frame) -> Result<(), E>) -> Result<(), E> {
        // Few wait, so that memory stays bounded.
        let (saw, seen) = sync_channel(1);
        let (took, taken) = sync_channel(2);
        thread::scope(|scope| {
            scope.spawn(move || (0..self.frames()).all(|index| saw.send(self.seen(index, index == 0)).is_ok()));
            scope.spawn(move || {
                let mut camera = self.camera();
                (0..).zip(seen).all(|(index, sharp)| took.send(self.develop(&mut camera, index, sharp)).is_ok())
            });
            taken.into_iter().try_for_each(sink)
        })
    }

    /// What both eyes see in the middle of the exposure of frame `index`; nothing where all its images are lost and it
    /// is not `metered`.
    fn seen(&self, index: u64, metered: bool) -> Option<[Radiance; 2]> {
        let wanted = metered || self.delivery.arrives(index) != [false; 2];
        wanted.then(|| self.render(self.time_s(index)))
    }

    /// The frame `index` of what both eyes see then.
    fn develop(&self, camera: &mut Camera, index: u64, sharp: Option<[Radiance; 2]>) -> Frame {
        let time_s = self.time_s(index);
        // What the camera saw before sets this frame's exposure; the first frame is metered on its own picture.
        let exposure = camera.exposure().unwrap_or_else(|| {
            let sharp = sharp.clone().unwrap_or_else(|| self.render(time_s));
            camera.meter(&self.optics.focus(sharp)[0])
        });
        let mut frame = Frame {
            index,
            true_ns: self.delivery.true_ns(index),
            stamps_ns: self.delivery.stamps_ns(index),
            world_from_left: self.world_from_left(time_s),
            left: None,
            right: None,
            exposure,
            motion_px: 0.0,
        };
        let arrives = self.delivery.arrives(index);
        let Some(sharp) = sharp.filter(|_| arrives != [false; 2]) else { return frame };
        let (light, motion_px) = self.expose(time_s, f64::from(exposure.time_s), sharp);
        let light = self.optics.focus(light);
        camera.meter(&light[0]);
        let camera = &*camera;
        let develop =
            |side: usize| arrives[side].then(|| camera.develop(&light[side], &self.optics, exposure, index, side));
        (frame.left, frame.right) = rayon::join(|| develop(0), || develop(1));
        frame.motion_px = motion_px;
        frame
    }
}

/// Simulates `traversal` and hands every frame to `sink`, in order, until the end or the sink's first error.
pub fn simulate<E: From<BadTraversal>>(
    traversal: &Traversal,
    sink: impl FnMut(Frame) -> Result<(), E>,
) -> Result<(), E> {
    Simulation::prepare(traversal)?.take_all(sink)
}
