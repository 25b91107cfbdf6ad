"""Reference objectives of simulated fits: SciPy's bounded trust-region solver from 24 starts each.

    cargo test --release --test starts -- --ignored write_the_problems     (writes the data to target/fit_problems and target/brdf_problems)
    python3 assets/reference/make_fit_problems.py > assets/reference/fit_problems.csv     (needs numpy and scipy; some ten minutes)
    python3 assets/reference/make_fit_problems.py target/brdf_problems > assets/reference/brdf_problems.csv

DoLP is fitted by Eq. (18), a BRDF by the sum of the squares of its relative differences.

The model is written anew here, from the equations of the paper in the forms of the module documentation, without derivatives: SciPy takes
differences. Starts: half spread evenly over the box, half by factors, the first one the defaults; seeded.
"""

import datetime
import pathlib
import sys

import numpy as np
import scipy
from scipy.optimize import least_squares

NAMES = ["n", "k", "sigma", "kd", "kv", "q", "c", "sigma_v", "ks"]
LOW = np.array([0.01, 0.0, 0.001, 0.0, 0.0, 1.0001, -1.0, 0.01, 0.0])
HIGH = np.array([10.0, 20.0, 3.0, 10.0, 10.0, 20.0, 0.0, 3.0, 10.0])
DEFAULT = np.array([2.0, 3.0, 0.3, 0.1, 0.1, 2.0, -0.5, 0.5, 1.0])
STARTS = 24


def dolp_and_brdf(p, gauss, theta_i, theta_r, dphi):
    n, k, sigma, kd, kv, q, c, sigma_v, ks = p
    ci, cr = np.cos(theta_i), np.cos(theta_r)
    cos_2beta = ci * cr + np.sin(theta_i) * np.sin(theta_r) * np.cos(dphi)
    cos_beta_sq = (1 + cos_2beta) / 2
    sin_sq = 1 - cos_beta_sq
    cos_beta = np.sqrt(cos_beta_sq)
    cos_alpha = np.minimum((ci + cr) / (2 * cos_beta), 1.0)
    tan_sq = 1 / cos_alpha**2 - 1
    a = np.sqrt((n + 1j * k) ** 2 - sin_sq)
    r_s = np.abs((cos_beta - a) / (cos_beta + a)) ** 2
    r_p = r_s * np.abs((a * cos_beta - sin_sq) / (a * cos_beta + sin_sq)) ** 2
    w = tan_sq / (2 * sigma**2)
    if gauss:
        log_density = -w - 2 * np.log(sigma)
    else:
        log_density = -q * np.log1p(w) + np.log(q - 1) - 2 * np.log(sigma)
    g = np.minimum(1, np.minimum(2 * cos_alpha * cr / cos_beta, 2 * cos_alpha * ci / cos_beta))
    log_lobe = log_density + np.log(g / (8 * np.pi * cos_alpha**4 * ci * cr))
    diffuse = (ci * cr) ** c / np.pi
    volume = np.exp(-(theta_r**2) / (2 * sigma_v**2)) / (np.sqrt(2 * np.pi) * sigma_v)
    depolarised = (kd * diffuse + kv * volume) * np.exp(np.minimum(-log_lobe, 650.0))
    half_difference, mean = (r_s - r_p) / 2, (r_s + r_p) / 2
    return half_difference / (mean + depolarised), ks * np.exp(log_lobe) * mean + kd * diffuse + kv * volume


def best(path):
    lines = path.read_text().splitlines()
    gauss, is_brdf = "gauss" in path.stem, lines[0].endswith("brdf")
    rows = np.array([[float(x) for x in line.split(",")] for line in lines[1:]])
    theta_i, theta_r, dphi, measured = np.radians(rows[:, 0]), np.radians(rows[:, 1]), np.radians(rows[:, 2]), rows[:, 3]
    scale = measured if is_brdf else np.sqrt(np.sum(measured**2))
    left_out = {"q"} if gauss else set()
    if not is_brdf:
        left_out.add("ks")
    free = [j for j in range(9) if NAMES[j] not in left_out]

    def residuals(x):
        p = DEFAULT.copy()
        p[free] = x
        return (dolp_and_brdf(p, gauss, theta_i, theta_r, dphi)[is_brdf] - measured) / scale

    random = np.random.default_rng(1)
    objective = np.inf
    for i in range(STARTS):
        u = random.random(9)
        if i == 0:
            start = DEFAULT
        elif i % 2:
            start = LOW + (HIGH - LOW) * u
        else:
            bottom = np.array([0.01, 0.1, 0.01, 1e-3, 1e-3, 1e-1, 0, 0.05, 1e-2])
            origin = np.array([0, 0, 0, 0, 0, 1, 0, 0, 0])
            spread = origin + bottom ** (1 - u) * (HIGH - origin) ** u
            start = np.where(np.array(NAMES) == "c", LOW + (HIGH - LOW) * u, spread)
        start = np.clip(start, LOW + 1e-9, HIGH - 1e-9)
        try:
            with np.errstate(all="ignore"):
                found = least_squares(
                    residuals, start[free], bounds=(LOW[free], HIGH[free]), x_scale="jac",
                    ftol=1e-15, xtol=1e-15, gtol=1e-15, max_nfev=600,
                )
        except ValueError:
            continue
        objective = min(objective, 2 * found.cost)
        if objective < 1e-22:
            break
    return objective


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "target/fit_problems")
    print(f"# least sum of squares that SciPy {scipy.__version__} finds from {STARTS} starts, least_squares, trf, bounded")
    print(f"# maker: make_fit_problems.py, {datetime.date.today()}; problems: tests/common/fit_problems.rs")
    print("problem,objective")
    for path in sorted(folder.glob("*.csv")):
        print(f"{path.stem},{best(path):.17e}", flush=True)


main()
