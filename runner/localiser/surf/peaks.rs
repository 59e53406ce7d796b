//! Samples of a row that may be maxima.

use std::ops::Range;

/// The `columns` where the middle one of three `lines` is above `threshold` and its four neighbours: few are left to be
/// compared with all
/// 26. Most blocks have none and are passed over as a whole.
#[inline(always)]
pub(super) fn for_each_peak(lines: [&[f32]; 3], columns: Range<usize>, threshold: f32, mut peak: impl FnMut(usize)) {
    const BLOCK: usize = 32;
    if columns.is_empty() {
        return;
    }
    let part = |line: usize, shift: usize| &lines[line][columns.start + shift - 1..columns.end + shift - 1];
    let (values, around) = (part(1, 1), [part(1, 0), part(1, 2), part(0, 1), part(2, 1)]);
    let is_peak = |value: f32, others: [f32; 4]| others.iter().fold(value > threshold, |peak, &o| peak & (value > o));
    let (blocks, rest) = values.as_chunks::<BLOCK>();
    let around_blocks = around.map(|values| values.as_chunks::<BLOCK>().0);
    for (index, block) in blocks.iter().enumerate() {
        let around = around_blocks.map(|blocks| &blocks[index]);
        let peaks: [bool; BLOCK] = std::array::from_fn(|i| is_peak(block[i], around.map(|values| values[i])));
        if peaks.iter().fold(false, |any, &peak| any | peak) {
            (0..BLOCK).filter(|&i| peaks[i]).for_each(|i| peak(columns.start + index * BLOCK + i));
        }
    }
    for (i, &value) in (values.len() - rest.len()..).zip(rest) {
        if is_peak(value, around.map(|values| values[i])) {
            peak(columns.start + i);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::for_each_peak;

    /// Rows of few levels, so that equal neighbours are common, against the definition column by column.
    #[test]
    fn peaks_are_the_samples_above_threshold_and_neighbours() {
        let row = |seed: usize| -> Vec<f32> { (0..171).map(|i| ((i * i * 7 + i * seed) % 31 / 3) as f32).collect() };
        let [above, line, below] = [row(11), row(23), row(5)];
        for columns in [1..170, 3..67, 9..9, 40..72, 100..101] {
            let mut found = Vec::new();
            for_each_peak([&above, &line, &below], columns.clone(), 4.0, |column| found.push(column));
            let is_peak = |c: &usize| {
                let around = [line[c - 1], line[c + 1], above[*c], below[*c]];
                line[*c] > 4.0 && around.iter().all(|&other| other < line[*c])
            };
            assert_eq!(found, columns.filter(is_peak).collect::<Vec<_>>());
        }
    }
}
