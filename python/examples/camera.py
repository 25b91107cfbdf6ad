"""A surface from three pictures of a sphere, here simulated: python camera.py"""

import numpy as np

import pbrdf

LAMPS = [(20.0, 90.0), (60.0, 200.0), (100.0, 330.0)]
SURFACE = {"n": 2.07, "k": 2.9, "sigma": 0.35, "kd": 0.15, "kv": 0.05}

random = np.random.default_rng(1)
seen = [pbrdf.picture("cauchy", SURFACE, lamp=lamp, size=200) for lamp in LAMPS]
stokes = np.stack([one.stokes + 0.005 * one.s0 * random.standard_normal((3, 200, 200)) for one in seen])

# The ground is dark: what is not of the sphere is left out by its outline.
body = pbrdf.sphere(np.nan_to_num(stokes[:, 0]).max(axis=0))
print(f"middle {body.center[0]:.2f}, {body.center[1]:.2f}, radius {body.radius:.2f} pixels")
found = pbrdf.fit_pixels(stokes, body, LAMPS)
print(found)
print(f"DoLP is described within {np.nanstd(found.dolp_residuals):.4f}")
