//! A depth buffer: of every pixel the facet that is nearest to the eye, and its colour.
//!
//! ```text
//!    ┌───────c────┐      on every line of pixels the weights w_b, w_c of a facet's corners are linear in the column:
//!    │     ▒▒▒    │      only the span ▒ in which no weight is negative is visited, a column wider on either side, and
//!    │   ▒▒▒▒▒▒▒  │      there the weights decide; z = a + w_b (b − a) + w_c (c − a)
//!    a────────────b
//! ```
//!
//! The loops over pixels are plain, because this crate is not optimised in every profile. Nothing drawn is zero in every field, so what stays
//! empty is neither written nor read.

use super::draw::colour::Rgb;
use glam::DVec3;
use std::ops::Range;

/// How many times larger than shown the image is drawn, each way.
pub(super) const FINER: usize = 3;

/// Red, green and blue in one number that is not [`NOTHING`].
pub(super) fn packed([red, green, blue]: Rgb) -> u32 {
    u32::from_be_bytes([255, red, green, blue])
}

/// The colour where nothing is drawn.
const NOTHING: u32 = 0;

/// The image while it is drawn, in fine pixels.
pub(super) struct DepthBuffer {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Towards the eye.
    depth: Vec<f64>,
    /// As [`packed`], or [`NOTHING`].
    pub(super) colour: Vec<u32>,
    /// Number of the facet that is seen, from 1; 0 is none.
    facet: Vec<u32>,
    /// Columns of each row that may be drawn.
    drawn: Vec<Range<usize>>,
}

/// Half-width of a line, in fine pixels.
const HALF: i32 = 2;

/// The pixels no farther than [`HALF`] from the centre, row by row.
const DISC: [[f64; 2]; 13] = {
    let (mut disc, mut count) = ([[0.0; 2]; 13], 0);
    let (mut dx, mut dy) = (-HALF, -HALF);
    while dy <= HALF {
        if dx * dx + dy * dy <= HALF * HALF {
            disc[count] = [dx as f64, dy as f64];
            count += 1;
        }
        [dx, dy] = if dx < HALF { [dx + 1, dy] } else { [-HALF, dy + 1] };
    }
    assert!(count == disc.len());
    disc
};

/// Facets this close to each other, in fine pixels, are coplanar: the first drawn stays, so that no pattern
/// of rounding is visible.
const COINCIDENT: f64 = 1e-6;

/// The columns in which slope·(x + ½ − origin) ≥ least, give or take one on either side.
fn inside(columns: Range<usize>, slope: f64, least: f64, origin: f64) -> Range<usize> {
    /// Below this slope rounding could move a border by more than a column.
    const STEEP: f64 = 1e-3;
    if slope.abs() < STEEP {
        return columns;
    }
    let border = (least / slope + origin - 0.5).clamp(columns.start as f64, columns.end as f64);
    if slope > 0.0 {
        (border.floor() as usize).saturating_sub(1).max(columns.start)..columns.end
    } else {
        columns.start..(border.ceil() as usize + 2).min(columns.end)
    }
}

impl DepthBuffer {
    pub(super) fn new([width, height]: [usize; 2]) -> Self {
        let pixels = width * height;
        Self {
            width,
            height,
            depth: vec![0.0; pixels],
            colour: vec![NOTHING; pixels],
            facet: vec![0; pixels],
            drawn: vec![width..0; height],
        }
    }

    /// Towards the eye; −∞ where nothing is drawn.
    pub(super) fn depth(&self, index: usize) -> f64 {
        if self.colour[index] == NOTHING { f64::NEG_INFINITY } else { self.depth[index] }
    }

    /// Columns of a row may be drawn.
    fn extend(&mut self, row: usize, columns: Range<usize>) {
        let drawn = &mut self.drawn[row];
        *drawn = drawn.start.min(columns.start)..drawn.end.max(columns.end);
    }

    /// A triangle with corners in fine pixels and depth, in one colour, as part of a facet. Facets are numbered from 1.
    pub(super) fn triangle(&mut self, [a, b, c]: [DVec3; 3], colour: Rgb, facet: u32) {
        let shade = packed(colour);
        let area = (b - a).truncate().perp_dot((c - a).truncate());
        if area.abs() < 1e-9 {
            return;
        }
        let range = |u: f64, v: f64, w: f64, n: usize| {
            let lo = u.min(v).min(w).floor().max(0.0) as usize;
            let hi = (u.max(v).max(w).ceil().max(0.0) as usize).min(n);
            lo.min(hi)..hi
        };
        let (origin, to_b, to_c) = (a.truncate(), (b - a).truncate(), (c - a).truncate());
        let columns = range(a.x, b.x, c.x, self.width);
        for y in range(a.y, b.y, c.y, self.height) {
            let py = y as f64 + 0.5 - origin.y;
            // On this line the three weights are linear in the column: (x·Δ − …)/area.
            let mut span = columns.clone();
            for (slope, least) in [
                (to_c.y, py * to_c.x),
                (-to_b.y, -py * to_b.x),
                (to_b.y - to_c.y, py * (to_b.x - to_c.x) - area),
            ] {
                span = inside(span, slope * area.signum(), least * area.signum(), origin.x);
            }
            self.extend(y, span.clone());
            let row = y * self.width + span.start..y * self.width + span.end;
            let (depths, colours) = (&mut self.depth[row.clone()], &mut self.colour[row.clone()]);
            let facets = &mut self.facet[row];
            let mut k = 0;
            while k < depths.len() {
                let px = (span.start + k) as f64 + 0.5 - origin.x;
                let wb = (px * to_c.y - py * to_c.x) / area;
                let wc = (to_b.x * py - to_b.y * px) / area;
                if wb >= 0.0 && wc >= 0.0 && wb + wc <= 1.0 {
                    let z = a.z + wb * (b.z - a.z) + wc * (c.z - a.z);
                    if colours[k] == NOTHING || z > depths[k] + COINCIDENT {
                        (depths[k], colours[k], facets[k]) = (z, shade, facet);
                    }
                }
                k += 1;
            }
        }
    }

