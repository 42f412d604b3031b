//! Facts about published areas besides the printed number: shapes, our computations, our readings,
//! contradictions.

use super::data::{RowSource, System};
use serde::Serialize;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4, PI, SQRT_2};

/// Provenance of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Provenance {
    /// The dissertation states it.
    #[serde(rename = "D")]
    Stated,
    /// Computed here from stated numbers.
    #[serde(rename = "R")]
    Recomputed,
    /// Our reading; not stated in the source.
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Number {
    /// Name of the quantity.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// `D²`, `D` or `%`.
    pub unit: &'static str,
    /// Provenance of the number.
    pub provenance: Provenance,
    /// Basis of the number.
    pub basis: String,
}

/// A zero-rotation area of acceptance with a closed form, in D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AcceptanceShape {
    /// A disc of this radius.
    Disc(f64),
    /// An axis-parallel square of this edge.
    Square(f64),
    /// |x| + |y| below this.
    Diamond(f64),
}

impl AcceptanceShape {
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

/// Facts about a system besides its printed area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fact {
    /// Its name in the catalogue.
    pub system: &'static str,
    /// Its region, if the geometry is given, or if only the number is given and the region is a reading.
    pub shape: Option<(AcceptanceShape, Provenance)>,
    /// Basis of the shape.
    pub basis: &'static str,
    /// The ONAA that the dissertation states, in D.
    pub onaa: Option<f64>,
    /// Contradictions, or open questions.
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

const fn read(
    system: &'static str,
    shape: Option<(AcceptanceShape, Provenance)>,
    basis: &'static str,
) -> Fact {
    Fact { system, shape, basis, onaa: None, doubt: None }
}

/// Facts about the systems with published areas.
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
            Some((AcceptanceShape::Disc(POLYBOT_REACH), Provenance::Recomputed)),
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
            Some((AcceptanceShape::Square(1.0 / 13.0), Provenance::Inferred)),
            "a square of edge 1/13 agrees to three digits: 5 mm on a module of 65 mm",
        )
    },
    Fact {
        doubt: Some("the same number is printed for M-TRAN III; no geometry is given for either"),
        ..read(
            "JHU",
            Some((AcceptanceShape::Square(1.0 / 13.0), Provenance::Inferred)),
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
        Some((AcceptanceShape::Square(4.0 / 15.0), Provenance::Inferred)),
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
            Some((AcceptanceShape::Disc(AROUND), Provenance::Recomputed)),
            "probe and drogue around the unit square: a circle of radius √2/2",
        )
    },
    Fact {
        onaa: Some(1.0),
        ..read(
            "3-D X-Face",
            Some((AcceptanceShape::Diamond(1.0), Provenance::Recomputed)),
            "the saddle accepts |x| + |y| < D",
        )
    },
];

impl Fact {
    /// Of a row of the catalogue.
    pub fn of(system: &System) -> Option<&'static Self> {
        if system.source == RowSource::Appended {
            return None;
        }
        GEOMETRY.iter().find(|fact| fact.system == system.name)
    }
}

/// Every known number of a system's zero-rotation area, each with its provenance.
pub fn numbers(system: &System) -> Vec<Number> {
    let mut result = Vec::new();
    let mut add = |name, value, unit, provenance, basis: &str| {
        result.push(Number { name, value, unit, provenance, basis: basis.to_owned() });
    };
    if let Some(zraa) = &system.published {
        let place = if system.source == RowSource::Section412 { "section 4.1.2" } else { "table 2.1" };
        let basis = if zraa.estimated { format!("{place}, marked as estimated") } else { place.to_owned() };
        add("area", zraa.area_d2, "D²", Provenance::Stated, &basis);
        add("radius", (zraa.area_d2 / PI).sqrt(), "D", Provenance::Recomputed, "of the circle of that area");
        add("edge", zraa.area_d2.sqrt(), "D", Provenance::Recomputed, "of the square of that area");
    }
    if let Some(area) = system.computed {
        add("area", area, "D²", Provenance::Recomputed, "of the design");
    }
    let Some(fact) = Fact::of(system) else { return result };
    if let Some(onaa) = fact.onaa {
        add("ONAA", onaa, "D", Provenance::Stated, "section 4.1.2");
    }
    if let Some((shape, provenance)) = fact.shape {
        add("area", shape.area(), "D²", provenance, fact.basis);
        add("ONAA", shape.onaa(), "D", provenance, "of that region");
    }
    match fact.system {
        "DRAGON" => {
            let circle = AcceptanceShape::Disc((DRAGON_AREA / PI).sqrt());
            add("ONAA", circle.onaa(), "D", Provenance::Recomputed, fact.basis);
            let stated = AcceptanceShape::Disc(DRAGON_REACH);
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
    result
}

#[cfg(test)]
mod tests;
