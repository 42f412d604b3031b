//! Problems from texts, designs and values in memory.

use super::*;
use crate::connector::HalfSource;
use crate::design::{ConnectorSpec, Family, FamilySpec, FileSpec, HalfSpec, WidthFrom};
use crate::pose::{Dof, DofSet, Mount};
use glam::DVec3;
use std::fmt::Write;

const V_FACE: &str =
    "[connector]\nfamily = \"v-face\"\naspect_ratio = 1.0\n[alignment]\nrotation_length = 1.0\n";

fn read(text: &str) -> Result<Problem, ProblemError> {
    Draft::read(SourceText::new("d.toml", text)).and_then(Draft::build)
}

fn diagnostics(error: ProblemError) -> Diagnostics {
    match error {
        ProblemError::Diagnostics(diagnostics) => diagnostics,
        ProblemError::Load(error) => panic!("{error}"),
    }
}

#[test]
fn a_problem_is_clone_send_and_sync() {
    fn goes_anywhere<T: Send + Sync + Clone + 'static>(_: &T) {}
    let problem = read(V_FACE).unwrap();
    goes_anywhere(&problem);
    let there = problem.clone();
    let digest = std::thread::spawn(move || there.digest().to_owned()).join().unwrap();
    assert_eq!(digest, problem.digest());
    assert_eq!(digest.len(), 64);
}

#[test]
fn digests_depend_on_the_problem_not_its_name() {
    let digest = |text: &str| read(text).unwrap().digest().to_owned();
    let own = digest(V_FACE);
    assert_eq!(digest(&format!("name = \"another\"\n{V_FACE}")), own);
    assert_eq!(digest(&V_FACE.replace("v-face\"\n", "v-face\"\nwidth = 50\nunit = \"mm\"\n")), own);
    for changed in [
        V_FACE.replace("aspect_ratio = 1.0", "aspect_ratio = 0.9"),
        V_FACE.replace("rotation_length = 1.0", "rotation_length = 0.9"),
        format!("{V_FACE}center_of_rotation = 0.1\n"),
        format!("{V_FACE}[errors]\nx = 0.5\n"),
    ] {
        assert_ne!(digest(&changed), own, "{changed}");
    }
}

#[test]
fn the_digest_depends_on_mesh_content_not_location() {
    let meshes = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs/meshes");
    let [plug, socket] = ["plug.stl", "socket.stl"].map(|name| std::fs::read(meshes.join(name)).unwrap());
    let home = tempfile::tempdir().unwrap();
    let problem = |folder: &str, plug: &[u8]| {
        let folder = home.path().join(folder);
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("a.stl"), &socket).unwrap();
        std::fs::write(folder.join("b.stl"), plug).unwrap();
        let text = std::fs::read_to_string(meshes.join("../pyramid-stl.toml")).unwrap();
        let text = text.replace("meshes/socket.stl", "a.stl").replace("meshes/plug.stl", "b.stl");
        std::fs::write(folder.join("d.toml"), text).unwrap();
        Problem::open(folder.join("d.toml"))
    };
    let (here, there) = (problem("here", &plug).unwrap(), problem("there", &plug).unwrap());
    assert_eq!(here.digest(), there.digest());
    // The report contains the content of the file, not only its path.
    let ConnectorSpec::Own(own) = &here.design().connector else { panic!("it has halves of its own") };
    let HalfSpec::Mesh(FileSpec { content: Some(content), .. }) = &own.moving else { panic!("a mesh") };
    assert_eq!((content.bytes, content.triangles), (plug.len() as u64, 6));
    assert_ne!(
        problem("swapped", &socket).map_or_else(|e| e.to_string(), |p| p.digest().to_owned()),
        here.digest()
    );
}

