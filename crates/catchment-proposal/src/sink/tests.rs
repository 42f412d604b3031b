//! Pins, plates and holes made of boxes: results of the lattices compared with closed forms.

use super::flood::basins;
use super::height::NOTHING;
use super::*;

/// A box from corner to corner.
pub(super) fn block([x0, y0, z0]: [f64; 3], [x1, y1, z1]: [f64; 3]) -> Triangles {
    let p = |k: usize| {
        DVec3::new(
            if k & 1 == 0 { x0 } else { x1 },
            if k & 2 == 0 { y0 } else { y1 },
            if k & 4 == 0 { z0 } else { z1 },
        )
    };
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        .into_iter()
        .flat_map(|[a, b, c, d]| [[p(a), p(b), p(c)], [p(a), p(c), p(d)]])
        .collect()
}

/// A plate of 40 × 40 × 20 mm, its top at z = 0, with a square hole of this half width, `deep` mm deep, whose middle is at (x, y).
fn plate(half: f64, deep: f64, [x, y]: [f64; 2]) -> Triangles {
    let (low, high) = (-20.0, 20.0);
    let mut all = [
        block([low, low, -20.0], [x - half, high, 0.0]),
        block([x + half, low, -20.0], [high, high, 0.0]),
        block([x - half, low, -20.0], [x + half, y - half, 0.0]),
        block([x - half, y + half, -20.0], [x + half, high, 0.0]),
    ]
    .concat();
    if deep < 20.0 {
        all.extend(block([x - half, y - half, -20.0], [x + half, y + half, -deep]));
    }
    all
}

/// A pin 10 mm wide and 24 mm long, its lower end at a height.
fn pin([x, y, z]: [f64; 3]) -> Triangles {
    block([x - 5.0, y - 5.0, z], [x + 5.0, y + 5.0, z + 24.0])
}

pub(super) const GRAIN: Grain = Grain { small: 0.5 };

pub(super) fn down() -> AxisDirection {
    "-z".parse().unwrap()
}

#[test]
fn a_pin_in_its_hole_holds_as_drawn() {
    let plate = plate(5.3, 12.0, [3.0, -2.0]);
    let looked = |pin: &Triangles| drawn([&plate, pin], down(), false, GRAIN);
    let ApproachResult::Holds(sunk) = looked(&pin([3.0, -2.0, -12.0])) else { panic!() };
    // The climb is the depth of the hole; the play is the clearance, up to a cell of 0.1 mm on each side.
    assert!((sunk.climb - 12.0).abs() < 1e-3 && sunk.height.abs() < 1e-3, "{sunk:?}");
    assert!((sunk.play - 0.3).abs() < 0.11 && sunk.offset.length() < 0.06, "{sunk:?}");
    // Drawn 4 mm above its floor it slides down; 9 mm above is apart, unless any distance is.
    let ApproachResult::Holds(slid) = looked(&pin([3.0, -2.0, -8.0])) else { panic!() };
    assert!((slid.height + 4.0).abs() < 1e-3, "{slid:?}");
    let far = pin([3.0, -2.0, -3.0]);
    assert!(matches!(looked(&far), ApproachResult::Apart(by) if (by - 9.0).abs() < 1e-3));
    assert!(matches!(drawn([&plate, &far], down(), true, GRAIN), ApproachResult::Holds(_)));
    // From the side its own hole is in the way.
    let sideways = drawn([&plate, &pin([3.0, -2.0, -12.0])], "+x".parse().unwrap(), false, GRAIN);
    assert!(matches!(sideways, ApproachResult::Blocked(_)), "{sideways:?}");
}

#[test]
fn a_pin_as_wide_as_its_hole_still_sinks() {
    let (plate, pin) = (plate(5.0, 12.0, [0.0; 2]), pin([0.0, 0.0, -12.0]));
    let result = drawn([&plate, &pin], down(), false, GRAIN);
    assert!(matches!(result, ApproachResult::Holds(sunk) if sunk.play < 0.16), "{result:?}");
}

#[test]
fn a_plate_is_flat_and_a_hole_without_a_floor_lets_pass() {
    let top = block([-8.0, -8.0, 0.0], [8.0, 8.0, 5.0]);
    let flat = drawn([&block([-20.0, -20.0, -5.0], [20.0, 20.0, 0.0]), &top], down(), false, GRAIN);
    assert!(matches!(flat, ApproachResult::Flat { climb } if climb < 1e-6), "{flat:?}");
    let through = drawn([&plate(5.4, 20.0, [0.0; 2]), &pin([0.0, 0.0, -18.0])], down(), false, GRAIN);
    assert!(matches!(through, ApproachResult::Passes), "{through:?}");
}

