"""Draws from the posterior of a fit."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _checks, _html, _pbrdf
from ._fitting import FitResult
from ._pbrdf import PbrdfError

PRIORS = ("normal", "uniform", "log-uniform")


class Summary(NamedTuple):
    """What the draws say of a parameter, in its own unit."""

    mean: float
    """Mean."""
    sd: float
    """Standard deviation."""
    q05: float
    """Quantile at 5 %."""
    q16: float
    """Quantile at 16 %."""
    q50: float
    """Median."""
    q84: float
    """Quantile at 84 %."""
    q95: float
    """Quantile at 95 %."""
    rhat: float | None
    """Rank-normalised split R̂; 1 is converged. None of too few draws."""
    ess_bulk: float | None
    """Effective number of draws for the bulk."""
    ess_tail: float | None
    """Effective number of draws for the tails."""


class Posterior:
    """Draws of all surfaces that a measurement allows."""

    def __init__(self, inner: _pbrdf.Drawn) -> None:
        *columns, self._log_posterior = (column.reshape(inner.shape) for column in inner.columns())
        self._draws: dict[str, NDArray[np.float64]] = dict(zip(inner.names, columns, strict=True))
        self._summary = {
            name: Summary(mean, sd, *quantiles, *(convergence or (None, None, None)))
            for name, (mean, sd, quantiles, convergence) in zip(inner.names, inner.summaries(), strict=True)
        }
        self._verdict, self._divergences, self._log_evidence = inner.verdict, inner.divergences, inner.log_evidence

    @property
    def draws(self) -> dict[str, NDArray[np.float64]]:
        """Draws of the free parameters by name, each of the shape (chains, draws)."""
        return self._draws

    @property
    def log_posterior(self) -> NDArray[np.float64]:
        """ln(likelihood × priors) of each draw, of the shape (chains, draws)."""
        return self._log_posterior

    @property
    def summary(self) -> dict[str, Summary]:
        """What the draws say of each free parameter."""
        return self._summary

    @property
    def verdict(self) -> str:
        """Whether the draws are to be trusted, in a sentence."""
        return self._verdict

    @property
    def divergences(self) -> int:
        """Transitions whose energy ran away; more than one in a thousand are too many."""
        return self._divergences

    @property
    def log_evidence(self) -> tuple[float, float] | None:
        """Natural logarithm of the evidence of the model, and its standard error; None of too few draws."""
        return self._log_evidence

    def to_arviz(self) -> Any:
        """As ``arviz.InferenceData``. Needs arviz."""
        import arviz  # type: ignore[import-not-found, unused-ignore]

        return arviz.from_dict(posterior=self.draws, sample_stats={"lp": self.log_posterior})

    def __str__(self) -> str:
        width = max(map(len, self.summary), default=0)
        lines = [f"  {name:<{width}} = {of.q50:.4g} ({of.q16:.4g} … {of.q84:.4g} at 68 %)" for name, of in self.summary.items()]
        return "\n".join([self.verdict, *lines])

    def __repr__(self) -> str:
        return f"<pbrdf.Posterior\n{self}\n>"

    def _repr_html_(self) -> str:
        rows = [(name, of.q50, of.q16, of.q84, of.rhat, of.ess_bulk) for name, of in self.summary.items()]
        return _html.page(self.verdict, ["parameter", "median", "16 %", "84 %", "R̂", "effective draws"], rows)


def posterior(
    result: FitResult,
    *,
    priors: Mapping[str, tuple[str, float, float]] | None = None,
    draws: int = 4000,
    chains: int = 4,
    seed: int = 1,
    progress: Callable[[float], object] | None = None,
) -> Posterior:
    """Draws from all surfaces that the data of a fit allow (no-U-turn sampler). Ctrl-C stops it.

    Args:
        result: The fit, of one measurement or of several: its data, free parameters and bounds are those of the posterior. One that comes from
            another process is fitted again first.
        priors: By name ``("normal", mean, sd)``, ``("uniform", low, high)`` or ``("log-uniform", low, high)``; the others are equally likely within
            the bounds of the fit.
        draws: Draws of each chain after the warm-up, at least 100.
        chains: Chains, at least 1.
        seed: The draws depend on it alone, not on the number of threads.
        progress: Called with the share that is done, 0 to 1.

    Raises:
        PbrdfError: A prior is none or on a parameter that is not free, nothing is free or measured, the fit has a robust loss.

    >>> from pbrdf import Measurement, fit
    >>> data = Measurement([30, 40, 50, 60, 60, 70], [40, 40, 50, 60, 70, 70], dolp=[.127, .166, .268, .398, .466, .525])
    >>> sample = posterior(fit(data, model="specular", starts=1), draws=200, priors={"k": ("normal", 2.9, 0.5)})
    >>> sample.draws["n"].shape
    (4, 200)
    """
    if not isinstance(result, FitResult):
        raise PbrdfError("result: expected a FitResult, as fit returns it")
    if progress is not None and not callable(progress):
        raise PbrdfError("progress: expected a function of the share that is done")
    request = SimpleNamespace(
        priors=[(name, _prior(name, value)) for name, value in _checks.items("priors", priors)],
        draws=_checks.whole("draws", draws, 1),
        chains=_checks.whole("chains", chains, 1),
        seed=_checks.whole("seed", seed, 0),
    )
    return Posterior(_pbrdf.posterior(result._fitted(), request, progress))


def _prior(name: str, value: Any) -> tuple[str, float, float]:
    if not (isinstance(value, (tuple, list)) and len(value) == 3 and value[0] in PRIORS):
        raise PbrdfError(f'priors[{name!r}] is {value!r}; expected ("normal", mean, sd), ("uniform", low, high) or ("log-uniform", low, high)')
    return value[0], _checks.number(f"priors[{name!r}]", value[1]), _checks.number(f"priors[{name!r}]", value[2])
