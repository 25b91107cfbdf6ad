#!/bin/sh
# Makes the pictures of the book with the program given as the first argument. Those that need more than the program have scripts of their
# own: make_picture.sh; screenshots of the window need Xvfb, xdotool and scrot.
set -e
program=$(realpath "$1")
docs=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$docs/images"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cp "$docs"/../assets/examples/*.csv .

# A fit of the example, and what its data leave open.
"$program" fit steel45_simulated.csv --figure "$docs/images/fit.svg" > /dev/null

# The window after a fit.
if command -v Xvfb > /dev/null && command -v xdotool > /dev/null && command -v scrot > /dev/null; then
    export HOME="$folder" XDG_CONFIG_HOME="$folder/config" XDG_DATA_HOME="$folder/data" XDG_CACHE_HOME="$folder/cache" DISPLAY=":${DISPLAY_NUMBER:-15}"
    Xvfb "$DISPLAY" -screen 0 1366x768x24 > /dev/null 2>&1 &
    server=$!
    sleep 1
    "$program" steel45_simulated.csv &
    window=$!
    for _ in $(seq 100); do xdotool search --onlyvisible --name pbrdf > /dev/null 2>&1 && break; sleep 0.2; done
    xdotool search --onlyvisible --name pbrdf windowsize 1366 768 windowmove 0 0 windowfocus
    sleep 2
    xdotool key F5
    sleep "${FIT_SECONDS:-10}"
    scrot -o "$docs/images/window.png"
    kill "$window" "$server"
else
    echo "without Xvfb, xdotool and scrot the screenshots stay as they are" >&2
fi
