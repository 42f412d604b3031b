//! A design with a changed setting, for sweeps and command-line options. The rules of the file apply, and the
//! name shows the new value ([`super::name`]).

use super::defect::DesignDefect;
use super::keys;
use super::name::DesignParameter;
use super::quantity::{Quantity, QuantityUnit, shortened};
use super::reader::unknown_name;
use super::{ConnectorSpec, Design, Family, FamilySpec};
use catchment_base::pose::{Dof, DofSet};

/// The set in a list such as `x,y,yaw`.
///
/// # Errors
/// An unknown name, a repeated name, or an empty list.
pub fn parse_dofs(text: &str) -> Result<DofSet, DesignDefect> {
    let mut set = DofSet::EMPTY;
    for name in text.split(',').map(str::trim) {
        if text.trim().is_empty() {
            return Err(DesignDefect::nothing_free("free".to_owned()));
        }
        let dof: Dof = name.parse().map_err(|_| {
            unknown_name("degree of freedom", &shortened(name), Dof::ALL.into_iter().map(Dof::name))
        })?;
        if set.contains(dof) {
            return Err(DesignDefect::Repeated { dof });
        }
        set = set.with(dof);
    }
    Ok(set)
}

impl Design {
    /// The built-in family, if any.
    pub const fn family(&self) -> Option<Family> {
        match &self.connector {
            ConnectorSpec::Family(spec) => Some(spec.family()),
            ConnectorSpec::Own(_) => None,
        }
    }

    /// The built-in family with its parameters, if any.
    pub const fn family_spec(&self) -> Option<&FamilySpec> {
        match &self.connector {
            ConnectorSpec::Family(spec) => Some(spec),
            ConnectorSpec::Own(_) => None,
        }
    }

    /// This design with other free degrees of freedom. A don't-care rotation that becomes free counts again.
    ///
    /// # Errors
    /// An empty set, or a degree of freedom that leaves the plane of a planar family.
    pub fn with_free(mut self, free: DofSet) -> Result<Self, DesignDefect> {
        if free.is_empty() {
            return Err(DesignDefect::nothing_free("free".to_owned()));
        }
        if let Some(defect) = free.iter().find_map(|dof| DesignDefect::out_of_plane(dof, self.family_spec()))
        {
            return Err(defect);
        }
        self.alignment.free = free;
        self.alignment.dont_care =
            self.alignment.dont_care.iter().filter(|dof| !free.contains(*dof)).collect();
        match self.alignment.beyond_the_pole() {
            Some(defect) => Err(defect),
            None => Ok(self),
        }
    }

    /// This design with its centre of rotation elsewhere; bare numbers are in D.
    ///
    /// # Errors
    /// Out of the range of the design file, or not a length.
    pub fn with_center_of_rotation(mut self, cor: Quantity) -> Result<Self, DesignDefect> {
        let was = self.alignment.center_of_rotation;
        let Some(now) = keys::CENTER_OF_ROTATION.checked(cor, Some(&self.scale()))? else { return Ok(self) };
        self.alignment.center_of_rotation = now;
        Ok(if now == was { self } else { self.titled(DesignParameter::CenterOfRotation, &cor.to_string()) })
    }

    /// This design with another ρ; bare numbers are in D.
    ///
    /// # Errors
    /// Out of the range of the design file, or not a length.
    pub fn with_rotation_length(mut self, length: Quantity) -> Result<Self, DesignDefect> {
        let was = self.alignment.rotation_length;
        let Some(now) = keys::ROTATION_LENGTH.checked(length, Some(&self.scale()))? else { return Ok(self) };
        self.alignment.rotation_length = now;
        Ok(if now == was { self } else { self.titled(DesignParameter::RotationLength, &length.to_string()) })
    }

    /// This design with another H/D.
    ///
    /// # Errors
    /// Out of the range of the design file, or own halves, whose shape is fixed.
    pub fn with_aspect_ratio(mut self, ratio: f64) -> Result<Self, DesignDefect> {
        let scale = self.scale();
        let ConnectorSpec::Family(spec) = &mut self.connector else {
            return Err(DesignDefect::NotAParameter {
                key: keys::ASPECT_RATIO.name.to_owned(),
                owner: "own halves",
                belongs_to: keys::ASPECT_RATIO.applies.to_string(),
            });
        };
        let was = spec.aspect_ratio();
        let quantity = Quantity { value: ratio, unit: QuantityUnit::Bare };
        let Some(now) = keys::ASPECT_RATIO.checked(quantity, Some(&scale))? else { return Ok(self) };
        *spec = spec.with_aspect_ratio(now);
        Ok(if now == was { self } else { self.titled(DesignParameter::AspectRatio, &quantity.to_string()) })
    }
}
