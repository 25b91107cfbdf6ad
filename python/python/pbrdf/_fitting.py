"""Fits, and what they say."""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _checks, _html, _pbrdf
from ._angles import Evaluation, evaluate
from ._measurement import Measurement
from ._pbrdf import PbrdfError

Interval = tuple["float | None", "float | None"]


@dataclass(frozen=True)
class Estimate:
    """A parameter after a fit. As text it is rounded by its uncertainty: ``2.071 ± 0.021``, ``> 1.2 (68 %)``, ``not determined``."""

    name: str
    """Its name: ``"n"``, or ``"n@B.csv"`` where a measurement has it for itself."""
    value: float
    """Its value, in its own unit."""
    free: bool
    """Whether the fit could change it."""
    std_error: float | None
    """Its standard error, in its own unit; None where the data do not determine it and on a bound."""
    at_bound: str | None
    """``"lower"`` or ``"upper"`` where it rests on a bound."""
    interval68: Interval | None
    """Ends of its interval at 68.3 %, None on an open side; None where it is fixed or intervals were not asked for."""
    interval95: Interval | None
    """The same at 95 %."""
    determined: bool
    """Whether the data determine it."""
    text: str
    """The value as far as the data determine it, in words."""

    def __str__(self) -> str:
        return self.text

    def __float__(self) -> float:
        """Its value: all parameters of a result can be evaluated, or started from, as they are."""
        return self.value


class _Estimates(dict[str, Estimate]):
    """Parameters by name; what is missing is said."""

    def __missing__(self, name: str) -> Estimate:
        own = [key for key in self if key.partition("@")[0] == name and "@" in key]
        if own:
            raise KeyError(f"each measurement has its own {name}: ask for {' or '.join(map(repr, own))}, or for sets[0].parameters[{name!r}]")
        raise KeyError(f"there is no parameter {name!r}; there are {', '.join(self)}")


@dataclass(frozen=True)
class Correlations:
    """Correlations of the parameters that the data determine."""

    names: tuple[str, ...]
    """Their names, in the order of rows and columns."""
    matrix: NDArray[np.float64]
    """Correlation coefficients, −1 to 1, a row and a column for each name."""


@dataclass(frozen=True)
class Minimum:
    """A minimum that starts of a fit ended in."""

    objective: float | None
    """ΔE there."""
    stop_reason: str
    """Why the best start ended there."""
    reached: int
    """How many starts ended there."""


@dataclass(frozen=True)
class SetResult:
    """One measurement of a fit of several."""

    name: str
    """What it is called."""
    objective: float | None
    """ΔE by its own measured values."""
    sum_of_squares: float
    """Its share in the residual sum of squares."""
    parameters: dict[str, Estimate]
    """All its parameters by name, those that all share among them."""


class _Finished:
    """What is left of a fit in another process: all that it says, without its problem."""

    def __init__(self, inner: _pbrdf.Fitted | _Finished) -> None:
        self._said = {name: getattr(inner, name)() for name in ("json", "estimates", "open", "ending", "surfaces")}

    def json(self) -> str:
        return str(self._said["json"])

    def estimates(self) -> list[tuple[str, str]]:
        return list(self._said["estimates"])

    def open(self) -> list[str]:
        return list(self._said["open"])

    def ending(self) -> str:
        return str(self._said["ending"])

    def surfaces(self) -> list[list[tuple[str, float]]]:
        return list(self._said["surfaces"])