#[test]
fn diagnostics_keep_their_place_from_any_module() {
    let place = |text: &str| {
        let result = diagnostics(read(text).unwrap_err());
        let source = result.source.unwrap();
        let span = result.list[0].span.clone().unwrap();
        source.text[span].to_owned()
    };
    assert_eq!(place("[connector]\nfamily = \"v-fac\"\n"), "\"v-fac\"");
    let two_cubes = |height: f64| {
        let mut piece = String::new();
        for k in 0..8 {
            write!(
                piece,
                "[{}, {}, {}],",
                f64::from(k & 1) - 0.5,
                f64::from(k >> 1 & 1) - 0.5,
                0.3 * f64::from(k >> 2)
            )
            .unwrap();
        }
        format!(
            "[connector]\nwidth = 1\nface_height = {height}\nfixed = {{ pieces = [[{piece}]] }}\nmoving = {{ pieces = [[{piece}]] }}\n\
             [alignment]\nfree = [\"x\"]\n[docked]\nx = 0.5\n"
        )
    };
    assert!(read(&two_cubes(0.3)).is_ok());
    assert_eq!(place(&two_cubes(0.2)), "0.2");
}

#[test]
fn a_refused_change_names_its_origin() {
    let draft = Draft::read(SourceText::new("d.toml", V_FACE)).unwrap();
    let all = DofSet::ALL;
    let result = diagnostics(draft.clone().change("free", |design| design.with_free(all)).unwrap_err());
    assert!(result.list[0].message.starts_with("free: "), "{result}");
    assert_eq!(&result.source.unwrap().text[result.list[0].span.clone().unwrap()], "\"v-face\"");
    let changed = draft.change("aspect ratio", |design| design.with_aspect_ratio(0.5)).unwrap();
    assert_ne!(changed.build().unwrap().digest(), read(V_FACE).unwrap().digest());
}

/// The triangles of a family's half, as drawn: from its face centre, facing +z.
fn soup(family: Family, moving: bool) -> Vec<[DVec3; 3]> {
    let mount = Mount::X;
    let connector = Connector::of_family(&FamilySpec::new(family), mount).unwrap();
    let half = if moving { &connector.moving } else { &connector.fixed };
    let drawn = |p: DVec3| if moving { mount.apply(p) } else { p };
    half.surfaces
        .iter()
        .flat_map(|surface| {
            surface.triangles().into_iter().map(move |t| t.map(|k| drawn(surface.vertices[k as usize])))
        })
        .collect()
}

#[test]
fn triangles_in_memory_are_the_same_problem_as_their_family() {
    let free = DofSet::ALL.without(Dof::Y).without(Dof::Roll);
    let alignment = Alignment { center_of_rotation: 0.5, ..Alignment::new(free, Mount::X) };
    let [fixed, moving] = [false, true].map(|moving| HalfSource::Triangles(soup(Family::Pyramid, moving)));
    let problem = Problem::new(fixed, moving, alignment.clone()).unwrap();
    let connector = ConnectorSpec::Family(FamilySpec::new(Family::Pyramid));
    let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
    let family = Problem::of(design).unwrap();
    for pose in [[0.2, 0.0, 0.0, 0.1, 0.3], [-0.4, 0.0, 0.0, -0.2, 0.0], [0.7, 0.0, 0.0, 0.0, 0.9]] {
        let pose = crate::pose::PoseError::from_array(pose);
        let (a, b) = (problem.follow(&pose), family.follow(&pose));
        assert_eq!(a.outcome, b.outcome);
        for (a, b) in a.error.to_array().into_iter().zip(b.error.to_array()) {
            assert!((a - b).abs() < 1e-6);
        }
    }
    assert_eq!(problem.digest().len(), 64);
    assert!(problem.source().is_none());
}

#[test]
fn defects_in_memory_are_reported_without_a_file() {
    let alignment = Alignment::new(DofSet::EMPTY.with(Dof::X), Mount::X);
    let mut open = soup(Family::Pyramid, true);
    open.pop();
    let fixed = HalfSource::Triangles(soup(Family::Pyramid, false));
    let result = diagnostics(Problem::new(fixed, HalfSource::Triangles(open), alignment).unwrap_err());
    assert!(result.source.is_none() && !result.list.is_empty());
    assert!(result.to_string().contains("moving half"), "{result}");
}

/// A plate of the given size, a cylinder of radius 6 that stands on it, in mm.
fn pin_on(width: &str, plate: f64) -> String {
    format!(
        "[connector]\n{width}unit = \"mm\"\n[[connector.fixed.parts]]\nbox = [{plate}, {plate}, 5]\n\
         [[connector.moving.parts]]\ncylinder = {{ radius = 6, height = 10 }}\n\
         [alignment]\ncenter_of_rotation = \"3 mm\"\n[errors]\nx = \"6 mm\"\ny = 0.25\n"
    )
}

