//! Parameters of a latch in a design file, with the dissertation's values as defaults.

use super::outline::Geometry;
use super::rules::{RuleCheck, WIDEST_SLIT, rules};
use crate::form::{Form, FormTable};
use catchment::design::SourceText;
use catchment::diagnostic::Diagnostics;
use serde::Serialize;

/// `MPa` in a `GPa`.
const GIGA: f64 = 1000.0;
/// Default lower edge below the plane of the overhang: room for dowels under the slit of a one-sided part.
const BASE_ONE_SIDED: f64 = 60.0;

/// A latching X-Face: lengths in mm, angles in rad, the modulus in `MPa`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LatchDesign {
    /// Name of the design.
    pub name: String,
    /// Width of the face, L.
    pub width: f64,
    /// Width of the overhang, o.
    pub overhang: f64,
    /// Thickness of the compliance neck, t.
    pub neck: f64,
    /// Height of the hook's tip, h.
    pub hook: f64,
    /// Width of the kerf that the laser burns away.
    pub kerf: f64,
    /// Thickness of a layer, w.
    pub sheet: f64,
    /// Thickness of the sheet between the layers.
    pub separator: f64,
    /// Number of layers with a profile: 1, or 2 that mirror each other.
    pub layers: u32,
    /// Young's modulus, in `MPa`.
    pub modulus: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Distance from the middle of the overhang to the near side of the stop slit.
    pub slit_distance: f64,
    /// Depth of the slit below the face.
    pub slit_depth: f64,
    /// Its width.
    pub slit_gap: f64,
    /// Whether a wider slit than the dissertation's is meant.
    pub wide_slit: bool,
    /// Depth of the cut-out's bottom below the face at the slit.
    pub cutout_depth: f64,
    /// Height of the cut-out, and so the length of the neck, `l_eq`.
    pub l_eq: f64,
    /// Angle of the profile at the outer edge, below the x axis.
    pub spline_start: f64,
    /// Angle at the hook, if it does not follow from P.
    pub spline_end: Option<f64>,
    /// Exponent n of the profile: the larger, the later it bends from the first angle to the second.
    pub bend: f64,
    /// Faces of the part: 1, or 3.
    pub sides: u32,
    /// Distance from the plane of the overhang down to the lower edge.
    pub base: f64,
    /// Diameter of two dowel holes below the slit, if the part has them.
    pub dowel: Option<f64>,
    /// Width of the module that carries it.
    pub module_width: f64,
    /// Distance from the plane of the overhang to the rotor's centre.
    pub rotor_distance: f64,
    /// Pressing of two halves.
    pub press: Press,
}

/// Conditions under which two halves are pressed together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Press {
    /// Coulomb friction coefficient.
    pub friction: f64,
    /// Lateral offset of the halves at first contact of their hooks, in mm.
    pub offset: f64,
    /// Tilt out of the plane of the layers, in rad: one layer meets its partner before the other.
    pub tilt: f64,
}

impl Default for Press {
    fn default() -> Self {
        Self { friction: 0.3, offset: 0.0, tilt: 2f64.to_radians() }
    }
}

impl Default for LatchDesign {
    /// The dissertation's part with o = 5.1 and t = 3.0, one-sided.
    fn default() -> Self {
        Self {
            name: "latching X-Face".to_owned(),
            width: 65.5,
            overhang: 5.1,
            neck: 3.0,
            hook: 3.0,
            kerf: 0.18,
            sheet: 6.35,
            separator: 6.35,
            layers: 2,
            modulus: 2100.0,
            poisson: 0.35,
            slit_distance: 15.0,
            slit_depth: 20.3,
            slit_gap: 0.36,
            wide_slit: false,
            cutout_depth: 19.0,
            l_eq: 6.0,
            spline_start: 35f64.to_radians(),
            spline_end: None,
            bend: 6.0,
            sides: 1,
            base: BASE_ONE_SIDED,
            dowel: None,
            module_width: 65.5,
            rotor_distance: 47.5,
            press: Press::default(),
        }
    }
}

impl LatchDesign {
    /// Reads a design file.
    ///
    /// # Errors
    /// Everything that is wrong with it, in place, also the rules of the outline that it breaks.
    pub fn read(source: SourceText) -> Result<(Self, Geometry), Diagnostics> {
        // The geometry is there whenever nothing was refused.
        let none = |source: SourceText| Diagnostics { source: Some(source), list: Vec::new(), omitted: 0 };
        let kept = source.clone();
        let (latch, geometry) = Form::read(source, |form, root| {
            let latch = filled(form, root);
            let geometry = if form.is_refused() { None } else { checked(form, root, &latch) };
            (latch, geometry)
        })?;
        geometry.map(|geometry| (latch, geometry)).ok_or_else(|| none(kept))
    }
}

