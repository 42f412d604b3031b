//! Resolution of the error box in text form: `30`, `x=40,yaw=24`, `20,yaw=36`.

use super::Grid;
use crate::design::Alignment;
use crate::pose::{Dof, UnknownDof};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Number of cells per axis of the error grid.
///
/// Text form: comma-separated parts; `number` applies to every axis that is not named, `axis=number` to one
/// axis. An axis without a number has the default of the method for the number of sampled axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(try_from = "String", into = "String")]
pub struct Resolution {
    every: Option<usize>,
    named: [Option<usize>; 5],
}

/// Why a resolution cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ResolutionError {
    /// Not a whole number.
    #[error("`{text}` is not a number of cells; write a whole number such as 30, or x=40,yaw=24")]
    NotANumber {
        /// The text as written.
        text: String,
    },
    /// Too few cells for a meaningful result, or more than any axis can use.
    #[error("{cells} cells per axis is out of range; choose {} to {}", Resolution::LEAST, Resolution::MOST)]
    OutOfRange {
        /// The requested number.
        cells: usize,
    },
    /// No such axis.
    #[error(transparent)]
    UnknownAxis(#[from] UnknownDof),
    /// The same axis, or the bare number, was given twice.
    #[error("the resolution of {name} is given twice")]
    Twice {
        /// Which.
        name: &'static str,
    },
    /// A resolution for an axis that is not sampled.
    #[error("{} is not free in this design, so it has no resolution; remove `{}=…` or add it to `free`", .dof.name(), .dof.name())]
    NotFree {
        /// Which.
        dof: Dof,
    },
}

impl Resolution {
    /// Fewest cells per axis.
    pub const LEAST: usize = 2;
    /// Most cells per axis: beyond any memory in two dimensions.
    pub const MOST: usize = 1_000_000;

    /// Default cells per axis, for one to five axes, for a cost of microseconds per cell. Odd, so that a cell
    /// is centred on the mated pose; [`Resolution::is_centred_on`] gives the choice of odd numbers.
    pub const DEFAULT_CELLS: [usize; 5] = [1001, 101, 41, 23, 13];

    /// Whether an axis with this number of cells has a centre at a fraction of its half range whose
    /// denominator is `denominator`, in lowest terms.
    ///
    /// The accepted set often ends at such a fraction (½ D, 45° of 90°). If the outermost accepted centres
    /// lie exactly there, rounding decides about them, and the set becomes a whole cell too wide or too
    /// narrow: with 30 cells over ±1 D, which have centres at ±½, a cube of ±½ D is 14 % off. Defaults avoid
    /// fractions with small denominators. Centres are at j/cells of the half range, j even for an odd number
    /// of cells and odd for an even number.
    pub fn is_centred_on(cells: usize, denominator: usize) -> bool {
        let is_center = |j: usize| j % 2 != cells % 2;
        let in_lowest_terms = |numerator: usize| {
            (2..=numerator).all(|d| !numerator.is_multiple_of(d) || !denominator.is_multiple_of(d))
        };
        cells.is_multiple_of(denominator)
            && (1..denominator).any(|k| in_lowest_terms(k) && is_center(k * (cells / denominator)))
    }

    /// The same number of cells on every axis.
    pub fn uniform(cells: usize) -> Result<Self, ResolutionError> {
        Ok(Self { every: Some(in_range(cells)?), ..Self::default() })
    }

    /// This resolution with `cells` cells on the axis of `dof`.
    pub fn with(mut self, dof: Dof, cells: usize) -> Result<Self, ResolutionError> {
        self.named[dof.index()] = Some(in_range(cells)?);
        Ok(self)
    }

    /// The resolution of a grid, axis by axis.
    pub fn of(grid: &Grid) -> Self {
        let mut resolution = Self::default();
        for axis in &grid.axes {
            resolution.named[axis.dof.index()] = Some(axis.cells);
        }
        resolution
    }

    /// Cells on the axis of `dof` in a grid of `axes` axes (1 to 5); `defaults` are those of the method for
    /// one to five axes.
    pub fn cells(&self, dof: Dof, axes: usize, defaults: &[usize; 5]) -> usize {
        let default = defaults[axes.clamp(1, 5) - 1];
        self.named[dof.index()].or(self.every).unwrap_or(default)
    }

    /// The grid of this resolution over the error box of `alignment`; `defaults` as in [`Resolution::cells`].
    ///
    /// # Errors
    /// When an axis is named that is not free.
    pub fn grid(&self, alignment: &Alignment, defaults: &[usize; 5]) -> Result<Grid, ResolutionError> {
        for dof in Dof::ALL {
            if self.named[dof.index()].is_some() && !alignment.free.contains(dof) {
                return Err(ResolutionError::NotFree { dof });
            }
        }
        Ok(Grid::over(alignment, |dof| self.cells(dof, alignment.free.len(), defaults)))
    }

    /// The largest number of cells per axis whose `axes`-dimensional grid fits into `budget` bytes.
    pub fn largest_that_fits(budget: u64, bytes_per_cell: u64, axes: usize) -> usize {
        let cells = budget / bytes_per_cell.max(1);
        let mut edge = (cells as f64).powf(1.0 / axes.max(1) as f64) as u64 + 1;
        while edge > 0 && (0..axes).try_fold(1u64, |n, _| n.checked_mul(edge)).is_none_or(|n| n > cells) {
            edge -= 1;
        }
        edge as usize
    }
}

