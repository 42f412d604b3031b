//! A window of pose errors: as versioned JSON, as text, as records for programs.

use super::envelope::{Body, Envelope};
use super::schema::{Timing, WarningReport};
use super::table::heading;
use super::text::{self, grouped, line, number, row, wrapped};
use super::trajectory::TouchReport;
use crate::acceptance::Outcome;
use crate::design::Design;
use crate::pose::{Dof, PoseError};
use crate::study::window::{Settings, Window};
use serde::{Serialize, Serializer};

/// What a window has to say, with its head.
pub type WindowReport = Envelope<WindowBody>;

/// What a window has to say.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WindowBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// How it was asked for.
    pub settings: Settings,
    /// ± so much of every free error, by its name, in D and radians.
    #[serde(serialize_with = "by_name")]
    pub window: Vec<(Dof, f64)>,
    /// What is known of every one of them.
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
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize)]
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
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
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

impl WindowReport {
    /// Of a design.
    pub fn new(design: &Design, found: &Window, doubts: Vec<WarningReport>, timing: Option<Timing>) -> Self {
        let window = found.axes.iter().map(|side| (side.axis, side.half_width)).collect();
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
        let body = WindowBody {
            design: design.clone(),
            settings: found.settings.clone(),
            window,
            sides: sides.collect(),
            scale: found.scale,
            tightest: found.tightest,
            worst,
            certificate,
            motions: found.motions,
        };
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
        line(&mut text, "  window         all at once, all dock      one alone      one, the others in it");
        for side in &self.sides {
            let tight = if Some(side.axis) == self.tightest { "  tightest" } else { "" };
            let given = if side.given { " given" } else { "" };
            let reach = |to: f64, is_border: bool| {
                format!("{}{}", self.size(side.axis, to), if is_border { "*" } else { "" })
            };
            line(
                &mut text,
                &format!(
                    "  {:<13}{:>18}{:<7}{:>16}  {:>16}{tight}",
                    side.axis.name(),
                    self.size(side.axis, side.half_width),
                    given,
                    reach(side.alone, side.alone_reaches_border),
                    reach(side.beside, side.beside_reaches_border),
                ),
            );
        }
        if self.sides.iter().any(|side| side.alone_reaches_border || side.beside_reaches_border) {
            line(&mut text, "  * up to the border of the error box, perhaps further");
        }
        text.push('\n');
        self.certified(&mut text);
        if let Some(worst) = &self.worst {
            text.push('\n');
            row(&mut text, "worst pose", &format!("{}: {}", self.place(&worst.error), worst.outcome.name()));
            if worst.outcome == Outcome::Jammed {
                row(&mut text, "", &format!("it rests at {}", self.place(&worst.end)));
            }
            for touch in worst.touches.iter().take(MOST_TOUCHES) {
                let [x, y, z] = touch.point_d.map(|part| self.length(part));
                row(&mut text, "", &format!("touching at ({x}, {y}, {z}) {}", self.unit()));
            }
            if worst.touches.len() > MOST_TOUCHES {
                row(&mut text, "", &format!("and at {} places more", worst.touches.len() - MOST_TOUCHES));
            }
        } else {
            row(&mut text, "worst pose", "none was found: the window ends at the error box");
        }
        for warning in &self.warnings {
            text.push('\n');
            wrapped(&mut text, "warning: ", &warning.message);
        }
        text
    }

    fn certified(&self, text: &mut String) {
        let CertificateReport { motions, failing_at_most, redrawn } = self.certificate;
        if motions == 0 {
            row(text, "certificate", "none: no random poses were asked for");
            return;
        }
        row(
            text,
            "certificate",
            &format!("no failure in {} random poses all over it: at most", grouped(motions)),
        );
        let one_in = 1.0 / failing_at_most;
        row(text, "", &format!("1 in {} poses of this window fails, 95 %", grouped(one_in.floor() as usize)));
        if redrawn > 0 {
            row(text, "", &format!("{redrawn} larger windows failed it before"));
        }
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

    fn unit(&self) -> &'static str {
        self.design.unit.map_or("D", |unit| unit.symbol())
    }

    fn length(&self, value: f64) -> String {
        let scale = if self.design.unit.is_some() { self.design.width } else { 1.0 };
        text::length(value * scale, scale)
    }

    /// `±0.402 mm` or `±12.3°`, rounded towards zero.
    fn size(&self, axis: Dof, value: f64) -> String {
        let down = |value: f64, digits: f64| (value * digits + 1e-9).floor() / digits;
        if axis.is_rotation() {
            return format!("±{:.2}°", down(value.to_degrees(), 100.0));
        }
        match self.design.unit {
            Some(unit) => {
                let decimals = text::decimals(self.design.width);
                let value = down(value * self.design.width, 10f64.powf(decimals as f64));
                format!("±{value:.decimals$} {}", unit.symbol())
            }
            None => format!("±{:.4} D", down(value, 10_000.0)),
        }
    }

    fn place(&self, error: &PoseError) -> String {
        let free = self.sides.iter().map(|side| side.axis);
        let said: Vec<String> = free
            .map(|axis| {
                let value = error.to_array()[axis.index()];
                if axis.is_rotation() {
                    format!("{} {:.2}°", axis.name(), value.to_degrees() + 0.0)
                } else {
                    format!("{} {} {}", axis.name(), self.length(value), self.unit())
                }
            })
            .collect();
        said.join(", ")
    }
}

fn by_name<S: Serializer>(window: &[(Dof, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(window.iter().map(|(axis, half_width)| (axis.name(), half_width)))
}

/// Contacts that are told.
const MOST_TOUCHES: usize = 4;
