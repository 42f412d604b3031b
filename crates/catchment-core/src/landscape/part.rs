//! Parts of a landscape, computed separately and assembled: the same bits for any division.

use super::{Fold, GradientField, Grid, Landscape, Patches};
use std::ops::Range;

/// The heights of some of a grid's rotations.
#[derive(Debug, Clone, PartialEq)]
pub struct LandscapePart {
    /// The whole grid.
    pub grid: Grid,
    /// Which of its rotations, in grid order.
    pub rotations: Range<usize>,
    /// Their heights, as in [`Landscape::heights`].
    pub heights: Vec<f32>,
}

/// The gradient field of some of the rotations that are kept of a grid.
#[derive(Debug, Clone)]
pub struct GradientFieldPart {
    /// The whole grid.
    pub grid: Grid,
    /// Which cells of the whole grid are kept.
    pub fold: Fold,
    /// Which of the representative rotations.
    pub representatives: Range<usize>,
    /// Their energies, as in [`GradientField::energies`].
    pub energies: Vec<f32>,
    /// Their carriers, as in [`GradientField::carriers`].
    pub carriers: Vec<u16>,
    /// Their patches, as in [`GradientField::patches`].
    pub patches: Patches,
}

/// Why parts do not make a whole.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MergeError {
    /// No parts were given.
    #[error("there is no part to put together")]
    Nothing,
    /// Parts of different wholes.
    #[error("the parts are of different grids")]
    Different,
    /// A rotation is missing, or there more than once.
    #[error("rotation {rotation} of {of} is {}", if *.missing { "in no part" } else { "in two parts" })]
    Rotation {
        /// Its number, from 0.
        rotation: usize,
        /// How many there are.
        of: usize,
        /// Whether no part has it; else two have.
        missing: bool,
    },
}

/// Whether ranges in ascending order are 0..`of`, each number once.
fn complete(ranges: impl Iterator<Item = Range<usize>>, of: usize) -> Result<(), MergeError> {
    let mut next = 0;
    for range in ranges.chain(std::iter::once(of..of)) {
        if range.start != next {
            let missing = range.start > next;
            return Err(MergeError::Rotation { rotation: range.start.min(next), of, missing });
        }
        next = range.end;
    }
    Ok(())
}

impl Landscape {
    /// The whole that these parts, in any order, are all of.
    ///
    /// # Errors
    /// When rotations are missing or there twice, or the grids differ.
    pub fn merge(parts: impl IntoIterator<Item = LandscapePart>) -> Result<Self, MergeError> {
        let mut parts: Vec<LandscapePart> = parts.into_iter().collect();
        parts.sort_by_key(|part| (part.rotations.start, part.rotations.end));
        let grid = parts.first().ok_or(MergeError::Nothing)?.grid.clone();
        if parts.iter().any(|part| part.grid != grid) {
            return Err(MergeError::Different);
        }
        complete(parts.iter().map(|part| part.rotations.clone()), Self::rotations(&grid))?;
        Ok(Self { grid, heights: parts.into_iter().flat_map(|part| part.heights).collect() })
    }
}

impl GradientField {
    /// Merges parts, in any order, into the whole.
    ///
    /// # Errors
    /// If rotations are missing or repeated, or the grids or the stored data differ.
    pub fn merge(parts: impl IntoIterator<Item = GradientFieldPart>) -> Result<Self, MergeError> {
        let mut parts: Vec<GradientFieldPart> = parts.into_iter().collect();
        parts.sort_by_key(|part| (part.representatives.start, part.representatives.end));
        let first = parts.first().ok_or(MergeError::Nothing)?;
        let (grid, fold) = (first.grid.clone(), first.fold.clone());
        if parts.iter().any(|part| part.grid != grid || part.fold != fold) {
            return Err(MergeError::Different);
        }
        complete(parts.iter().map(|part| part.representatives.clone()), fold.representatives())?;
        let (mut energies, mut carriers, mut patches) = (Vec::new(), Vec::new(), Vec::new());
        for part in parts {
            energies.extend(part.energies);
            carriers.extend(part.carriers);
            patches.extend(part.patches);
        }
        Ok(Self { grid, fold, energies, carriers, patches })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Gradient, LandscapeError};
    use super::*;
    use crate::connector::Connector;
    use crate::contact::Pair;
    use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
    use crate::exec::Exec;

