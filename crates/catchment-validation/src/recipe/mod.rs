//! Computation of an entry: by the method of its table, and exactly.
//!
//! ```text
//!   by the same method   kinematic starts · flooded samples of the preset · closed forms
//!   exact                the same rotation point and solids; every sample followed exactly (descent), or a sampled grid
//!                        whose Sum random descents make unbiased, with its 95 % interval
//! ```
//!
//! Exact means frictionless, quasi-static and overdamped with ρ = [`RHO`], which the dissertation does not
//! specify.

pub mod dissertation;

use self::dissertation::{DissertationError, SampledErrors};
use catchment::acceptance::{Acceptance, Domain, Outcome};
use catchment::connector::Connector;
use catchment::contact::Pair;
use catchment::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
use catchment::exec::{Cancelled, Exec};
use catchment::landscape::{Grid, GridAxis};
use catchment::merit::brute::largest_cube;
use catchment::merit::onaa::Onaa;
use catchment::method::correction::{self, ByFraction, Stop};
use catchment::method::descent;
use catchment::method::kinematic::{self, PlanarFace};
use catchment::method::partition;
use catchment::method::transport;
use catchment::method::zraa::{self, Zraa};
use catchment::pose::{Dof, DofSet, PoseError};
use serde::Serialize;
use std::f64::consts::PI;

/// ρ of the exact values, in D.
pub const RHO: f64 = 0.5;

/// The quantity to compute.
#[derive(Debug, Clone, Copy)]
pub enum Recipe {
    /// Starts that slide into the seat, by the kinematic method.
    Kinematic(PlanarFace),
    /// Sum by the polyhedral partition.
    Partition(Family),
    /// Sum of the flooded target basin.
    Sum(Family, SampledErrors),
    /// Area of the largest square in the flooded target basin.
    Onaa(Family),
    /// Zero-rotation area of a system, where its geometry is known.
    Zraa,
    /// Slices of the 3-D X-Face by drop tests: the first column is the Sum, the second the ONAA edge.
    Slices,
}

/// An entry's value by the table's method, and its exact value.
pub type RecipeEntry = (Option<f64>, Option<ExactValue>);

/// Why an entry cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RecipeError {
    /// The dissertation preset failed.
    #[error(transparent)]
    Dissertation(#[from] DissertationError),
    /// There is no exact value.
    #[error("no exact value: {reason}")]
    Exact {
        /// The reason.
        reason: String,
    },
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// An exact value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ExactValue {
    /// The value, in the table's unit.
    pub value: f64,
    /// Its 95 % interval if it comes from random poses; else its uncertainty is the spacing of the samples.
    pub ci95: Option<[f64; 2]>,
}

/// H/D of the rows of chapter 5.
const ASPECT_RATIOS: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];
/// COR of the columns of chapter 5.
const CORS: [f64; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];
/// Measure of one planar sample, D·rad.
const PLANAR_CELL: f64 = 4.0 * PI / 1e4;
/// Planar samples per axis, on the rotation point's own coordinates, both ends included.
const PLANAR: usize = 101;
/// Cells per axis of the grids with corrected Sums, and the number of random descents for the correction.
const SPATIAL: usize = 24;
const DESCENTS: usize = 4000;
const SEED: u64 = 1;
/// Cells per axis of a slice of the 3-D X-Face.
const SLICE: usize = 71;

