//! Interpretation of the column names of a table.
//!
//! ```text
//!   x   x_mm   x [mm]   x (mm)     an error, in D and radians or in the named unit
//!   part   time   id               not an error: carried through
//!   dx   X_mm   x mm   rol         nearly an error: rejected, because carrying it through would make the error 0
//! ```
//!
//! A name is *near* an error if one of its words is the error's. Words end at non-letters, between letters
//! and digits, and before capitals (`deltaX`). A word is also the error's in the forms rx, ry, rz, tx or ty,
//! and with a decoration attached: d, delta, err, offset or pos before or behind, a unit behind (`dx`,
//! `xerr`, `xpos`, `xmm`). A word for a rotation with an axis beside or attached to it is an angle
//! (`theta_z`, `rotx`). A name with a single word besides decorations and units is also near if one typing
//! error turns that word into roll, pitch or yaw (`rol`).
//!
//! A name is read by its appearance: `х` with the Cyrillic letter is near an error as `x` would be, and the
//! message shows the character.
//!
//! Names with control characters, or with invisible characters (a byte order mark), are always rejected.

use super::{defect, is_hidden, shortened};
use crate::design::{Design, LengthUnit, QuantityUnit, nearest};
use catchment_base::diagnostic::Diagnostic;
use catchment_base::pose::Dof;
use catchment_base::suggest::{as_it_looks, odd};

/// Units that a column's name may give.
const UNITS: [(&str, QuantityUnit); 8] = [
    ("um", QuantityUnit::Length(LengthUnit::Um)),
    ("mm", QuantityUnit::Length(LengthUnit::Mm)),
    ("cm", QuantityUnit::Length(LengthUnit::Cm)),
    ("m", QuantityUnit::Length(LengthUnit::M)),
    ("in", QuantityUnit::Length(LengthUnit::In)),
    ("D", QuantityUnit::D),
    ("deg", QuantityUnit::Degrees),
    ("rad", QuantityUnit::Radians),
];
/// Common additions to the name of an error.
const DECORATIONS: [&str; 12] =
    ["d", "delta", "δ", "e", "err", "error", "off", "offset", "misalignment", "pos", "position", "shift"];
/// Common words for a rotation, used with its axis.
const TURNS: [&str; 6] = ["theta", "θ", "rot", "rotation", "ang", "angle"];
/// The axes of rotations, and their errors.
const ABOUT: [(&str, Dof); 3] = [("x", Dof::Roll), ("y", Dof::Pitch), ("z", Dof::Yaw)];
/// Other names of the errors, in the order of [`Dof::ALL`].
const SYNONYMS: [&str; 5] = ["tx", "ty", "rx", "ry", "rz"];
/// Columns that the answer adds, beside the final errors.
const ADDED: [&str; 3] = ["outcome", "final_height", "contacts"];
/// Longest name of a column, in bytes: it is repeated with every row of some answers.
const LONGEST_NAME: usize = 200;

/// The error and the unit of a column; `None` for a column that is passed through.
pub(super) fn column(name: &str, design: &Design) -> Result<Option<(Dof, QuantityUnit)>, Diagnostic> {
    if name.contains(is_hidden) {
        let message = format!("`{}` has a character that does not show", shortened(name));
        return Err(defect(
            message,
            "type the name anew; line breaks and byte order marks do not belong here",
        ));
    }
    if name.len() > LONGEST_NAME {
        let message = format!("`{}…` is a name of {} bytes", shortened(name), name.len());
        return Err(defect(message, format!("the name of a column has at most {LONGEST_NAME}")));
    }
    if ADDED.contains(&name) || name.strip_prefix("final_").is_some_and(|rest| split(rest).is_some()) {
        return Err(defect(format!("`{name}` is a column that the answer adds"), "rename it"));
    }
    let Some((dof, symbol)) = split(name) else {
        let looks = as_it_looks(name);
        let meant = near(name).or_else(|| {
            let is_other = looks != name;
            is_other.then(|| split(&looks).map_or_else(|| near(&looks), |_| Some(looks.clone()))).flatten()
        });
        return meant.map_or(Ok(None), |meant| {
            let help = format!("did you mean {meant}? A column to be carried through needs another name");
            Err(defect(format!("`{}` is no pose error{}", shortened(name), odd(name)), help))
        });
    };
    let base = dof.name();
    let Some(symbol) = symbol else { return Ok(Some((dof, QuantityUnit::Bare))) };
    match UNITS.iter().find(|(known, _)| *known == symbol).map(|(_, unit)| *unit) {
        Some(unit @ (QuantityUnit::Degrees | QuantityUnit::Radians)) if dof.is_rotation() => {
            Ok(Some((dof, unit)))
        }
        Some(QuantityUnit::D) if !dof.is_rotation() => Ok(Some((dof, QuantityUnit::D))),
        Some(unit @ QuantityUnit::Length(_)) if !dof.is_rotation() => {
            if design.unit.is_some() {
                return Ok(Some((dof, unit)));
            }
            let help = format!(
                "name the column {base} and give it in D, or give the design a unit (connector.unit)"
            );
            Err(defect(format!("{name}: the design has no unit of length"), help))
        }
        Some(_) if dof.is_rotation() => {
            Err(defect(format!("{name}: {base} is an angle"), format!("{base}_deg or {base}_rad")))
        }
        Some(_) => Err(defect(format!("{name}: {base} is a length"), format!("{base} (in D), {base}_mm, …"))),
        None => {
            let units = UNITS.map(|(symbol, _)| symbol);
            let known = format!("units are {}", units.join(", "));
            let help = nearest(symbol, units).map_or(known, |meant| format!("did you mean {base}_{meant}?"));
            Err(defect(format!("`{}`: unknown unit{}", shortened(name), odd(symbol)), help))
        }
    }
}

