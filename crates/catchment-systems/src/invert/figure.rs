//! The pair, and its heights compared with the wanted heights.
//!
//! ```text
//!   ┌──────────┐   height │╲      ┄┄╱      wanted h* (dashed) and reached h (full) along x through y = 0;
//!   │   ▼  ▼   │          │ ╲┄┄┄┄▒▒╱       shaded: h below h*
//!   └──────────┘          └──────────── x
//! ```

use super::{Heights, Inverse, REACHED};
use catchment::design::Design;
use catchment::document::significant;
use catchment::report::figure::draw::axis::{PlotFrame, ShownUnits};
use catchment::report::figure::draw::colour::{CURVES, hex};
use catchment::report::figure::draw::layout::{Layout, Legend, Panel, stroked};
use catchment::report::figure::draw::svg::{Rect, Svg, polyline};
use catchment::report::figure::{FigureError, MovingHalfPose, Picture, section_panel};
use glam::DVec2;

/// Distance at which the halves are drawn apart, in D.
const APART: f64 = 0.25;
/// Height of both panels, and their widths, in SVG units.
const HEIGHT: f64 = 380.0;
const WIDTHS: [f64; 2] = [360.0, 400.0];
/// The style of the wanted heights.
const WANTED: &str = r##"fill="none" stroke="#1f2933" stroke-width="1.6" stroke-dasharray="6 4""##;
/// Room around the heights, as a share of their extent.
const MARGIN: f64 = 0.06;

/// Draws both halves in section, and the wanted and reached heights along x, at y = 0.
///
/// # Errors
/// If the section meets neither half, or no height is wanted at y = 0.
pub fn figure(design: &Design, found: &Inverse) -> Result<Picture, FigureError> {
    let key = Legend::default().line(WANTED, "wanted").line(stroked(CURVES[0], 2.2), "reached, at y = 0");
    let title = format!("{}: moving half for the wanted heights", design.name);
    let (mut svg, frames) = Layout::titled(title)
        .computed(design)
        .story(story(found))
        .row([
            Panel::with_axes([WIDTHS[0], HEIGHT]).over("the halves, aligned and drawn apart"),
            Panel::with_axes([WIDTHS[1], HEIGHT]).over(key),
        ])
        .open();
    section_panel(&mut svg, frames[0], design, &found.connector, &MovingHalfPose::mated(design, APART))?;
    heights(&mut svg, frames[1], design, found)?;
    Ok(Picture::of(svg))
}

fn story(found: &Inverse) -> String {
    let turned = if found.turns > 0 {
        format!("; wanted at {} rotations, too, which are not drawn", found.turns)
    } else {
        String::new()
    };
    match found.shortfalls.first() {
        Some(short) => {
            let [most, x, y] = [short.most, short.at.x, short.at.y].map(significant);
            format!("up to {most} D lower than wanted, at x {x}, y {y}{turned}")
        }
        None => format!("every wanted height is reached, to {REACHED:e} D{turned}"),
    }
}

fn heights(svg: &mut Svg, rect: Rect, design: &Design, found: &Inverse) -> Result<(), FigureError> {
    let units = ShownUnits::of(design);
    let [wanted, reached] = [&found.wanted, &found.reached].map(profile);
    let ends = wanted.iter().flatten();
    let (mut lo, mut hi) =
        ends.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), end| (lo.min(*end), hi.max(*end)));
    if lo.x >= hi.x {
        return Err(FigureError::Empty { what: "no height is wanted at y = 0" });
    }
    // The reached heights within the range of the wanted offsets.
    for end in reached.iter().flatten().filter(|end| (lo.x..=hi.x).contains(&end.x)) {
        (lo.y, hi.y) = (lo.y.min(end.y), hi.y.max(end.y));
    }
    let room = MARGIN * (hi - lo).max(DVec2::splat(1e-6));
    let scale = |name: &str, k: usize| units.length(name, lo[k] - room[k], hi[k] + room[k]);
    let frame = PlotFrame { rect, x: scale("x", 0), y: scale("height of first contact", 1) };
    let at = |p: DVec2| frame.at((p * units.lengths()).to_array());
    svg.begin_clip(rect);
    for corners in gaps(&wanted, &reached) {
        svg.path(
            &polyline(corners.map(at), true),
            &format!(r#"fill="{}" fill-opacity="0.3""#, hex(CURVES[1])),
        );
    }
    let line =
        |pieces: &[[DVec2; 2]]| pieces.iter().map(|ends| polyline(ends.map(at), false)).collect::<String>();
    svg.path(&line(&reached), &stroked(CURVES[0], 2.2));
    svg.path(&line(&wanted), WANTED);
    svg.end();
    frame.draw(svg);
    Ok(())
}

