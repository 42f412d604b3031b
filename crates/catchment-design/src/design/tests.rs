//! The design file as a user sees it: valid input, and the messages for invalid input.

use super::*;
use catchment_base::pose::{Dof, DofSet, Mount};
use std::f64::consts::FRAC_PI_6;
use std::path::Path;

fn design(text: &str) -> Design {
    match read(text, Path::new("")) {
        Ok(file) => file.design,
        Err(problems) => panic!("{problems}"),
    }
}

fn problems(text: &str) -> LocatedDefects {
    match read(text, Path::new("")) {
        Ok(file) => panic!("no problem found: {file:?}"),
        Err(problems) => problems,
    }
}

/// The only problem of a design.
fn problem(text: &str) -> LocatedDefect {
    let problems = problems(text);
    assert_eq!(problems.list.len(), 1, "{problems}");
    problems.list[0].clone()
}

fn set(dofs: &[Dof]) -> DofSet {
    dofs.iter().copied().collect()
}

#[test]
fn the_least_design_has_the_defaults_of_its_family() {
    for family in Family::ALL {
        let design = design(&format!("[connector]\nfamily = \"{}\"", family.name()));
        assert_eq!(design.name, family.name());
        assert_eq!((design.width, design.unit), (1.0, None));
        assert_eq!(design.connector, ConnectorSpec::Family(FamilySpec::new(family)));
        assert_eq!(design.alignment, Alignment::default_for(Some(family)));
    }
    assert_eq!(Alignment::default_for(Some(Family::VFace)).free, set(&[Dof::X, Dof::Pitch]));
    assert_eq!(Alignment::default_for(Some(Family::VFace)).mount, Mount::Y);
    assert_eq!(Alignment::default_for(Some(Family::Cone)).dont_care, set(&[Dof::Yaw]));
    assert_eq!(Alignment::default_for(Some(Family::Pyramid)).free, DofSet::ALL);
}

#[test]
fn units_become_d_and_radians() {
    let design = design(
        "[connector]\nfamily = \"pyramid\"\nwidth = \"5 cm\"\nunit = \"mm\"\nbase_thickness = \"10 mm\"\n\
         [alignment]\ncenter_of_rotation = \"-25 mm\"\nrotation_length = 0.25\n\
         [errors]\nx = \"1 in\"\ny = 0.4\nyaw = \"30 deg\"\nroll = 0.5",
    );
    // Each is a product of three numbers: within a few units in the last place.
    let near = |a: f64, b: f64| assert!((a - b).abs() <= 4.0 * f64::EPSILON * b.abs(), "{a} {b}");
    near(design.width, 50.0);
    let ConnectorSpec::Family(spec) = &design.connector else { panic!("a family") };
    near(spec.base_thickness().unwrap(), 0.2);
    near(design.alignment.center_of_rotation, -0.5);
    near(design.alignment.rotation_length, 0.25);
    near(design.alignment.half_ranges[0], 0.508);
    near(design.alignment.half_ranges[1], 0.4);
    near(design.alignment.half_ranges[2], 0.5);
    near(design.alignment.half_ranges[4], FRAC_PI_6);
}

const TETRAHEDRA: &str = "face_height = 5\nfixed.pieces = [[[0, 0, 0], [10, 0, 0], [0, \"1 cm\", 0], [0, 0, 10]]]\n\
                          moving = { pieces = [[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]] }\n";

#[test]
fn own_pieces_are_divided_by_the_width() {
    let design = design(&format!("[connector]\nwidth = 20\nunit = \"mm\"\n{TETRAHEDRA}"));
    let ConnectorSpec::Own(own) = &design.connector else { panic!("own halves") };
    assert_eq!(own.face_height, Some(0.25));
    let HalfSpec::Pieces(pieces) = &own.fixed else { panic!("pieces") };
    assert_eq!(pieces[0][1], [0.5, 0.0, 0.0]);
    assert!((pieces[0][2][1] - 0.5).abs() < 4.0 * f64::EPSILON);
    assert_eq!(design.alignment, Alignment::default_for(None));
}

#[test]
fn places_of_own_halves_are_known() {
    let text = format!("[connector]\nwidth = 20\nunit = \"mm\"\n{TETRAHEDRA}");
    let sources = read(&text, Path::new("")).unwrap().sources;
    let at = |place: &str| text[sources.span(place).unwrap()].to_owned();
    assert!(at("connector.fixed.pieces[0]").starts_with("[[0, 0, 0], [10,"));
    assert_eq!(at("connector.face_height"), "5");
    assert!(at("connector.moving.pieces[7]").starts_with("[[["));
    assert_eq!(at("alignment.free"), "");
}

