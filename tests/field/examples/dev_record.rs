//! Temporary.
use furrow_field::{Pass, record};
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let a: Vec<String> = std::env::args().skip(1).collect();
    let pass = Pass { length_m: a[3].parse()?, seed: a[4].parse()?, route: a.get(5).cloned().unwrap_or("main".into()), ..Pass::new(a[1].parse()?, a[2].parse()?) };
    let t = std::time::Instant::now();
    let mut last = 0;
    let s = record(&pass, a[0].as_ref(), &mut |d, n| if d * 10 / n != last { last = d * 10 / n; eprintln!("{d}/{n} {:.1?}", t.elapsed()) })?;
    println!("{s:?}");
    Ok(())
}
