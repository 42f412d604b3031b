//! No motion passes through material: every waypoint is at first contact, or below it in free space.
//!
//! Two oracles, both independent of the motion: the height of first contact by [`brute`], and, where a half has slid under an overhang, an overlap test
//! of any two convex pieces of the halves, or of any facets of closed surfaces.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use catchment::acceptance::Outcome;
use catchment::connector::{Connector, Half, Surface};
use catchment::contact::{Pair, brute};
use catchment::design::{Alignment, ConnectorSpec, Design, HalfSpec, OwnSpec};
use catchment::method::descent::{DescentSettings, Trajectory, trace};
use catchment::pose::{CorPose, Dof, DofSet, Mount, PoseError};
use catchment::prelude::Problem;
use glam::DVec3;
use proptest::prelude::*;
use std::path::Path;

/// Rounding tolerance of a waypoint below first contact, and of the depth of an overlap, in D.
const DEEP: f64 = 1e-6;

/// The waypoints below first contact by more than [`DEEP`].
fn below_first_contact<'a>(
    pair: &'a Pair,
    path: &'a Trajectory,
) -> impl Iterator<Item = (CorPose, DVec3)> + 'a {
    path.waypoints.iter().filter_map(|waypoint| {
        let pose =
            CorPose::from_error(&waypoint.error, pair.alignment.center_of_rotation, pair.alignment.free);
        let first = if is_small(pair) { brute::height(pair, &pose) } else { pair.height(&pose) };
        let is_below = first.is_none_or(|z| z > waypoint.height + DEEP);
        is_below.then_some((pose, pose.lateral.extend(waypoint.height)))
    })
}

/// Whether the oracles, which compare every pair of facets, take no longer than a motion.
fn is_small(pair: &Pair) -> bool {
    let facets = |half: &Half| half.surfaces.iter().map(|s| s.facets.len()).sum::<usize>();
    facets(&pair.fixed) * facets(&pair.moving) < 3_000
}

/// Poses spread over the error box: fractions of multiples of 1/g, 1/g², … with g⁶ = g + 1 (Roberts 2018), from `start` on.
fn poses(pair: &Pair, count: u32, start: u32) -> impl Iterator<Item = PoseError> {
    const ROOT: f64 = 1.134_724_138_401_519_5;
    let (ranges, free) = (pair.alignment.half_ranges, pair.alignment.free);
    (start..start + count).map(move |k| {
        let mut error = [0.0; 5];
        for dof in free.iter() {
            let number = (f64::from(k) / ROOT.powi(i32::try_from(dof.index()).unwrap() + 1)).fract();
            error[dof.index()] = ranges[dof.index()] * (2.0 * number - 1.0);
        }
        PoseError::from_array(error)
    })
}

// --- Convex pieces: overlap by separating axes. ---

/// Depth of overlap of two convex polyhedra: the least over the normals of their facets and the directions across one edge of
/// each (Gottschalk 1996), negative where they are apart.
fn depth(a: &Surface, b: &Surface) -> f64 {
    let edges = |s: &Surface| -> Vec<DVec3> {
        s.edges.iter().map(|e| s.vertices[e.ends[1] as usize] - s.vertices[e.ends[0] as usize]).collect()
    };
    let (of_a, of_b) = (edges(a), edges(b));
    let normals = a.facets.iter().chain(&b.facets).map(|f| f.normal);
    let across = of_a.iter().flat_map(|u| of_b.iter().map(|w| u.cross(*w)));
    normals
        .chain(across)
        .filter_map(DVec3::try_normalize)
        .map(|axis| {
            let span = |s: &Surface| {
                s.vertices
                    .iter()
                    .map(|v| axis.dot(*v))
                    .fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)])
            };
            let ([al, ah], [bl, bh]) = (span(a), span(b));
            (ah - bl).min(bh - al)
        })
        .fold(f64::INFINITY, f64::min)
}

/// Two halves made of strips between the same two planes y = ±`wide`: prisms under and over a polyline.
struct Extruded {
    /// The strips of the fixed half, as drawn.
    strips: Vec<Vec<[f64; 3]>>,
    /// Convex pieces of the fixed half, and of the moving half relative to the COR.
    pieces: [Vec<Surface>; 2],
    pair: Pair,
}

const FACE: f64 = 0.15;

