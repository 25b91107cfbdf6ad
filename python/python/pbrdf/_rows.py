"""Tables of fits that grow: a run that was killed goes on where it was."""

from __future__ import annotations

import contextlib
import csv
import io
import os
import tempfile
from pathlib import Path
from typing import Any

from ._pbrdf import PbrdfError

Row = tuple[Any, ...]

KEYS = ["file", "sets", "set", "sha256"]
"""What every row begins with: the file or the name of a measurement, how many measurements it holds, which one this is, and the hash of its
content."""
_COUNTS = {"sets", "rows", "dof"}


def is_text(column: str) -> bool:
    """Whether a column holds words."""
    return column in {"file", "set", "sha256", "model", "stop_reason", "undetermined", "notices", "error"} or column.endswith("_at_bound")


class _Rows:
    """What is done: the rows of each item, by its name."""

    def __init__(self, columns: list[str]) -> None:
        self.columns = columns
        self.done: dict[str, list[Row]] = {}

    def holds(self, key: str, found: str) -> bool:
        """Whether all rows of an item with that content are there."""
        rows = self.done.get(key)
        return rows is not None and (rows[0][3] or "") == found

    def keep(self, rows: list[Row]) -> None:
        """Takes rows in; the latest of an item count."""
        groups: dict[tuple[Any, Any], list[Row]] = {}
        for row in rows:
            groups.setdefault((row[0], row[3]), []).append(row)
        self.done.update({key: group for (key, _), group in groups.items() if len(group) == group[0][1]})

    def ordered(self, order: list[str]) -> list[Row]:
        """The rows of the items in their order."""
        return [row for key in order for row in self.done[key]]


class CsvRows(_Rows):
    """Rows in a CSV file; without a path, in memory alone."""

    def __init__(self, path: Path | None, columns: list[str], comments: dict[str, str]) -> None:
        super().__init__(columns)
        self._path = path
        self._file: Any = None
        if path is None:
            return
        comment = "".join(f"# {key}: {value}\n" for key, value in comments.items())
        self._head = comment + _line(columns)
        try:
            self._file = path.open("a+b")
            _lock(self._file, path)
            self._file.seek(0)
            found = self._file.read()
        except OSError as error:
            raise PbrdfError(f"{path} cannot be written: {error.strerror or error}") from error
        # A line without an end was being written when the run was killed.
        complete = found[: found.rfind(b"\n") + 1]
        head = self._head.encode()
        if head.startswith(complete) and len(complete) < len(head):
            self._file.truncate(0)
            self._write(self._head)
        elif complete.startswith(head):
            self._file.truncate(len(complete))
            self.keep([_cells(columns, row) for row in csv.reader(io.StringIO(complete[len(head) :].decode())) if len(row) == len(columns)])
        else:
            self._file.close()
            if complete.split(b"\n", 1)[0] == head.split(b"\n", 1)[0]:
                raise PbrdfError(f"{path} holds fits with other options; write to another file, or remove it")
            raise PbrdfError(f"{path} is no table of this version's map_fits; write to another file")

    def append(self, rows: list[Row]) -> None:
        """Appends the rows of some items."""
        self.keep(rows)
        if self._file is not None:
            self._write("".join(_line(row) for row in rows))

    def _write(self, text: str) -> None:
        try:
            self._file.write(text.encode())
            self._file.flush()
        except OSError as error:
            raise PbrdfError(f"{self._path} cannot be written: {error.strerror or error}") from error

    def finish(self, order: list[str]) -> list[Row]:
        """Puts the rows in the order of the items; those of others stand first."""
        rows = self.ordered(order)
        if self._path is not None:
            mine = set(order)
            others = [row for key, group in self.done.items() if key not in mine for row in group]
            with _replacing(self._path) as file:
                file.write((self._head + "".join(map(_line, others + rows))).encode())
        return rows

    def close(self) -> None:
        """Gives the file free."""
        if self._file is not None:
            self._file.close()


