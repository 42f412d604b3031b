//! Parameters of the pyramid.

use super::parameters;

parameters! {
    /// Square pyramid in its socket: gendered.
    Pyramid {
        /// H/D.
        aspect_ratio: f64 = 0.5 => ASPECT_RATIO;
        /// Material behind the mating surface, in D; `None`: 0.25 behind the socket, nothing behind the plug.
        base_thickness: Option<f64> = None => BASE_THICKNESS;
    }
}
