//! Damage to files, drawn by seeded chance, and readers fed with it: shared by the fuzz tests of the core and of the window.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "how many inputs were tried, with --nocapture")]

use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// Longer inputs find nothing that these do not, and take time.
const LONGEST: usize = 1 << 14;
/// Text that has a meaning somewhere.
const TOKENS: [&[u8]; 33] = [
    b"NaN",
    b"inf",
    b"-inf",
    b"1e999",
    b"-0",
    b"1e-320",
    b"90",
    b"-90",
    b"\"",
    b",",
    b";",
    b"\t",
    b"\n",
    b"\r",
    b"#",
    b"# a: b\n",
    b"\0",
    b"\xff\xfe",
    b"\xef\xbb\xbf",
    b"theta_i",
    b"dolp_percent",
    b"E",
    b"dpolE",
    b"|",
    b"null",
    b"true",
    b"[",
    b"]",
    b"{",
    b"}",
    b":",
    b"1e300",
    b"18446744073709551615",
];

fn number_from(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// Seeded damage.
struct Damage(Pcg64);

impl Damage {
    fn below(&mut self, bound: usize) -> usize {
        usize::try_from(self.0.next_u64() % bound.max(1) as u64).expect("below a usize")
    }

    /// One of the samples with some damage, now and then spliced with another one.
    fn of(&mut self, samples: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = samples[self.below(samples.len())].clone();
        if self.below(8) == 0 {
            let other = &samples[self.below(samples.len())];
            bytes.truncate(self.below(bytes.len() + 1));
            bytes.extend(&other[self.below(other.len() + 1)..]);
        }
        for _ in 0..=self.below(6) {
            self.hit(&mut bytes);
        }
        bytes.truncate(LONGEST);
        bytes
    }

    fn hit(&mut self, bytes: &mut Vec<u8>) {
        let at = self.below(bytes.len() + 1);
        let end = (at + self.below(24)).min(bytes.len());
        match self.below(8) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let again = bytes[at..end].to_vec();
                bytes.splice(at..at, again);
            }
            3 => {
                let token = TOKENS[self.below(TOKENS.len())];
                bytes.splice(at..at, token.iter().copied());
            }
            4 => {
                let token = TOKENS[self.below(TOKENS.len())];
                bytes.splice(at..end, token.iter().copied());
            }
            5 => bytes[at..end].fill(0xff),
            6 if at < bytes.len() => bytes[at] ^= 1 << self.below(8),
            _ if at < bytes.len() => bytes[at] = self.0.next_u64().to_le_bytes()[0],
            _ => {}
        }
    }
}

/// Feeds a reader for as long as asked for.
pub fn fuzz(name: &str, samples: &[Vec<u8>], mut read: impl FnMut(&[u8]) -> bool) {
    for sample in samples {
        assert!(read(sample), "{name}: a sample that should be read: {:?}", String::from_utf8_lossy(sample));
    }
    let mut damage = Damage(Pcg64::seed_from_u64(number_from("PBRDF_FUZZ_SEED", 1)));
    let end = Instant::now() + Duration::from_secs(number_from("PBRDF_FUZZ_SECONDS", 1));
    let (mut tried, mut accepted) = (0_u64, 0_u64);
    while Instant::now() < end {
        let input = damage.of(samples);
        match catch_unwind(AssertUnwindSafe(|| read(&input))) {
            Ok(is_accepted) => accepted += u64::from(is_accepted),
            Err(_) => {
                let path = std::env::temp_dir().join(format!("pbrdf-fuzz-{name}"));
                std::fs::write(&path, &input).expect("a writable folder for temporary files");
                panic!("{name}: input {tried} panics; it is in {}", path.display());
            }
        }
        tried += 1;
    }
    println!("{name}: {tried} inputs, {accepted} accepted");
}

pub fn texts(samples: &[&str]) -> Vec<Vec<u8>> {
    samples.iter().map(|text| text.as_bytes().to_vec()).collect()
}
