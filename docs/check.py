#!/usr/bin/env python3
"""Checks the book: python3 docs/check.py [PROGRAM]

Every chapter is in SUMMARY.md; every link leads to a file and every anchor to a heading, also between the
book and the library's documentation; the chapter of options is that of the program's help; with mdbook on
the PATH the book builds without a warning; and with the path of pbrdf-explorer given, every block of ```sh
in the chapters and in README.md runs, in one folder a chapter that holds the measurements that the chapters
speak of, and prints the lines that stand right below it; and the errors that numerics.md states are found.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import make_commands

DOCS = pathlib.Path(__file__).resolve().parent
ROOT = DOCS.parent
EXAMPLES = ROOT / "assets" / "examples"
# The error that `report stability` allows.
TEXTBOOK_LIMIT = 1e-13
LIBRARY = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "doc"
# Names that chapters give to a reader's own measurements, and the example that stands in for each.
# Blocks of Python and Rust run elsewhere: python/tests/test_examples.py, and as documentation tests of the core.
OWN = {"mine": "steel45", "blue": "copper_650nm", "green": "copper_650nm", "red": "copper_650nm", "copper": "copper_650nm",
       "aluminium": "aluminium_650nm", "monday": "steel45", "tuesday": "steel45"}


def anchors(text):
    """The anchors that mdBook and GitHub give to headings."""
    for heading in re.findall(r"^#+ (.*)$", text, re.M):
        yield re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def faulty_links(path, text):
    """Links that lead nowhere. Those to ../doc lead to what `cargo doc` makes, and are looked at where it has."""
    text = re.sub(r"```.*?```|`[^`\n]*`", "", text, flags=re.S)
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if "://" in target:
            continue
        name, _, anchor = target.partition("#")
        if name.startswith("../doc/"):
            if (LIBRARY / "pbrdf").exists() and not (LIBRARY / name.removeprefix("../doc/")).exists():
                yield f"{path.name}: cargo doc makes no {target}"
            continue
        goal = path.parent / name if name else path
        if not goal.exists():
            yield f"{path.name}: there is no {target}"
        elif anchor and anchor not in anchors(goal.read_text(encoding="utf-8")):
            yield f"{path.name}: {name} has no heading {anchor}"


def faulty_links_of_the_library():
    """Links of the library's documentation to chapters, which mdBook makes beside it."""
    text = (ROOT / "core" / "src" / "lib.rs").read_text(encoding="utf-8")
    links = re.findall(r"\]\(\.\./\.\./book/(\w+)\.html(#[\w-]+)?\)", text)
    if not links or len(links) != text.count("](../../book/"):
        yield "lib.rs: there are links to the book that are no links to a chapter"
    chapters = "\n".join(f"[]({name}.md{anchor})" for name, anchor in links)
    yield from (f"lib.rs: {fault}" for fault in faulty_links(DOCS / "rust.md", chapters))


def unnamed_panes():
    """Panes that the chapter on lessons does not name, though a lesson may."""
    table = (ROOT / "src" / "app" / "work" / "pane_id.rs").read_text(encoding="utf-8")
    lessons = (DOCS / "lessons.md").read_text(encoding="utf-8")
    for key in re.findall(r"^ +\w+ (\w+) (?:Upper|Lower),$", table, re.M):
        if f"`{key}`" not in lessons:
            yield f"lessons.md does not name the pane {key}"


def measurements(folder):
    """What the commands read."""
    for example in EXAMPLES.iterdir():
        shutil.copy(example, folder)
    for name, example in OWN.items():
        shutil.copy(EXAMPLES / f"{example}_simulated.csv", folder / f"{name}.csv")
    header, *rows = [line for line in (EXAMPLES / "steel45_simulated.csv").read_text().splitlines() if not line.startswith("#")]
    sets = [f"{row},{name}" for name in ("first", "second") for row in rows]
    (folder / "lab.csv").write_text("\n".join([f"{header},set", *sets, ""]))


def number(word):
    """The number that a word of a table is, if it is one."""
    try:
        return float(word.replace("−", "-"))
    except ValueError:
        return None


