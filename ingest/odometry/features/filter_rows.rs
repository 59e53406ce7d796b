//! The four 5x5 masks, one row of the image at a time. Each mask is a sum of products of a vertical and a horizontal
//! profile: the vertical profiles are summed once per row, the horizontal ones applied to these sums.

/// Pixels at the border where a 5x5 mask does not fit.
pub(crate) const MASK_RADIUS: usize = 2;

/// The five vertical profiles of one row.
pub(super) struct ColumnSums {
    /// 1 4 6 4 1.
    smooth: Vec<i16>,
    /// -1 -2 0 2 1.
    slope: Vec<i16>,
    /// 1 1 1 1 1.
    five: Vec<i16>,
    /// 0 1 1 1 0.
    three: Vec<i16>,
    /// 1 1 0 -1 -1.
    sign: Vec<i16>,
}

impl ColumnSums {
    pub fn new(width: usize) -> Self {
        let row = || vec![0; width];
        Self { smooth: row(), slope: row(), five: row(), three: row(), sign: row() }
    }

    /// Sums up the columns of five rows.
    #[inline(always)]
    pub fn gather(&mut self, rows: [&[u8]; 5]) {
        let width = self.smooth.len();
        let [a, b, c, d, e] = rows.map(|row| &row[..width]);
        let (smooth, slope) = (&mut self.smooth[..width], &mut self.slope[..width]);
        for u in 0..width {
            let (a, b, c, d, e) = (i16::from(a[u]), i16::from(b[u]), i16::from(c[u]), i16::from(d[u]), i16::from(e[u]));
            smooth[u] = a + e + 4 * (b + d) + 6 * c;
            slope[u] = (e - a) + 2 * (d - b);
        }
        let (five, three, sign) = (&mut self.five[..width], &mut self.three[..width], &mut self.sign[..width]);
        for u in 0..width {
            let (a, b, c, d, e) = (i16::from(a[u]), i16::from(b[u]), i16::from(c[u]), i16::from(d[u]), i16::from(e[u]));
            three[u] = b + c + d;
            five[u] = a + b + c + d + e;
            sign[u] = (a + b) - (d + e);
        }
    }

    #[inline(always)]
    pub fn sobel_u(&self, out: &mut [u8]) {
        let [a, b, _, d, e] = shifted(&self.smooth, out.len());
        for (u, value) in out.iter_mut().enumerate() {
            *value = to_byte((e[u] - a[u]) + 2 * (d[u] - b[u]));
        }
    }

    #[inline(always)]
    pub fn sobel_v(&self, out: &mut [u8]) {
        let [a, b, c, d, e] = shifted(&self.slope, out.len());
        for (u, value) in out.iter_mut().enumerate() {
            *value = to_byte(a[u] + e[u] + 4 * (b[u] + d[u]) + 6 * c[u]);
        }
    }

    /// -1 over 5x5, +1 over the inner 3x3, 8 in the middle: -five + 2 three + 7 centre.
    #[inline(always)]
    pub fn blob(&self, centre: &[u8], out: &mut [i16]) {
        let [a, b, c, d, e] = shifted(&self.five, out.len());
        let [_, f, g, h, _] = shifted(&self.three, out.len());
        let centre = &centre[MASK_RADIUS..MASK_RADIUS + out.len()];
        for (u, value) in out.iter_mut().enumerate() {
            *value = 2 * (f[u] + g[u] + h[u]) + 7 * i16::from(centre[u]) - (a[u] + b[u] + c[u] + d[u] + e[u]);
        }
    }

    #[inline(always)]
    pub fn corner(&self, out: &mut [i16]) {
        let [a, b, _, d, e] = shifted(&self.sign, out.len());
        for (u, value) in out.iter_mut().enumerate() {
            *value = (d[u] + e[u]) - (a[u] + b[u]);
        }
    }
}

/// The five shifted views of a row of profiles that a horizontal mask of `len` outputs reads.
#[inline(always)]
fn shifted(row: &[i16], len: usize) -> [&[i16]; 5] {
    std::array::from_fn(|i| &row[i..i + len])
}

/// A Sobel sum (at most 48 * 255 in magnitude) as a byte around 128. An edge of 85 grey levels saturates. Weaker
/// gradients, which are most of the texture, keep their resolution.
#[inline(always)]
fn to_byte(sum: i16) -> u8 {
    ((sum >> SOBEL_SHIFT) + 128).clamp(0, 255) as u8
}

const SOBEL_SHIFT: i16 = 5;
