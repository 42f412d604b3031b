//! The gradient field of the landscape: at every cell the energy, the contact that carries the half, and the
//! exact gradient.
//!
//! ```text
//!   h │  ╲ patch 0                 At one rotation the height is piecewise linear in x and y. A cell keeps its energy
//!     │    ╲____╱ patch 2          and the number of its patch; a patch keeps the gradient of the height, which is
//!     │   patch 1                  affine in x and y too:
//!     └────┴────┴────▶ x
//!                                  ∂h/∂(x, y, ω) = g₀ + k_x·g_x + k_y·g_y        k: cell numbers along x and y
//! ```
//!
//! It needs six bytes per cell, and stores only one of each set of rotations that are mirror images
//! ([`Fold`]). If several contacts carry the half at once, a cell stores the first of them.

use super::backend::{lateral, lateral_lattices};
use super::heights::{usable, within};
use super::{Fold, GradientFieldPart, Grid, LandscapeError, Resolution};
use crate::contact::{HeightEnvelope, Pair};
use crate::diagnostic::Advice;
use crate::exec::Exec;
use crate::pose::{self, CorPose};
use glam::DVec2;
use rayon::prelude::*;
use std::ops::Range;

/// Five numbers of a gradient: ∂h/∂x and ∂h/∂y at the COR (D/D), ∂h/∂ω about the COR in world axes (D/rad);
/// or a linear function of them, chosen by a method.
pub type Gradient = [f64; 5];

/// A gradient over a patch, affine in the cell numbers along x and y. Single precision: relative error 10⁻⁶.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch {
    base: [f32; 5],
    along_x: [f32; 5],
    along_y: [f32; 5],
}

impl Patch {
    /// The patch that takes these values at cells (0, 0), (1, 0) and (0, 1).
    fn through([origin, x, y]: [Gradient; 3]) -> Self {
        let single = |f: &dyn Fn(usize) -> f64| std::array::from_fn(|k| f(k) as f32);
        Self {
            base: single(&|k| origin[k]),
            along_x: single(&|k| x[k] - origin[k]),
            along_y: single(&|k| y[k] - origin[k]),
        }
    }

    /// The value at a cell.
    pub fn at(&self, x: usize, y: usize) -> [f32; 5] {
        let (x, y) = (x as f32, y as f32);
        std::array::from_fn(|k| self.base[k] + x * self.along_x[k] + y * self.along_y[k])
    }
}

/// Per representative rotation: its patches.
pub type Patches = Vec<Box<[Patch]>>;

/// Energies and gradients of the height over the kept half, or quarter, of an error grid.
#[derive(Debug, Clone)]
pub struct GradientField {
    /// The whole grid.
    pub grid: Grid,
    /// Which cells are kept.
    pub fold: Fold,
    /// Potential energy at first contact at every stored cell, in D; −∞ if the halves pass each other by.
    pub energies: Vec<f32>,
    /// Per kept cell: number of its patch within its rotation; [`GradientField::NOTHING`] without contact.
    pub carriers: Vec<u16>,
    /// Per representative rotation: its patches.
    pub patches: Patches,
}

impl GradientField {
    /// No patch: the halves pass each other by.
    pub const NOTHING: u16 = u16::MAX;

    /// Bytes per kept cell, beside the patches.
    pub const BYTES_PER_CELL: u64 = (size_of::<f32>() + size_of::<u16>()) as u64;

    /// The gradient field of `pair` over `grid`, one rotation at a time, in parallel. `linear(rotation)` gives, for the pose at
    /// the first cell of a rotation, a linear map that is applied to its gradients before they are kept; a method
    /// uses it to keep what it needs of them.
    ///
    /// # Errors
    /// If the grid samples a locked translation or has no cell, does not fit into the memory budget, has too
    /// many patches to number, or the computation is cancelled.
    pub fn compute<L>(
        pair: &Pair,
        grid: &Grid,
        exec: &Exec,
        linear: impl Fn(&pose::PoseError) -> L + Sync,
    ) -> Result<Self, LandscapeError>
    where
        L: Fn(&Gradient) -> Gradient,
    {
        let fold = folded(pair, grid)?;
        let all = 0..fold.representatives();
        let GradientFieldPart { grid, fold, energies, carriers, patches, .. } =
            part_of(pair, grid, fold, all, exec, linear)?;
        Ok(Self { grid, fold, energies, carriers, patches })
    }