/// The error that a name states in one of the known forms, and the text in place of its unit.
fn split(name: &str) -> Option<(Dof, Option<&str>)> {
    let named = |name: &str| Dof::ALL.into_iter().find(|dof| dof.name() == name);
    if let Some(dof) = named(name) {
        return Some((dof, None));
    }
    let bracketed = |open, close| {
        let (base, unit) = name.strip_suffix(close)?.split_once(open)?;
        Some((base.trim_end(), unit.trim()))
    };
    let (base, unit) =
        bracketed('[', ']').or_else(|| bracketed('(', ')')).or_else(|| name.rsplit_once('_'))?;
    Some((named(base)?, Some(unit)))
}

/// The name that was probably meant, if this name is near an error.
fn near(name: &str) -> Option<String> {
    let words = words(name);
    let unit = |word: &str| UNITS.iter().find(|(symbol, _)| symbol.eq_ignore_ascii_case(word));
    let fitting = |dof: Dof, word: &str| {
        unit(word).filter(|(_, unit)| {
            matches!(unit, QuantityUnit::Degrees | QuantityUnit::Radians) == dof.is_rotation()
        })
    };
    let turned = turn_in(&words).map(|dof| (dof, ""));
    let (dof, glued) = turned.or_else(|| words.iter().find_map(|word| error_in(word))).or_else(|| {
        let mut own = words.iter().filter(|w| unit(w).is_none() && !DECORATIONS.contains(&w.as_str()));
        let (word, None) = (own.next()?, own.next()) else { return None };
        let meant = nearest(word, ["roll", "pitch", "yaw"])?;
        Some((Dof::ALL.into_iter().find(|dof| dof.name() == meant)?, ""))
    })?;
    let symbol = std::iter::once(glued).chain(words.iter().map(String::as_str)).find_map(|w| fitting(dof, w));
    let base = dof.name();
    Some(symbol.map_or_else(|| base.to_owned(), |(symbol, _)| format!("{base}_{symbol}")))
}

/// The angle described by words for a rotation and its axis.
fn turn_in(words: &[String]) -> Option<Dof> {
    let about = |word: &str| ABOUT.iter().find(|(axis, _)| *axis == word).map(|(_, dof)| *dof);
    let is_turn = |word: &str| {
        let turn = |word: &str| TURNS.contains(&word);
        turn(word) || DECORATIONS.iter().any(|d| word.strip_prefix(d).is_some_and(turn))
    };
    let glued = |word: &String| {
        TURNS.iter().find_map(|turn| about(word.strip_prefix(turn).or_else(|| word.strip_suffix(turn))?))
    };
    words.iter().find_map(glued).or_else(|| {
        words.iter().any(|word| is_turn(word)).then(|| words.iter().find_map(|word| about(word))).flatten()
    })
}

/// The words of a name in small letters.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before = ' ';
    for c in name.chars() {
        let meets = before.is_alphabetic() != c.is_alphabetic() || before.is_lowercase() && c.is_uppercase();
        if meets {
            words.push(String::new());
        }
        if c.is_alphanumeric()
            && let Some(word) = words.last_mut()
        {
            word.extend(c.to_lowercase());
        }
        before = c;
    }
    words.retain(|word| !word.is_empty());
    words
}

