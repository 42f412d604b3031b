//! The two halves as solids: closed surfaces, prepared for contact.
//!
//! ```text
//! Design ──▶ Connector { fixed: Half, moving: Half }      lengths in D
//!                        │            └ mounted: turned face down, origin at its own face centre
//!                        └ the world frame: origin at its face centre, facing +z
//! ```
//!
//! A [`Half`] is its closed surface, independent of its description: convex pieces, parts, and bodies that
//! touch or overlap are united (`mesh::union`) before any computation. The original solids are kept beside it
//! for methods that need convexity.

mod family;
mod hull;
pub mod mesh;
mod obj;
mod outline;
mod packed;
mod part;
mod place;
mod ply;
mod problem;
mod round;
mod source;
mod step;
pub mod stl;
mod surface;
mod threemf;
mod ungendered;

pub use hull::{HullError, MAX_POINTS, convex_hull};
pub use mesh::MeshProblem;
pub use mesh::union::UnionProblem;
pub use outline::OutlineProblem;
pub use packed::PackedError;
pub use part::PartGeometryError;
pub use place::turn_between;
pub use problem::{GeometryDefect, HalfRole};
pub use source::{FileBytes, FileReader, HalfSource, UnitProblem};
pub use step::StepProblem;
#[doc(hidden)]
pub use step::bodies_of_answer;
pub use surface::{Edge, Facet, Surface, SurfaceError};

use catchment_base::exec::Exec;
use catchment_base::pose::{Mount, PoseError};
use catchment_design::design::{
    ConnectorSpec, Contents, Design, FamilySpec, FilesInMemory, HalfSpec, OwnSpec,
};
use glam::{DAffine3, DVec3};

/// A half of a connector.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Half {
    /// Its closed surface, with outward normals: one for every body, if bodies share no area and no volume.
    /// Contact, motion, symmetry, features and mass use nothing else.
    pub surfaces: Vec<Surface>,
    /// The original solids, if they differ from its surfaces: their union is the half. They may touch and
    /// overlap.
    pub pieces: Vec<Surface>,
}

impl Half {
    /// A half of bodies that share no area and no volume.
    pub const fn of(surfaces: Vec<Surface>) -> Self {
        Self { surfaces, pieces: Vec::new() }
    }

    /// The union of solids that may touch and overlap, with coordinates in double precision, in D.
    ///
    /// # Errors
    /// The solids have no union that closes and encloses the same region.
    pub fn union_of(solids: Vec<Surface>) -> Result<Self, UnionProblem> {
        Self::united(solids, mesh::union::EXACT, &Exec::new())
    }

    /// The same, for coordinates of the given exactness.
    fn united(solids: Vec<Surface>, exactness: f64, exec: &Exec) -> Result<Self, UnionProblem> {
        let surfaces = mesh::union::united(&solids, exactness, exec)?;
        let pieces = if surfaces.len() == solids.len() { Vec::new() } else { solids };
        Ok(Self { surfaces, pieces })
    }

    /// The solids that it was written as.
    pub fn solids(&self) -> &[Surface] {
        if self.pieces.is_empty() { &self.surfaces } else { &self.pieces }
    }

    /// The same half with every vertex moved by `map`, which must be rigid and orientation preserving.
    #[must_use]
    pub fn mapped(&self, map: impl Fn(DVec3) -> DVec3 + Copy) -> Self {
        let mapped = |surfaces: &[Surface]| surfaces.iter().map(|s| s.mapped(map)).collect();
        Self { surfaces: mapped(&self.surfaces), pieces: mapped(&self.pieces) }
    }

    /// Lowest and highest corner of the box around it.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let boxes = self.surfaces.iter().map(Surface::bounds);
        boxes.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), (a, b)| (low.min(a), high.max(b)))
    }

    /// The middle of its three extents.
    pub fn middle_extent(&self) -> f64 {
        let (low, high) = self.bounds();
        let mut sides = (high - low).to_array();
        sides.sort_by(f64::total_cmp);
        sides[1]
    }

    /// The same half, every length times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let mut half = self.clone();
        let surfaces = half.surfaces.iter_mut().chain(&mut half.pieces);
        for point in surfaces.flat_map(|surface| &mut surface.vertices) {
            *point *= factor;
        }
        half
    }

    /// The mirror image by `map`, a reflection.
    #[must_use]
    pub fn reflected(&self, map: impl Fn(DVec3) -> DVec3 + Copy) -> Self {
        let reflected = |surfaces: &[Surface]| surfaces.iter().map(|s| s.reflected(map)).collect();
        Self { surfaces: reflected(&self.surfaces), pieces: reflected(&self.pieces) }
    }
}

