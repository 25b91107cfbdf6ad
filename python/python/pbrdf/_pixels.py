"""A surface fitted to a camera's pixels: bodies of known shape, under one lamp or several."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _checks, _html, _pbrdf
from ._fitting import Estimate, FitResult, ends_text, fit_settings
from ._pbrdf import PbrdfError

Array = NDArray[np.float64]

# Two-sided quantiles of the normal distribution at 68.3 % and 95 %: with thousands of pixels Student's are the same.
_QUANTILES = (1.0, 1.959964)
# A pixel is of the body where it is brighter than this share of the median of the bright ones.
_FOREGROUND = 0.1
# Upper bound of a weight where the scale is not known, in medians of S0: a polished surface has a lobe so much brighter than the rest.
_BRIGHTEST = 1000.0
# Degrees within which lamps count as standing at one angle from the camera.
_SAME_ANGLE = 0.5


@dataclass(frozen=True)
class Body:
    """Where a body is in a picture, and which way its surface faces. The camera looks along −z: x to the right, y up."""

    normals: Array
    """Unit normals (x, y, z), of shape (rows, columns, 3); NaN beside the body."""
    center: tuple[float, float]
    """Row and column of its middle, in pixels from the middle of the first one; for a cylinder of a point of its axis."""
    radius: float
    """In pixels."""
    tilt: float = 0.0
    """Of a cylinder's axis from the columns of the picture towards −x, in degrees."""

    @property
    def mask(self) -> NDArray[np.bool_]:
        """The pixels that show the body."""
        return ~np.isnan(self.normals[..., 2])


def sphere(image: ArrayLike | tuple[int, int], center: tuple[float, float] | None = None, radius: float | None = None) -> Body:
    """A sphere in a picture: its outline is found, or given.

    Args:
        image: A picture of it before something dark, such as the largest S0 of several lamps; or, with ``center`` and ``radius``, the number
            of rows and columns.
        center: Row and column of its middle, in pixels from the middle of the first one.
        radius: In pixels.

    Raises:
        PbrdfError: No circle fits the outline, or only one of ``center`` and ``radius`` is given.

    >>> from pbrdf import picture
    >>> seen = picture("cauchy", {"kd": 0.3}, sky=1.0, lamp=None, size=200)
    >>> body = sphere(np.nan_to_num(seen.s0))
    >>> abs(body.radius - 100) < 0.2, abs(body.center[0] - 99.5) < 0.2
    (True, True)
    """
    if (center is None) != (radius is None):
        raise PbrdfError("center and radius belong together: give both, or neither")
    shape, bright = _picture_or_shape(image, center is not None and radius is not None)
    if center is None or radius is None:
        center, radius = _circle(_outline(bright))
    row, column = _checks.pair("center", center, "(row, column)")
    size = _checks.number("radius", radius)
    if not size > 0.0:
        raise PbrdfError(f"radius = {radius!r}; expected pixels above 0")
    rows, columns = np.mgrid[0 : shape[0], 0 : shape[1]]
    x, y = (columns - column) / size, (row - rows) / size
    return Body(_upright(x, y), (row, column), size)


def cylinder(
    image: ArrayLike | tuple[int, int],
    center: tuple[float, float] | None = None,
    radius: float | None = None,
    *,
    tilt: float = 0.0,
) -> Body:
    """A cylinder whose axis runs about along the columns of a picture, across the line of sight: its two edges are found, or given. Pass a
    picture of one that lies across the columns turned by ``numpy.rot90``, with the lamps turned along.

    Args:
        image: As :func:`sphere` has it; both edges must be lit.
        center: Row and column of a point on its axis.
        radius: In pixels.
        tilt: Of its axis from the columns towards −x, in degrees, where ``center`` is given.

    Raises:
        PbrdfError: As :func:`sphere` has it.
    """
    if (center is None) != (radius is None):
        raise PbrdfError("center and radius belong together: give both, or neither")
    shape, bright = _picture_or_shape(image, center is not None and radius is not None)
    if center is None or radius is None:
        center, radius, tilt = _edges(bright)
    row, column = _checks.pair("center", center, "(row, column)")
    size, turn = _checks.number("radius", radius), np.radians(_checks.number("tilt", tilt))
    if not size > 0.0:
        raise PbrdfError(f"radius = {radius!r}; expected pixels above 0")
    rows, columns = np.mgrid[0 : shape[0], 0 : shape[1]]
    # Across the axis, which is (−sin, cos).
    across = ((columns - column) * np.cos(turn) + (row - rows) * np.sin(turn)) / size
    return Body(_upright(across * np.cos(turn), across * np.sin(turn)), (row, column), size, float(np.degrees(turn)))


