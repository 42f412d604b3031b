//! The reply of the child process: a line of JSON, then for every body its corners and triangles,
//! little-endian.

use super::{FromCurves, StepProblem};
use crate::mesh::{self, FileOffset, MeshProblem, Triangle, TriangleLocation, most_read};
use crate::source::FileContent;
use catchment_design::design::{LengthUnit, MeshPreparation, hex};
use glam::DVec3;
use serde::Deserialize;
use sha2::{Digest, Sha256};

/// Bytes of a corner, and of a triangle.
const CORNER: usize = 24;
const TRIANGLE: usize = 12;
/// Bytes of the line of JSON, far more than the numbers of thousands of bodies take.
const MOST_HEAD: usize = 1 << 20;
/// Largest length of the mesher's name, in characters.
const LONGEST_NAME: usize = 100;

/// The line.
#[derive(Deserialize)]
struct Head {
    error: Option<String>,
    #[serde(default)]
    message: String,
    /// Numbers of corners and triangles.
    #[serde(default)]
    bodies: Vec<[usize; 2]>,
    #[serde(default)]
    deflection: f64,
    #[serde(default)]
    reached: f64,
    #[serde(default)]
    by: String,
}

/// Bytes of an answer of so many triangles: a body has no more than three corners for each.
pub(super) const fn most_bytes(triangles: usize) -> u64 {
    (MOST_HEAD + triangles * (TRIANGLE + 3 * CORNER)) as u64
}

/// The bodies of a reply, or the error that it contains.
pub(super) fn read(
    answer: &[u8],
    program: &str,
    treatment: MeshPreparation,
) -> Result<FileContent, Vec<MeshProblem>> {
    let broken = || {
        let message = "its answer is broken".to_owned();
        vec![StepProblem::Died { program: program.to_owned(), message }.into()]
    };
    let head = &answer[..answer.len().min(MOST_HEAD)];
    let end = head.iter().position(|byte| *byte == b'\n').ok_or_else(broken)?;
    let head: Head = serde_json::from_slice(&answer[..end]).map_err(|_| broken())?;
    let Head { error, message, bodies: sizes, deflection, reached, by } = head;
    if let Some(kind) = error {
        return Err(vec![refusal(&kind, &message, program, treatment)]);
    }
    mesh::BODIES.allows(sizes.len() as u64).map_err(|over| mesh::overspent("the file", over))?;
    let rest = &answer[end + 1..];
    let mut bodies = Vec::with_capacity(sizes.len());
    let (mut at, mut number) = (0_usize, 0);
    for [corners, triangles] in sizes {
        let mut take = |count: usize, size: usize| {
            let bytes = rest.get(at..)?.get(..count.checked_mul(size)?)?;
            at += bytes.len();
            Some(bytes)
        };
        let corners = take(corners, CORNER).ok_or_else(broken)?;
        let corners: Vec<DVec3> = corners.chunks_exact(CORNER).map(corner).collect();
        let triangles = take(triangles, TRIANGLE).ok_or_else(broken)?;
        let mut body = Vec::with_capacity(triangles.len() / TRIANGLE);
        for triangle in triangles.chunks_exact(TRIANGLE) {
            let at = |k: usize| {
                let index = triangle[4 * k..].first_chunk().map(|bytes| u32::from_le_bytes(*bytes));
                index.and_then(|index| corners.get(index as usize)).copied()
            };
            let (Some(a), Some(b), Some(c)) = (at(0), at(1), at(2)) else { return Err(broken()) };
            let place = TriangleLocation { triangle: number, start: FileOffset::Memory };
            body.push(Triangle { corners: [a, b, c], place });
            number += 1;
        }
        bodies.push(body);
    }
    let sound = at == rest.len() && deflection > 0.0 && reached >= 0.0 && by.len() < LONGEST_NAME;
    if !sound {
        return Err(broken());
    }
    let sha256 = hex(&Sha256::digest(rest));
    let curves = FromCurves { deflection, reached, by, sha256 };
    Ok(FileContent { bodies, metres: Some(LengthUnit::Mm.metres()), curves: Some(curves) })
}

fn corner(bytes: &[u8]) -> DVec3 {
    let number = |k: usize| bytes[8 * k..].first_chunk().map_or(f64::NAN, |bytes| f64::from_le_bytes(*bytes));
    DVec3::new(number(0), number(1), number(2))
}

fn refusal(kind: &str, message: &str, program: &str, treatment: MeshPreparation) -> MeshProblem {
    let message: String = message.chars().filter(|c| !c.is_control()).collect();
    let program = program.to_owned();
    match kind {
        "package" => StepProblem::NoPackage { program, message },
        "unreadable" => StepProblem::Unreadable { message },
        "empty" => StepProblem::NoSolid { message },
        "unmeshed" => StepProblem::NotMeshed { message },
        "memory" => StepProblem::Memory,
        "many" => {
            StepProblem::TooMany { count: message.parse().unwrap_or(u64::MAX), most: most_read(treatment) }
        }
        _ => StepProblem::Died { program, message },
    }
    .into()
}
