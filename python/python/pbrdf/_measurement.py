"""Measurements: from arrays, and from files."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _checks, _html, _pbrdf
from ._pbrdf import PbrdfError

COLUMNS = ("theta_i", "theta_r", "dphi", "dolp", "dolp_sigma", "brdf", "brdf_sigma", "masked")


class Measurement:
    """Rows of angles, and what was measured there.

    Args:
        theta_i: Zenith angles of incidence in degrees, 0 ≤ θi < 90.
        theta_r: Zenith angles of view in degrees, 0 ≤ θr < 90; or negative for the backscatter side where ``dphi`` is 180.
        dphi: Relative azimuths φr − φi in degrees; 180 is the forward side.
        dolp: Degree of linear polarisation, 0 to 1.
        brdf: BRDF in sr⁻¹, 0 or more.
        dolp_sigma: Standard deviations of ``dolp``, above 0.
        brdf_sigma: Standard deviations of ``brdf`` in sr⁻¹, above 0.
        masked: Rows that are kept and used by no fit.
        name: What it is called in results.
        metadata: Texts by keys, such as ``{"wavelength_nm": "650"}``.

    Its columns are read-only arrays: ``copy()`` gives one that can be changed.

    All broadcast to one row of numbers. At least one of ``dolp`` and ``brdf`` is needed. What was not measured is None, or masked in a
    ``numpy.ma`` array; NaN is refused.

    Raises:
        PbrdfError: Shapes do not broadcast, an angle or a value lies outside its range or is NaN, or nothing is measured.

    >>> data = Measurement(30, [30, 40, 50], dolp=[0.1, None, 0.3], name="steel")
    >>> data
    <pbrdf.Measurement 'steel': 3 rows, DoLP>
    >>> data.dolp
    array([0.1, nan, 0.3])
    """

    _inner: _pbrdf.Measurement
    _columns: dict[str, NDArray[Any]]

    def __init__(
        self,
        theta_i: ArrayLike,
        theta_r: ArrayLike,
        dphi: ArrayLike = 180.0,
        *,
        dolp: ArrayLike | None = None,
        brdf: ArrayLike | None = None,
        dolp_sigma: ArrayLike | None = None,
        brdf_sigma: ArrayLike | None = None,
        masked: ArrayLike = False,
        name: str = "",
        metadata: Mapping[str, Any] | None = None,
    ) -> None:
        quantities = {"dolp": dolp, "dolp_sigma": dolp_sigma, "brdf": brdf, "brdf_sigma": brdf_sigma}
        if dolp is None and brdf is None:
            raise PbrdfError("neither dolp nor brdf is given; at least one is needed")
        for quantity in ("dolp", "brdf"):
            if quantities[quantity] is None and quantities[f"{quantity}_sigma"] is not None:
                raise PbrdfError(f"{quantity}_sigma is given without {quantity}")
        columns = {key: _split(key, value) for key, value in quantities.items() if value is not None}
        angles = {"theta_i": theta_i, "theta_r": theta_r, "dphi": dphi, "masked": masked}
        flat, shape = _checks.broadcast(**angles, **{key: values for key, (values, _) in columns.items()})
        if len(shape) > 1:
            raise PbrdfError(f"the columns have the shape {shape}; expected one row of numbers each, as ravel() makes it")
        rows = dict(zip([*angles, *columns], flat, strict=True))
        if not np.isin(rows["masked"], (0.0, 1.0)).all():
            raise PbrdfError("masked: expected True or False in each row")
        pairs = {key: (rows[key], _to_rows(measured, rows[key].shape)) for key, (_, measured) in columns.items()}
        if not any(measured.any() for key, (_, measured) in pairs.items() if not key.endswith("_sigma")):
            raise PbrdfError("no row has a value of DoLP or BRDF")
        self._columns = {}
        texts = [(key, str(value)) for key, value in _checks.items("metadata", metadata)]
        self._inner = _pbrdf.Measurement(
            SimpleNamespace(
                **{key: rows[key] for key in ("theta_i", "theta_r", "dphi")},
                **{key: pairs.get(key) for key in quantities},
                masked=rows["masked"] != 0.0,
                name=_checks.word("name", name),
                metadata=texts,
            )
        )

    @classmethod
    def _of(cls, inner: _pbrdf.Measurement) -> Measurement:
        measurement = cls.__new__(cls)
        measurement._inner, measurement._columns = inner, {}
        return measurement

    def _column(self, name: str) -> NDArray[Any]:
        """A column, made once; read-only, so that nobody takes what is written to it for a change of the measurement."""
        found = self._columns.get(name)
        if found is None:
            found = self._inner.column(name)
            found = found != 0.0 if name == "masked" else found
            found.flags.writeable = False
            self._columns[name] = found
        return found

    @classmethod
    def from_pandas(cls, frame: Any, *, name: str = "", metadata: Mapping[str, Any] | None = None) -> Measurement:
        """From a data frame with columns ``theta_i``, ``theta_r`` and at least one of ``dolp`` and ``brdf``, as the arguments of the class are
        called. NaN in a column of values is what was not measured. Other columns are left alone.

        Raises:
            PbrdfError: A column of angles is missing, or as the class has it.
        """
        missing = [key for key in ("theta_i", "theta_r") if key not in frame]
        if missing:
            raise PbrdfError(f"the column {missing[0]} is missing; the columns are {', '.join(map(str, frame))}")
        columns = {key: np.asarray(frame[key]) for key in COLUMNS if key in frame}
        for key in ("dolp", "dolp_sigma", "brdf", "brdf_sigma"):
            if key in columns:
                columns[key] = np.ma.masked_invalid(_checks.numbers(key, columns[key]))
        return cls(**columns, name=name, metadata=metadata)

    def to_pandas(self) -> Any:
        """As a ``pandas.DataFrame`` with the columns that have a value, and ``masked`` as truth values. Needs pandas."""
        import pandas  # type: ignore[import-untyped, import-not-found, unused-ignore]

        columns: dict[str, Any] = {key: self._column(key) for key in COLUMNS}
        kept = {key: value for key, value in columns.items() if key == "masked" or not np.isnan(value).all()}
        return pandas.DataFrame(kept)

    @property
    def name(self) -> str:
        """What it is called in results."""
        return self._inner.name

    @property
    def metadata(self) -> dict[str, str]:
        """Texts by their keys."""
        return dict(self._inner.metadata)

    @property
    def notes(self) -> list[str]:
        """What the reader of its file had to say, a sentence each."""
        return self._inner.notes

    @property
    def theta_i(self) -> NDArray[np.float64]:
        """Zenith angles of incidence in degrees, one a row."""
        return self._column("theta_i")

    @property
    def theta_r(self) -> NDArray[np.float64]:
        """Zenith angles of view in degrees, 0 ≤ θr < 90, one a row."""
        return self._column("theta_r")

    @property
    def dphi(self) -> NDArray[np.float64]:
        """Relative azimuths in degrees, one a row: 0 where a negative θr was given."""
        return self._column("dphi")

    @property
    def dolp(self) -> NDArray[np.float64]:
        """Degree of linear polarisation, one a row; NaN where it was not measured."""
        return self._column("dolp")

    @property
    def dolp_sigma(self) -> NDArray[np.float64]:
        """Standard deviations of DoLP, one a row; NaN where none is stated."""
        return self._column("dolp_sigma")

    @property
    def brdf(self) -> NDArray[np.float64]:
        """BRDF in sr⁻¹, one a row; NaN where it was not measured."""
        return self._column("brdf")

    @property
    def brdf_sigma(self) -> NDArray[np.float64]:
        """Standard deviations of the BRDF in sr⁻¹, one a row; NaN where none is stated."""
        return self._column("brdf_sigma")

    @property
    def masked(self) -> NDArray[np.bool_]:
        """Rows that no fit uses."""
        return self._column("masked")

    def renamed(self, name: str) -> Measurement:
        """The same measurement under another name."""
        return Measurement._of(self._inner.renamed(_checks.word("name", name)))

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes it as a CSV that :func:`read`, the command line and the window read, every number to its last bit."""
        Path(path).write_bytes(bytes(self._inner.to_csv()))

    def __reduce__(self) -> tuple[Any, ...]:
        """Goes to other processes: rows, name and metadata, without the notes of its reader."""
        return _restored, ([self._column(key) for key in COLUMNS], self.name, self.metadata)

    def __len__(self) -> int:
        return len(self._inner)

    def __repr__(self) -> str:
        there = [label for key, label in (("dolp", "DoLP"), ("brdf", "BRDF")) if not np.isnan(self._column(key)).all()]
        return f"<pbrdf.Measurement {self.name!r}: {len(self)} rows, {' and '.join(there) or 'nothing measured'}>"

    def _repr_html_(self) -> str:
        names = [name for name in COLUMNS if name == "masked" or not np.isnan(self._column(name)).all()]
        columns = [self._column(name) for name in names if name != "masked"]
        rows = list(zip(*(column.tolist() for column in columns), ("yes" if masked else "" for masked in self.masked.tolist())))
        return _html.page(repr(self).strip("<>"), names, rows)


