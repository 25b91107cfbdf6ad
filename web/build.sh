#!/usr/bin/env bash
# Builds the page of the explorer into web/dist: static files with relative paths, for any web server.
#
# Where the target wasm32-unknown-unknown is installed (rustup target add wasm32-unknown-unknown), the ordinary toolchain builds it. On
# Debian without it, the compiler of the package rustc-web does, which comes with the sources of the standard library; the packages are
# unpacked beside the build, not installed. wasm-bindgen is built in the version of Cargo.lock where it is not there; wasm-opt is used
# where it is.
set -euo pipefail
cd "$(dirname "$0")/.."
target=${CARGO_TARGET_DIR:-$PWD/target}
tools=$target/web-tools
export CARGO_TARGET_DIR=$target/wasm
# Vectors of 128 bits, which browsers have had since 2021 (Safari since 2023); no tables of references, which Debian's wasm-opt mixes up with
# those of functions; a stack of 4 MiB, half of what a desktop gives.
export CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS="-Ctarget-feature=+simd128,-reference-types -Clink-arg=-zstack-size=4194304"
profile=${PROFILE:-web}
mkdir -p "$tools"

bindgen=$(sed -n '/^name = "wasm-bindgen"$/{n;s/version = "\(.*\)"/\1/p}' Cargo.lock)
if [ "$(wasm-bindgen --version 2>/dev/null || true)" = "wasm-bindgen $bindgen" ]; then
  wasm_bindgen=wasm-bindgen
else
  wasm_bindgen=$tools/bin/wasm-bindgen
  install_bindgen() { CARGO_TARGET_DIR=$tools/build cargo install --quiet "$@" wasm-bindgen-cli --version "$bindgen" --root "$tools"; }
  # A mirror of the registry may lack a version that the tool's lock file names.
  [ "$("$wasm_bindgen" --version 2>/dev/null || true)" = "wasm-bindgen $bindgen" ] || install_bindgen --locked || install_bindgen
fi

# Unpacks Debian's compiler for browsers, and names it to cargo.
debian_toolchain() {
  local root=$tools/debian std llvm
  if [ ! -x "$root/usr/bin/rustc" ]; then
    std=$(apt-cache depends libstd-rust-web-dev | sed -n 's/.*Depends: \(libstd-rust-web-[0-9.]*\)$/\1/p' | head -1)
    llvm=$(apt-cache depends rustc-web "$std" | sed -n 's/.*Depends: \(libllvm[0-9]*\)$/\1/p' | head -1)
    [ -n "$std" ] && [ -n "$llvm" ] || { echo "no target wasm32-unknown-unknown, and no package rustc-web (apt-get update first)"; exit 1; }
    mkdir -p "$tools/debs"
    (cd "$tools/debs" && apt-get download rustc-web rust-web-src libstd-rust-web-dev "$std" "$llvm")
    for package in "$tools"/debs/*.deb; do dpkg -x "$package" "$root"; done
  fi
  export LD_LIBRARY_PATH=$root/usr/lib/x86_64-linux-gnu:$(dirname "$(find "$root" -name 'libLLVM*.so*' | head -1)")
  local found wanted
  found=$("$root/usr/bin/rustc" -V | cut -d' ' -f2 || true)
  wanted=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml | head -1)
  if [ "$(printf '%s\n' "$wanted" "$found" | sort -V | head -1)" != "$wanted" ]; then
    rm -rf "$root" "$tools/debs"
    echo "Debian's rustc-web is $found, the program needs $wanted: apt-get update first, with bookworm-security among the sources" >&2
    exit 1
  fi
  CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=$(rustc --print sysroot)/lib/rustlib/$(rustc -vV | sed -n 's/host: //p')/bin/rust-lld
  export CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER RUSTC=$root/usr/bin/rustc RUSTC_BOOTSTRAP=1
}

own_std=()
if [ ! -d "$(rustc --print target-libdir --target wasm32-unknown-unknown 2>/dev/null)" ]; then
  debian_toolchain
  own_std=(-Zbuild-std=std,panic_abort)
fi
cargo build --profile "$profile" --target wasm32-unknown-unknown "${own_std[@]}" --no-default-features --features gui --bin pbrdf-explorer

dist=web/dist
rm -rf "$dist"
mkdir -p "$dist"
"$wasm_bindgen" --target web --no-typescript --remove-name-section --remove-producers-section --out-dir "$dist" "$CARGO_TARGET_DIR/wasm32-unknown-unknown/$profile/pbrdf-explorer.wasm"
program=$dist/pbrdf-explorer_bg.wasm
if command -v wasm-opt >/dev/null; then
  # Releases of wasm-opt that do not know what the compiler uses leave the program as it is.
  if wasm-opt -Os --enable-bulk-memory --enable-nontrapping-float-to-int --enable-sign-ext --enable-mutable-globals \
    --enable-multivalue --enable-simd "$program" -o "$program.small" 2>"$tools/wasm-opt.log"; then
    mv "$program.small" "$program"
  else
    rm -f "$program.small"
    echo "wasm-opt left out: $(head -1 "$tools/wasm-opt.log")"
  fi
fi
sed "s/@BYTES@/$(stat -c %s "$program")/" web/main.js > "$dist/main.js"
cp web/index.html web/style.css web/worker.js web/repaint.js "$dist/"
gzipped=$(for file in "$dist"/*; do gzip -9 -c "$file" | wc -c; done | awk '{ sum += $1 } END { print sum }')
echo "web/dist: $(du -cb "$dist"/* | tail -1 | cut -f1) bytes, $gzipped gzipped"
