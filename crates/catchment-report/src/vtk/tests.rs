use super::*;
use crate::schema::testing::{blob, design};
use catchment_core::exec::Exec;
use glam::DVec3;
use std::ops::Range;

/// A file of VTK, its head read as XML and its arrays as bytes.
struct Read {
    head: String,
    bytes: Vec<u8>,
}

impl Read {
    fn of(file: &[u8]) -> Self {
        let mark = b"<AppendedData encoding=\"raw\">\n_";
        let at = file.windows(mark.len()).position(|w| w == mark).unwrap();
        let head = String::from_utf8(file[..at].to_vec()).unwrap() + "</VTKFile>";
        Self { head, bytes: file[at + mark.len()..].to_vec() }
    }

    fn array(&self, name: &str) -> Vec<f64> {
        let xml = roxmltree::Document::parse(&self.head).unwrap();
        let node = xml.descendants().find(|node| node.attribute("Name") == Some(name)).unwrap();
        let from: usize = node.attribute("offset").unwrap().parse().unwrap();
        let length = u64::from_le_bytes(self.bytes[from..from + 8].try_into().unwrap()) as usize;
        let bytes = &self.bytes[from + 8..from + 8 + length];
        match node.attribute("type").unwrap() {
            "UInt8" => bytes.iter().map(|b| f64::from(*b)).collect(),
            "Int64" => bytes.as_chunks().0.iter().map(|b| i64::from_le_bytes(*b) as f64).collect(),
            "Float32" => bytes.as_chunks().0.iter().map(|b| f64::from(f32::from_le_bytes(*b))).collect(),
            _ => bytes.as_chunks().0.iter().map(|b| f64::from_le_bytes(*b)).collect(),
        }
    }
}

/// A set over x, y, roll, yaw with heights that count its cells.
fn four() -> (Acceptance, Vec<f32>) {
    let acceptance = blob(&design(DofSet::ALL.without(Dof::Pitch)), 7);
    let heights = (0..acceptance.outcomes.len()).map(|k| k as f32).collect();
    (acceptance, heights)
}

fn axes(dofs: &[Dof]) -> DofSet {
    dofs.iter().copied().collect()
}

#[test]
fn an_image_holds_the_section_and_the_share_of_all() {
    let (acceptance, heights) = four();
    let grid = acceptance.grid().unwrap();
    let at = PoseError { roll: 0.5, ..PoseError::default() };
    let view = View::new(&acceptance, Some(&heights), Some(axes(&[Dof::X, Dof::Y, Dof::Yaw])), &at).unwrap();
    let read = Read::of(&image(&view, &Exec::new()).unwrap());
    let roll = grid.axes[2].cell_of(0.5).unwrap();
    let (outcomes, shares, read_heights) = (read.array("outcome"), read.array("share"), read.array("height"));
    assert_eq!(outcomes.len(), 343);
    for k in 0..343 {
        let (x, y, yaw) = (k % 7, k / 7 % 7, k / 49);
        let cell = |roll: usize| grid.index(&[x, y, roll, yaw]);
        assert_eq!(outcomes[k], f64::from(acceptance.outcomes[cell(roll)] as u8));
        assert_eq!(read_heights[k], cell(roll) as f64);
        let accepted = (0..7).filter(|r| acceptance.outcomes[cell(*r)] == Outcome::Aligned).count();
        assert!((shares[k] - accepted as f64 / 7.0).abs() < 1e-7);
    }
    // All shares together are the measure of the whole grid.
    let sum = shares.iter().sum::<f64>() / 343.0 * grid.measure();
    assert!((sum - acceptance.counts()[0] as f64 * grid.cell_measure()).abs() < 1e-5 * sum);
    assert!(read.head.contains("x is x (D), y is y (D), z is yaw (rad), roll = "), "{}", read.head);
    assert!(view.table().contains("x (D), y (D), yaw (rad)"));
}

/// Corners, faces and codes of a border.
fn faces(view: &View) -> (Vec<DVec3>, Vec<[usize; 4]>, Read) {
    let read = Read::of(&border(view, &Exec::new()).unwrap());
    let places = read.array("places");
    let corners = places.as_chunks::<3>().0.iter().map(|p| DVec3::from_array(*p)).collect();
    let joins: Vec<usize> = read.array("connectivity").iter().map(|k| *k as usize).collect();
    let faces: Vec<[usize; 4]> = joins.as_chunks().0.to_vec();
    assert_eq!(read.array("offsets"), (1..=faces.len()).map(|k| 4.0 * k as f64).collect::<Vec<_>>());
    (corners, faces, read)
}