def _upright(x: Array, y: Array) -> Array:
    with np.errstate(invalid="ignore"):
        z = np.sqrt(1.0 - x * x - y * y)
    beside = np.isnan(z) | (z == 0.0)
    normals = np.stack([x, y, z], axis=-1)
    normals[beside] = np.nan
    return normals


def _picture_or_shape(image: Any, known: bool) -> tuple[tuple[int, int], Array]:
    array = _checks.numbers("image", image)
    if known and array.shape == (2,):
        rows, columns = (_checks.whole("image", size, 1) for size in array)
        return (rows, columns), array
    if array.ndim != 2:
        raise PbrdfError(f"image has the shape {array.shape}; expected rows and columns of brightness, such as S0")
    return (array.shape[0], array.shape[1]), array


def _foreground(image: Array) -> NDArray[np.bool_]:
    bright = np.nan_to_num(image, nan=0.0, posinf=0.0, neginf=0.0)
    lit = bright[bright > bright.max(initial=0.0) * 1e-3]
    if lit.size < 100:
        raise PbrdfError("image shows nothing bright before something dark; give center and radius")
    return bright > _FOREGROUND * np.median(lit)


def _outline(image: Array) -> Array:
    """Points (row, column) of the edge of what is bright. The first and last bright pixel of a row stand half a pixel within the edge, on the
    mean; they are taken where the edge is steep, those of columns where it is flat."""
    bright = _foreground(image)
    points = []
    for turned, table in ((False, bright), (True, bright.T)):
        has = np.flatnonzero(table.any(axis=1))
        first = table[has].argmax(axis=1) - 0.5
        last = table.shape[1] - 1 - table[has][:, ::-1].argmax(axis=1) + 0.5
        for edge in (first, last):
            slope = np.abs(np.gradient(edge)) if len(edge) > 1 else np.zeros(len(edge))
            steep = slope <= 1.0
            pair = np.stack([has[steep], edge[steep]], axis=1)
            points.append(pair[:, ::-1] if turned else pair)
    return np.concatenate(points).astype(np.float64)


def _circle(points: Array) -> tuple[tuple[float, float], float]:
    """The circle that most of the outline lies on: the edge of a shadow lies within it."""
    if len(points) < 12:
        raise PbrdfError("image shows no outline; give center and radius")
    random = np.random.default_rng(1)
    best: tuple[int, NDArray[np.bool_] | None] = (0, None)
    for _ in range(400):
        found = _through(points[random.choice(len(points), 3, replace=False)])
        if found is None:
            continue
        near = np.abs(np.hypot(*(points - found[:2]).T) - found[2]) < 1.0
        if near.sum() > best[0]:
            best = (int(near.sum()), near)
    near = best[1]
    if near is None or best[0] < 12:
        raise PbrdfError("no circle fits the outline of what is bright; give center and radius")
    for _ in range(4):
        row, column, size = _through(points[near]) or (np.nan,) * 3
        near = np.abs(np.hypot(points[:, 0] - row, points[:, 1] - column) - size) < 1.0
        if near.sum() < 12:
            raise PbrdfError("no circle fits the outline of what is bright; give center and radius")
    return (float(row), float(column)), float(size)


def _through(points: Array) -> tuple[float, float, float] | None:
    """The circle by linear least squares (Kåsa): row, column, radius."""
    middle = points.mean(axis=0)
    shifted = points - middle
    design = np.column_stack([2.0 * shifted, np.ones(len(points))])
    solution, _, rank, _ = np.linalg.lstsq(design, (shifted**2).sum(axis=1), rcond=None)
    size_squared = solution[2] + solution[0] ** 2 + solution[1] ** 2
    if rank < 3 or not size_squared > 0.0:
        return None
    return float(solution[0] + middle[0]), float(solution[1] + middle[1]), float(np.sqrt(size_squared))


