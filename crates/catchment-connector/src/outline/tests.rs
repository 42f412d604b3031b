//! Regions of loops, and equal outlines from both kinds of drawings.

use super::*;
use catchment_design::design::FileUnit;

fn square(low: f64, high: f64) -> Vec<DVec2> {
    vec![DVec2::splat(low), DVec2::new(high, low), DVec2::splat(high), DVec2::new(low, high)]
}

fn drawing(name: &str, text: &str) -> Result<Vec<Vec<DVec2>>, OutlineProblem> {
    let file = FileBytes::whole(text.as_bytes().to_vec());
    read(&FileSpec::new(name, 1.0), &file, 1e-3).map(|drawn| drawn.loops)
}

fn areas(name: &str, text: &str) -> Vec<f64> {
    let regions = regions(drawing(name, text).unwrap()).unwrap();
    regions.iter().map(|region| region.loops().map(|ring| super::area(ring)).sum()).collect()
}

#[test]
fn loops_nest() {
    let result =
        regions(vec![square(1.0, 2.0), square(0.0, 9.0), square(1.2, 1.8), square(3.0, 4.0)]).unwrap();
    let shapes: Vec<(f64, usize)> = result.iter().map(|r| (super::area(&r.outer), r.holes.len())).collect();
    assert_eq!(shapes.len(), 2);
    assert!(shapes.iter().any(|(area, holes)| (area - 81.0).abs() < 1e-12 && *holes == 2));
    assert!(shapes.iter().any(|(area, holes)| (area - 0.36).abs() < 1e-12 && *holes == 0));
    assert!(result.iter().flat_map(|r| &r.holes).all(|hole| super::area(hole) < 0.0));
}

#[test]
fn invalid_loops_are_refused() {
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

/// A plate of 10 by 6 with a round hole of radius 2: as a path, as shapes, and as a DXF drawing. Chords lie
/// inside the circle by at most the chord error.
#[test]
fn svg_and_dxf_give_the_same_plate_with_a_hole() {
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
        let result = areas(name, text);
        assert_eq!(result.len(), 1, "{name}");
        let beyond = result[0] - (60.0 - round);
        assert!(beyond > 0.0 && beyond < most, "{name}: {beyond}");
    }
}

#[test]
fn drawing_defects_are_reported_with_their_line() {
    let svg = |inner: &str| drawing("a.svg", &format!("<svg>\n{inner}\n</svg>")).unwrap_err().to_string();
    assert!(svg("<path d='M0 0h5v5'/>").starts_with("line 2: the outline that begins at [0, 0] is open"));
    assert!(svg("<text>a</text>").starts_with("line 2: <text> is not read"));
    assert!(svg("<path d='M0 0 what'/>").starts_with("line 2: the path cannot be read"));
    assert!(svg("<circle r='1e400'/>").contains("should be a plain number"));
    assert!(svg("<rect width='3e4' height='2'/>").contains("check the unit"));
    assert!(svg("<path d='M0 0A1e300 1e300 0 0 1 1e300 5'/>").contains("far too large"));
    assert!(svg("<g>").starts_with("line "));
    let deep = format!("{}<path d='M0 0h5v5z'/>{}", "<g>\n".repeat(300), "</g>".repeat(300));
    assert!(svg(&deep).starts_with("line 257: more than 256 elements within each other"));
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
    assert!(dxf("0\nCIRCLE\n10\n0\n20\n0\n40\n1\n210\n1\n230\n0").contains("tilted plane"));
}

