//! Design files of published geometries.

/// A design file with its description.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DesignText {
    /// Its name on the command line.
    pub name: &'static str,
    /// Description.
    pub summary: &'static str,
    /// The file.
    pub text: &'static str,
}

/// Every design that is written.
pub const DESIGNS: [DesignText; 3] = [
    DesignText {
        name: "cone",
        summary: "probe and drogue around a face of 50 mm, as amour's published area takes it",
        text: include_str!("../../data/cone.toml"),
    },
    DesignText {
        name: "x-face-3d",
        summary: "the 3-D X-Face on a face of 50 mm, slope 30 degrees",
        text: include_str!("../../data/x-face-3d.toml"),
    },
    DesignText {
        name: "polybot",
        summary: "four pins and four holes on a face of 50 mm, as PolyBot's published area takes them",
        text: include_str!("../../data/polybot.toml"),
    },
];

impl DesignText {
    /// The design of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        DESIGNS.iter().find(|design| design.name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment::design::SourceText;
    use catchment::problem::Draft;

    #[test]
    fn every_design_is_a_problem_to_decide() {
        for design in DESIGNS {
            let source = SourceText::new(format!("{}.toml", design.name), design.text);
            let problem =
                Draft::read(source).and_then(Draft::build).unwrap_or_else(|e| panic!("{}: {e}", design.name));
            let ungendered = problem.connector().ungendered(problem.alignment().mount);
            assert_eq!(ungendered, design.name != "cone", "{}", design.name);
        }
        assert!(DesignText::named("cone").is_some() && DesignText::named("dragon").is_none());
    }

    /// The committed example equals the design that the command writes.
    #[test]
    fn the_committed_example_is_the_design_that_is_written() {
        let path =
            std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs/systems/polybot.toml");
        assert_eq!(std::fs::read_to_string(path).unwrap(), DesignText::named("polybot").unwrap().text);
    }
}