#[test]
fn a_mesh_is_scaled_from_its_unit_to_d() {
    let folder = Path::new("no/such/folder");
    let read_here = |head: &str, unit: &str| {
        let half = format!("mesh = \"half.stl\"\n{unit}");
        let text = format!(
            "[connector]\nface_height = 0\n{head}\n[connector.fixed]\n{half}\n[connector.moving]\n{half}"
        );
        read(&text, folder)
    };
    let scale = |head: &str, unit: &str| match read_here(head, unit).unwrap().design.connector {
        ConnectorSpec::Own(OwnSpec {
            fixed: HalfSpec::Mesh(FileSpec { scale, path, content: None, .. }),
            ..
        }) => {
            assert_eq!(path, folder.join("half.stl"));
            scale
        }
        other => panic!("{other:?}"),
    };
    assert!((scale("width = 5\nunit = \"cm\"", "unit = \"mm\"") - 0.02).abs() < 1e-17);
    assert_eq!(scale("width = 4.0", ""), 0.25);
    let defect = |head, unit| read_here(head, unit).unwrap_err().list[0].defect.clone();
    assert!(matches!(defect("width = 5\nunit = \"cm\"", ""), DesignDefect::Missing { .. }));
    assert!(matches!(defect("", "unit = \"mm\""), DesignDefect::UnitInDimensionlessDesign { .. }));
}

#[test]
fn all_defects_are_reported_with_their_places() {
    let text = "schema = 2\n\
                [connector]\n\
                family = \"pyramide\"\n\
                widht = 1.0\n\
                aspect_ratio = -1\n\
                [alignment]\n\
                free = [\"x\", \"x\", \"pich\"]\n\
                symmetry = 0\n\
                [errors]\n\
                x = \"5 mm\"\n\
                yaw = \"400 deg\"\n\
                roll = 5 deg\n\
                z = true\n";
    let problems = problems(text);
    let got: Vec<(usize, usize, String)> =
        problems.list.iter().map(|p| (p.line, p.column, p.defect.to_string())).collect();
    let expected = [
        (1, 10, "this design has schema 2; this program reads schema 1"),
        (3, 10, "unknown family `pyramide`"),
        (4, 1, "unknown key `widht` in [connector]"),
        (5, 16, "`aspect_ratio` is -1, outside of 0.001 to 100"),
        (7, 14, "`x` is listed twice"),
        (7, 19, "unknown degree of freedom `pich`"),
        (8, 12, "`symmetry` is 0, outside of 1 to 360"),
        (10, 5, "`5 mm` has a unit, but the design is dimensionless"),
        (11, 7, "`yaw` is 400 deg, outside of more than 0 to 180 deg"),
        (12, 8, "string values must be quoted, expected literal string"),
        (13, 1, "unknown key `z` in [errors]"),
    ];
    assert_eq!(got, expected.map(|(line, column, text)| (line, column, text.to_owned())));
    let help = |index: usize| problems.list[index].defect.help().unwrap();
    assert!(help(1).starts_with("did you mean `pyramid`?"));
    assert_eq!(help(2), "did you mean `width`?");
    assert_eq!(help(5), "did you mean `pitch`? One of x, y, roll, pitch, yaw");
}