fn filled(form: &mut Form<'_>, root: &FormTable<'_>) -> LatchDesign {
    let d = LatchDesign::default();
    form.integer(root, "schema", 1..=1, Some(1));
    let name = form.word(root, "name").map_or(d.name, |word| word.text.to_owned());
    let s = form.table(root, "latch");
    let width = form.length(&s, "width", 10.0..=1000.0, Some(d.width));
    let overhang = form.length(&s, "overhang", 0.1..=100.0, Some(d.overhang));
    let neck = form.length(&s, "neck", 0.2..=50.0, Some(d.neck));
    let hook = form.length(&s, "hook", 0.2..=100.0, Some(d.hook));
    let kerf = form.length(&s, "kerf", 0.0..=2.0, Some(d.kerf));
    let sheet = form.length(&s, "sheet", 0.2..=50.0, Some(d.sheet));
    let separator = form.length(&s, "separator", 0.0..=100.0, Some(sheet));
    let layers = form.integer(&s, "layers", 1..=2, Some(2)) as u32;
    let modulus = GIGA * form.number(&s, "E", 0.001..=1000.0, Some(d.modulus / GIGA));
    let poisson = form.number(&s, "poisson", 0.0..=0.49, Some(d.poisson));
    let slit_distance = form.length(&s, "slit_distance", 0.5..=500.0, Some(d.slit_distance));
    let slit_depth = form.length(&s, "slit_depth", 0.5..=500.0, Some(d.slit_depth));
    let slit_gap = form.length(&s, "slit_gap", 0.0..=20.0, Some((2.0 * kerf).min(WIDEST_SLIT).max(kerf)));
    let wide_slit = form.flag(&s, "wide_slit", d.wide_slit);
    let cutout_depth = form.length(&s, "cutout_depth", 0.5..=500.0, Some(d.cutout_depth));
    let l_eq = form.length(&s, "l_eq", 0.2..=200.0, Some(d.l_eq));
    // Steeper than this is a wall.
    let (flat, steep) = (-80f64.to_radians(), 89f64.to_radians());
    let spline_start = form.angle(&s, "spline_start", flat..=steep, Some(d.spline_start));
    let spline_end =
        s.has("spline_end").then(|| form.angle(&s, "spline_end", flat..=steep, Some(d.spline_start)));
    let bend = form.number(&s, "bend", 1.0..=50.0, Some(d.bend));
    let sides = if form.integer(&s, "sides", 1..=3, Some(1)) == 2 {
        form.refuse(s.span_of("sides"), "`latch.sides` is 2: a part has one face or three", None);
        1
    } else if form.integer(&s, "sides", 1..=3, Some(1)) == 3 {
        3
    } else {
        1
    };
    let module_width = form.length(&s, "module_width", 5.0..=2000.0, Some(d.module_width));
    let rotor_distance = form.length(&s, "rotor_distance", 5.0..=2000.0, Some(d.rotor_distance));
    let lower = if sides == 3 { rotor_distance } else { d.base };
    let base = form.length(&s, "base", 1.0..=2000.0, Some(lower));
    let dowel = s.has("dowel").then(|| form.length(&s, "dowel", 0.5..=50.0, Some(3.0)));
    form.close(&s);
    let p = form.table(root, "press");
    let press = Press {
        friction: form.number(&p, "friction", 0.0..=2.0, Some(d.press.friction)),
        offset: form.length(&p, "offset", -100.0..=100.0, Some(d.press.offset)),
        tilt: form.angle(&p, "tilt", -0.2..=0.2, Some(d.press.tilt)),
    };
    form.close(&p);
    form.close(root);
    if !s.is_written() {
        form.refuse(
            root.span(),
            "`latch` is missing: a table of what the part measures; it may be empty",
            None,
        );
    }
    LatchDesign {
        name,
        width,
        overhang,
        neck,
        hook,
        kerf,
        sheet,
        separator,
        layers,
        modulus,
        poisson,
        slit_distance,
        slit_depth,
        slit_gap,
        wide_slit,
        cutout_depth,
        l_eq,
        spline_start,
        spline_end,
        bend,
        sides,
        base,
        dowel,
        module_width,
        rotor_distance,
        press,
    }
}