/// The error named by a word, and the text attached to it.
fn error_in(word: &str) -> Option<(Dof, &str)> {
    if let Some(k) = SYNONYMS.iter().position(|synonym| *synonym == word) {
        return Some((Dof::ALL[k], ""));
    }
    let starts = std::iter::once(word).chain(DECORATIONS.iter().filter_map(|d| word.strip_prefix(d)));
    let known = |tail: &str| {
        tail.is_empty()
            || DECORATIONS.contains(&tail)
            || UNITS.iter().any(|(symbol, _)| symbol.eq_ignore_ascii_case(tail))
    };
    starts.into_iter().find_map(|rest| {
        let after = |dof: Dof| Some((dof, rest.strip_prefix(dof.name())?)).filter(|(_, tail)| known(tail));
        Dof::ALL.into_iter().find_map(after)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn read(name: &str) -> Result<Option<(Dof, QuantityUnit)>, Diagnostic> {
        let text = "[connector]\nfamily = \"pyramid\"\nwidth = 50\nunit = \"mm\"\n";
        column(name, &crate::design::read(text, Path::new("")).unwrap().design)
    }

    #[test]
    fn plain_forms_are_read() {
        let mm = QuantityUnit::Length(LengthUnit::Mm);
        for name in ["x_mm", "x [mm]", "x (mm)", "x[mm]", "x  ( mm )"] {
            assert_eq!(read(name), Ok(Some((Dof::X, mm))), "{name}");
        }
        assert_eq!(read("pitch (deg)"), Ok(Some((Dof::Pitch, QuantityUnit::Degrees))));
        assert_eq!(read("y [D]"), Ok(Some((Dof::Y, QuantityUnit::D))));
        assert_eq!(read("yaw"), Ok(Some((Dof::Yaw, QuantityUnit::Bare))));
    }

    #[test]
    fn near_names_are_refused_with_a_suggestion() {
        for (name, meant) in [
            ("x mm", "x_mm"),
            ("x.mm", "x_mm"),
            ("X_mm", "x_mm"),
            ("xmm", "x_mm"),
            ("x_a_mm", "x_mm"),
            ("dx", "x"),
            ("dx_mm", "x_mm"),
            ("delta_x", "x"),
            ("deltaX", "x"),
            ("Δx [mm]", "x_mm"),
            ("xerr", "x"),
            ("x1", "x"),
            ("robot y", "y"),
            ("ty", "y"),
            ("rz", "yaw"),
            ("rol", "roll"),
            ("rol_deg", "roll_deg"),
            ("Pitch (deg)", "pitch_deg"),
            ("PITCH", "pitch"),
            ("yawdeg", "yaw_deg"),
            ("d_ptich", "pitch"),
            ("xpos", "x"),
            ("pos_x", "x"),
            ("posX [mm]", "x_mm"),
            ("position y", "y"),
            ("yposition", "y"),
            ("x shift", "x"),
            ("theta_z", "yaw"),
            ("theta_x", "roll"),
            ("dtheta_y", "pitch"),
            ("θz", "yaw"),
            ("rot_z", "yaw"),
            ("rotz", "yaw"),
            ("zrot", "yaw"),
            ("rotation_y_deg", "pitch_deg"),
            ("angle x (rad)", "roll_rad"),
            ("roll angle", "roll"),
            ("RotX", "roll"),
        ] {
            let fault = read(name).expect_err(name);
            let help = format!("did you mean {meant}? A column to be carried through needs another name");
            assert_eq!(fault.help().as_deref(), Some(help.as_str()), "{name}");
        }
        for (name, stated) in
            [("x_ft", "unknown unit"), ("x [ft]", "unknown unit"), ("x (deg)", "is a length")]
        {
            assert!(read(name).unwrap_err().message.contains(stated), "{name}");
        }
        for name in ["outcome", "final_height", "contacts", "final_x", "final_x [mm]", "final_yaw_deg"] {
            assert!(read(name).unwrap_err().message.contains("the answer adds"), "{name}");
        }
    }

    /// The first of each is a Cyrillic, Greek, wide or mathematical letter.
    #[test]
    fn lookalike_characters_are_refused_and_named() {
        for (name, code, meant) in [
            ("х", "U+0445", "x"),
            ("у_mm", "U+0443", "y_mm"),
            ("χ [mm]", "U+03C7", "x [mm]"),
            ("ｘ_mm", "U+FF58", "x_mm"),
            ("𝑦aw", "U+1D466", "yaw"),
            ("уaw_dеg", "U+0443", "yaw_deg"),
            ("dх", "U+0445", "x"),
        ] {
            let fault = read(name).expect_err(name);
            assert!(fault.message.contains(code), "{}", fault.message);
            assert!(fault.help().unwrap().starts_with(&format!("did you mean {meant}?")), "{name}");
        }
        assert!(read("x_mм").unwrap_err().message.contains("U+043C"));
    }

    #[test]
    fn hidden_characters_are_refused_and_not_repeated() {
        for name in ["\u{feff}x", "x\0", "pa\0rt", "\x1b[2J", "note\nmore", "x\u{200b}", "\u{202e}x"] {
            let fault = read(name).expect_err(name);
            assert!(!fault.message.contains(is_hidden), "{name:?}");
        }
        assert!(read(&"part".repeat(100)).is_err());
    }

    #[test]
    fn other_names_are_carried_through() {
        for name in [
            "part",
            "time",
            "index",
            "max",
            "id",
            "result",
            "success",
            "min",
            "date",
            "robot",
            "trial no.",
            "comment",
            "force [N]",
            "operator",
            "type",
            "day",
            "temp_in",
            "",
            "Prüfer",
            "деталь",
            "угол",
            "α",
            "γ",
            "tray",
            "proxy",
            "matrix",
            "exit",
            "position",
            "angle",
            "rotor",
            "z_mm",
            "pos_z",
            "angle of the camera",
        ] {
            assert_eq!(read(name), Ok(None), "{name}");
        }
    }
}
