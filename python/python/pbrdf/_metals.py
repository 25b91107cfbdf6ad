"""Tabulated refractive indices of metals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _checks, _pbrdf
from ._pbrdf import PbrdfError


@dataclass(frozen=True, repr=False, eq=False)
class MetalSource:
    """One published table of the refractive index n + i k of a metal or an alloy."""

    metal: str
    """Chemical symbol, or the name of the alloy."""
    name: str
    """The metal in words."""
    source: str
    """Short name of the source, unique within the metal."""
    authors: str
    """Authors and year."""
    citation: str
    """Where it was published."""
    comment: str
    """What is said of sample and method; may be empty."""
    wavelength_nm: NDArray[np.float64]
    """Vacuum wavelengths in nm, ascending."""
    n: NDArray[np.float64]
    """Real part at each of them."""
    k: NDArray[np.float64]
    """Imaginary part at each of them."""

    def index_at(self, wavelength_nm: ArrayLike) -> tuple[Any, Any]:
        """n and k at vacuum wavelengths in nm, linear between neighbours; each with the shape of the wavelengths.

        Raises:
            PbrdfError: A wavelength lies outside the table, or is NaN.

        >>> n, k = metals("Cu")[0].index_at([600, 650])
        >>> n.shape
        (2,)
        """
        wavelengths = _checks.numbers("wavelength_nm", wavelength_nm)
        low, high = self.wavelength_nm[0], self.wavelength_nm[-1]
        outside = wavelengths[~((wavelengths >= low) & (wavelengths <= high))]
        if outside.size:
            raise PbrdfError(f"{outside.flat[0]:g} nm is outside the tabulated range, {low:g} to {high:g} nm")
        return np.interp(wavelengths, self.wavelength_nm, self.n)[()], np.interp(wavelengths, self.wavelength_nm, self.k)[()]

    def __repr__(self) -> str:
        return f"<pbrdf.MetalSource {self.metal}/{self.source}: {self.wavelength_nm[0]:g} to {self.wavelength_nm[-1]:g} nm, {self.authors}>"


def metals(name: str | None = None) -> list[MetalSource]:
    """The tables of a metal, source by source, by its symbol or its name; without a name those of all.

    Raises:
        PbrdfError: There is no such metal.

    >>> sorted({source.metal for source in metals()})[:3]
    ['Ag', 'Al', 'Au']
    """
    rows = _pbrdf.metals(None if name is None else _checks.word("name", name))
    return [MetalSource(*texts, wavelength_nm, n, k) for texts, (wavelength_nm, n, k) in rows]