class ParquetRows(_Rows):
    """Rows in a folder of Parquet files, one for each task: a Parquet file cannot grow."""

    def __init__(self, path: Path, columns: list[str], comments: dict[str, str]) -> None:
        super().__init__(columns)
        try:
            import pyarrow  # type: ignore[import-untyped, import-not-found, unused-ignore]
            import pyarrow.parquet  # type: ignore[import-untyped, import-not-found, unused-ignore]
        except ImportError as error:
            raise PbrdfError(f"{path}: Parquet needs the package pyarrow; pip install pyarrow, or write a .csv") from error
        self._path = path
        if path.exists() and not path.is_dir():
            raise PbrdfError(f"{path} is a file; expected a folder, or no such name")
        kinds = [pyarrow.field(name, _kind(pyarrow, name)) for name in columns]
        self._schema = pyarrow.schema(kinds, metadata=comments)
        self._number = 0
        path.mkdir(parents=True, exist_ok=True)
        for part in sorted(path.glob("part-*.parquet")):
            table = pyarrow.parquet.read_table(part)
            if table.schema.metadata is None or not table.schema.equals(self._schema, check_metadata=True):
                raise PbrdfError(f"{path} holds fits with other options; write to another folder, or remove it")
            self.keep([tuple(row.values()) for row in table.to_pylist()])
            self._number = int(part.stem.rpartition("-")[2]) + 1

    def append(self, rows: list[Row]) -> None:
        """Adds a file with the rows of some items."""
        import pyarrow
        import pyarrow.parquet

        self.keep(rows)
        cells = {name: [row[index] for row in rows] for index, name in enumerate(self.columns)}
        table = pyarrow.table(cells, schema=self._schema)
        with _replacing(self._path / f"part-{self._number:06}.parquet") as file:
            pyarrow.parquet.write_table(table, file)
        self._number += 1

    def finish(self, order: list[str]) -> list[Row]:
        """The rows in the order of the items; the files stay as they came."""
        return self.ordered(order)

    def close(self) -> None:
        """There is nothing to give free."""


def _kind(pyarrow: Any, column: str) -> Any:
    if is_text(column):
        return pyarrow.string()
    if column in _COUNTS:
        return pyarrow.int64()
    return pyarrow.bool_() if column.endswith("_determined") else pyarrow.float64()


@contextlib.contextmanager
def _replacing(path: Path) -> Any:
    """A file that takes the name when it is complete."""
    file = tempfile.NamedTemporaryFile(dir=path.parent, prefix=f".{path.name}.", delete=False)
    try:
        with file:
            yield file
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(file.name, 0o666 & ~mask)
        os.replace(file.name, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(file.name)
        raise


def _lock(file: Any, path: Path) -> None:
    """Keeps other runs away, where the system has such locks."""
    try:
        import fcntl
    except ImportError:
        return
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.close()
        raise PbrdfError(f"{path} is being written by another run") from None
    except OSError:
        # A file system without locks.
        return


def _line(cells: Any) -> str:
    """A row as a line of CSV; `#` is quoted, so that readers with comment lines take it as text."""

    def text(cell: Any) -> str:
        if cell is None:
            return ""
        if isinstance(cell, bool):
            return "true" if cell else "false"
        if not isinstance(cell, str):
            return repr(cell)
        cell = cell.replace("\r", " ").replace("\n", " ")
        return '"' + cell.replace('"', '""') + '"' if set(cell) & set(',"#') else cell

    return ",".join(map(text, cells)) + "\n"


def _cells(columns: list[str], row: list[str]) -> Row:
    """The cells of a line."""

    def cell(column: str, text: str) -> Any:
        if text == "" or is_text(column):
            return text or None
        if column in _COUNTS:
            return int(text)
        return text == "true" if column.endswith("_determined") else float(text)

    return tuple(cell(column, text) for column, text in zip(columns, row, strict=True))
