#!/usr/bin/env python3
"""Makes stability_gallery.csv: the named stiff and extreme cases of `report stability`, to 60 digits.

    pip install mpmath==1.3.0
    python3 core/assets/reference/make_stability_gallery.py > core/assets/reference/stability_gallery.csv

Values and one-sided derivatives come from make_corner_rows.py: the textbook forms in 520-digit arithmetic, nothing of which is
shared with the program.
"""
from math import nextafter

from make_corner_rows import NAMES, derivatives, evaluate, text
from mpmath import mpf

DEFAULTS = dict(n=2, k=3, sigma=0.3, ks=1, kd=0.1, kv=0.1, q=2, c=-0.5, sigma_v=0.5, theta_i=40, theta_r=55, dphi=180)
EDGE = 90 - 1e-6
LAST = nextafter(90.0, 0.0)

CASES = [
    ("ordinary metal", "both", {}),
    ("ordinary metal, out of plane", "both", dict(dphi=120)),
    ("normal incidence, normal view", "both", dict(theta_i=0, theta_r=0)),
    ("normal incidence, oblique view", "cauchy", dict(theta_i=0)),
    ("near normal, 0.0001°", "cauchy", dict(theta_i=1e-4, theta_r=2e-4)),
    ("near normal, 1e-8°", "cauchy", dict(theta_i=1e-8, theta_r=3e-8, dphi=75)),
    ("view along incidence", "cauchy", dict(theta_i=45, theta_r=45, dphi=0)),
    ("view along incidence but for 1e-9°", "cauchy", dict(theta_i=45, theta_r=45 + 1e-9, dphi=1e-9)),
    ("mirror direction", "both", dict(theta_i=60, theta_r=60)),
    ("mirror direction but for 1e-9°", "gauss", dict(theta_i=60, theta_r=60 + 1e-9, sigma=0.001)),
    ("grazing incidence, 90° − 1e-6°", "both", dict(theta_i=EDGE)),
    ("grazing view, 90° − 1e-6°", "cauchy", dict(theta_r=EDGE)),
    ("both grazing, forward", "cauchy", dict(theta_i=EDGE, theta_r=EDGE)),
    ("both grazing, forward, smooth", "gauss", dict(theta_i=EDGE, theta_r=89.999, sigma=0.01)),
    ("both grazing, out of plane", "cauchy", dict(theta_i=EDGE, theta_r=EDGE, dphi=90)),
    ("both grazing, backwards", "cauchy", dict(theta_i=EDGE, theta_r=EDGE, dphi=0)),
    ("last angles below 90°", "cauchy", dict(theta_i=LAST, theta_r=LAST)),
    ("σ = 1e-5 in the mirror direction", "both", dict(sigma=1e-5, theta_i=60, theta_r=60)),
    ("σ = 1e-5 a facet's width off", "both", dict(sigma=1e-5, theta_i=60, theta_r=60.001)),
    ("σ = 1e-5 far off", "both", dict(sigma=1e-5)),
    ("σ = 1000", "both", dict(sigma=1e3)),
    ("σ = 1e-30", "cauchy", dict(sigma=1e-30)),
    ("σ = 1e30", "both", dict(sigma=1e30, kd=1e-62, kv=1e-62)),
    ("q = 1.0001", "cauchy", dict(q=1.0001)),
    ("q = 1 + 1e-12", "cauchy", dict(q=1 + 1e-12)),
    ("q = 10000", "cauchy", dict(q=1e4)),
    ("q = 1e12, a facet's width off", "cauchy", dict(q=1e12, theta_i=60, theta_r=60.00001)),
    ("q = 10000, tilted facets", "cauchy", dict(q=1e4, theta_i=10, theta_r=70)),
    ("glass, k = 0", "both", dict(n=1.5, k=0)),
    ("glass at Brewster's angle", "cauchy", dict(n=1.5, k=0, theta_i=56.309932474020215, theta_r=56.309932474020215)),
    ("k = 1e-12", "cauchy", dict(n=1.5, k=1e-12)),
    ("n = 0.5, k = 0 below the critical angle", "cauchy", dict(n=0.5, k=0, theta_i=20, theta_r=25)),
    ("n = 0.5, k = 0 above the critical angle", "cauchy", dict(n=0.5, k=0, theta_i=50, theta_r=55)),
    ("n = 0.5, k = 0, 0.0001° below the critical angle", "cauchy", dict(n=0.5, k=0, theta_i=30, theta_r=29.9998)),
    ("n = 0.5, k = 0, 0.0001° above the critical angle", "cauchy", dict(n=0.5, k=0, theta_i=30, theta_r=30.0002)),
    ("n = 0.5, k = 1e-8, above the critical angle", "cauchy", dict(n=0.5, k=1e-8, theta_i=50, theta_r=55)),
    ("n = 1 + 1e-8, k = 0", "both", dict(n=1 + 1e-8, k=0)),
    ("n = 1 − 1e-8, k = 1e-8", "cauchy", dict(n=1 - 1e-8, k=1e-8)),
    ("n = 1, k = 1e-6", "cauchy", dict(n=1, k=1e-6)),
    ("n = 1, k = 0: no surface", "cauchy", dict(n=1, k=0)),
    ("n = 1 + 1e-8, k = 0, grazing", "cauchy", dict(n=1 + 1e-8, k=0, theta_i=89.9999, theta_r=89.9)),
    ("n = 0.000001, k = 20", "both", dict(n=1e-6, k=20)),
    ("n = 0, k = 3", "cauchy", dict(n=0, k=3)),
    ("n = 0.000001, k = 20, grazing", "cauchy", dict(n=1e-6, k=20, theta_i=EDGE, theta_r=89.9)),
    ("n = k = 1000", "cauchy", dict(n=1e3, k=1e3)),
    ("n = k = 1e10", "cauchy", dict(n=1e10, k=1e10)),
    ("k_s = 0", "both", dict(ks=0)),
    ("k_s = 1e-100", "cauchy", dict(ks=1e-100)),
    ("k_s = 1e100", "cauchy", dict(ks=1e100)),
    ("all weights 1e-100", "cauchy", dict(ks=1e-100, kd=1e-100, kv=1e-100)),
    ("no light at all", "cauchy", dict(ks=0, kd=0, kv=0)),
    ("k_d = k_v = 0", "both", dict(kd=0, kv=0)),
    ("specular term underflows", "gauss", dict(sigma=0.01, theta_i=10, theta_r=70)),
    ("specular term underflows, nothing else there", "gauss", dict(sigma=0.01, theta_i=10, theta_r=70, kd=0, kv=0)),
    ("specular and volume term underflow, e^−1000", "gauss", dict(sigma=0.01043, sigma_v=0.02341, kd=0, theta_i=10, theta_r=60)),
    ("specular and volume term underflow, e^−10000", "gauss", dict(sigma=0.0032973, sigma_v=0.0074045, kd=0, theta_i=10, theta_r=60)),
    ("specular and volume term underflow, e^−1000000", "gauss", dict(sigma=0.00032973, sigma_v=0.000740479, kd=0, theta_i=10, theta_r=60)),
    ("specular and volume term underflow, q = 10000", "cauchy", dict(sigma=0.7007954, sigma_v=0.016557, q=1e4, kd=0, theta_i=10, theta_r=60)),
    ("σ_v = 0.01 rad", "cauchy", dict(sigma_v=0.01)),
    ("σ_v = 0.001 rad, k_d = 0", "cauchy", dict(sigma_v=0.001, kd=0)),
    ("σ_v = 1e-30 rad", "cauchy", dict(sigma_v=1e-30)),
    ("σ_v = 1000 rad", "cauchy", dict(sigma_v=1e3)),
    ("σ_v = 1e30 rad", "cauchy", dict(sigma_v=1e30)),
    ("c = −1", "cauchy", dict(c=-1)),
    ("c = −1, both grazing", "cauchy", dict(c=-1, theta_i=EDGE, theta_r=EDGE)),
    ("c = 0", "cauchy", dict(c=0)),
    ("c = 0, both grazing", "cauchy", dict(c=0, theta_i=EDGE, theta_r=EDGE)),
    ("c = −1000", "cauchy", dict(c=-1e3, theta_i=10, theta_r=15)),
    ("c = 1000", "cauchy", dict(c=1e3, theta_i=10, theta_r=15)),
    ("faint depolarising terms, k_d = k_v = 1e-50", "gauss", dict(kd=1e-50, kv=1e-50, sigma=0.0301, theta_i=10, theta_r=60)),
]


