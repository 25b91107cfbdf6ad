"""A sphere of one megapixel under three lamps: python benches/megapixel.py [SIZE [SEED]]

Simulated with noise of 0.005 of S0 in each Stokes component and one unknown scale of the radiance; says which of the determined parameters
lie within their 95 % intervals, the time, and the most memory.
"""

from __future__ import annotations

import resource
import sys
import time

import numpy as np

import pbrdf

LAMPS = [(20.0, 90.0), (60.0, 200.0), (100.0, 330.0)]
SURFACE = {"n": 2.07, "k": 2.9, "sigma": 0.35, "kd": 0.15, "kv": 0.05, "q": 2.2, "c": -0.4, "sigma_v": 0.6}
SCALE = 37.0


def main():
    size = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    random = np.random.default_rng(int(sys.argv[2]) if len(sys.argv) > 2 else 1)
    stokes = np.empty((len(LAMPS), 3, size, size))
    for number, lamp in enumerate(LAMPS):
        seen = pbrdf.picture("cauchy", SURFACE, lamp=lamp, size=size)
        stokes[number] = SCALE * (seen.stokes + 0.005 * seen.s0 * random.standard_normal((3, size, size)))
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    begun, busy = time.perf_counter(), time.process_time()
    found = pbrdf.fit_pixels(stokes, pbrdf.sphere((size, size), center=((size - 1) / 2,) * 2, radius=size / 2), LAMPS)
    spent, busy = time.perf_counter() - begun, time.process_time() - busy
    print(found)
    truth = {**SURFACE, "ks": SCALE, "kd": SCALE * SURFACE["kd"], "kv": SCALE * SURFACE["kv"]}
    for name, estimate in found.parameters.items():
        if estimate.determined:
            low, high = estimate.interval95
            verdict = "within" if low <= truth[name] <= high else "OUTSIDE"
            print(f"{name}: {low:.6g} … {high:.6g}, truth {truth[name]:.6g}: {verdict}")
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    print(f"{found.used.sum()} pixels, {spent:.1f} s ({busy:.1f} s of processor), {most / 2**20:.2f} GiB at most ({before / 2**20:.2f} GiB before the fit)")


if __name__ == "__main__":
    main()