/// The half of a design, with files read from disk, at the scales of the files, without a limit on its size.
pub fn of_half(spec: &HalfSpec, side: HalfRole, exec: &Exec) -> Result<Half, Vec<GeometryDefect>> {
    Ok(HalfSource::of(spec, side, &source::disk::read)?.build(side, Size::Any, exec)?.half)
}

/// How large a half may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Size {
    /// About D.
    Plausible,
    /// Whatever it is: D is not known yet.
    Any,
}

/// A half and the content of its files, or all its errors.
type Sourced = Result<source::Built, Vec<GeometryDefect>>;

/// The two halves, in the frames the contact room works in.
#[derive(Debug, Clone, PartialEq)]
pub struct Connector {
    /// The fixed half in the world frame (origin at its face centre).
    pub fixed: Half,
    /// The moving half, mounted, origin at its face centre.
    pub moving: Half,
    /// Content of the meshes from which the halves were built.
    pub contents: Contents,
    /// Origin of the halves.
    pub origin: Origin,
}

/// Origin of the halves: the transforms from the coordinates in which each was drawn to its frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Origin {
    /// From the coordinates of the fixed half's file, or of its pieces, to its frame in D.
    pub fixed: DAffine3,
    /// The same of the moving half.
    pub moving: DAffine3,
    /// Distance of the aligned halves as drawn, along the approach, in D; negative if they overlap. `None` if
    /// nothing was moved.
    pub apart: Option<f64>,
    /// Pose error of the rest that the halves reached when released as drawn, if it serves as the mated pose.
    pub settled: Option<PoseError>,
}

impl Origin {
    /// Halves that were drawn in their frames.
    pub const HERE: Self =
        Self { fixed: DAffine3::IDENTITY, moving: DAffine3::IDENTITY, apart: None, settled: None };

    /// A point of a half, given in its frame, in the coordinates in which the half was drawn; those in D, whatever the unit of its file.
    pub fn drawn(&self, side: HalfRole, point: DVec3) -> DVec3 {
        let from_file = match side {
            HalfRole::Fixed => self.fixed,
            HalfRole::Moving => self.moving,
        };
        from_file.inverse().transform_point3(point) * from_file.matrix3.determinant().abs().cbrt()
    }
}

impl Connector {
    /// Two halves that already are in these frames.
    pub const fn from_halves(fixed: Half, moving: Half) -> Self {
        let contents = Contents { fixed: Vec::new(), moving: Vec::new() };
        Self { fixed, moving, contents, origin: Origin::HERE }
    }

    /// Builds the halves of a design, mesh files read from disk, and places them in the frames of the contact room.
    ///
    /// # Errors
    /// Everything that is wrong with the geometry, each with its place.
    pub fn build(design: &Design) -> Result<Self, Vec<GeometryDefect>> {
        Self::build_with(design, &source::disk::read)
    }

    /// The same with some of the files in memory, cancelled if a stop is requested.
    pub fn build_on(
        design: &Design,
        files: &FilesInMemory,
        exec: &Exec,
    ) -> Result<Self, Vec<GeometryDefect>> {
        Self::build_within(design, &source::beside(files), exec)
    }

    /// Builds the halves of a design; `read` gives the mesh files.
    ///
    /// # Errors
    /// Everything that is wrong with the geometry, each with its place.
    pub fn build_with(design: &Design, read: FileReader<'_>) -> Result<Self, Vec<GeometryDefect>> {
        Self::build_within(design, read, &Exec::new())
    }

    /// The same, cancelled if a stop is requested while a STEP file is meshed.
    ///
    /// # Errors
    /// All errors of the geometry, each with its place.
    pub fn build_within(
        design: &Design,
        read: FileReader<'_>,
        exec: &Exec,
    ) -> Result<Self, Vec<GeometryDefect>> {
        let mount = design.alignment.mount;
        match &design.connector {
            ConnectorSpec::Family(spec) => Self::of_family(spec, mount),
            ConnectorSpec::Own(own) => {
                // Parts are drawn in the unit of the design.
                let half = |spec: &HalfSpec, side| -> Sourced {
                    let built = HalfSource::of(spec, side, read)?.build(side, Size::Plausible, exec)?;
                    let scale = matches!(spec, HalfSpec::Parts(_)).then_some(1.0 / design.width);
                    Ok(source::Built { scale: built.scale.or(scale), ..built })
                };
                Self::of_own(
                    [half(&own.fixed, HalfRole::Fixed), half(&own.moving, HalfRole::Moving)],
                    own,
                    mount,
                )
            }
        }
    }

