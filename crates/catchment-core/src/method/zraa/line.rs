//! A single free translation: the height over a line, and its segment that slides into the seat.

use super::sheet::Sheet;
use glam::DVec2;

/// A segment of the line over which a plane is a candidate for the height.
pub(super) struct Segment {
    pub(super) from: f64,
    pub(super) to: f64,
    /// Height over 0, inside the stretch or not.
    pub(super) offset: f64,
    pub(super) slope: f64,
}

impl Segment {
    pub(super) fn height(&self, s: f64) -> f64 {
        self.offset + self.slope * s
    }
}

/// The interval around the mated pose, along `axis`, from which the motion leads back to it.
///
/// The height over the line is divided at every intersection and end of planes; outward from 0 every segment
/// must lie in the seat, at most `depth` above the height at 0, or fall towards 0, and no step may block the
/// motion.
pub(super) fn interval(sheets: &[Sheet], axis: DVec2, depth: f64, seam: f64) -> [f64; 2] {
    let segments: Vec<Segment> = sheets.iter().filter_map(|p| along(p, axis, seam)).collect();
    let tops = envelope(&segments);
    [-1.0, 1.0].map(|sign| sign * reach(&tops, sign, depth, seam)).map(|s| s + 0.0)
}

/// The part of a sheet over the line.
fn along(sheet: &Sheet, axis: DVec2, seam: f64) -> Option<Segment> {
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    let n = sheet.footprint.len();
    for k in 0..n {
        let (a, b) = (sheet.footprint[k], sheet.footprint[(k + 1) % n]);
        let side = (b - a).normalize_or_zero();
        // Inside if perp_dot(side, s·axis − a) ≥ −seam: linear in s.
        let (rate, at_zero) = (side.perp_dot(axis), -side.perp_dot(a) + seam);
        if rate.abs() <= seam {
            if at_zero < 0.0 {
                return None;
            }
        } else if rate > 0.0 {
            from = from.max(-at_zero / rate);
        } else {
            to = to.min(-at_zero / rate);
        }
    }
    (to - from > 4.0 * seam).then(|| Segment {
        from,
        to,
        offset: sheet.offset,
        slope: sheet.gradient.dot(axis),
    })
}

/// A stretch of the line and the segment that is the highest there.
#[derive(Clone, Copy)]
pub(super) struct Top<'a> {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) segment: &'a Segment,
}

/// The upper envelope of segments, from left to right: that of either half, merged.
pub(super) fn envelope(segments: &[Segment]) -> Vec<Top<'_>> {
    match segments {
        [] => Vec::new(),
        [segment] => vec![Top { from: segment.from, to: segment.to, segment }],
        _ => {
            let (left, right) = segments.split_at(segments.len() / 2);
            merged(&envelope(left), &envelope(right))
        }
    }
}

