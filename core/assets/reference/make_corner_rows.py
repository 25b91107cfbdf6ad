#!/usr/bin/env python3
"""Makes golden_corners.csv: values and one-sided derivatives at the corners and ends of the domain, to 60 digits.

    pip install mpmath==1.3.0
    python3 core/assets/reference/make_corner_rows.py > core/assets/reference/golden_corners.csv

Straight from the textbook forms (Eqs. 2, 4-7, 10, 12-14, 17 with k_s inside the numerator) in 520-digit arithmetic;
nothing here is shared with the program. Derivatives are differences of 520-digit values: central where the parameter is
inside its domain, forward at n, k, k_s, k_d, k_v = 0. A derivative beyond f64 is printed as inf.
"""
import random

from mpmath import atan, cos, exp, inf, mp, mpc, mpf, nstr, pi, re, sin, sqrt

mp.dps = 520
NAMES = ["n", "k", "sigma", "ks", "kd", "kv", "q", "c", "sigma_v"]


def evaluate(dist, p, ti, tr, dphi):
    n, k, sigma, ks, kd, kv, q, c, sigma_v = p
    ti, tr, dphi = (mpf(x) * pi / 180 for x in (ti, tr, dphi))
    cos2b = cos(ti) * cos(tr) + sin(ti) * sin(tr) * cos(dphi)
    cb = sqrt((1 + cos2b) / 2)
    s2 = (1 - cos2b) / 2
    if s2 < mpf(10) ** -500:
        s2 = mpf(0)
    ca = (cos(ti) + cos(tr)) / (2 * cb)
    t2 = max(mpf(0), 1 / ca**2 - 1)
    a = sqrt(mpc(n, k) ** 2 - s2)
    if re(a) < 0:
        a = -a
    nn = mpc(n, k) ** 2
    rs2 = abs((cb - a) / (cb + a)) ** 2
    rp2 = abs((nn * cb - a) / (nn * cb + a)) ** 2
    if dist == "gauss":
        P = exp(-t2 / (2 * sigma**2)) / (2 * pi * sigma**2 * ca**3)
    else:
        P = (q - 1) * (sqrt(mpf(2)) * sigma) ** (2 * q - 2) / (pi * ca**3 * (t2 + 2 * sigma**2) ** q)
    G = min(mpf(1), 2 * ca * cos(tr) / cb, 2 * ca * cos(ti) / cb)
    shape = P * G / (4 * ca * cos(ti) * cos(tr))
    spec = ks * shape * (rs2 + rp2) / 2
    diff = kd * (cos(ti) * cos(tr)) ** c / pi
    vol = kv * exp(-(tr**2) / (2 * sigma_v**2)) / (sqrt(2 * pi) * sigma_v)
    total = spec + diff + vol
    polarised = ks * shape * abs(rs2 - rp2) / 2
    if total == 0:
        dolp = mpf(0)
    else:
        dolp = polarised / total
    return total, dolp, spec, diff, vol


def derivatives(dist, p, geometry):
    out = [[], []]
    for j, name in enumerate(NAMES):
        one_sided = p[j] == 0 and name in ("n", "k", "ks", "kd", "kv")
        h = mpf(10) ** -40 * (abs(p[j]) or mpf(10) ** -6)
        if name == "q":
            h = mpf(10) ** -40 * (p[j] - 1)
        if one_sided:
            # Far below the smallest weight, 1e-100.
            h = mpf(10) ** -400

        def at(x):
            moved = list(p)
            moved[j] = x
            return evaluate(dist, moved, *geometry)[:2]

        if one_sided:
            # Second-order forward difference.
            f0, f1, f2 = at(p[j]), at(p[j] + h), at(p[j] + 2 * h)
            pair = [(-3 * f0[i] + 4 * f1[i] - f2[i]) / (2 * h) for i in (0, 1)]
        else:
            f1, f2 = at(p[j] - h), at(p[j] + h)
            pair = [(f2[i] - f1[i]) / (2 * h) for i in (0, 1)]
        for i in (0, 1):
            out[i].append(mpf(0) if dist == "gauss" and name == "q" else pair[i])
    return out


