//! Parameters of the cone.

use super::parameters;

parameters! {
    /// Circular cone in its socket: gendered, yaw does not matter.
    Cone {
        /// H/D.
        aspect_ratio: f64 = 0.5 => ASPECT_RATIO;
        /// Material behind the mating surface, in D; `None`: 0.25 behind the socket, nothing behind the plug.
        base_thickness: Option<f64> = None => BASE_THICKNESS;
        /// Largest distance between the rim and the polygon that stands for it, in D.
        chord_error: f64 = 0.001 => CHORD_ERROR;
    }
}
