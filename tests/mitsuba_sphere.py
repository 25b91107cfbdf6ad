#!/usr/bin/env python3
"""Renders a sphere with exported tensors in Mitsuba 3 and compares DoLP and angle of polarisation with `pbrdf-explorer picture`, pixel by pixel.

Run by hand, since it needs Mitsuba:

    pip install mitsuba==3.9.1
    cargo build --release --no-default-features --features cli
    python3 tests/mitsuba_sphere.py target/release/pbrdf-explorer [--resolution 145,121,128]

A directional light and an orthographic camera stand where those of `picture` are. Each pixel of Mitsuba is the mean over its area, so that
pixels at the limb and at the edge of the shadow, where the picture changes within a pixel, are left out (cosines below 0.2). The Stokes
vector of Mitsuba refers to a frame of its camera; its S1 and S2 are turned by the one angle and handedness, of four, that fits best for
all surfaces and lamps together. Bars: DoLP within the resolution of the tensor, median 0.5 %; angle of polarisation 1 degree where
DoLP > 0.02.
"""
import csv
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import mitsuba as mi

mi.set_variant("scalar_spectral_polarized")

SIZE = 96
CASES = {
    "gauss, sigma 0.3": ("--model gauss --set n=2.07,k=2.9,sigma=0.3,kd=0.12,kv=0.2,c=-0.4,sigma_v=0.6", (60, 135)),
    "cauchy, sigma 0.35": ("--model cauchy --set n=2.07,k=2.9,sigma=0.35,kd=0.12,kv=0.2,q=2.2,c=-0.4,sigma_v=0.6", (80, 20)),
    "dielectric, sigma 0.2": ("--model gauss --set n=1.5,k=0,sigma=0.2,kd=0.05,kv=0,c=-0.5", (100, -60)),
}


def render(bsdf, lamp):
    polar, azimuth = map(math.radians, lamp)
    light = mi.Vector3f(math.sin(polar) * math.cos(azimuth), math.sin(polar) * math.sin(azimuth), math.cos(polar))
    film = {"type": "hdrfilm", "width": SIZE, "height": SIZE, "pixel_format": "rgb", "component_format": "float32", "rfilter": {"type": "box"}}
    scene = mi.load_dict({
        "type": "scene",
        "integrator": {"type": "stokes", "nested": {"type": "direct"}},
        "sphere": {"type": "sphere", "bsdf": bsdf},
        "light": {"type": "directional", "direction": -light, "irradiance": {"type": "uniform", "value": 1.0}},
        "camera": {
            "type": "orthographic", "film": film,
            "to_world": mi.ScalarTransform4f().look_at([0, 0, 4], [0, 0, 0], [0, 1, 0]),
            "sampler": {"type": "multijitter", "sample_count": 64},
        },
    })
    # Three channels of the image, then three of each Stokes component.
    image = mi.render(scene, seed=1)
    values, channels = list(image.array), image.shape[2]
    return lambda row, column: [float(values[(row * SIZE + column) * channels + 3 + 3 * component]) for component in range(3)]


def main():
    program, more = sys.argv[1], sys.argv[2:]
    found = []
    for name, (options, lamp) in CASES.items():
        with tempfile.TemporaryDirectory() as folder:
            tensor, table = Path(folder) / "surface.pbsdf", Path(folder) / "picture.csv"
            subprocess.run([program, "export", "mitsuba", *options.split(), "-o", tensor, *more], check=True, capture_output=True)
            subprocess.run([program, "picture", *options.split(), "--lamp", f"{lamp[0]},{lamp[1]}", "--size", str(SIZE), "-o", table], check=True)
            stokes = render(mi.load_dict({"type": "measured_polarized", "filename": str(tensor)}), lamp)
            for row in csv.DictReader(open(table)):
                x, y, *own = (float(row[key]) for key in ["x", "y", "s0", "s1", "s2"])
                cosines = [math.cos(math.radians(float(row[key]))) for key in ["theta_i", "theta_r"]]
                if min(cosines) < 0.2:
                    continue
                line, column = round((1 - y) * SIZE / 2 - 0.5), round((x + 1) * SIZE / 2 - 0.5)
                found.append((name, own, stokes(line, column)))
    angle = lambda stokes, turn, hand: math.degrees(0.5 * math.atan2(hand * stokes[2], stokes[1])) + turn
    apart = lambda a, b: abs((a - b + 90) % 180 - 90)
    median = lambda values: sorted(values)[len(values) // 2]
    dolp = lambda stokes: math.hypot(stokes[1], stokes[2]) / stokes[0]
    polarised = [(name, own, other) for name, own, other in found if dolp(own) > 0.02]
    frames = [(turn, hand) for turn in (0, 90) for hand in (1, -1)]
    frame = min(frames, key=lambda frame: median([apart(angle(own, 0, 1), angle(other, *frame)) for _, own, other in polarised]))
    print(f"Mitsuba's frame: turned by {frame[0]} degrees, {'same' if frame[1] > 0 else 'other'} handedness")
    good = True
    for name in CASES:
        relative = [abs(dolp(other) / dolp(own) - 1) for case, own, other in polarised if case == name]
        absolute = [abs(dolp(other) - dolp(own)) for case, own, other in found if case == name]
        angles = [apart(angle(own, 0, 1), angle(other, *frame)) for case, own, other in polarised if case == name]
        radiance = [other[0] / own[0] for case, own, other in found if case == name]
        print(f"{name}: {len(absolute)} pixels, {len(angles)} with DoLP > 0.02")
        print(f"  DoLP: median {100 * median(relative):.2f} %, worst {max(absolute):.2e} absolute")
        print(f"  angle of polarisation: median {median(angles):.3f} degrees, worst {max(angles):.3f}")
        print(f"  radiance over ours: median {median(radiance):.4f}")
        good &= median(relative) < 0.005 and max(angles) < 1
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
