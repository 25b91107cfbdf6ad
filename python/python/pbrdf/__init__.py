"""Polarimetric microfacet BRDF of metal surfaces: values, Mueller matrices, derivatives, and fits that say what the data determine.

The model is that of F. Wang et al., Acta Optica Sinica 41(11), 1129002 (2021), doi 10.3788/AOS202141.1129002, and its special cases.

>>> import pbrdf
>>> surface = {"n": 2.07, "k": 2.9, "kd": 0.1, "kv": 0.05}
>>> values = pbrdf.evaluate("cauchy", surface, theta_i=60, theta_r=[30, 50, 60])
>>> values.dolp.shape
(3,)
>>> data = pbrdf.Measurement([30, 40, 50, 60, 60, 70], [40, 40, 50, 60, 70, 70], dolp=[.127, .166, .268, .398, .466, .525])
>>> result = pbrdf.fit(data, model="specular", fix={"ks": 1.0}, start={"k": 3.0}, starts=1)
>>> print(result.parameters["n"])
2.080 ± 0.018

Angles are in degrees: zenith angles ``theta_i`` of incidence and ``theta_r`` of view, 0 ≤ θ < 90, and ``dphi`` = φr − φi, 180 on the
forward side. A negative ``theta_r`` is the backscatter side of the plane of incidence (``dphi`` is 180 then). BRDF is in sr⁻¹, DoLP from 0
to 1. What is refused raises :class:`PbrdfError` with one sentence that says why and what helps.
"""

from __future__ import annotations

from . import _docs
from ._angles import Evaluation, Geometries, evaluate, prepare
from ._fitting import Correlations, Estimate, FitResult, Minimum, SetResult, fit
from ._many import FitTable, map_fits
from ._measurement import Measurement, read, read_all
from ._metals import MetalSource, metals
from ._pbrdf import PbrdfError, __version__
from ._picture import Picture, picture
from ._pixels import Body, PixelFit, cylinder, fit_pixels, sphere
from ._planning import AngleChoice, choose_angles, simulate
from ._posterior import Posterior, Summary, posterior
from ._tables import ModelInfo, ParameterInfo, models, parameters

__all__ = [
    "AngleChoice",
    "Body",
    "Correlations",
    "Estimate",
    "Evaluation",
    "FitResult",
    "FitTable",
    "Geometries",
    "Measurement",
    "MetalSource",
    "Minimum",
    "ModelInfo",
    "ParameterInfo",
    "PbrdfError",
    "Picture",
    "PixelFit",
    "Posterior",
    "SetResult",
    "Summary",
    "__version__",
    "choose_angles",
    "cylinder",
    "evaluate",
    "fit",
    "fit_pixels",
    "map_fits",
    "metals",
    "models",
    "parameters",
    "picture",
    "posterior",
    "prepare",
    "read",
    "read_all",
    "simulate",
    "sphere",
]

_docs.describe(found for found in list(globals().values()) if isinstance(found, type))
