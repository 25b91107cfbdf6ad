#!/usr/bin/env bash
# Builds the Debian package into target/debian; needs `cargo install cargo-deb`. With --no-build the program in target/release is taken
# as it is.
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
    --no-build) ;;
    *) cargo build --release --locked ;;
esac
cargo run -q --release -p pbrdf-explorer --example package_files --no-default-features --features cli -- target/package-files
cargo deb --no-build -o "${CARGO_TARGET_DIR:-target}/debian/"
