//! What the robot's sensors send around each frame, with their faults, in the order of arrival. Receive times, IMU and
//! GPS keep the true time; the images' stamps are the camera's own.

use super::messages::{Body, Message, Topic};
use crate::chance::{Dice, derive};
use crate::simulation::{Frame, Simulation};

const IMU_PER_S: f64 = 100.0;
const GPS_PER_S: f64 = 5.0;
/// Standard deviations of the IMU's noise: rad/s and m/s^2.
const TURN_NOISE: f64 = 0.003;
const FORCE_NOISE: f64 = 0.04;
/// Standard deviations of a fix: a slow part that the receiver does not notice for minutes, a quick one, and upwards.
const SLOW_M: f64 = 0.7;
const QUICK_M: f64 = 0.25;
const UP_M: f64 = 1.8;
/// Metres per degree of latitude.
const DEGREE_M: f64 = 111_320.0;
const ALTITUDE_M: f64 = 112.0;
/// Time from a stamp to the receipt of its message.
const IMAGE_DELAY_NS: i64 = 14_000_000;
const SMALL_DELAY_NS: i64 = 2_000_000;

/// The sensors of one traversal.
pub struct Sensors {
    imu: Dice,
    gps: Dice,
    turn_bias: [f64; 3],
    force_bias: [f64; 3],
    drift_m: [f64; 3],
    imu_sent: u32,
    gps_sent: u32,
    /// Where the route's region lies from the site's reference point, in metres east and north.
    region_m: [f64; 2],
}

impl Sensors {
    /// The sensors of `simulation`, with the offsets that they keep all the while.
    pub fn of(simulation: &Simulation) -> Sensors {
        let seed = derive(simulation.traversal().traversal_seed(), 6);
        let mut dice = Dice::of(seed, 0);
        let mut three = |deviation: f64| [0; 3].map(|_| f64::from(dice.normal()) * deviation);
        let (turn_bias, force_bias, drift_m) = (three(0.002), three(0.03), three(SLOW_M));
        Sensors {
            imu: Dice::of(seed, 1),
            gps: Dice::of(seed, 2),
            turn_bias,
            force_bias,
            drift_m,
            imu_sent: 0,
            gps_sent: 0,
            region_m: simulation.traversal().region_m(),
        }
    }

    /// Hands on all messages up to and with `frame`: (receive time, message), receive times never falling.
    pub fn messages<E>(
        &mut self,
        simulation: &Simulation,
        frame: Frame,
        send: &mut impl FnMut(i64, &Message) -> Result<(), E>,
    ) -> Result<(), E> {
        let start_ns = simulation.traversal().start_ns();
        let received_ns = frame.true_ns + IMAGE_DELAY_NS;
        loop {
            let imu_ns = start_ns + (f64::from(self.imu_sent) * 1e9 / IMU_PER_S) as i64;
            let gps_ns = start_ns + (f64::from(self.gps_sent) * 1e9 / GPS_PER_S) as i64;
            let next_ns = imu_ns.min(gps_ns);
            if next_ns + SMALL_DELAY_NS >= received_ns {
                break;
            }
            let message =
                if gps_ns <= imu_ns { self.fix(simulation, gps_ns) } else { self.inertia(simulation, imu_ns) };
            send(next_ns + SMALL_DELAY_NS, &message)?;
        }
        let size = simulation.traversal().size;
        let [left_info, right_info] =
            simulation.calibrations().clone().map(|calibration| Body::CameraInfo(Box::new(calibration)));
        let image = |pixels| Body::Image { width: size.0, height: size.1, pixels };
        let bodies = [
            (Topic::LeftInfo, 0, Some(left_info)),
            (Topic::RightInfo, 1, Some(right_info)),
            (Topic::LeftImage, 0, frame.left.map(image)),
            (Topic::RightImage, 1, frame.right.map(image)),
        ];
        for (k, (topic, side, body)) in bodies.into_iter().enumerate() {
            // A lost image leaves a gap in the stream's numbers.
            if let Some(body) = body {
                let message = Message { topic, sequence: frame.index as u32, stamp_ns: frame.stamps_ns[side], body };
                send(received_ns + 200_000 * k as i64, &message)?;
            }
        }
        Ok(())
    }

    fn inertia(&mut self, simulation: &Simulation, stamp_ns: i64) -> Message {
        let time_s = (stamp_ns - simulation.traversal().start_ns()) as f64 / 1e9;
        let (force, turn) = simulation.imu(time_s);
        // Camera axes (right, down, forward) to the robot's (forward, left, up).
        let robot = |v: [f64; 3]| [v[2], -v[0], -v[1]];
        let (force, turn) = (robot(force), robot(turn));
        let mut noisy = |v: [f64; 3], bias: [f64; 3], noise: f64| {
            [0, 1, 2].map(|k| v[k] + bias[k] + noise * f64::from(self.imu.normal()))
        };
        let body = Body::Imu {
            turn_rate: noisy(turn, self.turn_bias, TURN_NOISE),
            acceleration: noisy(force, self.force_bias, FORCE_NOISE),
            variances: [TURN_NOISE * TURN_NOISE, FORCE_NOISE * FORCE_NOISE],
        };
        let sequence = self.imu_sent;
        self.imu_sent += 1;
        Message { topic: Topic::Imu, sequence, stamp_ns, body }
    }

    fn fix(&mut self, simulation: &Simulation, stamp_ns: i64) -> Message {
        let time_s = (stamp_ns - simulation.traversal().start_ns()) as f64 / 1e9;
        let [x, y, z] = simulation.world_from_left(time_s).translation_m;
        let mut quick = |k: usize| self.drift_m[k] + QUICK_M * f64::from(self.gps.normal());
        let (east, north) = (x + self.region_m[0] + quick(0), y + self.region_m[1] + quick(1));
        let up = ALTITUDE_M + z + UP_M / SLOW_M * quick(2);
        let place = simulation.traversal().site.place();
        let latitude = place.latitude_deg + north / DEGREE_M;
        let longitude = place.longitude_deg + east / (DEGREE_M * libm::cos(place.latitude_deg.to_radians()));
        let level = SLOW_M * SLOW_M + QUICK_M * QUICK_M;
        let body = Body::Fix { position: [latitude, longitude, up], variances_m2: [level, level, UP_M * UP_M * 1.2] };
        // The slow part wanders within a minute.
        let keep = 0.997_f64;
        for drift in &mut self.drift_m {
            *drift = keep * *drift + (1.0 - keep * keep).sqrt() * SLOW_M * f64::from(self.gps.normal());
        }
        let sequence = self.gps_sent;
        self.gps_sent += 1;
        Message { topic: Topic::Gps, sequence, stamp_ns, body }
    }
}
