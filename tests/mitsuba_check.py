#!/usr/bin/env python3
"""Loads exported tensors in Mitsuba 3 and compares radiance and polarisation at 100 random directions with the model's own values.

Run by hand, since it needs Mitsuba:

    pip install mitsuba==3.9.1
    cargo build --release --no-default-features --features cli
    python3 tests/mitsuba_check.py target/release/pbrdf-explorer [--resolution 145,121,128]

The model's values come from `pbrdf-explorer evaluate --mueller`. Every direction is asked twice. First the plugin's eval(), divided by the
cosine of the light. Only lengths such as that of (M10, M20) are free of the bases that Mitsuba chooses for itself, so these are compared:
DoLP, and the circular part of what was linear, the length of (M31, M32); besides them the sign of M33. Then a render: a rectangle of
the surface under a directional light, seen by a radiance meter, with Mitsuba's Stokes integrator; a white Lambertian rectangle under the
same light and sampler gives the unit.
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


def render(bsdf, light, eye):
    """Stokes components S0, S1, S2 of what the eye sees, in the film's first channel."""
    film = {"type": "hdrfilm", "width": 1, "height": 1, "pixel_format": "rgb", "component_format": "float32", "rfilter": {"type": "box"}}
    scene = mi.load_dict({
        "type": "scene",
        "integrator": {"type": "stokes", "nested": {"type": "direct"}},
        "surface": {"type": "rectangle", "bsdf": bsdf},
        "light": {"type": "directional", "direction": -light, "irradiance": {"type": "uniform", "value": 1.0}},
        "eye": {"type": "radiancemeter", "origin": 0.5 * eye, "direction": -eye, "film": film,
                "sampler": {"type": "independent", "sample_count": 4}},
    })
    # Three channels of the image, then three of each Stokes component.
    channels = [float(value) for value in mi.render(scene, seed=1).array]
    return channels[3], channels[6], channels[9]


def quantile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def main():
    program, more = sys.argv[1], sys.argv[2:]
    good = True
    white = mi.load_dict({"type": "diffuse", "reflectance": {"type": "uniform", "value": 1.0}})
    for name, options in SURFACES.items():
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "surface.pbsdf"
            subprocess.run([program, "export", "mitsuba", *options.split(), "-o", path, *more], check=True)
            size = path.stat().st_size / 1e6
            bsdf = mi.load_dict({"type": "measured_polarized", "filename": str(path)})
            sigma = float(options.split("sigma=")[1].split(",")[0])
            rows = directions(100, sigma)
            brdf_errors, dolp_errors, circular_errors, rendered, rendered_dolp = [], [], [], [], []
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
                s0, s1, s2 = render(bsdf, light, interaction.wi)
                rendered.append(abs(s0 / render(white, light, interaction.wi)[0] / math.pi / brdf - 1))
                rendered_dolp.append(abs(math.hypot(s1, s2) / s0 - dolp))
                signs = float(row["m33"]), m[3][3]
                good &= signs[0] * signs[1] >= 0 or abs(signs[0] / brdf) < 0.02
        print(f"{name} ({size:.1f} MB)")
        for what, errors in {
            "radiance, relative": brdf_errors, "DoLP": dolp_errors, "circular": circular_errors,
            "rendered radiance, relative": rendered, "rendered DoLP": rendered_dolp,
        }.items():
            print(f"  {what}: median {quantile(errors, .5):.2e}, 90 % {quantile(errors, .9):.2e}, worst {max(errors):.2e}")
        good &= all(quantile(errors, 0.5) < 0.01 for errors in (brdf_errors, rendered))
        good &= all(max(errors) < 0.02 for errors in (dolp_errors, rendered_dolp))
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