#[test]
fn the_unit_of_a_drawing_counts() {
    let text = "<svg width='50mm' viewBox='0 0 100 20'><rect width='10' height='10'/></svg>";
    let file = FileBytes::whole(text.as_bytes().to_vec());
    let width = |unit, scale| {
        let spec = FileSpec { unit, ..FileSpec::new("a.svg", scale) };
        read(&spec, &file, 1e-3).map(|drawn| drawn.loops[0].iter().map(|p| p.x).fold(0.0, f64::max))
    };
    // D is a metre.
    assert!((width(FileUnit::InFile, 1.0).unwrap() - 5e-3).abs() < 1e-15);
    assert_eq!(width(FileUnit::Beside, 1.0), Ok(10.0));
    let stated =
        width(FileUnit::Stated(catchment_design::design::LengthUnit::Mm), 1e-3).unwrap_err().to_string();
    assert!(stated.starts_with("the file says that its unit is 0.5 mm, and the design says mm"), "{stated}");
    let dxf = |code: u8| {
        let head = format!("0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n{code}\n0\nENDSEC\n");
        super::dxf::metres(&head).unwrap()
    };
    assert_eq!([1, 4, 6, 0].map(dxf), [Some(0.0254), Some(1e-3), Some(1.0), None]);
}

/// Everything that may hide a shape, and the volume that is left: a plate of 10 by 10 with a hole of 2 by 2 and, in the hole, a post that is hidden.
#[test]
fn hidden_shapes_are_left_out() {
    let svg = |head: &str, post: &str| {
        format!("<svg {head}>\n<path d='M0 0h10v10h-10z M2 2h2v2h-2z'/>{post}\n</svg>")
    };
    let rect = |attributes: &str| format!("<rect x='2.5' y='2.5' width='1' height='1' {attributes}/>");
    let shown = svg("", &rect(""));
    assert_eq!(areas("a.svg", &shown), [96.0, 1.0], "seen");
    for post in [
        format!("<g display='none'>{}</g>", rect("")),
        format!("<g style='fill:red; DISPLAY : None'>{}</g>", rect("")),
        rect("style='display:none' display='inline'"),
        format!("<g visibility='hidden'>{}</g>", rect("")),
        format!("<g visibility='visible'><g visibility='collapse'>{}</g></g>", rect("visibility='inherit'")),
        format!("<style>.off {{ display: none }}</style><g class='on off'>{}</g>", rect("")),
        format!("{}<style>rect {{ visibility: hidden }}</style>", rect("")),
        format!("<defs><style>#a, .b {{ display: none }}</style></defs>{}", rect("id='a'")),
        format!(
            "<style><![CDATA[ /* .x {{ */ rect#a.b {{ display:none }} ]]></style>{}",
            rect("id='a' class='b c'")
        ),
        format!("<symbol>{0}</symbol><i:page>{0}</i:page>", rect("")),
    ] {
        let text = svg("xmlns:i='i'", &post);
        assert_eq!(areas("a.svg", &text), [96.0], "{post}");
    }
    // A shape that overrides the hiding is seen.
    for post in [
        format!("<g visibility='hidden'>{}</g>", rect("visibility='visible'")),
        format!("<style>.a {{ display: none }}</style>{}", rect("class='a' style='display:inline'")),
        format!("<style>rect {{ display: none }} .a {{ display: block }}</style>{}", rect("class='a'")),
        format!(
            "<style>.a {{ display: none }} rect.a {{ display: block }} .b {{ fill: none }}</style>{}",
            rect("class='a'")
        ),
        format!("<g fill='none' stroke='#000'>{}</g>", rect("")),
    ] {
        assert_eq!(areas("a.svg", &svg("", &post)), [96.0, 1.0], "{post}");
    }
    let file = |text: &str| FileBytes::whole(text.as_bytes().to_vec());
    let hidden = svg("", &format!("{}<g display='none'>{}</g>", rect("visibility='hidden'"), rect("")));
    assert_eq!(read(&FileSpec::new("a.svg", 1.0), &file(&hidden), 1e-3).unwrap().hidden, 2);
    let all = "<svg><g display='none'><rect width='1' height='1'/></g></svg>";
    assert!(
        drawing("a.svg", all).unwrap_err().to_string().contains("1 hidden entities are left out: show those")
    );
}

