"""The examples of the documentation."""

from __future__ import annotations

import doctest
import importlib
import pkgutil
import re
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


def test_everything_public_is_documented():
    for name in pbrdf.__all__:
        item = getattr(pbrdf, name)
        if callable(item):
            assert item.__doc__, name
