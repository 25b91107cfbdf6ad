"""Many fits: on threads here, on an executor, or on a Dask cluster; rows of a table that survives a run that dies."""

from __future__ import annotations

import concurrent.futures
import hashlib
import inspect
import json
import os
import time
from collections.abc import Callable, Iterable, Iterator, Sized
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from . import _html, _pbrdf
from ._fitting import fit_settings
from ._measurement import Measurement, read_quietly
from ._pbrdf import PbrdfError, __version__
from ._rows import KEYS, CsvRows, ParquetRows, Row, is_text

# Seconds that a task should take: long beside what it costs to send it, short beside the patience of somebody who stops the run.
_TASK_SECONDS = 0.25
# Fits of a task at most.
_MOST = 2048
# The options of `fit` that every one of many fits can have.
_OPTIONS = [name for name in inspect.signature(fit_settings).parameters if name not in ("model", "own")]


class FitTable:
    """Rows of fits, one a measurement, in the order of the items; a failure is a row with its sentence in ``error``."""

    def __init__(self, columns: list[str], rows: list[Row]) -> None:
        self._columns = columns
        self._rows = rows

    @property
    def columns(self) -> list[str]:
        """Names of the columns, those of ``pbrdf-explorer fit --batch``: ``file``, ``set``, ``objective``, ``n``, ``n_std_error``,
        ``n_low68`` …, ``undetermined``, ``error``."""
        return self._columns

    def __len__(self) -> int:
        return len(self._rows)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return (dict(zip(self.columns, row, strict=True)) for row in self._rows)

    def __getitem__(self, column: str) -> np.ndarray:
        """A column: numbers as float64 with NaN where there is none, words as an array of objects."""
        if column not in self.columns:
            raise PbrdfError(f"there is no column {column!r}; the columns are {', '.join(self.columns)}")
        cells = [row[self.columns.index(column)] for row in self._rows]
        if is_text(column):
            return np.array(["" if cell is None else cell for cell in cells], dtype=object)
        return np.array([np.nan if cell is None else float(cell) for cell in cells], dtype=np.float64)

    @property
    def failures(self) -> dict[str, str]:
        """The sentence of each file, or measurement, that could not be fitted, by its name."""
        return {row["file"]: row["error"] for row in self if row["error"]}

    def to_pandas(self) -> Any:
        """As a ``pandas.DataFrame``. Needs pandas."""
        import pandas  # type: ignore[import-untyped, import-not-found, unused-ignore]

        return pandas.DataFrame({column: self[column] for column in self.columns})

    def __repr__(self) -> str:
        failures = len(self.failures)
        return f"<pbrdf.FitTable of {len(self)} rows{f', {failures} without a fit' if failures else ''}>"

    def _repr_html_(self) -> str:
        # What one looks at first; all columns are in to_pandas().
        shown = [name for name in self.columns if name in ("file", "set", "objective", "stop_reason", "error") or f"{name}_std_error" in self.columns]
        places = [self.columns.index(name) for name in shown]
        rows = [[row[place] for place in places] for row in self._rows]
        return _html.page(f"{len(self)} fits", shown, rows)


@dataclass
class _Item:
    """What is fitted, with the rows that it becomes."""

    key: str
    hash: str
    measurements: list[tuple[str, bytes, str]]
    """Name, table and notices of each measurement."""
    error: str = ""
    """Why there are none."""


def fit_chunk(tables: list[bytes], settings: SimpleNamespace, stop: _pbrdf.Stop | None = None) -> tuple[list[Any], float]:
    """The rows of some measurements, and how many seconds they took. It runs wherever the client has it run."""
    begun = time.perf_counter()
    return _pbrdf.fit_rows(tables, settings, stop), time.perf_counter() - begun