def cases():
    rng = random.Random(20211129002)

    def ordinary():
        return dict(n=rng.uniform(0.1, 4), k=rng.uniform(0.1, 8), sigma=rng.uniform(0.05, 1), ks=rng.uniform(0.2, 2),
                    kd=rng.uniform(0.01, 1), kv=rng.uniform(0.01, 1), q=rng.uniform(1.2, 6), c=rng.uniform(-1, 0),
                    sigma_v=rng.uniform(0.1, 1.5), ti=rng.uniform(1, 85), tr=rng.uniform(1, 85), dphi=rng.choice([0, 180, rng.uniform(0, 360)]))

    corners = {
        "k_zero": lambda: dict(k=0.0, n=rng.uniform(1.1, 4)),
        "k_zero_total_reflection": lambda: dict(k=0.0, n=rng.uniform(0.05, 0.4), ti=rng.uniform(60, 80), tr=rng.uniform(60, 80), dphi=180),
        "k_zero_below_critical": lambda: dict(k=0.0, n=rng.uniform(0.7, 0.95), ti=rng.uniform(5, 35), tr=rng.uniform(5, 35), dphi=180),
        "k_tiny": lambda: dict(k=10 ** rng.uniform(-12, -3)),
        "n_zero": lambda: dict(n=0.0),
        "n_tiny": lambda: dict(n=10 ** rng.uniform(-12, -2), k=rng.uniform(1, 20)),
        "index_near_one": lambda: dict(n=1 + rng.choice([-1, 1]) * 10 ** rng.uniform(-10, -2), k=rng.choice([0.0, 10 ** rng.uniform(-12, -3)])),
        "index_near_one_grazing": lambda: dict(n=1 + 10 ** rng.uniform(-10, -4), k=0.0, ti=89.9999, tr=rng.uniform(88, 89.99), dphi=180),
        "index_one": lambda: dict(n=1.0, k=0.0),
        "normal": lambda: dict(ti=0.0, tr=0.0),
        "normal_in": lambda: dict(ti=0.0),
        "normal_out": lambda: dict(tr=0.0),
        "near_normal": lambda: dict(ti=10 ** rng.uniform(-9, -1), tr=10 ** rng.uniform(-9, -1)),
        "near_retro": lambda: (lambda t: dict(ti=t, tr=t + rng.choice([0.0, 1e-12, 1e-6]), dphi=rng.choice([0.0, 1e-9, 1e-5])))(rng.uniform(1, 85)),
        "grazing": lambda: dict(ti=90 - 10 ** rng.uniform(-6, -1), tr=90 - 10 ** rng.uniform(-6, -1)),
        "grazing_in": lambda: dict(ti=90 - 10 ** rng.uniform(-6, -1)),
        "c_edges": lambda: dict(c=rng.choice([0.0, -1.0])),
        "kd_zero": lambda: dict(kd=0.0),
        "kv_zero": lambda: dict(kv=0.0),
        "no_depolarised": lambda: dict(kd=0.0, kv=0.0),
        "ks_zero": lambda: dict(ks=0.0),
        "ks_smallest": lambda: dict(ks=10 ** rng.uniform(-100, -90), kd=rng.choice([0.0, 1e-100]), kv=rng.choice([0.0, 1e-98])),
        "specular_underflow": lambda: dict(sigma=10 ** rng.uniform(-5, -2)),
        "specular_underflow_alone": lambda: dict(sigma=10 ** rng.uniform(-5, -2), kd=0.0, kv=0.0),
        "volume_underflow": lambda: dict(sigma_v=10 ** rng.uniform(-4, -2)),
        "both_underflow": lambda: (lambda s: dict(sigma=s, sigma_v=s * rng.uniform(0.9, 3), kd=0.0, tr=rng.uniform(10, 60)))(10 ** rng.uniform(-2.5, -0.8)),
        "sigma_huge": lambda: dict(sigma=10 ** rng.uniform(1, 3)),
        "sigma_at_its_ends": lambda: dict(sigma=rng.choice([1e-30, 1e30])),
        "sigma_v_huge": lambda: dict(sigma_v=10 ** rng.uniform(1, 3)),
        "sigma_v_at_its_ends": lambda: dict(sigma_v=rng.choice([1e-30, 1e30])),
        "q_near_one": lambda: dict(q=1 + 10 ** rng.uniform(-12, -2)),
        "q_huge": lambda: dict(q=10 ** rng.uniform(1, 4)),
        "q_at_its_end": lambda: (lambda t: dict(q=1e12, ti=t, tr=t + 10 ** rng.uniform(-7, -4), dphi=180))(rng.uniform(5, 80)),
        "c_at_its_ends": lambda: dict(c=rng.choice([-1e3, 1e3]), ti=rng.uniform(1, 18), tr=rng.uniform(1, 18)),
        "brewster": lambda: (lambda n: (lambda t: dict(n=n, k=0.0, ti=t, tr=t, dphi=180))(float(180 * atan(n) / pi)))(rng.uniform(1.1, 4)),
        "faint_weights_in_the_dark": lambda: dict(sigma=10 ** rng.uniform(-2.2, -1.2), kd=10 ** rng.uniform(-100, -60), kv=0.0),
        "no_specular_and_no_volume_to_speak_of": lambda: dict(ks=0.0, kd=0.0, sigma_v=10 ** rng.uniform(-4, -2.5), tr=rng.uniform(20, 80)),
        "volume_absent": lambda: dict(kv=0.0, sigma_v=1e-30, tr=0.0),
        "glaring_weights": lambda: dict(ks=10 ** rng.uniform(60, 100), kd=10 ** rng.uniform(60, 100), kv=10 ** rng.uniform(60, 100)),
        "weights_at_their_ends": lambda: dict(ks=rng.choice([1e-100, 1e100]), kd=rng.choice([1e-100, 1e100]), kv=rng.choice([1e-100, 1e100])),
        "index_huge": lambda: dict(n=10 ** rng.uniform(3, 10), k=10 ** rng.uniform(3, 10)),
        "index_tiny": lambda: dict(n=10 ** rng.uniform(-300, -20), k=rng.choice([0.0, 10 ** rng.uniform(-300, -20)])),
    }
    for name, corner in corners.items():
        for _ in range(12):
            case = ordinary()
            case.update(corner())
            if name == "k_zero_below_critical":
                case["ti"], case["tr"] = min(case["ti"], 35), min(case["tr"], 35)
            yield name, rng.choice(["gauss", "cauchy"]), case


