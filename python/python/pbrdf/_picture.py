"""What a polarisation camera sees of a surface."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
from numpy.typing import NDArray

from . import _checks, _pbrdf
from ._pbrdf import PbrdfError

Array = NDArray[np.float64]


@dataclass(frozen=True, repr=False)
class Picture:
    """Stokes vectors and normals, row by row from the top; NaN where there is no surface. The camera looks along −z: x to the right, y up."""

    s0: Array
    """Radiance; for a lamp of irradiance 1 across its beam in sr⁻¹."""
    s1: Array
    """Radiance along x less that along y."""
    s2: Array
    """Radiance along the diagonal of x and y less that across it."""
    normals: Array
    """Unit normals (x, y, z), of shape (size, size, 3)."""

    @property
    def stokes(self) -> Array:
        """S0, S1 and S2, of shape (3, size, size), as :func:`fit_pixels` takes them."""
        return np.stack([self.s0, self.s1, self.s2])

    @property
    def dolp(self) -> Array:
        """Degree of linear polarisation; NaN without light."""
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.where(self.s0 > 0.0, np.hypot(self.s1, self.s2) / self.s0, np.nan)

    @property
    def aop(self) -> Array:
        """Angle of polarisation from x towards y, 0 to 180 degrees; NaN where nothing is polarised."""
        angle = np.degrees(0.5 * np.arctan2(self.s2, self.s1)) % 180.0
        return np.where(np.hypot(self.s1, self.s2) > 0.0, angle, np.nan)

    def through_analyser(self, angle: float) -> Array:
        """Radiance through an ideal analyser at that angle from x towards y, in degrees."""
        turn = 2.0 * np.radians(_checks.number("angle", angle))
        return 0.5 * (self.s0 + self.s1 * np.cos(turn) + self.s2 * np.sin(turn))

    def __repr__(self) -> str:
        return f"<pbrdf.Picture of {self.s0.shape[0]} × {self.s0.shape[1]} pixels>"


def picture(
    model: str,
    parameters: Mapping[str, float],
    *,
    shape: str = "sphere",
    lamp: tuple[float, float] | None = (30.0, 135.0),
    sky: float | None = None,
    size: int = 512,
) -> Picture:
    """What an orthographic polarisation camera sees of a surface. No cast shadows, no light from one part of the shape to another.

    Args:
        model: The name of a model; :func:`models` lists them.
        parameters: Values by name, as :func:`evaluate` has them.
        shape: ``"sphere"`` and ``"cylinder"`` (its axis along y) of radius 1, ``"plate"`` (tilted by 45° towards +x), or ``"relief"``; the
            picture spans −1 to 1.
        lamp: Direction of a distant, unpolarised lamp of irradiance 1: its angle from z, and its angle from x towards y, in degrees; or None.
        sky: Radiance of a uniform, unpolarised sky, or None.
        size: Pixels along an edge.

    Returns:
        A :class:`Picture`: what ``pbrdf-explorer picture`` writes.

    Raises:
        PbrdfError: A name is not known, a value lies outside its domain, or there is neither lamp nor sky.

    >>> seen = picture("cauchy", {"n": 2.07}, size=64)
    >>> seen.dolp.shape, bool(np.isnan(seen.s0[0, 0]))
    ((64, 64), True)
    """
    if lamp is None and sky is None:
        raise PbrdfError("lamp and sky are None: nothing is lit; give one of them")
    if sky is not None and not _checks.number("sky", sky) >= 0.0:
        raise PbrdfError(f"sky = {sky!r}; expected a radiance from 0 on")
    edge = _checks.whole("size", size, 1)
    if edge > 16384:
        raise PbrdfError(f"size = {size!r}; expected 1 to 16384 pixels")
    request = SimpleNamespace(
        model=_checks.word("model", model),
        parameters=_checks.surface(_checks.word("model", model), parameters),
        shape=_checks.word("shape", shape),
        lamp=None if lamp is None else _checks.pair("lamp", lamp, "(angle from z, angle from x) in degrees"),
        sky=None if sky is None else float(sky),
        size=edge,
    )
    s0, s1, s2, *normal = (column.reshape(edge, edge) for column in _pbrdf.picture(request))
    return Picture(s0, s1, s2, np.stack(normal, axis=-1))