#[test]
fn unsupported_svg_features_are_refused_with_their_line() {
    let error_of = |post: &str| {
        drawing("a.svg", &format!("<svg>\n<rect width='9' height='9'/>\n{post}</svg>"))
            .unwrap_err()
            .to_string()
    };
    let shape = "<path d='M1 1h1v1z'/>";
    for (post, what) in [
        (format!("<g clip-path='url(#a)'>{shape}</g>"), "`clip-path` of <g> is not read"),
        (format!("<g style='mask:url(#a)'>{shape}</g>"), "`mask` of <g>"),
        (format!("<g filter='url(#a)'>{shape}</g>"), "`filter` of <g>"),
        (format!("<g style='transform:rotate(3deg)'>{shape}</g>"), "`transform` of <g>"),
        (format!("<style>g {{ translate: 3px }}</style><g>{shape}</g>"), "`translate` of <g>"),
        ("<circle r='1' style='r:3px'/>".to_owned(), "`r` of <circle>"),
        ("<path transform='scale(2)' transform-origin='center' d='M1 1h1v1z'/>".to_owned(), "`transform-origin` is read as two"),
        (
            "<path transform='scale(2)' style='transform-box:fill-box' transform-origin='1 1' d='M1 1h1v1z'/>".to_owned(),
            "`transform-origin` is read as two",
        ),
        ("<path fill='none' d='M1 1h1v1z'/>".to_owned(), "<path> has neither a fill nor a stroke"),
        ("<path fill='none' stroke='red' stroke-width='0' d='M1 1h1v1z'/>".to_owned(), "neither a fill nor a stroke"),
        (format!("<g opacity='0%'>{shape}</g>"), "<path> has an opacity of 0"),
        ("<path systemLanguage='de' d='M1 1h1v1z'/>".to_owned(), "`systemLanguage` is not read"),
        ("<rect width='2' height='2'><animate attributeName='x'/></rect>".to_owned(), "<animate> is not read"),
        ("<set attributeName='display' to='none'/>".to_owned(), "<set> is not read"),
        ("<shape/>".to_owned(), "<shape> is not read"),
        ("<x:path d='M1 1h1v1z'/>".to_owned(), "<path> of another namespace is not read"),
        (format!("<g xmlns='y'>{shape}</g>"), "<g> of another namespace"),
        (format!("<style>svg > g {{ display: none }}</style><g>{shape}</g>"), "the style of `svg > g` decides what is drawn"),
        (format!("<style>@media print {{ g {{ display: none }} }}</style><g>{shape}</g>"), "the rule `@media print`"),
        (format!("<style media='print'>g {{ display: none }}</style><g>{shape}</g>"), "a style sheet for `print`"),
        (format!("<g style='display: none !important'>{shape}</g>"), "`display: none !important` is not read"),
        ("<polygon points='0,0 9,0 9,9 oops 0,9'/>".to_owned(), "its points cannot be read"),
        ("<polygon points='0,0 9,0 9,9 0'/>".to_owned(), "an odd count of numbers"),
        ("<rect width='-3' height='2'/>".to_owned(), "`width` is below 0"),
        ("<circle r='-3'/>".to_owned(), "`r` is below 0"),
        ("<path d='M0 0h5v5z'/><path d='M0 0h5v5z".to_owned(), "this is no SVG picture"),
        ("</svg><svg>".to_owned(), "something follows the end"),
    ] {
        let result = error_of(&post);
        assert!(result.contains(what), "{post}: {result}");
        assert!(result.starts_with("line 3: "), "{post}: {result}");
    }
    // Elements that draw nothing may use any feature.
    let fine = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:svg='http://www.w3.org/2000/svg'>                <svg:g clip-path='none'><svg:rect width='9' height='9'/></svg:g><linearGradient/><title>a</title></svg>";
    assert_eq!(areas("a.svg", fine), [81.0]);
}