def map_fits(
    items: Iterable[Measurement | str | os.PathLike[str]],
    model: str = "cauchy",
    *,
    client: Any = None,
    output: str | os.PathLike[str] | None = None,
    progress: Callable[[int, int | None, float | None], object] | None = None,
    **options: Any,
) -> FitTable:
    """Fits a model to each of many measurements by itself, several at a time.

    Args:
        items: Measurements, or files that :func:`read_all` reads; a generator is drawn on as fits are done.
        model: The name of a model; :func:`models` lists them.
        client: Where: None for threads of this process, an executor of ``concurrent.futures``, or a ``distributed.Client`` of Dask, whose
            workers need this package.
        output: A file for the rows as they come: ``.csv`` as ``pbrdf-explorer fit --batch`` writes it, or ``.parquet``, a folder with a
            file a task (needs pyarrow). The same call again goes on where it was: what is there with the same content is not fitted again.
        progress: Called after each task with the items that are done, how many there are (None for a generator), and the seconds that are
            left (None where that is not known).
        **options: Those of :func:`fit` but ``own`` and ``progress``; the same for all.

    Returns:
        A :class:`FitTable`. What cannot be read or fitted is a row with its sentence in ``error``.

    Raises:
        PbrdfError: As :func:`fit` for its options; ``output`` holds something else, or rows of other options; or the client went away. What
            was done then is in ``output``.

    >>> from pbrdf import simulate
    >>> data = [simulate("specular", {"n": n}, [30, 50, 70], range(0, 80, 10), noise=0.002).renamed(f"n{n}") for n in (1.5, 2.0)]
    >>> table = map_fits(data, "specular", fix={"ks": 1.0}, intervals="linear", starts=1)
    >>> table["file"].tolist(), table["n"].round(1).tolist()
    (['n1.5', 'n2.0'], [1.5, 2.0])
    """
    if isinstance(items, (str, os.PathLike, Measurement)) or not isinstance(items, Iterable):
        raise PbrdfError('items: expected measurements or files, such as sorted(Path("runs").glob("*.csv"))')
    if progress is not None and not callable(progress):
        raise PbrdfError("progress: expected a function of items done, items in all, and seconds left")
    if options.get("own") is not None:
        raise PbrdfError("map_fits has no own: each measurement is fitted by itself; fit([...], own=...) fits several together")
    unknown = sorted(set(options) - set(_OPTIONS))
    if unknown:
        raise PbrdfError(f"map_fits has no option {unknown[0]}; it has {', '.join(_OPTIONS)}")
    settings = fit_settings(model, **options)
    # Refuses what is wrong with the options before anything is done.
    _pbrdf.fit_rows([], settings, None)
    columns = [*KEYS, "model", *_pbrdf.fit_row_columns(settings.model), "notices", "error"]
    rows = _rows_file(output, columns, settings)
    executor, workers, stop = _executor(client)
    run = _Run(items, settings, rows, executor, workers, stop, progress)
    try:
        return FitTable(columns, run.work())
    except (PbrdfError, KeyboardInterrupt):
        raise
    except (concurrent.futures.BrokenExecutor, concurrent.futures.CancelledError, RuntimeError, OSError) as error:
        if client is None:
            raise
        kept = f"; what was done is in {os.fspath(output)}, and the same call goes on from there" if output is not None else ""
        raise PbrdfError(f"the client went away or could not do its work ({type(error).__name__}: {error}){kept}") from error
    finally:
        if stop is not None:
            stop.ask()
            executor.shutdown(cancel_futures=True)
        rows.close()


def _rows_file(output: Any, columns: list[str], settings: SimpleNamespace) -> CsvRows | ParquetRows:
    options = json.dumps(vars(settings), sort_keys=True)
    comments = {"program": f"pbrdf {__version__} (Python)", "options": options}
    if output is not None and not isinstance(output, (str, os.PathLike)):
        raise PbrdfError(f"output is a {type(output).__name__}; expected the name of a file")
    path = None if output is None else Path(output)
    if path is not None and path.suffix == ".parquet":
        return ParquetRows(path, columns, comments)
    if path is not None and path.suffix != ".csv":
        raise PbrdfError(f"output: {path} ends in neither .csv nor .parquet")
    return CsvRows(path, columns, comments)


def _executor(client: Any) -> tuple[concurrent.futures.Executor, int, _pbrdf.Stop | None]:
    """An executor, how many tasks it does at once, and what stops its threads where they are ours."""
    if client is None:
        threads = _pbrdf.thread_count()
        return concurrent.futures.ThreadPoolExecutor(threads, "pbrdf"), threads, _pbrdf.Stop()
    if isinstance(client, concurrent.futures.Executor):
        return client, getattr(client, "_max_workers", None) or os.cpu_count() or 1, None
    if callable(getattr(client, "get_executor", None)):
        try:
            # A function of its arguments alone, but one whose results nobody wants to be kept.
            return client.get_executor(pure=False), max(1, sum(client.ncores().values())), None
        except Exception as error:
            raise PbrdfError(f"the client does not answer ({type(error).__name__}: {error}); is its cluster still there?") from error
    raise PbrdfError(f"client is a {type(client).__name__}; expected None, an executor of concurrent.futures, or a Client of distributed")


