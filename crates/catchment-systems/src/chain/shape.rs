//! The shapes into which chains fold: cells of a lattice with the spacing of one pitch, rotating joints,
//! latching faces.
//!
//! ```text
//!    P            Block, middle    Block, tail       O
//!    1─2─3─4      1─2─3            1─2               1─2     (corners 2, 5, 8, 11)
//!        ◆ │      ◆ ◆ │            ◆ │          ┌─12◆  │
//!        6─5      6─5─4            6◆3          11     3
//!                                  │ │          │      │
//!                                  5─4          ┊      ┊
//! ```
//!
//! A joint of a lattice rotates by quarter turns, here by −90° each. Two modules in neighbouring cells that
//! are not joined by a link latch (◆) if both have a face there: front and sides lie behind the joint, and
//! the first module has a back.
//!
//! The dissertation names P, Block and O (section 6.3, figure 6.5) and its picture is lost: the rotating
//! joints are given for P alone. Both readings of the Block give a cluster of 3 × 2 with two latches; the
//! reading that is folded in the middle is preferred because the text describes latching in mid chain, from a
//! straight chain, like a zipper. The corners of the O are chosen so that the closing link lies in the middle
//! of a side.

use super::kinematics::{ModuleDimensions, PlanarPose, rotors, wrapped};
use catchment::tolerance::SINGLE;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI};

/// A face of a module.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum ModuleFace {
    /// Front face, behind the joint.
    Front,
    /// Left face, behind the joint.
    Left,
    /// Right face, behind the joint.
    Right,
    /// Rear face, before the joint: only the first module's.
    Back,
}

impl ModuleFace {
    /// Rotation from the heading to which it is fixed.
    pub const fn turn(self) -> f64 {
        match self {
            Self::Front => 0.0,
            Self::Left => FRAC_PI_2,
            Self::Right => -FRAC_PI_2,
            Self::Back => PI,
        }
    }

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Left => "left",
            Self::Right => "right",
            Self::Back => "back",
        }
    }

    /// The face centre with its outward direction, from the rotors of a chain and its joint angles; `module` from 1.
    pub fn of(
        self,
        body: &ModuleDimensions,
        rotors: &[PlanarPose],
        angles: &[f64],
        module: usize,
    ) -> PlanarPose {
        let rotor = rotors[module - 1];
        // Faces before the joint do not turn with it.
        let before = if self == Self::Back { -angles[module - 1] } else { 0.0 };
        rotor.ahead(before + self.turn(), body.overhang)
    }
}

/// Two faces that latch; modules are numbered from 1, and `from` is the nearer to the base.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LatchingPair {
    /// Module nearer to the base.
    pub from: usize,
    /// Module farther along the chain.
    pub to: usize,
    /// Face of `from`.
    pub from_side: ModuleFace,
    /// Face of `to`.
    pub to_side: ModuleFace,
}

impl LatchingPair {
    /// `3–6`.
    pub fn name(&self) -> String {
        format!("{}–{}", self.from, self.to)
    }

    /// Both faces, from the rotors of a chain and its joint angles.
    pub fn faces(&self, body: &ModuleDimensions, rotors: &[PlanarPose], angles: &[f64]) -> [PlanarPose; 2] {
        [self.from_side.of(body, rotors, angles, self.from), self.to_side.of(body, rotors, angles, self.to)]
    }

    /// Joints between the two faces, counted from 0.
    pub const fn joints(&self) -> std::ops::Range<usize> {
        match self.from_side {
            ModuleFace::Back => self.from - 1..self.to,
            _ => self.from..self.to,
        }
    }
}

/// Reading of the source for the Block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Reading {
    /// Reading A: folded in the middle, joints 3 and 4.
    Middle,
    /// Reading B: from the P, its tail folded at joint 2.
    Tail,
}

/// A shape by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "name")]
pub enum ChainShape {
    /// Six modules, one lattice step.
    P,
    /// Six modules, a cluster of 3 × 2.
    Block {
        /// Way of folding.
        reading: Reading,
    },
    /// Twelve modules, a square of four modules a side.
    O {
        /// The first corner: 1, 2 or 3; the others follow every three modules.
        first_corner: usize,
    },
}

/// First corners that an O can have.
pub const FIRST_CORNERS: std::ops::RangeInclusive<usize> = 1..=SIDE;
/// Modules of a side of the O, counting each corner once.
const SIDE: usize = 3;

impl ChainShape {
    /// `P`, `Block A`, `Block B`, `O`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::P => "P",
            Self::Block { reading: Reading::Middle } => "Block, reading A",
            Self::Block { reading: Reading::Tail } => "Block, reading B",
            Self::O { .. } => "O",
        }
    }

    /// Modules of the chain.
    pub const fn modules(self) -> usize {
        match self {
            Self::P | Self::Block { .. } => 6,
            Self::O { .. } => 4 * SIDE,
        }
    }

    /// Joints that turn by −90°, numbered from 1.
    pub fn turned(self) -> Vec<usize> {
        match self {
            Self::P => vec![4, 5],
            Self::Block { reading: Reading::Middle } => vec![3, 4],
            Self::Block { reading: Reading::Tail } => vec![2, 4, 5],
            Self::O { first_corner } => (0..4).map(|side| first_corner + SIDE * side).collect(),
        }
    }

    /// Angle of every joint.
    pub fn angles(self) -> Vec<f64> {
        let turned = self.turned();
        (1..=self.modules()).map(|k| if turned.contains(&k) { -FRAC_PI_2 } else { 0.0 }).collect()
    }

    /// The dissertation's statements and our reading.
    pub const fn reading(self) -> &'static str {
        match self {
            Self::P => "joints and commands of table 6.2",
            Self::Block { reading: Reading::Middle } => {
                "our reading: the picture is lost, the text describes latching in mid chain from straight"
            }
            Self::Block { reading: Reading::Tail } => {
                "our reading, not the preferred one: the P, its tail folded at module 2"
            }
            Self::O { .. } => {
                "our reading: the picture is lost; corners so that the closing link lies as requested"
            }
        }
    }
}