/// The higher of two envelopes.
fn merged<'a>(a: &[Top<'a>], b: &[Top<'a>]) -> Vec<Top<'a>> {
    let mut cuts: Vec<f64> = a.iter().chain(b).flat_map(|top| [top.from, top.to]).collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    let mut out: Vec<Top<'a>> = Vec::new();
    let mut push = |from: f64, to: f64, segment: &'a Segment| match out.last_mut() {
        Some(last) if last.to == from && std::ptr::eq(last.segment, segment) => last.to = to,
        _ => out.push(Top { from, to, segment }),
    };
    let (mut i, mut j) = (0, 0);
    for ends in cuts.windows(2) {
        let [from, to] = [ends[0], ends[1]];
        while a.get(i).is_some_and(|top| top.to <= from) {
            i += 1;
        }
        while b.get(j).is_some_and(|top| top.to <= from) {
            j += 1;
        }
        let over =
            |tops: &[Top<'a>], k: usize| tops.get(k).filter(|top| top.from <= from).map(|top| top.segment);
        match (over(a, i), over(b, j)) {
            (None, None) => {}
            (Some(only), None) | (None, Some(only)) => push(from, to, only),
            (Some(p), Some(q)) => {
                let higher = |at: f64| if q.height(at) > p.height(at) { q } else { p };
                let crossing = (q.offset - p.offset) / (p.slope - q.slope);
                if crossing > from && crossing < to {
                    push(from, crossing, higher(f64::midpoint(from, crossing)));
                    push(crossing, to, higher(f64::midpoint(crossing, to)));
                } else {
                    push(from, to, higher(f64::midpoint(from, to)));
                }
            }
        }
    }
    out
}

/// Distance from 0, in the direction of `sign`, up to which the motion leads back.
fn reach(tops: &[Top<'_>], sign: f64, depth: f64, seam: f64) -> f64 {
    let near = 10.0 * seam;
    let mated = tops.iter().filter(|top| top.from <= 0.0 && 0.0 <= top.to).map(|top| top.segment.offset);
    let level = mated.fold(f64::NEG_INFINITY, f64::max) + depth;
    // Outward from 0, in distances.
    let outward = |top: &Top<'_>| {
        let [from, to] = [top.from * sign, top.to * sign];
        (from.min(to), from.max(to))
    };
    let mut ahead: Vec<&Top<'_>> = tops.iter().filter(|top| outward(top).1 > near).collect();
    ahead.sort_by(|a, b| outward(a).0.total_cmp(&outward(b).0));
    let mut seated = true;
    let mut reached = 0.0;
    let mut below: Option<(f64, f64)> = None;
    for top in ahead {
        let (from, to) = outward(top);
        if from > reached + near {
            break;
        }
        if to - reached <= near {
            continue;
        }
        // Up a step outward is a drop on the way home; down a step outward is a wall.
        let segment = top.segment;
        // Ends are accurate to a few seams, so a steep segment may start lower than the previous end by that
        // much times the slope.
        let walled = below.is_some_and(|(z, slope)| {
            let steep = 1.0 + slope.abs() + segment.slope.abs();
            segment.height(reached * sign) < z - near * steep
        });
        seated &= [reached, to].into_iter().all(|s| segment.height(s * sign) <= level + near);
        if !seated && (segment.slope * sign <= seam || walled) {
            break;
        }
        reached = to;
        below = Some((segment.height(to * sign), segment.slope));
    }
    reached
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Between any two ends or intersections a single segment is the highest, and the envelope contains
        /// it.
        #[test]
        fn the_envelope_is_the_highest_everywhere(
            raw in prop::collection::vec((-4i32..4, 1i32..5, -3i32..3, -2i32..3), 1..12),
            at in prop::collection::vec(-4.5..8.5f64, 20),
        ) {
            let segments: Vec<Segment> = raw
                .iter()
                .map(|(from, length, offset, slope)| Segment {
                    from: f64::from(*from),
                    to: f64::from(from + length),
                    offset: f64::from(*offset),
                    slope: f64::from(*slope),
                })
                .collect();
            let tops = envelope(&segments);
            prop_assert!(tops.windows(2).all(|w| w[0].from < w[0].to && w[0].to <= w[1].from));
            for s in at {
                let over = |from: f64, to: f64| from < s && s < to;
                let brute = segments.iter().filter(|p| over(p.from, p.to)).map(|p| p.height(s)).reduce(f64::max);
                let result = tops.iter().find(|top| over(top.from, top.to)).map(|top| top.segment.height(s));
                // On an end itself, which random places do not hit, either may be missing.
                match (brute, result) {
                    (Some(brute), Some(result)) => prop_assert!((brute - result).abs() < 1e-9, "{brute} {result} at {s}"),
                    // The envelope may be missing only at the end of a piece, where the next begins.
                    (brute, result) => prop_assert_eq!(brute.is_some() && tops.iter().all(|t| t.from != s && t.to != s), result.is_some()),
                }
            }
        }
    }
}
