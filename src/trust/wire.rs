//! SSH's binary encoding (RFC 4251, section 5), with every length checked against the remaining bytes.

/// A length that extends past the end of its container.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("an item of {needed} bytes at byte {offset}, where only {left} bytes are left")]
pub(super) struct Truncated {
    /// Offset of the item that does not fit, in bytes from the start of the file.
    offset: usize,
    needed: usize,
    left: usize,
}

impl From<Truncated> for String {
    fn from(truncated: Truncated) -> Self {
        truncated.to_string()
    }
}

/// Reader of binary data that knows its offset from the start of the file.
#[derive(Debug, Clone)]
pub(super) struct Wire<'a> {
    pub(super) rest: &'a [u8],
    /// Offset from the start of the file, in bytes.
    pub(super) offset: usize,
}

impl<'a> Wire<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes, offset: 0 }
    }

    pub(super) fn take(&mut self, length: usize) -> Result<&'a [u8], Truncated> {
        let truncated = Truncated { offset: self.offset, needed: length, left: self.rest.len() };
        let (taken, rest) = self.rest.split_at_checked(length).ok_or(truncated)?;
        self.rest = rest;
        self.offset += length;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], Truncated> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        Ok(array)
    }

    pub(super) fn byte(&mut self) -> Result<u8, Truncated> {
        self.array::<1>().map(|[byte]| byte)
    }

    /// Reads four bytes, the most significant first.
    pub(super) fn u32(&mut self) -> Result<u32, Truncated> {
        self.array().map(u32::from_be_bytes)
    }

    /// Reads eight bytes, the most significant first.
    pub(super) fn u64(&mut self) -> Result<u64, Truncated> {
        self.array().map(u64::from_be_bytes)
    }

    /// Reads a string: its length in four bytes, then its bytes.
    pub(super) fn string(&mut self) -> Result<&'a [u8], Truncated> {
        self.nested().map(|nested| nested.rest)
    }

    /// Reads a string that is itself encoded; offsets in it count from the start of the file.
    pub(super) fn nested(&mut self) -> Result<Wire<'a>, Truncated> {
        let length = self.u32()? as usize;
        let offset = self.offset;
        Ok(Wire { rest: self.take(length)?, offset })
    }
}

/// Writes a string: its length in four bytes, then its bytes.
pub(super) fn string(bytes: &[u8]) -> Vec<u8> {
    [&(bytes.len() as u32).to_be_bytes()[..], bytes].concat()
}
