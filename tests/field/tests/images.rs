//! What the images promise: geometry as the ground truth says, the same bytes on any number of threads, the same world
//! in every traversal.

use furrow_field::camera::rig;
use furrow_field::render::hills::Hills;
use furrow_field::render::shadow::ShadowMap;
use furrow_field::render::{Radiance, Stage, render_pair};
use furrow_field::sky::Sky;
use furrow_field::texture::set::{ROSETTE, STONE, WOOD};
use furrow_field::traversal::{Site, Traversal, Weather};
use furrow_field::vector::v3;
use furrow_field::world::route::RouteLine;
use furrow_field::world::scene::{Facet, Scene};
use furrow_field::world::terrain::{Soil, Terrain};
use furrow_field::world::{World, build};
use furrow_field::{BadTraversal, Frame};
use furrow_field::{Simulation, simulate};
use furrow_model::Se3;

fn traversal(site: Site, slot: &str) -> Traversal {
    Traversal { size: (128, 72), length_m: 3.0, ..Traversal::new(site, slot.parse().expect("a slot")) }
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
fn a_point_of_the_world_is_seen_where_the_ground_truth_says() {
    let sky = Sky::over(&traversal(Site::Backsburg, "10:00"));
    let route = RouteLine::through(&[[0.0, 0.0], [0.0, 5.0]], false);
    let terrain =
        Terrain::build(&route, 12.0, |_, _, _| Soil { height_m: 0.0, shares: [0.0, 1.0, 0.0, 0.0], tint: 0.2 });
    // A camera that looks north and a little down and aside, 0.9 m above the ground.
    let world_from_left = Se3::from_quaternion([-0.74, 0.06, 0.05, 0.67], [0.3, -0.4, 0.9]);
    let rig = rig((640, 360));
    for point in [[0.5, 4.0, 1.2], [-1.5, 3.0, 0.4], [1.0, 7.5, 2.0]] {
        let seen = world_from_left.inverse().apply(point);
        assert!(seen[2] > 1.0, "{seen:?}");
        let mut scene = Scene::new(1);
        let (u, v) = (v3(0.12, 0.0, 0.0), v3(0.0, 0.0, 0.12));
        let middle = v3(point[0] as f32, point[1] as f32, point[2] as f32);
        // A lamp of 12 cm: so bright that nothing else counts.
        let lamp = Facet {
            tint: v3(5e4, 5e4, 5e4),
            uv: [0.5, 0.5, 0.001, 0.001],
            ..Facet::solid(middle - (u + v) * 0.5, u, v, WOOD.first())
        };
        scene.add(lamp);
        let (facets, squares) = scene.into_squares();
        let world =
            World { route: route.clone(), terrain: terrain.clone(), facets, squares, net: None, horizon_seed: 1 };
        let shadows = ShadowMap::bake(&world, sky.to_sun, [-10.0; 2], [10.0; 2]);
        let hills = Hills::paint(1);
        let stage = Stage { world: &world, sky: &sky, shadows: &shadows, hills: &hills, wind: 0.0 };
        let [left, right] = render_pair(&stage, &rig, &world_from_left, 0.0);
        let (l, r) = (centre(&left, 2e3), centre(&right, 2e3));
        let expected = rig.project(seen);
        assert!((l[0] - expected[0]).abs() < 0.12 && (l[1] - expected[1]).abs() < 0.12, "{l:?} {expected:?}");
        let disparity = rig.focal_px * rig.baseline_m / seen[2];
        assert!((l[0] - r[0] - disparity).abs() < 0.12, "{} {disparity}", l[0] - r[0]);
        assert!((l[1] - r[1]).abs() < 0.05, "rows differ by {}", l[1] - r[1]);
    }
}

fn frames(traversal: &Traversal, threads: usize) -> Vec<Frame> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    pool.install(|| {
        let mut frames = Vec::new();
        simulate(traversal, |frame| {
            frames.push(frame);
            Ok::<(), BadTraversal>(())
        })
        .expect("a sound traversal");
        frames
    })
}

