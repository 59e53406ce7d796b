//! Words and descriptors out of a stream of numbers that is the same every time.

use furrow_runner::localiser::Presence;
use furrow_runner::localiser::vocabulary::Descriptor;

/// A stream of numbers for synthetic words, the same every time (Steele, Lea and Flood 2014).
struct Mix(u64);

impl Mix {
    fn below(&mut self, count: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % count
    }
}

/// Images of about 190 words, frequent ones more often.
pub fn images(count: usize, words: u64, seed: u64) -> Vec<Presence> {
    let mut mix = Mix(seed);
    let mut word = || (mix.below(words).min(mix.below(words))) as u32;
    (0..count).map(|_| (0..190).map(|_| word()).collect()).collect()
}

/// Unit vectors around 20 000 directions, some of them often: as hard to cluster as descriptors of a field.
pub fn descriptors(count: usize) -> Vec<Descriptor> {
    let mut mix = Mix(3);
    let mut bell = || (0..4).map(|_| mix.below(1 << 20) as f32 / (1 << 19) as f32 - 1.0).sum::<f32>();
    let directions: Vec<Descriptor> = (0..20_000).map(|_| std::array::from_fn(|_| bell())).collect();
    let mut choice = Mix(5);
    let mut around = || {
        let direction = choice.below(20_000).min(choice.below(20_000)) as usize;
        let near: Descriptor = std::array::from_fn(|k| directions[direction][k] + 0.6 * bell());
        let length = near.iter().map(|number| number * number).sum::<f32>().sqrt();
        near.map(|number| number / length)
    };
    (0..count).map(|_| around()).collect()
}
