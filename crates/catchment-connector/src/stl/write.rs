//! Output of a half as STL: for other programs, and for round-trip tests.

use crate::{Half, Surface};
use glam::DVec3;
use std::io::{self, Write};

/// The two dialects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StlEncoding {
    /// Text, all digits.
    Ascii,
    /// Single precision: coordinates are rounded to 6e-8 of their size.
    Binary,
}

/// Writes all surfaces of `half` as one mesh, in its own coordinates.
///
/// The halves of a [`Connector`](crate::Connector) have their face centre at the origin, and the
/// moving half is mounted; for use in a design file, rotate it back with `mapped(|p| mount.apply(p))` and set
/// `face_height = 0`.
pub fn write(half: &Half, format: StlEncoding, out: &mut impl Write) -> io::Result<()> {
    let triangles: Vec<[DVec3; 3]> = half.surfaces.iter().flat_map(corners).collect();
    match format {
        StlEncoding::Ascii => {
            writeln!(out, "solid half")?;
            for t in &triangles {
                let n = normal(t);
                writeln!(out, "  facet normal {:e} {:e} {:e}\n    outer loop", n.x, n.y, n.z)?;
                for p in t {
                    writeln!(out, "      vertex {} {} {}", p.x, p.y, p.z)?;
                }
                writeln!(out, "    endloop\n  endfacet")?;
            }
            writeln!(out, "endsolid half")
        }
        StlEncoding::Binary => {
            let mut header = [0u8; 80];
            header[..9].copy_from_slice(b"catchment");
            out.write_all(&header)?;
            let count = u32::try_from(triangles.len()).map_err(io::Error::other)?;
            out.write_all(&count.to_le_bytes())?;
            for t in &triangles {
                for p in [normal(t), t[0], t[1], t[2]] {
                    for value in p.to_array() {
                        out.write_all(&(value as f32).to_le_bytes())?;
                    }
                }
                out.write_all(&[0, 0])?;
            }
            Ok(())
        }
    }
}

fn normal([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

/// The corners of the triangles of a surface.
fn corners(surface: &Surface) -> Vec<[DVec3; 3]> {
    surface.triangles().into_iter().map(|t| t.map(|k| surface.vertices[k as usize])).collect()
}
