//! Parameters of pins and holes.

use super::parameters;

parameters! {
    /// Pins and chamfered holes on a circle.
    PinHole {
        /// Length of a pin over D.
        aspect_ratio: f64 = 0.2 => ASPECT_RATIO;
        /// Thickness of the plate behind pins and holes, in D; `None`: 0.25.
        base_thickness: Option<f64> = None => BASE_THICKNESS;
        /// Largest distance between a circle and the polygon that stands for it, in D.
        chord_error: f64 = 0.001 => CHORD_ERROR;
        /// Pins per half.
        pins: u32 = 2 => PINS;
        /// Pins and holes alternate on both halves instead of all pins on a single half.
        hermaphroditic: bool = false => HERMAPHRODITIC;
        /// Radius of a pin, in D.
        pin_radius: f64 = 0.05 => PIN_RADIUS;
        /// Radial play between pin and hole, in D.
        clearance: f64 = 0.005 => CLEARANCE;
        /// Width of the chamfer around a hole, and of the point of a pin, in D.
        chamfer: f64 = 0.1 => CHAMFER;
        /// Radius of the circle on which pins and holes sit, in D.
        circle_radius: f64 = 0.3 => CIRCLE_RADIUS;
    }
}