def main():
    print("# 60-digit values and derivatives of the stability gallery; made by make_stability_gallery.py (mpmath), 2026-11-29")
    header = ["case", "distribution", *NAMES, "theta_i", "theta_r", "dphi", "brdf", "dolp", "specular", "diffuse", "volume"]
    header += ["dbrdf_d" + name for name in NAMES] + ["ddolp_d" + name for name in NAMES]
    print(",".join(header))
    for name, which, changes in CASES:
        case = {key: float(value) for key, value in {**DEFAULTS, **changes}.items()}
        p = [mpf(case[x]) for x in NAMES]
        geometry = [case[x] for x in ("theta_i", "theta_r", "dphi")]
        for dist in ("gauss", "cauchy") if which == "both" else (which,):
            slopes = derivatives(dist, p, geometry)
            if (p[3] == 0 or (p[0] == 1 and p[1] == 0)) and p[4] == 0 and p[5] == 0:
                slopes[1] = [mpf(0)] * 9
            row = [f'"{name}"', dist, *(repr(case[x]) for x in NAMES), *(repr(x) for x in geometry)]
            row += [text(x) for x in evaluate(dist, p, *geometry)] + [text(x) for x in slopes[0]] + [text(x) for x in slopes[1]]
            print(",".join(row))


if __name__ == "__main__":
    main()
