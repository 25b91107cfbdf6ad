//! The machine that a report was made on, as far as it bears on times.

use std::fmt;

/// Processor, vector units, system, build.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Machine {
    /// Name of the processor, or its architecture where it has no name.
    pub processor: String,
    /// Threads that run at once.
    pub threads: usize,
    /// Vector instructions that the processor has and that bear on the kernels here.
    pub vectors: Vec<&'static str>,
}

impl Machine {
    /// From the text of `/proc/cpuinfo` (empty where there is none) and the number of threads that run at once.
    #[must_use]
    pub fn new(cpuinfo: &str, threads: usize) -> Self {
        let value = |key: &str| {
            let mut lines = cpuinfo.lines().filter_map(|line| line.split_once(':'));
            lines.find(|(name, _)| name.trim() == key).map(|(_, value)| value.trim().to_owned())
        };
        let processor = value("model name").or_else(|| value("Model")).unwrap_or_else(|| std::env::consts::ARCH.to_owned());
        Self { processor, threads, vectors: vectors() }
    }
}

#[cfg(target_arch = "x86_64")]
fn vectors() -> Vec<&'static str> {
    let all = [
        ("AVX2", is_x86_feature_detected!("avx2")),
        ("FMA", is_x86_feature_detected!("fma")),
        ("AVX-512", is_x86_feature_detected!("avx512f")),
    ];
    all.into_iter().filter(|(_, has)| *has).map(|(name, _)| name).collect()
}

#[cfg(target_arch = "aarch64")]
fn vectors() -> Vec<&'static str> {
    // Part of the architecture.
    vec!["NEON"]
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
fn vectors() -> Vec<&'static str> {
    Vec::new()
}

impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { processor, threads, vectors } = self;
        let plural = if *threads == 1 { "" } else { "s" };
        write!(f, "{processor}, {threads} thread{plural}")?;
        if !vectors.is_empty() {
            write!(f, ", {}", vectors.join(" "))?;
        }
        let build = if cfg!(debug_assertions) { ", a build with debug assertions: times say little" } else { "" };
        write!(f, ", {} {}, pbrdf-explorer {}{build}", std::env::consts::OS, std::env::consts::ARCH, env!("CARGO_PKG_VERSION"))
    }
}

#[cfg(test)]
mod tests {
    use super::Machine;

    #[test]
    fn the_processor_is_called_by_the_name_it_gives_itself() {
        let machine = Machine::new("processor\t: 0\nmodel name\t: Some CPU @ 3 GHz: fast\nflags\t\t: fpu avx2\n", 2);
        assert_eq!(machine.processor, "Some CPU @ 3 GHz: fast");
        assert!(machine.to_string().starts_with("Some CPU @ 3 GHz: fast, 2 threads"), "{machine}");
    }

    #[test]
    fn a_processor_without_a_name_is_called_by_its_architecture() {
        assert_eq!(Machine::new("", 1).processor, std::env::consts::ARCH);
    }
}
