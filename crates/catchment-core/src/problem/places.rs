//! The key of a design file to which an error of a later module belongs.

use crate::connector::{MeshProblem, PartError, Problem, Side};
use crate::contact::display_unit::{DisplayUnit, number};
use crate::contact::mated::MatedProblem;
use crate::design::{Complaint, Finding, Findings, keys};
use std::mem::discriminant;

/// The key that forbids a change.
pub(super) const fn of_change(complaint: &Complaint) -> &'static str {
    match complaint {
        Complaint::OutOfPlane { .. } => "connector.family",
        Complaint::NotAParameter { .. } => "connector",
        Complaint::PitchBeyondPole => "errors.pitch",
        _ => "",
    }
}

/// The key that a mated pose which is none is about.
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

/// Key, message and advice of geometric problems; those that say the same of one mesh are one, with the others as advice.
pub(super) fn of_geometry(problems: &[Problem], told: DisplayUnit) -> Vec<(String, String, Option<String>)> {
    problems
        .chunk_by(same_kind)
        .map(|kind| (key_of(&kind[0]), message(&kind[0], told), likewise(&kind[1..])))
        .collect()
}

/// A problem as a sentence: a size that makes no sense in the unit of the design as well.
fn message(problem: &Problem, told: DisplayUnit) -> String {
    let text = problem.to_string();
    let (Problem::Mesh { error, .. }
    | Problem::Part { error: PartError::Mesh { error, .. }, .. }
    | Problem::Triangles { error, .. }) = problem
    else {
        return text;
    };
    match error {
        MeshProblem::Unit { width } if told != DisplayUnit::IN_D => {
            let size = format!(
                "the half is {} wide, {} D; a connector's half is about 1 D: check the mesh's unit and the design's width",
                told.length(*width),
                number(*width)
            );
            text.replace(&error.to_string(), &size)
        }
        _ => text,
    }
}

/// Geometric problems of halves that no file describes.
pub fn findings(problems: &[Problem]) -> Findings {
    let finding = |(_, message, help)| Finding::new(message, help);
    let list = of_geometry(problems, DisplayUnit::IN_D).into_iter().map(finding).collect();
    Findings { source: None, list, omitted: 0 }
}

/// Whether two problems say the same of one mesh: a hole opens several edges, but it is one hole to close.
fn same_kind(a: &Problem, b: &Problem) -> bool {
    match (a, b) {
        (Problem::Mesh { side: a, error: first, .. }, Problem::Mesh { side: b, error, .. }) => {
            a == b
                && (discriminant(first) == discriminant(error)
                    || matches!(error, MeshProblem::More { .. } | MeshProblem::NotLookedAt { .. }))
        }
        (
            Problem::Part { side: a, part: p, error: PartError::Mesh { error: first, .. } },
            Problem::Part { side: b, part: q, error: PartError::Mesh { error, .. } },
        ) => {
            (a, p) == (b, q)
                && (discriminant(first) == discriminant(error)
                    || matches!(error, MeshProblem::More { .. } | MeshProblem::NotLookedAt { .. }))
        }
        _ => false,
    }
}

/// The other places of one kind of problem.
fn likewise(rest: &[Problem]) -> Option<String> {
    let places: Vec<String> = rest
        .iter()
        .map(|problem| match problem {
            Problem::Mesh { error, .. } | Problem::Part { error: PartError::Mesh { error, .. }, .. } => {
                error.to_string()
            }
            other => other.to_string(),
        })
        .collect();
    (!places.is_empty()).then(|| format!("likewise: {}", places.join("; ")))
}

fn key_of(problem: &Problem) -> String {
    match problem {
        Problem::Parameter { parameter, .. } => format!("connector.{parameter}"),
        Problem::Surface { side, .. } => format!("connector.{}", half(*side)),
        Problem::PieceCount { side, .. } => format!("connector.{}.pieces", half(*side)),
        Problem::Piece { side, piece, .. } => format!("connector.{}.pieces[{piece}]", half(*side)),
        Problem::Mesh { side, .. } => format!("connector.{}.mesh", half(*side)),
        Problem::Part { side, part, error } => {
            let key = match error {
                PartError::Mesh { .. } => ".mesh",
                PartError::Outline { .. } => ".profile",
                _ => "",
            };
            format!("connector.{}.parts[{part}]{key}", half(*side))
        }
        Problem::Triangles { side, .. } | Problem::Union { side, .. } | Problem::NotInDesign { side } => {
            format!("connector.{}", half(*side))
        }
    }
}

const fn half(side: Side) -> &'static str {
    match side {
        Side::Fixed => "fixed",
        Side::Moving => "moving",
    }
}