    /// The pixels no farther than [`HALF`] from a place.
    pub(super) fn around(&self, p: DVec3) -> Vec<usize> {
        let (width, height) = (self.width as f64, self.height as f64);
        let mut pixels = Vec::with_capacity(DISC.len());
        for [dx, dy] in &DISC {
            let (x, y) = (p.x + dx, p.y + dy);
            if x >= 0.0 && y >= 0.0 && x < width && y < height {
                pixels.push(x as usize + y as usize * self.width);
            }
        }
        pixels
    }

    /// A line slightly in front of its facets, if one of them is visible.
    pub(super) fn edge(&mut self, [a, b]: [DVec3; 2], colour: Rgb, facets: &[u32]) {
        /// Its offset to the front, in fine pixels.
        const PROUD: f64 = 9.0;
        let line = packed(colour);
        let steps = (b - a).truncate().length().ceil().max(1.0);
        for k in 0..=steps as usize {
            let p = a + (b - a) * (k as f64 / steps);
            let pixels = self.around(p);
            if !pixels.iter().any(|index| facets.contains(&self.facet[*index])) {
                continue;
            }
            for index in pixels {
                let depth = self.depth(index);
                if p.z + PROUD > depth {
                    self.colour[index] = line;
                    // Covered from now on, but no nearer than the facet: a later line may cross it.
                    self.depth[index] = depth.max(p.z);
                    let column = index % self.width;
                    self.extend(index / self.width, column..column + 1);
                }
            }
        }
    }

    /// RGBA pixels of the finished image: averages blocks of fine pixels; pixels without drawing are
    /// transparent.
    pub(super) fn averaged(&self) -> Vec<u8> {
        const BLOCK: u32 = (FINER * FINER) as u32;
        let width = self.width / FINER;
        let mut pixels = vec![0; 4 * width * (self.height / FINER)];
        for (y, line) in pixels.chunks_exact_mut(4 * width).enumerate() {
            let rows = FINER * y..FINER * (y + 1);
            let drawn = &self.drawn[rows.clone()];
            let [mut start, mut end] = [self.width, 0];
            for columns in drawn {
                [start, end] = [start.min(columns.start), end.max(columns.end)];
            }
            let mut x = start / FINER;
            while x < end.div_ceil(FINER).min(width) {
                // Red, green and blue, and how many fine pixels are drawn.
                let mut sums = [0u32; 4];
                let mut row = rows.start;
                while row < rows.end {
                    let mut k = row * self.width + FINER * x;
                    let past = k + FINER;
                    while k < past {
                        let colour = self.colour[k];
                        if colour != NOTHING {
                            sums[0] += colour >> 16 & 255;
                            sums[1] += colour >> 8 & 255;
                            sums[2] += colour & 255;
                            sums[3] += 1;
                        }
                        k += 1;
                    }
                    row += 1;
                }
                let n = sums[3].max(1);
                for channel in 0..3 {
                    line[4 * x + channel] = ((sums[channel] + n / 2) / n) as u8;
                }
                line[4 * x + 3] = (sums[3] * 255 / BLOCK) as u8;
                x += 1;
            }
        }
        pixels
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment_core::acceptance::Stream;
    use glam::DVec2;

    /// Brute judge: the weights of every pixel, of wide triangles and slivers, partly outside the image.
    #[test]
    fn no_pixel_of_a_triangle_is_left_out() {
        const SIDE: usize = 30;
        let random = Stream::new(7);
        for case in 0..400 {
            let number = |k: u64| random.branch(case).uniform(k);
            let corner = |k: u64| {
                DVec3::new(50.0 * number(3 * k) - 10.0, 50.0 * number(3 * k + 1) - 10.0, number(3 * k + 2))
            };
            let [a, b] = [corner(0), corner(1)];
            let c = if case % 2 == 0 { corner(2) } else { a.lerp(b, number(9)) + 1e-3 * corner(2) };
            let c = if case % 5 == 0 { DVec3::new(c.x, a.y, c.z) } else { c };
            let mut buffer = DepthBuffer::new([SIDE, SIDE]);
            buffer.triangle([a, b, c], [1, 2, 3], 4);
            let area = (b - a).truncate().perp_dot((c - a).truncate());
            for (k, facet) in buffer.facet.iter().enumerate() {
                let p = DVec2::new((k % SIDE) as f64 + 0.5, (k / SIDE) as f64 + 0.5) - a.truncate();
                let weights = [p.perp_dot((c - a).truncate()) / area, (b - a).truncate().perp_dot(p) / area];
                let inside = weights[0] >= 0.0 && weights[1] >= 0.0 && weights[0] + weights[1] <= 1.0;
                assert_eq!(*facet == 4, inside, "{case}: pixel {k} of {a}, {b}, {c}");
            }
        }
    }
}
