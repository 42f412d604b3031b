//! A design among the published systems: the catalogue entries that follow from its geometry.

use super::attribute::CatalogAttribute;
use super::data::{Catalog, RowSource, System};
use super::facts::Fact;
use super::rule::{Degree, Extents};
use catchment::exec::{Cancelled, Exec};
use catchment::method::zraa::{AcceptedSquare, Zraa, ZraaError, ZraaSettings, run};
use catchment::problem::Problem;
use serde::Serialize;

/// Printed form of an unknown value.
const UNKNOWN: &str = "-";

/// A design, classified.
#[derive(Debug, Clone, PartialEq)]
pub struct Classified {
    /// Its name.
    pub name: String,
    /// Which offsets it corrects without rotation.
    pub zraa: Zraa,
    /// The largest square among them; if one translation is locked, its edge is the length of the interval.
    pub square: AcceptedSquare,
    /// Their extent on the axes through zero.
    pub extents: Extents,
    /// The degree by the rule.
    pub degree: Degree,
    /// Whether the moving half, turned by the mounting half turn, is the fixed half.
    pub ungendered: bool,
}

/// Comparison of a design with a published system.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Ratio {
    /// The system.
    pub system: String,
    /// Its stated area, in D².
    pub area_d2: f64,
    /// Whether that area is an estimate.
    pub estimated: bool,
    /// Area of the design divided by that of the system; null if the design has a length instead of an area.
    pub area_ratio: Option<f64>,
    /// Its stated ONAA, in D; null if the source states none.
    pub onaa_d: Option<f64>,
    /// ONAA of the design divided by that of the system.
    pub onaa_ratio: Option<f64>,
}

/// Why a design cannot be classified.
#[derive(Debug, thiserror::Error)]
pub enum ClassifyError {
    /// Its area is not known.
    #[error(transparent)]
    Zraa(#[from] ZraaError),
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Classifies a design by its own geometry.
///
/// # Errors
/// If its zero-rotation area of acceptance cannot be decided.
pub fn classify(problem: &Problem, exec: &Exec) -> Result<Classified, ClassifyError> {
    let zraa = run(problem.pair(), &ZraaSettings::default(), exec)?;
    let square = AcceptedSquare::of(&zraa, exec)?;
    let extents = Extents::of(&zraa);
    Ok(Classified {
        name: problem.design().name.clone(),
        square,
        extents,
        degree: extents.degree(),
        ungendered: problem.connector().ungendered(problem.alignment().mount),
        zraa,
    })
}

impl Classified {
    /// Its area, in D²; `None` if one translation is locked.
    pub const fn area(&self) -> Option<f64> {
        match &self.zraa {
            Zraa::Region { area, .. } => Some(*area),
            Zraa::Interval { .. } => None,
        }
    }

    /// As table 1.1 prints it.
    pub const fn gendering(&self) -> &'static str {
        if self.ungendered { "Ungendered" } else { "Gendered" }
    }

    /// Its row: attributes that do not follow from geometry are left open.
    pub fn row(&self) -> System {
        let value = |attribute| match attribute {
            CatalogAttribute::SelfAligningDegree => self.degree.name(),
            CatalogAttribute::Gendering => self.gendering(),
            _ => UNKNOWN,
        };
        System {
            name: self.name.clone(),
            source: RowSource::Appended,
            attributes: Some(CatalogAttribute::ALL.map(|attribute| value(attribute).to_owned())),
            published: None,
            computed: self.area(),
        }
    }

    /// The design beside every published area, the smallest first.
    pub fn ratios(&self, catalog: &Catalog) -> Vec<Ratio> {
        let beside = |system: &System| {
            let zraa = system.published.as_ref()?;
            let onaa_d = Fact::of(system).and_then(|fact| fact.onaa);
            // Of an interval neither the area nor the square is that of a plane.
            let area = self.area();
            Some(Ratio {
                system: system.name.clone(),
                area_d2: zraa.area_d2,
                estimated: zraa.estimated,
                area_ratio: area.map(|own| own / zraa.area_d2),
                onaa_d,
                onaa_ratio: onaa_d.filter(|_| area.is_some()).map(|stated| self.square.edge / stated),
            })
        };
        let mut ratios: Vec<Ratio> = catalog.systems.iter().filter_map(beside).collect();
        ratios.sort_by(|a, b| a.area_d2.total_cmp(&b.area_d2));
        ratios
    }
}

impl Catalog {
    /// Adds a design as the last row.
    pub fn append(&mut self, classified: &Classified) {
        self.systems.push(classified.row());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};

    fn of(family: Family) -> Classified {
        let connector = ConnectorSpec::Family(FamilySpec::new(family));
        let alignment = Alignment::default_for(Some(family));
        let design = Design { name: family.name().to_owned(), connector, width: 1.0, unit: None, alignment };
        classify(&Problem::of(design).unwrap(), &Exec::new()).unwrap()
    }

    #[test]
    fn families_are_classified_as_published() {
        for (family, degree, gendering, longest) in [
            (Family::XFace3d, Degree::High, "Ungendered", 2.0),
            (Family::Pyramid, Degree::High, "Gendered", 1.0),
            (Family::Cone, Degree::High, "Gendered", 1.0),
            (Family::SFace, Degree::High, "Ungendered", 2.0 / 3.0),
            (Family::VFace, Degree::High, "Gendered", 1.0),
        ] {
            let result = of(family);
            assert_eq!((result.degree, result.gendering()), (degree, gendering), "{family:?}");
            assert!((result.extents.longest() - longest).abs() < 1e-9, "{family:?}: {:?}", result.extents);
        }
    }

    #[test]
    fn ratios_of_the_saddle_are_those_of_the_text() {
        let catalog = Catalog::published().unwrap();
        let ratios = of(Family::XFace3d).ratios(&catalog);
        assert_eq!(ratios.len(), 12);
        let beside = |name: &str| ratios.iter().find(|ratio| ratio.system == name).unwrap();
        // 27 % by the printed 1.57.
        assert!((beside("amour").area_ratio.unwrap() - 2.0 / 1.57).abs() < 1e-9);
        assert!((beside("DRAGON").area_ratio.unwrap() - 5.67).abs() < 0.005);
        assert!((beside("DRAGON").onaa_ratio.unwrap() - 2.11).abs() < 0.005);
        assert!((beside("3-D X-Face").area_ratio.unwrap() - 1.0).abs() < 1e-9);
        // A length has no ratio to an area.
        assert!(
            of(Family::SFace)
                .ratios(&catalog)
                .iter()
                .all(|r| r.area_ratio.is_none() && r.onaa_ratio.is_none())
        );
    }

    #[test]
    fn a_design_is_the_twenty_eighth_row_of_its_table() {
        let mut catalog = Catalog::published().unwrap();
        catalog.append(&of(Family::XFace3d));
        let with_attributes = catalog.systems.iter().filter(|system| system.attributes.is_some()).count();
        assert_eq!(with_attributes, 28);
        let row = catalog.systems.last().unwrap();
        assert_eq!(row.printed(CatalogAttribute::Gendering), Some("Ungendered"));
        assert_eq!(
            (row.printed(CatalogAttribute::Introduced), row.area().map(f64::round)),
            (Some("-"), Some(2.0))
        );
        // The printed tables stay as they are.
        let printed =
            |catalog: &Catalog| catalog.as_printed(super::super::PublishedTable::Connectors).unwrap();
        assert_eq!(printed(&catalog), printed(&Catalog::published().unwrap()));
    }
}
