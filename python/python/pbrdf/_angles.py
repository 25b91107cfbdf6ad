"""Values of a surface at angles."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _checks, _pbrdf
from ._tables import models

Array = NDArray[np.float64]


@dataclass(frozen=True, repr=False)
class Evaluation:
    """Values of a surface, each with the shape to which the angles broadcast (numbers where all angles are)."""

    brdf: Array
    """BRDF for unpolarised light, the element F00 of the Mueller matrix, in sr⁻¹."""
    dolp: Array
    """Degree of linear polarisation of the reflected light, 0 to 1."""
    specular: Array | None = None
    """Specular part of the BRDF, k_s F^s, in sr⁻¹; with ``terms=True``."""
    diffuse: Array | None = None
    """Diffuse part of the BRDF in sr⁻¹; with ``terms=True``."""
    volume: Array | None = None
    """Volume part of the BRDF in sr⁻¹; with ``terms=True``."""
    mueller: Array | None = None
    """Mueller matrices in sr⁻¹ between the meridian bases of the rays, the shape of the angles and (4, 4); with ``mueller=True``."""
    brdf_gradient: dict[str, Array] | None = None
    """∂BRDF/∂p by the name of the parameter, in sr⁻¹ per unit of it; with ``gradients``."""
    dolp_gradient: dict[str, Array] | None = None
    """∂DoLP/∂p by the name of the parameter, per unit of it; with ``gradients``."""

    def __repr__(self) -> str:
        there = [name for name, value in self.__dict__.items() if value is not None]
        return f"<pbrdf.Evaluation of shape {np.shape(self.brdf)}: {', '.join(there)}>"


class Geometries:
    """Angles that are prepared once and evaluated for many surfaces; made by :func:`prepare`."""

    def __init__(self, theta_i: ArrayLike, theta_r: ArrayLike, dphi: ArrayLike = 180.0) -> None:
        (rays_in, rays_out, azimuths), self._shape = _checks.broadcast(theta_i=theta_i, theta_r=theta_r, dphi=dphi)
        self._prepared = _pbrdf.Prepared(rays_in, rays_out, azimuths, self._shape)

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape to which the angles broadcast."""
        return self._shape

    def evaluate(
        self,
        model: str,
        parameters: Mapping[str, float],
        *,
        terms: bool = False,
        mueller: bool = False,
        gradients: bool | Iterable[str] = False,
    ) -> Evaluation:
        """Values of a surface at these angles, as :func:`evaluate` has them."""
        question, by = _question(model, parameters, terms, mueller, gradients)
        return _evaluation(self._prepared.evaluate(question), self._shape, terms, mueller, by)

    def __repr__(self) -> str:
        return f"<pbrdf.Geometries of shape {self._shape}>"


def prepare(theta_i: ArrayLike, theta_r: ArrayLike, dphi: ArrayLike = 180.0) -> Geometries:
    """Prepares angles that are evaluated for more than one surface.

    Takes the angles of :func:`evaluate` and refuses the same. It holds some 200 bytes for each point.

    >>> geometries = prepare(60, range(80))
    >>> geometries.evaluate("cauchy", {"n": 2.07}).brdf.shape
    (80,)
    """
    return Geometries(theta_i, theta_r, dphi)


def evaluate(
    model: str,
    parameters: Mapping[str, float],
    theta_i: ArrayLike,
    theta_r: ArrayLike,
    dphi: ArrayLike = 180.0,
    *,
    terms: bool = False,
    mueller: bool = False,
    gradients: bool | Iterable[str] = False,
) -> Evaluation:
    """BRDF and DoLP of a surface; angles broadcast against each other as numpy's do. All processors work, without the GIL.

    Args:
        model: The name of a model, such as ``"cauchy"``; :func:`models` lists them.
        parameters: Values by name, such as ``{"n": 2.07, "k": 2.9}``; :func:`parameters` lists names, units and the defaults that stand for
            those not given. Names that only other models have change nothing, and are warned of.
        theta_i: Zenith angles of incidence in degrees, 0 ≤ θi < 90.
        theta_r: Zenith angles of view in degrees, 0 ≤ θr < 90; or −90 < θr < 0 for the backscatter side where ``dphi`` is 180.
        dphi: Relative azimuths φr − φi in degrees; 180 is the forward side.
        terms: Whether to return the specular, the diffuse and the volume part of the BRDF as well.
        mueller: Whether to return Mueller matrices.
        gradients: Whether to return derivatives by all parameters of the model; or the names of those that are wanted.

    Returns:
        An :class:`Evaluation`.

    Raises:
        PbrdfError: A model or a parameter of that name is not known, a value lies outside its domain, an angle outside its range or is NaN, or
            the angles do not broadcast.

    >>> import numpy as np
    >>> values = evaluate("cauchy", {"n": 2.07}, np.array([[30.0], [60.0]]), np.arange(0.0, 80.0), gradients=["kd"])
    >>> values.brdf.shape, values.dolp_gradient["kd"].shape
    ((2, 80), (2, 80))
    """
    question, by = _question(model, parameters, terms, mueller, gradients)
    (rays_in, rays_out, azimuths), shape = _checks.broadcast(theta_i=theta_i, theta_r=theta_r, dphi=dphi)
    return _evaluation(_pbrdf.evaluate(question, rays_in, rays_out, azimuths, shape), shape, terms, mueller, by)


def _question(
    model: Any, parameters: Any, terms: Any, mueller: Any, gradients: Any
) -> tuple[SimpleNamespace, list[str]]:
    model = _checks.word("model", model)
    if gradients is True:
        found = models().get(model)
        by = [] if found is None else list(found.parameters)
    else:
        by = [] if gradients is False else _checks.names("gradients", gradients)
    order = [name for name, *_ in _pbrdf.parameters()]
    # In the order of the core; unknown names stay, for it to refuse.
    by = sorted(dict.fromkeys(by), key=lambda name: order.index(name) if name in order else len(order))
    values = _checks.surface(model, parameters)
    return SimpleNamespace(model=model, parameters=values, terms=bool(terms), mueller=bool(mueller), gradients=by), by


def _evaluation(numbers: Array, shape: tuple[int, ...], terms: Any, mueller: Any, by: list[str]) -> Evaluation:
    """Of columns that stand one behind the other."""
    begin = 0

    def column(of: tuple[int, ...] = shape) -> Any:
        nonlocal begin
        end = begin + math.prod(of)
        begin, values = end, numbers[begin:end]
        return values.reshape(of)[()]

    brdf, dolp = column(), column()
    specular, diffuse, volume = (column(), column(), column()) if terms else (None, None, None)
    matrices = column((*shape, 4, 4)) if mueller else None
    of_brdf, of_dolp = ({name: column() for name in by}, {name: column() for name in by}) if by else (None, None)
    return Evaluation(brdf, dolp, specular, diffuse, volume, matrices, of_brdf, of_dolp)