impl Recipe {
    /// The method's name.
    pub const fn method(self) -> &'static str {
        match self {
            Self::Kinematic(_) => "kinematic",
            Self::Partition(_) => "partition",
            Self::Sum(..) | Self::Onaa(_) => "flood, dissertation preset",
            Self::Zraa => "closed form",
            Self::Slices => "drop",
        }
    }

    /// Meaning of the rows.
    pub const fn row_name(self) -> &'static str {
        match self {
            Self::Zraa => "system",
            Self::Slices => "slice",
            _ => "H/D",
        }
    }

    /// Our values and, if requested, the exact ones of a row of entries.
    ///
    /// # Errors
    /// See [`RecipeError`].
    pub fn row(
        self,
        row: usize,
        columns: usize,
        exact: bool,
        exec: &Exec,
    ) -> Result<Vec<RecipeEntry>, RecipeError> {
        if matches!(self, Self::Slices) {
            let ours = dropped(row, exec)?;
            let exact = if exact { Some(slice(row, followed_exactly, exec)?) } else { None };
            let value = |values: Option<[f64; 2]>, k: usize| values.map(|values| values[k]);
            return Ok((0..columns)
                .map(|k| (value(ours, k), value(exact, k).map(|value| ExactValue { value, ci95: None })))
                .collect());
        }
        exec.try_map(columns, |column| {
            let ours = self.compute(row, column, exec)?;
            let exact = if exact { self.exact(row, column, exec)? } else { None };
            Ok((ours, exact))
        })
    }

    /// Our value of one entry by the method of its table; `None` if that method or the geometry is not available.
    fn compute(self, row: usize, column: usize, exec: &Exec) -> Result<Option<f64>, RecipeError> {
        exec.check()?;
        Ok(match self {
            Self::Kinematic(face) => {
                // The printed 0.108819 is 2^(−4 + 0.8), rounded.
                let aspect_ratio = (0.8 * row as f64 - 4.0).exp2();
                Some(
                    kinematic::KinematicSettings { face, aspect_ratio, rotation_point: column as f64 }.area(),
                )
            }
            Self::Sum(family, errors) => {
                Some(dissertation::accept(&settings(family, errors, row, column), exec)?.sum())
            }
            Self::Onaa(family) => {
                let sampled =
                    dissertation::accept(&settings(family, SampledErrors::XTheta, row, column), exec)?;
                Some(square(largest_cube(&sampled.shape, &sampled.accepted)))
            }
            Self::Partition(family) => Some(partitioned(family, row, column, exec)?),
            Self::Zraa => zero_rotation(row, exec)?,
            // Computed a row at a time.
            Self::Slices => None,
        })
    }

    /// The exact value of one entry; `None` where it does not exist: the rotation point of the kinematic method keeps its
    /// x, which is a different problem, and zero-rotation areas are exact already.
    ///
    /// # Errors
    /// See [`RecipeError`].
    pub fn exact(self, row: usize, column: usize, exec: &Exec) -> Result<Option<ExactValue>, RecipeError> {
        exec.check()?;
        Ok(match self {
            Self::Kinematic(_) | Self::Zraa | Self::Slices => None,
            Self::Sum(family, SampledErrors::XTheta) | Self::Partition(family) => {
                let accepted = followed(family, row, column, exec)?;
                let count = accepted.iter().filter(|accepted| **accepted).count();
                Some(ExactValue { value: count as f64 * PLANAR_CELL, ci95: None })
            }
            Self::Sum(..) => Some(self.corrected(row, column, exec)?),
            Self::Onaa(family) => {
                let edge = largest_cube(&[PLANAR; 2], &followed(family, row, column, exec)?);
                Some(ExactValue { value: square(edge), ci95: None })
            }
        })
    }

    /// Whether two values agree as the integers they represent, or to the three printed digits.
    pub fn agree(self, published: f64, ours: f64) -> bool {
        let count = |value: f64| match self {
            Self::Kinematic(_) => (value / kinematic::START_MEASURE).round(),
            _ => (value / PLANAR_CELL).sqrt().round(),
        };
        match self {
            Self::Kinematic(_) | Self::Onaa(_) => count(published) == count(ours),
            Self::Sum(..) | Self::Partition(_) | Self::Zraa | Self::Slices => {
                let half_a_digit = 0.5 * 10f64.powf(published.log10().floor() - 2.0);
                (ours - published).abs() <= half_a_digit
            }
        }
    }

    /// The Sum of a pyramid: a grid by transport, corrected. A pyramid is invariant under the exchange of x and y, which turns the
    /// dissertation's (x; pitch about x, roll about y) into (y; pitch about y, roll about x). With yaw the axes are the same, but here yaw
    /// turns last and in the dissertation first: the same rotations in another measure.
    fn corrected(self, row: usize, column: usize, exec: &Exec) -> Result<ExactValue, RecipeError> {
        let Self::Sum(family, errors) = self else {
            return Err(RecipeError::Exact { reason: "no such table".to_owned() });
        };
        let free: DofSet = match errors {
            SampledErrors::XPitchRoll => [Dof::Y, Dof::Roll, Dof::Pitch].into_iter().collect(),
            SampledErrors::XPitchYaw => [Dof::X, Dof::Roll, Dof::Yaw].into_iter().collect(),
            SampledErrors::XRollYaw => [Dof::X, Dof::Pitch, Dof::Yaw].into_iter().collect(),
            _ => [Dof::X, Dof::Y, Dof::Pitch].into_iter().collect(),
        };
        let settings = settings(family, errors, row, column);
        let pair = pair(family, settings.aspect_ratio, None, settings.center_of_rotation(), free)?;
        let grid = Grid::over(&pair.alignment, |_| SPATIAL);
        let arrival =
            transport::run(&pair, &grid, &transport::TransportSettings::default(), exec).map_err(failed)?;
        let by = ByFraction::new(|cell| arrival.fraction(cell), grid.shape());
        let sample = correction::CorrectionSettings { seed: SEED, stop: Stop::Samples(DESCENTS) };
        let descents = descent::DescentSettings::default();
        let result = correction::correct(&pair, &grid, &by, &sample, &descents, exec).map_err(failed)?;
        Ok(ExactValue { value: result.sum, ci95: Some(result.ci95) })
    }
}

