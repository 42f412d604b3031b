//! What is known of published areas beside the printed number: shapes, our computations, our readings, contradictions.

use super::data::{Source, System};
use serde::Serialize;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4, PI, SQRT_2};

/// Where a number comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Provenance {
    /// The dissertation states it.
    #[serde(rename = "D")]
    Stated,
    /// Computed here from what it states.
    #[serde(rename = "R")]
    Recomputed,
    /// Our reading: nothing that is stated says so.
    #[serde(rename = "I")]
    Inferred,
}

impl Provenance {
    /// Its mark.
    pub const fn mark(self) -> &'static str {
        match self {
            Self::Stated => "[D]",
            Self::Recomputed => "[R]",
            Self::Inferred => "[I]",
        }
    }
}

/// A number with its provenance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Number {
    /// What it measures.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// `D²`, `D` or `%`.
    pub unit: &'static str,
    /// Where it comes from.
    pub provenance: Provenance,
    /// What it rests on.
    pub basis: String,
}

/// A zero-rotation area of acceptance with a closed form, in D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A disc of this radius.
    Disc(f64),
    /// An axis-parallel square of this edge.
    Square(f64),
    /// |x| + |y| below this.
    Diamond(f64),
}

impl Shape {
    /// Its area, in D².
    pub fn area(self) -> f64 {
        match self {
            Self::Disc(radius) => PI * radius * radius,
            Self::Square(edge) => edge * edge,
            Self::Diamond(reach) => 2.0 * reach * reach,
        }
    }

    /// Edge of the largest axis-parallel square inside, in D.
    pub fn onaa(self) -> f64 {
        match self {
            Self::Disc(radius) => SQRT_2 * radius,
            Self::Square(edge) => edge,
            Self::Diamond(reach) => reach,
        }
    }
}

/// What is known of a system beside its printed area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fact {
    /// Its name in the catalogue.
    pub system: &'static str,
    /// Its region, where the geometry is given, or where nothing but the number is and the region is a reading.
    pub shape: Option<(Shape, Provenance)>,
    /// What the shape rests on.
    pub basis: &'static str,
    /// The ONAA that the dissertation states, in D.
    pub onaa: Option<f64>,
    /// What contradicts it, or is open.
    pub doubt: Option<&'static str>,
}

/// A pin of radius 2 mm on a face of 50 mm.
const POLYBOT_REACH: f64 = 2.0 / 50.0;
/// The printed area of DRAGON, in D².
const DRAGON_AREA: f64 = 0.353;
/// The lateral reach that is stated for DRAGON: a fifth of the diameter.
const DRAGON_REACH: f64 = 1.0 / 5.0;
/// Radius of the circle around a square of edge 1.
const AROUND: f64 = FRAC_1_SQRT_2;

const fn read(system: &'static str, shape: Option<(Shape, Provenance)>, basis: &'static str) -> Fact {
    Fact { system, shape, basis, onaa: None, doubt: None }
}

