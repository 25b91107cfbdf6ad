#!/bin/sh
# The font of figures: DejaVu Sans (Debian package fonts-dejavu-core), less the glyphs that no figure needs.
# Needs pyftsubset: pip install fonttools.
set -eu
cd "$(dirname "$0")"
pyftsubset "${1:-/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf}" \
    --unicodes="U+0020-007E,U+00A0-017F,U+0218-021B,U+0370-03FF,U+0400-045F,U+1D62-1D65,U+2010-2015,U+2018-201E,U+2020-2022,U+2026,U+2030,U+2032,U+2033,U+2070-209C,U+20AC,U+2103,U+210F,U+2113,U+2126,U+212B,U+2190-2194,U+21D2,U+21D4,U+2202,U+2206-2208,U+220F,U+2211,U+2212,U+2215,U+221A,U+221D,U+221E,U+2220,U+2225,U+222B,U+2248,U+2260,U+2261,U+2264,U+2265,U+226A,U+226B,U+22A5,U+22C5,U+25A0,U+25CB,U+25CF,U+2713,U+2717,U+FFFD" \
    --no-hinting --notdef-outline --desubroutinize --layout-features='' --name-IDs='*' --drop-tables+=GPOS,GSUB,GDEF,FFTM,kern \
    --output-file=figure.ttf