/// `heights` of the fixed half at evenly spaced x; the moving half lies against it, lower by `play` at each knot.
fn extruded(heights: &[f64], play: &[f64], wide: f64, alignment: &Alignment) -> Extruded {
    let count = heights.len();
    let x = |k: usize| k as f64 / (count - 1) as f64 - 0.5;
    let strips = |level: &dyn Fn(usize) -> f64| -> Vec<Vec<[f64; 3]>> {
        (0..count - 1)
            .map(|k| {
                let ends = [(x(k), level(k)), (x(k + 1), level(k + 1)), (x(k + 1), -0.2), (x(k), -0.2)];
                ends.iter().flat_map(|&(x, z)| [[x, -wide, z], [x, wide, z]]).collect()
            })
            .collect()
    };
    let halves = [strips(&|k| heights[k]), strips(&|k| 2.0 * FACE - heights[k] - play[k])];
    let pieces = [0, 1].map(|side| {
        let convex = |corners: &Vec<[f64; 3]>| {
            let placed = corners.iter().map(|&p| {
                let p = DVec3::from_array(p) - DVec3::Z * FACE;
                if side == 0 { p } else { Mount::X.apply(p) + DVec3::Z * alignment.center_of_rotation }
            });
            catchment::connector::convex_hull(&placed.collect::<Vec<_>>()).unwrap()
        };
        halves[side].iter().map(convex).collect()
    });
    let [strips, facing] = halves;
    let [fixed, moving] = [strips.clone(), facing].map(HalfSpec::Pieces);
    let connector = ConnectorSpec::Own(OwnSpec::new(FACE, fixed, moving));
    let design =
        Design { name: String::new(), connector, width: 1.0, unit: None, alignment: alignment.clone() };
    let pair = Pair::new(&Connector::build(&design).unwrap(), alignment);
    Extruded { strips, pieces, pair }
}

fn alignment(free: &[Dof], cor: f64) -> Alignment {
    let mut alignment = Alignment::new(free.iter().copied().collect::<DofSet>(), Mount::X);
    alignment.center_of_rotation = cor;
    alignment.half_ranges = [0.6, 0.3, 0.5, 1.0, 1.0];
    alignment
}

impl Extruded {
    /// The deepest overlap of any two pieces.
    fn overlap(&self, pose: &CorPose, cor: DVec3) -> f64 {
        let [fixed, moving] = &self.pieces;
        let placed: Vec<Surface> = moving.iter().map(|s| s.mapped(|p| pose.rotation * p + cor)).collect();
        let pairs = fixed.iter().flat_map(|f| placed.iter().map(move |m| depth(f, m)));
        pairs.fold(f64::NEG_INFINITY, f64::max)
    }

    fn passes_through_nothing(&self, error: &PoseError) -> Result<Outcome, TestCaseError> {
        let path = trace(&self.pair, error, &DescentSettings::default());
        for (pose, cor) in below_first_contact(&self.pair, &path) {
            let deep = self.overlap(&pose, cor);
            prop_assert!(deep <= DEEP, "{error:?}: {deep} D deep at {pose:?}, {cor}");
        }
        Ok(path.outcome)
    }
}