#[test]
fn a_width_that_is_left_out_is_measured() {
    let draft = |text: &str| Draft::read(SourceText::new("d.toml", text)).unwrap();
    let from = |draft: &Draft| match &draft.design().connector {
        ConnectorSpec::Own(own) => own.width_from,
        ConnectorSpec::Family(_) => panic!("own halves"),
    };
    let result = draft(&pin_on("", 40.0));
    let design = result.design();
    // The cylinder is a polygon inside of the circle, by at most 0.001 D to either side.
    assert!((12.0 - 0.002 * 12.0..=12.0).contains(&design.width), "{}", design.width);
    assert_eq!(from(&result), WidthFrom::Touching);
    // Lengths with a unit are converted with this D; plain numbers are in D.
    assert!((design.alignment.center_of_rotation * design.width - 3.0).abs() < 1e-12);
    assert!((design.alignment.half_ranges[0] * design.width - 6.0).abs() < 1e-12);
    assert_eq!(design.alignment.half_ranges[1], 0.25);
    // Written out it is the same problem.
    let written = draft(&pin_on(&format!("width = {}\n", design.width), 40.0));
    assert_eq!(from(&written), WidthFrom::Written);
    assert_eq!(written.design().alignment, design.alignment);
    // On a plate 40 times as wide, the size of the plate determines D.
    let wide = draft(&pin_on("", 480.0));
    assert_eq!(from(&wide), WidthFrom::Size);
    assert!((wide.design().width - 480.0 / (16.0 * 0.99)).abs() < 1e-6, "{}", wide.design().width);
}

#[test]
fn a_measured_width_gives_the_digest_of_a_written_one() {
    let meshes = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs/meshes");
    let open = |width: &str, unit: &str| {
        let text = format!(
            "[connector]\n{width}unit = \"{unit}\"\nfixed = {{ mesh = \"socket.stl\", unit = \"mm\" }}\n\
             moving = {{ mesh = \"plug.stl\", unit = \"mm\" }}\n[errors]\nx = \"10 mm\"\n"
        );
        Draft::read(SourceText::new(meshes.join("d.toml"), text)).unwrap().build().unwrap()
    };
    let (measured, written) = (open("", "mm"), open("width = 50\n", "mm"));
    assert_eq!(measured.design().width, 50.0);
    assert_eq!(measured.digest(), written.digest());
    let in_inches = open("", "in").design().width;
    assert!((in_inches - 50.0 / 25.4).abs() < 1e-8, "{in_inches}");
}

#[test]
fn defects_beside_an_omitted_width_are_reported() {
    let error_of = |text: &str| {
        let diagnostics = diagnostics(Draft::read(SourceText::new("d.toml", text)).unwrap_err());
        diagnostics.list.iter().map(|diagnostic| diagnostic.message.clone()).collect::<Vec<_>>().join("; ")
    };
    let pin = pin_on("", 40.0);
    // D depends on it.
    let message = error_of(&pin.replace("radius = 6", "radius = \"0.5 D\""));
    assert!(message.contains("0.5 D depends on D"), "{message}");
    // Out of range once D is known, and not before.
    let message = error_of(&pin.replace("\"6 mm\"", "\"6 m\""));
    assert!(message.contains("outside of"), "{message}");
    // Nothing to measure, nothing that touches, nothing there.
    let message = error_of("[connector]\nunit = \"mm\"\nfamily = \"pyramid\"\n");
    assert!(message.contains("width"), "{message}");
    let message = error_of(&pin.replace("height = 10 }", "height = 10 }\nat = [400, 0, 0]"));
    assert!(message.contains("pass each other by"), "{message}");
    let half = "{ mesh = \"no.stl\", unit = \"mm\" }";
    let message = error_of(&format!("[connector]\nunit = \"mm\"\nfixed = {half}\nmoving = {half}\n"));
    assert!(message.contains("there is no such file"), "{message}");
}