/// What is known of the systems with published areas.
pub const GEOMETRY: [Fact; 13] = [
    Fact {
        doubt: Some("the text names its cone as the first dock that aligns itself in three dimensions"),
        ..read("CEBOT Mark II", None, "")
    },
    read("GENFA Connector", None, ""),
    Fact {
        doubt: Some("the chamfers of the holes are not counted in the printed number"),
        ..read(
            "Polybot G3",
            Some((Shape::Disc(POLYBOT_REACH), Provenance::Recomputed)),
            "4 pairs of pins and holes, pins 4 mm across on a face of 50 mm: a circle of the pin's radius",
        )
    },
    Fact {
        doubt: Some(
            "the degree None is printed beside an area: what corrects it acts, and the degree counts what needs no \
             action [I]",
        ),
        ..read(
            "M-TRAN III",
            Some((Shape::Square(1.0 / 13.0), Provenance::Inferred)),
            "a square of edge 1/13 agrees to three digits: 5 mm on a module of 65 mm",
        )
    },
    Fact {
        doubt: Some("the same number is printed for M-TRAN III; no geometry is given for either"),
        ..read(
            "JHU",
            Some((Shape::Square(1.0 / 13.0), Provenance::Inferred)),
            "a square of edge 1/13 agrees to three digits",
        )
    },
    Fact {
        doubt: Some(
            "marked as an estimate; the degree None is printed beside it: what corrects it acts, and the degree counts \
             what needs no action [I]",
        ),
        ..read("I-Cubes", None, "")
    },
    Fact {
        doubt: Some(
            "marked as an estimate; by the rule its degree would be High (0.206 of the face), Low is printed",
        ),
        ..read("CONRO", None, "")
    },
    Fact {
        doubt: Some(
            "1/18 = 0.05556 is near the printed number but rounds to 0.0556; no geometry is given [I]",
        ),
        ..read("Vacuubes", None, "")
    },
    read(
        "ACOR (unpaired)",
        Some((Shape::Square(4.0 / 15.0), Provenance::Inferred)),
        "a square of edge 4/15 agrees to three digits",
    ),
    Fact {
        doubt: Some("concave and shaped like an X, the text says: only a small square fits its middle"),
        ..read("SINGO", None, "")
    },
    Fact {
        onaa: Some(0.474),
        doubt: Some(
            "the text gives 15 mm = Ø/5 as lateral reach, a circle of 0.1257 D² where 0.353 is printed; area and \
             ONAA agree with each other (√2 · 0.3352 = 0.474), and neither with Ø/5; 45° of rotation, also stated, is half \
             the period of four pairs and consistent",
        ),
        ..read(
            "DRAGON",
            None,
            "the circle of the printed area: calculated back from the number, not from geometry",
        )
    },
    Fact {
        onaa: Some(1.0),
        doubt: Some(
            "the number takes the cone that circumscribes the unit square (Ø √2); the one inscribed in it \
             accepts π/4 = 0.7854 D² with an ONAA of 0.7071 D",
        ),
        ..read(
            "amour",
            Some((Shape::Disc(AROUND), Provenance::Recomputed)),
            "probe and drogue around the unit square: a circle of radius √2/2",
        )
    },
    Fact {
        onaa: Some(1.0),
        ..read(
            "3-D X-Face",
            Some((Shape::Diamond(1.0), Provenance::Recomputed)),
            "the saddle accepts |x| + |y| < D",
        )
    },
];

impl Fact {
    /// Of a row of the catalogue.
    pub fn of(system: &System) -> Option<&'static Self> {
        if system.source == Source::Appended {
            return None;
        }
        GEOMETRY.iter().find(|fact| fact.system == system.name)
    }
}

