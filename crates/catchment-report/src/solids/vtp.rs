//! VTK's `PolyData` in its XML form, as text: points, polygons, and numbers per polygon.
//!
//! | array | of every face |
//! |---|---|
//! | `body` | number of its convex body |
//! | `fixed_piece`, `moving_piece` | numbers of the convex pieces of the halves from which it was made; −1 without a piece |
//! | `slice`, `angle` | number of the lower slice of its angle, and the middle between both slices in rad; −1 and 0 without free rotations |
//! | `height` | z of the middle of the face, in D |
//! | `up` | z of its outward normal, if it is part of a solid: above 0 it can be met from above |
//!
//! Text keeps every digit: reading it back gives the computed numbers. Corners are not shared between bodies.

use super::{heading, middle};
use catchment_core::document::number;
use catchment_core::method::partition::{Solid, Solids};
use glam::DVec3;
use std::fmt::{Display, Write};

/// A shape as a `.vtp` file.
pub fn vtp(shape: &Solids) -> String {
    let solids = &shape.solids;
    let points: usize = solids.iter().map(|solid| solid.vertices.len()).sum();
    let faces = || {
        let numbered = solids.iter().enumerate();
        numbered.flat_map(|(k, solid)| solid.faces.iter().map(move |face| (k, solid, face)))
    };
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = writeln!(text, "<?xml version=\"1.0\"?>\n<!-- {} -->", heading(shape));
    text.push_str("<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\">\n<PolyData>\n");
    let _ = writeln!(
        text,
        "<Piece NumberOfPoints=\"{points}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" \
         NumberOfPolys=\"{}\">",
        faces().count()
    );
    text.push_str("<CellData Scalars=\"height\">\n");
    let piece = |piece: Option<usize>| piece.map_or_else(|| "-1".to_owned(), |number| number.to_string());
    array(&mut text, "Int64", "body", faces().map(|(k, ..)| k));
    array(&mut text, "Int64", "fixed_piece", faces().map(|(_, solid, _)| piece(solid.fixed)));
    array(&mut text, "Int64", "moving_piece", faces().map(|(_, solid, _)| piece(solid.moving)));
    array(&mut text, "Int64", "slice", faces().map(|(_, solid, _)| piece(solid.slice.map(|(k, _)| k))));
    let angle = |solid: &Solid| solid.slice.map_or(0.0, |(_, [low, high])| f64::midpoint(low, high));
    array(&mut text, "Float64", "angle", faces().map(|(_, solid, _)| number(angle(solid))));
    array(&mut text, "Float64", "height", faces().map(|(_, solid, face)| number(middle(solid, face).z)));
    array(&mut text, "Float64", "up", faces().map(|(_, solid, face)| number(up(solid, face))));
    text.push_str("</CellData>\n<Points>\n");
    let corners = solids.iter().flat_map(|solid| &solid.vertices);
    let triple = |v: &DVec3| format!("{} {} {}", number(v.x), number(v.y), number(v.z));
    array(&mut text, "Float64\" NumberOfComponents=\"3", "places", corners.map(triple));
    text.push_str("</Points>\n<Polys>\n");
    let mut first = 0;
    let connectivity = solids.iter().flat_map(|solid| {
        let from = first;
        first += solid.vertices.len();
        solid.faces.iter().map(move |face| {
            face.iter().map(|corner| (from + corner).to_string()).collect::<Vec<_>>().join(" ")
        })
    });
    array(&mut text, "Int64", "connectivity", connectivity);
    let ends = faces().scan(0, |end, (.., face)| {
        *end += face.len();
        Some(*end)
    });
    array(&mut text, "Int64", "offsets", ends);
    text.push_str("</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n");
    text
}

/// A data array, a value or tuple per line.
fn array(text: &mut String, kind: &str, name: &str, values: impl Iterator<Item = impl Display>) {
    let _ = writeln!(text, "<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">");
    for value in values {
        let _ = writeln!(text, "{value}");
    }
    text.push_str("</DataArray>\n");
}

/// z of a face's unit normal; 0 for a flat body, which has no outside.
fn up(solid: &Solid, face: &[usize]) -> f64 {
    if solid.faces.len() == 1 {
        return 0.0;
    }
    let at = |k: usize| solid.vertices[face[k]] - solid.vertices[face[0]];
    let area: DVec3 = (2..face.len()).map(|k| at(k - 1).cross(at(k))).sum();
    area.normalize_or_zero().z
}