def _restored(columns: list[NDArray[np.float64]], name: str, metadata: dict[str, str]) -> Measurement:
    """A measurement from another process."""
    rows: dict[str, Any] = dict(zip(COLUMNS, columns, strict=True))
    for key in ("dolp", "dolp_sigma", "brdf", "brdf_sigma"):
        rows[key] = np.ma.masked_invalid(rows[key])
    for key in ("dolp", "brdf"):
        if rows[key].mask.all():
            del rows[key], rows[f"{key}_sigma"]
    return Measurement(**rows, name=name, metadata=metadata)


def _split(name: str, value: Any) -> tuple[np.ndarray, np.ndarray]:
    """Values, and where there is one: not where it is None or masked."""
    if np.ma.isMaskedArray(value):
        measured = ~np.ma.getmaskarray(value)
        return np.where(measured, _checks.numbers(name, value.data), 0.0), measured
    if isinstance(value, (list, tuple)) or getattr(value, "dtype", None) == object:
        array = np.array(value, dtype=object) if not isinstance(value, np.ndarray) else value
        measured = np.array([item is not None for item in array.ravel()], dtype=bool).reshape(array.shape)
        if not measured.all():
            return _checks.numbers(name, np.where(measured, array, 0.0)), measured
    array = _checks.numbers(name, value)
    return array, np.ones(array.shape, dtype=bool)


