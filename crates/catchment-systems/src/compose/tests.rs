//! Closed forms, references and properties of sums.

use super::read::{Measure, ParsedRegion, read};
use super::sweep::{Bracket, SweptShape};
use super::*;
use catchment::design::SourceText;
use catchment::polytope::minkowski_sum_of;
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, TAU};

fn v(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

fn square(side: f64) -> Region {
    Region::rectangle(DVec2::ZERO, DVec2::splat(side))
}

fn sum(a: &Region, b: &Region) -> Region {
    minkowski_sum(a, b).unwrap()
}

fn polygon(corners: &[(f64, f64)]) -> Region {
    Region::of_outlines(&[corners.iter().map(|(x, y)| v(*x, *y)).collect()])
}

fn given(name: &str, region: Region) -> ParsedRegion {
    ParsedRegion {
        name: name.to_owned(),
        region: Bracket::exact(region),
        measure: Measure::Millimetres,
        notes: vec![],
    }
}

fn composed(a: &Region, b: &Region, settings: &ComposeSettings) -> Composition {
    compose([given("a", a.clone()), given("b", b.clone())], None, settings, &Exec::new()).unwrap()
}

fn at(frames: RegionFrames, heading: f64) -> ComposeSettings {
    ComposeSettings { frames, headings: vec![heading], map_cells: 24 }
}

#[test]
fn squares_and_discs_add_up() {
    assert_eq!(sum(&square(1.0), &square(1.0)).area(), 4.0);
    let disc = |radius: f64| SweptShape::Disc { radius }.bracket(DVec2::ZERO, 1e-3);
    let both = disc(3.0).sum(&disc(5.0)).unwrap();
    let [inner, outer] = both.area();
    let exact = PI * 64.0;
    // Each polygon is off by at most the two chord errors all around.
    assert!(inner < exact && exact < outer && outer - inner < 2.0 * 2e-3 * TAU * 8.0, "{inner} {outer}");
    // Convex A: area + perimeter·r + πr².
    let triangle = polygon(&[(0.0, 0.0), (7.0, 1.0), (2.0, 5.0)]);
    let exact = triangle.area() + triangle.perimeter() * 3.0 + PI * 9.0;
    let around = triangle.perimeter() + TAU * 3.0;
    let [inner, outer] = Bracket::exact(triangle).sum(&disc(3.0)).unwrap().area();
    assert!(inner < exact && exact < outer && outer - inner < 2.0 * 1e-3 * around, "{inner} {exact} {outer}");
}

#[test]
fn segments_and_points_add_up() {
    let (a, b) = (Region::segment(v(1.0, 2.0), v(4.0, 3.0)), Region::segment(v(0.0, 0.0), v(-1.0, 5.0)));
    // |(3, 1) × (−1, 5)| = 16.
    assert_eq!((sum(&a, &b).area(), sum(&a, &b).parts()), (16.0, 1));
    let parallel = sum(&a, &Region::segment(DVec2::ZERO, v(6.0, 2.0)));
    assert_eq!((parallel.area(), parallel.bounds()), (0.0, Some([v(1.0, 2.0), v(10.0, 5.0)])));
    assert!(parallel.contains(v(4.0, 3.0)) && !parallel.contains(v(4.0, 3.1)));
    let moved = sum(&square(2.0), &Region::point(v(3.0, -1.0)));
    assert_eq!(moved, Region::rectangle(v(3.0, -1.0), v(5.0, 1.0)));
    assert_eq!(sum(&square(2.0), &Region::segment(DVec2::ZERO, v(3.0, 4.0))).area(), 4.0 + 2.0 * 7.0);
    assert!(sum(&square(2.0), &Region::default()).is_empty());
}

#[test]
fn corners_and_holes_add_up() {
    let corner = polygon(&[(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)]);
    let ring =
        Region::rectangle(v(0.0, 0.0), v(3.0, 3.0)).minus(&Region::rectangle(v(1.0, 1.0), v(2.0, 2.0)));
    assert_eq!(ring.holes(), 1);
    for s in [0.1, 0.25, 0.5, 0.9, 0.999] {
        let area = sum(&corner, &square(s)).area();
        assert!((area - (1.0 + s) * (3.0 + s)).abs() < 1e-8, "{s}: {area}");
        let swept = sum(&ring, &square(s));
        assert!((swept.area() - ((3.0 + s).powi(2) - (1.0 - s).powi(2))).abs() < 1e-8, "{s}");
        assert_eq!((swept.parts(), swept.holes()), (1, 1), "{s}");
    }
    assert_eq!((sum(&corner, &square(0.5)).area(), sum(&ring, &square(0.5)).area()), (5.25, 12.0));
    for s in [1.0, 1.5] {
        assert_eq!((sum(&ring, &square(s)).holes(), sum(&ring, &square(s)).area()), (0, (3.0 + s).powi(2)));
    }
}

/// An L, a hook, a ring with a bay: nothing about them is symmetric.
fn odd_pair() -> [Region; 2] {
    let a = polygon(&[
        (0.0, 0.0),
        (6.0, 0.0),
        (6.0, 1.0),
        (1.5, 1.2),
        (1.0, 4.0),
        (3.0, 4.5),
        (2.5, 5.5),
        (0.0, 5.0),
    ]);
    let b = polygon(&[(-1.0, 1.0), (2.0, 1.0), (2.5, 3.0), (0.5, 2.0), (0.0, 4.0)]);
    let hole = polygon(&[(0.1, 0.3), (0.4, 0.3), (0.3, 3.0)]);
    [a.minus(&hole), b]
}

#[test]
fn own_and_world_frames_agree_after_a_half_turn_of_the_file() {
    let [a, b] = odd_pair();
    for heading in [0.0, 0.3, -1.0] {
        let own = composed(&a, &b, &at(RegionFrames::Own, heading));
        let world = composed(&a, &b.turned(PI), &at(RegionFrames::World, heading));
        let (own, world) = (&own.slices[0].region.inner, &world.slices[0].region.inner);
        assert!(own.minus(world).area() + world.minus(own).area() < 1e-7);
        // Without the reflection it is another region altogether.
        let forgotten = sum(&a, &b.turned(PI).turned(heading));
        assert!(own.minus(&forgotten).area() > 1.0, "{heading}");
    }
}

/// The next number of a fixed sequence in [0, 1).
fn dice(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

#[test]
fn a_place_is_in_the_sum_exactly_where_the_regions_meet() {
    let [a, b] = odd_pair();
    for frames in [RegionFrames::Own, RegionFrames::World] {
        let result = composed(&a, &b, &at(frames, 0.4));
        let region = &result.slices[0].region.inner;
        // As it stands before A.
        let stands = b.turned(if frames == RegionFrames::Own { PI + 0.4 } else { 0.4 });
        let [low, high] = region.bounds().unwrap();
        let (mut state, mut inside, mut outside) = (7, 0, 0);
        for _ in 0..50_000 {
            let d = low + (high - low) * v(dice(&mut state), dice(&mut state)) * 1.1 - (high - low) * 0.05;
            let meets = brute::meet(&a, &stands.mapped(|p| p + d));
            assert_eq!(region.contains(d), meets, "{frames:?} {d}");
            if meets { inside += 1 } else { outside += 1 }
        }
        assert!(inside > 10_000 && outside > 5_000, "{inside} {outside}");
    }
}

#[test]
fn the_overlap_is_a_convolution() {
    let [a, b] = odd_pair();
    let result = composed(&a, &b, &ComposeSettings { map_cells: 200, ..at(RegionFrames::World, 0.2) });
    let integral: f64 = result.map.values.iter().sum::<f64>() * result.map.cell * result.map.cell;
    let exact = a.area() * b.area();
    assert!((integral - exact).abs() < 1e-3 * exact, "{integral} {exact}");
    let region = &result.slices[0].region.inner;
    for (k, value) in result.map.values.iter().enumerate() {
        let cell = v((k % result.map.cells[0]) as f64 + 0.5, (k / result.map.cells[0]) as f64 + 0.5);
        let d = result.map.low + cell * result.map.cell;
        assert!(*value < 1e-12 || region.contains(d), "{d}: {value}");
        assert!(*value <= a.area().min(b.area()) + 1e-9);
    }
    // Two unit squares overlap as a product of tents.
    let squares = RegionOverlap::new(&square(1.0), &square(1.0));
    for (x, y) in [(0.0, 0.0), (0.25, -0.5), (-0.9, 0.3), (1.0, 0.0), (1.5, 0.2)] {
        let tent = |t: f64| (1.0 - f64::abs(t)).max(0.0);
        assert!((squares.at(v(x, y)) - tent(x) * tent(y)).abs() < 1e-12);
    }
}

#[test]
fn bodies_are_kept_apart() {
    // Reaches of radius 5 about robots that are squares of side 2: a disc of 10 without a square of side 4.
    let reach = SweptShape::Disc { radius: 5.0 }.bracket(DVec2::ZERO, 1e-3);
    let read = |name: &str, region: &Bracket| ParsedRegion {
        region: region.clone(),
        ..given(name, Region::default())
    };
    let body = Bracket::exact(Region::rectangle(v(-1.0, -1.0), v(1.0, 1.0)));
    let halves = [read("a", &reach), read("b", &reach)];
    let bodies = Some([read("c", &body), read("d", &body)]);
    let result = compose(
        halves,
        bodies,
        &ComposeSettings { map_cells: 8, ..ComposeSettings::default() },
        &Exec::new(),
    )
    .unwrap();
    let region = &result.slices[0].region;
    let exact = PI * 100.0 - 16.0;
    assert!(region.inner.area() < exact && exact < region.outer.area() && region.inner.holes() == 1);
    assert!(!region.inner.contains(v(1.9, 0.0)) && region.inner.contains(v(2.0, 0.0)));
    assert_eq!(result.square_about_zero, None);
}

#[test]
fn a_stack_of_headings_has_a_volume() {
    // A segment of length 2 with a segment of length 3: area 6 |sin ψ|, over a quarter turn ∫ = 6.
    let (a, b) = (Region::segment(v(-1.0, 0.0), v(1.0, 0.0)), Region::segment(v(-1.5, 0.0), v(1.5, 0.0)));
    let headings: Vec<f64> = (0..=90).map(|k| f64::from(k) * FRAC_PI_2 / 90.0).collect();
    let result = composed(&a, &b, &ComposeSettings { headings, ..at(RegionFrames::World, 0.0) });
    let [inner, outer] = result.volume.unwrap();
    // The trapezoidal rule is off by at most h²/12 · (b − a) · 6.
    let most = (FRAC_PI_2 / 90.0).powi(2) / 12.0 * FRAC_PI_2 * 6.0;
    assert!(inner == outer && (inner - 6.0).abs() < most, "{inner}");
    assert_eq!(result.slices[result.shown].heading, 0.0);
}

#[test]
fn hook_and_loop_agree_with_random_places() {
    let hook = SweptShape::AnnularSector { inner: 100.0, outer: 160.0, from: -FRAC_PI_3, to: FRAC_PI_3 };
    let string = SweptShape::HalfEllipse { half_width: 100.0, reach: 120.0 };
    let [a, b] = [hook, string].map(|shape| shape.bracket(DVec2::ZERO, 0.01));
    let both = a.sum(&b).unwrap();
    let [inner, outer] = both.area();
    assert!(outer - inner < 2e-4 * inner);
    // Whether d meets, from the definitions of the two shapes: some point of the ring lies in the half ellipse about d.
    let meets = |d: DVec2| {
        (0..=240).any(|i| {
            let angle = -FRAC_PI_3 + TAU / 3.0 * f64::from(i) / 240.0;
            (0..=60).any(|j| {
                let p = DVec2::from_angle(angle + FRAC_PI_2) * (100.0 + f64::from(j));
                // −(turned L) = L: p ∈ −L + d ⇔ d − p ∈ L.
                let q = d - p;
                q.y >= 0.0 && (q / v(100.0, 120.0)).length_squared() <= 1.0
            })
        })
    };
    let [low, high] = both.outer.bounds().unwrap();
    let (mut state, mut hits) = (3, 0u32);
    let draws = 20_000;
    for _ in 0..draws {
        hits += u32::from(meets(low + (high - low) * v(dice(&mut state), dice(&mut state))));
    }
    let size = (high - low).x * (high - low).y;
    let (result, share) = (f64::from(hits) / f64::from(draws) * size, inner / size);
    // Four standard deviations of the draws; the grid of points misses less than that.
    let slack = 4.0 * size * (share * (1.0 - share) / f64::from(draws)).sqrt();
    assert!(slack < 0.02 * inner && (result - inner).abs() < slack, "{result} {inner} ± {slack}");
}

#[test]
fn the_shipped_example_is_the_one_of_the_page() {
    let file = |name: &str| {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs/systems").join(name);
        let text = std::fs::read_to_string(&path).unwrap();
        read(SourceText::new(path, text), &Exec::new()).unwrap()
    };
    let [hook, string] = [file("hook.toml"), file("loop.toml")];
    let brackets = |read: &ParsedRegion, exact: f64| {
        read.region.inner.area() < exact && exact < read.region.outer.area()
    };
    assert!(brackets(&hook, PI / 3.0 * (160f64.powi(2) - 100f64.powi(2))));
    assert!(brackets(&string, PI * 6000.0));
    let boats = Some([file("boat.toml"), file("boat.toml")]);
    let result = compose([hook, string], boats, &ComposeSettings::default(), &Exec::new()).unwrap();
    let printed = report(&result);
    assert!(printed.table().lines().all(|line| line.chars().count() <= 80), "{}", printed.table());
    assert!(figure(&result).unwrap().png(1.0).unwrap().len() > 1000);
    // The written files are read back, to the last digit.
    let svg = read(SourceText::new("sum.svg", outline_svg(&result)), &Exec::new()).unwrap();
    let table = catchment::report::csv(&printed.records()).unwrap();
    let table = read(SourceText::new("sum.csv", String::from_utf8(table).unwrap()), &Exec::new()).unwrap();
    let inner = result.slices[0].region.inner.area();
    // Corners of the drawing are rounded by a scale factor of 1.
    assert!((svg.region.inner.area() - inner).abs() < 1e-4, "{}", svg.region.inner.area());
    assert!((table.region.inner.area() - inner).abs() < 1e-7);
}

/// Unit cells of the plane.
type Cells = BTreeSet<(i32, i32)>;

fn of_cells(cells: &Cells) -> Region {
    let unit = |(i, j): &(i32, i32)| {
        let low = v(f64::from(*i), f64::from(*j));
        Region::rectangle(low, low + 1.0)
    };
    Region::union(&cells.iter().map(unit).collect::<Vec<_>>())
}

fn cells() -> impl Strategy<Value = Cells> {
    proptest::collection::btree_set((-3..4i32, -3..4i32), 1..14)
}

fn stars() -> impl Strategy<Value = Region> {
    proptest::collection::vec(1.0..6.0f64, 3..9).prop_map(|radii| {
        let n = radii.len() as f64;
        let corner = |(k, r): (usize, f64)| DVec2::from_angle(TAU * k as f64 / n + 0.1) * r;
        Region::of_outlines(&[radii.into_iter().enumerate().map(corner).collect()])
    })
}

fn apart(a: &Region, b: &Region) -> f64 {
    a.minus(b).area() + b.minus(a).area()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The raster of the sum of two sets of cells is known: cell (i, j) and cell (k, l) fill the square of side 2 at (i + k, j + l).
    #[test]
    fn sets_of_cells_add_up_as_rasters(a in cells(), b in cells()) {
        let mut raster = Cells::new();
        for (i, j) in &a {
            for (k, l) in &b {
                raster.extend([(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| (i + k + x, j + l + y)));
            }
        }
        let result = sum(&of_cells(&a), &of_cells(&b));
        prop_assert_eq!(result.area(), raster.len() as f64);
        prop_assert_eq!(apart(&result, &of_cells(&raster)), 0.0);
        prop_assert_eq!(apart(&result, &brute::minkowski_sum(&of_cells(&a), &of_cells(&b))), 0.0);
    }

    #[test]
    fn sums_commute_move_along_and_grow(a in stars(), b in stars(), c in stars(), x in -5.0..5.0f64, y in -5.0..5.0f64) {
        let ab = sum(&a, &b);
        prop_assert!(apart(&ab, &sum(&b, &a)) < 1e-7);
        prop_assert!(apart(&ab, &brute::minkowski_sum(&a, &b)) < 1e-7);
        let d = v(x, y);
        prop_assert!(apart(&sum(&a.mapped(|p| p + d), &b), &ab.mapped(|p| p + d)) < 1e-7);
        let more = sum(&Region::union([&a, &c]), &b);
        prop_assert!(ab.minus(&more).area() < 1e-7);
    }

    /// Convex sets: the room of polytopes knows their sum, too.
    #[test]
    fn convex_sums_are_those_of_the_polytopes(
        a in proptest::collection::vec((-3.0..3.0f64, -3.0..3.0f64), 3..8),
        b in proptest::collection::vec((-3.0..3.0f64, -3.0..3.0f64), 3..8),
    ) {
        let point = |(x, y): &(f64, f64)| [*x, *y, 0.0, 0.0, 0.0, 0.0];
        let points = [&a, &b].map(|set| set.iter().map(point).collect::<Vec<_>>());
        let hull = |set: &[(f64, f64)]| {
            let nodes: Vec<region::Node> = set.iter().map(|(x, y)| region::node(v(*x, *y))).collect();
            Region::of_nodes(&[super::sum::convex_sum(&nodes, &[region::Node::new(0, 0)])])
        };
        let (ours, theirs) = (sum(&hull(&a), &hull(&b)), minkowski_sum_of(2, &points[0], &points[1]));
        // Both round corners: to 2⁻³² here, to 2⁻⁴⁰ there.
        prop_assume!(hull(&a).area() > 1e-3 && hull(&b).area() > 1e-3);
        let volume = theirs.map_or(0.0, |polytope| polytope.volume());
        prop_assert!((ours.area() - volume).abs() < 1e-7, "{} {volume}", ours.area());
    }
}

#[test]
fn a_connectors_region_and_a_square_add_up() {
    let pyramid = "[connector]\nfamily = \"pyramid\"\nwidth = 40.0\nunit = \"mm\"\n[alignment]\nfree = [\"x\", \"y\"]\n";
    let read = |text: &str| read(SourceText::new("p.toml", text), &Exec::new()).unwrap();
    let connector = read(pyramid);
    let small = square(10.0).mapped(|p| p - 5.0);
    let result =
        compose([connector.clone(), given("square", small)], None, &at(RegionFrames::Own, 0.0), &Exec::new())
            .unwrap();
    let region = &connector.region.inner;
    // A convex set and a square of side s: area + width along y·s + width along x·s + s².
    let [low, high] = region.bounds().unwrap();
    let exact = region.area() + 10.0 * ((high - low).x + (high - low).y) + 100.0;
    let area = result.slices[0].region.inner.area();
    assert!((area - exact).abs() < 1e-5 && region.area() > 100.0, "{area} {exact}");
    let bare = read("[connector]\nfamily = \"v-face\"\n");
    assert_eq!(bare.measure, Measure::Widths);
    let refused = compose([connector, bare], None, &ComposeSettings::default(), &Exec::new()).unwrap_err();
    assert!(refused.to_string().contains("the units are mixed"), "{refused}");
}

#[test]
fn file_defects_are_reported_in_their_places() {
    let error_of = |name: &str, text: &str| match read(SourceText::new(name, text), &Exec::new()) {
        Ok(_) => "nothing".to_owned(),
        Err(error) => error.to_string(),
    };
    for (text, expected) in [
        ("x,y\n0,0\n2,2\n2,0\n0,2\n", "a.csv:4:1: the outline crosses itself"),
        ("x,y\n0,0\n1,0\n", "a.csv:2:1: the ring is open: it has 2 different corners"),
        ("x,y\n0,0\n1,0\n2,0\n", "the outline runs back along itself"),
        ("x,y\n0,0\n1,nan\n0,1\n", "a.csv:3:3: "),
        ("x,y\n0,0\n1 mm,0\n0,1\n", "a.csv:3:1: the units are mixed: `1 mm` has one of its own"),
        ("x [mm],y [cm]\n0,0\n1,0\n0,1\n", "a.csv:1:1: the units are mixed: x is in mm and y in cm"),
        ("x,y,ring\n0,0,1\n1,0,1\n5,5,2\n0,1,1\n", "a.csv:5:1: ring `1` was left open"),
        ("x,y,ring\n0,0,1\n4,0,1\n0,4,1\n1,1,2\n9,1,2\n1,2,2\n", "two rings cross"),
        ("x,z\n0,0\n", "unknown column `z`"),
        ("", "the table is empty"),
        ("x,y\n0,0\n1,0\n0,1e9\n", "farther from the origin"),
    ] {
        assert!(error_of("a.csv", text).contains(expected), "{text:?}: {}", error_of("a.csv", text));
    }
    let corners = |count: usize| "x,y\n".to_owned() + &"0,0\n".repeat(count);
    assert!(error_of("a.csv", &corners(10_001)).contains("the outline has more than 10000 corners"));
    assert!(error_of("a.csv", &corners(10_000)).contains("the ring is open"));
    let deep = |count: usize| {
        format!("<svg>{}<path d=\"M0 0L1 0L0 1Z\"/>{}</svg>", "<g>".repeat(count), "</g>".repeat(count))
    };
    assert_eq!(error_of("a.svg", &deep(254)), "nothing");
    assert!(error_of("a.svg", &deep(255)).contains("more than 256 elements within each other"));
    for (text, expected) in [
        ("<svg><path d=\"M0 0L1 0L0 1\"/></svg>", "is open"),
        ("<svg><path d=\"M0 0L2 2L2 0L0 2Z\"/></svg>", "crosses itself"),
        ("<svg><path d=\"M0 0Lx\"/></svg>", "the path cannot be read"),
        ("<svg><rect width=\"3\"/></svg>", "a.svg:1:6: <rect> is not read"),
        ("<svg><g transform=\"rotate(3)\"><path d=\"M0 0L1 0L0 1Z\"/></g></svg>", "a transform is not read"),
        ("<svg>", "this is no SVG picture: it was cut off"),
        ("<svg/>", "the picture has no path"),
        ("<svg><path d=\"M0 0A1e300 1e300 0 0 1 9 9Z\"/></svg>", "far too large"),
        ("<svg><path d=\"M0 0L12345678901 0L0 1Z\"/></svg>", "far too large"),
    ] {
        assert!(error_of("a.svg", text).contains(expected), "{text:?}: {}", error_of("a.svg", text));
    }
    for (text, expected) in [
        ("name = 'x'", "neither [sweep] nor [connector]"),
        ("[sweep]", "`sweep.shape` is missing"),
        ("[sweep]\nshape = 'dsic'", "did you mean \"disc\"?"),
        ("[sweep]\nshape = 'disc'\nradius = '3 deg'", "an angle where a length is wanted"),
        ("[sweep]\nshape = 'disc'\nradius = nan", "`sweep.radius`"),
        ("[sweep]\nshape = 'polygon'\nx = [0, 1, 1, 0]\ny = [0, 1, 0, 1]", "the polygon crosses itself"),
        (
            "[sweep]\nshape = 'annular-sector'\nouter_radius = 3\nfrom = 1\nto = 0.5",
            "`to` must be larger than `from`",
        ),
    ] {
        assert!(error_of("a.toml", text).contains(expected), "{text:?}: {}", error_of("a.toml", text));
    }
    assert!(error_of("a.dxf", "").contains("a region is read from .csv, .svg or .toml"));
}

#[test]
fn a_picture_in_centimetres_with_curves_is_read_in_millimetres() {
    let text = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"4cm\" viewBox=\"0 0 8 8\">\
                <path d=\"M0 0 A 4 4 0 0 1 8 0 Z M 3 -1 h 1 v -1 h -1 z\"/></svg>";
    let result = read(SourceText::new("a.svg", text), &Exec::new()).unwrap();
    // A half disc of radius 20 mm without a square of 5 mm, within the chord error along the arc.
    let exact = PI * 200.0 - 25.0;
    assert!(
        (result.region.inner.area() - exact).abs() < 2.0 * 0.01 * PI * 20.0,
        "{}",
        result.region.inner.area()
    );
    assert_eq!((result.region.inner.holes(), result.notes.len()), (1, 1));
    assert!(result.region.inner.contains(v(20.0, 15.0)), "up the page is +y");
}