    /// Own halves of any size beside D, and the larger lateral extent of either as drawn.
    pub fn unsized_on(
        own: &OwnSpec,
        mount: Mount,
        files: &FilesInMemory,
        exec: &Exec,
    ) -> Result<(Self, f64), Vec<GeometryDefect>> {
        let half = |spec: &HalfSpec, side| -> Sourced {
            HalfSource::of(spec, side, &source::beside(files))?.build(side, Size::Any, exec)
        };
        let halves = [half(&own.fixed, HalfRole::Fixed), half(&own.moving, HalfRole::Moving)];
        let wide = |built: &source::Built| {
            let (low, high) = built.half.bounds();
            (high - low).truncate().max_element()
        };
        let widest = halves.iter().flatten().map(wide).fold(0.0, f64::max);
        Ok((Self::of_own(halves, own, mount)?, widest))
    }

    /// The halves of a family.
    ///
    /// # Errors
    /// Every parameter that makes no solid.
    pub fn of_family(spec: &FamilySpec, mount: Mount) -> Result<Self, Vec<GeometryDefect>> {
        Ok(Self::placed(&family::draw(spec)?, mount))
    }

    /// Builds two halves that face +z as drawn; `face_height` is the z of both face centres, in D. No file is touched.
    ///
    /// # Errors
    /// Everything that is wrong with either.
    pub fn from_sources(
        fixed: &HalfSource,
        moving: &HalfSource,
        face_height: f64,
        mount: Mount,
    ) -> Result<Self, Vec<GeometryDefect>> {
        let exec = Exec::new();
        let nothing = || HalfSpec::Pieces(Vec::new());
        let own = OwnSpec::new(face_height, nothing(), nothing());
        let build = |source: &HalfSource, side| source.build(side, Size::Plausible, &exec);
        Self::of_own([build(fixed, HalfRole::Fixed), build(moving, HalfRole::Moving)], &own, mount)
    }

    /// Places halves that were built; a face centre still to be found is put at the origin of the drawing.
    fn of_own(
        [fixed, moving]: [Sourced; 2],
        own: &OwnSpec,
        mount: Mount,
    ) -> Result<Self, Vec<GeometryDefect>> {
        match (fixed, moving) {
            (Ok(fixed), Ok(moving)) => {
                let frames = place::frames(own, mount);
                let [placed_fixed, placed_moving] = [(&fixed, frames[0]), (&moving, frames[1])]
                    .map(|(built, f)| built.half.mapped(|p| f.transform_point3(p)));
                let scale = |scale: Option<f64>| DAffine3::from_scale(DVec3::splat(scale.unwrap_or(1.0)));
                let origin = Origin {
                    fixed: frames[0] * scale(fixed.scale),
                    moving: frames[1] * scale(moving.scale),
                    apart: None,
                    settled: None,
                };
                let contents = Contents { fixed: fixed.contents, moving: moving.contents };
                Ok(Self { fixed: placed_fixed, moving: placed_moving, contents, origin })
            }
            (fixed, moving) => Err([fixed, moving].into_iter().filter_map(Result::err).flatten().collect()),
        }
    }

    /// The same halves, moved on in their frames.
    #[must_use]
    pub fn moved(mut self, fixed: DVec3, moving: DVec3, apart: f64) -> Self {
        self.fixed = self.fixed.mapped(|p| p + fixed);
        self.moving = self.moving.mapped(|p| p + moving);
        self.origin.fixed = DAffine3::from_translation(fixed) * self.origin.fixed;
        self.origin.moving = DAffine3::from_translation(moving) * self.origin.moving;
        self.origin.apart = Some(apart);
        self
    }

    /// The same halves, with the moving half transformed by a rigid map to its rest, at the pose error
    /// `error`.
    #[must_use]
    pub fn settled(mut self, map: DAffine3, error: PoseError) -> Self {
        self.origin.settled = Some(error);
        self.moving = self.moving.mapped(|p| map.transform_point3(p));
        self.origin.moving = map * self.origin.moving;
        self
    }

    /// Moves both face centres to the origin and mounts the moving half.
    fn placed(drawn: &family::DrawnHalves, mount: Mount) -> Self {
        let face = DVec3::new(0.0, 0.0, drawn.face_height);
        Self::from_halves(drawn.fixed.mapped(|p| p - face), drawn.moving.mapped(|p| mount.apply(p - face)))
    }
}
