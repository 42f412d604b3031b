//! The halves of a proposal: a file for each, with its settings, in the unit of the design.

use super::candidate::shown_unit;
use super::{PartDetail, PartFile, ProposalError, ProposalSettings, file};
use catchment_core::connector::{Half, HalfRole, of_half};
use catchment_core::design::{ConnectorSpec, FileSpec, FileUnit, HalfSpec, LengthUnit, SourceText};
use catchment_core::diagnostic::Diagnostics;
use catchment_core::exec::Exec;
use catchment_core::problem::{Draft, diagnostics};
use glam::DVec3;
use std::collections::HashSet;
use std::path::Path;

/// Reads them.
pub(super) fn read(
    parts: &[PartFile; 2],
    settings: &ProposalSettings,
    place: &Path,
    exec: &Exec,
) -> Result<[Half; 2], ProposalError> {
    let [fixed, moving] = specs(parts, settings, place)?;
    let halves = match (of_half(&fixed, HalfRole::Fixed, exec), of_half(&moving, HalfRole::Moving, exec)) {
        (Ok(fixed), Ok(moving)) => [fixed, moving],
        (fixed, moving) => {
            let all: Vec<_> = [fixed, moving].into_iter().filter_map(Result::err).flatten().collect();
            return Err(ProposalError::Problem(without_duplicates(diagnostics(&all)).into()));
        }
    };
    if settings.unit.is_none() {
        for (part, with) in parts.iter().zip(&settings.with) {
            let more = with.iter().filter_map(|beside| match beside {
                PartDetail::File(file) => Some(file),
                PartDetail::Part(_) => None,
            });
            let mut files = std::iter::once(part).chain(more);
            if let Some(file) = files.find(|file| !may_state_unit(&file.path)) {
                let alone = of_half(&mesh(file, settings), HalfRole::Fixed, exec);
                return Err(no_unit(file, &alone.unwrap_or_default()));
            }
        }
    }
    Ok(halves)
}

/// Whether a single file holds both halves, and further bodies.
pub(super) fn are_more_than_two(parts: &[PartFile; 2], settings: &ProposalSettings, exec: &Exec) -> bool {
    let [one, other] = parts;
    let third = PartFile { body: Some(3), ..one.clone() };
    let is_one_file = one.written == other.written && one.body.is_some();
    is_one_file && of_half(&mesh(&third, settings), HalfRole::Fixed, exec).is_ok()
}

/// Errors that both files share are reported only for the first.
fn without_duplicates(mut diagnostics: Diagnostics) -> Diagnostics {
    let mut stated = HashSet::new();
    diagnostics.list.retain(|diagnostic| {
        let reason =
            diagnostic.message.split_once(": ").map_or(diagnostic.message.as_str(), |(_, reason)| reason);
        stated.insert(reason.to_owned())
    });
    diagnostics
}

fn no_unit(part: &PartFile, half: &Half) -> ProposalError {
    let (low, high) = half.bounds();
    let size = high - low;
    ProposalError::NoUnit { path: part.path.clone(), size: size.to_array(), guess: guess(size) }
}

/// The halves, with lengths in the unit of the design: a file, or, if more belongs to one of them, the parts
/// of a design.
fn specs(
    parts: &[PartFile; 2],
    settings: &ProposalSettings,
    place: &Path,
) -> Result<[HalfSpec; 2], ProposalError> {
    let files = parts.each_ref().map(|part| mesh(part, settings));
    if settings.with.iter().all(Vec::is_empty) {
        return Ok(files);
    }
    let draft = Draft::read_roughly(SourceText::new(place, file::halves(parts, settings)))?;
    match draft.design().connector.clone() {
        ConnectorSpec::Own(own) => Ok([own.fixed, own.moving]),
        ConnectorSpec::Family(_) => Ok(files),
    }
}

/// A file as a half.
fn mesh(part: &PartFile, settings: &ProposalSettings) -> HalfSpec {
    let unit = design_unit(settings).metres();
    let scale = file_unit(settings).metres() / unit;
    let mut spec = FileSpec::new(&part.path, scale);
    if may_state_unit(&part.path) {
        (spec.unit, spec.scale) = (FileUnit::InFile, 1.0 / unit);
    }
    spec.treatment.body = part.body;
    spec.treatment.simplify = settings.simplify.map(|most| scale * most);
    HalfSpec::Mesh(spec)
}

/// The unit of files that do not state a unit.
pub(super) fn file_unit(settings: &ProposalSettings) -> LengthUnit {
    settings.unit.unwrap_or(LengthUnit::Mm)
}

/// The unit of the design, used in results: millimetres if files are in metres, unless parts are written in
/// the unit of the files beside them.
pub(super) fn design_unit(settings: &ProposalSettings) -> LengthUnit {
    let unit = file_unit(settings);
    let has_parts = settings.with.iter().flatten().any(|beside| matches!(beside, PartDetail::Part(_)));
    if has_parts { unit } else { shown_unit(unit) }
}

/// Whether a file states its unit.
pub(super) fn may_state_unit(path: &Path) -> bool {
    FileSpec::new(path, 1.0).may_state_unit()
}

/// The unit in which a part of this size is between a pea and a door, if it is a common unit.
fn guess(size: DVec3) -> LengthUnit {
    match size.max_element() {
        most if most < 1.0 => LengthUnit::M,
        most if most < 4.0 => LengthUnit::In,
        most if most < 5e3 => LengthUnit::Mm,
        _ => LengthUnit::Um,
    }
}
