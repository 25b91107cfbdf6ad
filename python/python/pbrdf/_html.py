"""Tables for notebooks."""

from __future__ import annotations

import html
import math
from collections.abc import Iterable, Sequence
from typing import Any

# Rows of a long table that a notebook shows.
_SHOWN = 12


def page(head: str, header: Sequence[str], rows: Sequence[Sequence[Any]], sentences: Iterable[str] = ()) -> str:
    """A line of text, a table, and sentences under it; of a long table its first rows."""
    shown = rows if len(rows) <= _SHOWN + 1 else rows[:_SHOWN]
    titles = "".join(f"<th>{html.escape(title)}</th>" for title in header)
    body = "".join(f"<tr>{''.join(f'<td>{_cell(cell)}</td>' for cell in row)}</tr>" for row in shown)
    told = list(sentences)
    if len(shown) < len(rows):
        told.insert(0, f"and {len(rows) - len(shown)} more rows")
    said = "".join(f"<li>{html.escape(sentence)}</li>" for sentence in told)
    return f"<p>{html.escape(head)}</p><table><tr>{titles}</tr>{body}</table>" + (f"<ul>{said}</ul>" if said else "")


def _cell(cell: Any) -> str:
    """Nothing where there is nothing; numbers as far as they are read."""
    if cell is None or (isinstance(cell, float) and math.isnan(cell)):
        return ""
    return f"{cell:.4g}" if isinstance(cell, float) else html.escape(str(cell))
