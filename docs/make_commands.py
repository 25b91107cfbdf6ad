#!/usr/bin/env python3
"""Makes docs/commands.md from the program's own help: python3 docs/make_commands.py

The help is that of tests/contract/snapshots/help.snap, which a test of the program keeps up to date.
"""

import pathlib
import re

DOCS = pathlib.Path(__file__).resolve().parent
HEAD = """# Every option

What `pbrdf-explorer help COMMAND` prints. Made by `docs/make_commands.py`; do not edit.
"""


def commands():
    """The help of each command."""
    snapshot = (DOCS.parent / "tests/contract/snapshots/help.snap").read_text(encoding="utf-8")
    for part in re.split(r"^\$ pbrdf-explorer ", snapshot, flags=re.M)[1:]:
        command, rest = part.split("\n", 1)
        if command.endswith(" --help"):
            yield command.removesuffix(" --help"), rest.split("--- stdout ---\n", 1)[1].rstrip("\n")


def page():
    """The text of the chapter."""
    return "\n".join([HEAD, *(f"## {command}\n\n```text\n{text}\n```\n" for command, text in commands())])


if __name__ == "__main__":
    (DOCS / "commands.md").write_text(page(), encoding="utf-8")
