#!/usr/bin/env python3
"""Loads exported tensors in Mitsuba 3 and compares radiance and polarisation at 100 random directions with the model's own values.

Run by hand, since it needs Mitsuba:

    pip install mitsuba==3.9.1
    cargo build --release --no-default-features --features cli
    python3 tests/mitsuba_check.py target/release/pbrdf-explorer [--resolution 145,121,128]

The model's values come from `pbrdf-explorer evaluate --mueller`. Radiance is that of a surface under unit irradiance from one direction
times the cosine of the light, as the plugin's eval() has it, divided by it again; polarisation is the first column of the Mueller
matrix. Only lengths such as that of (M10, M20) are free of the bases that Mitsuba chooses for itself, so these are compared: DoLP, and the
circular part of what was linear, the length of (M31, M32); besides them the sign of M33.
"""
import csv
import math
import random
import subprocess
import sys
import tempfile
from pathlib import Path

import mitsuba as mi

mi.set_variant("scalar_spectral_polarized")

SURFACES = {
    "gauss, sigma 0.3": "--model gauss --set n=2.07,k=2.9,sigma=0.3,kd=0.12,kv=0.2,c=-0.4,sigma_v=0.6",
    "cauchy, sigma 0.35": "--model cauchy --set n=2.07,k=2.9,sigma=0.35,kd=0.12,kv=0.2,q=2.2,c=-0.4,sigma_v=0.6",
    "cauchy, sigma 0.05": "--model cauchy --set n=1.24,k=6.6,sigma=0.05,kd=0.01,kv=0.01,q=1.8,c=-0.5,sigma_v=0.5",
    "gauss, sigma 0.1": "--model gauss --set n=0.4,k=2.95,sigma=0.1,kd=0.03,kv=0.02,c=-0.5,sigma_v=0.5",
}
NAMES = ["n", "k", "sigma", "ks", "kd", "kv", "q", "c", "sigma_v"]
DEFAULTS = dict(zip(NAMES, [2, 3, 0.3, 1, 0.1, 0.1, 2, -0.5, 0.5]))


def directions(count, sigma):
    """Half of them anywhere up to 85 degrees, half of them around the lobe."""
    rng = random.Random(7)
    found = []
    while len(found) < count:
        theta_i = math.degrees(math.acos(rng.uniform(math.cos(math.radians(85)), 1)))
        theta_r, dphi = math.degrees(math.acos(rng.uniform(math.cos(math.radians(85)), 1))), rng.uniform(-180, 180)
        if len(found) % 2:
            width = math.degrees(math.atan(2 * sigma))
            theta_r, dphi = theta_i + rng.gauss(0, width), 180 + rng.gauss(0, width)
            if not 0 < theta_r < 85:
                continue
        found.append((theta_i, theta_r, dphi))
    return found


def vector(theta, phi):
    theta, phi = math.radians(theta), math.radians(phi)
    return mi.Vector3f(math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta))


def model_values(program, options, rows, folder):
    words = options.split()
    values = DEFAULTS | {name: float(value) for name, value in (part.split("=") for part in words[3].split(","))}
    distribution = words[1]
    path = folder / "rows.csv"
    with open(path, "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["distribution", *NAMES, "theta_i", "theta_r", "dphi"])
        for row in rows:
            out.writerow([distribution, *(values[name] for name in NAMES), *map(repr, row)])
    text = subprocess.run([program, "evaluate", path, "--mueller"], check=True, capture_output=True, text=True).stdout
    return list(csv.DictReader(text.splitlines()))


def quantile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def main():
    program, more = sys.argv[1], sys.argv[2:]
    good = True
    for name, options in SURFACES.items():
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "surface.pbsdf"
            subprocess.run([program, "export", "mitsuba", *options.split(), "-o", path, *more], check=True)
            size = path.stat().st_size / 1e6
            bsdf = mi.load_dict({"type": "measured_polarized", "filename": str(path)})
            sigma = float(options.split("sigma=")[1].split(",")[0])
            rows = directions(100, sigma)
            brdf_errors, dolp_errors, circular_errors = [], [], []
            context = mi.BSDFContext()
            for (theta_i, theta_r, dphi), row in zip(rows, model_values(program, options, rows, Path(folder))):
                interaction = mi.SurfaceInteraction3f()
                # wi points to the eye, wo to the light.
                interaction.wi = vector(theta_r, dphi + 20)
                interaction.wavelengths = [450, 500, 550, 600]
                light = vector(theta_i, 20)
                value = bsdf.eval(context, interaction, light, True)
                m = [[value[i, j][0] / light.z for j in range(4)] for i in range(4)]
                brdf, dolp = float(row["brdf"]), float(row["dolp"])
                brdf_errors.append(abs(m[0][0] / brdf - 1))
                dolp_errors.append(abs(math.hypot(m[1][0], m[2][0]) / m[0][0] - dolp))
                circular = [math.hypot(float(row["m31"]), float(row["m32"])) / brdf, math.hypot(m[3][1], m[3][2]) / m[0][0]]
                circular_errors.append(abs(circular[0] - circular[1]))
                signs = float(row["m33"]), m[3][3]
                good &= signs[0] * signs[1] >= 0 or abs(signs[0] / brdf) < 0.02
        print(f"{name} ({size:.1f} MB): radiance, relative: median {quantile(brdf_errors, .5):.2e}, 90 % {quantile(brdf_errors, .9):.2e}, worst "
              f"{max(brdf_errors):.2e}; DoLP: median {quantile(dolp_errors, .5):.2e}, worst {max(dolp_errors):.2e}; circular: worst {max(circular_errors):.2e}")
        good &= quantile(brdf_errors, 0.5) < 0.01 and max(dolp_errors) < 0.02
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