/// Every number that is known of a system's zero-rotation area, each with where it comes from.
pub fn numbers(system: &System) -> Vec<Number> {
    let mut found = Vec::new();
    let mut add = |name, value, unit, provenance, basis: &str| {
        found.push(Number { name, value, unit, provenance, basis: basis.to_owned() });
    };
    if let Some(zraa) = &system.published {
        let place = if system.source == Source::Section412 { "section 4.1.2" } else { "table 2.1" };
        let basis = if zraa.estimated { format!("{place}, marked as estimated") } else { place.to_owned() };
        add("area", zraa.area_d2, "D²", Provenance::Stated, &basis);
        add("radius", (zraa.area_d2 / PI).sqrt(), "D", Provenance::Recomputed, "of the circle of that area");
        add("edge", zraa.area_d2.sqrt(), "D", Provenance::Recomputed, "of the square of that area");
    }
    if let Some(area) = system.computed {
        add("area", area, "D²", Provenance::Recomputed, "of the design");
    }
    let Some(fact) = Fact::of(system) else { return found };
    if let Some(onaa) = fact.onaa {
        add("ONAA", onaa, "D", Provenance::Stated, "section 4.1.2");
    }
    if let Some((shape, provenance)) = fact.shape {
        add("area", shape.area(), "D²", provenance, fact.basis);
        add("ONAA", shape.onaa(), "D", provenance, "of that region");
    }
    match fact.system {
        "DRAGON" => {
            let circle = Shape::Disc((DRAGON_AREA / PI).sqrt());
            add("ONAA", circle.onaa(), "D", Provenance::Recomputed, fact.basis);
            let stated = Shape::Disc(DRAGON_REACH);
            add("area", stated.area(), "D²", Provenance::Recomputed, "of a circle of the stated reach, Ø/5");
        }
        "amour" => {
            add("area", FRAC_PI_4, "D²", Provenance::Recomputed, "of the cone inscribed in the unit square");
            add(
                "ONAA",
                FRAC_1_SQRT_2,
                "D",
                Provenance::Recomputed,
                "of the cone inscribed in the unit square",
            );
        }
        "3-D X-Face" => {
            let more = |own: f64, other: f64| 100.0 * (own / other - 1.0);
            add("more area", more(2.0, FRAC_PI_2), "%", Provenance::Recomputed, "than amour; 27 % is stated");
            add(
                "more area",
                more(2.0, DRAGON_AREA),
                "%",
                Provenance::Recomputed,
                "than DRAGON; 467 % is stated",
            );
            add("more ONAA", more(1.0, 0.474), "%", Provenance::Recomputed, "than DRAGON; 111 % is stated");
        }
        _ => {}
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::{Catalog, Table};
    use super::*;
    use catchment::design::family::PinHole;
    use catchment::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
    use catchment::exec::Exec;
    use catchment::method::zraa::{Settings, Square, Zraa, circle_bounds, circle_square, run};
    use catchment::problem::Problem;

    fn fact(name: &str) -> Fact {
        *GEOMETRY.iter().find(|fact| fact.system == name).unwrap()
    }

    fn published(name: &str) -> f64 {
        Catalog::published().unwrap().find(name).unwrap().area().unwrap()
    }

    /// The exact area of acceptance of a family, with its square.
    fn computed(spec: FamilySpec) -> (Design, Zraa, Square) {
        let mut alignment = Alignment::default_for(Some(spec.family()));
        alignment.free = alignment.free.iter().filter(|dof| !dof.is_rotation()).collect();
        let connector = ConnectorSpec::Family(spec);
        let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
        let problem = Problem::of(design.clone()).unwrap();
        let zraa = run(problem.pair(), &Settings::default(), &Exec::new()).unwrap();
        let square = Square::of(&zraa, &Exec::new()).unwrap();
        (design, zraa, square)
    }

    fn area(zraa: &Zraa) -> f64 {
        match zraa {
            Zraa::Region { area, .. } => *area,
            Zraa::Interval { from, to, .. } => to - from,
        }
    }

    #[test]
    fn every_published_area_has_its_line() {
        let catalog = Catalog::published().unwrap();
        assert_eq!(catalog.systems.iter().filter(|s| Fact::of(s).is_some()).count(), GEOMETRY.len());
        // CEBOT is only named.
        let known = |s: &System| s.published.is_some() || s.name == "CEBOT Mark II";
        assert!(catalog.systems.iter().all(|s| known(s) == Fact::of(s).is_some()));
        assert_eq!(String::from_utf8(catalog.as_printed(Table::Zraa).unwrap()).unwrap().lines().count(), 12);
    }

    /// What each area is as a circle and as a square, to the printed digits.
    #[test]
    fn circles_and_squares_of_the_printed_areas() {
        for (name, radius, edge) in [
            ("GENFA", 0.03352, 0.05941),
            ("Polybot", 0.04001, 0.07092),
            ("M-TRAN III", 0.04341, 0.07694),
            ("JHU", 0.04341, 0.07694),
            ("I-Cubes", 0.0772, 0.1367),
            ("CONRO", 0.1163, 0.2062),
            ("Vacuubes", 0.1329, 0.2356),
            ("ACOR", 0.1504, 0.2666),
            ("SINGO", 0.3121, 0.5532),
            ("DRAGON", 0.3352, 0.5941),
            ("amour", 0.7069, 1.2530),
        ] {
            let catalog = Catalog::published().unwrap();
            let numbers = numbers(catalog.find(name).unwrap());
            let value = |wanted: &str| numbers.iter().find(|n| n.name == wanted).unwrap().value;
            // Half a unit of the last digit of the coarser ones.
            assert!((value("radius") - radius).abs() < 5.1e-5, "{name}: {}", value("radius"));
            assert!((value("edge") - edge).abs() < 5.1e-5, "{name}: {}", value("edge"));
        }
    }

    #[test]
    fn where_the_geometry_is_given_the_area_agrees_within_two_per_mille() {
        for name in ["Polybot G3", "amour", "3-D X-Face"] {
            let (shape, provenance) = fact(name).shape.unwrap();
            assert_eq!(provenance, Provenance::Recomputed);
            assert!((shape.area() / published(name) - 1.0).abs() < 0.002, "{name}: {}", shape.area());
        }
        // Within half a unit of the third printed digit.
        for (name, half_a_unit) in [("M-TRAN III", 5e-6), ("JHU", 5e-6), ("ACOR (unpaired)", 5e-5)] {
            let (shape, provenance) = fact(name).shape.unwrap();
            assert_eq!(provenance, Provenance::Inferred);
            assert!((shape.area() - published(name)).abs() < half_a_unit, "{name}: {}", shape.area());
        }
        // 1/18 misses by a little more than that.
        let off = (1.0 / 18.0 - published("Vacuubes")).abs();
        assert!(off > 5e-5 && off < 6e-5, "{off}");
    }

    #[test]
    fn closed_forms_are_what_the_program_computes() {
        // The saddle and the pyramid are polygons: exact.
        let (_, zraa, square) = computed(FamilySpec::new(Family::XFace3d));
        assert!((area(&zraa) - Shape::Diamond(1.0).area()).abs() < 1e-9);
        assert!((square.edge - 1.0).abs() < Square::TOLERANCE);
        let (_, zraa, square) = computed(FamilySpec::new(Family::Pyramid));
        assert!((area(&zraa) - 1.0).abs() < 1e-9 && (square.edge - 1.0).abs() < Square::TOLERANCE);
        // The cone has width 1; the one around the unit square is √2 as wide.
        for chord_error in [0.004, 0.001] {
            let (design, zraa, square) =
                computed(FamilySpec::new(Family::Cone).with_chord_error(chord_error));
            let [low, high] = circle_bounds(&design, &zraa).unwrap();
            let [less, more] = circle_square(&design, &zraa, &square).unwrap();
            let (inscribed, around) = (Shape::Disc(0.5), Shape::Disc(AROUND));
            assert!(low <= inscribed.area() && inscribed.area() <= high);
            assert!(
                less <= inscribed.onaa() + Square::TOLERANCE && inscribed.onaa() <= more,
                "{less} {more}"
            );
            assert!(2.0 * low <= around.area() && around.onaa() <= SQRT_2 * more);
            assert!(high / low - 1.0 < 5.0 * chord_error);
        }
        let fine = FamilySpec::new(Family::Cone).with_chord_error(0.0004);
        let (_, zraa, square) = computed(fine);
        assert!((2.0 * area(&zraa) / published("amour") - 1.0).abs() < 0.002);
        assert!((SQRT_2 * square.edge - 1.0).abs() < 0.002);
    }

    /// One pin with its hole: what a ring of them accepts without rotation, each pair for itself.
    #[test]
    fn a_pin_of_polybot_accepts_the_circle_of_its_radius() {
        let (clearance, chamfer) = (0.002, 0.019);
        let chord_error = 0.0001;
        let radius = POLYBOT_REACH;
        let pins = PinHole {
            pins: 1,
            circle_radius: 0.0,
            pin_radius: radius,
            clearance,
            chamfer,
            chord_error,
            ..PinHole::DEFAULT
        };
        assert!((clearance + 2.0 * chamfer - radius).abs() < 1e-12);
        let (_, zraa, square) = computed(pins.into());
        assert!((area(&zraa) / published("Polybot") - 1.0).abs() < 0.01, "{}", area(&zraa));
        assert!((square.edge - 0.0566).abs() < 5e-4, "{square:?}");
    }

    #[test]
    fn planar_faces_have_twice_their_bound() {
        for (family, bound) in [(Family::SFace, 1.0 / 3.0), (Family::VFace, 0.5), (Family::XFace, 1.0)] {
            let (_, _, square) = computed(FamilySpec::new(family));
            assert!((square.edge - 2.0 * bound).abs() < 1e-9, "{family:?}: {square:?}");
        }
    }

    #[test]
    fn stated_edges_and_ratios_come_out_to_their_digits() {
        assert!((Shape::Disc(AROUND).onaa() - 1.0).abs() < 1e-12);
        assert!((Shape::Disc(0.5).onaa() - FRAC_1_SQRT_2).abs() < 1e-12);
        assert!((Shape::Disc(POLYBOT_REACH).onaa() - 0.0566).abs() < 5e-5);
        assert!((Shape::Disc(POLYBOT_REACH).area() - 0.005_027).abs() < 5e-7);
        let catalog = Catalog::published().unwrap();
        let of = |name: &str| numbers(catalog.find(name).unwrap());
        let ratios: Vec<f64> = of("X-Face").iter().filter(|n| n.unit == "%").map(|n| n.value).collect();
        for (ratio, (fine, stated)) in ratios.iter().zip([(27.3, 27.0), (467.0, 467.0), (111.0, 111.0)]) {
            assert!((ratio - fine).abs() < 0.5 && (ratio.round() - stated).abs() < 1e-9, "{ratio}");
        }
        assert!((ratios[0] - 27.3).abs() < 0.05);
        let dragon = of("DRAGON");
        let computed = |name| {
            let is = |n: &&Number| n.name == name && n.provenance == Provenance::Recomputed;
            dragon.iter().find(is).unwrap().value
        };
        // Area and ONAA agree with each other and not with the stated reach.
        assert!((computed("ONAA") - 0.474).abs() < 5e-4);
        assert!((computed("area") - 0.1257).abs() < 5e-5);
    }
}