def _edges(image: Array) -> tuple[tuple[float, float], float, float]:
    """Axis, radius and tilt of a cylinder from straight lines through both edges."""
    bright = _foreground(image)
    has = np.flatnonzero(bright.any(axis=1))
    if len(has) < 12:
        raise PbrdfError("image shows no cylinder along its columns; give center and radius")
    first = bright[has].argmax(axis=1) - 0.5
    last = bright.shape[1] - 1 - bright[has][:, ::-1].argmax(axis=1) + 0.5
    lines = [_line(has.astype(np.float64), edge.astype(np.float64)) for edge in (first, last)]
    slope = 0.5 * (lines[0][0] + lines[1][0])
    turn = float(np.arctan(slope))
    row = float(has.mean())
    left, right = (line[0] * row + line[1] for line in lines)
    if not right - left > 4.0:
        raise PbrdfError("the edges of what is bright are no two lines; give center and radius")
    return (row, 0.5 * float(left + right)), 0.5 * float(right - left) * float(np.cos(turn)), float(np.degrees(turn))


def _line(rows: Array, edge: Array) -> tuple[float, float]:
    """A line through most of an edge: the largest of the residuals are left out."""
    kept = np.ones(len(rows), dtype=bool)
    for _ in range(6):
        slope, shift = np.polyfit(rows[kept], edge[kept], 1)
        residual = np.abs(edge - slope * rows - shift)
        kept = residual <= max(1.0, 2.5 * float(np.median(residual)))
    return float(slope), float(shift)


class PixelFit:
    """What pixels say of a surface."""

    def __init__(self, fit: FitResult, noise: Sequence[float], maps: SimpleNamespace, one_angle: float | None) -> None:
        self._fit, self._maps, self._one_angle = fit, maps, one_angle
        self._noise_s0, self._noise_polarised = noise

    @property
    def fit(self) -> FitResult:
        """The fit, with correlations and what the data leave undetermined."""
        return self._fit

    @property
    def noise_s0(self) -> float:
        """Standard deviation of S0 that the weights suppose, relative to S0."""
        return self._noise_s0

    @property
    def noise_polarised(self) -> float:
        """Standard deviation of the polarised part that the weights suppose, relative to S0."""
        return self._noise_polarised

    @property
    def used(self) -> NDArray[np.bool_]:
        """The pixels that were fitted, of shape (lamps, rows, columns)."""
        return self._maps.used

    @property
    def s0_residuals(self) -> Array:
        """(S0 − model)/model in each pixel, of shape (lamps, rows, columns); NaN where it was not fitted."""
        return self._maps.s0

    @property
    def dolp_residuals(self) -> Array:
        """DoLP − model in each pixel, the same way; what is polarised is divided by the S0 of the model."""
        return self._maps.dolp

    @property
    def parameters(self) -> dict[str, Estimate]:
        """The parameters by name. ``ks`` is the scale of the radiances where ``scale`` is unknown; ``kd`` and ``kv`` then carry it too."""
        return {name: _with_intervals(estimate) for name, estimate in self.fit.parameters.items()}

    @property
    def undetermined(self) -> list[str]:
        """What the pictures leave open, a sentence each; among them what lamps at one angle from the camera cannot tell."""
        return [*self._about_lamps(), *self.fit.undetermined]

    def _about_lamps(self) -> list[str]:
        if self._one_angle is None:
            return []
        return [
            f"every facet that mirrors a lamp to the camera is met at β = {self._one_angle:.1f}°: DoLP there is one number for n and k, which it "
            "cannot tell apart; add a lamp at another angle from the camera"
        ]

    def __repr__(self) -> str:
        lines = [f"<pbrdf.PixelFit of {int(self.used.sum())} pixels under {len(self.used)} lamps: {self.fit.stop_reason}"]
        lines += [f"  {name} = {estimate}" for name, estimate in self.parameters.items()]
        return "\n".join([*lines, *(f"  {sentence}" for sentence in self.undetermined), ">"])

    def _repr_html_(self) -> str:
        rows = [(name, estimate.text, ends_text(estimate.interval95)) for name, estimate in self.parameters.items()]
        head = f"{int(self.used.sum())} pixels under {len(self.used)} lamps: {self.fit.stop_reason}"
        return _html.page(head, ["parameter", "value", "95 %"], rows, self.undetermined)


