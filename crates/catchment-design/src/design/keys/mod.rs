//! The design file as one table: every key with its place, type, range and meaning.
//!
//! The reader checks files by this table, and the JSON schema and the commented templates are generated from
//! it, so that the three always agree.

mod key;

pub use key::{Applies, DesignTable, Key, Range, ValueKind};

use super::family::{self, Family};
use std::f64::consts::PI;

/// Version of the design format.
pub const SCHEMA: i64 = 1;

const fn key(table: DesignTable, name: &'static str, kind: ValueKind, doc: &'static str) -> Key {
    Key { table, name, kind, applies: Applies::Always, doc }
}

const fn parameter(name: &'static str, applies: Applies, kind: ValueKind, doc: &'static str) -> Key {
    Key { table: DesignTable::Connector, name, kind, applies, doc }
}

const LOCKING: Applies = Applies::Families(&[Family::XFace3dLocking]);
const PINS_ONLY: Applies = Applies::Families(&[Family::PinHole]);
const WITH_PLAY: Applies = Applies::Families(&[Family::PinHole, Family::XFace3dLocking]);
const LAYERED: Applies = Applies::Families(&[Family::XFace]);
const ROUND: Applies = Applies::Families(&[Family::Cone, Family::PinHole]);

macro_rules! keys {
    ($($(#[$doc:meta])* $name:ident = $key:expr;)*) => {
        $($(#[$doc])* pub const $name: Key = $key;)*
        /// Every key, in the order of the documentation.
        pub const KEYS: &[&Key] = &[$(&$name),*];
    };
}

keys! {
    /// `schema`
    SCHEMA_KEY = key(DesignTable::Root, "schema", ValueKind::Whole { min: 1, max: 1 },
        "Version of this format: 1.");
    /// `name`
    NAME = key(DesignTable::Root, "name", ValueKind::Line,
        "Name of the design in reports.");
    /// `[connector]`
    CONNECTOR = key(DesignTable::Root, "connector", ValueKind::Table(DesignTable::Connector),
        "The two halves: a built-in family with its parameters, or own halves.");
    /// `[alignment]`
    ALIGNMENT = key(DesignTable::Root, "alignment", ValueKind::Table(DesignTable::Alignment),
        "The alignment problem: every input besides the geometry that changes the result.");
    /// `[errors]`
    ERRORS = key(DesignTable::Root, "errors", ValueKind::Table(DesignTable::Errors),
        "Half-ranges of the error box: an error x of 0.5 means x from -0.5 D to 0.5 D.");
    /// `[docked]`
    DOCKED = key(DesignTable::Root, "docked", ValueKind::Table(DesignTable::Docked),
        "Docking tolerance: the depth and the residual misalignment at which a half at rest counts as docked.");

    /// `connector.family`
    FAMILY = key(DesignTable::Connector, "family", ValueKind::Family, family::NAMES);
    /// `connector.width`
    WIDTH = key(DesignTable::Connector, "width", ValueKind::Width(Range::new(1e-6, 1e6, "")),
        "D, the width of the connector, in `unit`. Results are in D. Optional for own halves with a unit; the default is the larger lateral extent of \
         the facets that can touch.");
    /// `connector.unit`
    UNIT = key(DesignTable::Connector, "unit", ValueKind::Unit,
        "Unit of `width` and of drawn coordinates: um, mm, cm, m or in. Without it the design is dimensionless.");
    /// `connector.aspect_ratio`
    ASPECT_RATIO = parameter("aspect_ratio", Applies::AnyFamily, ValueKind::Ratio(Range::new(1e-3, 100.0, "")),
        "H/D: height of the mating profile divided by the width D.");
    /// `connector.base_thickness`
    BASE_THICKNESS = parameter("base_thickness", Applies::AnyFamily, ValueKind::Length(Range::new(0.0, 100.0, "D")),
        "Thickness of the material behind the mating surface; it can touch once a half tilts. Default: 0.25 for sockets and 3-D \
         X-Faces, 0 for plugs and planar faces.");
    /// `connector.chord_error`
    CHORD_ERROR = parameter("chord_error", ROUND, ValueKind::Length(Range::new(1e-6, 0.1, "D")),
        "Largest distance between a circle and the polygon that approximates it.");
    /// `connector.layer_thickness`
    LAYER_THICKNESS = parameter("layer_thickness", LAYERED, ValueKind::Length(Range::new(1e-3, 10.0, "D")),
        "Thickness of each of the two layers along y. If this key or `layer_gap` is set, y, roll and yaw may be free.");
    /// `connector.layer_gap`
    LAYER_GAP = parameter("layer_gap", LAYERED, ValueKind::Length(Range::new(1e-2, 10.0, "D")),
        "Gap between the two layers along y: the offset at which an unrotated half first touches the wrong layer.");
    /// `connector.lip_height`
    LIP_HEIGHT = parameter("lip_height", LOCKING, ValueKind::Length(Range::new(1e-4, 10.0, "D")),
        "Height of the lip along the centre lines.");
    /// `connector.draft_angle`
    DRAFT_ANGLE = parameter("draft_angle", LOCKING, ValueKind::Angle(Range::new(0.0, 80.0 / 180.0 * PI, "rad")),
        "Angle between the lip's mating faces and the vertical.");
    /// `connector.pins`
    PINS = parameter("pins", PINS_ONLY, ValueKind::Whole { min: 1, max: 64 },
        "Pins per half.");
    /// `connector.hermaphroditic`
    HERMAPHRODITIC = parameter("hermaphroditic", PINS_ONLY, ValueKind::Flag,
        "Pins and holes alternate on both halves, instead of all pins on one.");
    /// `connector.pin_radius`
    PIN_RADIUS = parameter("pin_radius", PINS_ONLY, ValueKind::Length(Range::new(1e-4, 1.0, "D")),
        "Radius of a pin.");
    /// `connector.clearance`
    CLEARANCE = parameter("clearance", WITH_PLAY, ValueKind::Length(Range::new(0.0, 1.0, "D")),
        "Radial clearance between pin and hole; clearance between vertical lips.");
    /// `connector.chamfer`
    CHAMFER = parameter("chamfer", PINS_ONLY, ValueKind::Length(Range::new(0.0, 1.0, "D")),
        "Width of the chamfer around a hole and at the tip of a pin.");
    /// `connector.circle_radius`
    CIRCLE_RADIUS = parameter("circle_radius", PINS_ONLY, ValueKind::Length(Range::new(0.0, 2.0, "D")),
        "Radius of the circle on which pins and holes sit.");
    /// `connector.drawn`
    DRAWN = parameter("drawn", Applies::OwnHalves, ValueKind::Drawn,
        "facing (default): each half is drawn in its own frame and faces +z; assembled: both halves are drawn docked, in a common frame.");
    /// `connector.approach`
    APPROACH = parameter("approach", Applies::OwnHalves, ValueKind::Direction,
        "For halves drawn assembled: direction of motion of the approaching moving half. Default: -z.");
    /// `connector.settle`
    SETTLE = parameter("settle", Applies::OwnHalves, ValueKind::Flag,
        "If true, the mated pose is the rest that the halves reach when released as drawn. Default: false.");
    /// `connector.face_height`
    FACE_HEIGHT = parameter("face_height", Applies::OwnHalves, ValueKind::DrawnLength(Range::new(-1e3, 1e3, "D")),
        "z of the face centre in the frame of each half, in the unit of the design. Default: the halves are mated at first contact, and the face centre \
         is at mid height of the region that they share.");
    /// `connector.face_center`
    FACE_CENTER = parameter("face_center", Applies::OwnHalves, ValueKind::Point(Range::new(-1e3, 1e3, "D")),
        "For halves drawn assembled: the face centre [x, y, z] in their common frame, in the unit of the design. Default: the centre of \
         the bounding box of the region that they share.");
    /// `[connector.fixed]`
    FIXED = parameter("fixed", Applies::OwnHalves, ValueKind::Table(DesignTable::Half),
        "The fixed half, drawn facing +z.");
    /// `[connector.moving]`
    MOVING = parameter("moving", Applies::OwnHalves, ValueKind::Table(DesignTable::Half),
        "The moving half, drawn facing +z as well; `alignment.mount` turns it over.");

    /// `pieces` of a half
    PIECES = key(DesignTable::Half, "pieces", ValueKind::Pieces,
        "Convex pieces whose union is the half: each a list of points [x, y, z] in the unit of the design.");
    /// `mesh` of a half
    MESH = key(DesignTable::Half, "mesh", ValueKind::Path,
        "A closed triangle mesh: an STL, OBJ, PLY, 3MF or STEP file, its path relative to the folder of the design file.");
    /// `unit` of a half
    MESH_UNIT = key(DesignTable::Half, "unit", ValueKind::Unit,
        "Unit of the mesh file: um, mm, cm, m or in. Of the mesh formats only 3MF stores its unit.");
    /// `parts` of a half
    PARTS = key(DesignTable::Half, "parts", ValueKind::Parts,
        "Meshes, pieces, spheres, cylinders, cones, boxes and extruded profiles whose union is the half, each with its own position.");
    /// `repair` of a half
    REPAIR = key(DesignTable::Half, "repair", ValueKind::Flag,
        "Whether a defective mesh is repaired; every repair is reported. Default: true. Repair removes triangles without area, duplicate triangles and lids without \
         thickness, unifies windings, separates solids that touch along an edge and unites shells that cross. It never closes holes.");
    /// `simplify` of a half
    SIMPLIFY = key(DesignTable::Half, "simplify", ValueKind::DrawnLength(Range::new(1e-6, 0.05, "D")),
        "Simplifies the mesh to fewer triangles: largest displacement of its surface, such as \"0.01 mm\"; a bare number is in the unit of the design. \
         If set, a file may have 5 million triangles.");
    /// `body` of a half
    BODY = key(DesignTable::Half, "body", ValueKind::Whole { min: 1, max: 256 },
        "Number of the body in a mesh file that is the half, for a file that holds both halves; 1 has the largest bounding box. Default: all bodies.");
    /// `deflection` of a half
    DEFLECTION = key(DesignTable::Half, "deflection", ValueKind::DrawnLength(Range::new(1e-6, 0.1, "D")),
        "Largest distance between the curved faces of a STEP file and the facets that approximate them, such as \"0.01 mm\"; a bare number is in the unit of the design. \
         Default: 0.0002 of the part's largest side. Choose it smaller than the play of the fit.");
    /// `facing` of a half
    FACING = key(DesignTable::Half, "facing", ValueKind::Direction,
        "Direction in which the part faces in its file: +x, -x, +y, -y, +z, -z or [x, y, z]. This direction is rotated to +z.");
    /// `rotate` of a half
    ROTATE = key(DesignTable::Half, "rotate", ValueKind::Turns(Range::new(-2.0 * PI, 2.0 * PI, "rad")),
        "Rotations about x, then y, then z, applied after `facing`.");
    /// `translate` of a half
    TRANSLATE = key(DesignTable::Half, "translate", ValueKind::Point(Range::new(-1e3, 1e3, "D")),
        "Translation of the part, applied after the rotations: [x, y, z] in the unit of the design.");
    /// `profile` of a half
    PROFILE = key(DesignTable::Half, "profile", ValueKind::Later,
        "Not yet supported: a profile in the x-z plane.");
    /// `heightfield` of a half
    HEIGHTFIELD = key(DesignTable::Half, "heightfield", ValueKind::Later,
        "Not yet supported: a grid of heights.");

    /// `mesh` of a part
    PART_MESH = key(DesignTable::Part, "mesh", ValueKind::Path,
        "A closed triangle mesh: an STL, OBJ, PLY, 3MF or STEP file, its path relative to the folder of the design file.");
    /// `pieces` of a part
    PART_PIECES = key(DesignTable::Part, "pieces", ValueKind::Pieces,
        "Convex pieces: each a list of points [x, y, z] in the unit of the design.");
    /// `sphere` of a part
    PART_SPHERE = key(DesignTable::Part, "sphere", ValueKind::Table(DesignTable::Sphere),
        "A ball about the origin of the part.");
    /// `cylinder` of a part
    PART_CYLINDER = key(DesignTable::Part, "cylinder", ValueKind::Table(DesignTable::Cylinder),
        "A cylinder along the z axis of the part; the centre of its base is the origin.");
    /// `cone` of a part
    PART_CONE = key(DesignTable::Part, "cone", ValueKind::Table(DesignTable::Cone),
        "A cone or truncated cone along the z axis of the part; the centre of its base is the origin.");
    /// `box` of a part
    PART_BOX = key(DesignTable::Part, "box", ValueKind::Point(Range::new(1e-6, 1e3, "D")),
        "Size [x, y, z] of a box; the centre of its base is the origin of the part, and the box extends along +z.");
    /// `profile` of a part
    PART_PROFILE = key(DesignTable::Part, "profile", ValueKind::Outline(Range::new(-1e3, 1e3, "D")),
        "The corners [x, y] of a polygon, or the path of an SVG or DXF file with closed outlines, extruded along the part's z axis by `height`.");
    /// `height` of a part
    PART_HEIGHT = key(DesignTable::Part, "height", ValueKind::DrawnLength(Range::new(1e-6, 1e3, "D")),
        "Length of the extrusion, in the unit of the design.");
    /// `unit` of a part
    PART_UNIT = key(DesignTable::Part, "unit", ValueKind::Unit,
        "Unit of the mesh, SVG or DXF file, if the file does not state it: um, mm, cm, m or in.");
    /// `chord_error` of a part
    PART_CHORD_ERROR = key(DesignTable::Part, "chord_error", ValueKind::DrawnLength(Range::new(1e-6, 0.1, "D")),
        "Largest distance between a round surface and the facets that approximate it, in the unit of the design. Default: 0.001 D.");
    /// `deflection` of a part
    PART_DEFLECTION = key(DesignTable::Part, "deflection", ValueKind::DrawnLength(Range::new(1e-6, 0.1, "D")),
        "Largest distance between the curved faces of a STEP file and the facets that approximate them. Default: 0.0002 of the part's largest side.");
    /// `axis` of a part
    PART_AXIS = key(DesignTable::Part, "axis", ValueKind::Direction,
        "Direction to which the part's z axis is rotated: +x, -x, +y, -y, +z, -z or [x, y, z].");
    /// `rotate` of a part
    PART_ROTATE = key(DesignTable::Part, "rotate", ValueKind::Turns(Range::new(-2.0 * PI, 2.0 * PI, "rad")),
        "Rotations about x, then y, then z, applied after `axis`.");
    /// `at` of a part
    PART_AT = key(DesignTable::Part, "at", ValueKind::Point(Range::new(-1e3, 1e3, "D")),
        "Position of the part's origin in the frame of its half: [x, y, z] in the unit of the design.");
    /// `radius` of a sphere
    SPHERE_RADIUS = key(DesignTable::Sphere, "radius", ValueKind::DrawnLength(Range::new(1e-5, 1e3, "D")),
        "Radius of the ball, in the unit of the design.");
    /// `radius` of a cylinder
    CYLINDER_RADIUS = key(DesignTable::Cylinder, "radius", ValueKind::DrawnLength(Range::new(1e-5, 1e3, "D")),
        "Radius of the cylinder, in the unit of the design.");
    /// `height` of a cylinder
    CYLINDER_HEIGHT = key(DesignTable::Cylinder, "height", ValueKind::DrawnLength(Range::new(1e-5, 1e3, "D")),
        "Height of the cylinder, in the unit of the design.");
    /// `radius` of a cone
    CONE_RADIUS = key(DesignTable::Cone, "radius", ValueKind::DrawnLength(Range::new(1e-5, 1e3, "D")),
        "Radius of the cone's base, in the unit of the design.");
    /// `top_radius` of a cone
    CONE_TOP_RADIUS = key(DesignTable::Cone, "top_radius", ValueKind::DrawnLength(Range::new(0.0, 1e3, "D")),
        "Radius of the cone's top, in the unit of the design. Default: 0, a cone with an apex.");
    /// `height` of a cone
    CONE_HEIGHT = key(DesignTable::Cone, "height", ValueKind::DrawnLength(Range::new(1e-5, 1e3, "D")),
        "Height of the cone, in the unit of the design.");

    /// `alignment.free`
    FREE = key(DesignTable::Alignment, "free", ValueKind::Dofs,
        "Pose errors that occur and that contact may correct: x, y, roll, pitch, yaw. The others are locked.");
    /// `alignment.dont_care`
    DONT_CARE = key(DesignTable::Alignment, "dont_care", ValueKind::Dofs,
        "Rotations that are locked and do not count in the outcome, such as the yaw of a round plug.");
    /// `alignment.center_of_rotation`
    CENTER_OF_ROTATION = key(DesignTable::Alignment, "center_of_rotation", ValueKind::Length(Range::new(-100.0, 100.0, "D")),
        "Distance of the centre of rotation in front of the face centre; the approach force acts through it.");
    /// `alignment.rotation_length`
    ROTATION_LENGTH = key(DesignTable::Alignment, "rotation_length", ValueKind::Length(Range::new(1e-3, 1e3, "D")),
        "Characteristic length rho: converts a rotation in radians to a length in the damping metric. State it explicitly; the result depends on it.");
    /// `alignment.mount`
    MOUNT = key(DesignTable::Alignment, "mount", ValueKind::Mount,
        "Axis of the half turn that brings the moving half face to face with the fixed one: x or y.");
    /// `alignment.symmetry`
    SYMMETRY = key(DesignTable::Alignment, "symmetry", ValueKind::Whole { min: 1, max: 360 },
        "n-fold symmetry about the approach axis: a pair that is rotated by a multiple of 360/n deg also counts as docked.");

    /// `errors.x`
    ERROR_X = key(DesignTable::Errors, "x", ValueKind::Length(Range::new(1e-6, 100.0, "D")),
        "Largest lateral offset along x.");
    /// `errors.y`
    ERROR_Y = key(DesignTable::Errors, "y", ValueKind::Length(Range::new(1e-6, 100.0, "D")),
        "Largest lateral offset along y.");
    /// `errors.roll`
    ERROR_ROLL = key(DesignTable::Errors, "roll", ValueKind::Angle(Range::new(1e-6, PI, "rad")),
        "Largest rotation about x.");
    /// `errors.pitch`
    ERROR_PITCH = key(DesignTable::Errors, "pitch", ValueKind::Angle(Range::new(1e-6, PI, "rad")),
        "Largest rotation about y.");
    /// `errors.yaw`
    ERROR_YAW = key(DesignTable::Errors, "yaw", ValueKind::Angle(Range::new(1e-6, PI, "rad")),
        "Largest rotation about the approach axis.");

    /// `docked.depth`
    DOCKED_DEPTH = key(DesignTable::Docked, "depth", ValueKind::Length(Range::new(1e-6, 1.0, "D")),
        "Largest height above the mated height at which a half at rest counts as docked.");
    /// `docked.x`
    DOCKED_X = key(DesignTable::Docked, "x", ValueKind::Length(Range::new(1e-6, 100.0, "D")),
        "Largest residual offset along x at which a half counts as docked. Default: the play of the seat, or 0.05 D if that is smaller.");
    /// `docked.y`
    DOCKED_Y = key(DesignTable::Docked, "y", ValueKind::Length(Range::new(1e-6, 100.0, "D")),
        "Largest residual offset along y at which a half counts as docked. Default as for x.");
    /// `docked.roll`
    DOCKED_ROLL = key(DesignTable::Docked, "roll", ValueKind::Angle(Range::new(1e-6, PI, "rad")),
        "Largest residual rotation about x at which a half counts as docked. Default: the play of the seat, at most 5 deg.");
    /// `docked.pitch`
    DOCKED_PITCH = key(DesignTable::Docked, "pitch", ValueKind::Angle(Range::new(1e-6, PI, "rad")),
        "Largest residual rotation about y at which a half counts as docked. Default as for roll.");
    /// `docked.yaw`
    DOCKED_YAW = key(DesignTable::Docked, "yaw", ValueKind::Angle(Range::new(1e-6, PI, "rad")),
        "Largest residual rotation about the approach axis at which a half counts as docked. Default as for roll.");
}

/// The error half-ranges in the order of [`catchment_base::pose::Dof::ALL`].
pub const ERROR_KEYS: [Key; 5] = [ERROR_X, ERROR_Y, ERROR_ROLL, ERROR_PITCH, ERROR_YAW];
/// The limits at rest in the order of [`catchment_base::pose::Dof::ALL`], and their places in the file.
pub const DOCKED_KEYS: [Key; 5] = [DOCKED_X, DOCKED_Y, DOCKED_ROLL, DOCKED_PITCH, DOCKED_YAW];
/// Their places in the file.
pub const DOCKED_PLACES: [&str; 5] = ["docked.x", "docked.y", "docked.roll", "docked.pitch", "docked.yaw"];

/// A coordinate of a drawn point: 1000 widths away is a wrong unit.
pub const COORDINATE: Key = key(
    DesignTable::Half,
    "pieces",
    ValueKind::DrawnLength(Range::new(-1e3, 1e3, "D")),
    "A coordinate of a convex piece, in the unit of the design. Is `connector.width` in the same unit?",
);

/// Largest number of parts of a half: beyond it use a mesh.
pub const MOST_PARTS: usize = 256;

/// Longest name, in characters.
pub const LONGEST_LINE: usize = 200;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_stands_twice_in_a_table() {
        for table in DesignTable::ALL {
            let mut names: Vec<&str> = table.keys().map(|key| key.name).collect();
            let all = names.len();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), all, "{}", table.name());
            assert!(all > 0, "{}", table.name());
        }
    }
}