#[test]
fn a_turned_pin_enters_by_its_headless_ends() {
    let plate = plate(5.3, 12.0, [3.0, -2.0]);
    // The pin lies along x, at an arbitrary place; its head distinguishes its ends.
    let lying =
        [block([30.0, 5.0, 7.0], [50.0, 15.0, 17.0]), block([50.0, 2.0, 4.0], [54.0, 18.0, 20.0])].concat();
    let exec = Exec::new();
    let result = sinks([&plate, &lying], [&AxisDirection::ALL, &AxisDirection::ALL], GRAIN, &exec).unwrap();
    let classes = classes(&lying, &result, GRAIN);
    let best = classes[0].best;
    let faces = |fixed: &str, moving: &str, lie: PartLayout| matches!(lie, PartLayout::Facing { fixed: f, moving: m, .. } if f.name() == fixed && m.name() == moving);
    assert!(faces("+z", "-x", best.lie), "{best:?}");
    assert!((best.climb - 12.0).abs() < 1e-3, "{best:?}");
    let middle = (best.lie.turns()[1] * DVec3::new(40.0, 10.0, 12.0)).truncate() + best.offset;
    assert!(middle.abs_diff_eq(DVec2::new(3.0, -2.0), 0.06), "{middle}");
    assert!(
        !classes.iter().any(|class| faces("+z", "+x", class.best.lie) && class.best.steep > 0.4 * best.steep)
    );
    // Without its head either end goes in.
    let plain = block([30.0, 5.0, 7.0], [54.0, 15.0, 17.0]);
    let result = sinks([&plate, &plain], [&AxisDirection::ALL, &AxisDirection::ALL], GRAIN, &exec).unwrap();
    let classes = super::classes(&plain, &result, GRAIN);
    let mut ends: Vec<bool> = classes[..2].iter().map(|class| faces("+z", "+x", class.best.lie)).collect();
    ends.sort_unstable();
    assert_eq!(ends, [false, true]);
    assert!((classes[1].best.steep / classes[0].best.steep - 1.0).abs() < 0.05, "{classes:?}");
}

/// The same plate, drawn at 45 degrees: no axis enters its hole.
#[test]
fn a_pair_drawn_at_45_degrees_sinks_along_a_diagonal() {
    let turned = |part: &Triangles| -> Triangles {
        let by = DMat3::from_rotation_x(std::f64::consts::FRAC_PI_4);
        part.iter().map(|triangle| triangle.map(|p| by * p)).collect()
    };
    let (plate, pin) = (plate(5.3, 12.0, [3.0, -2.0]), pin([0.0, 0.0, 7.0]));
    assert!(diagonals(&plate).is_empty() && diagonals(&pin).is_empty());
    let (plate, pin) = (turned(&plate), turned(&pin));
    let [fixed, moving] = [&plate, &pin].map(diagonals);
    let names: Vec<&str> = fixed.iter().map(|way| way.name()).collect();
    assert_eq!(names, ["+y+z", "-y-z", "+y-z", "-y+z"]);
    let steepest = |facing: [&[AxisDirection]; 2]| {
        sinks([&plate, &pin], facing, GRAIN, &Exec::new()).unwrap().first().copied()
    };
    let result = steepest([&fixed, &moving]).unwrap();
    assert!(matches!(result.lie, PartLayout::Facing { fixed, .. } if fixed.name() == "-y+z"), "{result:?}");
    assert!((result.climb - 12.0).abs() < 0.1, "{result:?}");
    let along_axes = steepest([&AxisDirection::ALL, &AxisDirection::ALL]).map_or(0.0, |sunk| sunk.steep);
    assert!(along_axes < 0.5 * result.steep, "{along_axes} {result:?}");
}

#[test]
fn the_overlap_of_two_parts_is_measured() {
    let fixed = block([0.0; 3], [10.0, 10.0, 10.0]);
    let lapped = together([&fixed, &block([5.0, 5.0, 5.0], [15.0, 15.0, 15.0])], GRAIN);
    assert!((lapped.shared - 0.125).abs() < 0.01 && (lapped.inside - 0.125).abs() < 1e-12, "{lapped:?}");
    let beside = together([&fixed, &block([10.2, 0.0, 0.0], [20.0, 10.0, 10.0])], GRAIN);
    assert!(beside.shared == 0.0 && beside.near > 0.4, "{beside:?}");
    let far = together([&fixed, &block([30.0; 3], [40.0; 3])], GRAIN);
    assert!(far.shared == 0.0 && far.near == 0.0, "{far:?}");
}

/// A shallow basin beside a deep one climbs to the pass between them; the deep one climbs out; a floor that
/// falls off the edge is not a basin.
#[test]
fn basins_climb_to_their_passes() {
    let rows: [[f32; 7]; 3] = [[9.0; 7], [9.0, 1.0, 5.0, 3.0, 9.0, 2.0, NOTHING], [9.0; 7]];
    let result = basins(&rows.concat(), 7, 0.5);
    let printed: Vec<(usize, f32)> = result.iter().map(|basin| (basin.at, basin.climb)).collect();
    assert_eq!(printed, [(8, 8.0), (10, 2.0)]);
}