def _with_intervals(estimate: Estimate) -> Estimate:
    """With intervals from the standard error, where the fit has none: the likelihood of so many pixels is quadratic where it is determined."""
    if estimate.interval68 is not None or estimate.std_error is None:
        return estimate
    ends = [(estimate.value - factor * estimate.std_error, estimate.value + factor * estimate.std_error) for factor in _QUANTILES]
    return dataclasses.replace(estimate, interval68=ends[0], interval95=ends[1])


def fit_pixels(
    stokes: ArrayLike,
    normals: Body | ArrayLike,
    lamps: Sequence[tuple[float, float]],
    model: str = "cauchy",
    *,
    scale: float | None = None,
    mask: ArrayLike | None = None,
    saturation: float | None = None,
    dark: float = 0.0,
    max_angle: float = 80.0,
    intervals: str = "linear",
    progress: Callable[[float, int, float], object] | None = None,
    **options: Any,
) -> PixelFit:
    """Fits one surface to all pixels of a body under one lamp or several, each a distant unpolarised lamp of one irradiance.

    Args:
        stokes: S0, S1 and S2 of the camera, of shape (lamps, 3, rows, columns), or (3, rows, columns) of one lamp. S1 > 0 is polarised along
            x (to the right), S2 > 0 along the diagonal of x and y (up); NaN is a pixel that was not measured.
        normals: Unit normals of shape (rows, columns, 3), NaN beside the body; or a :class:`Body` of :func:`sphere` or :func:`cylinder`.
        lamps: Direction of each lamp: its angle from z (towards the camera), and its angle from x towards y, in degrees.
        model: The name of a model; :func:`models` lists them.
        scale: Radiance that the camera gives for 1 sr⁻¹ times the irradiance. None: not known; ``ks`` becomes this scale, and ``kd/ks`` and
            ``kv/ks`` are the surface's.
        mask: True where a pixel is left out, of shape (rows, columns) or (lamps, rows, columns).
        saturation: S0 from which on a pixel is left out: highlights that the camera cuts off.
        dark: S0 up to which a pixel is left out: shadows and background.
        max_angle: Angles of incidence and of view above this, in degrees, are left out: an error of the outline is large there.
        intervals: ``"linear"``, ``"profile"`` (slower) or ``"none"``.
        progress: As :func:`fit` has it.
        **options: The others of :func:`fit` but ``own``, ``weights`` and ``brdf_residuals``: rows are weighed by the noise that the pixels
            themselves show, relative to S0.

    Returns:
        A :class:`PixelFit`.

    Raises:
        PbrdfError: Shapes do not agree, a lamp is no direction, no pixel is left, or as :func:`fit` has it.

    >>> from pbrdf import picture
    >>> lamps = [(20.0, 90.0), (60.0, 200.0), (100.0, 330.0)]
    >>> seen = [picture("cauchy", {"n": 2.07, "k": 2.9}, lamp=lamp, size=60) for lamp in lamps]
    >>> found = fit_pixels([one.stokes for one in seen], seen[0].normals, lamps, scale=1.0)
    >>> round(found.parameters["n"].value, 3), round(found.parameters["k"].value, 3)
    (2.07, 2.9)
    """
    light = _checks.numbers("stokes", stokes)
    light = light[None] if light.ndim == 3 else light
    directions = [_checks.pair(f"lamps[{number}]", lamp, "(angle from z, angle from x) in degrees") for number, lamp in enumerate(lamps)]
    if light.ndim != 4 or light.shape[1] not in (3, 4) or len(light) != len(directions):
        raise PbrdfError(f"stokes has the shape {np.shape(stokes)} for {len(directions)} lamps; expected (lamps, 3, rows, columns)")
    facing = normals.normals if isinstance(normals, Body) else _checks.numbers("normals", normals)
    if facing.shape != (*light.shape[2:], 3):
        raise PbrdfError(f"normals has the shape {facing.shape}; expected {(*light.shape[2:], 3)}")
    angle = _checks.number("max_angle", max_angle)
    if not 0.0 < angle < 90.0:
        raise PbrdfError(f"max_angle = {max_angle!r}; expected degrees above 0 and below 90")
    factor = 1.0 if scale is None else _checks.number("scale", scale)
    if not (np.isfinite(factor) and factor > 0.0):
        raise PbrdfError(f"scale = {scale!r}; expected a number above 0")
    for taken in ("own", "weights", "brdf_residuals"):
        if taken in options:
            raise PbrdfError(f"fit_pixels has no {taken}: one surface, weighed by the noise of the pixels")
    options = {**options, "intervals": intervals}
    if scale is not None:
        options["fix"] = {"ks": 1.0, **_fixed(options.get("fix"))}
    used = _usable(light, facing, mask, saturation, _checks.number("dark", dark))
    if not used.any():
        raise PbrdfError("no pixel is left: each is masked, dark, saturated or beside the body")
    if scale is None:
        options = _scaled(options, float(np.median(light[:, 0][used])))
    settings = fit_settings(model, **options)
    request = SimpleNamespace(
        lamps=directions,
        normals=np.ascontiguousarray(facing, dtype=np.float64).reshape(-1),
        s0=_flat(light[:, 0], factor),
        s1=_flat(light[:, 1], factor),
        s2=_flat(light[:, 2], factor),
        used=used.reshape(-1),
        max_angle=angle,
    )
    inner, noise, places, (of_s0, of_dolp) = _pbrdf.fit_pixels(request, settings, progress)
    maps = SimpleNamespace(used=np.zeros(used.shape, dtype=bool), s0=np.full(used.shape, np.nan), dolp=np.full(used.shape, np.nan))
    maps.used.flat[places] = True
    maps.s0.flat[places] = of_s0
    maps.dolp.flat[places] = of_dolp
    polar = np.array([direction[0] for direction in directions])
    one_angle = float(0.5 * polar.mean()) if np.ptp(polar) <= _SAME_ANGLE else None
    return PixelFit(FitResult(inner), noise, maps, one_angle)