#[test]
fn the_same_pass_gives_the_same_bytes_on_any_number_of_threads() {
    for site in Site::ALL {
        let traversal = Traversal { length_m: 1.0, ..traversal(site, "08:00") };
        let (one, three) = (frames(&traversal, 1), frames(&traversal, 3));
        assert!(one.len() > 5 && one == three, "{site}");
    }
}

#[test]
fn passes_share_the_world_but_not_the_line_nor_the_noise() {
    let base = traversal(Site::Backsburg, "08:00");
    let other = Traversal { seed: 2, ..base.clone() };
    let second = Traversal { number: 1, ..base.clone() };
    assert!(base.world_seed() == other.world_seed() && base.world_seed() == second.world_seed());
    assert_ne!(base.world_seed(), Traversal { route: "vocabulary".to_owned(), ..base.clone() }.world_seed());
    let start = |traversal: &Traversal| {
        Simulation::prepare(traversal).expect("a sound traversal").world_from_left(0.0).translation_m
    };
    assert!(start(&base) != start(&other) && start(&base) != start(&second));
    assert!(second.start_ns() - base.start_ns() > 4 * 60 * 1_000_000_000);
}

#[test]
fn it_is_dark_at_half_past_four_and_bright_at_ten() {
    let exposure = |slot: &str| {
        let simulation = Simulation::prepare(&traversal(Site::Backsburg, slot)).expect("a sound traversal");
        simulation.take(&mut simulation.camera(), 0).exposure
    };
    let (night, day) = (exposure("04:30"), exposure("10:00"));
    assert!(night.gain > 8.0 && day.gain == 1.0 && day.time_s < 0.008, "{night:?} {day:?}");
}

#[test]
fn the_robot_drives_as_fast_and_as_straight_as_it_should() {
    for (site, slot) in [(Site::Backsburg, "08:00"), (Site::OldZoo, "16:00"), (Site::Lindenhof, "12:00")] {
        let simulation =
            Simulation::prepare(&Traversal { length_m: 60.0, weather: Weather::Hazy, ..traversal(site, slot) })
                .expect("a sound traversal");
        let poses: Vec<Se3> =
            (0..simulation.frames()).map(|i| simulation.world_from_left(simulation.time_s(i))).collect();
        for pair in poses.windows(2) {
            let step = pair[0].inverse().compose(&pair[1]);
            assert!((0.055..0.13).contains(&step.distance_m()), "{site}: {}", step.distance_m());
            assert!(step.yaw_rad().abs() < 0.06 && step.angle_rad() < 0.07, "{site}: {}", step.angle_rad());
        }
        let length: f64 = poses.windows(2).map(|pair| pair[0].inverse().compose(&pair[1]).distance_m()).sum();
        assert!((55.0..66.0).contains(&length), "{site}: {length}");
    }
}

#[test]
fn what_cannot_be_rendered_is_refused() {
    for size in [(641, 360), (0, 0), (640, 20), (9000, 360)] {
        assert!(matches!(
            Simulation::prepare(&Traversal { size, ..traversal(Site::Backsburg, "08:00") }),
            Err(BadTraversal::Size(..))
        ));
    }
    let endless = Traversal { length_m: f64::NAN, ..traversal(Site::Backsburg, "08:00") };
    assert!(matches!(Simulation::prepare(&endless), Err(BadTraversal::Length(_))));
}

#[test]
fn what_lies_under_the_trees_is_in_their_shade_whenever_it_came_there() {
    let world = build(&traversal(Site::Lindenhof, "12:00"));
    let under = |facet: &&Facet| {
        let near = |metre: u8| (facet.centre() - world.route.place(60.0 + f32::from(metre), 0.0)).length() < 1.2;
        // Weeds and fallen leaves, those that every traversal has and those of this one.
        (ROSETTE.first()..STONE.first()).contains(&facet.texture) && (0..20).any(near)
    };
    let lying: Vec<u8> = world.facets.iter().filter(under).map(|facet| facet.open).collect();
    let brightest = lying.iter().max();
    assert!(lying.len() > 100 && brightest < Some(&64), "of {} one has {brightest:?} of 255 of the sky", lying.len());
}