/// The area that a square of this many samples represents.
fn square(edge: usize) -> f64 {
    (edge * edge) as f64 * PLANAR_CELL
}

fn settings(
    family: Family,
    errors: SampledErrors,
    row: usize,
    column: usize,
) -> dissertation::DissertationSettings {
    dissertation::DissertationSettings::new(family, errors, ASPECT_RATIOS[row], CORS[column])
}

fn failed<E: std::error::Error>(error: E) -> RecipeError {
    RecipeError::Exact { reason: error.to_string() }
}

/// A family with an error box that is large enough in x and y for the tables.
pub(crate) fn design(
    family: Family,
    aspect_ratio: f64,
    base_thickness: Option<f64>,
    cor: f64,
    free: DofSet,
) -> Design {
    /// Half-range of x and y, in D.
    const LATERAL: f64 = 2.0;
    let spec = FamilySpec::new(family).with_aspect_ratio(aspect_ratio).with_base_thickness(base_thickness);
    let mut alignment = Alignment {
        free,
        center_of_rotation: cor,
        rotation_length: RHO,
        ..Alignment::default_for(Some(family))
    };
    for dof in [Dof::X, Dof::Y] {
        alignment.half_ranges[dof.index()] = LATERAL;
    }
    let connector = ConnectorSpec::Family(spec);
    Design { name: family.name().to_owned(), connector, width: 1.0, unit: None, alignment }
}

fn pair(
    family: Family,
    aspect_ratio: f64,
    base_thickness: Option<f64>,
    cor: f64,
    free: DofSet,
) -> Result<Pair, RecipeError> {
    let design = design(family, aspect_ratio, base_thickness, cor, free);
    let reason = |problems: Vec<catchment::connector::GeometryDefect>| RecipeError::Exact {
        reason: problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "),
    };
    Ok(Pair::new(&Connector::build(&design).map_err(reason)?, &design.alignment))
}

/// Thickness of the block behind both planar faces of chapter 5, in D.
pub(crate) const PLANAR_BASE: f64 = 0.5;

/// Whether each of a planar table's own samples docks, by exact descent; x of the rotation point runs fastest.
fn followed(family: Family, row: usize, column: usize, exec: &Exec) -> Result<Vec<bool>, RecipeError> {
    let settings = settings(family, SampledErrors::XTheta, row, column);
    let cor = settings.center_of_rotation();
    let free = [Dof::X, Dof::Pitch].into_iter().collect();
    let pair = pair(family, settings.aspect_ratio, Some(PLANAR_BASE), cor, free)?;
    let last = (PLANAR - 1) as f64;
    let pose = |k: usize| {
        let x = 4.0 * (k % PLANAR) as f64 / last - 2.0;
        let pitch = PI * (k / PLANAR) as f64 / last - PI / 2.0;
        // A sample is the place of the rotation point, a pose error that of the face centre.
        PoseError { x: x + cor * pitch.sin(), pitch, ..PoseError::default() }
    };
    let poses = Domain::Poses((0..PLANAR * PLANAR).map(pose).collect());
    let (acceptance, _) = descent::run(&pair, poses, &descent::DescentSettings::default(), exec)?;
    Ok(acceptance.accepted().collect())
}

