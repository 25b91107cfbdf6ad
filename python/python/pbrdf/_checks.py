"""Arguments turned into what the compiled part takes, or refused in one sentence."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from ._pbrdf import PbrdfError


def numbers(name: str, value: Any) -> np.ndarray:
    """An array of float64, of any shape."""
    try:
        array = np.asarray(value)
        if array.dtype.kind in "biuf":
            return array.astype(np.float64, copy=False)
        if array.dtype == object:
            return array.astype(np.float64)
    except (TypeError, ValueError):
        pass
    raise PbrdfError(f"{name} is {_described(value)}; expected numbers, all rows of one length")


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


def items(name: str, value: Any) -> list[tuple[str, Any]]:
    """The items of a mapping whose keys are names; None is an empty one."""
    if value is None:
        return []
    if not isinstance(value, Mapping):
        raise PbrdfError(f'{name} is {_described(value)}; expected values by name, such as {{"n": 2.0}}')
    for key in value:
        if not isinstance(key, str):
            raise PbrdfError(f'{name} has the key {key!r}; expected names of parameters, such as "n"')
    return list(value.items())


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
