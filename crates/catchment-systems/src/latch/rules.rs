//! Requirements on an outline, with reasons: the design principles of section 6.1.1 as checks.

use super::kerf::compensated;
use super::measured::REJECTED_OVERHANG;
use super::outline::is_simple;
use super::{Basis, Geometry, LatchDesign};
use serde::Serialize;

/// Verdict on a rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum RuleCheck {
    /// The rule holds.
    Holds,
    /// The rule does not hold, but the part may still work: the report warns.
    Doubt,
    /// The rule does not hold, and such a latch cannot exist: the design is rejected.
    Broken,
}

/// A rule, the finding, and the reason for the rule.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LatchRule {
    /// The rule.
    pub rule: &'static str,
    /// The finding.
    pub found: String,
    /// Whether it holds.
    pub verdict: RuleCheck,
    /// Reason for the rule.
    pub reason: String,
    /// Basis of the rule.
    pub basis: Basis,
    /// The key of the design file that determines it.
    #[serde(skip)]
    pub key: &'static str,
}

/// The smallest overhang that latched, in mm.
const LEAST_OVERHANG: f64 = 2.5;
/// The widest slit that was found to stop the arm soon enough, in mm.
pub const WIDEST_SLIT: f64 = 0.36;
/// Largest distance of the tangent from P, as a share of the lever.
const TANGENT: f64 = 0.01;
/// The chosen angle at the outer edge, in degrees, and the deviation beyond which a warning is given.
const START_DEG: (f64, f64) = (35.0, 0.5);
/// Distance and depth of the slit that were found to be sufficient, in mm.
const SUFFICIENT: (f64, f64) = (15.0, 20.3);
/// Lengths that are equal as written, in mm.
const EQUAL: f64 = 1e-6;

/// The largest swing of an arm, in rad: until the corner of its hook is half an overhang aside. To first order.
pub fn swing(geometry: &Geometry) -> f64 {
    0.5 * geometry.overhang / geometry.lever().y
}

struct List(Vec<LatchRule>);

impl List {
    #[expect(clippy::too_many_arguments, reason = "a rule has that many sides")]
    fn check(
        &mut self,
        rule: &'static str,
        key: &'static str,
        basis: Basis,
        holds: bool,
        if_not: RuleCheck,
        found: String,
        reason: &str,
    ) {
        let verdict = if holds { RuleCheck::Holds } else { if_not };
        self.0.push(LatchRule { rule, found, verdict, reason: reason.to_owned(), basis, key });
    }
}

/// All rules, in the order of the dissertation, then those of our outline.
pub fn rules(latch: &LatchDesign, geometry: &Geometry) -> Vec<LatchRule> {
    let mut list = List(Vec::new());
    of_the_profile(&mut list, latch, geometry);
    of_the_slit(&mut list, latch, geometry);
    of_the_whole(&mut list, latch, geometry);
    list.0
}

