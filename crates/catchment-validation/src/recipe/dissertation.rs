//! The conventions behind the dissertation's printed tables 5.4 to 5.11.
//!
//! They were recovered from the printed numbers; several contradict the text, and most were fitted on these very
//! tables, without an independent check. They reproduce the numbers; they are not physics, and never the default.
//!
//! - **Rotation point**: on the axis behind the mated apex plane, `lever·(1 − COR)` away. The planar bodies have a block
//!   half a width thick behind the face, and their lever is the total height H + D/2; the pyramid's is D where
//!   (x, y, pitch) is sampled and H where two rotations are. (The text: from the centre, in units of D.)
//!   No single convention explains the four tables of the pyramid: of 96 tested (levers D, H, H + D/2 and (H + D)/2, either order of the
//!   rotations, flat cells minima or not, dams passed on or not, counted by three rules) this one is the best for each of 5.9, 5.10 and 5.11
//!   (mean |ln ratio| 0.43, 0.05, 0.14), whereas 5.8 has 0.93 with it and 0.06 with its own lever.
//! - **Samples** are on the rotation point's own coordinates: x, y in [−2, 2] with both ends, 101 in the plane and 31
//!   in space; angles over [−π/2, π/2] with both ends in the plane (101), without the lower end in space (30). A
//!   sample counts range/100 per axis in the plane and range/31 in space.
//! - **Pyramid angles**: pitch turns about x, roll about y, yaw about z, the last named first: `R = Rx(pitch)·Ry(roll)`,
//!   `Rx(pitch)·Rz(yaw)`, `Ry(roll)·Rz(yaw)`.
//! - **Flooding**: basins below a depth of 0.1·AR are merged; dam cells pass water on (as in the text). In space each
//!   cell without a lower neighbour is a minimum (as in the text); in the plane plateaus that drain are not, which
//!   reproduces one entry more.
//! - **Dams**: in the plane a dam cell goes to the neighbouring basin whose labelled cell is lowest, but never to one
//!   that reaches below the docking height; in space dam cells count for no basin. (The text: steepest descent.)

use catchment::connector::{Connector, GeometryDefect};
use catchment::contact::{Lattice, Pair};
use catchment::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
use catchment::exec::{Cancelled, Exec};
use catchment::method::flood::FloodError;
use catchment::method::flood::meyer::{self, Division, Rules};
use catchment::pose::{Dof, DofSet, Mount};
use glam::DMat3;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI};

/// The errors that a table samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SampledErrors {
    /// x and the planar rotation: tables 5.4 to 5.7.
    XTheta,
    /// x, y and pitch: table 5.8.
    XYPitch,
    /// x, pitch and roll: table 5.9.
    XPitchRoll,
    /// x, pitch and yaw: table 5.10.
    XPitchYaw,
    /// x, roll and yaw: table 5.11.
    XRollYaw,
}

/// The rotation by an angle about one axis.
type Turn = fn(f64) -> DMat3;

impl SampledErrors {
    /// The first and the second of two rotations of a half; `None` if there are fewer.
    fn turns(self) -> Option<[Turn; 2]> {
        match self {
            Self::XTheta | Self::XYPitch => None,
            Self::XPitchRoll => Some([DMat3::from_rotation_x, DMat3::from_rotation_y]),
            Self::XPitchYaw => Some([DMat3::from_rotation_x, DMat3::from_rotation_z]),
            Self::XRollYaw => Some([DMat3::from_rotation_y, DMat3::from_rotation_z]),
        }
    }
}

/// One entry of a table: the connector and all settings that affect the result.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DissertationSettings {
    /// The connector: a planar family for [`SampledErrors::XTheta`], the pyramid for the others.
    pub family: Family,
    /// H/D.
    pub aspect_ratio: f64,
    /// The dissertation's COR: 1 is the apex plane, 0 one lever behind it.
    pub cor: f64,
    /// The sampled errors.
    pub errors: SampledErrors,
    /// Depth below which basins are merged, in D.
    pub depth_tolerance: f64,
    /// Samples per axis in the plane, both ends included: [`Self::PLANAR_SAMPLES`] in the tables, others in figure 5.13.
    pub planar_samples: usize,
}