/// A transform about a point of its own: a quarter turn of a rectangle about its centre.
#[test]
fn a_transform_has_its_origin() {
    let corners = |attributes: &str| {
        let text = format!(
            "<svg><rect x='0' y='0' width='4' height='2' transform='rotate(90)' {attributes}/></svg>"
        );
        let loops = drawing("a.svg", &text).unwrap();
        let low = loops[0].iter().fold(DVec2::INFINITY, |low, p| low.min(*p));
        let high = loops[0].iter().fold(DVec2::NEG_INFINITY, |high, p| high.max(*p));
        [low.x, low.y, high.x, high.y].map(|c| (c * 1e9).round() / 1e9 + 0.0)
    };
    // y is up: the picture's y from −1 to 3.
    assert_eq!(corners("transform-origin='2 1'"), [1.0, -3.0, 3.0, 1.0]);
    assert_eq!(corners("style='transform-origin:2px 1px'"), [1.0, -3.0, 3.0, 1.0]);
    assert_eq!(corners(""), [-2.0, -4.0, 0.0, 0.0]);
}

/// Attributes are counted on the tokens that are read: quotes in a text change nothing.
#[test]
fn too_many_attributes_or_elements_are_refused() {
    let crowd = |count: usize| (0..count).map(|k| format!("a{k}='' ")).collect::<Vec<_>>().concat();
    for text in ["", "='", "=\"", "<!-- ' -->=\"", "<![CDATA[ <g a=\"]]>"] {
        let result =
            drawing("a.svg", &format!("<svg>{text}\n<g {}/></svg>", crowd(201))).unwrap_err().to_string();
        assert_eq!(result, "line 2: more than 200 attributes of an element: save it as plain SVG", "{text}");
    }
    let many = drawing("a.svg", &format!("<svg>{}</svg>", "<g/>".repeat(100_000))).unwrap_err().to_string();
    assert!(many.starts_with("line 1: more than 100000 elements"), "{many}");
}

fn dxf(tables: &str, entities: &str) -> String {
    format!("{tables}0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n")
}

/// A square about the origin.
fn polyline(half: f64, groups: &str) -> String {
    let corner = |[x, y]: [f64; 2]| format!("10\n{x}\n20\n{y}\n");
    let corners: String =
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|c| corner(c.map(|c| c * half))).concat();
    format!("0\nLWPOLYLINE\n{groups}90\n4\n70\n1\n{corners}")
}

#[test]
fn entities_that_are_not_shown_are_no_solid() {
    let layer = |name: &str, flags: u8, color: i8| format!("0\nLAYER\n2\n{name}\n70\n{flags}\n62\n{color}\n");
    let tables = format!(
        "0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n70\n3\n{}{}{}{}0\nENDTAB\n0\nENDSEC\n",
        layer("shown", 0, 7),
        layer("Off", 0, -7),
        layer("frozen", 1, 7),
        layer("locked", 4, 7),
    );
    let plate = polyline(5.0, "8\nshown\n") + &polyline(2.0, "8\nunknown\n");
    let of = |post: &str| areas("a.dxf", &dxf(&tables, &format!("{plate}{post}")));
    for seen in ["", "8\nlocked\n", "60\n0\n", "67\n0\n"] {
        assert_eq!(of(&polyline(1.0, seen)), [84.0, 4.0], "{seen:?}");
    }
    for hidden in ["8\nOFF\n", "8\nFrozen\n", "60\n1\n", "67\n1\n"] {
        assert_eq!(of(&polyline(1.0, hidden)), [84.0], "{hidden:?}");
        // A hidden entity may be of a kind that the reader does not support.
        assert_eq!(of(&format!("0\nINSERT\n{hidden}2\nblock\n")), [84.0], "{hidden:?}");
        let old = format!(
            "0\nPOLYLINE\n{hidden}70\n1\n0\nVERTEX\n10\n0\n20\n0\n0\nVERTEX\n10\n1\n20\n1\n0\nSEQEND\n"
        );
        assert_eq!(of(&old), [84.0], "{hidden:?}");
    }
    let file = FileBytes::whole(dxf(&tables, &(plate.clone() + &polyline(1.0, "67\n1\n"))).into_bytes());
    assert_eq!(read(&FileSpec::new("a.dxf", 1.0), &file, 1e-3).unwrap().hidden, 1);
    // Control points of a curve are not on it.
    let vertex = |x: f64, y: f64, flags: u8| format!("0\nVERTEX\n10\n{x}\n20\n{y}\n70\n{flags}\n");
    let fitted =
        [vertex(0.0, 0.0, 8), vertex(9.0, 9.0, 16), vertex(1.0, 0.0, 8), vertex(1.0, 1.0, 8)].concat();
    let fitted = format!("0\nPOLYLINE\n70\n5\n{fitted}0\nSEQEND\n");
    assert_eq!(areas("a.dxf", &dxf("", &fitted)), [0.5]);
}

