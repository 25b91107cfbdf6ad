"""The examples of the documentation."""

from __future__ import annotations

import doctest
import importlib.util
import os
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import pbrdf
import pytest

MODULES = ["pbrdf", *(f"pbrdf.{module.name}" for module in pkgutil.iter_modules(pbrdf.__path__) if module.name != "_pbrdf")]


def test_the_examples_of_docstrings_hold():
    results = [doctest.testmod(importlib.import_module(name)) for name in MODULES]
    assert sum(result.failed for result in results) == 0 and sum(result.attempted for result in results) > 10


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", ["python/README.md", "docs/python.md"])
def test_the_pages_of_the_package_run(name, tmp_path, example, monkeypatch, capsys):
    page = (Path(__file__).parents[2] / name).read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    assert blocks
    (tmp_path / "steel.csv").write_bytes(example.read_bytes())
    monkeypatch.chdir(tmp_path)
    names = {}
    for block in blocks:
        if "matplotlib" in block:
            pytest.importorskip("matplotlib").use("Agg")
        exec(compile(block, "README.md", "exec"), names)
    assert capsys.readouterr().out


def test_the_examples_run(tmp_path, example):
    folder = Path(__file__).parents[1] / "examples"
    (tmp_path / "steel.csv").write_bytes(example.read_bytes())
    needs = {"fit_table.py": "matplotlib"}
    arguments = {"many_files.py": ["steel.csv"]}
    scripts = sorted(folder.glob("*.py"))
    assert len(scripts) == 3
    for script in scripts:
        if script.name in needs and importlib.util.find_spec(needs[script.name]) is None:
            continue
        run = [sys.executable, str(script), *arguments.get(script.name, [])]
        done = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True, env={**os.environ, "MPLBACKEND": "Agg"})
        assert done.returncode == 0 and done.stdout, done.stderr


def test_everything_public_is_documented():
    for name in pbrdf.__all__:
        item = getattr(pbrdf, name)
        if callable(item):
            assert item.__doc__, name
