//! A digest of all inputs in a design that change a result.
//!
//! ```text
//! tag ‖ connector (family and parameters, or halves and face height) ‖ alignment  ──SHA-256──▶ 32 bytes
//! ```
//!
//! For a mesh its content and its scale are included. Name, unit, width and paths are not: results are in D.
//! Numbers enter as little-endian doubles with −0 as 0, counts as 64 bits, texts with their length, so that
//! different designs never share their bytes.

use super::family::Value;
use super::{
    Alignment, ConnectorSpec, Design, Docked, DrawnFrames, FileSpec, FileUnit, HalfSpec, OutlineSpec,
    OwnSpec, PartPlacement, PartSpec,
};
use super::{ShapeSpec, keys};
use catchment_base::pose::{Dof, DofSet, Mount};
use sha2::{Digest, Sha256};

/// Changes with every change of the layout below.
const TAG: &str = "catchment alignment problem 2";

impl Design {
    /// SHA-256 of all inputs in this design that change a result; `None` while the content of a mesh is
    /// unknown, see [`Design::with_contents`].
    pub fn digest(&self) -> Option<[u8; 32]> {
        let mut hash = Hash(Sha256::new());
        hash.text(TAG);
        match &self.connector {
            ConnectorSpec::Family(spec) => {
                hash.text("family");
                hash.text(spec.family().name());
                for (key, value) in spec.parameters() {
                    // Parameters added later enter the digest only if they are set, so that all older digests
                    // stay valid.
                    if value.is_none() && key.name != keys::BASE_THICKNESS.name {
                        continue;
                    }
                    hash.text(key.name);
                    match value {
                        None => hash.text("default"),
                        Some(Value::Number(number)) => hash.number(number),
                        Some(Value::Whole(count)) => hash.count(u64::from(count)),
                        Some(Value::Flag(flag)) => hash.count(u64::from(flag)),
                    }
                }
            }
            ConnectorSpec::Own(own) => {
                hash.text("own");
                hash.drawn(own);
                hash.half(&own.fixed)?;
                hash.half(&own.moving)?;
            }
        }
        hash.alignment(&self.alignment);
        Some(hash.0.finalize().into())
    }
}

struct Hash(Sha256);

impl Hash {
    fn number(&mut self, number: f64) {
        self.0.update((number + 0.0).to_le_bytes());
    }

    fn count(&mut self, count: u64) {
        self.0.update(count.to_le_bytes());
    }

    fn text(&mut self, text: &str) {
        self.count(text.len() as u64);
        self.0.update(text.as_bytes());
    }

    fn numbers(&mut self, numbers: &[f64]) {
        for number in numbers {
            self.number(*number);
        }
    }

    /// The placement of the halves, if any.
    fn drawn(&mut self, own: &OwnSpec) {
        match own.face_height {
            Some(height) => self.number(height),
            None => self.text("face height found"),
        }
        if let DrawnFrames::Assembled { approach, face_center } = &own.drawn {
            self.text("assembled");
            self.numbers(approach);
            self.count(u64::from(face_center.is_some()));
            self.numbers(face_center.as_ref().map_or(&[], |center| center.as_slice()));
        }
        if own.settle {
            self.text("settled");
        }
        for (side, placement) in [("fixed", &own.fixed_placement), ("moving", &own.moving_placement)] {
            if !placement.is_none() {
                let PartPlacement { facing, rotate, translate } = placement;
                self.text(side);
                self.numbers(&[*facing, *rotate, *translate].concat());
            }
        }
    }

    fn half(&mut self, half: &HalfSpec) -> Option<()> {
        match half {
            HalfSpec::Pieces(pieces) => self.pieces(pieces),
            HalfSpec::Mesh(file) => return self.file(file),
            HalfSpec::Memory { content } => {
                self.text("memory");
                self.number(1.0);
                self.text(&content.sha256);
            }
            HalfSpec::Parts(parts) => {
                self.text("parts");
                self.count(parts.len() as u64);
                for PartSpec { shape, axis, rotate, at } in parts {
                    self.shape(shape)?;
                    self.numbers(&[*axis, *rotate, *at].concat());
                }
            }
        }
        Some(())
    }

    fn pieces(&mut self, pieces: &[Vec<[f64; 3]>]) {
        self.text("pieces");
        self.count(pieces.len() as u64);
        for piece in pieces {
            self.count(piece.len() as u64);
            piece.iter().flatten().for_each(|number| self.number(*number));
        }
    }

