//! The title of a design after changes to its parameters: the name in its file, with the current values.
//!
//! ```text
//!   name in the file          replaced               title
//!   V-Face, AR 1, COR 0       --aspect-ratio 0.5     V-Face, AR 0.5, COR 0
//!   my dock                   --cor "5 mm"           my dock, COR 5 mm
//!   V-Face, AR 1, COR 0       --over aspect_ratio    V-Face, COR 0
//! ```
//!
//! A name is free text. A comma-separated part is recognised if it contains a word of a [`Parameter`] before
//! a number. Values that a name states in other words remain unchanged.

use super::Design;

/// A parameter that options replace and that names state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DesignParameter {
    /// H/D.
    AspectRatio,
    /// The centre of rotation.
    CenterOfRotation,
    /// ρ.
    RotationLength,
}

impl DesignParameter {
    /// Every parameter, with its key in the design file.
    const KEYS: [(Self, &'static str); 3] = [
        (Self::AspectRatio, "connector.aspect_ratio"),
        (Self::CenterOfRotation, "alignment.center_of_rotation"),
        (Self::RotationLength, "alignment.rotation_length"),
    ];

    /// The parameter of a key such as `connector.aspect_ratio`.
    pub fn of_key(key: &str) -> Option<Self> {
        Self::KEYS.into_iter().find(|(_, known)| *known == key).map(|(parameter, _)| parameter)
    }

    /// The words that state it in a name, the symbol of titles first.
    const fn words(self) -> &'static [&'static str] {
        match self {
            Self::AspectRatio => &["AR", "H/D", "aspect ratio", "slope"],
            Self::CenterOfRotation => &["COR", "centre of rotation", "center of rotation"],
            Self::RotationLength => &["ρ", "rho", "rotation length"],
        }
    }

    /// The words before and after a value in a part of a name that states this parameter.
    fn stated(self, part: &str) -> Option<(&str, &str)> {
        self.words().iter().find_map(|word| {
            let (start, _) = part.match_indices(word).find(|(start, _)| {
                let ends_word = |c: char| !c.is_alphanumeric();
                part[..*start].chars().next_back().is_none_or(ends_word)
            })?;
            let value = part[start + word.len()..].trim_start_matches([' ', '=']);
            let rest = after_value(value)?;
            Some((part[..start].trim_end(), rest))
        })
    }
}

/// The text after a value such as `1/2`, `−½`, `tan 30°` or `5 mm`; `None` if the text does not begin with a
/// value.
fn after_value(text: &str) -> Option<&str> {
    const UNITS: [&str; 8] = ["um", "mm", "cm", "m", "in", "D", "deg", "°"];
    const SIGNS: [char; 3] = ['-', '−', '+'];
    const FRACTIONS: [char; 5] = ['½', '¼', '¾', '⅓', '⅔'];
    let number = text.strip_prefix("tan ").unwrap_or(text);
    let digits = number.trim_start_matches(SIGNS);
    if !digits.starts_with(|c: char| c.is_ascii_digit() || c == '.' || FRACTIONS.contains(&c)) {
        return None;
    }
    let word = |text: &'_ str| text.find(' ').unwrap_or(text.len());
    let rest = number[word(number)..].trim_start();
    let unit = &rest[..word(rest)];
    Some(if UNITS.contains(&unit) { rest[unit.len()..].trim_start() } else { rest })
}

impl Design {
    /// The design with a title that states `value` of a parameter, in place of the old statement in its name.
    #[must_use]
    pub fn titled(mut self, parameter: DesignParameter, value: &str) -> Self {
        let now = format!("{} {value}", parameter.words()[0]);
        let mut is_stated = false;
        self.rename(|part| match parameter.stated(part) {
            Some((before, after)) => {
                is_stated = true;
                joined([before, &now, after])
            }
            None => part.to_owned(),
        });
        if !is_stated {
            self.name = format!("{}, {now}", self.name);
        }
        self
    }

    /// The design with a title without a value of a parameter, for computations of many values.
    #[must_use]
    pub fn untitled(mut self, parameter: DesignParameter) -> Self {
        self.rename(|part| match parameter.stated(part) {
            Some((before, after)) => joined([before, "", after]),
            None => part.to_owned(),
        });
        self
    }

    /// Rewrites every part of the name; a name of which nothing would be left stays.
    fn rename(&mut self, rewrite: impl FnMut(&str) -> String) {
        let parts: Vec<String> =
            self.name.split(", ").map(rewrite).filter(|part| !part.trim().is_empty()).collect();
        if !parts.is_empty() {
            self.name = parts.join(", ");
        }
    }
}

/// Words separated by single spaces.
fn joined(words: [&str; 3]) -> String {
    words.into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::super::{Design, Quantity, read};
    use super::DesignParameter;

    fn named(name: &str) -> Design {
        let text = format!(
            "name = \"{name}\"\n[connector]\nfamily = \"v-face\"\naspect_ratio = 1\nwidth = 50\nunit = \"mm\"\n"
        );
        read(&text, ".".as_ref()).unwrap().design
    }

    fn cor(text: &str) -> Quantity {
        text.parse().unwrap()
    }

    /// The title named the values of the file, `V-Face, AR 1, COR 0`, over results of the options.
    #[test]
    fn a_title_states_the_values_in_force() {
        let changed = |name: &str| {
            let design = named(name).with_aspect_ratio(0.5).unwrap();
            design.with_center_of_rotation(cor("-5 mm")).unwrap().name
        };
        assert_eq!(changed("V-Face, AR 1, COR 0"), "V-Face, AR 0.5, COR -5 mm");
        assert_eq!(changed("V-Face, slope 30 deg, COR −½"), "V-Face, AR 0.5, COR -5 mm");
        assert_eq!(changed("V-Face"), "V-Face, AR 0.5, COR -5 mm");
        assert_eq!(changed("AR = 1 mark 2, COR 1/2"), "AR 0.5 mark 2, COR -5 mm");
        assert_eq!(changed("CAR 54"), "CAR 54, AR 0.5, COR -5 mm");
    }

    #[test]
    fn an_option_without_effect_keeps_the_name() {
        let name = "V-Face, AR 1, COR 0";
        let same = named(name).with_aspect_ratio(1.0).unwrap();
        assert_eq!(same.with_center_of_rotation(cor("0")).unwrap().name, name);
    }

    #[test]
    fn swept_parameters_are_not_in_the_title() {
        let title = |name: &str| {
            let design = named(name).untitled(DesignParameter::AspectRatio);
            design.untitled(DesignParameter::CenterOfRotation).name
        };
        assert_eq!(title("V-Face, AR 1, COR 0"), "V-Face");
        assert_eq!(title("AR tan 30°"), "AR tan 30°");
        assert_eq!(title("V-Face"), "V-Face");
    }
}
