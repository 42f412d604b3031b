//! Parameters of the 3-D X-Faces.

use super::parameters;

/// tan 30°, the dissertation's choice.
const ASPECT_RATIO: f64 = 0.577_350_269_189_625_8;

parameters! {
    /// Saddle of four triangular facets: ungendered.
    XFace3d {
        /// H/D.
        aspect_ratio: f64 = ASPECT_RATIO => ASPECT_RATIO;
        /// Material behind the mating surface, in D; `None`: 0.25.
        base_thickness: Option<f64> = None => BASE_THICKNESS;
    }
}

parameters! {
    /// The saddle with a lip along its centre lines: ungendered.
    XFace3dLocking {
        /// H/D of the plain saddle.
        aspect_ratio: f64 = ASPECT_RATIO => ASPECT_RATIO;
        /// Material behind the mating surface, in D; `None`: 0.25.
        base_thickness: Option<f64> = None => BASE_THICKNESS;
        /// Height of the lip, in D.
        lip_height: f64 = 0.1 => LIP_HEIGHT;
        /// Inclination of the lip's mating faces from the vertical, radians.
        draft_angle: f64 = 0.0 => DRAFT_ANGLE;
        /// Play between vertical lips, in D; lips with a draft have no play.
        clearance: f64 = 0.005 => CLEARANCE;
    }
}
