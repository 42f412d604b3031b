use super::compose::{Compartment, slices};
use super::oracle::{self, MotionEnd};
use super::space::{Roof, Tile, envelope, roofs};
use super::watershed::Parts;
use super::*;
use crate::acceptance::Stream;
use crate::connector::Connector;
use crate::design::{ConnectorSpec, Design, Family, FamilySpec};
use crate::method::descent;
use crate::pose::DofSet;

fn pair(family: Family, aspect_ratio: f64, cor: f64, rotation_length: f64, free: &[Dof]) -> Pair {
    let mut alignment = Alignment::default_for(Some(family));
    alignment.center_of_rotation = cor;
    alignment.rotation_length = rotation_length;
    if !free.is_empty() {
        alignment.free = free.iter().copied().collect::<DofSet>();
    }
    let connector = ConnectorSpec::Family(FamilySpec::new(family).with_aspect_ratio(aspect_ratio));
    let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
    Pair::new(&Connector::build(&design).unwrap(), &design.alignment)
}

/// The five planar designs whose exact Sums are known: family, H/D, COR.
const FIVE: [(Family, f64, f64); 5] = [
    (Family::XFace, 1.0, 0.5),
    (Family::XFace, 0.5, -0.5),
    (Family::VFace, 1.0, 0.0),
    (Family::XFace, 2.0, 1.0),
    (Family::VFace, 0.5, -0.5),
];

fn spaces_of(pair: &Pair, settings: &PartitionSettings) -> Vec<(Vec<Roof>, Vec<Tile>, Compartment)> {
    let free = pair.alignment.free;
    let angles = settings.slices_of(&pair.alignment);
    let pieces = Pieces::of(pair, 1.0 / settings.strips as f64).unwrap();
    let pairs = pieces.pairs().unwrap();
    Compartment::all(&angles)
        .into_iter()
        .map(|compartment| {
            let roofs = roofs(&pairs, &compartment, free, &Exec::new()).unwrap();
            let tiles = envelope(&roofs, &Exec::new()).unwrap();
            (roofs, tiles, compartment)
        })
        .collect()
}

/// A random point of a compartment with translations within ±1.2 D.
fn random_point(compartment: &Compartment, translations: usize, stream: Stream, k: u64) -> PolytopePoint {
    let mut q = [0.0; MAX_DIMENSION];
    let mut number = (0..).map(|j| stream.uniform(8 * k + j));
    for value in q.iter_mut().take(translations) {
        *value = 2.4 * number.next().unwrap() - 1.2;
    }
    for (value, (_, [low, high])) in q.iter_mut().skip(translations).zip(&compartment.spans) {
        *value = low + (high - low) * number.next().unwrap();
    }
    q
}

/// The highest roof over `q`: the definition of the envelope.
fn brute_height(roofs: &[Roof], q: &PolytopePoint) -> Option<f64> {
    roofs.iter().filter_map(|roof| roof.height(q)).max_by(f64::total_cmp)
}

