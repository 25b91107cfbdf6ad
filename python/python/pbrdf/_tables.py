"""The tables of models and parameters."""

from __future__ import annotations

from typing import NamedTuple

from . import _pbrdf


class ModelInfo(NamedTuple):
    """A model."""

    name: str
    """What it is, in words."""
    citation: str
    """Where it comes from."""
    parameters: tuple[str, ...]
    """The names of its parameters."""


class ParameterInfo(NamedTuple):
    """A parameter."""

    name: str
    """What it is called in words."""
    unit: str
    """Its unit; empty for a pure number."""
    default: float
    """The value that stands where none is given."""
    range: tuple[float, float]
    """Bounds of a fit where none are given."""
    help: str
    """What it means and does."""


def models() -> dict[str, ModelInfo]:
    """All models by name, from the fewest terms to the most.

    >>> models()["specular"].parameters
    ('n', 'k', 'sigma', 'ks', 'q')
    """
    return {key: ModelInfo(name, citation, tuple(names)) for key, name, citation, names in _pbrdf.models()}


def parameters() -> dict[str, ParameterInfo]:
    """All parameters by name.

    >>> parameters()["n"].unit
    ''
    """
    return {row[0]: ParameterInfo(*row[1:]) for row in _pbrdf.parameters()}