#[test]
fn each_rule_reports_its_defect() {
    let pyramid = |rest: &str| problem(&format!("[connector]\nfamily = \"pyramid\"\n{rest}")).defect;
    assert!(matches!(pyramid("pins = 3"), DesignDefect::NotAParameter { .. }));
    assert!(matches!(pyramid("face_height = 0.3"), DesignDefect::NotAParameter { .. }));
    assert!(matches!(pyramid("aspect_ratio = \"5 mm\""), DesignDefect::NotARatio { .. }));
    assert!(matches!(pyramid("aspect_ratio = true"), DesignDefect::WrongType { .. }));
    assert!(matches!(pyramid("aspect_ratio = nan"), DesignDefect::NotFinite { .. }));
    assert!(matches!(pyramid("aspect_ratio = 1e999"), DesignDefect::NotFinite { .. }));
    assert!(matches!(pyramid("width = \"1 D\""), DesignDefect::WidthInD));
    assert!(matches!(pyramid("width = 0"), DesignDefect::OutOfRange { .. }));
    assert!(matches!(pyramid("unit = \"mm\""), DesignDefect::Missing { .. }));
    assert!(matches!(
        pyramid("unit = \"furlong\"\nbase_thickness = \"3 mm\""),
        DesignDefect::UnknownName { .. }
    ));
    assert!(matches!(pyramid("base_thickness = \"3\""), DesignDefect::NoUnit { .. }));
    assert!(matches!(pyramid("base_thickness = \"3 deg\""), DesignDefect::WrongDimension { .. }));
    assert!(matches!(pyramid("center_of_rotation = 1"), DesignDefect::UnknownKey { elsewhere: Some(_), .. }));
    assert!(matches!(pyramid("[alignment]\nfree = []"), DesignDefect::Empty { .. }));
    assert!(matches!(
        pyramid("[alignment]\nfree = [\"yaw\"]\ndont_care = [\"yaw\"]"),
        DesignDefect::FreeAndDontCare { dof: Dof::Yaw }
    ));
    assert!(matches!(pyramid("[alignment]\ndont_care = [\"x\"]"), DesignDefect::DontCareTranslation { .. }));
    assert!(matches!(pyramid("[errors]\npitch = \"91 deg\""), DesignDefect::PitchBeyondPole));
    assert!(matches!(pyramid("[connector.fixed]"), DesignDefect::Contradiction { .. }));
    assert!(matches!(
        problem("errors = 3\n[connector]\nfamily = \"cone\"").defect,
        DesignDefect::WrongType { .. }
    ));
    assert!(matches!(problem("").defect, DesignDefect::Missing { .. }));
    assert!(matches!(problem("[connector]").defect, DesignDefect::Missing { .. }));
    let planar = "[connector]\nfamily = \"s-face\"\n[alignment]\nfree = [\"x\", \"yaw\"]";
    assert!(matches!(problem(planar).defect, DesignDefect::OutOfPlane { dof: Dof::Yaw, .. }));
    let name = format!("name = \"{}\"\n[connector]\nfamily = \"cone\"", "n".repeat(201));
    assert!(matches!(problem(&name).defect, DesignDefect::NotALine { .. }));
}

#[test]
fn each_rule_of_own_halves_reports_its_defect() {
    const GOOD: &str = "pieces = [[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]]";
    let own = |fixed: &str| {
        let text = format!("[connector]\nface_height = 0.5\nfixed = {{ {fixed} }}\nmoving = {{ {GOOD} }}");
        problem(&text).defect
    };
    assert!(matches!(own(""), DesignDefect::Missing { .. }));
    assert!(matches!(own("pieces = []"), DesignDefect::Empty { .. }));
    assert!(matches!(own("pieces = [[[0, 0, 0]]]"), DesignDefect::TooFewPoints { found: 1, .. }));
    assert!(matches!(
        own("pieces = [[[0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]]"),
        DesignDefect::NotAPoint { found: 2, .. }
    ));
    assert!(matches!(
        own("pieces = [[[nan, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]]"),
        DesignDefect::NotFinite { .. }
    ));
    assert!(matches!(
        own("pieces = [[[5000, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]]"),
        DesignDefect::OutOfRange { .. }
    ));
    assert!(matches!(own("profile = [[0, 0]]"), DesignDefect::UnsupportedHalf { key: "profile" }));
    assert!(matches!(own("mesh = \" \""), DesignDefect::Empty { .. }));
    assert!(matches!(own(&format!("{GOOD}, mesh = \"half.stl\"")), DesignDefect::Contradiction { .. }));
    assert!(matches!(own(&format!("{GOOD}, unit = \"mm\"")), DesignDefect::NotAParameter { .. }));
    let missing = problems("[connector]\n[connector.fixed]\npieces = 3");
    let defects: Vec<String> = missing.list.iter().map(|p| p.defect.to_string()).collect();
    assert_eq!(
        defects,
        ["`connector.moving` is missing", "`connector.fixed.pieces` should be a list of pieces, not integer"]
    );
}

#[test]
fn hopeless_text_is_refused_quickly_and_briefly() {
    for text in ["[".repeat(100_000), "a = ".to_owned() + &"[".repeat(100_000), "]\n".repeat(100_000)] {
        let problems = problems(&text);
        assert!(problems.list.len() <= LocatedDefects::MOST);
    }
    let many = "key = 1\n".repeat(2000) + "[connector]\nfamily = \"cone\"";
    let found = problems(&many);
    assert_eq!(found.list.len(), LocatedDefects::MOST);
    assert_eq!(found.list.len() + found.omitted, 2000);
    let strange: Vec<String> = (0..2000).map(|k| format!("key{k} = 1\n")).collect();
    let found = problems(&(strange.concat() + "[connector]\nfamily = \"cone\""));
    assert_eq!((found.list.len(), found.omitted), (LocatedDefects::MOST, 2000 - LocatedDefects::MOST));
    let large = "#".repeat(LARGEST_FILE + 1);
    assert!(matches!(problem(&large).defect, DesignDefect::TooLarge { .. }));
}