/// The samples, and which of them belong to the target basin.
#[derive(Debug, Clone, PartialEq)]
pub struct BasinSamples {
    /// Samples per axis; the first axis runs fastest.
    pub shape: Vec<usize>,
    /// Whether each sample is accepted.
    pub accepted: Vec<bool>,
    /// Measure of a sample, Dᵃ·radᵇ.
    pub cell_measure: f64,
}

impl BasinSamples {
    /// Number of accepted samples.
    pub fn count(&self) -> usize {
        self.accepted.iter().filter(|a| **a).count()
    }

    /// The Sum area of acceptance, Dᵃ·radᵇ.
    pub fn sum(&self) -> f64 {
        self.count() as f64 * self.cell_measure
    }
}

/// Why an entry cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DissertationError {
    /// The family does not exist at this aspect ratio.
    #[error("a {} of aspect ratio {aspect_ratio} cannot be drawn: {}", .family.name(), list(problems))]
    Geometry {
        /// The family.
        family: Family,
        /// Its aspect ratio.
        aspect_ratio: f64,
        /// The defect.
        problems: Vec<GeometryDefect>,
    },
    /// The samples cannot be flooded.
    #[error(transparent)]
    Flood(#[from] FloodError),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

fn list(problems: &[GeometryDefect]) -> String {
    problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}

/// Half-range of x and y, in D.
const LATERAL: f64 = 2.0;
/// Samples of x and y in space, both ends included.
const SPATIAL: usize = 31;
/// Heights are rounded to this, in D, so that heights that are equal in exact arithmetic are equal here: flat cells
/// count as minima, and rounding errors of 1e-16 must not create or remove minima.
const HEIGHT_STEP: f64 = 1e-9;

impl DissertationSettings {
    /// Depth tolerance as a share of H.
    pub const DEPTH_PER_FACE_HEIGHT: f64 = 0.1;
    /// Samples per axis of the planar tables, both ends included.
    pub const PLANAR_SAMPLES: usize = 101;

    /// An entry with the tolerance of the text.
    pub fn new(family: Family, errors: SampledErrors, aspect_ratio: f64, cor: f64) -> Self {
        let depth_tolerance = Self::DEPTH_PER_FACE_HEIGHT * aspect_ratio;
        Self { family, aspect_ratio, cor, errors, depth_tolerance, planar_samples: Self::PLANAR_SAMPLES }
    }

    /// Thickness of the block behind both planar faces, in D.
    const fn base_thickness(&self) -> Option<f64> {
        match self.errors {
            SampledErrors::XTheta => Some(0.5),
            _ => None,
        }
    }

    /// The rotation point in catchment's convention: signed distance in front of the face centre, in D.
    pub fn center_of_rotation(&self) -> f64 {
        let lever = match self.errors {
            SampledErrors::XTheta => self.aspect_ratio + 0.5,
            SampledErrors::XYPitch => 1.0,
            SampledErrors::XPitchRoll | SampledErrors::XPitchYaw | SampledErrors::XRollYaw => {
                self.aspect_ratio
            }
        };
        self.aspect_ratio / 2.0 - lever * (1.0 - self.cor)
    }

    fn pair(&self) -> Result<Pair, DissertationError> {
        let spec = FamilySpec::new(self.family)
            .with_aspect_ratio(self.aspect_ratio)
            .with_base_thickness(self.base_thickness());
        let (free, mount) = match self.errors {
            SampledErrors::XTheta => ([Dof::X, Dof::Pitch].into_iter().collect(), Mount::Y),
            _ => (DofSet::ALL, Mount::X),
        };
        let alignment =
            Alignment { center_of_rotation: self.center_of_rotation(), ..Alignment::new(free, mount) };
        let design = Design {
            name: String::new(),
            connector: ConnectorSpec::Family(spec),
            width: 1.0,
            unit: None,
            alignment,
        };
        let connector = Connector::build(&design).map_err(|problems| DissertationError::Geometry {
            family: self.family,
            aspect_ratio: self.aspect_ratio,
            problems,
        })?;
        Ok(Pair::new(&connector, &design.alignment))
    }
}

/// The sampling points of the heights: a lattice of rotation points at each of a list of rotations.
struct Samples {
    x: Lattice,
    y: Lattice,
    /// Numbers of angles per rotation axis, the first running fastest.
    angles: Vec<usize>,
    rotations: Vec<DMat3>,
    cell_measure: f64,
    /// The sample at the mated pose.
    mated: usize,
}

impl Samples {
    fn of(errors: SampledErrors, in_plane: usize) -> Self {
        let ends =
            |count: usize| Lattice { first: -LATERAL, step: 2.0 * LATERAL / (count - 1) as f64, count };
        let locked = Lattice { first: 0.0, step: 0.0, count: 1 };
        let middle = |lattice: &Lattice| lattice.count / 2;
        // The plane includes both ends; space omits the lower end.
        let planar: Vec<f64> =
            (0..in_plane).map(|k| PI * k as f64 / (in_plane - 1) as f64 - FRAC_PI_2).collect();
        let spatial: Vec<f64> =
            (1..SPATIAL).map(|k| PI * k as f64 / (SPATIAL - 1) as f64 - FRAC_PI_2).collect();
        let (x, y, angles, rotations): (_, _, _, Vec<DMat3>) = match (errors, errors.turns()) {
            (_, Some([first, second])) => {
                let pairs = spatial.iter().flat_map(|b| spatial.iter().map(move |a| first(*a) * second(*b)));
                (ends(SPATIAL), locked, vec![spatial.len(); 2], pairs.collect())
            }
            (SampledErrors::XTheta, None) => {
                let rotations = planar.iter().map(|a| DMat3::from_rotation_y(*a)).collect();
                (ends(in_plane), locked, vec![in_plane], rotations)
            }
            (_, None) => {
                let rotations = spatial.iter().map(|a| DMat3::from_rotation_x(*a)).collect();
                (ends(SPATIAL), ends(SPATIAL), vec![spatial.len()], rotations)
            }
        };
        let (weights, per_axis): (Vec<f64>, usize) = match errors {
            SampledErrors::XTheta => (vec![2.0 * LATERAL, PI], in_plane - 1),
            SampledErrors::XYPitch => (vec![2.0 * LATERAL, 2.0 * LATERAL, PI], SPATIAL),
            _ => (vec![2.0 * LATERAL, PI, PI], SPATIAL),
        };
        let cell_measure = weights.iter().map(|range| range / per_axis as f64).product();
        // Without the lower end the sample at 0 is the 15th of 30, number 14.
        let zero = match errors {
            SampledErrors::XTheta => in_plane / 2,
            _ => SPATIAL / 2 - 1,
        };
        let rotation = angles.iter().rev().fold(0, |index, count| index * count + zero);
        let mated = middle(&x) + x.count * (middle(&y) + y.count * rotation);
        Self { x, y, angles, rotations, cell_measure, mated }
    }

    fn shape(&self) -> Vec<usize> {
        let lateral = [self.x.count, self.y.count].into_iter().filter(|count| *count > 1);
        lateral.chain(self.angles.iter().copied()).collect()
    }

    fn heights(&self, pair: &Pair, exec: &Exec) -> Result<Vec<f64>, Cancelled> {
        let slab = self.x.count * self.y.count;
        let mut heights = vec![0.0f64; slab * self.rotations.len()];
        for (rotation, out) in self.rotations.iter().zip(heights.chunks_exact_mut(slab)) {
            exec.check()?;
            pair.at_rotation(*rotation).heights(self.x, self.y, out);
        }
        for height in heights.iter_mut().filter(|h| h.is_finite()) {
            *height = (*height / HEIGHT_STEP).round() * HEIGHT_STEP;
        }
        Ok(heights)
    }
}

/// Computes one entry.
///
/// # Errors
/// When the family does not exist at this aspect ratio, or the computation is cancelled.
pub fn accept(settings: &DissertationSettings, exec: &Exec) -> Result<BasinSamples, DissertationError> {
    let pair = settings.pair()?;
    let samples = Samples::of(settings.errors, settings.planar_samples.max(2));
    let heights = samples.heights(&pair, exec)?;
    let shape = samples.shape();
    let planar = settings.errors == SampledErrors::XTheta;
    let rules = Rules { flat_cells_are_minima: !planar, dams_pass_water_on: true };
    let targets = [samples.mated];
    let division = meyer::divide(&shape, &heights, &targets, settings.depth_tolerance, rules, exec)?;
    let accepted = accepted(&heights, samples.mated, &division, planar);
    Ok(BasinSamples { shape, accepted, cell_measure: samples.cell_measure })
}

/// Whether each sample belongs to the basin of the mated sample; dam cells count only if `dams_count`.
fn accepted(heights: &[f64], mated: usize, division: &Division, dams_count: bool) -> Vec<bool> {
    let Some(target) = division.basin(mated) else { return vec![false; heights.len()] };
    let docking = heights[mated];
    let inside = |basin: u32| division.bottom(basin) >= docking;
    let lowest_inside = |cell: usize| {
        division
            .neighbours(cell)
            .filter_map(|near| Some((division.basin(near)?, near)))
            .filter(|(basin, _)| inside(*basin))
            .reduce(|best, next| if heights[next.1] < heights[best.1] { next } else { best })
            .map(|(basin, _)| basin)
    };
    (0..heights.len())
        .map(|cell| {
            division.basin(cell).or_else(|| if dams_count { lowest_inside(cell) } else { None })
                == Some(target)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mated_sample_is_the_aligned_pose() {
        for (errors, shape) in [
            (SampledErrors::XTheta, vec![101, 101]),
            (SampledErrors::XYPitch, vec![31, 31, 30]),
            (SampledErrors::XPitchRoll, vec![31, 30, 30]),
            (SampledErrors::XPitchYaw, vec![31, 30, 30]),
            (SampledErrors::XRollYaw, vec![31, 30, 30]),
        ] {
            let samples = Samples::of(errors, DissertationSettings::PLANAR_SAMPLES);
            assert_eq!(samples.shape(), shape);
            let slab = samples.x.count * samples.y.count;
            let (lateral, rotation) = (samples.mated % slab, samples.rotations[samples.mated / slab]);
            assert!((rotation - DMat3::IDENTITY).to_cols_array().iter().all(|v| v.abs() < 1e-15));
            assert!(samples.x.at(lateral % samples.x.count).abs() < 1e-15);
            assert!(samples.y.at(lateral / samples.x.count).abs() < 1e-15);
        }
    }

    #[test]
    fn the_rotation_point_lies_behind_the_apex_plane() {
        let at =
            |errors, cor| DissertationSettings::new(Family::VFace, errors, 2.0, cor).center_of_rotation();
        // The apex plane is H/2 = 1 in front of the face centre; the planar body's back is 2.5 behind that.
        assert_eq!(at(SampledErrors::XTheta, 1.0), 1.0);
        assert_eq!(at(SampledErrors::XTheta, 0.0), -1.5);
        assert_eq!(at(SampledErrors::XYPitch, 0.0), 0.0);
        assert_eq!(at(SampledErrors::XPitchRoll, 0.0), -1.0);
    }

    #[test]
    fn a_planar_cell_counts_four_pi_over_ten_thousand() {
        let expected = 4.0 * PI / 1e4;
        assert!(
            (Samples::of(SampledErrors::XTheta, DissertationSettings::PLANAR_SAMPLES).cell_measure
                - expected)
                .abs()
                < 1e-16
        );
    }

    #[test]
    fn the_accepted_set_is_symmetric_like_the_connector() {
        // Mirroring the V-Face maps (x, θ) to (−x, −θ): the samples in reverse.
        let sampled =
            accept(&DissertationSettings::new(Family::VFace, SampledErrors::XTheta, 1.0, 1.0), &Exec::new())
                .unwrap();
        let mirrored = sampled.accepted.iter().rev();
        let different = sampled.accepted.iter().zip(mirrored).filter(|(a, b)| a != b).count();
        // First in, first out breaks ties at the dams.
        assert!(different * 100 < sampled.count(), "{different} of {}", sampled.count());
    }

    #[test]
    fn a_shape_that_cannot_be_drawn_is_an_error() {
        let settings = DissertationSettings::new(Family::VFace, SampledErrors::XTheta, -1.0, 0.0);
        assert!(matches!(accept(&settings, &Exec::new()), Err(DissertationError::Geometry { .. })));
    }
}
