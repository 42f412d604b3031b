//! The key of a design file to which an error of a later module belongs.

use crate::connector::{GeometryDefect, HalfRole, MeshProblem, PartGeometryError};
use crate::contact::display_unit::{DisplayUnit, number};
use crate::contact::mated::MatedProblem;
use crate::design::{DesignDefect, keys};
use crate::diagnostic::{Diagnostic, Diagnostics};
use std::mem::discriminant;

/// The key that forbids a change.
pub(super) const fn of_change(defect: &DesignDefect) -> &'static str {
    match defect {
        DesignDefect::OutOfPlane { .. } => "connector.family",
        DesignDefect::NotAParameter { .. } => "connector",
        DesignDefect::PitchBeyondPole => "errors.pitch",
        _ => "",
    }
}

/// The key to which a problem of the mated pose refers.
pub(super) const fn of_mated(problem: &MatedProblem) -> &'static str {
    match problem {
        MatedProblem::Collision { .. } | MatedProblem::Gap { .. } => "connector.face_height",
        MatedProblem::DrawnApart { .. } | MatedProblem::DrawnDeeper { .. } => "connector.drawn",
        MatedProblem::Apart | MatedProblem::SideBySide(_) => "connector",
        MatedProblem::RunsOff => "connector.settle",
        MatedProblem::NotMinimum { .. } | MatedProblem::Free { .. } | MatedProblem::Round { .. } => {
            "alignment.free"
        }
        MatedProblem::LimitCutsPlay { dof, .. } => keys::DOCKED_PLACES[dof.index()],
    }
}

/// Key, message and advice of geometric problems; equal problems of the same mesh are merged, with the others
/// as advice.
pub(super) fn of_geometry(
    problems: &[GeometryDefect],
    display: DisplayUnit,
) -> Vec<(String, String, Option<String>)> {
    problems
        .chunk_by(same_kind)
        .map(|kind| (key_of(&kind[0]), message(&kind[0], display), likewise(&kind[1..])))
        .collect()
}

/// A problem as a sentence: a size that makes no sense in the unit of the design as well.
fn message(problem: &GeometryDefect, display: DisplayUnit) -> String {
    let text = problem.to_string();
    let (GeometryDefect::Mesh { error, .. }
    | GeometryDefect::Part { error: PartGeometryError::Mesh { error, .. }, .. }
    | GeometryDefect::Triangles { error, .. }) = problem
    else {
        return text;
    };
    match error {
        MeshProblem::Unit { width } if display != DisplayUnit::IN_D => {
            let size = format!(
                "the half is {} wide, {} D; a connector's half is about 1 D: check the mesh's unit and the design's width",
                display.length(*width),
                number(*width)
            );
            text.replace(&error.to_string(), &size)
        }
        _ => text,
    }
}

/// Geometric problems of halves that no file describes.
pub fn diagnostics(problems: &[GeometryDefect]) -> Diagnostics {
    let diagnostic = |(_, message, help)| Diagnostic::error("geometry", message, help);
    let list = of_geometry(problems, DisplayUnit::IN_D).into_iter().map(diagnostic).collect();
    Diagnostics { source: None, list, omitted: 0 }
}

/// Whether two problems of a mesh are equivalent: a hole opens several edges, but it is a single hole to
/// close.
fn same_kind(a: &GeometryDefect, b: &GeometryDefect) -> bool {
    match (a, b) {
        (GeometryDefect::Mesh { side: a, error: first, .. }, GeometryDefect::Mesh { side: b, error, .. }) => {
            a == b
                && (discriminant(first) == discriminant(error)
                    || matches!(error, MeshProblem::More { .. } | MeshProblem::NotLookedAt { .. }))
        }
        (
            GeometryDefect::Part { side: a, part: p, error: PartGeometryError::Mesh { error: first, .. } },
            GeometryDefect::Part { side: b, part: q, error: PartGeometryError::Mesh { error, .. } },
        ) => {
            (a, p) == (b, q)
                && (discriminant(first) == discriminant(error)
                    || matches!(error, MeshProblem::More { .. } | MeshProblem::NotLookedAt { .. }))
        }
        _ => false,
    }
}

/// The other places of a kind of problem.
fn likewise(rest: &[GeometryDefect]) -> Option<String> {
    let places: Vec<String> = rest
        .iter()
        .map(|problem| match problem {
            GeometryDefect::Mesh { error, .. }
            | GeometryDefect::Part { error: PartGeometryError::Mesh { error, .. }, .. } => error.to_string(),
            other => other.to_string(),
        })
        .collect();
    (!places.is_empty()).then(|| format!("likewise: {}", places.join("; ")))
}

fn key_of(problem: &GeometryDefect) -> String {
    match problem {
        GeometryDefect::Parameter { parameter, .. } => format!("connector.{parameter}"),
        GeometryDefect::Surface { side, .. } => format!("connector.{}", half(*side)),
        GeometryDefect::PieceCount { side, .. } => format!("connector.{}.pieces", half(*side)),
        GeometryDefect::Piece { side, piece, .. } => format!("connector.{}.pieces[{piece}]", half(*side)),
        GeometryDefect::Mesh { side, .. } => format!("connector.{}.mesh", half(*side)),
        GeometryDefect::Part { side, part, error } => {
            let key = match error {
                PartGeometryError::Mesh { .. } => ".mesh",
                PartGeometryError::Outline { .. } => ".profile",
                _ => "",
            };
            format!("connector.{}.parts[{part}]{key}", half(*side))
        }
        GeometryDefect::Triangles { side, .. }
        | GeometryDefect::Union { side, .. }
        | GeometryDefect::NotInDesign { side } => {
            format!("connector.{}", half(*side))
        }
    }
}

const fn half(side: HalfRole) -> &'static str {
    match side {
        HalfRole::Fixed => "fixed",
        HalfRole::Moving => "moving",
    }
}
