//! Wavefront OBJ: corners, and a group of faces for every convex body.
//!
//! Groups are named after their origin: `body3_fixed0_moving1_slice7`. Faces are polygons, counter-clockwise
//! seen from outside; corners are not shared between bodies.

use super::heading;
use catchment_core::document::number;
use catchment_core::method::partition::{Solid, Solids};
use std::fmt::Write;

/// A shape as an OBJ file.
pub fn obj(shape: &Solids) -> String {
    let mut text = format!("# {}\n", heading(shape));
    let mut first = 1;
    for (k, solid) in shape.solids.iter().enumerate() {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "g {}", name(k, solid));
        for v in &solid.vertices {
            let _ = writeln!(text, "v {} {} {}", number(v.x), number(v.y), number(v.z));
        }
        for face in &solid.faces {
            text.push('f');
            for corner in face {
                let _ = write!(text, " {}", first + corner);
            }
            text.push('\n');
        }
        first += solid.vertices.len();
    }
    text
}

fn name(number: usize, solid: &Solid) -> String {
    let mut name = format!("body{number}");
    let parts = [("fixed", solid.fixed), ("moving", solid.moving), ("slice", solid.slice.map(|(k, _)| k))];
    for (part, number) in parts {
        if let Some(number) = number {
            let _ = write!(name, "_{part}{number}");
        }
    }
    name
}