/// The Sum of a planar face by the partition with the dissertation's own settings: 12 slices, without strips.
fn partitioned(family: Family, row: usize, column: usize, exec: &Exec) -> Result<f64, RecipeError> {
    const AS_PUBLISHED: partition::PartitionSettings = partition::PartitionSettings { slices: 12, strips: 1 };
    let settings = settings(family, SampledErrors::XTheta, row, column);
    let free = [Dof::X, Dof::Pitch].into_iter().collect();
    let cor = settings.center_of_rotation();
    let pair = pair(family, settings.aspect_ratio, Some(PLANAR_BASE), cor, free)?;
    Ok(partition::run(&pair, &AS_PUBLISHED, exec).map_err(failed)?.measure(Outcome::Aligned))
}

/// Zero-rotation areas of the systems of table 2.1 whose geometry is known, by row; widths are 1.
fn zero_rotation(row: usize, exec: &Exec) -> Result<Option<f64>, RecipeError> {
    /// A pin of radius 2 mm on a face of 50 mm reaches its hole from this distance.
    const POLYBOT: f64 = 2.0 / 50.0;
    /// The lateral reach stated in the text: a fifth of the face. (A radius of 0.335 gives the printed area because it is calculated
    /// back from it.)
    const DRAGON: f64 = 0.2;
    Ok(match row {
        1 => Some(PI * POLYBOT * POLYBOT),
        9 => Some(PI * DRAGON * DRAGON),
        10 => {
            // The cone has width 1; the cone that circumscribes a square of width 1 is √2 as wide.
            let free = [Dof::X, Dof::Y].into_iter().collect();
            let pair = pair(Family::Cone, FamilySpec::new(Family::Cone).aspect_ratio(), None, 0.0, free)?;
            match zraa::run(&pair, &zraa::ZraaSettings::default(), exec).map_err(failed)? {
                Zraa::Region { area, .. } => Some(2.0 * area),
                Zraa::Interval { .. } => None,
            }
        }
        _ => None,
    })
}

/// Outcomes of the cells of a grid.
type Decide = fn(&Pair, Grid, &Exec) -> Result<Acceptance, RecipeError>;

fn followed_exactly(pair: &Pair, grid: Grid, exec: &Exec) -> Result<Acceptance, RecipeError> {
    Ok(descent::run(pair, Domain::Grid(grid), &descent::DescentSettings::default(), exec)?.0)
}

/// The same slice by drop tests; `None` without the engine.
#[cfg(feature = "drop")]
fn dropped(row: usize, exec: &Exec) -> Result<Option<[f64; 2]>, RecipeError> {
    use catchment::method::drop;
    let decide: Decide = |pair, grid, exec| {
        let (acceptance, _) =
            drop::run(pair, Domain::Grid(grid), &drop::DropSettings::default(), exec).map_err(failed)?;
        Ok(acceptance)
    };
    slice(row, decide, exec).map(Some)
}

#[cfg(not(feature = "drop"))]
fn dropped(_: usize, exec: &Exec) -> Result<Option<[f64; 2]>, RecipeError> {
    exec.check()?;
    Ok(None)
}

/// A slice of the 3-D X-Face over ± D and ± 90°, with all errors free: its Sum as a share of the plane, and its ONAA edge. The
/// source does not state the centre of mass of the published model: the rotation point is the face centre here.
fn slice(row: usize, decide: Decide, exec: &Exec) -> Result<[f64; 2], RecipeError> {
    const SECOND: [Dof; 4] = [Dof::Y, Dof::Roll, Dof::Pitch, Dof::Yaw];
    let family = Family::XFace3d;
    let mut design = design(family, FamilySpec::new(family).aspect_ratio(), None, 0.0, DofSet::ALL);
    design.alignment.half_ranges = Alignment::DEFAULT_HALF_RANGES;
    let connector =
        Connector::build(&design).map_err(|_| RecipeError::Exact { reason: family.name().to_owned() })?;
    let pair = Pair::new(&connector, &design.alignment);
    let axis = |dof: Dof| {
        let half = pair.alignment.half_range(dof);
        GridAxis { dof, lo: -half, hi: half, cells: SLICE }
    };
    let acceptance = decide(&pair, Grid { axes: vec![axis(Dof::X), axis(SECOND[row])] }, exec)?;
    let share = acceptance.counts()[0] as f64 / acceptance.outcomes.len() as f64;
    Ok([share, Onaa::of(&acceptance, exec).map_err(failed)?.edge])
}
