"""Effective draws a second beside emcee, in one run: python benches/posterior.py [--steps 20000]

Both draw from the same posterior: stated noise, every value within the bounds of the program equally likely. emcee 3 (affine-invariant ensemble,
32 walkers) has the model compiled by numba; its effective draws are walkers × steps / autocorrelation time of the worst parameter. pbrdf's are
those of the worst parameter in the bulk (rank-normalised). Seconds of the clock: pbrdf uses all cores, emcee one. Needs emcee and numba.
"""

from __future__ import annotations

import argparse
import time

import compare
import emcee
import numpy as np

import pbrdf

NOISE = 0.005
GRIDS = {
    "dense, 144 points": (np.arange(10.0, 81.0, 10.0), np.arange(0.0, 86.0, 5.0)),
    "steel, 27 points": (np.array([30.0, 40.0, 50.0]), np.arange(20.0, 61.0, 5.0)),
}
WALKERS = 32


def by_pbrdf(data):
    """Seconds and effective draws, the fit included."""
    begun = time.perf_counter()
    sample = pbrdf.posterior(pbrdf.fit(data, model="cauchy", weights="sigma"))
    seconds = time.perf_counter() - begun
    return seconds, min(of.ess_bulk for of in sample.summary.values()), sample


def by_emcee(data, steps):
    """Seconds, effective draws and chain; the walkers begin around the truth and the first fifth is left out."""
    values = compare.kernels()
    low, high = np.array(compare.LOW), np.array(compare.HIGH)
    theta_i, theta_r, dphi, measured = data.theta_i, data.theta_r, data.dphi, data.dolp
    brdf, dolp = np.empty(len(measured)), np.empty(len(measured))

    def log_posterior(x):
        if np.any(x < low) or np.any(x > high):
            return -np.inf
        n, k, sigma, kd, kv, q, c, sigma_v = x
        values((n, k, sigma, 1.0, kd, kv, q, c, sigma_v), theta_i, theta_r, dphi, brdf, dolp)
        return -0.5 * float(np.sum(((dolp - measured) / NOISE) ** 2))

    truth = np.array([compare.SURFACE[name] for name in compare.NAMES])
    random = np.random.default_rng(1)
    start = np.clip(truth * (1.0 + 0.01 * random.standard_normal((WALKERS, truth.size))), low + 1e-6, high - 1e-6)
    log_posterior(truth)
    sampler = emcee.EnsembleSampler(WALKERS, truth.size, log_posterior)
    begun = time.perf_counter()
    sampler.run_mcmc(start, steps)
    seconds = time.perf_counter() - begun
    first = steps // 5
    tau = float(np.max(sampler.get_autocorr_time(discard=first, tol=0)))
    return seconds, WALKERS * (steps - first) / tau, sampler.get_chain(discard=first, flat=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--steps", type=int, default=20_000, help="steps of each walker of emcee")
    steps = parser.parse_args().steps
    print("| data | sampler | seconds | effective draws | per second | median of n |\n|---|---|---|---|---|---|")
    for name, (theta_i, theta_r) in GRIDS.items():
        data = pbrdf.simulate("cauchy", compare.SURFACE, theta_i, theta_r, noise=NOISE, seed=1)
        seconds, effective, sample = by_pbrdf(data)
        print(f"| {name} | pbrdf | {seconds:.1f} | {effective:.0f} | {effective / seconds:.0f} | {sample.summary['n'].q50:.3f} |", flush=True)
        seconds, effective, chain = by_emcee(data, steps)
        print(f"| {name} | emcee | {seconds:.1f} | {effective:.0f} | {effective / seconds:.0f} | {np.median(chain[:, 0]):.3f} |", flush=True)


if __name__ == "__main__":
    main()