class FitResult:
    """What a fit found, and what the data leave undetermined. It can be pickled, and so come from other processes."""

    def __init__(
        self, inner: _pbrdf.Fitted | _Finished, data: Sequence[Measurement] = (), settings: SimpleNamespace | None = None
    ) -> None:
        self._inner = inner
        self._data = list(data)
        self._settings = settings
        self._document: dict[str, Any] = json.loads(inner.json())
        texts = dict(inner.estimates())
        document = self._document

        def estimates(of: Mapping[str, Any], suffix: str = "") -> dict[str, Estimate]:
            return {name: _estimate(f"{name}{suffix}", fields, texts) for name, fields in of.items()}

        shared = estimates(document["parameters"])
        sets = [(item, estimates(item["parameters"], f"@{item['set']}")) for item in document.get("sets", [])]
        self._parameters = _Estimates(shared)
        for _, own in sets:
            self._parameters.update({estimate.name: estimate for estimate in own.values()})
        self._sets = [
            SetResult(item["set"], item["objective"], item["sum_of_squares"], _Estimates({**shared, **own})) for item, own in sets
        ]

    def __reduce__(self) -> tuple[Any, ...]:
        return FitResult, (_Finished(self._inner), self._data, self._settings)

    def _fitted(self) -> _pbrdf.Fitted:
        """The fit with its problem; where it comes from another process, it is made again, which gives the same."""
        if isinstance(self._inner, _pbrdf.Fitted):
            return self._inner
        if self._settings is None:
            raise PbrdfError("result comes from another process and lacks its pixels; fit and draw in one process")
        return _pbrdf.fit([item._inner for item in self._data], self._settings, None)

    @property
    def parameters(self) -> dict[str, Estimate]:
        """The parameters of the model by name; those that each measurement has for itself as ``"n@B.csv"``."""
        return self._parameters

    @property
    def sets(self) -> list[SetResult]:
        """The measurements of a fit of several, in their order; empty after a fit of one."""
        return self._sets

    @property
    def model(self) -> str:
        """The name of the model."""
        return self._document["model"]

    @property
    def objective(self) -> float | None:
        """ΔE of Eq. (18) of Wang et al. (2021): Σ (X − Xm)²/Σ Xm², of DoLP if measured, else of BRDF; with both, the sum. None
        where all measured values are 0."""
        return self._document["objective"]

    @property
    def sum_of_squares(self) -> float:
        """Residual sum of squares."""
        return self._document["sum_of_squares"]

    @property
    def chi2(self) -> float | None:
        """χ², with ``weights="sigma"``."""
        return self._document["chi2"]

    @property
    def dof(self) -> int:
        """Degrees of freedom: residuals less the directions that the data determine."""
        return self._document["dof"]

    @property
    def aicc(self) -> float | None:
        """Akaike's corrected criterion, for models of the same data; None where there are too few data."""
        return self._document["aicc"]

    @property
    def stop_reason(self) -> str:
        """Why the fit ended, as one word such as ``"converged"`` or ``"underdetermined"``."""
        return self._document["stop_reason"]

    @property
    def evaluations(self) -> int:
        """Residual evaluations of all starts."""
        return self._document["evaluations"]

    @property
    def undetermined(self) -> list[str]:
        """What the data leave open, a sentence each; empty where they determine everything."""
        return self._inner.open()

    @property
    def correlations(self) -> Correlations:
        """Correlations of the parameters that the data determine."""
        found = self._document["correlations"]
        size = len(found["names"])
        return Correlations(tuple(found["names"]), np.array(found["matrix"], dtype=np.float64).reshape(size, size))

    @property
    def minima(self) -> list[Minimum]:
        """The minima that starts ended in, best first."""
        return [Minimum(**fields) for fields in self._document["starts"]]

    def values(self, set: int = 0) -> dict[str, float]:
        """Values of all parameters of the model by name, as :func:`evaluate` takes them; ``set`` counts the measurements of a fit of several."""
        surfaces = self._inner.surfaces()
        if not 0 <= set < len(surfaces):
            raise PbrdfError(f"set = {set!r}; expected 0 to {len(surfaces) - 1}")
        return dict(surfaces[set])

    def evaluate(self, theta_i: ArrayLike, theta_r: ArrayLike, dphi: ArrayLike = 180.0, *, set: int = 0, **wanted: Any) -> Evaluation:
        """The fitted surface at angles, as :func:`evaluate` has it; ``set`` counts the measurements of a fit of several."""
        return evaluate(self.model, self.values(set), theta_i, theta_r, dphi, **wanted)

    def plot(self, quantity: str | None = None, *, set: int = 0, ax: Any = None) -> Any:
        """Draws what was measured in the plane of incidence and the fitted curves over the angle of view, a colour for each angle of incidence.
        Needs matplotlib.

        Args:
            quantity: ``"dolp"`` or ``"brdf"``; without, DoLP if it was measured.
            set: Which measurement of a fit of several, counted from 0.
            ax: Axes of matplotlib to draw on; without, the current ones.

        Returns:
            The axes.

        Raises:
            PbrdfError: The quantity was not measured in the plane of incidence.
        """
        import matplotlib.pyplot as plt  # type: ignore[import-not-found, unused-ignore]

        self.values(set)
        if not self._data:
            raise PbrdfError("a fit of pixels has no curves; its residuals are maps, such as s0_residuals of the PixelFit")
        data = self._data[set]
        quantity = ("brdf" if np.isnan(data.dolp).all() else "dolp") if quantity is None else _checks.word("quantity", quantity)
        if quantity not in ("dolp", "brdf"):
            raise PbrdfError(f'quantity = {quantity!r}; expected "dolp" or "brdf"')
        measured: NDArray[np.float64] = getattr(data, quantity)
        backward = np.isin(data.dphi, (0.0, 360.0))
        in_plane = (backward | (data.dphi == 180.0)) & ~np.isnan(measured)
        if not in_plane.any():
            raise PbrdfError(f"no {quantity} was measured in the plane of incidence (dphi 0 or 180)")
        axes = plt.gca() if ax is None else ax
        signed = np.where(backward, -data.theta_r, data.theta_r)
        for number, theta_i in enumerate(np.unique(data.theta_i[in_plane])):
            colour, rows = f"C{number % 10}", in_plane & (data.theta_i == theta_i)
            for chosen, filled in ((rows & ~data.masked, colour), (rows & data.masked, "none")):
                axes.plot(signed[chosen], measured[chosen], "o", color=colour, markerfacecolor=filled, markersize=4)
            angles = np.linspace(signed[rows].min(), signed[rows].max(), 200)
            curve = getattr(self.evaluate(theta_i, angles, set=set), quantity)
            axes.plot(angles, curve, color=colour, label=f"θi = {theta_i:g}°")
        axes.set_xlabel("θr (degrees)")
        axes.set_ylabel("DoLP" if quantity == "dolp" else "BRDF (1/sr)")
        axes.legend()
        return axes

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain lists and dicts: what the command ``pbrdf-explorer fit --json`` prints, but for its files."""
        return json.loads(self._inner.json())

    def __str__(self) -> str:
        width = max(map(len, self.parameters), default=0)
        lines = [f"{self.model}: {self._inner.ending()}, ΔE = {_short(self.objective)}"]
        lines += [f"  {name:<{width}} = {estimate}" for name, estimate in self.parameters.items()]
        return "\n".join(lines + [f"  {sentence}" for sentence in self.undetermined])

    def __repr__(self) -> str:
        return f"<pbrdf.FitResult\n{self}\n>"

    def _repr_html_(self) -> str:
        head = f"{self.model}: {self._inner.ending()}, ΔE = {_short(self.objective)}"
        if not self.sets:
            rows = [(name, estimate.text, ends_text(estimate.interval95)) for name, estimate in self.parameters.items()]
            return _html.page(head, ["parameter", "value", "95 %"], rows, self.undetermined)
        # A column for each measurement: what they share stands in the first one.
        shared = [(name, estimate.text, *("" for _ in self.sets)) for name, estimate in self.parameters.items() if "@" not in name]
        names = dict.fromkeys(name.partition("@")[0] for name in self.parameters if "@" in name)
        own = [(name, "", *(one.parameters[name].text for one in self.sets)) for name in names]
        ends = ("ΔE", _short(self.objective), *(_short(one.objective) for one in self.sets))
        return _html.page(head, ["parameter", "shared", *(one.name for one in self.sets)], [*shared, *own, ends], self.undetermined)


def _estimate(name: str, fields: Mapping[str, Any], texts: Mapping[str, str]) -> Estimate:
    def ends(interval: Sequence[float | None] | None) -> Interval | None:
        return None if interval is None else (interval[0], interval[1])

    return Estimate(
        name=name,
        value=fields["value"],
        free=fields["free"],
        std_error=fields["std_error"],
        at_bound=fields["at_bound"],
        interval68=ends(fields["interval68"]),
        interval95=ends(fields["interval95"]),
        determined=fields["determined"],
        text=texts[name],
    )


def _short(number: float | None) -> str:
    return "none" if number is None else f"{number:.4g}"


def ends_text(interval: Interval | None) -> str:
    """The ends of an interval, nothing on an open side."""
    if interval is None:
        return ""
    low, high = interval
    return f"{'' if low is None else f'{low:.4g}'} … {'' if high is None else f'{high:.4g}'}"


def fit(
    data: Measurement | Sequence[Measurement],
    model: str = "cauchy",
    *,
    own: str | Iterable[str] | None = None,
    fix: Mapping[str, float | None] | Iterable[str] | None = None,
    free: str | Iterable[str] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    start: Mapping[str, float] | None = None,
    tie: Mapping[str, tuple[float, str]] | None = None,
    theta_i_range: tuple[float, float] | None = None,
    theta_r_range: tuple[float, float] | None = None,
    starts: int | None = None,
    seed: int = 1,
    intervals: str = "profile",
    weights: str = "none",
    loss: str = "squared",
    loss_scale: float | None = None,
    brdf_residuals: str = "relative",
    progress: Callable[[float, int, float], object] | None = None,
) -> FitResult:
    """Fits a model by least squares in a box, and says what the data determine. Ctrl-C stops it (``KeyboardInterrupt``).

    Args:
        data: A measurement, or several that are fitted together.
        model: The name of a model; :func:`models` lists them.
        own: Parameters that each of several measurements has for itself; the others are shared. ``"all"`` means each.
        fix: Values at which parameters are held, by name; with the value None, or as a list of names, at their starts.
        free: Parameters to free that are not free by default.
        bounds: ``(low, high)`` by name; without, the range of :func:`parameters`.
        start: Values to start from, by name.
        tie: Parameters that are another one times a factor: ``{"kv": (2.0, "kd")}`` is kv = 2 kd.
        theta_i_range: Angles of incidence that are fitted, ``(low, high)`` in degrees, both included; without, all.
        theta_r_range: Angles of view that are fitted, negative on the backscatter side; without, all.
        starts: How many starts; None searches until nothing new is found.
        seed: Shifts the points that starts are spread over. The same seed gives the same result.
        intervals: ``"profile"`` (likelihood), ``"linear"`` (standard errors alone, much faster) or ``"none"``.
        weights: ``"none"``, or ``"sigma"`` for the standard deviations of the measurement.
        loss: ``"squared"``, ``"huber"`` or ``"soft-l1"``.
        loss_scale: Scale of a robust loss in the unit of the residual; without, from the residuals.
        brdf_residuals: ``"relative"``, ``"absolute"`` or ``"log"``.
        progress: Called at each improvement with milliseconds, evaluations, and ΔE.

    A name in ``fix``, ``free``, ``bounds`` and ``start`` can carry that of a measurement: ``"n@B.csv"``.

    Returns:
        A :class:`FitResult`: equal to what ``pbrdf-explorer fit`` finds with the same options.

    Raises:
        PbrdfError: A name is not known or not of the model, a value or a bound does not fit, or the data do not.

    >>> data = Measurement([30, 40, 50, 60, 60, 70], [40, 40, 50, 60, 70, 70], dolp=[.127, .166, .268, .398, .466, .525])
    >>> result = fit(data, model="specular", fix={"ks": 1.0}, start={"k": 3.0}, starts=1)
    >>> round(result.parameters["n"].value, 2), result.undetermined
    (2.08, [])
    """
    measurements = [data] if isinstance(data, Measurement) else list(data) if isinstance(data, Iterable) else None
    if measurements is None or not all(isinstance(item, Measurement) for item in measurements):
        raise PbrdfError("data: expected a Measurement or a list of them; read(path) and Measurement(...) make one")
    if not measurements:
        raise PbrdfError("data: the list is empty; expected at least one Measurement")
    if progress is not None and not callable(progress):
        raise PbrdfError("progress: expected a function of milliseconds, evaluations, and ΔE")
    settings = fit_settings(
        model,
        own=own,
        fix=fix,
        free=free,
        bounds=bounds,
        start=start,
        tie=tie,
        theta_i_range=theta_i_range,
        theta_r_range=theta_r_range,
        starts=starts,
        seed=seed,
        intervals=intervals,
        weights=weights,
        loss=loss,
        loss_scale=loss_scale,
        brdf_residuals=brdf_residuals,
    )
    _check_range(settings, measurements)
    return FitResult(_pbrdf.fit([item._inner for item in measurements], settings, progress), measurements, settings)


def _check_range(settings: SimpleNamespace, measurements: Sequence[Measurement]) -> None:
    """Refuses a range of angles that no row lies in, and warns where one of several measurements has none."""
    if settings.range is None:
        return
    empty = [one for one in measurements if not one.masked.all() and not _in_range(settings, one).any()]
    if not empty:
        return
    (low, high), (view_low, view_high) = settings.range
    signed, first = _signed(empty[0]), empty[0]
    told = (
        f"no row lies in the range that is fitted, θi {low:g}° to {high:g}° and θr {view_low:g}° to {view_high:g}°; "
        f"the rows have θi {first.theta_i.min():g}° to {first.theta_i.max():g}° and θr {signed.min():g}° to {signed.max():g}°"
    )
    if len(empty) == len(measurements):
        raise PbrdfError(told)
    warnings.warn(f"{', '.join(one.name or 'a measurement' for one in empty)}: {told}", stacklevel=_checks.outside())


def _signed(data: Measurement) -> NDArray[np.float64]:
    """θr as ranges have it: negative on the side of the source."""
    azimuth = data.dphi % 360.0
    return np.where((azimuth > 90.0) & (azimuth <= 270.0), data.theta_r, -data.theta_r)


def _in_range(settings: SimpleNamespace, data: Measurement) -> NDArray[np.bool_]:
    """The rows that a fit with these settings uses."""
    used = ~data.masked
    if settings.range is not None:
        (low, high), (view_low, view_high) = settings.range
        signed = _signed(data)
        used = used & (data.theta_i >= low) & (data.theta_i <= high) & (signed >= view_low) & (signed <= view_high)
    return used


def fit_settings(
    model: Any,
    *,
    own: Any = None,
    fix: Any = None,
    free: Any = None,
    bounds: Any = None,
    start: Any = None,
    tie: Any = None,
    theta_i_range: Any = None,
    theta_r_range: Any = None,
    starts: Any = None,
    seed: Any = 1,
    intervals: Any = "profile",
    weights: Any = "none",
    loss: Any = "squared",
    loss_scale: Any = None,
    brdf_residuals: Any = "relative",
) -> SimpleNamespace:
    """The options of :func:`fit` as the compiled part takes them."""
    model = _checks.word("model", model)
    everything = [name for key, _, _, names in _pbrdf.models() if key == model for name in names]
    held = _checks.items("fix", fix) if fix is None or isinstance(fix, Mapping) else [(name, None) for name in _checks.names("fix", fix)]
    return SimpleNamespace(
        model=model,
        own=everything if own == "all" else _checks.names("own", own),
        fix=[(name, None if value is None else _checks.number(f"fix[{name!r}]", value)) for name, value in held],
        free=_checks.names("free", free),
        bounds=[(name, _bounds(name, value)) for name, value in _checks.items("bounds", bounds)],
        start=_checks.values("start", start),
        tie=[(name, *_tie(name, value)) for name, value in _checks.items("tie", tie)],
        range=None
        if theta_i_range is None and theta_r_range is None
        else [_range("theta_i_range", theta_i_range, (0.0, 90.0)), _range("theta_r_range", theta_r_range, (-90.0, 90.0))],
        starts=None if starts is None else _checks.whole("starts", starts, 1),
        seed=_checks.whole("seed", seed, 0),
        intervals=_checks.word("intervals", intervals),
        weights=_checks.word("weights", weights),
        loss=_checks.word("loss", loss),
        loss_scale=None if loss_scale is None else _checks.number("loss_scale", loss_scale),
        brdf_residuals=_checks.word("brdf_residuals", brdf_residuals),
    )


def _bounds(name: str, value: Any) -> tuple[float, float]:
    ends = _checks.numbers(f"bounds[{name!r}]", value)
    if ends.shape != (2,):
        raise PbrdfError(f"bounds[{name!r}] is {value!r}; expected (low, high)")
    return float(ends[0]), float(ends[1])


def _tie(name: str, value: Any) -> tuple[float, str]:
    if not (isinstance(value, (tuple, list)) and len(value) == 2 and isinstance(value[1], str)):
        raise PbrdfError(f'tie[{name!r}] is {value!r}; expected a factor and a name, such as (2.0, "kd")')
    return _checks.number(f"tie[{name!r}]", value[0]), value[1]


def _range(name: str, value: Any, whole: tuple[float, float]) -> list[float]:
    if value is None:
        return list(whole)
    ends = _checks.numbers(name, value)
    if ends.shape != (2,) or not ends[0] <= ends[1]:
        raise PbrdfError(f"{name} is {value!r}; expected (low, high) in degrees")
    return [float(end) for end in ends]
