//! A window of pose errors: as versioned JSON, as text, as records for programs.

use super::envelope::{Body, Envelope};
use super::resting::Told;
use super::schema::{Timing, WarningReport};
use super::table::heading;
use super::text::{grouped, line, number, row};
use super::trajectory::TouchReport;
use catchment_core::acceptance::Outcome;
use catchment_core::design::Design;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::run::window::{Settings, Window};
use serde::de::{Deserializer, IgnoredAny, MapAccess, Visitor};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Deref;

/// What a window has to say, with its head.
pub type WindowReport = Envelope<WindowBody>;

/// What a window has to say.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WindowBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// ± so much of every free error, by its name, in D and radians.
    pub window: HalfWidths,
    /// What was found.
    #[serde(flatten)]
    pub found: WindowFound,
}

/// A window beside other things: its half-widths by name, and what was found of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WindowSection {
    /// ± so much of every free error, by its name, in D and radians.
    #[serde(flatten)]
    pub half_widths: HalfWidths,
    /// What was found.
    #[serde(flatten)]
    pub found: WindowFound,
}

/// ± so much of every free error, in D and radians.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(transparent)]
pub struct HalfWidths(pub BTreeMap<Dof, f64>);

/// What was found of a window.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WindowFound {
    /// How it was asked for.
    pub settings: Settings,
    /// What is known of every free error.
    pub sides: Vec<SideReport>,
    /// Half-widths that were not given are so many times their proportions.
    pub scale: f64,
    /// The error that is nearest to its limit while all others are anywhere within the window; null where all reach the error box.
    pub tightest: Option<Dof>,
    /// The nearest pose, in proportions, that does not dock; null where the window reaches the error box.
    pub worst: Option<WorstReport>,
    /// What random poses show.
    pub certificate: CertificateReport,
    /// Exact motions in all.
    pub motions: usize,
}

/// One error, in D or radians.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SideReport {
    /// Which.
    pub axis: Dof,
    /// ± so much is in the window.
    pub half_width: f64,
    /// Whether that was given.
    pub given: bool,
    /// ± so far with all others 0.
    pub alone: f64,
    /// The error box ends there.
    pub alone_reaches_border: bool,
    /// ± so far with all others anywhere within their half-widths.
    pub beside: f64,
    /// The error box ends there.
    pub beside_reaches_border: bool,
}

/// A pose that does not dock.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WorstReport {
    /// The pose error.
    pub error: PoseError,
    /// What becomes of it.
    pub outcome: Outcome,
    /// Where it ends.
    pub end: PoseError,
    /// What touches there, in the world frame of the fixed face centre, in D, with the normal towards the moving half.
    pub touches: Vec<TouchReport>,
}

/// None of so many random poses failed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CertificateReport {
    /// How many.
    pub motions: usize,
    /// At most this share of the window fails, with 95 % confidence.
    pub failing_at_most: f64,
    /// Windows before this one in which some random pose failed.
    pub redrawn: usize,
}

impl Body for WindowBody {
    const KIND: &'static str = "window";
}

impl Deref for WindowBody {
    type Target = WindowFound;

    fn deref(&self) -> &WindowFound {
        &self.found
    }
}

/// Names that are none of an error are of other things.
impl<'de> Deserialize<'de> for HalfWidths {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Named;
        impl<'de> Visitor<'de> for Named {
            type Value = HalfWidths;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("half-widths by the names of errors")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<HalfWidths, A::Error> {
                let mut found = BTreeMap::new();
                while let Some(name) = map.next_key::<String>()? {
                    if let Ok(axis) = name.parse::<Dof>() {
                        found.insert(axis, map.next_value()?);
                    } else {
                        map.next_value::<IgnoredAny>()?;
                    }
                }
                Ok(HalfWidths(found))
            }
        }
        deserializer.deserialize_map(Named)
    }
}

impl From<&Window> for HalfWidths {
    fn from(found: &Window) -> Self {
        Self(found.axes.iter().map(|side| (side.axis, side.half_width)).collect())
    }
}

impl From<&Window> for WindowSection {
    fn from(found: &Window) -> Self {
        Self { half_widths: found.into(), found: found.into() }
    }
}

impl From<&Window> for WindowFound {
    fn from(found: &Window) -> Self {
        let sides = found.axes.iter().map(|side| SideReport {
            axis: side.axis,
            half_width: side.half_width,
            given: side.given,
            alone: side.alone.to,
            alone_reaches_border: side.alone.is_border,
            beside: side.beside.to,
            beside_reaches_border: side.beside.is_border,
        });
        let worst = found.worst.as_ref().map(|worst| {
            let touches = worst.touches.iter().map(|touch| TouchReport {
                point_d: touch.point.to_array(),
                normal: touch.normal.to_array(),
            });
            WorstReport {
                error: worst.error,
                outcome: worst.outcome,
                end: worst.end,
                touches: touches.collect(),
            }
        });
        let certificate = CertificateReport {
            motions: found.certificate.motions,
            failing_at_most: found.certificate.failing_at_most,
            redrawn: found.certificate.redrawn,
        };
        Self {
            settings: found.settings.clone(),
            sides: sides.collect(),
            scale: found.scale,
            tightest: found.tightest,
            worst,
            certificate,
            motions: found.motions,
        }
    }
}

