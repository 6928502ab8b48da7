//! SHA-256 checksums in the format of `sha256sum`.
//!
//! A checksum is a text of 64 hexadecimal digits in lower case (FIPS 180-4). That of a file is taken 64 KiB
//! at a time; its error is that of opening or reading the file.

use std::io::Read;
use std::path::Path;

use sha2::{Digest, Sha256};

use super::files;

/// A checksum of bytes that are added one after another.
#[derive(Debug, Clone, Default)]
pub struct Checksum(Sha256);

impl Checksum {
    /// Adds bytes.
    pub fn add(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// The checksum of all bytes so far, in hexadecimal digits.
    pub fn text(&self) -> String {
        self.0.clone().finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// The checksum of these bytes, in hexadecimal digits.
pub fn checksum(bytes: &[u8]) -> String {
    let mut sum = Checksum::default();
    sum.add(bytes);
    sum.text()
}

/// The checksum of the file at `path`, in hexadecimal digits.
pub fn file_checksum(path: &Path) -> std::io::Result<String> {
    let (mut file, mut sum, mut bytes) = (files::open(path)?, Checksum::default(), vec![0; 1 << 16]);
    loop {
        match file.read(&mut bytes)? {
            0 => return Ok(sum.text()),
            n => sum.add(&bytes[..n]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_are_those_of_the_standard() {
        // FIPS 180-2, appendix B.1 and B.2
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(checksum(b"abc"), abc);
        let mut sum = Checksum::default();
        sum.add(b"abcdbcdecdefdefgefghfghighij");
        sum.add(b"hijkijkljklmklmnlmnomnopnopq");
        assert_eq!(sum.text(), "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    }
}