#[test]
fn tiles_cover_the_shadow_at_the_height_of_the_highest_roof() {
    let yaw = [Dof::X, Dof::Y, Dof::Yaw];
    let cases = [
        (pair(Family::VFace, 0.5, -0.5, 1.0, &[]), PartitionSettings { slices: 7, strips: 3 }),
        (pair(Family::XFace, 1.0, 0.5, 1.0, &[]), PartitionSettings { slices: 6, strips: 2 }),
        (pair(Family::SFace, 1.0, 0.0, 1.0, &[]), PartitionSettings { slices: 4, strips: 2 }),
        (pair(Family::Pyramid, 1.0, 0.0, 0.5, &yaw), PartitionSettings { slices: 4, strips: 1 }),
    ];
    for (case, (pair, settings)) in cases.iter().enumerate() {
        let stream = Stream::new(case as u64);
        let translations = pair.alignment.free.len() - pair.alignment.free.rotations();
        for (roofs, tiles, compartment) in spaces_of(pair, settings) {
            for k in 0..300 {
                let q = random_point(&compartment, translations, stream, k);
                let over: Vec<f64> = tiles
                    .iter()
                    .filter(|tile| tile.region.contains(&q))
                    .map(|tile| tile.height.at(&q))
                    .collect();
                match brute_height(&roofs, &q) {
                    None => assert!(over.is_empty(), "case {case} at {q:?}: nothing is met there"),
                    Some(height) => {
                        assert_eq!(over.len(), 1, "case {case} at {q:?}: the tiles do not tile");
                        // Facets meet at their cuts, within a few times the resolution.
                        assert!(
                            (over[0] - height).abs() < 1e-7,
                            "case {case} at {q:?}: {} {height}",
                            over[0]
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn on_slices_the_height_is_that_of_first_contact() {
    for (family, ratio, cor) in FIVE {
        let pair = pair(family, ratio, cor, 1.0, &[]);
        let partition = run(&pair, &PartitionSettings { slices: 6, strips: 2 }, &Exec::new()).unwrap();
        for angle in slices(std::f64::consts::FRAC_PI_2, 6) {
            let rotation = PoseError { pitch: angle, ..PoseError::default() }.rotation();
            for k in -20..=20 {
                // Avoid corners, which have two valid results.
                let x = 0.0613 * f64::from(k) + 0.0017;
                let exact = pair.at_rotation(rotation).height(glam::DVec2::new(x, 0.0));
                let q = [x, angle, 0.0, 0.0, 0.0, 0.0];
                let cells = &partition.cells;
                let ours = cells.holding(&q).into_iter().map(|k| cells.all[k].height.at(&q));
                let ours = ours.max_by(f64::total_cmp);
                match (exact, ours) {
                    (Some(exact), Some(ours)) => assert!((exact - ours).abs() < 1e-7, "{exact} {ours}"),
                    (exact, ours) => assert_eq!(exact, ours, "{} at {x}, {angle}", family.name()),
                }
            }
        }
    }
}

/// Every part against the motion of single points: the definition of a watershed.
fn judged(pair: &Pair, partition: &Partition, stream: Stream, count: u64) -> [usize; 2] {
    let translations = partition.alignment.free.len() - partition.alignment.free.rotations();
    let (mut same, mut tried) = (0, 0);
    for k in 0..count {
        let number = stream.uniform(1_000_000 + k);
        let compartment = &partition.compartments[(number * partition.compartments.len() as f64) as usize];
        let q = random_point(compartment, translations, stream, k);
        let Some(&cell) = partition.cells.holding(&q).first() else { continue };
        let label = match &partition.watersheds.parts[cell] {
            Parts::Whole(label) => Some(*label),
            Parts::Cut(parts) => parts.iter().find(|(part, _)| part.contains(&q)).map(|(_, label)| *label),
        };
        // Along a level ravine the points have many rests and the parts have a single rest.
        let fate = match oracle::fate(&partition.cells, &q) {
            MotionEnd::Lost => Outcome::Missed,
            MotionEnd::Rest(place) if docks(pair)(&place) => Outcome::Aligned,
            MotionEnd::Rest(_) | MotionEnd::Left => Outcome::Jammed,
        };
        tried += 1;
        same += usize::from(label == Some(fate));
    }
    [same, tried]
}

#[test]
fn labels_of_parts_equal_outcomes_of_their_points() {
    for (case, (family, ratio, cor)) in FIVE.into_iter().enumerate() {
        let pair = pair(family, ratio, cor, 1.0, &[]);
        let partition = run(&pair, &PartitionSettings { slices: 12, strips: 3 }, &Exec::new()).unwrap();
        let [same, tried] = judged(&pair, &partition, Stream::new(case as u64), 1000);
        println!("{} AR {ratio} COR {cor}: {same} of {tried}, {:?}", family.name(), partition.counts());
        assert!(tried > 500 && same == tried, "{} AR {ratio} COR {cor}: {same} of {tried}", family.name());
    }
}

/// Measure of the poses that exact descents accept.
fn exact(pair: &Pair, cells: usize) -> f64 {
    let grid = Grid::over(&pair.alignment, |_| cells);
    let measure = grid.cell_measure();
    let settings = descent::DescentSettings::default();
    let (acceptance, _) = descent::run(pair, Domain::Grid(grid), &settings, &Exec::new()).unwrap();
    acceptance.counts()[0] as f64 * measure
}

#[test]
fn sums_are_close_to_those_of_exact_descents() {
    for (family, ratio, cor) in FIVE {
        let pair = pair(family, ratio, cor, 1.0, &[]);
        // With 40 cells per axis, 450 accepted cells have a border of 160, of which a grid counts 0.3·√160 = 4
        // too many or too few: 0.8 %.
        let exact = exact(&pair, 40);
        // In the thin ravine of the last family the crest between two watersheds is a ten-thousandth of D
        // high.
        let strips = if (family, ratio) == (Family::VFace, 0.5) { 40 } else { 16 };
        let partition = run(&pair, &PartitionSettings { slices: 32, strips }, &Exec::new()).unwrap();
        let sum = partition.measure(Outcome::Aligned);
        println!("{} AR {ratio} COR {cor}: {sum:.4} for {exact:.4}", family.name());
        assert!((sum / exact - 1.0).abs() < 0.03, "{} AR {ratio} COR {cor}: {sum} {exact}", family.name());
    }
}

/// Without strips the composite of an edge that turns is a corrugated face, whose valleys stop the rotation.
#[test]
fn without_strips_more_slices_make_it_worse() {
    let (family, ratio, cor) = FIVE[2];
    let pair = pair(family, ratio, cor, 1.0, &[]);
    let exact = exact(&pair, 50);
    let share = |slices| {
        run(&pair, &PartitionSettings { slices, strips: 1 }, &Exec::new()).unwrap().measure(Outcome::Aligned)
            / exact
    };
    let [few, many] = [12, 50].map(share);
    println!("{few} {many}");
    assert!(many < few && few < 0.3, "{few} {many}");
}

#[test]
fn spatial_sets_of_three_errors_agree_with_the_oracle() {
    for (free, slices, least) in
        [([Dof::X, Dof::Y, Dof::Pitch], 8, 0.98), ([Dof::X, Dof::Pitch, Dof::Yaw], 2, 0.94)]
    {
        let pair = pair(Family::Pyramid, 0.5, 0.5, 0.5, &free);
        let partition = run(&pair, &PartitionSettings { slices, strips: 1 }, &Exec::new()).unwrap();
        let [same, tried] = judged(&pair, &partition, Stream::new(3), 500);
        println!("{free:?}: {same} of {tried}, {:?}", partition.counts());
        assert!(tried > 250 && same as f64 >= least * tried as f64, "{free:?}: {same} of {tried}");
    }
}

#[test]
fn threads_change_nothing() {
    let (family, ratio, cor) = FIVE[0];
    let pair = pair(family, ratio, cor, 1.0, &[]);
    let parts = |threads| {
        let exec = Exec::new().with_threads(threads).unwrap();
        let partition = run(&pair, &PartitionSettings { slices: 8, strips: 3 }, &exec).unwrap();
        let parts: Vec<_> =
            partition.parts().map(|part| (part.region.vertices().to_vec(), part.outcome)).collect();
        parts
    };
    assert_eq!(parts(1), parts(3));
}

#[test]
fn the_outline_encloses_the_accepted_set() {
    let (family, ratio, cor) = FIVE[1];
    let pair = pair(family, ratio, cor, 1.0, &[]);
    let partition = run(&pair, &PartitionSettings { slices: 12, strips: 4 }, &Exec::new()).unwrap();
    // Green's theorem: the area is the integral of x dθ around the border, with the accepted side on the left
    // of each segment; the unsigned sum over polygons gives the same area independently of the error box.
    let area = |corners: &[Corner]| {
        let next = corners.iter().cycle().skip(1);
        0.5 * corners.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>()
    };
    let polygons = partition.polygons();
    let accepted = polygons.iter().filter(|(_, outcome)| *outcome == Outcome::Aligned);
    let enclosed: f64 = accepted.map(|(corners, _)| area(corners)).sum();
    // Every corner of the outline has an even number of segments: it is closed.
    let outline = partition.outline();
    let near = |a: &Corner, b: &Corner| (a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-6;
    for end in outline.iter().flatten() {
        let meeting = outline.iter().flatten().filter(|other| near(end, other)).count();
        assert_eq!(meeting % 2, 0, "open at {end:?}");
    }
    assert!(enclosed >= partition.measure(Outcome::Aligned) - 1e-9, "{enclosed}");
}

#[test]
fn unsuitable_errors_and_settings_are_reported() {
    let locked = pair(Family::Pyramid, 0.5, 0.0, 0.5, &[Dof::X, Dof::Y]);
    let error = run(&locked, &PartitionSettings::default(), &Exec::new()).unwrap_err();
    assert_eq!(error, PartitionError::TooFewErrors { free: 2 });
    let planar = pair(Family::VFace, 0.5, 0.0, 0.5, &[]);
    let error = run(&planar, &PartitionSettings { slices: 1, strips: 1 }, &Exec::new()).unwrap_err();
    assert!(error.to_string().contains("slices must be at least 2"), "{error}");
    for settings in [
        PartitionSettings { slices: usize::MAX, strips: 1 },
        PartitionSettings { slices: 8, strips: usize::MAX },
    ] {
        let error = run(&planar, &settings, &Exec::new()).unwrap_err();
        assert!(error.to_string().contains("at most"), "{error}");
    }
    let all = pair(Family::Pyramid, 0.5, 0.0, 0.5, &Dof::ALL);
    let error = run(&all, &PartitionSettings { slices: 1000, strips: 200 }, &Exec::new()).unwrap_err();
    assert!(matches!(error, PartitionError::TooManyStrips { .. }), "{error}");
    let small = Exec::new().with_memory_budget(1000);
    assert!(matches!(
        run(&planar, &PartitionSettings::default(), &small),
        Err(PartitionError::OutOfBudget(_))
    ));
    let cancelled = Exec::new();
    cancelled.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
    assert!(matches!(
        run(&planar, &PartitionSettings::default(), &cancelled),
        Err(PartitionError::Cancelled(_))
    ));
}
