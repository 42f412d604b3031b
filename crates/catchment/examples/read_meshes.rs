//! Reads mesh files one by one, each as a half scaled to its own width. Prints whether it bounds a solid, and the mesh preparation:
//!
//! ```console
//! $ cargo run --release --example read_meshes -- FILE…
//! ok    0.02 s   1520 triangles  dock.stl
//! ```
//!
//! `SIMPLIFY=0.001` in the environment simplifies each mesh to that fraction of its width; `REPAIR=0` disables repair.

use catchment::connector::{Connector, FileBytes, GeometryDefect, HalfSource, MeshProblem};
use catchment::design::{FileSpec, MeshPreparation};
use catchment::pose::Mount;
use std::env;
use std::error::Error;
use std::io::{self, Write};
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let simplify = env::var("SIMPLIFY").ok().map(|text| text.parse()).transpose()?;
    let treatment = MeshPreparation {
        repair: env::var("REPAIR").as_deref() != Ok("0"),
        simplify,
        ..MeshPreparation::DEFAULT
    };
    let other = HalfSource::Family(catchment::design::FamilySpec::new(catchment::design::Family::Pyramid));
    let mut out = io::stdout().lock();
    for path in env::args().skip(1) {
        let file = FileBytes::whole(std::fs::read(&path)?);
        let start = Instant::now();
        let read = |scale| {
            let spec = FileSpec { treatment, ..FileSpec::new(&path, scale) };
            let mesh = HalfSource::Mesh { spec, file: file.clone() };
            Connector::from_sources(&mesh, &other, 0.0, Mount::X)
        };
        let mut result = read(1.0);
        let width = result.as_ref().err().and_then(|problems| {
            problems.iter().find_map(|problem| match problem {
                GeometryDefect::Mesh { error: MeshProblem::Unit { width }, .. } => Some(*width),
                _ => None,
            })
        });
        if let Some(width) = width {
            result = read(1.0 / width);
        }
        let time = start.elapsed().as_secs_f64();
        match result {
            Ok(connector) => {
                let held = connector.contents.fixed.first().cloned();
                let (count, repairs) = held.map(|held| (held.triangles, held.repairs)).unwrap_or_default();
                let done = if repairs.is_none() { String::new() } else { repairs.to_string() };
                writeln!(out, "ok\t{time:.2} s\t{count} triangles\t{path}\t{done}")?;
            }
            Err(problems) => {
                let printout: Vec<String> = problems.iter().map(ToString::to_string).collect();
                writeln!(out, "bad\t{time:.2} s\t\t{path}\t{}", printout.join(" | "))?;
            }
        }
    }
    Ok(())
}
