"""Speed beside numba and SciPy, all in one run: python benches/compare.py [--points 10000000] [--fits 10000] [--dask]

One thread where single speeds are compared (the script starts itself again with RAYON_NUM_THREADS=1 for that). Needs numba and scipy, and
distributed for --dask.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import sys
import time

import numpy as np

import pbrdf

SURFACE = {"n": 2.07, "k": 2.9, "sigma": 0.35, "ks": 1.0, "kd": 0.12, "kv": 0.2, "q": 2.2, "c": -0.4, "sigma_v": 0.6}
NAMES = ["n", "k", "sigma", "kd", "kv", "q", "c", "sigma_v"]
# The bounds and the start of the program.
LOW = [0.01, 0.0, 0.001, 0.0, 0.0, 1.0001, -1.0, 0.01]
HIGH = [10.0, 20.0, 3.0, 10.0, 10.0, 20.0, 0.0, 3.0]
START = [2.0, 3.0, 0.3, 0.1, 0.1, 2.0, -0.5, 0.5]


def kernels():
    """BRDF and DoLP of the Cauchy model as somebody would write them for numba: a loop of textbook formulas in f64."""
    import numba

    @numba.njit(error_model="numpy")
    def values(p, theta_i, theta_r, dphi, brdf, dolp):
        n, k, sigma, ks, kd, kv, q, c, sigma_v = p
        for j in range(theta_i.size):
            ti, tr, f = math.radians(theta_i[j]), math.radians(theta_r[j]), math.radians(dphi[j])
            ci, cr, si, sr = math.cos(ti), math.cos(tr), math.sin(ti), math.sin(tr)
            cos_beta = math.sqrt(max(0.0, 0.5 * (1.0 + ci * cr + si * sr * math.cos(f))))
            cos_alpha = (ci + cr) / (2.0 * cos_beta)
            tan_sq = max(0.0, 1.0 / (cos_alpha * cos_alpha) - 1.0)
            s2 = 2.0 * sigma * sigma
            density = (q - 1.0) * s2 ** (q - 1.0) / (math.pi * cos_alpha**3 * (tan_sq + s2) ** q)
            masking = min(1.0, 2.0 * cos_alpha * cr / cos_beta, 2.0 * cos_alpha * ci / cos_beta)
            sin_sq = 1.0 - cos_beta * cos_beta
            a, b = n * n - k * k - sin_sq, 2.0 * n * k
            length = math.sqrt(a * a + b * b)
            u, v = math.sqrt(0.5 * (length + a)), math.sqrt(max(0.0, 0.5 * (length - a)))
            rs = ((cos_beta - u) ** 2 + v * v) / ((cos_beta + u) ** 2 + v * v)
            st = sin_sq / cos_beta
            rp = rs * ((u - st) ** 2 + v * v) / ((u + st) ** 2 + v * v)
            geometric = density * masking / (4.0 * cos_alpha * ci * cr)
            specular = ks * geometric * 0.5 * (rs + rp)
            polarised = ks * geometric * 0.5 * (rs - rp)
            rest = kd * (ci * cr) ** c / math.pi + kv * math.exp(-tr * tr / (2.0 * sigma_v * sigma_v)) / (math.sqrt(2.0 * math.pi) * sigma_v)
            brdf[j] = specular + rest
            dolp[j] = polarised / brdf[j]

    return values


def median(run, times=5):
    """The median time of some runs in seconds."""
    spent = []
    for _ in range(times):
        begun = time.perf_counter()
        run()
        spent.append(time.perf_counter() - begun)
    return float(np.median(spent))


def evaluations(points):
    """Evaluation on one thread."""
    random = np.random.default_rng(1)
    theta_i, theta_r, dphi = random.uniform(0, 85, points), random.uniform(0, 85, points), random.uniform(0, 360, points)
    values = kernels()
    p = tuple(SURFACE.values())
    brdf, dolp = np.empty(points), np.empty(points)
    values(p, theta_i[:10], theta_r[:10], dphi[:10], brdf[:10], dolp[:10])
    by_numba = median(lambda: values(p, theta_i, theta_r, dphi, brdf, dolp), 3)
    ours = pbrdf.evaluate("cauchy", SURFACE, theta_i, theta_r, dphi)
    apart = float(np.max(np.abs(ours.brdf / brdf - 1)))
    whole = median(lambda: pbrdf.evaluate("cauchy", SURFACE, theta_i, theta_r, dphi), 3)
    few = min(points, 1_000_000)
    prepared = pbrdf.prepare(theta_i[:few], theta_r[:few], dphi[:few])
    again = median(lambda: prepared.evaluate("cauchy", SURFACE)) / few
    return {
        "points": points,
        "numba_ns": 1e9 * by_numba / points,
        "evaluate_ns": 1e9 * whole / points,
        "prepared_ns": 1e9 * again,
        "times_numba": by_numba / whole,
        "brdf_apart": apart,
    }


def measurements(count):
    """Sets of 27 points on steel, each with noise of its own."""
    angles = ([30.0, 40.0, 50.0], np.arange(20.0, 61.0, 5.0))
    return [pbrdf.simulate("cauchy", SURFACE, *angles, noise=0.005, seed=seed).renamed(f"{seed:06}") for seed in range(count)]


def by_scipy(data):
    """Seconds a fit by SciPy, from the same start in the same box, with residuals by numba; its ΔE too."""
    from scipy.optimize import least_squares

    values = kernels()
    objectives = []

    def one(item):
        theta_i, theta_r, dphi, measured = item.theta_i, item.theta_r, item.dphi, item.dolp
        brdf, dolp = np.empty(len(measured)), np.empty(len(measured))
        norm = np.sqrt(np.sum(measured**2))

        def residuals(x):
            n, k, sigma, kd, kv, q, c, sigma_v = x
            values((n, k, sigma, 1.0, kd, kv, q, c, sigma_v), theta_i, theta_r, dphi, brdf, dolp)
            return (dolp - measured) / norm

        objectives.append(2.0 * least_squares(residuals, START, bounds=(LOW, HIGH), x_scale=np.maximum(np.abs(START), 0.1)).cost)

    one(data[0])
    objectives.clear()
    begun = time.process_time()
    for item in data:
        one(item)
    return (time.process_time() - begun) / len(data), objectives


def fits(count):
    """Fits of many small sets, one start and linear errors."""
    data = measurements(count)
    options = {"fix": {"ks": 1.0}, "starts": 1, "intervals": "linear"}
    pbrdf.map_fits(data[:50], **options)
    begun = time.perf_counter()
    table = pbrdf.map_fits(data, **options)
    spent = time.perf_counter() - begun
    some = data[: min(count, 100)]
    scipy, objectives = by_scipy(some)
    ours = table["objective"][: len(some)]
    return {
        "fits": count,
        "ms_a_fit": 1e3 * spent / count,
        "scipy_ms_a_fit": 1e3 * scipy,
        "times_scipy": scipy * count / spent,
        "scipy_lower_by_1_percent": int(np.sum(np.array(objectives) < 0.99 * ours)),
        "ours_lower_by_1_percent": int(np.sum(ours < 0.99 * np.array(objectives))),
        "of": len(some),
    }


def on_dask(count):
    """The same on a local Dask cluster of two processes."""
    from distributed import Client, LocalCluster

    data = measurements(count)
    options = {"fix": {"ks": 1.0}, "starts": 1, "intervals": "linear"}
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster, Client(cluster) as client:
        pbrdf.map_fits(data[:50], client=client, **options)
        begun = time.perf_counter()
        pbrdf.map_fits(data, client=client, **options)
        return {"fits": count, "dask_ms_a_fit": 1e3 * (time.perf_counter() - begun) / count}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=10_000_000)
    parser.add_argument("--fits", type=int, default=10_000)
    parser.add_argument("--dask", action="store_true")
    parser.add_argument("--alone", choices=["evaluations", "fits"], help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.alone:
        print(json.dumps(evaluations(arguments.points) if arguments.alone == "evaluations" else fits(arguments.fits)))
        return
    for alone in ("evaluations", "fits"):
        command = [sys.executable, __file__, "--alone", alone, "--points", str(arguments.points), "--fits", str(arguments.fits)]
        subprocess.run(command, check=True, env={**os.environ, "RAYON_NUM_THREADS": "1"})
    if arguments.dask:
        print(json.dumps(on_dask(arguments.fits)))


if __name__ == "__main__":
    main()