    fn file(&mut self, file: &FileSpec) -> Option<()> {
        let content = file.content.as_ref()?;
        // The effect of a repair follows from the bytes; without a repair the digest is that of the original
        // mesh.
        if !content.repairs.is_none() {
            self.text("repaired");
        }
        // The deflection shows in the triangles, and so does who meshed it.
        if let Some(meshed) = &content.meshed {
            self.text("meshed");
            self.text(&meshed.sha256);
        }
        if let Some(body) = file.treatment.body {
            self.text("body");
            self.count(u64::from(body));
        }
        if let Some(tolerance) = file.treatment.simplify {
            self.text("simplified");
            self.number(tolerance);
        }
        // A unit stated in the design is part of the scale; a unit in the file is part of its bytes.
        self.text(if file.unit == FileUnit::InFile { "mesh in its own unit" } else { "mesh" });
        self.number(file.scale);
        self.text(&content.sha256);
        Some(())
    }

    fn shape(&mut self, shape: &ShapeSpec) -> Option<()> {
        match shape {
            ShapeSpec::Mesh(file) => return self.file(file),
            ShapeSpec::Pieces(pieces) => self.pieces(pieces),
            ShapeSpec::Sphere { radius, chord_error } => {
                self.text("sphere");
                self.numbers(&[*radius, *chord_error]);
            }
            ShapeSpec::Cone { radius, top_radius, height, chord_error } => {
                self.text("cone");
                self.numbers(&[*radius, *top_radius, *height, *chord_error]);
            }
            ShapeSpec::Box { size } => {
                self.text("box");
                self.numbers(size);
            }
            ShapeSpec::Profile { outline: OutlineSpec::Corners(corners), height, .. } => {
                self.text("profile");
                self.count(corners.len() as u64);
                self.numbers(corners.as_flattened());
                self.number(*height);
            }
            ShapeSpec::Profile { outline: OutlineSpec::File(file), height, chord_error } => {
                self.text("drawing");
                // The extension of the file name selects the reader of the drawing.
                self.text(&file.ending());
                self.numbers(&[*height, *chord_error]);
                return self.file(file);
            }
        }
        Some(())
    }

    fn dofs(&mut self, set: DofSet) {
        for dof in Dof::ALL {
            self.count(u64::from(set.contains(dof)));
        }
    }

