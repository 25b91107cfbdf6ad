#!/usr/bin/env python3
"""Makes the bundled fonts: what the window's default fonts lack, and what a page takes in place of these, no more.

cjk.ttf      from Droid Sans Fallback (Debian fonts-droid-fallback, Apache-2.0): the 3755 characters of GB 2312 level 1, Chinese
             punctuation, and whatever else the translations and lessons use
symbols.ttf  from DejaVu Sans (Debian fonts-dejavu-core, Bitstream Vera licence): arrows, marks and mathematical signs
page-text.ttf, page-mono.ttf
             from the default fonts Ubuntu Light and Hack of egui (crate epaint_default_fonts), without the instructions that fit
             outlines to pixels (egui does it where there are none); Ubuntu's licence wants another name for such a font

    apt-get install fonts-droid-fallback fonts-dejavu-core && pip install fonttools
    python3 assets/fonts/make_subset.py
"""

import pathlib
import subprocess

from fontTools import subset

ASSETS = pathlib.Path(__file__).resolve().parent.parent
SYMBOLS = "⁻∇→←↑↓↔↺↶↷◧◨⇒⇔′″∝∈✓✗▲▼▶◀■□●○★⇧⏎−⁵⁶⁷⁸⁹⁺₃₄₅₆₇₈₉ₖₛ∥⊥"
# Western Europe's letters, Greek, general punctuation, superscripts, arrows, mathematics, technical signs, shapes. Other letters of Europe
# come from the font of figures.
RANGES = [(0x20, 0x7E), (0xA0, 0xFF), (0x2000, 0x206F), (0x2070, 0x209C), (0x20AC, 0x20AC), (0x2100, 0x214F), (0x2190, 0x23FF), (0x25A0, 0x27BF)]
PAGE = [chr(code) for first, last in [*RANGES, (0x131, 0x131), (0x152, 0x153), (0x370, 0x3FF), (0xFFFD, 0xFFFD)] for code in range(first, last + 1)]
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


def default_fonts():
    """The folder of egui's default fonts, in cargo's sources."""
    [folder] = pathlib.Path.home().glob(".cargo/registry/src/*/epaint_default_fonts-" + version() + "/fonts")
    return folder


def version():
    found = subprocess.run(["cargo", "tree", "--target", "all", "-i", "epaint_default_fonts", "--depth", "0"], capture_output=True, text=True, check=True)
    return found.stdout.split()[1].removeprefix("v")


def make(source, characters, target, name=None, features=()):
    options = subset.Options(hinting=False, notdef_outline=True, name_IDs=[0, 1, 2, 13, 14], layout_features=list(features))
    options.drop_tables += ["TTFA"]
    font = subset.load_font(source, options)
    subsetter = subset.Subsetter(options)
    subsetter.populate(text="".join(sorted(set(characters))))
    subsetter.subset(font)
    for record in font["name"].names if name else []:
        if record.nameID == 1:
            record.string = name
    subset.save_font(font, str(ASSETS / "fonts" / target), options)


make("/usr/share/fonts/truetype/droid/DroidSansFallbackFull.ttf", [*gb2312_level_1(), *PUNCTUATION, *used()], "cjk.ttf")
make("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", SYMBOLS, "symbols.ttf")
make(default_fonts() / "Ubuntu-Light.ttf", PAGE, "page-text.ttf", "Ubuntu Light derivative pbrdf-explorer", ["kern", "liga", "mark"])
make(default_fonts() / "Hack-Regular.ttf", PAGE, "page-mono.ttf", features=["mark"])
