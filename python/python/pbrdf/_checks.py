"""Arguments turned into what the compiled part takes, or refused in one sentence."""

from __future__ import annotations

import functools
import math
import sys
import warnings
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from . import _pbrdf
from ._pbrdf import PbrdfError


def numbers(name: str, value: Any) -> np.ndarray:
    """An array of float64, of any shape."""
    try:
        array = np.asarray(value)
        if array.dtype.kind in "biuf":
            return array.astype(np.float64, copy=False)
        if array.dtype == object:
            return array.astype(np.float64)
        helps = _HELPS.get(array.dtype.kind, f"expected numbers, not {array.dtype}")
    except (TypeError, ValueError):
        helps = "expected numbers, all rows of one length"
    raise PbrdfError(f"{name} is {_described(value)}; {helps}")


# What turns arrays of other kinds of numpy into numbers.
_HELPS = {
    "c": "expected real numbers; take its .real, or its absolute values by numpy.abs",
    "U": "expected numbers, not text; numpy.asarray(..., dtype=float) reads text that is numbers",
    "S": "expected numbers, not text; numpy.asarray(..., dtype=float) reads text that is numbers",
    "m": "expected numbers, not times",
    "M": "expected numbers, not dates",
    "V": "expected numbers, not a table; take one of its columns",
}


def number(name: str, value: Any) -> float:
    """One number; NaN and infinity are left to the core, which names the domain."""
    array = numbers(name, value)
    if array.ndim != 0:
        raise PbrdfError(f"{name} has the shape {array.shape}; expected one number")
    return float(array)


def broadcast(**arrays: Any) -> tuple[list[np.ndarray], tuple[int, ...]]:
    """Arrays of one shape, flattened without gaps in memory, and that shape."""
    found = {name: numbers(name, value) for name, value in arrays.items()}
    try:
        shape = np.broadcast_shapes(*(array.shape for array in found.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in found.items())
        raise PbrdfError(f"the shapes do not broadcast: {shapes}; add an axis, as in theta_i[:, None]") from None
    return [np.ascontiguousarray(np.broadcast_to(array, shape)).reshape(-1) for array in found.values()], shape


def values(name: str, value: Any) -> list[tuple[str, float]]:
    """Values by the names of parameters."""
    return [(key, number(f"{name}[{key!r}]", item)) for key, item in items(name, value)]


@functools.cache
def _parameters_of(model: str) -> frozenset[str]:
    """The names of the parameters of a model; of all models where there is none of that name, which the core refuses."""
    tables = {key: frozenset(names) for key, _, _, names in _pbrdf.models()}
    return tables.get(model, frozenset(name for name, *_ in _pbrdf.parameters()))


def surface(model: str, value: Any) -> list[tuple[str, float]]:
    """Values of a surface by the names of parameters; warns of those that the model does not have."""
    found = values("parameters", value)
    known = _parameters_of(model)
    # Names that are none are refused by the core.
    strange = [name for name, _ in found if name not in known and name in _parameters_of("")]
    if strange:
        told = f"the model {model} has no {' and no '.join(strange)}; what is given for it changes nothing"
        warnings.warn(told, stacklevel=outside())
    return found


def outside() -> int:
    """How many calls up the package was called: there a warning helps."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__package__") == __package__:
        level, frame = level + 1, frame.f_back
    return level


def items(name: str, value: Any) -> list[tuple[str, Any]]:
    """The items of a mapping whose keys are names; None is an empty one."""
    if value is None:
        return []
    if not isinstance(value, Mapping):
        found = _as_mapping(value)
        if found is None:
            # As results of this package have it.
            helps = "; its values() returns them" if callable(getattr(value, "values", None)) else ""
            raise PbrdfError(f'{name} is {_described(value)}; expected values by name, such as {{"n": 2.0}}{helps}')
        value = found
    for key in value:
        if not isinstance(key, str):
            raise PbrdfError(f'{name} has the key {key!r}; expected names of parameters, such as "n"')
    return list(value.items())


def _as_mapping(value: Any) -> dict[Any, Any] | None:
    """What has keys as a dict has, such as a row of pandas."""
    if not (callable(getattr(value, "keys", None)) and hasattr(value, "__getitem__")):
        return None
    try:
        return dict(value)
    except (TypeError, ValueError, KeyError):
        return None


def names(name: str, value: Any) -> list[str]:
    """Names of parameters: a sequence of them, one, or none."""
    if value is None:
        return []
    found = [value] if isinstance(value, str) else list(value) if isinstance(value, Iterable) else None
    if found is None or not all(isinstance(item, str) for item in found):
        raise PbrdfError(f'{name} is {_described(value)}; expected names of parameters, such as ["n", "k"]')
    return found


def whole(name: str, value: Any, least: int) -> int:
    """A whole number from ``least`` on."""
    found = number(name, value)
    if not (math.isfinite(found) and found == int(found) and least <= found < 2**63):
        raise PbrdfError(f"{name} = {value!r}; expected a whole number from {least} on")
    return int(value)


def word(name: str, value: Any) -> str:
    """A word."""
    if not isinstance(value, str):
        raise PbrdfError(f"{name} is {_described(value)}; expected a name")
    return value


def pair(name: str, value: Any, expected: str) -> tuple[float, float]:
    """Two numbers."""
    found = numbers(name, value)
    if found.shape != (2,):
        raise PbrdfError(f"{name} is {_described(value)}; expected {expected}")
    return float(found[0]), float(found[1])


def _described(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"a {type(value).__name__}"