impl WindowReport {
    /// Of a design.
    pub fn new(design: &Design, found: &Window, doubts: Vec<WarningReport>, timing: Option<Timing>) -> Self {
        let body = WindowBody { design: design.clone(), window: found.into(), found: found.into() };
        Self::of(body, doubts, timing)
    }

    /// The report as text of 80 columns; ends with a line break.
    pub fn table(&self) -> String {
        let mut text = String::new();
        heading(&mut text, &self.design);
        row(&mut text, "method", &format!("descent, {} motions, no grid", grouped(self.motions)));
        if self.settings.friction > 0.0 {
            row(&mut text, "friction", &format!("{} between the halves (Coulomb)", self.settings.friction));
        }
        text.push('\n');
        lines(&mut text, self, &self.design);
        let told = Told::of(&self.design);
        if let Some(worst) = &self.worst {
            text.push('\n');
            row(&mut text, "worst pose", &format!("{}: {}", told.place(&worst.error), worst.outcome.name()));
            if worst.outcome == Outcome::Jammed {
                row(&mut text, "", &format!("it rests at {}", told.place(&worst.end)));
            }
            // Corners, edges and facets that meet at one point say it several times.
            let mut places: Vec<String> = Vec::new();
            for place in worst.touches.iter().map(|touch| told.point(touch.point_d)) {
                if !places.contains(&place) {
                    places.push(place);
                }
            }
            for place in places.iter().take(MOST_TOUCHES) {
                row(&mut text, "", &format!("touching at {place}"));
            }
            match places.len().saturating_sub(MOST_TOUCHES) {
                0 => {}
                1 => row(&mut text, "", "and at 1 place more"),
                more => row(&mut text, "", &format!("and at {more} places more")),
            }
        } else {
            row(&mut text, "worst pose", "none was found: the window ends at the error box");
        }
        self.append_warnings(&mut text);
        text
    }

    /// Window and reaches as records for programs, the names of the columns first; D and radians.
    pub fn records(&self) -> Vec<Vec<String>> {
        let head = [
            "axis",
            "half_width",
            "given",
            "alone",
            "alone_reaches_border",
            "beside",
            "beside_reaches_border",
        ];
        let mut records = vec![head.map(str::to_owned).to_vec()];
        records.extend(self.sides.iter().map(|side| {
            vec![
                side.axis.name().to_owned(),
                number(side.half_width),
                side.given.to_string(),
                number(side.alone),
                side.alone_reaches_border.to_string(),
                number(side.beside),
                side.beside_reaches_border.to_string(),
            ]
        }));
        records
    }
}

/// The window and what makes it sure, without the worst pose.
pub(super) fn lines(text: &mut String, found: &WindowFound, design: &Design) {
    let told = Told::of(design);
    line(text, "  window         all at once, all dock      one alone      one, the others in it");
    for side in &found.sides {
        let tight = if Some(side.axis) == found.tightest { "  tightest" } else { "" };
        let given = if side.given { " given" } else { "" };
        let reach = |to: f64, is_border: bool| {
            format!("{}{}", told.size(side.axis, to), if is_border { "*" } else { "" })
        };
        line(
            text,
            &format!(
                "  {:<13}{:>18}{:<7}{:>16}  {:>16}{tight}",
                side.axis.name(),
                told.size(side.axis, side.half_width),
                given,
                reach(side.alone, side.alone_reaches_border),
                reach(side.beside, side.beside_reaches_border),
            ),
        );
    }
    if found.sides.iter().any(|side| side.alone_reaches_border || side.beside_reaches_border) {
        line(text, "  * up to the border of the error box, perhaps further");
    }
    text.push('\n');
    let CertificateReport { motions, failing_at_most, redrawn } = found.certificate;
    if motions == 0 {
        row(text, "certificate", "none: no random poses were asked for");
        return;
    }
    row(
        text,
        "certificate",
        &format!("no failure in {} random poses all over it: at most", grouped(motions)),
    );
    let one_in = grouped((1.0 / failing_at_most).floor() as usize);
    row(text, "", &format!("1 in {one_in} poses of this window fails, 95 %"));
    if redrawn > 0 {
        row(text, "", &format!("{redrawn} larger windows failed it before"));
    }
}

/// Contacts that are told.
const MOST_TOUCHES: usize = 4;