/// The outline, unless a required rule is broken; the error is then reported at the place of its number.
fn checked(form: &mut Form<'_>, root: &FormTable<'_>, latch: &LatchDesign) -> Option<Geometry> {
    let section = form.table(root, "latch");
    let press = form.table(root, "press");
    let geometry = match Geometry::of(latch) {
        Ok(geometry) => geometry,
        Err(error) => {
            form.refuse(section.span_of(error.key()), error.to_string(), Some(error.help()));
            return None;
        }
    };
    for rule in rules(latch, &geometry).iter().filter(|rule| rule.verdict == RuleCheck::Broken) {
        let at = if press.has(rule.key) { press.span_of(rule.key) } else { section.span_of(rule.key) };
        let message = format!("{}: {}", rule.rule, rule.found);
        form.refuse(at, message, Some(&rule.reason));
    }
    (!form.is_refused()).then_some(geometry)
}

#[cfg(test)]
mod tests {
    use super::super::drawing::files;
    use super::super::press::record;
    use super::*;
    use proptest::prelude::*;

    fn read(text: &str) -> Result<LatchDesign, String> {
        LatchDesign::read(SourceText::new("l.toml", text)).map(|(latch, _)| latch).map_err(|e| e.to_string())
    }

    #[test]
    fn an_empty_table_is_the_dissertations_part() {
        assert_eq!(read("[latch]\n").unwrap(), LatchDesign::default());
        let text = include_str!("../../../../designs/systems/latch.toml");
        let stated = LatchDesign {
            name: "latching X-Face, overhang 5.1, neck 3.0".to_owned(),
            dowel: Some(4.0),
            ..LatchDesign::default()
        };
        assert_eq!(read(text).unwrap(), stated);
        assert_eq!(read("[latch]\nsides = 3\n").unwrap().base, 47.5);
        let inches = read("[latch]\nsheet = '0.125 in'\nkerf = 0.2\n").unwrap();
        assert!((inches.sheet - 3.175).abs() < 1e-12 && inches.separator == inches.sheet);
        // Two kerfs, unless that is too wide, and at least a single kerf.
        assert_eq!(inches.slit_gap, 0.36);
        assert_eq!(read("[latch]\nkerf = 0.1\n").unwrap().slit_gap, 0.2);
    }

    #[test]
    fn broken_rules_are_reported_in_their_place_with_their_reason() {
        let words = read("[latch]\nslit_depth = 15\nspline_end = '70 deg'\n").unwrap_err();
        assert!(words.contains("l.toml:2:14: the stop slit ends below the cut-out"), "{words}");
        assert!(words.contains("l.toml:3:14: the tangent at the hook passes through P"), "{words}");
        assert!(read("[latch]\nsides = 2\n").unwrap_err().contains("one face or three"));
        assert!(read("").unwrap_err().contains("`latch` is missing"));
        let words = read("[latch]\nspline_start = '35 deg'\nl_eq = 100\n").unwrap_err();
        assert!(words.contains("l.toml:2:16: no falling profile"), "{words}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// For any lengths in a file: a complete outline, or a list of errors.
        #[test]
        fn any_lengths_are_drawn_or_refused(
            width in 10.0f64..200.0, overhang in 0.1f64..20.0, neck in 0.2f64..12.0, hook in 0.2f64..20.0,
            kerf in 0.0f64..0.6, distance in 1.0f64..60.0, depth in 1.0f64..60.0, cutout in 1.0f64..60.0,
            l_eq in 0.3f64..30.0, start in -20f64..85.0, bend in 1.0f64..50.0, friction in 0.0f64..2.0,
        ) {
            let text = format!(
                "[latch]\nwidth = {width}\noverhang = {overhang}\nneck = {neck}\nhook = {hook}\nkerf = {kerf}\n\
                 slit_distance = {distance}\nslit_depth = {depth}\ncutout_depth = {cutout}\nl_eq = {l_eq}\n\
                 spline_start = '{start} deg'\nbend = {bend}\nmodule_width = 500\nrotor_distance = 500\nbase = 400\n\
                 [press]\nfriction = {friction}\n"
            );
            match LatchDesign::read(SourceText::new("l.toml", text)) {
                Ok((latch, geometry)) => {
                    prop_assert!(record(&latch, &geometry).unwrap().peak > 0.0);
                    prop_assert!(files(&latch, &geometry).unwrap().len() == 9);
                }
                Err(found) => prop_assert!(!found.list.is_empty()),
            }
        }
    }
}
