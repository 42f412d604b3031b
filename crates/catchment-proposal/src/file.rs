//! The design file of a proposal: the meaning of every line, and the reason for its value.

use super::halves::{design_unit, file_unit, may_state_unit};
use super::layout::PartLayout;
use super::seat_check::{Seat, SeatCandidate};
use super::{PartDetail, PartFile, ProposalSettings, error_box};
use catchment_core::design::{FileSpec, LengthUnit};
use catchment_core::pose::{Dof, DofSet, Mount};
use glam::DVec2;
use std::fmt::Write;
use std::path::Path;

/// Rounding of lengths, in D: rests are known to 1e-7.
const ROUNDED: f64 = 1e-8;

/// A number rounded to a step that is a power of ten, below `about`.
pub(super) fn number(value: f64, about: f64) -> String {
    let digits = (-about.log10()).ceil().clamp(0.0, 15.0) as usize;
    let text = format!("{value:.digits$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// A string of TOML.
fn quoted(text: &str) -> String {
    let escaped = text.chars().fold(String::new(), |mut text, c| {
        match c {
            '"' | '\\' => text.extend(['\\', c]),
            _ if c.is_control() => {
                let _ = write!(text, "\\u{:04x}", u32::from(c));
            }
            _ => text.push(c),
        }
        text
    });
    format!("\"{escaped}\"")
}

fn list(set: DofSet) -> String {
    let names: Vec<String> = set.iter().map(|dof| format!("\"{}\"", dof.name())).collect();
    format!("[{}]", names.join(", "))
}

fn stem(path: &Path) -> String {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Facets stand for curved faces in a STEP file.
const MESHED: &str =
    "# Facets stand for its curved faces, off by 0.0002 of its size; closer with deflection = \"0.01 mm\".";

/// The keys that name a file, and the unit of a file that does not state it.
fn named(part: &PartFile, unit: LengthUnit) -> (String, Option<String>) {
    let stated = (!may_state_unit(&part.path)).then(|| format!("unit = \"{}\"", unit.symbol()));
    (format!("mesh = {}", quoted(&part.written)), stated)
}

/// An element of a list of parts.
fn element(beside: &PartDetail, unit: LengthUnit) -> String {
    match beside {
        PartDetail::File(part) => {
            let (mesh, stated) = named(part, unit);
            format!("    {{ {} }},", std::iter::once(mesh).chain(stated).collect::<Vec<_>>().join(", "))
        }
        PartDetail::Part(text) => format!("    {text},"),
    }
}

/// Keys that define a half: its file, or a list of parts that begins with it.
fn drawn(part: &PartFile, with: &[PartDetail], settings: &ProposalSettings) -> Vec<String> {
    let unit = file_unit(settings);
    let is_step = FileSpec::new(&part.path, 1.0).is_step();
    let meshed = is_step.then(|| MESHED.to_owned());
    if with.is_empty() {
        let (mesh, stated) = named(part, unit);
        let body = part.body.map(|body| {
            format!("# Of the separate bodies in it this one, the largest first.\nbody = {body}")
        });
        let stated = stated.map(|unit| unit + " # the file itself states no unit");
        let fewer = settings.simplify.map(|most| {
            let most = quoted(&format!("{most} {}", unit.symbol()));
            format!("# Described with fewer triangles: its surface may move so far.\nsimplify = {most}")
        });
        return [Some(mesh), body, meshed, stated, fewer].into_iter().flatten().collect();
    }
    let open = "# The file, and what belongs to it, in its coordinates.\nparts = [".to_owned();
    let file = element(&PartDetail::File(part.clone()), unit);
    let more = with.iter().map(|one| element(one, unit));
    meshed.into_iter().chain([open, file]).chain(more).chain(["]".to_owned()]).collect()
}

/// A design with only the keys that define the halves.
pub(super) fn halves(parts: &[PartFile; 2], settings: &ProposalSettings) -> String {
    let unit = design_unit(settings);
    let mut text = format!("[connector]\nunit = \"{}\"\n", unit.symbol());
    for ((name, part), with) in ["fixed", "moving"].into_iter().zip(parts).zip(&settings.with) {
        let _ = writeln!(text, "\n[connector.{name}]\n{}", drawn(part, with, settings).join("\n"));
    }
    text
}

/// The design; lengths of `judged` times `scale` are in its unit, and errors are examined up to these shares
/// of 1 D and 90 degrees.
pub(super) fn text(
    parts: &[PartFile; 2],
    settings: &ProposalSettings,
    judged: &SeatCandidate,
    seat: Seat,
    scale: f64,
    ranges: &[f64; 5],
) -> String {
    let unit = design_unit(settings);
    let width = judged.width * scale;
    let length = |value: f64| number(value * scale, ROUNDED * width);
    let name = settings.name.clone().unwrap_or_else(|| {
        let [fixed, moving] = parts.each_ref().map(|part| stem(&part.path));
        let both = if parts[0].body.is_some() { fixed } else { format!("{moving} on {fixed}") };
        both.chars().take(catchment_core::design::keys::LONGEST_LINE).collect()
    });
    let mut text = String::new();
    let mut line = |words: &str| {
        let _ = writeln!(text, "{words}");
    };
    line(
        "# Two parts from CAD, and how they dock: a proposal by `catchment place`. `catchment check FILE -o pair.png` draws both halves,",
    );
    line(
        "# apart and mated. Lengths without a unit are in D (the width); those in [connector] and [connector.*] in the unit given there.",
    );
    line("schema = 1");
    line(&format!("name = {}", quoted(&name)));
    line("\n[connector]");
    line(if judged.is_widened {
        "# D, the width, by which lengths are scaled: as small as the parts allow; the facets that can touch are smaller."
    } else {
        "# D, the width, by which lengths are scaled: the larger lateral extent of the facets that can touch."
    });
    line(&format!("width = {}", decimal(number(width, ROUNDED * width))));
    line(&format!("unit = \"{}\"", unit.symbol()));
    if let PartLayout::Assembled { approach } = judged.lie {
        line(
            "# Both parts are drawn docked, in one frame; catchment moves them along the approach until they touch.",
        );
        line("drawn = \"assembled\"");
        line(
            "# The moving half approaches along this direction: nothing blocks it, and docked halves hold each other sideways.",
        );
        line(&format!("approach = {}", approach.written()));
    }
    if seat.settle.is_some() {
        line("# The drawn pose is not a rest: a nearby rest is taken as the mated pose.");
        line("settle = true");
    }
    let to_axis = [-judged.center, judged.offset - judged.center];
    for (k, name) in ["fixed", "moving"].into_iter().enumerate() {
        line(&format!("\n[connector.{name}]"));
        for words in drawn(&parts[k], &settings.with[k], settings) {
            line(&words);
        }
        if let PartLayout::Facing { fixed, moving, turned } = judged.lie {
            line("# The direction in which the mating face of this half looks, in its file.");
            line(&format!("facing = {}", [fixed, moving][k].written()));
            if k == 1 && turned > 0 {
                line("# Then turned about the approach axis until the features fit.");
                line(&format!("rotate = [0, 0, \"{} deg\"]", u32::from(turned) * 90));
            }
            // Facing +z the moving half is not mounted yet.
            let by = Mount::X.apply(to_axis[k].extend(0.0)).truncate();
            let DVec2 { x, y } = if k == 0 { to_axis[k] } else { by };
            let why = if k == 0 {
                "# Then moved: the approach axis stands in the middle of the facets that can touch."
            } else {
                "# Then moved to its deepest position, in the middle of its play."
            };
            line(why);
            line(&format!("translate = [{}, {}, 0]", length(x), length(y)));
        }
    }
    alignment(&mut line, seat, settings, unit);
    line("\n# The error box: pose errors are sampled from minus to plus these values.");
    if seat.free.iter().any(|dof| ranges[dof.index()] < 1.0) {
        line(
            "# About four times the single-axis limits (the largest value of an error that docks with all others 0).",
        );
    }
    line("[errors]");
    for dof in seat.free.iter() {
        let share = ranges[dof.index()];
        let range = if dof.is_rotation() {
            format!("\"{} deg\"", number(90.0 * share, 1e-6))
        } else {
            format!("{} # D", decimal(number(share, 1e-9)))
        };
        if error_box::is_least(share) {
            line("# The smallest range that is proposed: the limit may be less than a quarter of it.");
        }
        line(&format!("{} = {range}", dof.name()));
    }
    text
}

/// `[alignment]` and `[docked]`.
fn alignment(line: &mut impl FnMut(&str), seat: Seat, settings: &ProposalSettings, unit: LengthUnit) {
    line("\n[alignment]");
    let left: DofSet = Dof::ALL
        .into_iter()
        .filter(|dof| !seat.free.contains(*dof) && !seat.dont_care.contains(*dof))
        .collect();
    line(match (settings.free, left.is_empty()) {
        (Some(_), _) => "# Free errors, as you gave them; all others are locked at 0.",
        (None, true) => "# Free errors: the seat corrects each of them.",
        (None, false) => "# Free errors: those that the seat corrects; all others are locked at 0.",
    });
    line(&format!("free = {}", list(seat.free)));
    if !seat.dont_care.is_empty() {
        line("# Ignored: the half is seated at any angle.");
        line(&format!("dont_care = {}", list(seat.dont_care)));
    }
    if seat.symmetry > 1 && seat.free.contains(Dof::Yaw) {
        line(&format!(
            "# Turned by {} deg about the approach axis the halves mate as well. If that counts as docked:",
            number(360.0 / f64::from(seat.symmetry), 1e-3)
        ));
        line(&format!("# symmetry = {}", seat.symmetry));
    }
    line(
        "# Your mount decides: the point of the moving half where the mount pushes, from the face centre, positive towards the other half;",
    );
    line(&format!("# in D, or with a unit, such as \"5 {}\".", unit.symbol()));
    line("center_of_rotation = 0.0");
    line(
        "# Your mount decides: rho = sqrt(rotational / lateral damping of the mount); results depend on it.",
    );
    line("rotation_length = 0.5");
    let message = Dof::ALL.into_iter().filter_map(|dof| Some((dof, seat.play[dof.index()]?)));
    for (k, (dof, play)) in message.enumerate() {
        if k == 0 {
            line(
                "\n# The seat has this play; any pose in it counts as docked. Pins or plugs behind the face may need less.",
            );
            line("[docked]");
        }
        line(&if dof.is_rotation() {
            format!("{} = \"{} deg\"", dof.name(), number(play.to_degrees(), 1e-4))
        } else {
            format!("{} = {} # D", dof.name(), decimal(number(play, 1e-6)))
        });
    }
}

/// A number with a decimal point.
fn decimal(text: String) -> String {
    if text.contains('.') { text } else { text + ".0" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_long_as_they_must_be() {
        assert_eq!(number(50.000_000_000_1, 5e-7), "50");
        assert_eq!(number(-0.000_000_01, 1e-6), "0");
        assert_eq!(number(12.345_678_9, 1e-3), "12.346");
        assert_eq!(number(1200.0, 10.0), "1200");
        assert_eq!(quoted("a\"b\\c\n"), r#""a\"b\\c\u000a""#);
        assert_eq!(decimal(number(0.008, 1e-9)), "0.008");
    }
}
