//! Regions of loops, and the same outlines from both kinds of drawings.

use super::*;
use crate::design::FileUnit;

fn square(low: f64, high: f64) -> Vec<DVec2> {
    vec![DVec2::splat(low), DVec2::new(high, low), DVec2::splat(high), DVec2::new(low, high)]
}

fn drawing(name: &str, text: &str) -> Result<Vec<Vec<DVec2>>, OutlineProblem> {
    let file = FileBytes::whole(text.as_bytes().to_vec());
    read(&FileSpec::new(name, 1.0), &file, 1e-3)
}

fn areas(name: &str, text: &str) -> Vec<f64> {
    let regions = regions(drawing(name, text).unwrap()).unwrap();
    regions.iter().map(|region| region.loops().map(|ring| super::area(ring)).sum()).collect()
}

#[test]
fn loops_nest() {
    let found =
        regions(vec![square(1.0, 2.0), square(0.0, 9.0), square(1.2, 1.8), square(3.0, 4.0)]).unwrap();
    let shapes: Vec<(f64, usize)> = found.iter().map(|r| (super::area(&r.outer), r.holes.len())).collect();
    assert_eq!(shapes.len(), 2);
    assert!(shapes.iter().any(|(area, holes)| (area - 81.0).abs() < 1e-12 && *holes == 2));
    assert!(shapes.iter().any(|(area, holes)| (area - 0.36).abs() < 1e-12 && *holes == 0));
    assert!(found.iter().flat_map(|r| &r.holes).all(|hole| super::area(hole) < 0.0));
}

#[test]
fn what_bounds_nothing_is_refused() {
    let bow = vec![DVec2::ZERO, DVec2::ONE, DVec2::X, DVec2::new(0.0, 1.1)];
    assert!(matches!(regions(vec![bow]), Err(OutlineProblem::Crossing { .. })));
    assert!(matches!(
        regions(vec![vec![DVec2::ZERO, DVec2::X, DVec2::ZERO]]),
        Err(OutlineProblem::Flat { .. })
    ));
    let touching = vec![square(0.0, 1.0), square(1.0, 2.0)];
    assert!(matches!(regions(touching), Err(OutlineProblem::Crossing { .. })));
    let spike = vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::new(1.0, 3.0), DVec2::ONE, DVec2::Y];
    assert!(matches!(regions(vec![spike]), Err(OutlineProblem::Crossing { .. })));
    let far = vec![DVec2::ZERO, DVec2::new(f64::NAN, 0.0), DVec2::Y];
    assert_eq!(regions(vec![far]), Err(OutlineProblem::TooFar));
}

/// A plate of 10 by 6 with a round hole of radius 2: as one path, as shapes, and as a DXF drawing. Chords lie inside of the circle by at most
/// the chord error.
#[test]
fn a_plate_with_a_hole_in_both_kinds_of_drawings() {
    let round = std::f64::consts::PI * 4.0;
    let most = std::f64::consts::TAU * 2.0 * 1e-3;
    let path = "<svg xmlns='http://www.w3.org/2000/svg'><path d='M0,0h10v6H0z M7,3a2,2 0 1 0 -4 0 A2 2 0 0 0 7 3Z'/></svg>";
    let shapes = "<svg xmlns='http://www.w3.org/2000/svg'><g transform='translate(5 3) scale(-1 1)'>\
                  <rect x='-5' y='-3' width='10' height='6'/><circle r='2'/></g><defs><path d='M0 0h1'/></defs></svg>";
    let line = |[x, y]: [f64; 2], [u, v]: [f64; 2]| format!("0\nLINE\n10\n{x}\n20\n{y}\n11\n{u}\n21\n{v}\n");
    let sides = [
        line([0.0, 0.0], [10.0, 0.0]),
        line([10.0, 6.0], [10.0, 0.0]),
        line([0.0, 6.0], [10.0, 6.0]),
        line([0.0, 0.0], [0.0, 6.0]),
    ];
    let dxf = |hole: &str| format!("0\nSECTION\n2\nENTITIES\n{}{hole}0\nENDSEC\n0\nEOF\n", sides.concat());
    let circle = dxf("0\nCIRCLE\n10\n5\n20\n3\n40\n2\n");
    let arcs = dxf(
        "0\nARC\n10\n-5\n20\n3\n40\n2\n50\n30\n51\n210\n230\n-1\n0\nARC\n10\n-5\n20\n3\n40\n2\n50\n210\n51\n390\n230\n-1\n",
    );
    let bulges = dxf("0\nLWPOLYLINE\n90\n2\n70\n1\n10\n3\n20\n3\n42\n1\n10\n7\n20\n3\n42\n1\n");
    let old = dxf(
        "0\nPOLYLINE\n66\n1\n70\n1\n0\nVERTEX\n10\n3\n20\n3\n42\n-1\n0\nVERTEX\n10\n7\n20\n3\n42\n-1\n0\nSEQEND\n",
    );
    for (name, text) in [
        ("a.svg", path),
        ("b.SVG", shapes),
        ("c.dxf", &circle),
        ("d.dxf", &arcs),
        ("e.dxf", &bulges),
        ("f.dxf", &old),
    ] {
        let found = areas(name, text);
        assert_eq!(found.len(), 1, "{name}");
        let beyond = found[0] - (60.0 - round);
        assert!(beyond > 0.0 && beyond < most, "{name}: {beyond}");
    }
}

