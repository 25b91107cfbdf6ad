#!/usr/bin/env python3
"""Makes the two bundled fonts: what the window's default fonts lack, and no more.

cjk.ttf      from Droid Sans Fallback (Debian fonts-droid-fallback, Apache-2.0): the 3755 characters of GB 2312 level 1, Chinese
             punctuation, and whatever else the translations and lessons use
symbols.ttf  from DejaVu Sans (Debian fonts-dejavu-core, Bitstream Vera licence): arrows, marks and mathematical signs

    apt-get install fonts-droid-fallback fonts-dejavu-core && pip install fonttools
    python3 assets/fonts/make_subset.py
"""

import pathlib

from fontTools import subset

ASSETS = pathlib.Path(__file__).resolve().parent.parent
SYMBOLS = "⁻∇→←↑↓↔⇒⇔′″∝∈✓✗▲▼▶◀■□●○★⇧⏎−⁵⁶⁷⁸⁹⁺₃₄₅₆₇₈₉ₖₛ∥⊥"
PUNCTUATION = "，。：；！？（）《》、“”‘’…—·「」【】％～"


def gb2312_level_1():
    """Rows 16 to 55 of GB 2312: the common characters."""
    for row in range(0xB0, 0xD8):
        for cell in range(0xA1, 0xFF):
            try:
                yield bytes([row, cell]).decode("gb2312")
            except UnicodeDecodeError:
                pass  # The last row is not full.


def used():
    for path in [*ASSETS.glob("locales/*.po"), *ASSETS.glob("lessons/*.md")]:
        yield from (c for c in path.read_text(encoding="utf-8") if ord(c) >= 0x2E80)


def make(source, characters, target):
    options = subset.Options(hinting=False, notdef_outline=True, name_IDs=[0, 1, 2, 13, 14], layout_features=[])
    font = subset.load_font(source, options)
    subsetter = subset.Subsetter(options)
    subsetter.populate(text="".join(sorted(set(characters))))
    subsetter.subset(font)
    subset.save_font(font, str(ASSETS / "fonts" / target), options)


make("/usr/share/fonts/truetype/droid/DroidSansFallbackFull.ttf", [*gb2312_level_1(), *PUNCTUATION, *used()], "cjk.ttf")
make("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", SYMBOLS, "symbols.ttf")
