#!/usr/bin/env bash
# Installs a Debian package in a clean system, starts the program under a virtual display, opens a session by its MIME type, and removes it
# without a trace: packaging/test_deb.sh PACKAGE.deb
#
# Needs root, debootstrap, and a mirror of Debian (MIRROR; that of apt without). BASE names a folder with a clean system that is copied instead.
set -euo pipefail
package=$(realpath "$1")
source=$(cd "$(dirname "$0")/.." && pwd)
mirror=${MIRROR:-$(cat /etc/apt/sources.list /etc/apt/sources.list.d/* 2> /dev/null | sed -nE '/^#/!s#.*(https?://[^ ]*).*#\1#p' | sed -n 1p || true)}
root=$(mktemp -d "${TMPDIR:-/tmp}/pbrdf-deb.XXXXXX")
trap 'for at in dev/pts dev proc; do umount -q "$root/$at" 2> /dev/null || true; done; rm -rf "$root"' EXIT
step() { printf '== %s\n' "$*"; }

step "a clean system"
if [ -n "${BASE:-}" ]; then
    cp -a "$BASE/." "$root"
else
    debootstrap --variant=minbase --include=ca-certificates bookworm "$root" "$mirror" > "$root.log" 2>&1 || { tail "$root.log"; exit 1; }
    rm -f "$root.log"
fi
for file in /etc/resolv.conf /etc/hosts; do cp -L "$file" "$root$file" 2> /dev/null || true; done
cp -r /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/" 2> /dev/null || true
mount -t proc proc "$root/proc"
mount --bind /dev "$root/dev"
mount -t devpts devpts "$root/dev/pts"
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/home/reader LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
mkdir -p "$root/home/reader"
inside apt-get -qq update
inside apt-get -qq install -y --no-install-recommends xvfb xauth xdotool xdg-utils shared-mime-info desktop-file-utils libfile-mimeinfo-perl > /dev/null
list() { (cd "$root" && find etc usr var/lib/dpkg/info home -type f ! -path '*/mime/*' ! -name '*.cache' ! -name mimeinfo.cache | sort); }
list > "$root/tmp/before"

step "install"
cp "$package" "$root/tmp/package.deb"
inside apt-get -qq install -y --no-install-recommends /tmp/package.deb > /dev/null
inside pbrdf-explorer --version
inside pbrdf-explorer fit /usr/share/doc/pbrdf-explorer/examples/steel45_simulated.csv --starts 1 | head -1
test -s "$root/usr/share/man/man1/pbrdf-explorer-fit.1.gz"
inside bash -c 'source /usr/share/bash-completion/completions/pbrdf-explorer && complete -p pbrdf-explorer'

step "a session has its type, and opens by it"
cp "$source/tests/fixtures/v0.1/plain_with_a_fit.pbrdf.json" "$root/home/reader/work.pbrdf.json"
type=$(inside xdg-mime query filetype /home/reader/work.pbrdf.json)
test "$type" = application/vnd.pbrdf-explorer.session+json || { echo "its type is $type"; exit 1; }
test "$(inside xdg-mime query default "$type")" = pbrdf-explorer.desktop
inside xvfb-run -a -s "-screen 0 1366x768x24" bash -c '
    xdg-open /home/reader/work.pbrdf.json > /dev/null 2>&1 &
    for _ in $(seq 300); do
        window=$(xdotool search --name "^work .* pBRDF explorer" 2> /dev/null | head -1)
        [ -n "$window" ] && break
        sleep 0.2
    done
    [ -n "$window" ] || { echo "no window has the name of the session"; xdotool search --name . getwindowname %@; exit 1; }
    xdotool getwindowname "$window"
    kill "$(xdotool getwindowpid "$window")"
    wait'

step "remove"
inside apt-get -qq purge -y pbrdf-explorer > /dev/null
rm -rf "$root"/home/reader/{.config,.local,.cache,work.pbrdf.json}
inside apt-get -qq autoremove -y --purge > /dev/null
list > "$root/tmp/after"
left=$(comm -13 "$root/tmp/before" "$root/tmp/after" | grep -i pbrdf || true)
test -z "$left" || { echo "left behind: $left"; exit 1; }
echo "installed, started, opened a session by its type, removed without a trace"