fn of_the_profile(list: &mut List, latch: &LatchDesign, geometry: &Geometry) {
    use Basis::{Inferred, Stated};
    use RuleCheck::{Broken, Doubt};
    let profile = &geometry.profile;
    let start_key = if latch.spline_end.is_some() { "spline_end" } else { "spline_start" };
    let (start, end) = (profile.start.to_degrees(), profile.end.to_degrees());
    let least = profile.least_angle();
    let falls = if profile.start <= 0.0 { "spline_start" } else { start_key };
    list.check(
        "the profile falls everywhere, from its highest point at the outer edge",
        falls, Stated, least > 0.0, Broken,
        format!("f falls at {:.1}° where it is flattest, f(0) = {:.2} mm", least.to_degrees(), geometry.height()),
        "where it rises or lies flat the halves jam; the highest point at the edge is what gives the X-Face its area of acceptance",
    );
    list.check(
        "its curvature is negative everywhere",
        start_key, Stated, profile.end > profile.start, Broken,
        format!("its angle goes from {start:.1}° at the edge to {end:.1}° at the hook"),
        "with a straight or concave profile the bent arm turns the contact force away from the inward direction: such prototypes jammed",
    );
    let lever = geometry.lever().length();
    let miss = geometry.tangent_miss();
    list.check(
        "the tangent at the hook passes through P",
        start_key, Stated, miss <= TANGENT * lever, Broken,
        format!("it passes {miss:.3} mm from P, lever {lever:.2} mm"),
        "the force of the partner then has the longest lever about the neck; leave spline_end out and it is found",
    );
    let (best, near) = START_DEG;
    list.check(
        "the profile starts at 35°",
        "spline_start",
        Stated,
        (start - best).abs() <= near,
        Doubt,
        format!("it starts at {start:.1}°"),
        "smaller angles deflect the arm instead of aligning the halves, larger ones take more force to latch",
    );
    let o = latch.overhang;
    let reason = if o <= REJECTED_OVERHANG + EQUAL {
        "prototypes with 1.27 mm were hard to latch: hooks often overlapped by less than 1 mm, and the connection was unstable"
    } else {
        "2.5 mm is the smallest overhang that was tested; 1.27 mm was too little to latch reliably"
    };
    list.check(
        "the overhang is 2.5 mm or more",
        "overhang",
        Stated,
        o >= LEAST_OVERHANG - EQUAL,
        Doubt,
        format!("it is {o:.2} mm"),
        reason,
    );
    list.check(
        "friction alone cannot hold the arm",
        "friction", Inferred, friction_lets_go(latch, geometry), Broken,
        format!("friction {} with P {:.1} mm right of the middle", latch.press.friction,
            geometry.pivot.x - 0.5 * geometry.width),
        "friction on the wall of the hook turns the arm with the push as P lies to its right; this is where it would not",
    );
}

/// Whether the push of the partner opens the arm along the whole way.
fn friction_lets_go(latch: &LatchDesign, geometry: &Geometry) -> bool {
    super::press::record(latch, geometry).is_ok()
}

fn of_the_slit(list: &mut List, latch: &LatchDesign, geometry: &Geometry) {
    use Basis::{Inferred, Stated};
    use RuleCheck::{Broken, Doubt};
    let below = geometry.cutout[0] - geometry.slit_end;
    list.check(
        "the stop slit ends below the cut-out",
        "slit_depth",
        Stated,
        below > 0.0,
        Broken,
        format!(
            "it is {:.2} mm deep, the cut-out's bottom {:.2} mm below the face there",
            latch.slit_depth, latch.cutout_depth
        ),
        "the thin neck between slit and cut-out is what bends: make the slit deeper or cutout_depth smaller",
    );
    let (distance, depth) = SUFFICIENT;
    list.check(
        "the slit is 15 mm from the overhang and 20.3 mm deep, or more",
        "slit_depth", Stated,
        latch.slit_distance >= distance - EQUAL && latch.slit_depth >= depth - EQUAL, Doubt,
        format!("it is {:.2} mm away and {:.2} mm deep", latch.slit_distance, latch.slit_depth),
        "these were found to be sufficient; less was not reported (that the distance is from the overhang is our reading)",
    );
    list.check(
        "the slit is as wide as one kerf at least",
        "slit_gap",
        Stated,
        latch.slit_gap >= latch.kerf - EQUAL && latch.slit_gap > 0.0,
        Broken,
        format!("it is {:.3} mm, the kerf {:.3} mm", latch.slit_gap, latch.kerf),
        "nothing narrower can be cut; the dissertation takes two kerfs",
    );
    list.check(
        "the slit is no wider than 0.36 mm",
        "slit_gap",
        Stated,
        latch.slit_gap <= WIDEST_SLIT + EQUAL || latch.wide_slit,
        Broken,
        format!(
            "it is {:.3} mm: {:.3}° of free play in tension",
            latch.slit_gap,
            play(latch, geometry).to_degrees()
        ),
        "a wider slit lets the arm turn too far before it stops; `wide_slit = true` asks for it all the same",
    );
    let room = geometry.cutout[1] - geometry.cutout[0];
    let drop = geometry.pivot.x * swing(geometry).sin();
    list.check(
        "the cut-out leaves the arm room to swing",
        "l_eq", Inferred, room > drop, Broken,
        format!("it is {room:.2} mm high, the arm's outer edge comes down by {drop:.2} mm"),
        "an arm that meets the body cannot give way by half an overhang: make the neck longer or the overhang smaller",
    );
    let strut = latch.cutout_depth - latch.l_eq;
    list.check(
        "the arm is thicker than its neck where it hangs on it",
        "cutout_depth",
        Inferred,
        strut > latch.neck,
        Broken,
        format!("{strut:.2} mm of arm above the cut-out, neck {:.2} mm", latch.neck),
        "else the arm bends and not the neck: make the cut-out deeper",
    );
}

