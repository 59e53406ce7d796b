//! The robot's way along the route: where its left camera is at any time, and what its IMU and GPS receiver feel of it.

use crate::chance::{Dice, derive};
use crate::traversal::Traversal;
use crate::world::route::RouteLine;
use crate::world::terrain::Terrain;
use furrow_model::Se3;

/// Height of the camera above the ground in metres.
pub const CAMERA_HEIGHT_M: f64 = 0.75;
/// How far the camera looks down, in radians.
const TILT_RAD: f64 = 0.07;
/// Half the wheelbase and half the track of the robot in metres.
const HALF_BASE_M: f64 = 0.3;

/// A smooth random curve: a cubic B-spline over autoregressive knots, continuous to its second derivative.
#[derive(Debug, Clone)]
struct Wander {
    knots: Vec<f64>,
    spacing: f64,
}

impl Wander {
    /// A curve over 0 to `length` with this standard deviation, a knot every `spacing`, each keeping `memory` of the
    /// one before.
    fn new(dice: &mut Dice, length: f64, spacing: f64, memory: f64, std: f64) -> Wander {
        let fresh = (1.0 - memory * memory).sqrt();
        let mut value = f64::from(dice.normal());
        let mut knots = Vec::new();
        for _ in 0..(length / spacing) as usize + 8 {
            knots.push(value * std);
            value = memory * value + fresh * f64::from(dice.normal());
        }
        Wander { knots, spacing }
    }

    fn at(&self, x: f64) -> f64 {
        let position = (x / self.spacing).max(0.0) + 1.0;
        let i = (position as usize).clamp(1, self.knots.len() - 3);
        let t = position - i as f64;
        let k = &self.knots[i - 1..i + 3];
        let (t2, t3) = (t * t, t * t * t);
        ((1.0 - 3.0 * t + 3.0 * t2 - t3) * k[0]
            + (4.0 - 6.0 * t2 + 3.0 * t3) * k[1]
            + (1.0 + 3.0 * t + 3.0 * t2 - 3.0 * t3) * k[2]
            + t3 * k[3])
            / 6.0
    }
}

/// One traversal by the robot, as functions of time.
#[derive(Debug, Clone)]
pub struct Robot {
    start_m: f64,
    speed_m_s: f64,
    surge: f64,
    length_m: f64,
    offset_m: Wander,
    heading_rad: Wander,
    shake_rad: [Wander; 2],
}

impl Robot {
    /// The robot on `traversal` along `route`: it starts within 1 m, keeps 0.6 to 0.9 m/s, and follows a line of its
    /// own.
    pub fn new(traversal: &Traversal, route: &RouteLine) -> Robot {
        let seed = derive(traversal.traversal_seed(), 4);
        let mut dice = Dice::new(seed);
        let length_m = traversal.length_m.min(route.length_m());
        let bias = 0.09 * f64::from(dice.normal());
        let mut offset_m = Wander::new(&mut dice, length_m + 2.0, 2.5, 0.75, 0.10);
        offset_m.knots.iter_mut().for_each(|knot| *knot += bias);
        Robot {
            start_m: f64::from(dice.within(0.0, 1.0)),
            speed_m_s: f64::from(dice.within(0.65, 0.85)),
            surge: f64::from(dice.within(0.2, 0.5)),
            length_m,
            offset_m,
            heading_rad: Wander::new(&mut dice, length_m + 2.0, 1.3, 0.5, 0.028),
            shake_rad: [0.004, 0.005].map(|std| Wander::new(&mut dice, length_m + 2.0, 0.35, 0.2, std)),
        }
    }

    /// Seconds that the traversal takes.
    pub fn duration_s(&self) -> f64 {
        self.length_m / self.speed_m_s
    }

    /// Metres along the route at `time_s`: the speed breathes by a few percent.
    pub fn along_m(&self, time_s: f64) -> f64 {
        let swell = 0.05 * self.speed_m_s / self.surge;
        self.start_m + self.speed_m_s * time_s + swell * (1.0 - libm::cos(self.surge * time_s))
    }

    /// The pose of the left camera, world from camera, at `time_s`.
    pub fn pose(&self, route: &RouteLine, terrain: &Terrain, time_s: f64) -> Se3 {
        let along = self.along_m(time_s);
        let (line, ahead) = route.at(along);
        let offset = self.offset_m.at(along);
        let (x, y) = (line[0] - offset * ahead[1], line[1] + offset * ahead[0]);
        let turn = self.heading_rad.at(along);
        let (cos, sin) = (libm::cos(turn), libm::sin(turn));
        let (fx, fy) = (ahead[0] * cos - ahead[1] * sin, ahead[0] * sin + ahead[1] * cos);
        // The body rests on four wheels: its slopes are the differences of the ground under them.
        let wheel = |front: f64, left: f64| {
            let (px, py) = (x + HALF_BASE_M * (front * fx - left * fy), y + HALF_BASE_M * (front * fy + left * fx));
            soft_height(terrain, px, py)
        };
        let [fl, fr, bl, br] = [wheel(1.0, 1.0), wheel(1.0, -1.0), wheel(-1.0, 1.0), wheel(-1.0, -1.0)];
        let pitch = (fl + fr - bl - br) / (4.0 * HALF_BASE_M) - TILT_RAD + self.shake_rad[0].at(along);
        let roll = (fl + bl - fr - br) / (4.0 * HALF_BASE_M) + self.shake_rad[1].at(along);
        let forward = unit([fx, fy, pitch]);
        let right = unit([fy, -fx, -roll]);
        let down = unit(cross(forward, right));
        let right = cross(down, forward);
        let rotation = [0, 1, 2].map(|k| [right[k], down[k], forward[k]]);
        Se3 { rotation, translation_m: [x, y, (fl + fr + bl + br) / 4.0 + CAMERA_HEIGHT_M] }
    }

    /// What an ideal IMU with the left camera's axes measures at `time_s`: specific force (m/s^2) and turn rate
    /// (rad/s).
    pub fn imu(&self, route: &RouteLine, terrain: &Terrain, time_s: f64) -> ([f64; 3], [f64; 3]) {
        const H: f64 = 0.02;
        let [before, now, after] = [time_s - H, time_s, time_s + H].map(|t| self.pose(route, terrain, t));
        let mut force_world = [0, 1, 2]
            .map(|k| (before.translation_m[k] - 2.0 * now.translation_m[k] + after.translation_m[k]) / (H * H));
        force_world[2] += 9.81;
        let to_camera = Se3 { translation_m: [0.0; 3], ..now.inverse() };
        let turn = before.inverse().compose(&after).rotation;
        let rate = [turn[2][1] - turn[1][2], turn[0][2] - turn[2][0], turn[1][0] - turn[0][1]].map(|v| v / (4.0 * H));
        (to_camera.apply(force_world), rate)
    }
}

/// The ground as a tyre feels it: the mean over its footprint.
fn soft_height(terrain: &Terrain, x: f64, y: f64) -> f64 {
    let mut sum = 0.0;
    for dy in -1..=1 {
        for dx in -1..=1 {
            sum += f64::from(terrain.height_m((x + 0.1 * f64::from(dx)) as f32, (y + 0.1 * f64::from(dy)) as f32));
        }
    }
    sum / 9.0
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|c| c / length)
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