    /// The gradient field of some of the representative rotations, numbered as in the [`Fold`] of the grid: that of the whole, bit
    /// for bit. [`GradientField::merge`] puts parts together.
    ///
    /// # Errors
    /// As [`GradientField::compute`], and when there are no such rotations.
    pub fn part<L>(
        pair: &Pair,
        grid: &Grid,
        representatives: Range<usize>,
        exec: &Exec,
        linear: impl Fn(&pose::PoseError) -> L + Sync,
    ) -> Result<GradientFieldPart, LandscapeError>
    where
        L: Fn(&Gradient) -> Gradient,
    {
        let fold = folded(pair, grid)?;
        within(&representatives, fold.representatives())?;
        part_of(pair, grid, fold, representatives, exec, linear)
    }
}

/// The fold of a grid that suits the pair.
fn folded(pair: &Pair, grid: &Grid) -> Result<Fold, LandscapeError> {
    usable(pair, grid)?;
    Fold::new(grid, pair.mirrors()).ok_or_else(|| LandscapeError::Unusable { shape: grid.shape() })
}

/// The gradient field of a range of representative rotations.
fn part_of<L>(
    pair: &Pair,
    grid: &Grid,
    fold: Fold,
    representatives: Range<usize>,
    exec: &Exec,
    linear: impl Fn(&pose::PoseError) -> L + Sync,
) -> Result<GradientFieldPart, LandscapeError>
where
    L: Fn(&Gradient) -> Gradient,
{
    let keep = |slab: &[u16], patches: Vec<Patch>, carriers: &mut [u16]| {
        carriers.copy_from_slice(slab);
        patches.into_boxed_slice()
    };
    let (energies, carriers, patches) =
        slabs(pair, grid, &fold, representatives.clone(), GradientField::BYTES_PER_CELL, exec, linear, keep)?;
    Ok(GradientFieldPart { grid: grid.clone(), fold, representatives, energies, carriers, patches })
}

/// Energies over the kept cells of an error grid, and to which side of every cell its gradient points: a byte in the place of patches.
#[derive(Debug, Clone)]
pub struct DescentDirections {
    /// The whole grid.
    pub grid: Grid,
    /// Which cells are kept.
    pub fold: Fold,
    /// Potential energy at first contact at every stored cell, in D; −∞ if the halves pass each other by.
    pub energies: Vec<f32>,
    /// Per kept cell: bit k where entry k of its gradient is negative; [`DescentDirections::NOTHING`] without contact.
    pub below: Vec<u8>,
}

impl DescentDirections {
    /// The halves pass each other by.
    pub const NOTHING: u8 = u8::MAX;

    /// Bytes per kept cell.
    pub const BYTES_PER_CELL: u64 = (size_of::<f32>() + size_of::<u8>()) as u64;

    /// As [`GradientField::compute`].
    ///
    /// # Errors
    /// As there.
    pub fn compute<L>(
        pair: &Pair,
        grid: &Grid,
        exec: &Exec,
        linear: impl Fn(&pose::PoseError) -> L + Sync,
    ) -> Result<Self, LandscapeError>
    where
        L: Fn(&Gradient) -> Gradient,
    {
        let fold = folded(pair, grid)?;
        let width = grid.axis(pose::Dof::X).map_or(1, |axis| axis.cells);
        let keep = |slab: &[u16], patches: Vec<Patch>, below: &mut [u8]| {
            for (cell, (carrier, below)) in slab.iter().zip(below).enumerate() {
                *below = match carrier {
                    &GradientField::NOTHING => Self::NOTHING,
                    carrier => {
                        let gradient = patches[usize::from(*carrier)].at(cell % width, cell / width);
                        let bit = |(k, entry): (usize, &f32)| u8::from(*entry < 0.0) << k;
                        gradient.iter().enumerate().map(bit).sum()
                    }
                };
            }
        };
        let all = 0..fold.representatives();
        let (energies, below, _) = slabs(pair, grid, &fold, all, Self::BYTES_PER_CELL, exec, linear, keep)?;
        Ok(Self { grid: grid.clone(), fold, energies, below })
    }
}