#[test]
fn halves_that_end_in_the_same_planes_do_not_pass_through_each_other() {
    // A V of two slopes, and of four: motions with offsets and both rotations once passed up to 0.31 D into
    // material.
    let low = alignment(&[Dof::X, Dof::Pitch, Dof::Yaw], -0.5);
    let v = extruded(&[0.25, 0.0, 0.25], &[0.05, 0.05, 0.05], 0.5, &low);
    let missed = PoseError { x: -0.129_114_4, pitch: 0.626_097_4, yaw: 0.283_553_4, ..PoseError::default() };
    v.passes_through_nothing(&missed).unwrap();
    let high = alignment(&[Dof::X, Dof::Pitch, Dof::Yaw], -0.3);
    let w = extruded(&[0.3, 0.0, 0.25, 0.05, 0.3], &[0.0; 5], 0.3, &high);
    for error in poses(&w.pair, 40, 7) {
        w.passes_through_nothing(&error).unwrap();
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    /// Random profiles, mated between the same two planes, with and without play, over every choice of errors that keeps them between these
    /// planes for part of the way.
    #[test]
    fn random_extruded_halves_do_not_pass_through_each_other(
        heights in proptest::collection::vec(0.0..0.3f64, 3..7), loose in proptest::collection::vec(0.0..0.1f64, 7),
        has_play in any::<bool>(), wide in 0.1..0.6f64, cor in -0.6..0.6f64, start in 0..100_000u32,
        free in proptest::sample::select(vec![
            vec![Dof::X, Dof::Pitch], vec![Dof::X, Dof::Pitch, Dof::Yaw], vec![Dof::X, Dof::Y, Dof::Pitch],
            vec![Dof::X, Dof::Roll, Dof::Pitch], Dof::ALL.to_vec(),
        ]),
    ) {
        let play: Vec<f64> = loose.iter().map(|p| if has_play { *p } else { 0.0 }).collect();
        let halves = extruded(&heights, &play, wide, &alignment(&free, cor));
        for error in poses(&halves.pair, 6, start) {
            halves.passes_through_nothing(&error)?;
        }
    }
}

// --- Every committed design. ---

/// Solid angle of a closed surface seen from a point, as a share of 4π: 1 inside, 0 outside (van Oosterom and Strackee 1983).
fn winding(surface: &Surface, point: DVec3) -> f64 {
    let mut angle = 0.0;
    for facet in &surface.facets {
        let at = |k: u32| surface.vertices[k as usize] - point;
        let a = at(facet.corners[0]);
        for corners in facet.corners[1..].windows(2) {
            let (b, c) = (at(corners[0]), at(corners[1]));
            let (la, lb, lc) = (a.length(), b.length(), c.length());
            let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            angle += 2.0 * a.dot(b.cross(c)).atan2(below);
        }
    }
    angle / (4.0 * std::f64::consts::PI)
}

/// A point of one surface more than [`DEEP`] inside both: tried near the corners, the sides and the middle of every facet.
fn shared_point(a: &Surface, b: &Surface) -> Option<DVec3> {
    let (low, high) = b.bounds();
    a.facets.iter().find_map(|facet| {
        let corners: Vec<DVec3> = facet.corners.iter().map(|&k| a.vertices[k as usize]).collect();
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let next = corners.iter().cycle().skip(1);
        let along =
            corners.iter().zip(next).flat_map(|(p, q)| (0..8).map(move |k| p.lerp(*q, f64::from(k) / 8.0)));
        let tried = along.flat_map(|p| [0.001, 0.1, 0.5].map(|share| p.lerp(middle, share))).chain([middle]);
        tried
            .map(|p| p - facet.normal * (2.0 * DEEP))
            .filter(|p| p.cmpge(low).all() && p.cmple(high).all())
            .find(|p| winding(b, *p) > 0.5 && winding(a, *p) > 0.5)
    })
}

#[test]
fn no_design_passes_through_itself() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs");
    let files = ["", "gallery"].into_iter().flat_map(|folder| {
        let mut files: Vec<_> =
            std::fs::read_dir(root.join(folder)).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.retain(|path| path.extension().is_some_and(|e| e == "toml"));
        files.sort();
        files
    });
    for file in files {
        let problem = Problem::open(&file).unwrap();
        let pair = problem.pair();
        let count = if is_small(pair) { 15 } else { 3 };
        for error in poses(pair, count, 3) {
            let path = trace(pair, &error, &DescentSettings::default());
            // With many facets only the last waypoint: a half that has passed a wall stays behind it.
            let below: Vec<_> = below_first_contact(pair, &path).collect();
            for (pose, cor) in
                if is_small(pair) { &below[..] } else { &below[below.len().saturating_sub(1)..] }
            {
                let placed: Vec<Surface> =
                    pair.moving.surfaces.iter().map(|s| s.mapped(|p| pose.rotation * p + *cor)).collect();
                let shared = pair.fixed.surfaces.iter().find_map(|fixed| {
                    placed.iter().find_map(|m| shared_point(m, fixed).or_else(|| shared_point(fixed, m)))
                });
                assert_eq!(shared, None, "{}: {error:?}, {pose:?}, {cor}", file.display());
            }
        }
    }
}

/// A tip with a flat lands on a level rim: as soon as both lie flush, no descent direction remains, and it jams
/// there.
#[test]
fn a_tip_that_lands_flat_stays_where_it_lies() {
    // A groove between x = ±¼ in a level rim at z = 0.3; the tip's flat, 0.2 D wide, lies on the rim beside it.
    let all = alignment(&Dof::ALL, -0.3);
    let rim = extruded(&[0.3, 0.3, 0.05, 0.3, 0.3], &[0.0, 0.0, 0.0, 0.0, 0.0], 0.4, &all);
    let tip = |z: f64, x: f64, y: f64| [[-x, -y, z], [x, -y, z], [-x, y, z], [x, y, z]];
    let pieces = vec![[tip(0.25, 0.1, 0.1), tip(0.0, 0.3, 0.3)].concat()];
    let fixed = HalfSpec::Pieces(rim.strips.clone());
    let connector = ConnectorSpec::Own(OwnSpec::new(FACE, fixed, HalfSpec::Pieces(pieces)));
    let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment: all.clone() };
    let pair = Pair::new(&Connector::build(&design).unwrap(), &all);
    for k in 0..40 {
        let part = |step: f64| (f64::from(k) * step).fract() - 0.5;
        let error = PoseError {
            x: 0.4 + 0.02 * part(0.83),
            y: 0.1 * part(0.69),
            roll: 0.2 * part(0.58),
            pitch: 0.2 * part(0.48),
            yaw: 0.5 * part(0.4),
        };
        let path = trace(&pair, &error, &DescentSettings::default());
        assert_eq!(path.outcome, Outcome::Jammed, "{error:?}");
        let last = path.waypoints.last().unwrap();
        let flush = path.waypoints.iter().filter(|w| w.height - last.height < 1e-6);
        // The last tilts to close, of 10⁻³ and less, continue over some 10⁻⁴ D; before the fix, one continued over a whole step of
        // 0.02 D.
        for w in flush {
            let drift = (w.error.x - last.error.x).hypot(w.error.y - last.error.y);
            assert!(drift < 3e-4, "{error:?}: {drift}");
        }
    }
}