class _Run:
    """Items on their way through an executor."""

    def __init__(
        self,
        items: Iterable[Any],
        settings: SimpleNamespace,
        rows: CsvRows | ParquetRows,
        executor: concurrent.futures.Executor,
        workers: int,
        stop: _pbrdf.Stop | None,
        progress: Callable[[int, int | None, float | None], object] | None,
    ) -> None:
        self._total = len(items) if isinstance(items, Sized) else None
        self._items = enumerate(items)
        self._settings = settings
        self._rows = rows
        self._executor = executor
        self._workers = workers
        self._stop = stop
        self._progress = progress
        self._pending: dict[concurrent.futures.Future[Any], list[_Item]] = {}
        self._seen: set[str] = set()
        self._size = 1
        self._done = self._made = 0
        self._begun = time.perf_counter()

    def work(self) -> list[Row]:
        order: list[str] = []
        self._submit(order)
        while self._pending:
            finished, _ = concurrent.futures.wait(self._pending, return_when=concurrent.futures.FIRST_COMPLETED)
            for future in finished:
                self._take(self._pending.pop(future), future.result())
            self._submit(order)
        return self._rows.finish(order)

    def _submit(self, order: list[str]) -> None:
        """Keeps the workers busy: a task at work and one in wait for each."""
        while len(self._pending) < 2 * self._workers:
            chunk: list[_Item] = []
            fits = 0
            for number, given in self._items:
                key, found = _hashed(given, number)
                if key in self._seen:
                    raise PbrdfError(f"two items are called {key}; each needs a name of its own")
                self._seen.add(key)
                order.append(key)
                if self._rows.holds(key, found):
                    self._tell(1, 0)
                    continue
                item = _read(given, key, found)
                if item.error:
                    self._rows.append([_failure(item, self._settings.model, self._rows.columns)])
                    self._tell(1, 1)
                    continue
                chunk.append(item)
                fits += len(item.measurements)
                if fits >= self._size:
                    break
            if not chunk:
                return
            tables = [table for item in chunk for _, table, _ in item.measurements]
            arguments = (tables, self._settings) if self._stop is None else (tables, self._settings, self._stop)
            self._pending[self._executor.submit(fit_chunk, *arguments)] = chunk

    def _take(self, chunk: list[_Item], found: tuple[list[Any], float]) -> None:
        fits, seconds = found
        wanted = _TASK_SECONDS * len(fits) / max(seconds, 1e-6)
        self._size = int(min(max(wanted, 1), _MOST, 4 * max(self._size, len(fits))))
        taken = iter(fits)
        rows: list[Row] = []
        for item in chunk:
            for (name, _, notices), (cells, error) in zip(item.measurements, taken):
                row = [item.key, len(item.measurements), name or None, item.hash, self._settings.model]
                row += cells or [None] * (len(self._rows.columns) - len(row) - 2)
                rows.append((*row, notices or None, error or None))
        self._rows.append(rows)
        self._tell(len(chunk), len(chunk))

    def _tell(self, done: int, made: int) -> None:
        self._done += done
        self._made += made
        if self._progress is not None:
            elapsed = time.perf_counter() - self._begun
            left = None if self._total is None or self._made == 0 else elapsed / self._made * (self._total - self._done)
            self._progress(self._done, self._total, left)


def _hashed(given: Any, number: int) -> tuple[str, str]:
    """What an item is called, and the hash of its content; empty where a file cannot be read."""
    if isinstance(given, Measurement):
        return given.name or str(number), hashlib.sha256(bytes(given._inner.to_csv())).hexdigest()
    if isinstance(given, (str, os.PathLike)):
        key = os.fspath(given)
        try:
            return key, hashlib.sha256(Path(key).read_bytes()).hexdigest()
        except OSError:
            return key, ""
    raise PbrdfError(f"items[{number}] is a {type(given).__name__}; expected a Measurement or the name of a file")


def _read(given: Any, key: str, found: str) -> _Item:
    if isinstance(given, Measurement):
        return _Item(key, found, [("", bytes(given._inner.to_csv()), "")])
    try:
        measurements = read_quietly(given)
    except PbrdfError as error:
        return _Item(key, found, [], str(error))
    own = Path(key).name
    one = [("" if item.name == own and len(measurements) == 1 else item.name, bytes(item._inner.to_csv()), "; ".join(item.notes)) for item in measurements]
    return _Item(key, found, one)


def _failure(item: _Item, model: str, columns: list[str]) -> Row:
    row = [item.key, 1, None, item.hash or None, model]
    return (*row, *[None] * (len(columns) - len(row) - 1), item.error)