#[test]
fn overrides_follow_the_rules_of_the_file() {
    let cone = design("[connector]\nfamily = \"cone\"\nwidth = 50\nunit = \"mm\"");
    let freed = cone.clone().with_free(parse_dofs("x, yaw").unwrap()).unwrap();
    assert_eq!(freed.alignment.free, set(&[Dof::X, Dof::Yaw]));
    assert_eq!(freed.alignment.dont_care, DofSet::EMPTY);
    let moved = cone.clone().with_center_of_rotation("25 mm".parse().unwrap()).unwrap();
    assert_eq!(moved.alignment.center_of_rotation, 0.5);
    let longer = cone.clone().with_rotation_length("2".parse().unwrap()).unwrap();
    assert_eq!(longer.alignment.rotation_length, 2.0);
    let flat = cone.clone().with_aspect_ratio(0.25).unwrap();
    assert_eq!(flat.connector, ConnectorSpec::Family(FamilySpec::new(Family::Cone).with_aspect_ratio(0.25)));

    assert!(matches!(parse_dofs("x,x"), Err(DesignDefect::Repeated { dof: Dof::X })));
    assert!(matches!(parse_dofs(""), Err(DesignDefect::Empty { .. })));
    assert!(matches!(parse_dofs("x,"), Err(DesignDefect::UnknownName { .. })));
    assert!(matches!(cone.clone().with_free(DofSet::EMPTY), Err(DesignDefect::Empty { .. })));
    assert!(matches!(cone.clone().with_aspect_ratio(f64::NAN), Err(DesignDefect::OutOfRange { .. })));
    assert!(matches!(
        cone.with_center_of_rotation("30 deg".parse().unwrap()),
        Err(DesignDefect::WrongDimension { .. })
    ));
    let planar = design("[connector]\nfamily = \"v-face\"");
    assert!(matches!(planar.with_free(DofSet::ALL), Err(DesignDefect::OutOfPlane { layered: false, .. })));
    let layers = "[connector]\nfamily = \"x-face\"";
    let refused = design(layers).with_free(DofSet::ALL).unwrap_err();
    assert!(refused.help().is_some_and(|help| help.contains("write layer_thickness and layer_gap")));
    let deep = design(&format!("{layers}\nlayer_gap = 0.2\n[alignment]\nfree = [\"x\", \"y\", \"yaw\"]"));
    assert!(deep.with_free(DofSet::ALL).is_ok());
    let own = design(&format!("[connector]\n{TETRAHEDRA}").replace("\"1 cm\"", "10"));
    assert!(matches!(own.with_aspect_ratio(1.0), Err(DesignDefect::NotAParameter { .. })));
}

proptest::proptest! {
    /// Whatever the text, the answer is a design or problems whose places lie in the text.
    #[test]
    fn any_text_gets_an_answer(lines in proptest::collection::vec(
        "(\\[connector\\]|\\[connector.fixed\\]|\\[errors\\]|family = \"cone\"|x = .{0,8}|free = \\[.{0,8}|.{0,12})", 0..12)
    ) {
        let text = lines.join("\n");
        if let Err(problems) = read(&text, Path::new("")) {
            proptest::prop_assert!(!problems.list.is_empty());
            for problem in &problems.list {
                proptest::prop_assert!(problem.span.start <= problem.span.end && problem.span.end <= text.len());
                proptest::prop_assert!(text.get(problem.span.clone()).is_some(), "{problem:?} splits a character");
            }
        }
    }
}

/// Every design of the repository is valid and names the schema for editors; every family has a design.
#[test]
fn the_example_designs_are_good() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs");
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let text = load(&path).unwrap();
            assert!(text.starts_with("#:schema schema.json\n"), "{}", path.display());
            if let Err(problems) = read(&text, &folder) {
                panic!("{}: {problems}", path.display());
            }
        }
    }
    for family in Family::ALL {
        let text = load(&folder.join(format!("{}.toml", family.name()))).unwrap();
        assert_eq!(read(&text, &folder).unwrap().design.family(), Some(family));
    }
}