#[test]
fn a_border_is_closed_and_encloses_the_accepted_cells() {
    let (acceptance, _) = four();
    let grid = acceptance.grid().unwrap();
    let view =
        View::new(&acceptance, None, Some(axes(&[Dof::X, Dof::Roll, Dof::Yaw])), &PoseError::default())
            .unwrap();
    let (corners, faces, read) = faces(&view);
    // The flux of (x, y, z)/3 through it.
    let volume: f64 = faces
        .iter()
        .flat_map(|f| [[0, 1, 2], [0, 2, 3]].map(|t| t.map(|k| corners[f[k]])))
        .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
        .sum();
    let accepted = view.cells().filter(|cell| acceptance.outcomes[*cell] == Outcome::Aligned).count();
    let measure: f64 = view.axes().map(GridAxis::step).product::<f64>() * accepted as f64;
    assert!((volume - measure).abs() < 1e-12, "{volume} {measure}");
    // Each edge is traversed equally often in both directions.
    let mut edges = std::collections::BTreeMap::<[usize; 2], i32>::new();
    for face in &faces {
        for k in 0..4 {
            let (a, b) = (face[k], face[(k + 1) % 4]);
            *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
        }
    }
    assert!(edges.values().all(|sum| *sum == 0));
    // Beyond are other outcomes, or the border of the box.
    let beyond = read.array("beyond");
    assert!(beyond.len() == faces.len() && beyond.iter().all(|code| *code != 1.0));
    assert!(beyond.contains(&2.0));
    let range: Range<f64> = -1e-9 - grid.axes[0].hi..grid.axes[0].hi + 1e-9;
    assert!(corners.iter().all(|corner| range.contains(&corner.x)));
}

#[test]
fn two_axes_give_the_cells_themselves() {
    let acceptance = blob(&design([Dof::X, Dof::Yaw].into_iter().collect()), 9);
    let heights: Vec<f32> = (0..81).map(|k| k as f32).collect();
    let view = View::new(&acceptance, Some(&heights), None, &PoseError::default()).unwrap();
    let (corners, faces, read) = faces(&view);
    assert_eq!(faces.len(), acceptance.counts()[0]);
    let area: f64 =
        faces.iter().map(|f| (corners[f[1]] - corners[f[0]]).cross(corners[f[3]] - corners[f[0]]).z).sum();
    let grid = acceptance.grid().unwrap();
    assert!((area - faces.len() as f64 * grid.cell_measure()).abs() < 1e-12);
    let accepted = view.cells().filter(|cell| acceptance.outcomes[*cell] == Outcome::Aligned);
    assert_eq!(read.array("height"), accepted.map(|cell| cell as f64).collect::<Vec<_>>());
}

#[test]
fn views_that_cannot_be_shown_are_refused() {
    let (acceptance, _) = four();
    let refused = |dofs: &[Dof], at: PoseError| {
        View::new(&acceptance, None, Some(axes(dofs)), &at).map(|_| ()).unwrap_err().to_string()
    };
    let zero = PoseError::default();
    assert_eq!(refused(&[Dof::Pitch], zero), "pitch is no axis of the grid; it has x, y, roll, yaw");
    assert!(refused(&[Dof::X, Dof::Y, Dof::Roll, Dof::Yaw], zero).starts_with("4 axes cannot"));
    let at = PoseError { roll: 9.0, ..zero };
    assert!(
        refused(&[Dof::X], at).starts_with("roll = 9 lies outside of the error box"),
        "{}",
        refused(&[Dof::X], at)
    );
    assert!(refused(&[Dof::Roll], PoseError { roll: 0.1, ..zero }).contains("takes no value"));
    let pitched = PoseError { pitch: 0.1, ..zero };
    assert!(refused(&[Dof::X], pitched).starts_with("pitch is no axis"));
    let line = View::new(&acceptance, None, Some(axes(&[Dof::X])), &zero).unwrap();
    assert!(matches!(border(&line, &Exec::new()), Err(ViewError::OneAxis)));
    let all = View::new(&acceptance, None, None, &zero).unwrap();
    let small = Exec::new().with_memory_budget(100);
    assert!(matches!(image(&all, &small), Err(ViewError::OutOfBudget(_))));
    assert!(matches!(border(&all, &small), Err(ViewError::OutOfBudget(_))));
}