def _to_rows(measured: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    return np.ascontiguousarray(np.broadcast_to(measured, shape))


def read_all(
    path: str | os.PathLike[str],
    *,
    columns: str | Mapping[str, int | str] | None = None,
    wavelength_nm: float | None = None,
    theta_i: ArrayLike | None = None,
    theta_r: ArrayLike | None = None,
    dphi: float | None = None,
) -> list[Measurement]:
    """All measurements of a file: one for each set and wavelength. As :func:`read` otherwise."""
    if not isinstance(path, (str, os.PathLike)):
        raise PbrdfError(f"path is a {type(path).__name__}; expected the name of a file")
    answers = SimpleNamespace(
        columns=",".join(f"{name}={column}" for name, column in columns.items()) if isinstance(columns, Mapping) else columns,
        wavelength_nm=None if wavelength_nm is None else _checks.number("wavelength_nm", wavelength_nm),
        theta_i=[] if theta_i is None else _checks.numbers("theta_i", theta_i).ravel().tolist(),
        theta_r=[] if theta_r is None else _checks.numbers("theta_r", theta_r).ravel().tolist(),
        dphi=None if dphi is None else _checks.number("dphi", dphi),
    )
    found = read_quietly(path, answers)
    for measurement in found:
        for note in measurement.notes:
            warnings.warn(f"{os.fspath(path)}: {note}", stacklevel=_checks.outside())
    return found


def read_quietly(path: str | os.PathLike[str], answers: SimpleNamespace | None = None) -> list[Measurement]:
    """The same without warnings."""
    none = SimpleNamespace(columns=None, wavelength_nm=None, theta_i=[], theta_r=[], dphi=None)
    return [Measurement._of(inner) for inner in _pbrdf.read(os.fspath(path), answers or none)]


def read(
    path: str | os.PathLike[str],
    *,
    columns: str | Mapping[str, int | str] | None = None,
    wavelength_nm: float | None = None,
    theta_i: ArrayLike | None = None,
    theta_r: ArrayLike | None = None,
    dphi: float | None = None,
) -> Measurement:
    """Reads a measurement: a CSV with the columns ``theta_i``, ``theta_r`` and ``dolp`` or ``brdf``, or any other file that the program
    reads (tables and workbooks of other laboratories, ellipsometers' texts, tensors).

    Args:
        path: The file.
        columns: What the columns of a table mean, where its header does not say it: their numbers or names, with a unit behind a colon,
            as in ``{"theta_i": 1, "theta_r": 2, "dolp": "3:percent"}`` or ``"theta_i=1,theta_r=2,dolp=3:percent"``.
        wavelength_nm: Which wavelength of a file with several, in nm; the nearest is taken.
        theta_i: Angles of incidence in degrees, where the file does not state them or has a choice.
        theta_r: Angles of view in degrees, where the file has a choice.
        dphi: Relative azimuth in degrees, where the file has a choice.

    What the reader has to say is warned of, and stands in :attr:`Measurement.notes`.

    Raises:
        PbrdfError: The file cannot be read, with line and column; it needs an answer that is not given; or it holds several measurements,
            which :func:`read_all` returns.
    """
    found = read_all(path, columns=columns, wavelength_nm=wavelength_nm, theta_i=theta_i, theta_r=theta_r, dphi=dphi)
    if len(found) > 1:
        names = ", ".join(measurement.name for measurement in found)
        raise PbrdfError(f"{os.fspath(path)} holds {len(found)} measurements ({names}); read_all returns them as a list")
    return found[0]
