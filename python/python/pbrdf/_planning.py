"""Measurements simulated, and angles chosen."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _checks, _html, _pbrdf
from ._measurement import Measurement
from ._pbrdf import PbrdfError


def simulate(
    model: str,
    parameters: Mapping[str, float],
    theta_i: ArrayLike,
    theta_r: ArrayLike,
    dphi: float = 180.0,
    *,
    columns: str = "dolp",
    noise: float = 0.005,
    brdf_noise: float = 0.02,
    seed: int = 1,
) -> Measurement:
    """A measurement of a surface at every ``theta_r`` for every ``theta_i``, with Gaussian noise; the same seed gives the same numbers everywhere.

    Args:
        model: The name of a model.
        parameters: Values by name, as :func:`evaluate` takes them.
        theta_i: Zenith angles of incidence in degrees.
        theta_r: Zenith angles of view in degrees; negative is the backscatter side.
        dphi: Relative azimuth in degrees.
        columns: ``"dolp"``, ``"brdf"`` or ``"both"``.
        noise: Standard deviation of DoLP.
        brdf_noise: Standard deviation of the BRDF, relative to its value.
        seed: Seed of the noise.

    Raises:
        PbrdfError: As :func:`evaluate`; noise below 0.

    >>> len(simulate("cauchy", {"n": 2.07}, [30, 50], range(0, 80, 10)))
    16
    """
    scene = SimpleNamespace(
        model=_checks.word("model", model),
        parameters=_checks.surface(_checks.word("model", model), parameters),
        theta_i=_checks.numbers("theta_i", theta_i).ravel().tolist(),
        theta_r=_checks.numbers("theta_r", theta_r).ravel().tolist(),
        dphi=_checks.number("dphi", dphi),
        columns=_checks.word("columns", columns),
        noise=_checks.number("noise", noise),
        brdf_noise=_checks.number("brdf_noise", brdf_noise),
        seed=_checks.whole("seed", seed, 0),
    )
    return Measurement._of(_pbrdf.simulate(scene))


@dataclass(frozen=True, eq=False, repr=False)
class AngleChoice:
    """Angles to measure at, and what they promise."""

    theta_i: NDArray[np.float64]
    """Zenith angles of incidence in degrees, one a pair of directions."""
    theta_r: NDArray[np.float64]
    """Zenith angles of view in degrees; negative is the backscatter side."""
    dphi: NDArray[np.float64]
    """Relative azimuths in degrees."""
    repeats: NDArray[np.int64]
    """How often to measure there."""
    efficiency: float
    """How much of what all candidates tell these readings tell, 0 to 1."""
    value: float
    """The criterion: ln det of the information, or the sum of relative variances."""
    std_error: dict[str, float | None]
    """Predicted standard errors of the free parameters, of the first surface; None where they stay open."""
    undetermined: list[str]
    """What stays open, a sentence each."""

    def __repr__(self) -> str:
        return f"<pbrdf.AngleChoice: {int(self.repeats.sum())} readings in {len(self.repeats)} pairs of directions, {self._told()}>"

    def _told(self) -> str:
        return f"{100.0 * self.efficiency:.0f} % of what all candidates tell"

    def _repr_html_(self) -> str:
        rows = list(zip(self.theta_i, self.theta_r, self.dphi, self.repeats))
        errors = [f"{name}: standard error {'open' if error is None else f'{error:.2g}'}" for name, error in self.std_error.items()]
        head = f"{int(self.repeats.sum())} readings: {self._told()}"
        return _html.page(head, ["θi / °", "θr / °", "Δφ / °", "times"], rows, [*errors, *self.undetermined])


def choose_angles(
    model: str,
    parameters: Mapping[str, float] | Iterable[Mapping[str, float]],
    theta_i: ArrayLike,
    theta_r: ArrayLike,
    dphi: ArrayLike = 180.0,
    *,
    count: int,
    noise: float | None = 0.005,
    brdf_noise: float | None = None,
    fix: str | Iterable[str] | None = None,
    free: str | Iterable[str] | None = None,
    wanted: str | Iterable[str] | None = None,
    repeats: bool = False,
    given: Measurement | None = None,
    progress: Callable[[float], object] | None = None,
) -> AngleChoice:
    """The angles of a grid whose readings determine a surface best. Ctrl-C stops it.

    Args:
        model: The name of a model.
        parameters: Supposed values by name; or several such surfaces, over which the criterion is averaged.
        theta_i: Angles of incidence that could be measured, in degrees.
        theta_r: Angles of view that could be measured, in degrees.
        dphi: Relative azimuths that could be measured, in degrees.
        count: How many readings.
        noise: Standard deviation of DoLP; None where it is not measured.
        brdf_noise: Standard deviation of the BRDF relative to its value; None where it is not measured.
        fix: Parameters that are known.
        free: Parameters to free that are not free by default.
        wanted: The parameters whose errors are to be small; without, all that are free.
        repeats: Whether a pair of directions may be measured more than once.
        given: What is measured already.
        progress: Called with the share that is done, 0 to 1.

    Raises:
        PbrdfError: No choice determines what is asked for, or an argument does not fit.

    >>> chosen = choose_angles("specular", {"n": 2.07, "k": 2.9}, range(10, 90, 10), range(0, 80, 10), count=6)
    >>> int(chosen.repeats.sum()), chosen.undetermined
    (6, [])
    """
    surfaces = [parameters] if isinstance(parameters, Mapping) else list(parameters) if isinstance(parameters, Iterable) else None
    if surfaces is None:
        raise PbrdfError('parameters: expected values by name, such as {"n": 2.0}, or a list of such')
    if given is not None and not isinstance(given, Measurement):
        raise PbrdfError("given: expected a Measurement")
    if progress is not None and not callable(progress):
        raise PbrdfError("progress: expected a function of the share that is done")
    request = SimpleNamespace(
        model=_checks.word("model", model),
        surfaces=[_checks.surface(_checks.word("model", model), surface) for surface in surfaces],
        theta_i=_checks.numbers("theta_i", theta_i).ravel().tolist(),
        theta_r=_checks.numbers("theta_r", theta_r).ravel().tolist(),
        dphi=_checks.numbers("dphi", dphi).ravel().tolist(),
        count=_checks.whole("count", count, 1),
        repeats=bool(repeats),
        noise=None if noise is None else _checks.number("noise", noise),
        brdf_noise=None if brdf_noise is None else _checks.number("brdf_noise", brdf_noise),
        fix=_checks.names("fix", fix),
        free=_checks.names("free", free),
        wanted=_checks.names("wanted", wanted),
        given=None if given is None else given._inner,
    )
    angles, value, efficiency, errors, undetermined = _pbrdf.choose_angles(request, progress)
    rays_in, rays_out, azimuths = np.array([directions for directions, _ in angles], dtype=np.float64).reshape(-1, 3).T
    counts = np.array([times for _, times in angles], dtype=np.int64)
    return AngleChoice(rays_in, rays_out, azimuths, counts, efficiency, value, dict(errors), undetermined)
