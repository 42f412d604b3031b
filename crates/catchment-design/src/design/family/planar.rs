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

impl XFace {
    /// Default thickness of a layer along y, in D: with the gap the halves are 1 D deep.
    pub const DEFAULT_LAYER_THICKNESS: f64 = 0.45;
    /// Default gap between the layers, in D.
    pub const DEFAULT_LAYER_GAP: f64 = 0.1;
}

parameters! {
    /// Two crossed ramps in two layers: planar, ungendered.
    XFace {
        /// H/D.
        aspect_ratio: f64 = 0.5 => ASPECT_RATIO;
        /// Material behind the mating surface, in D; `None`: nothing.
        base_thickness: Option<f64> = None => BASE_THICKNESS;
        /// Thickness of a layer along y, in D; `None`: [`XFace::DEFAULT_LAYER_THICKNESS`].
        layer_thickness: Option<f64> = None => LAYER_THICKNESS;
        /// Gap between the layers along y, in D; `None`: [`XFace::DEFAULT_LAYER_GAP`].
        layer_gap: Option<f64> = None => LAYER_GAP;
    }
}
