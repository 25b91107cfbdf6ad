"""What the tests share: the files of the repository, and its command line."""

from __future__ import annotations

import csv
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def example() -> Path:
    """A simulated measurement that comes with the program."""
    return ROOT / "assets/examples/steel45_simulated.csv"


@pytest.fixture(scope="session")
def golden():
    """A reference table by its name, row by row: values and derivatives in 60-digit arithmetic."""

    def rows(name: str) -> list[dict[str, str]]:
        lines = (ROOT / "core/assets/reference" / name).read_text(encoding="utf-8").splitlines()
        return list(csv.DictReader(line for line in lines if not line.startswith("#")))

    return rows


@pytest.fixture(scope="session")
def program():
    """The command line; PBRDF_EXPLORER names the program, as `.ci/python` does."""
    path = os.environ.get("PBRDF_EXPLORER")
    if not path:
        pytest.skip("PBRDF_EXPLORER names no program to compare with")

    def run(*arguments: object) -> str:
        done = subprocess.run([path, *map(str, arguments)], capture_output=True, check=False, encoding="utf-8")
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run
