//! One free translation: the height over a line, and the stretch of it that slides home.

use super::sheet::Sheet;
use glam::DVec2;

/// A stretch of the line over which one plane is a candidate for the height.
struct Segment {
    from: f64,
    to: f64,
    offset: f64,
    slope: f64,
}

impl Segment {
    fn height(&self, s: f64) -> f64 {
        self.offset + self.slope * s
    }
}

/// The interval around the mated pose, along `axis`, from which the motion leads back to it.
///
/// The height over the line is cut where two planes cross or one ends; outward from 0 every stretch must lie in the seat, at most
/// `depth` above the height at 0, or fall towards 0, and no step may block the way.
pub(super) fn interval(sheets: &[Sheet], axis: DVec2, depth: f64, seam: f64) -> [f64; 2] {
    let segments: Vec<Segment> = sheets.iter().filter_map(|p| along(p, axis, seam)).collect();
    [-1.0, 1.0].map(|sign| sign * reach(&segments, sign, depth, seam)).map(|s| s + 0.0)
}

/// The part of a sheet over the line.
fn along(sheet: &Sheet, axis: DVec2, seam: f64) -> Option<Segment> {
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    let n = sheet.footprint.len();
    for k in 0..n {
        let (a, b) = (sheet.footprint[k], sheet.footprint[(k + 1) % n]);
        let side = (b - a).normalize_or_zero();
        // Inside where perp_dot(side, s·axis − a) ≥ −seam: linear in s.
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

/// How far from 0, in the direction of `sign`, the motion still leads back.
fn reach(segments: &[Segment], sign: f64, depth: f64, seam: f64) -> f64 {
    let near = 10.0 * seam;
    let mut cuts: Vec<f64> = segments.iter().flat_map(|s| [s.from, s.to]).collect();
    for (k, a) in segments.iter().enumerate() {
        for b in &segments[..k] {
            let crossing = (b.offset - a.offset) / (a.slope - b.slope);
            if crossing.is_finite() && crossing >= a.from.max(b.from) && crossing <= a.to.min(b.to) {
                cuts.push(crossing);
            }
        }
    }
    let mut cuts: Vec<f64> = cuts.into_iter().map(|s| s * sign).filter(|s| *s > near).collect();
    cuts.sort_by(f64::total_cmp);
    let mated = segments.iter().filter(|s| s.from <= 0.0 && 0.0 <= s.to).map(|s| s.offset);
    let level = mated.fold(f64::NEG_INFINITY, f64::max) + depth;
    let mut seated = true;
    let mut reached = 0.0;
    let mut below: Option<f64> = None;
    for cut in cuts {
        if cut - reached <= near {
            continue;
        }
        let middle = f64::midpoint(reached, cut) * sign;
        let top = segments
            .iter()
            .filter(|s| s.from <= middle && middle <= s.to)
            .max_by(|a, b| a.height(middle).total_cmp(&b.height(middle)));
        let Some(top) = top else { break };
        // Up a step outward is a drop on the way home; down a step outward is a wall.
        let walled = below.is_some_and(|z| top.height(reached * sign) < z - near);
        seated &= [reached, cut].into_iter().all(|s| top.height(s * sign) <= level + near);
        if !seated && (top.slope * sign <= seam || walled) {
            break;
        }
        reached = cut;
        below = Some(top.height(cut * sign));
    }
    reached
}
