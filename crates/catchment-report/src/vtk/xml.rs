//! VTK's XML: a head that describes the arrays, then all numbers in binary form, little-endian.
//!
//! An array is its length in bytes (64 bits) and its bytes. The data after the underscore is not XML, and VTK
//! does not read it as such.

use std::fmt::Write;

/// A number as VTK names it.
pub(super) trait Number: Copy {
    /// The name of its type.
    const KIND: &'static str;
    /// Adds its bytes.
    fn put(self, bytes: &mut Vec<u8>);
}

macro_rules! numbers {
    ($($type:ty, $name:literal);*) => {$(
        impl Number for $type {
            const KIND: &'static str = $name;
            fn put(self, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(&self.to_le_bytes());
            }
        }
    )*};
}

numbers!(u8, "UInt8"; i64, "Int64"; f32, "Float32"; f64, "Float64");

/// Counts and places of points, which VTK wants signed.
impl Number for usize {
    const KIND: &'static str = "Int64";
    fn put(self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&(self as u64).to_le_bytes());
    }
}

/// A file that is being written.
#[derive(Debug)]
pub(super) struct File {
    kind: &'static str,
    head: String,
    bytes: Vec<u8>,
}

impl File {
    /// An empty file of a kind of data set, such as `ImageData`; `heading` is its description in a line.
    pub(super) fn new(kind: &'static str, heading: &str) -> Self {
        // Two hyphens would end a comment.
        let heading = heading.replace("--", "- -");
        let head = format!(
            "<?xml version=\"1.0\"?>\n<!-- {heading} -->\n\
             <VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        );
        Self { kind, head, bytes: Vec::new() }
    }

    /// Adds a line to the head.
    pub(super) fn tag(&mut self, tag: &str) {
        self.head.push_str(tag);
        self.head.push('\n');
    }

    /// Adds an array of tuples of `N` numbers.
    pub(super) fn array<T: Number, const N: usize>(
        &mut self,
        name: &str,
        values: impl IntoIterator<Item = [T; N]>,
    ) {
        let offset = self.bytes.len();
        // Writing to a String cannot fail.
        let _ = writeln!(
            self.head,
            "<DataArray type=\"{}\" Name=\"{name}\" NumberOfComponents=\"{N}\" format=\"appended\" offset=\"{offset}\"/>",
            T::KIND
        );
        self.bytes.extend_from_slice(&[0; size_of::<u64>()]);
        let from = self.bytes.len();
        values.into_iter().flatten().for_each(|value| value.put(&mut self.bytes));
        let length = (self.bytes.len() - from) as u64;
        self.bytes[offset..from].copy_from_slice(&length.to_le_bytes());
    }

    /// The whole file.
    pub(super) fn finish(self) -> Vec<u8> {
        let mut file = self.head.into_bytes();
        file.extend_from_slice(format!("</{}>\n<AppendedData encoding=\"raw\">\n_", self.kind).as_bytes());
        file.extend_from_slice(&self.bytes);
        file.extend_from_slice(b"\n</AppendedData>\n</VTKFile>\n");
        file
    }
}
