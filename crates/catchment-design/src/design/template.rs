//! Commented starting points for `catchment new`.

use super::family::{Freedom, Value, XFace};
use super::keys::{self, Applies, DesignTable, Key, ValueKind};
use super::{Alignment, Docked, Family, FamilySpec};
use catchment_base::pose::{Dof, DofSet, Mount};
use std::fmt::Write;

/// A design file of this family with every key that it may have: the comments show the defaults.
pub fn template(family: Family) -> String {
    let mut text = String::from(
        "#:schema schema.json\n\
         # A docking connector. Bare numbers are in D (the width) and radians; strings carry a unit: \"5 mm\",\n\
         # \"30 deg\". The first line is for editors; `catchment schema -o schema.json` writes the file it names.\n\n",
    );
    for table in [
        DesignTable::Root,
        DesignTable::Connector,
        DesignTable::Alignment,
        DesignTable::Errors,
        DesignTable::Docked,
    ] {
        if table != DesignTable::Root {
            let _ = writeln!(text, "\n{}", table.name());
        }
        for key in table.keys().filter(|key| key.applies.to(Some(family))) {
            let Some(value) = default_text(key, family) else { continue };
            let active = is_active(key, family);
            for line in wrapped(key.doc) {
                let _ = writeln!(text, "# {line}");
            }
            let mark = if active { "" } else { "# " };
            let _ = writeln!(text, "{mark}{} = {value}", key.name);
        }
    }
    text
}

/// Keys that a new user is likely to change first, and those with the largest effect on the result.
fn is_active(key: &Key, family: Family) -> bool {
    let free = Alignment::default_for(Some(family)).free;
    match key.table {
        DesignTable::Root => true,
        DesignTable::Connector => {
            [keys::FAMILY, keys::WIDTH, keys::ASPECT_RATIO].contains(key)
                || (matches!(key.applies, Applies::Families(_)) && FamilySpec::new(family).get(key).is_some())
        }
        DesignTable::Alignment => {
            [keys::FREE, keys::CENTER_OF_ROTATION, keys::ROTATION_LENGTH].contains(key)
                || (*key == keys::DONT_CARE && family.freedom() == Freedom::Round)
        }
        DesignTable::Errors => free.iter().any(|dof| keys::ERROR_KEYS[dof.index()] == *key),
        DesignTable::Half
        | DesignTable::Docked
        | DesignTable::Part
        | DesignTable::Sphere
        | DesignTable::Cylinder
        | DesignTable::Cone => false,
    }
}

/// The default of a key as TOML; `None` for tables, and for keys of own halves.
fn default_text(key: &Key, family: Family) -> Option<String> {
    let spec = FamilySpec::new(family);
    let alignment = Alignment::default_for(Some(family));
    let number = |value: f64| Some(format!("{value:?}"));
    match *key {
        keys::SCHEMA_KEY => Some(keys::SCHEMA.to_string()),
        keys::NAME | keys::FAMILY => Some(format!("\"{}\"", family.name())),
        keys::WIDTH => number(1.0),
        keys::UNIT => Some("\"mm\"".to_owned()),
        keys::BASE_THICKNESS => number(0.25),
        keys::LAYER_THICKNESS => number(XFace::DEFAULT_LAYER_THICKNESS),
        keys::LAYER_GAP => number(XFace::DEFAULT_LAYER_GAP),
        keys::FREE => Some(list(alignment.free)),
        keys::DONT_CARE => Some(list(alignment.dont_care)),
        keys::CENTER_OF_ROTATION => number(alignment.center_of_rotation),
        keys::ROTATION_LENGTH => number(alignment.rotation_length),
        keys::MOUNT => Some(if alignment.mount == Mount::X { "\"x\"" } else { "\"y\"" }.to_owned()),
        keys::SYMMETRY => Some(alignment.symmetry.to_string()),
        _ if key.table == DesignTable::Errors => {
            let dof = key.name.parse::<Dof>().ok()?;
            let value = alignment.half_ranges[dof.index()];
            if matches!(key.kind, ValueKind::Angle(_)) { Some(degrees(value)) } else { number(value) }
        }
        keys::DOCKED_DEPTH => number(alignment.docked.depth),
        _ if key.table == DesignTable::Docked => {
            let [length, angle] = Docked::MOST_PLAY;
            if matches!(key.kind, ValueKind::Angle(_)) { Some(degrees(angle)) } else { number(length) }
        }
        _ => match spec.get(key)? {
            Value::Number(value) if matches!(key.kind, ValueKind::Angle(_)) => Some(degrees(value)),
            Value::Number(value) => number(value),
            Value::Whole(value) => Some(value.to_string()),
            Value::Flag(value) => Some(value.to_string()),
        },
    }
}

fn degrees(radians: f64) -> String {
    format!("\"{} deg\"", radians.to_degrees())
}

fn list(set: DofSet) -> String {
    let names: Vec<String> = set.iter().map(|dof| format!("\"{}\"", dof.name())).collect();
    format!("[{}]", names.join(", "))
}

/// Lines of at most 100 characters.
fn wrapped(text: &str) -> Vec<String> {
    const WIDTH: usize = 100;
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.len() + 1 + word.len() <= WIDTH => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{ConnectorSpec, read};
    use std::path::Path;

    #[test]
    fn every_template_reads_back_as_the_defaults_of_its_family() {
        for family in Family::ALL {
            let text = template(family);
            let design = match read(&text, Path::new("")) {
                Ok(file) => file.design,
                Err(problems) => panic!("{}:\n{problems}\n{text}", family.name()),
            };
            assert_eq!(design.connector, ConnectorSpec::Family(FamilySpec::new(family)));
            assert_eq!(design.alignment, Alignment::default_for(Some(family)));
        }
    }

    /// The values in comments are the defaults: writing them out changes nothing except the unit, the base
    /// thickness and the limits of [docked], which have no default value.
    #[test]
    fn commented_out_defaults_are_the_defaults() {
        // For these keys, being set has a meaning of its own.
        const OTHERS: [&str; 4] = ["unit", "base_thickness", "layer_thickness", "layer_gap"];
        for family in Family::ALL {
            let text = template(family);
            let text = text.split("\n[docked]").next().unwrap();
            let key_line = |line: &str| {
                let (name, _) = line.strip_prefix("# ")?.split_once(" = ")?;
                let is_key = keys::KEYS.iter().any(|key| key.name == name);
                (is_key && !OTHERS.contains(&name)).then(|| line[2..].to_owned())
            };
            let lines: Vec<String> =
                text.lines().map(|line| key_line(line).unwrap_or_else(|| line.to_owned())).collect();
            assert_ne!(lines.join("\n"), text.trim_end());
            let written_out = read(&lines.join("\n"), Path::new("")).unwrap().design;
            assert_eq!(written_out, read(text, Path::new("")).unwrap().design, "{}", family.name());
        }
    }
}
