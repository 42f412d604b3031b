//! The alignment problem as an owned value: the input of every front end.
//!
//! ```text
//!   design file ──▶ Draft ──(meshes loaded, halves built, mated pose checked once)──▶ Problem
//!   values in memory ─────────────────────────────────────────────────────────────────┘
//!                                                     geometry · alignment · mirrors · warnings · digest
//! ```
//!
//! A [`Problem`] holds everything that determines a result besides the method and its settings. It is cheap
//! to clone, can be sent to any thread, and is immutable: another centre of rotation needs another problem.
//! Its [`digest`](Problem::digest) is a SHA-256 of all inputs that may change a result, including the
//! contents of meshes and excluding names, units and paths, so that two problems with equal digests have
//! equal results.
//!
//! All reasons why a problem cannot be built share an error type with the places in the file
//! ([`ProblemError`]).
//!
//! Not promised: that the mated pose is stable against errors larger than the probes of
//! [`crate::contact::mated`]. Lengths in D, angles in radians.

mod defect_keys;
mod draft;
mod measure;
mod memory;
mod remedies;
#[cfg(test)]
mod tests;

pub use defect_keys::diagnostics;
pub use draft::Draft;

use crate::connector::{Connector, HalfRole};
use crate::contact::mated::MatedProblem;
use crate::contact::{Mirror, Pair};
use crate::design::{Alignment, ConnectorSpec, Design, FamilySpec, LoadError, SourceText, hex};
use crate::diagnostic::Diagnostics;
use crate::exec::Exec;
use crate::pose::Dof;
use glam::DVec3;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

/// An alignment problem, ready to be decided.
#[derive(Clone)]
pub struct Problem(Arc<Inner>);

struct Inner {
    draft: Draft,
    connector: Connector,
    pair: Pair,
    mated_warnings: Vec<MatedProblem>,
    digest: String,
}

/// Why there is no problem to decide.
#[derive(Debug, thiserror::Error)]
pub enum ProblemError {
    /// There is no text.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// Errors of the design, of its geometry, or of its mated pose.
    #[error(transparent)]
    Diagnostics(#[from] Diagnostics),
}

impl Problem {
    /// The problem of a design file.
    ///
    /// # Errors
    /// The file or a mesh cannot be read, or everything that is wrong with them, each with its place.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, ProblemError> {
        Draft::open(path.as_ref())?.build()
    }

    /// The problem of a design, such as one that a study changed.
    ///
    /// # Errors
    /// All errors of its geometry or its mated pose.
    pub fn of(design: Design) -> Result<Self, ProblemError> {
        Draft::from(design).build()
    }

    /// This problem with another design, for example with another centre of rotation. If the halves are
    /// unchanged they are not built again, and no file is read.
    ///
    /// # Errors
    /// All errors of its geometry or its mated pose.
    pub fn with(&self, design: Design) -> Result<Self, ProblemError> {
        let own = self.design();
        // The rest that halves settle into depends on the alignment.
        let settles = matches!(&design.connector, ConnectorSpec::Own(own) if own.settle);
        if !settles && design.connector == own.connector && design.alignment.mount == own.alignment.mount {
            return Draft::from(design).with_halves(self.connector().clone(), &Exec::new());
        }
        Draft::from(design).beside(&self.0.draft).build()
    }

    fn assembled(draft: Draft, connector: Connector, pair: Pair, mated_warnings: Vec<MatedProblem>) -> Self {
        // The mesh contents are known at this point for any design whose halves were built, so a digest
        // exists.
        let digest = draft.design().digest().map_or_else(String::new, |digest| hex(&digest));
        Self(Arc::new(Inner { draft, connector, pair, mated_warnings, digest }))
    }

    /// The design, resolved.
    pub fn design(&self) -> &Design {
        self.0.draft.design()
    }

    /// The text from which it was read, if any.
    pub fn source(&self) -> Option<&SourceText> {
        self.0.draft.source()
    }

    /// Everything but the geometry that an answer depends on.
    pub fn alignment(&self) -> &Alignment {
        &self.design().alignment
    }

    /// The two halves.
    pub fn connector(&self) -> &Connector {
        &self.0.connector
    }

    /// The halves, ready for contact.
    pub fn pair(&self) -> &Pair {
        &self.0.pair
    }

    /// The reflections that map the pair onto itself.
    pub fn mirrors(&self) -> &[Mirror] {
        self.pair().mirrors()
    }

    /// Warnings about the mated pose.
    pub fn mated_warnings(&self) -> &[MatedProblem] {
        &self.0.mated_warnings
    }

    /// SHA-256, in hexadecimal digits, of everything that may change an answer.
    pub fn digest(&self) -> &str {
        &self.0.digest
    }

    /// Whether a layer of the moving half can meet a layer that is not its partner: the halves have layers,
    /// and some error leads out of their plane.
    pub fn may_cross(&self) -> bool {
        let out_of_plane = [Dof::Y, Dof::Roll, Dof::Yaw];
        self.design().family_spec().is_some_and(FamilySpec::is_layered)
            && out_of_plane.into_iter().any(|dof| self.alignment().free.contains(dof))
    }

    /// A point of a half, given in its frame (of the moving half from its face centre, mounted), in the half's own coordinates, in D: those in
    /// which it was drawn, or, for a family, from the face centre of a half that faces up.
    pub fn drawn(&self, side: HalfRole, point: DVec3) -> DVec3 {
        match (&self.design().connector, side) {
            (ConnectorSpec::Own(_), _) => self.connector().origin.drawn(side, point),
            (ConnectorSpec::Family(_), HalfRole::Fixed) => point,
            (ConnectorSpec::Family(_), HalfRole::Moving) => self.alignment().mount.apply(point),
        }
    }

    /// Additional advice for a warning about its mated pose.
    pub(crate) fn advice(&self, problem: &MatedProblem) -> Option<String> {
        remedies::advice(self.connector(), self.pair(), self.design(), problem)
    }

    /// This problem, refused for a reason that another room found, at the key it is about.
    pub fn refused(&self, place: &str, message: String, help: Option<String>) -> Diagnostics {
        self.0.draft.clone().refused(place, message, help)
    }
}

impl fmt::Debug for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Problem")
            .field("name", &self.design().name)
            .field("digest", &self.digest())
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
pub(crate) mod testing {
    //! Problems to try things on.

    use crate::design::{Design, Family};
    use crate::pose::DofSet;
    use crate::problem::Problem;

    /// A family with its defaults, free in `free`.
    pub(crate) fn problem(family: Family, free: DofSet) -> Problem {
        Problem::of(Design::of_family(family, free)).unwrap()
    }
}