    fn case() -> (Pair, Grid) {
        let mut alignment = Alignment::default_for(Some(Family::Pyramid));
        alignment.center_of_rotation = -0.4;
        let connector = ConnectorSpec::Family(FamilySpec::new(Family::Pyramid));
        let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
        let pair = Pair::new(&Connector::build(&design).unwrap(), &design.alignment);
        let grid = Grid::over(&pair.alignment, |dof| 3 + dof.index() % 2);
        (pair, grid)
    }

    fn cut(all: usize, parts: usize) -> impl Iterator<Item = Range<usize>> {
        (0..parts).rev().map(move |k| k * all / parts..(k + 1) * all / parts)
    }

    #[test]
    fn a_landscape_in_parts_is_the_whole() {
        let (pair, grid) = case();
        let exec = Exec::new();
        let whole = Landscape::compute(&pair, &grid, &exec).unwrap();
        for parts in [1, 2, 7] {
            let part = |range| Landscape::part(&pair, &grid, range, &exec).unwrap();
            let merged = Landscape::merge(cut(Landscape::rotations(&grid), parts).map(part)).unwrap();
            assert_eq!(merged.grid, whole.grid);
            assert!(merged.heights.iter().zip(&whole.heights).all(|(a, b)| a.to_bits() == b.to_bits()));
            assert_eq!(merged.heights.len(), whole.heights.len());
        }
    }

    #[test]
    fn a_gradient_field_in_parts_is_the_whole() {
        let (pair, grid) = case();
        let exec = Exec::new();
        let linear = |_: &crate::pose::PoseError| |g: &Gradient| *g;
        let whole = GradientField::compute(&pair, &grid, &exec, linear).unwrap();
        assert!(whole.fold.representatives() < whole.fold.rotations(), "folded");
        for parts in [1, 2, 7] {
            let part = |range| GradientField::part(&pair, &grid, range, &exec, linear).unwrap();
            let merged = GradientField::merge(cut(whole.fold.representatives(), parts).map(part)).unwrap();
            assert_eq!(merged.energies, whole.energies);
            assert_eq!(merged.carriers, whole.carriers);
            assert_eq!(merged.patches, whole.patches);
        }
    }

    #[test]
    fn parts_that_are_no_whole_are_refused() {
        let (pair, grid) = case();
        let exec = Exec::new();
        let of = Landscape::rotations(&grid);
        let part = |range| Landscape::part(&pair, &grid, range, &exec).unwrap();
        let refused = |parts: Vec<Range<usize>>| Landscape::merge(parts.into_iter().map(part)).unwrap_err();
        assert_eq!(refused(Vec::new()), MergeError::Nothing);
        assert_eq!(refused(vec![0..2, 3..of]).to_string(), format!("rotation 2 of {of} is in no part"));
        assert_eq!(refused(vec![0..3, 2..of]).to_string(), format!("rotation 2 of {of} is in two parts"));
        assert_eq!(
            refused(std::iter::once(0..of - 1).collect()),
            MergeError::Rotation { rotation: of - 1, of, missing: true }
        );
        let mut other = part(0..of);
        other.grid.axes[0].hi += 1.0;
        assert_eq!(Landscape::merge([part(0..of), other]), Err(MergeError::Different));
        let beyond = Landscape::part(&pair, &grid, 1..of + 1, &exec);
        assert_eq!(beyond, Err(LandscapeError::NoSuchRotations { range: 1..of + 1, of }));
    }
}
