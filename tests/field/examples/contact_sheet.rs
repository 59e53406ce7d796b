//! Writes one picture of site x slot: `contact_sheet OUT.png [SITE,SITE] [SLOT,SLOT] [METRES] [WIDTHxHEIGHT] [ROUTE]`.

use furrow_field::{Simulation, Site, Traversal};
use std::fs::File;
use std::io::BufWriter;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let argument = |i: usize, default: &str| arguments.get(i).cloned().unwrap_or_else(|| default.to_owned());
    let sites =
        argument(1, "backsburg,lindenhof,old-zoo").split(',').map(str::parse).collect::<Result<Vec<Site>, _>>()?;
    let slots = argument(2, "04:30,06:00,08:00,10:00,12:00,14:00,16:00");
    let slots = slots.split(',').map(str::parse).collect::<Result<Vec<_>, _>>()?;
    let metres: Vec<f64> = argument(3, "8").split(',').map(str::parse).collect::<Result<_, _>>()?;
    let size = argument(4, "640x360");
    let (width, height) = size.split_once('x').ok_or("size: expected WIDTHxHEIGHT")?;
    let (width, height): (usize, usize) = (width.parse()?, height.parse()?);
    let (columns, rows) = (slots.len(), sites.len() * metres.len());
    let mut sheet = vec![0_u8; 3 * width * columns * height * rows];
    for (s, &site) in sites.iter().enumerate() {
        for (column, &slot) in slots.iter().enumerate() {
            let traversal = Traversal {
                size: (width as u32, height as u32),
                length_m: 1e3,
                route: argument(5, "main"),
                ..Traversal::new(site, slot)
            };
            let started = std::time::Instant::now();
            let simulation = Simulation::prepare(&traversal)?;
            let prepared = started.elapsed();
            for (m, metre) in metres.iter().enumerate() {
                let mut camera = simulation.camera();
                let frame = simulation.take(&mut camera, (metre / 0.75 * 8.0) as u64);
                let left = frame.left.ok_or("the frame was lost")?;
                let row = s * metres.len() + m;
                for y in 0..height {
                    let start = 3 * ((row * height + y) * width * columns + column * width);
                    for x in 0..width {
                        for channel in 0..3 {
                            sheet[start + 3 * x + channel] = left[3 * (y * width + x) + 2 - channel];
                        }
                    }
                }
            }
            let taken = started.elapsed() - prepared;
            eprintln!("{site} {slot}: prepared in {prepared:.2?}, {} frames in {taken:.2?}", metres.len());
        }
    }
    let mut encoder = png::Encoder::new(
        BufWriter::new(File::create(argument(0, "contact_sheet.png"))?),
        (width * columns) as u32,
        (height * rows) as u32,
    );
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(&sheet)?;
    Ok(())
}
