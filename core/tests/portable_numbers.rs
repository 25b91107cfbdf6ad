//! The switch to portable instructions, which is one of the whole process: this file has one test.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use pbrdf::model::{Batch, Instructions, Model, Parameters, Pbrdf};
use pbrdf::optics::Geometry;

#[test]
fn the_switch_makes_all_numbers_those_of_portable_instructions_or_refuses() {
    let surface = Pbrdf::new(Model::CAUCHY, Parameters::default()).expect("a surface");
    let at = |i: u32| Geometry::new(30.0 + 0.01 * f64::from(i), 0.02 * f64::from(i), 180.0).expect("a geometry");
    let dolp = |instructions| {
        let mut dolp = Vec::new();
        Batch::new((0..4000).map(at)).with_instructions(instructions).dolp(&surface, &mut dolp);
        dolp.iter().map(|value| value.to_bits()).collect::<Vec<_>>()
    };
    let (widest, portable) = (dolp(Instructions::Widest), dolp(Instructions::Portable));
    let name = Instructions::Widest.name();
    let is_switched = Instructions::use_portable_only();
    // Where the narrowest vectors fuse as well, nothing could be switched.
    assert_eq!(is_switched, !cfg!(target_arch = "aarch64"));
    assert_eq!(dolp(Instructions::Widest), if is_switched { portable.clone() } else { widest.clone() });
    assert_eq!(Instructions::Widest.name(), if is_switched { Instructions::Portable.name() } else { name });
    // Fused products differ somewhere among so many values: the switch is not for nothing.
    assert_eq!(widest != portable, ["AVX-512", "AVX2"].contains(&name));
}