/// Energies, and the results of `keep` for the carriers and patches of every rotation: a value for each cell,
/// and a value for each rotation.
#[expect(clippy::too_many_arguments, reason = "two callers, side by side")]
#[expect(clippy::type_complexity, reason = "what two callers take apart at once")]
fn slabs<L, C: Clone + Default + Send, P: Send>(
    pair: &Pair,
    grid: &Grid,
    fold: &Fold,
    representatives: Range<usize>,
    bytes_per_cell: u64,
    exec: &Exec,
    linear: impl Fn(&pose::PoseError) -> L + Sync,
    keep: impl Fn(&[u16], Vec<Patch>, &mut [C]) -> P + Sync,
) -> Result<(Vec<f32>, Vec<C>, Vec<P>), LandscapeError>
where
    L: Fn(&Gradient) -> Gradient,
{
    let slab = fold.slab();
    let kept = representatives.len() * slab;
    exec.ensure_fits("heights and their gradients", kept as u64 * bytes_per_cell, |budget| {
        let share = kept as f64 / grid.len() as f64;
        let budget = (budget as f64 / share) as u64;
        let largest = Resolution::largest_that_fits(budget, bytes_per_cell, grid.axes.len());
        vec![Advice::AtMostResolution(largest)]
    })?;
    let mut energies = vec![0f32; kept];
    let mut values = vec![C::default(); kept];
    let tally = exec.tally(representatives.len(), "heights");
    let all = exec.install(|| {
        energies
            .par_chunks_exact_mut(slab)
            .zip(values.par_chunks_exact_mut(slab))
            .enumerate()
            .map_init(
                || (Slab::new(pair, slab), vec![0u16; slab]),
                |(buffer, carriers), (k, (energies, values))| {
                    exec.check()?;
                    let error = grid.pose(fold.rotation(representatives.start + k) * slab);
                    let patches = buffer.fill(grid, &error, linear(&error), energies, carriers)?;
                    let made = keep(carriers, patches, values);
                    tally.add(1);
                    Ok(made)
                },
            )
            .collect::<Result<Vec<P>, LandscapeError>>()
    })?;
    Ok((energies, values, all))
}

/// Buffers of a thread that fills slabs.
struct Slab<'a> {
    pair: &'a Pair,
    envelope: HeightEnvelope<'a>,
    heights: Vec<f64>,
    carriers: Vec<u32>,
    /// Per carrier of the envelope: its patch in this slab.
    numbers: Vec<u16>,
}

impl<'a> Slab<'a> {
    fn new(pair: &'a Pair, slab: usize) -> Self {
        let envelope = pair.at_rotation(glam::DMat3::IDENTITY);
        Self { pair, envelope, heights: vec![0.0; slab], carriers: vec![0; slab], numbers: Vec::new() }
    }

    fn fill<L: Fn(&Gradient) -> Gradient>(
        &mut self,
        grid: &Grid,
        error: &pose::PoseError,
        linear: L,
        energies: &mut [f32],
        carriers: &mut [u16],
    ) -> Result<Vec<Patch>, LandscapeError> {
        let rotation = error.rotation();
        let lattices @ [x, y] = lateral_lattices(self.pair, grid, &rotation);
        self.envelope.turn(&rotation);
        self.envelope.heights_and_carriers(x, y, &mut self.heights, &mut self.carriers);
        self.numbers.clear();
        let mut patches = Vec::new();
        for (k, carrier) in self.carriers.iter().enumerate() {
            let pose =
                CorPose { lateral: lateral(lattices, (k % x.count) as f64, (k / x.count) as f64), rotation };
            energies[k] = self.pair.energy(&pose, self.heights[k]) as f32;
            carriers[k] = if *carrier == HeightEnvelope::NOTHING {
                GradientField::NOTHING
            } else {
                let slot = *carrier as usize;
                if slot >= self.numbers.len() {
                    self.numbers.resize(slot + 1, GradientField::NOTHING);
                }
                if self.numbers[slot] == GradientField::NOTHING {
                    if patches.len() >= usize::from(GradientField::NOTHING) {
                        return Err(LandscapeError::TooManyPatches {
                            most: usize::from(GradientField::NOTHING),
                        });
                    }
                    self.numbers[slot] = patches.len() as u16;
                    // At points a lattice step apart, or 1 D apart along an axis without a step: the patch is
                    // constant there.
                    let at = |kx: f64, ky: f64| lateral(lattices, kx, ky);
                    let gradient = |lateral: DVec2| {
                        let (contact, cor) = self.envelope.carried_by(*carrier, lateral);
                        let ([gx, gy], turn) = contact.gradient(cor);
                        linear(&[gx, gy, turn.x, turn.y, turn.z])
                    };
                    patches.push(Patch::through([at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)].map(gradient)));
                }
                self.numbers[slot]
            };
        }
        Ok(patches)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::Connector;
    use crate::contact::Contact;
    use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
    use crate::landscape::Landscape;
    use crate::pose::Dof;