#[test]
fn what_is_wrong_with_a_drawing_is_said_with_its_line() {
    let svg = |inner: &str| drawing("a.svg", &format!("<svg>\n{inner}\n</svg>")).unwrap_err().to_string();
    assert!(svg("<path d='M0 0h5v5'/>").starts_with("line 2: the outline that begins at [0, 0] is open"));
    assert!(svg("<text>a</text>").starts_with("line 2: <text> is not read"));
    assert!(svg("<path d='M0 0 what'/>").starts_with("line 2: the path cannot be read"));
    assert!(svg("<circle r='1e400'/>").contains("should be a plain number"));
    assert!(svg("<rect width='3e4' height='2'/>").contains("check the unit"));
    assert!(svg("<path d='M0 0A1e300 1e300 0 0 1 1e300 5'/>").contains("far too large"));
    assert!(svg("<g>").starts_with("line "));
    let deep = format!("{}<path d='M0 0h5v5z'/>{}", "<g>\n".repeat(300), "</g>".repeat(300));
    assert!(svg(&deep).starts_with("line 256: more than 256 elements within each other"));
    assert_eq!(svg("<defs/>"), "there is no closed outline in the drawing");
    let dxf = |entity: &str| {
        drawing("a.dxf", &format!("0\nSECTION\n2\nENTITIES\n{entity}\n0\nENDSEC\n")).unwrap_err().to_string()
    };
    assert!(
        dxf("0\nLINE\n10\n0\n20\n0\n11\n1\n21\n0")
            .starts_with("line 5: the outline that begins at [0, 0] is open")
    );
    assert!(dxf("0\nSPLINE\n70\n1").starts_with("line 5: SPLINE is not read"));
    assert!(dxf("0\nLINE\n10\nzero").starts_with("line 8: expected a number"));
    assert!(dxf("solid").starts_with("line 5: expected a group code"));
    assert!(dxf("0\nCIRCLE\n40\n1\n210\n1\n230\n0").contains("tilted plane"));
}

#[test]
fn the_unit_of_a_drawing_counts() {
    let text = "<svg width='50mm' viewBox='0 0 100 20'><rect width='10' height='10'/></svg>";
    let file = FileBytes::whole(text.as_bytes().to_vec());
    let width = |unit, scale| {
        let spec = FileSpec { unit, ..FileSpec::new("a.svg", scale) };
        read(&spec, &file, 1e-3).map(|loops| loops[0].iter().map(|p| p.x).fold(0.0, f64::max))
    };
    // D is a metre.
    assert!((width(FileUnit::InFile, 1.0).unwrap() - 5e-3).abs() < 1e-15);
    assert_eq!(width(FileUnit::Beside, 1.0), Ok(10.0));
    let stated = width(FileUnit::Stated(crate::design::LengthUnit::Mm), 1e-3).unwrap_err().to_string();
    assert!(stated.starts_with("the file says that its unit is 0.5 mm, and the design says mm"), "{stated}");
    let dxf = |code: u8| {
        let head = format!("0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n{code}\n0\nENDSEC\n");
        super::dxf::metres(&head).unwrap()
    };
    assert_eq!([1, 4, 6, 0].map(dxf), [Some(0.0254), Some(1e-3), Some(1.0), None]);
}