fn in_range(cells: usize) -> Result<usize, ResolutionError> {
    if (Resolution::LEAST..=Resolution::MOST).contains(&cells) {
        Ok(cells)
    } else {
        Err(ResolutionError::OutOfRange { cells })
    }
}

impl FromStr for Resolution {
    type Err = ResolutionError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let mut resolution = Self::default();
        for part in text.split(',').map(str::trim) {
            let (slot, name, number) = match part.split_once('=') {
                None => (&mut resolution.every, "every axis", part),
                Some((name, number)) => {
                    let name = name.trim();
                    let dof: Dof = name.parse()?;
                    (&mut resolution.named[dof.index()], dof.name(), number.trim())
                }
            };
            let cells =
                number.parse().map_err(|_| ResolutionError::NotANumber { text: number.to_owned() })?;
            if slot.replace(in_range(cells)?).is_some() {
                return Err(ResolutionError::Twice { name });
            }
        }
        Ok(resolution)
    }
}

impl fmt::Display for Resolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts: Vec<String> = self.every.iter().map(ToString::to_string).collect();
        for dof in Dof::ALL {
            if let Some(cells) = self.named[dof.index()] {
                parts.push(format!("{}={cells}", dof.name()));
            }
        }
        f.write_str(&parts.join(","))
    }
}

impl TryFrom<String> for Resolution {
    type Error = ResolutionError;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        if text.is_empty() { Ok(Self::default()) } else { text.parse() }
    }
}

impl From<Resolution> for String {
    fn from(resolution: Resolution) -> Self {
        resolution.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::{DofSet, Mount};

    fn planar() -> Alignment {
        Alignment::new([Dof::X, Dof::Pitch].into_iter().collect(), Mount::Y)
    }

    #[test]
    fn a_bare_number_counts_for_every_axis_that_is_not_named() {
        let r: Resolution = "20, yaw=36".parse().unwrap();
        assert_eq!(r.cells(Dof::X, 5, &Resolution::DEFAULT_CELLS), 20);
        assert_eq!(r.cells(Dof::Yaw, 5, &Resolution::DEFAULT_CELLS), 36);
        let r: Resolution = "x=40".parse().unwrap();
        assert_eq!(r.grid(&planar(), &Resolution::DEFAULT_CELLS).unwrap().shape(), [40, 101]);
    }

    #[test]
    fn writing_and_reading_are_inverse() {
        for text in ["30", "x=40,yaw=24", "20,roll=3"] {
            assert_eq!(text.parse::<Resolution>().unwrap().to_string(), text);
        }
        assert_eq!(Resolution::try_from(String::from(Resolution::default())), Ok(Resolution::default()));
    }

    #[test]
    fn each_mistake_has_its_own_message() {
        let error = |text: &str| text.parse::<Resolution>().unwrap_err().to_string();
        assert!(error("").starts_with("`` is not a number of cells"));
        assert!(error("3o").starts_with("`3o` is not a number"));
        assert!(error("1").starts_with("1 cells per axis is out of range; choose 2 to"));
        assert!(error("z=4").starts_with("there is no axis `z`"));
        assert_eq!(error("x=4,x=5"), "the resolution of x is given twice");
        let not_free = "30,yaw=8"
            .parse::<Resolution>()
            .unwrap()
            .grid(&planar(), &Resolution::DEFAULT_CELLS)
            .unwrap_err();
        assert_eq!(not_free, ResolutionError::NotFree { dof: Dof::Yaw });
    }

    #[test]
    fn the_largest_resolution_fits_and_the_next_does_not() {
        for axes in 1..=5 {
            for budget in [1u64 << 10, 1 << 20, 7 << 30] {
                let edge = Resolution::largest_that_fits(budget, 4, axes) as u64;
                let bytes = |edge: u64| 4 * edge.pow(axes as u32);
                assert!(bytes(edge) <= budget && bytes(edge + 1) > budget);
            }
        }
    }

    /// Against the definition, and the numbers of the note.
    #[test]
    fn centres_lie_on_fractions_or_do_not() {
        for cells in 2..=64usize {
            for denominator in 2..=8usize {
                // Centres are at (2 k + 1 − cells)/cells; the fraction is in lowest terms if only 1 divides
                // both numbers.
                let centers = (0..cells).map(|k| (2 * k + 1).abs_diff(cells));
                let divides = |d: usize, j: usize| (j * denominator).is_multiple_of(d);
                let result =
                    centers.filter(|j| divides(cells, *j)).map(|j| j * denominator / cells).any(|k| {
                        (2..=denominator).all(|d| !(k.is_multiple_of(d) && denominator.is_multiple_of(d)))
                            && k > 0
                            && k < denominator
                    });
                assert_eq!(Resolution::is_centred_on(cells, denominator), result, "{cells} {denominator}");
            }
        }
        assert!(Resolution::is_centred_on(30, 2) && !Resolution::is_centred_on(32, 2));
        assert!(Resolution::is_centred_on(21, 3) && !Resolution::is_centred_on(23, 3));
    }

    #[test]
    fn every_default_is_odd_and_all_free_axes_get_one() {
        assert!(Resolution::DEFAULT_CELLS.iter().all(|n| n % 2 == 1));
        let grid = Resolution::default()
            .grid(&Alignment::new(DofSet::ALL, Mount::X), &Resolution::DEFAULT_CELLS)
            .unwrap();
        assert_eq!(grid.shape(), [13; 5]);
    }
}