/// The cell of every rotor, in pitches; the first is (0, 0).
pub fn cells(angles: &[f64]) -> Vec<[i64; 2]> {
    let unit = ModuleDimensions { pitch: 1.0, ..ModuleDimensions::default() };
    rotors(&unit, angles).iter().map(|r| [r.x.round() as i64, r.y.round() as i64]).collect()
}

/// All pairs of a chain folded by quarter turns that latch: nearest along the chain first.
pub fn latches(angles: &[f64]) -> Vec<LatchingPair> {
    let cells = cells(angles);
    let mut result = Vec::new();
    for from in 1..=cells.len() {
        for to in from + 2..=cells.len() {
            let [a, b] = [cells[from - 1], cells[to - 1]];
            if (a[0] - b[0]).abs() + (a[1] - b[1]).abs() != 1 {
                continue;
            }
            let towards = |a: [i64; 2], b: [i64; 2]| ((b[1] - a[1]) as f64).atan2((b[0] - a[0]) as f64);
            let sides = (side(angles, from, towards(a, b)), side(angles, to, towards(b, a)));
            if let (Some(from_side), Some(to_side)) = sides {
                result.push(LatchingPair { from, to, from_side, to_side });
            }
        }
    }
    result.sort_by_key(|latch| latch.to - latch.from);
    result
}

/// The face of a module that faces a direction, if it has one there.
fn side(angles: &[f64], module: usize, towards: f64) -> Option<ModuleFace> {
    let heading: f64 = angles[..module].iter().sum();
    let looks = |heading: f64, side: ModuleFace| wrapped(heading + side.turn() - towards).abs() < SINGLE;
    if module == 1 && looks(0.0, ModuleFace::Back) {
        return Some(ModuleFace::Back);
    }
    [ModuleFace::Front, ModuleFace::Left, ModuleFace::Right].into_iter().find(|side| looks(heading, *side))
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: ChainShape = ChainShape::Block { reading: Reading::Middle };
    const B: ChainShape = ChainShape::Block { reading: Reading::Tail };

    fn latched(shape: ChainShape) -> Vec<(usize, usize)> {
        latches(&shape.angles()).iter().map(|l| (l.from, l.to)).collect()
    }

    #[test]
    fn the_shapes_have_the_published_cells_and_latches() {
        assert_eq!(cells(&ChainShape::P.angles()), [[0, 0], [1, 0], [2, 0], [3, 0], [3, -1], [2, -1]]);
        assert_eq!(cells(&A.angles()), [[0, 0], [1, 0], [2, 0], [2, -1], [1, -1], [0, -1]]);
        assert_eq!(cells(&B.angles()), [[0, 0], [1, 0], [1, -1], [1, -2], [0, -2], [0, -1]]);
        assert_eq!(latched(ChainShape::P), [(3, 6)]);
        assert_eq!(latched(A), [(2, 5), (1, 6)]);
        assert_eq!(latched(B), [(3, 6), (1, 6)]);
        for first_corner in FIRST_CORNERS {
            let shape = ChainShape::O { first_corner };
            assert_eq!(latched(shape), [(1, 12)], "{shape:?}");
            let cells = cells(&shape.angles());
            let reach = |k: usize| {
                let along = || cells.iter().map(|c| c[k]);
                (along().min().unwrap(), along().max().unwrap())
            };
            // The border of a lattice of 4 × 4.
            let ([left, right], [low, high]) = ([reach(0).0, reach(0).1], [reach(1).0, reach(1).1]);
            assert_eq!((right - left, high - low), (3, 3), "{shape:?}");
            assert!(cells.iter().all(|c| c[0] == left || c[0] == right || c[1] == low || c[1] == high));
        }
        for shape in [ChainShape::P, A, B, ChainShape::O { first_corner: 2 }] {
            let mut cells = cells(&shape.angles());
            cells.sort_unstable();
            cells.dedup();
            assert_eq!(cells.len(), shape.modules(), "{shape:?}: distinct cells");
        }
    }

    /// Latched faces coincide and face each other: the chain closes exactly, to the rounding of a dozen
    /// sines.
    #[test]
    fn latched_faces_coincide() {
        let body = ModuleDimensions::default();
        let shapes = [ChainShape::P, A, B].into_iter();
        for shape in shapes.chain(FIRST_CORNERS.map(|first_corner| ChainShape::O { first_corner })) {
            let angles = shape.angles();
            let rotors = rotors(&body, &angles);
            for latch in latches(&angles) {
                let [from, to] = latch.faces(&body, &rotors, &angles);
                assert!((from.place() - to.place()).length() < 1e-9, "{shape:?} {latch:?}: {from:?} {to:?}");
                assert!(wrapped(to.heading - from.heading - PI).abs() < 1e-9, "{shape:?} {latch:?}");
            }
        }
    }

    #[test]
    fn faces_that_a_module_lacks_do_not_latch() {
        // A ring of four: the front of the last module meets the back of the first, and no other faces meet.
        let ring = [0.0, -FRAC_PI_2, -FRAC_PI_2, -FRAC_PI_2];
        let result = latches(&ring);
        assert_eq!(result.len(), 1);
        assert_eq!((result[0].from, result[0].to), (1, 4));
        // The second cell of a turned module, against its new heading, has no face.
        assert_eq!(side(&[0.0, -FRAC_PI_2], 2, FRAC_PI_2), None);
        assert_eq!(latches(&[0.0; 5]), []);
    }
}
