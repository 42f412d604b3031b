//! Advice for an error or a warning, as data, so that each front end can phrase it with its own controls: a
//! command line with its options, a page with its fields.

use serde::{Serialize, Serializer};
use std::fmt;

/// Something that helps.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Advice {
    /// So many cells per axis would fit.
    AtMostResolution(usize),
    /// Largest number of sampled poses that fits.
    AtMostSamples(u64),
    /// A coarser grid.
    CoarserGrid,
    /// An error box that reaches farther.
    EnlargeErrors,
    /// Fewer poses at a time.
    FewerPoses,
    /// Fewer slices or strips of the partition.
    FewerSlices,
    /// Fewer threads.
    FewerThreads,
    /// A finer grid.
    FinerGrid,
    /// A magnet, a pin, a stop: a part that belongs to a half and is not in its file.
    MissingPart,
    /// This method instead.
    Method(&'static str),
    /// A larger memory budget.
    MoreMemory,
    /// Parts that are each drawn in a frame of their own, instead of as an assembly.
    OwnFrames,
    /// Sampled poses, followed exactly.
    Samples,
    /// A look at the picture of the pair, and a statement how the parts lie.
    StateLayout,
    /// Advice that every front end words alike.
    Words(String),
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AtMostResolution(cells) => write!(f, "at most {cells} cells per axis fit"),
            Self::AtMostSamples(poses) => write!(f, "at most {poses} random poses fit"),
            Self::CoarserGrid => f.write_str("use a coarser grid"),
            Self::EnlargeErrors => f.write_str("enlarge the error box"),
            Self::FewerPoses => f.write_str("try fewer poses at a time"),
            Self::FewerSlices => f.write_str("use fewer slices or strips"),
            Self::FewerThreads => f.write_str("use fewer threads"),
            Self::FinerGrid => f.write_str("use a finer grid"),
            Self::MissingPart => f.write_str("add what a half has beside its file"),
            Self::Method(name) => write!(f, "use the method {name}"),
            Self::MoreMemory => f.write_str("allow more memory"),
            Self::OwnFrames => f.write_str("take the parts as drawn in frames of their own"),
            Self::Samples => f.write_str("follow random poses exactly"),
            Self::StateLayout => f.write_str("look at the picture, or state how the parts lie"),
            Self::Words(words) => f.write_str(words),
        }
    }
}

impl Serialize for Advice {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Advice for an error, as alternatives: the `source()` of an error with advice, at any depth.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join(", or "))]
pub struct Advised(pub Vec<Advice>);
