"""Documentation of fields: help() shows none of the texts that stand under them in the source."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterable
from pathlib import Path

# A class with its body, and a field with the text under it.
_CLASS = re.compile(r"^class (\w+).*?(?=^\S|\Z)", re.MULTILINE | re.DOTALL)
_FIELD = re.compile(r'^    (\w+): [^\n]+\n    """(.*?)"""', re.MULTILINE | re.DOTALL)


def describe(classes: Iterable[type]) -> None:
    """Puts the texts under the fields of these classes where help() finds them."""
    sources: dict[str, dict[str, str]] = {}
    for one in classes:
        module = one.__module__
        if module not in sources:
            sources[module] = _bodies(one)
        fields = {name: re.sub(r"\s+", " ", text) for name, text in _FIELD.findall(sources[module].get(one.__name__, ""))}
        if not fields or one.__doc__ is None:
            continue
        if issubclass(one, tuple):
            for name, text in fields.items():
                getattr(one, name).__doc__ = text
        else:
            lines = "".join(f"\n    {name}: {text}" for name, text in fields.items())
            one.__doc__ = f"{one.__doc__}\n\nAttributes:{lines}"


def _bodies(one: type) -> dict[str, str]:
    """The text of each class of the file of that one; none where it is compiled, or the source was not installed."""
    try:
        text = Path(inspect.getsourcefile(one) or "").read_text(encoding="utf-8")
    except (OSError, TypeError):
        return {}
    return {found.group(1): found.group(0) for found in _CLASS.finditer(text)}