    fn pair(family: Family) -> Pair {
        let mut alignment = Alignment::default_for(Some(family));
        alignment.center_of_rotation = -0.4;
        let connector = ConnectorSpec::Family(FamilySpec::new(family));
        let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
        Pair::new(&Connector::build(&design).unwrap(), &design.alignment)
    }

    #[test]
    fn energies_are_those_of_the_landscape_and_gradients_those_of_a_contact() {
        for family in [Family::Pyramid, Family::XFace3d, Family::VFace, Family::SFace, Family::Cone] {
            let pair = pair(family);
            let cells = if pair.alignment.free.len() == 2 { 12 } else { 4 };
            let grid = Grid::over(&pair.alignment, |_| cells);
            let field = GradientField::compute(&pair, &grid, &Exec::new(), |_| |g: &Gradient| *g).unwrap();
            let landscape = Landscape::compute(&pair, &grid, &Exec::new()).unwrap();
            let mut contacts: Vec<Contact> = Vec::new();
            let mut carried = 0;
            for cell in 0..grid.len() {
                let kept = field.fold.kept_cell(cell);
                let (a, b) = (field.energies[kept], landscape.heights[cell]);
                assert!(a == b || (a - b).abs() < 1e-6, "{family:?} {cell}: {a} {b}");
                let slab = field.fold.slab();
                let representative = kept / slab;
                if field.fold.rotation(representative) * slab + kept % slab != cell || !a.is_finite() {
                    continue;
                }
                carried += 1;
                // The gradient must belong to one of the active contacts; the list contains all of them,
                // including the carrier.
                let error = grid.pose(cell);
                let pose = CorPose::from_error(&error, -0.4, pair.alignment.free);
                let mut envelope = pair.at_rotation(pose.rotation);
                let cor = pose.lateral.extend(envelope.height(pose.lateral).unwrap());
                envelope.contacts(cor, 1e-9, &mut contacts);
                let nx = grid.axis(Dof::X).map_or(1, |a| a.cells);
                let patch = field.patches[representative][usize::from(field.carriers[kept])];
                let result = patch.at(kept % slab % nx, kept % slab / nx);
                let near = contacts.iter().any(|c| {
                    let ([gx, gy], turn) = c.gradient(cor);
                    [gx, gy, turn.x, turn.y, turn.z]
                        .iter()
                        .zip(result)
                        .all(|(a, b)| (a - f64::from(b)).abs() < 1e-4 * (1.0 + a.abs()))
                });
                assert!(near, "{family:?} {cell}: {result:?} is none of {contacts:?}");
            }
            assert!(carried > 10, "{family:?}: {carried}");
        }
    }

    /// A byte for each cell stores which entries of the gradient are negative.
    #[test]
    fn falls_are_the_signs_of_the_gradients() {
        for family in [Family::Pyramid, Family::XFace3d, Family::VFace, Family::SFace, Family::Cone] {
            let pair = pair(family);
            let cells = if pair.alignment.free.len() == 2 { 12 } else { 4 };
            let grid = Grid::over(&pair.alignment, |_| cells);
            let linear = |_: &pose::PoseError| |g: &Gradient| *g;
            let field = GradientField::compute(&pair, &grid, &Exec::new(), linear).unwrap();
            let falls = DescentDirections::compute(&pair, &grid, &Exec::new(), linear).unwrap();
            assert_eq!(field.energies, falls.energies);
            let (slab, nx) = (field.fold.slab(), grid.axis(Dof::X).map_or(1, |a| a.cells));
            for (kept, below) in falls.below.iter().enumerate() {
                let carrier = field.carriers[kept];
                if carrier == GradientField::NOTHING {
                    assert_eq!(*below, DescentDirections::NOTHING);
                    continue;
                }
                let gradient =
                    field.patches[kept / slab][usize::from(carrier)].at(kept % slab % nx, kept % slab / nx);
                for (k, entry) in gradient.iter().enumerate() {
                    assert_eq!(below >> k & 1 == 1, *entry < 0.0, "{family:?} {kept} {gradient:?}");
                }
            }
        }
    }

    #[test]
    fn threads_do_not_change_a_bit() {
        let pair = pair(Family::Pyramid);
        let grid = Grid::over(&pair.alignment, |_| 4);
        let with = |threads| {
            let exec = Exec::new().with_threads(threads).unwrap();
            GradientField::compute(&pair, &grid, &exec, |_| |g: &Gradient| *g).unwrap()
        };
        let (one, three) = (with(1), with(3));
        assert_eq!(one.energies, three.energies);
        assert_eq!(one.carriers, three.carriers);
        assert_eq!(one.patches, three.patches);
    }
}