/// Rotation of the arm by tension until the slit is closed, in rad.
pub fn play(latch: &LatchDesign, geometry: &Geometry) -> f64 {
    let above = -geometry.profile.height(latch.width - geometry.slit[0]) - geometry.pivot.y;
    (latch.slit_gap / above).atan()
}

fn of_the_whole(list: &mut List, latch: &LatchDesign, geometry: &Geometry) {
    use Basis::{Inferred, Stated};
    use RuleCheck::{Broken, Doubt};
    list.check(
        "the separator is as thick as a layer",
        "separator",
        Stated,
        latch.separator >= latch.sheet - EQUAL || latch.layers == 1,
        Doubt,
        format!("it is {:.2} mm, a layer {:.2} mm", latch.separator, latch.sheet),
        "halves are unlatched by hand by moving them out of plane by one layer, into the partner's gap",
    );
    let below = geometry.slit_end.min(-geometry.height()) - geometry.bottom;
    list.check(
        "there is body below slit and profile",
        "base", Inferred, below > 0.0, Broken,
        format!("{below:.2} mm of it"),
        "layers are fixed to the module and to each other below the compliant features only: make `base` larger",
    );
    let (limit, from) = if latch.sides == 3 {
        (latch.rotor_distance, "the rotor's centre")
    } else {
        (latch.rotor_distance + 0.5 * latch.module_width, "the far side of the module")
    };
    list.check(
        "the part fits the module",
        if latch.width > latch.module_width + EQUAL { "width" } else { "base" },
        if latch.sides == 3 { Stated } else { Inferred },
        latch.width <= latch.module_width + EQUAL && latch.base <= limit + EQUAL, Broken,
        format!(
            "it is {:.2} mm wide on a module of {:.2} mm, and reaches {:.2} mm below the overhang; {from} is {limit:.2} mm below",
            latch.width, latch.module_width, latch.base
        ),
        "what is larger stands in the way of the neighbours of the chain",
    );
    if let Some((middles, diameter)) = geometry.dowels {
        let room = geometry.slit_end - geometry.bottom;
        list.check(
            "dowel holes fit below the slit",
            "dowel",
            Inferred,
            room > 2.0 * diameter && diameter > latch.kerf,
            Broken,
            format!("holes of {diameter:.2} mm at y = {:.2} mm, {room:.2} mm of body", middles[0].y),
            "as much material as the hole is wide must stay around it: make `base` larger",
        );
    }
    let outline = geometry.layer();
    let cut = compensated(&outline, latch.kerf);
    list.check(
        "the outline and its cut line are single closed curves",
        "kerf",
        Inferred,
        is_simple(&outline) && cut.is_ok(),
        Broken,
        if cut.is_ok() {
            format!("{} corners", outline.len())
        } else {
            "an edge or a gap is narrower than the kerf".to_owned()
        },
        "a cut that crosses itself gives two parts or none",
    );
    let press = latch.press;
    list.check(
        "both hooks meet",
        "offset",
        Inferred,
        press.offset.abs() < latch.overhang,
        Broken,
        format!(
            "halves are {:.2} mm off sideways, the hooks are {:.2} mm wide",
            press.offset.abs(),
            latch.overhang
        ),
        "a hook that misses its partner's does not hold",
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    fn broken(latch: &LatchDesign) -> Vec<&'static str> {
        let geometry = Geometry::of(latch).unwrap();
        rules(latch, &geometry).iter().filter(|r| r.verdict == RuleCheck::Broken).map(|r| r.key).collect()
    }

    fn doubted(latch: &LatchDesign) -> Vec<&'static str> {
        let geometry = Geometry::of(latch).unwrap();
        rules(latch, &geometry).iter().filter(|r| r.verdict == RuleCheck::Doubt).map(|r| r.key).collect()
    }

    #[test]
    fn the_defaults_meet_every_rule() {
        assert!(broken(&LatchDesign::default()).is_empty() && doubted(&LatchDesign::default()).is_empty());
    }

    /// Each rule can be broken by the number that it names.
    #[test]
    fn every_rule_has_a_number_that_breaks_it() {
        let d = LatchDesign::default;
        let angle = |deg: f64| Some(deg.to_radians());
        assert_eq!(broken(&LatchDesign { spline_start: -0.1, ..d() }), ["spline_start"]);
        assert_eq!(broken(&LatchDesign { spline_end: angle(30.0), ..d() }), ["spline_end", "spline_end"]);
        assert_eq!(broken(&LatchDesign { spline_end: angle(70.0), ..d() }), ["spline_end"]);
        assert_eq!(broken(&LatchDesign { slit_depth: 15.0, ..d() }), ["slit_depth"]);
        assert_eq!(broken(&LatchDesign { slit_gap: 0.1, ..d() }), ["slit_gap", "kerf"]);
        assert_eq!(broken(&LatchDesign { slit_gap: 0.5, ..d() }), ["slit_gap"]);
        assert!(broken(&LatchDesign { slit_gap: 0.5, wide_slit: true, ..d() }).is_empty());
        assert_eq!(broken(&LatchDesign { l_eq: 1.0, ..d() }), ["l_eq"]);
        assert!(broken(&LatchDesign { cutout_depth: 8.5, ..d() }).contains(&"cutout_depth"));
        assert_eq!(broken(&LatchDesign { base: 81.0, ..d() }), ["base"]);
        assert_eq!(broken(&LatchDesign { base: 40.0, ..d() })[0], "base");
        assert_eq!(broken(&LatchDesign { sides: 3, base: 48.0, ..d() }), ["base"]);
        assert!(broken(&LatchDesign { sides: 3, base: 47.5, ..d() }).is_empty());
        assert_eq!(broken(&LatchDesign { width: 80.0, module_width: 65.5, ..d() })[0], "width");
        assert_eq!(broken(&LatchDesign { dowel: Some(9.0), ..d() }), ["dowel"]);
        let mut aside = d();
        aside.press.offset = 5.2;
        assert_eq!(broken(&aside), ["offset"]);
    }

    #[test]
    fn borderline_values_raise_warnings() {
        let d = LatchDesign::default;
        assert_eq!(doubted(&LatchDesign { overhang: 1.27, ..d() }), ["overhang"]);
        assert_eq!(doubted(&LatchDesign { separator: 3.0, ..d() }), ["separator"]);
        assert_eq!(doubted(&LatchDesign { spline_start: 0.5, ..d() }), ["spline_start"]);
        assert_eq!(doubted(&LatchDesign { slit_distance: 14.0, ..d() }), ["slit_depth"]);
    }

    /// A wider slit lets the arm turn farther in tension.
    #[test]
    fn free_play_grows_with_the_slit() {
        let geometry = Geometry::of(&LatchDesign::default()).unwrap();
        let narrow = play(&LatchDesign::default(), &geometry);
        // 0.36 mm, 16.0 mm above P.
        assert!((narrow - 0.36 / 16.0).abs() < 1e-5, "{narrow}");
        assert!(play(&LatchDesign { slit_gap: 0.5, ..LatchDesign::default() }, &geometry) > narrow);
    }
}