/// Heights along x at y = 0, in D: the ends of straight pieces, from left to right.
fn profile(heights: &Heights) -> Vec<[DVec2; 2]> {
    let cut = |polygon: &[DVec2]| {
        let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
        for (k, from) in polygon.iter().enumerate() {
            let to = polygon[(k + 1) % polygon.len()];
            if (from.y <= 0.0) != (to.y <= 0.0) || from.y == 0.0 {
                let share = if from.y == to.y { 0.0 } else { from.y / (from.y - to.y) };
                let x = from.x + share * (to.x - from.x);
                ends = [ends[0].min(x), ends[1].max(x)];
            }
        }
        (ends[1] - ends[0] > REACHED).then_some(ends)
    };
    let piece = |facet: &catchment::method::zraa::HeightFacet| {
        cut(&facet.polygon).map(|ends| ends.map(|x| DVec2::new(x, facet.height(DVec2::new(x, 0.0)))))
    };
    let mut pieces: Vec<[DVec2; 2]> = heights.facets.iter().filter_map(piece).collect();
    pieces.sort_by(|a, b| a[0].x.total_cmp(&b[0].x));
    pieces
}

/// Regions in which the reached heights are below the wanted heights: quadrangles between the two.
fn gaps(wanted: &[[DVec2; 2]], reached: &[[DVec2; 2]]) -> Vec<[DVec2; 4]> {
    let at = |[from, to]: &[DVec2; 2], x: f64| from.lerp(*to, (x - from.x) / (to.x - from.x));
    let mut found = Vec::new();
    for want in wanted {
        for got in reached {
            let (left, right) = (want[0].x.max(got[0].x), want[1].x.min(got[1].x));
            if right - left > REACHED {
                let upper = [left, right].map(|x| at(want, x));
                let lower = [right, left].map(|x| at(got, x));
                if upper[0].y - lower[1].y > REACHED || upper[1].y - lower[0].y > REACHED {
                    found.push([upper[0], upper[1], lower[0], lower[1]]);
                }
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::tests::{family, inverted, own_heights};
    use super::super::{InvertSettings, wanted_from_table};
    use super::*;
    use roxmltree::{Document, Node};

    fn path<'a>(document: &'a Document<'a>, attribute: &str, value: &str) -> Vec<Node<'a, 'a>> {
        let is = |node: &Node| node.has_tag_name("path") && node.attribute(attribute) == Some(value);
        document.descendants().filter(is).collect()
    }

    /// The picture had only the halves: neither the wanted nor the reached heights.
    #[test]
    fn wanted_and_reached_heights_are_drawn() {
        let problem = family("pyramid");
        let attained = inverted(&problem, own_heights(&problem), &InvertSettings::default());
        let picture = figure(problem.design(), &attained).unwrap();
        let document = Document::parse(picture.svg()).unwrap();
        let (wanted, reached) =
            (path(&document, "stroke-dasharray", "6 4"), path(&document, "stroke", &hex(CURVES[0])));
        assert_eq!((wanted.len(), reached.len()), (1, 1));
        assert!(path(&document, "fill", &hex(CURVES[1])).is_empty());
        // A bowl with a slope of 0.6 to all sides: over a socket of 45° less is reached.
        let table =
            "x,y,height\n-1,-1,.6\n0,-1,.6\n1,-1,.6\n-1,0,.6\n0,0,0\n1,0,.6\n-1,1,.6\n0,1,.6\n1,1,.6\n";
        let source = catchment::design::SourceText::new("wanted.csv", table);
        let found = inverted(&problem, wanted_from_table(source).unwrap(), &InvertSettings::default());
        assert!(!found.shortfalls.is_empty());
        let picture = figure(problem.design(), &found).unwrap();
        let document = Document::parse(picture.svg()).unwrap();
        let [wanted] = path(&document, "stroke-dasharray", "6 4")[..] else { panic!("one line") };
        assert_ne!(wanted.attribute("d"), path(&document, "stroke", &hex(CURVES[0]))[0].attribute("d"));
        assert!(picture.svg().contains("D lower than wanted, at x "));
    }

    #[test]
    fn a_profile_is_exact_and_gaps_are_where_less_is_reached() {
        let problem = family("v-face");
        let own = own_heights(&problem);
        let pieces = profile(&own);
        for [from, to] in &pieces {
            for x in [0.25, 0.75].map(|share| from.x + share * (to.x - from.x)) {
                let (drawn, exact) =
                    (from.lerp(*to, (x - from.x) / (to.x - from.x)).y, own.at(DVec2::new(x, 0.0)));
                assert!((drawn - exact.unwrap()).abs() < 1e-9, "{x}");
            }
        }
        assert!(gaps(&pieces, &pieces).is_empty());
        let lower: Vec<[DVec2; 2]> =
            pieces.iter().map(|ends| ends.map(|p| p - DVec2::new(0.0, 0.1))).collect();
        assert_eq!(gaps(&pieces, &lower).len(), pieces.len());
        assert!(gaps(&lower, &pieces).is_empty());
    }
}