def is_printed(shown, lines):
    """Whether a line begins with these words, and with these numbers within 1e-3: the last digits of values on
    a flat valley, and times, are not the same everywhere."""
    words = shown.split()
    for line in lines:
        pairs = list(zip(words, line.split()))
        same = [a == b or (number(a) is not None and number(b) is not None and abs(number(a) - number(b)) <= 1e-3 * abs(number(b)))
                for a, b in pairs]
        if len(pairs) == len(words) and all(same):
            return True
    return " ms)" in shown


def failing_commands(path, text, program):
    """Commands that fail, and lines in a block of ```text right below them that they do not print."""
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        measurements(folder)
        os.symlink(program.resolve(), folder / "pbrdf-explorer")
        environment = {**os.environ, "PATH": f"{place}:{os.environ['PATH']}"}
        for block, answer in re.findall(r"^```sh\n(.*?)^```\n(?:\n```text\n(.*?)^```)?", text, re.M | re.S):
            done = subprocess.run(["sh", "-euc", block], cwd=place, env=environment, capture_output=True, text=True)
            if done.returncode:
                yield f"{path.name}: {block}{done.stderr}"
            lines = done.stdout.splitlines()
            yield from (f"{path.name}: not printed: {line}" for line in answer.splitlines() if not is_printed(line, lines))


def faults_of_the_book():
    """What mdBook says of the book, where it is installed."""
    if not shutil.which("mdbook"):
        print("mdbook is not installed: the book is not built")
        return
    with tempfile.TemporaryDirectory() as place:
        done = subprocess.run(["mdbook", "build", str(DOCS), "-d", place], capture_output=True, text=True)
        said = done.stdout + done.stderr
        if done.returncode or re.search(r"\b(WARN|ERROR)\b", said):
            yield f"mdbook: {said}"


def false_figures(program):
    """Errors that the chapter on numerics and README.md state, and the program does not find."""
    def rows(report):
        done = subprocess.run([program.resolve(), "report", report, "--json"], capture_output=True, text=True, check=True)
        return json.loads(done.stdout)["rows"]

    numerics = (DOCS / "numerics.md").read_text(encoding="utf-8")
    for row in rows("error-vs-time"):
        if row["task"] == "evaluate":
            shown = f"| {row['method']} | {row['worst_relative_error']:.1e} | {row['median_relative_error']:.1e} |"
            if shown not in numerics:
                yield f"numerics.md does not state: {shown}"
    cases = rows("stability")
    textbook = [case["textbook_error"] for case in cases if case["textbook_error"] is not None]
    passed, missed = sum(case["pass"] for case in cases), sum(error > TEXTBOOK_LIMIT for error in textbook)
    for path, sentence in [("docs/numerics.md", f"All {passed} pass."), ("docs/numerics.md", f"in {missed} of the {len(textbook)}."),
                           ("README.md", f"{passed} of {len(cases)} pass; textbook formulas miss {missed} of {len(textbook)}")]:
        if sentence not in (ROOT / path).read_text(encoding="utf-8"):
            yield f"{path} does not state: {sentence}"


def main():
    summary = (DOCS / "SUMMARY.md").read_text(encoding="utf-8")
    faults = []
    if (DOCS / "commands.md").read_text(encoding="utf-8") != make_commands.page():
        faults.append("commands.md is not what the program prints: run docs/make_commands.py")
    faults += faults_of_the_book()
    faults += faulty_links_of_the_library()
    faults += unnamed_panes()
    for path in [*sorted(DOCS.rglob("*.md")), *sorted(ROOT.glob("*.md")), ROOT / "python" / "README.md"]:
        text = path.read_text(encoding="utf-8")
        faults += faulty_links(path, text)
        name = path.relative_to(DOCS).as_posix() if path.is_relative_to(DOCS) else "SUMMARY.md"
        if name != "SUMMARY.md" and f"({name})" not in summary:
            faults.append(f"{name} is not in SUMMARY.md")
        if len(sys.argv) > 1 and (path.is_relative_to(DOCS) or path == ROOT / "README.md"):
            faults += failing_commands(path, text, pathlib.Path(sys.argv[1]))
    if len(sys.argv) > 1:
        faults += false_figures(pathlib.Path(sys.argv[1]))
    print("\n".join(faults) or "the book is in order")
    return 1 if faults else 0


sys.exit(main())