def _scaled(options: dict[str, Any], radiance: float) -> dict[str, Any]:
    """Starts and bounds of the weights in units of what the camera gives, where nothing else is said of them."""
    start = {"ks": 3.0 * radiance, "kd": radiance, "kv": 0.3 * radiance}
    bounds = {name: (0.0, _BRIGHTEST * radiance) for name in start}
    held = set(_fixed(options.get("fix")))
    tied = set(options.get("tie") or {})
    free = [name for name in start if name not in held | tied]
    said = {key: dict(options.get(key) or {}) for key in ("start", "bounds")}
    of: dict[str, dict[str, Any]] = {"start": start, "bounds": bounds}
    return {**options, **{key: {**{name: of[key][name] for name in free}, **said[key]} for key in said}}


def _fixed(fix: Any) -> dict[str, Any]:
    if fix is None or isinstance(fix, dict):
        return dict(fix or {})
    return dict.fromkeys(_checks.names("fix", fix))


def _flat(component: Array, factor: float) -> Array:
    return np.ascontiguousarray(component / factor if factor != 1.0 else component, dtype=np.float64).reshape(-1)


def _usable(light: Array, facing: Array, mask: Any, saturation: Any, dark: float) -> NDArray[np.bool_]:
    """The pixels of the body that are neither masked, dark nor saturated."""
    with np.errstate(invalid="ignore"):
        used = np.isfinite(light[:, :3]).all(axis=1) & (light[:, 0] > max(dark, 0.0)) & (facing[..., 2] > 0.0)
        if saturation is not None:
            used &= light[:, 0] < _checks.number("saturation", saturation)
    if mask is not None:
        left_out = np.asarray(mask)
        if left_out.dtype != bool or left_out.shape not in (used.shape, used.shape[1:]):
            raise PbrdfError(f"mask has the shape {left_out.shape} of {left_out.dtype}; expected truth values of shape {used.shape[1:]}")
        used &= ~left_out
    return np.ascontiguousarray(used)
