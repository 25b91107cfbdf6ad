#!/usr/bin/env bash
# Opens web/dist in Debian's Chromium without a screen and tries it out as a user would; see web/drive.cjs.
#
#   web/build.sh && web/test.sh
#
# Needs chromium and node (apt-get install chromium nodejs npm); the driver, playwright-core, comes from npm. Pictures go to web/shots.
set -euo pipefail
cd "$(dirname "$0")"
[ -f dist/index.html ] || { echo "web/dist is not there: run web/build.sh first"; exit 1; }
chromium=${CHROMIUM:-$(command -v chromium || command -v chromium-browser || true)}
[ -n "$chromium" ] || { echo "chromium is not there: apt-get install chromium"; exit 1; }
target=${CARGO_TARGET_DIR:-$PWD/../target}
# What the fit is compared with.
program=${PROGRAM:-}
if [ -z "$program" ]; then
  (cd .. && cargo build --quiet --release --no-default-features --features cli --bin pbrdf-explorer)
  program=$target/release/pbrdf-explorer
fi
modules=${NODE_MODULES:-$target/web-tools/node}
if [ ! -d "$modules/node_modules/playwright-core" ]; then
  mkdir -p "$modules"
  npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$modules" playwright-core@1
fi
mkdir -p shots
NODE_PATH=$modules/node_modules CHROMIUM=$chromium PROGRAM=$program node drive.cjs "$@"
