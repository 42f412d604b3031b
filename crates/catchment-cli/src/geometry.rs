//! From a design to its halves, with geometry's complaints placed in the design file.

use crate::source::{Finding, Input, InputError};
use catchment::connector::{Connector, MeshProblem, Problem, Side};
use catchment::contact::Pair;
use catchment::contact::mated::{self, MatedProblem};
use std::mem::discriminant;

/// A design and its halves.
#[derive(Debug)]
pub(crate) struct Built {
    /// The design, and where its file says what.
    pub input: Input,
    /// Its halves.
    pub connector: Connector,
}

impl Built {
    /// Builds the halves of a design.
    pub(crate) fn new(mut input: Input) -> Result<Self, InputError> {
        match Connector::build(&input.design) {
            Ok(connector) => {
                input.design = input.design.with_contents(&connector.contents);
                Ok(Self { input, connector })
            }
            Err(problems) => {
                let findings = problems
                    .chunk_by(same_kind)
                    .map(|kind| input.finding(&place(&kind[0]), kind[0].to_string(), likewise(&kind[1..])))
                    .collect();
                Err(input.refused(findings))
            }
        }
    }

    /// The pair that moves, refused where the halves do not meet in the aligned pose, and the doubts about it.
    pub(crate) fn into_pair(self) -> Result<(Self, Pair, Vec<String>), InputError> {
        let pair = Pair::new(&self.connector, &self.input.design.alignment);
        let found = mated::problems(&pair);
        let (doubts, apart): (Vec<_>, Vec<_>) =
            found.iter().partition(|problem| matches!(problem, MatedProblem::NotMinimum { .. }));
        if apart.is_empty() {
            let doubts = doubts.iter().map(ToString::to_string).collect();
            return Ok((self, pair, doubts));
        }
        let findings = apart
            .iter()
            .map(|problem| self.input.finding(mated_place(problem), problem.to_string(), None))
            .collect();
        Err(self.input.refused(findings))
    }

    /// What keeps the aligned pose from being a mated pose.
    pub(crate) fn mated_findings(&self) -> Vec<Finding> {
        let pair = Pair::new(&self.connector, &self.input.design.alignment);
        let found = mated::problems(&pair);
        found
            .iter()
            .map(|problem| self.input.finding(mated_place(problem), problem.to_string(), None))
            .collect()
    }
}

/// Whether two problems say the same of one mesh: a hole opens several edges, but it is one hole to close.
fn same_kind(a: &Problem, b: &Problem) -> bool {
    match (a, b) {
        (Problem::Mesh { side: a, error: first, .. }, Problem::Mesh { side: b, error, .. }) => {
            a == b
                && (discriminant(first) == discriminant(error) || matches!(error, MeshProblem::More { .. }))
        }
        _ => false,
    }
}

/// The other places of one kind of problem.
fn likewise(rest: &[Problem]) -> Option<String> {
    let places: Vec<String> = rest
        .iter()
        .map(|problem| match problem {
            Problem::Mesh { error, .. } => error.to_string(),
            other => other.to_string(),
        })
        .collect();
    (!places.is_empty()).then(|| format!("likewise: {}", places.join("; ")))
}

/// The key that a geometric problem is about.
fn place(problem: &Problem) -> String {
    match problem {
        Problem::Parameter { parameter, .. } => format!("connector.{parameter}"),
        Problem::Surface { side, .. } => format!("connector.{}", key(*side)),
        Problem::PieceCount { side, .. } => format!("connector.{}.pieces", key(*side)),
        Problem::Piece { side, piece, .. } => format!("connector.{}.pieces[{piece}]", key(*side)),
        Problem::Mesh { side, .. } => format!("connector.{}.mesh", key(*side)),
        Problem::Triangles { side, .. } | Problem::NotInDesign { side } => {
            format!("connector.{}", key(*side))
        }
    }
}

fn key(side: Side) -> &'static str {
    match side {
        Side::Fixed => "fixed",
        Side::Moving => "moving",
    }
}

fn mated_place(problem: &MatedProblem) -> &'static str {
    match problem {
        MatedProblem::Collision { .. } | MatedProblem::Gap { .. } => "connector.face_height",
        MatedProblem::Apart => "connector",
        MatedProblem::NotMinimum { .. } => "alignment.free",
    }
}