    fn alignment(&mut self, alignment: &Alignment) {
        let Alignment {
            free,
            dont_care,
            center_of_rotation,
            rotation_length,
            mount,
            symmetry,
            half_ranges,
            docked: Docked { depth, limits },
        } = alignment;
        self.text("alignment");
        self.dofs(*free);
        self.dofs(*dont_care);
        self.number(*center_of_rotation);
        self.number(*rotation_length);
        self.text(match mount {
            Mount::X => "x",
            Mount::Y => "y",
        });
        self.count(u64::from(*symmetry));
        for range in half_ranges {
            self.number(*range);
        }
        self.number(*depth);
        for limit in limits {
            self.count(u64::from(limit.is_some()));
            self.number(limit.unwrap_or_default());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::family::Cone;
    use crate::design::{Family, FamilySpec, LengthUnit, MeshContent, MeshPreparation, OwnSpec, Repairs};

    fn family(family: Family) -> Design {
        let spec = FamilySpec::new(family);
        let alignment = Alignment::default_for(Some(family));
        Design { name: "a".into(), connector: ConnectorSpec::Family(spec), width: 1.0, unit: None, alignment }
    }

    /// Parameters added later leave the digests of older designs unchanged: this digest was recorded before.
    #[test]
    fn new_parameters_keep_old_digests() {
        use crate::design::family::XFace;
        use crate::design::hex;
        let old = "fea9ebe52e43e7f586e998c95c3786faadb7b5ed0658fed4a441f163acb70c87";
        let digest = |design: Design| hex(&design.digest().unwrap());
        assert_eq!(digest(family(Family::XFace)), old);
        for layers in [[Some(0.45), None], [None, Some(0.1)]] {
            let face = XFace { layer_thickness: layers[0], layer_gap: layers[1], ..XFace::DEFAULT };
            let connector = ConnectorSpec::Family(face.into());
            assert_ne!(digest(Design { connector, ..family(Family::XFace) }), old);
        }
    }

    #[test]
    fn parameter_changes_change_the_digest() {
        let base = family(Family::Cone);
        let mut others: Vec<Design> = Family::ALL.into_iter().map(family).collect();
        let mut other = |change: &dyn Fn(&mut Design)| {
            let mut design = base.clone();
            change(&mut design);
            others.push(design);
        };
        other(&|d| d.connector = ConnectorSpec::Family(Cone { chord_error: 0.002, ..Cone::DEFAULT }.into()));
        other(&|d| {
            d.connector = ConnectorSpec::Family(Cone { base_thickness: Some(0.25), ..Cone::DEFAULT }.into());
        });
        other(&|d| d.alignment.center_of_rotation = 0.1);
        other(&|d| d.alignment.rotation_length = 0.6);
        other(&|d| d.alignment.half_ranges[3] = 1.0);
        other(&|d| d.alignment.mount = Mount::Y);
        other(&|d| d.alignment.symmetry = 2);
        other(&|d| d.alignment.free = DofSet::ALL);
        other(&|d| d.alignment.dont_care = DofSet::EMPTY);
        other(&|d| d.alignment.docked.depth = 0.01);
        other(&|d| d.alignment.docked.limits[0] = Some(0.01));
        other(&|d| d.alignment.docked.limits[1] = Some(0.01));
        let mut digests: Vec<_> = others.iter().map(|design| design.digest().unwrap()).collect();
        digests.sort_unstable();
        digests.dedup();
        assert_eq!(digests.len(), others.len());
    }

    #[test]
    fn names_units_and_signed_zeros_keep_the_digest() {
        let base = family(Family::Pyramid);
        let mut same = base.clone();
        (same.name, same.width, same.unit) = ("b".into(), 50.0, Some(LengthUnit::Mm));
        same.alignment.center_of_rotation = -0.0;
        assert_eq!(base.digest(), same.digest());
    }

    #[test]
    fn mesh_digests_depend_on_content_not_path() {
        let mesh = |path: &str, scale, held: Option<&[u8]>| {
            let content = held.map(|bytes| MeshContent::of(bytes, 4));
            let half = HalfSpec::Mesh(FileSpec { content, ..FileSpec::new(path, scale) });
            let own = OwnSpec::new(0.0, half.clone(), half);
            Design { connector: ConnectorSpec::Own(own), ..family(Family::Pyramid) }.digest()
        };
        assert_eq!(mesh("a", 1.0, None), None);
        assert!(mesh("a", 1.0, Some(b"x")).is_some());
        assert_eq!(mesh("a", 1.0, Some(b"x")), mesh("b", 1.0, Some(b"x")));
        assert_ne!(mesh("a", 1.0, Some(b"x")), mesh("a", 1.0, Some(b"y")));
        assert_ne!(mesh("a", 1.0, Some(b"x")), mesh("a", 2.0, Some(b"x")));
    }

    /// The permission to repair changes nothing; an actual repair, and the permitted displacement of a
    /// simplification, do.
    #[test]
    fn mesh_digests_depend_on_applied_preparation() {
        let mesh = |treatment, repairs| {
            let content = Some(MeshContent { repairs, ..MeshContent::of(b"x", 4) });
            let half = HalfSpec::Mesh(FileSpec { treatment, content, ..FileSpec::new("a", 1.0) });
            let own = OwnSpec::new(0.0, half.clone(), half);
            Design { connector: ConnectorSpec::Own(own), ..family(Family::Pyramid) }.digest().unwrap()
        };
        let simplified = |d| MeshPreparation { simplify: Some(d), ..MeshPreparation::DEFAULT };
        let repaired = Repairs { turned: 1, ..Repairs::default() };
        let plain = mesh(MeshPreparation::DEFAULT, Repairs::default());
        assert_eq!(mesh(MeshPreparation::AS_IT_IS, Repairs::default()), plain);
        let all = [
            plain,
            mesh(MeshPreparation::DEFAULT, repaired.clone()),
            mesh(simplified(1e-3), Repairs::default()),
            mesh(simplified(2e-3), Repairs::default()),
            mesh(simplified(1e-3), repaired),
            mesh(MeshPreparation { body: Some(1), ..MeshPreparation::DEFAULT }, Repairs::default()),
            mesh(MeshPreparation { body: Some(2), ..MeshPreparation::DEFAULT }, Repairs::default()),
        ];
        assert!((0..all.len()).all(|i| (0..i).all(|j| all[i] != all[j])));
    }

    #[test]
    fn a_mesh_without_its_content_reads_as_before() {
        let old = r#"{"mesh":{"path":"a.stl","scale":0.5}}"#;
        let half: HalfSpec = serde_json::from_str(old).unwrap();
        assert_eq!(half, HalfSpec::Mesh(FileSpec::new("a.stl", 0.5)));
        assert_eq!(serde_json::to_string(&half).unwrap(), old);
        // SHA-256 of nothing, FIPS 180-4.
        assert!(MeshContent::of(b"", 0).sha256.starts_with("e3b0c44298fc1c14"));
    }
}