def text(x):
    x = mpf(x)
    if abs(x) > mpf("1.797e308"):
        return "inf" if x > 0 else "-inf"
    return nstr(x, 20, min_fixed=0, max_fixed=0) if abs(x) > mpf(10) ** -330 else "0.0"


def main():
    print("# 60-digit values and derivatives at the corners of the domain; made by make_corner_rows.py (mpmath), 2026-11-29")
    header = ["case", "distribution", *NAMES, "theta_i", "theta_r", "dphi", "brdf", "dolp", "specular", "diffuse", "volume"]
    header += ["dbrdf_d" + name for name in NAMES] + ["ddolp_d" + name for name in NAMES]
    print(",".join(header))
    for name, dist, case in cases():
        values = [float(case[x]) for x in NAMES]
        geometry = [float(case[x]) for x in ("ti", "tr", "dphi")]
        p = [mpf(x) for x in values]
        result = evaluate(dist, p, *geometry)
        slopes = derivatives(dist, p, geometry)
        dark = (p[3] == 0 or (p[0] == 1 and p[1] == 0)) and p[4] == 0 and p[5] == 0
        if dark:
            slopes[1] = [mpf(0)] * 9
        row = [name, dist, *(repr(x) for x in values), *(repr(x) for x in geometry)]
        row += [text(x) for x in result] + [text(x) for x in slopes[0]] + [text(x) for x in slopes[1]]
        print(",".join(row))


if __name__ == "__main__":
    main()
