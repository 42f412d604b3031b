//! Parameters of the planar families.

use super::parameters;

parameters! {
    /// V notch and tip: planar, gendered.
    VFace {
        /// H/D.
        aspect_ratio: f64 = 0.5 => ASPECT_RATIO;
        /// Material behind the mating surface, in D; `None`: nothing.
        base_thickness: Option<f64> = None => BASE_THICKNESS;
    }
}

parameters! {
    /// Sawtooth of three edges: planar, ungendered.
    SFace {
        /// H/D.
        aspect_ratio: f64 = 0.5 => ASPECT_RATIO;
        /// Material behind the mating surface, in D; `None`: nothing.
        base_thickness: Option<f64> = None => BASE_THICKNESS;
    }
}

parameters! {
    /// Two crossed ramps in two layers: planar, ungendered.
    XFace {
        /// H/D.
        aspect_ratio: f64 = 0.5 => ASPECT_RATIO;
        /// Material behind the mating surface, in D; `None`: nothing.
        base_thickness: Option<f64> = None => BASE_THICKNESS;
    }
}