#[test]
fn a_broken_dxf_drawing_is_refused_with_its_line() {
    let error_of = |entities: &str| drawing("a.dxf", &dxf("", entities)).unwrap_err().to_string();
    for (entities, what) in [
        (
            "0\nLWPOLYLINE\n70\n1\n10\n0\n20\n0\n10\n1\n10\n1\n20\n1\n",
            "line 15: a corner has no y (group 20)",
        ),
        ("0\nLWPOLYLINE\n70\n1\n10\n0\n20\n0\n10\n1\n", "line 5: LWPOLYLINE has 2 x and 1 y of corners"),
        ("0\nLWPOLYLINE\n90\n5\n10\n0\n20\n0\n", "line 5: LWPOLYLINE announces 5 corners and has 1"),
        ("0\nLINE\n10\n0\n20\n0\n11\n1\n", "line 5: LINE has no group 21"),
        ("0\nCIRCLE\n10\n0\n20\n0\n", "line 5: CIRCLE has no group 40"),
        ("0\nCIRCLE\n10\n0\n20\n0\n40\n-3\n", "line 5: CIRCLE has the radius -3"),
        ("0\nARC\n10\n0\n20\n0\n40\n1\n50\n0\n", "line 5: ARC has no group 51"),
        ("0\nVERTEX\n10\n0\n20\n0\n", "line 5: a VERTEX belongs to no POLYLINE"),
        ("0\nPOLYLINE\n70\n1\n0\nVERTEX\n10\n0\n20\n0\n", "line 5: the POLYLINE has no SEQEND"),
        ("0\nPOLYLINE\n70\n16\n0\nSEQEND\n", "line 5: a mesh of polylines is not read"),
        ("0\nLINE\n10\n0\n60\nx\n", "line 10: expected a number"),
    ] {
        assert!(error_of(entities).starts_with(what), "{entities:?}: {}", error_of(entities));
    }
    let cut = "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n10\n0\n20\n0\n40\n2\n";
    assert!(drawing("a.dxf", cut).unwrap_err().to_string().starts_with("line 11: the DXF file was cut off"));
}

/// Hundreds of holes in a plate, which cost an hour of comparing bridges when all were sorted for each.
#[test]
fn a_plate_with_many_holes_is_a_solid() {
    let hole =
        |k: usize| format!("M{} {}h1l-.5 1z", 1.0 + 2.0 * (k % 25) as f64, 1.0 + 2.0 * (k / 25) as f64);
    let holes: String = (0..625).map(hole).collect();
    let text = format!("<svg><path d='M0 0h51v51h-51z {holes}'/></svg>");
    let regions = regions(drawing("a.svg", &text).unwrap()).unwrap();
    let plate = crate::part::extruded(&regions[0], 1.0).unwrap();
    assert!((plate.volume() - (51.0 * 51.0 - 625.0 / 2.0)).abs() < 1e-6, "{}", plate.volume());
}
