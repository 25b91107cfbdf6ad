"""Many files on all processors: python many_files.py FILE... ; writes results.csv, and goes on where it was when it is run again."""

import sys

import pbrdf


def told(done, total, left):
    print(f"\r{done} of {total}" + ("" if left is None else f", {left:.0f} s left"), end="", file=sys.stderr)


if __name__ == "__main__":
    table = pbrdf.map_fits(sys.argv[1:], fix={"ks": 1.0}, output="results.csv", progress=told)
    print(table)
    for file, sentence in table.failures.items():
        print(f"{file}: {sentence}")
