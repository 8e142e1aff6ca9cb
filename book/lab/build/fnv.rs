//! FNV-1a of 64 bits, by which files are told apart.

/// FNV-1a begins with this.
pub const START: u64 = 0xcbf2_9ce4_8422_2325;

/// Takes FNV-1a on from `hash` over `bytes`.
pub fn fnv(hash: u64, bytes: &[u8]) -> u64 {
    let one = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
    bytes.iter().fold(hash, one)
}
