"""Pictures, and surfaces from pictures."""

import numpy as np
import pytest

import pbrdf

SURFACE = {"n": 2.07, "k": 2.9, "sigma": 0.35, "kd": 0.15, "kv": 0.05}
LAMPS = [(20.0, 90.0), (60.0, 200.0), (100.0, 330.0)]


def pictures(size, lamps=LAMPS, noise=0.0, scale=1.0, seed=1, shape="sphere"):
    """Stokes pictures whose noise has that share of S0 in each component, and the normals."""
    seen = [pbrdf.picture("cauchy", SURFACE, lamp=lamp, size=size, shape=shape) for lamp in lamps]
    stokes = np.stack([one.stokes for one in seen])
    stokes = stokes + noise * stokes[:, :1] * np.random.default_rng(seed).standard_normal(stokes.shape)
    return scale * stokes, seen[0].normals


def test_a_picture_is_that_of_the_command_line(program, tmp_path):
    path = tmp_path / "sphere.csv"
    program("picture", "--set", "n=2.07,k=2.9,sigma=0.35,kd=0.15,kv=0.05", "--lamp", "40,135", "--size", "16", "-o", path)
    rows = np.genfromtxt(path, delimiter=",", names=True, comments="#")
    seen = pbrdf.picture("cauchy", SURFACE, lamp=(40.0, 135.0), size=16)
    column, row = np.round((rows["x"] * 16 + 15) / 2).astype(int), np.round((15 - rows["y"] * 16) / 2).astype(int)
    for key in ("s0", "s1", "s2"):
        assert np.allclose(getattr(seen, key)[row, column], rows[key], rtol=1e-13, atol=0.0)
    facing = rows["x"] ** 2 + rows["y"] ** 2
    assert np.allclose(seen.normals[row, column, 2], np.sqrt(1 - facing), rtol=1e-12)


def test_the_light_of_a_picture_is_that_of_evaluate():
    seen = pbrdf.picture("cauchy", SURFACE, lamp=(60.0, 0.0), size=9)
    x = 2 / 9
    normal = np.array([x, 0.0, np.sqrt(1 - x * x)])
    theta_i = 60.0 - np.degrees(np.arcsin(x))
    one = pbrdf.evaluate("cauchy", SURFACE, theta_i, np.degrees(np.arcsin(x)), 180.0)
    other = pbrdf.evaluate("cauchy", SURFACE, theta_i, np.degrees(np.arcsin(x)), 0.0)
    assert np.allclose(seen.normals[4, 5], normal, rtol=1e-12)
    # The lamp stands beyond the normal, seen from the camera: the forward side.
    light = np.cos(np.radians(theta_i)) * one.brdf
    assert np.isclose(seen.s0[4, 5], light, rtol=1e-12) and not np.isclose(one.brdf, other.brdf)
    assert np.isclose(seen.dolp[4, 5], one.dolp, rtol=1e-12) and np.isclose(seen.aop[4, 5], 90.0)


@pytest.mark.parametrize("shape", ["sphere", "cylinder"])
def test_three_lamps_tell_the_surface_and_the_scale(shape):
    stokes, normals = pictures(120, noise=0.005, scale=37.0, shape=shape)
    found = pbrdf.fit_pixels(stokes, normals, LAMPS)
    truth = {**SURFACE, "ks": 37.0, "kd": 37.0 * SURFACE["kd"], "kv": 37.0 * SURFACE["kv"], "q": 2.0, "c": -0.5, "sigma_v": 0.5}
    determined = [name for name, estimate in found.parameters.items() if estimate.determined]
    assert {"n", "k", "sigma", "ks"} <= set(determined), found
    for name in determined:
        estimate = found.parameters[name]
        # Four standard errors: one draw in 16,000 is beyond them. Over 12 seeds the deviations have a mean of 0 and a spread of 1.
        assert abs(estimate.value - truth[name]) < 4.0 * estimate.std_error, (name, estimate, truth[name])
        assert estimate.interval95[0] < estimate.value < estimate.interval95[1]
    # The noise that the pixels show is the one that was added, to what 10,000 of them tell.
    assert abs(found.noise_s0 / 0.005 - 1) < 0.05 and abs(found.noise_polarised / 0.005 - 1) < 0.05
    assert found.used.shape == (3, 120, 120) and np.isnan(found.s0_residuals[~found.used]).all()
    assert abs(np.nanmean(found.dolp_residuals)) < 1e-3


def test_a_known_scale_leaves_ks_fixed():
    stokes, normals = pictures(60, scale=12.0)
    found = pbrdf.fit_pixels(stokes, normals, LAMPS, scale=12.0)
    assert not found.parameters["ks"].free
    for name, value in SURFACE.items():
        assert found.parameters[name].value == pytest.approx(value, rel=1e-4)


def test_one_lamp_is_told_not_to_tell_n_from_k():
    stokes, normals = pictures(60, lamps=LAMPS[1:2], noise=0.005)
    found = pbrdf.fit_pixels(stokes[0], normals, LAMPS[1:2])
    assert "β = 30.0°" in found.undetermined[0] and "n and k" in found.undetermined[0]
    assert not (found.parameters["n"].determined and found.parameters["k"].determined)
    three = pbrdf.fit_pixels(*pictures(60, noise=0.005), LAMPS)
    assert not any("β" in sentence and "add a lamp" in sentence for sentence in three.undetermined)


def test_highlights_shadows_and_masks_are_left_out():
    stokes, normals = pictures(60)
    bright = float(np.nanquantile(stokes[:, 0], 0.9))
    left_out = np.zeros((60, 60), dtype=bool)
    left_out[:, :20] = True
    cut = stokes.copy()
    cut[:, 0] = np.minimum(cut[:, 0], bright)
    found = pbrdf.fit_pixels(cut, normals, LAMPS, scale=1.0, saturation=bright, dark=0.02, mask=left_out, max_angle=70.0)
    assert not found.used[:, left_out].any() and not found.used[cut[:, 0] >= bright].any() and not found.used[~(cut[:, 0] > 0.02)].any()
    assert found.parameters["n"].value == pytest.approx(SURFACE["n"], rel=1e-3)


def test_the_outline_of_a_sphere_is_found():
    stokes, _ = pictures(200, lamps=[(40.0, 0.0), (40.0, 120.0), (40.0, 240.0)])
    ground = np.zeros((260, 300))
    ground[30:230, 70:270] = np.nan_to_num(stokes[:, 0]).max(axis=0)
    ground += 1e-4 * np.random.default_rng(1).standard_normal(ground.shape)
    body = pbrdf.sphere(ground)
    # A fifth of a pixel: what threshold and pixels leave.
    assert np.allclose(body.center, (129.5, 169.5), atol=0.2) and abs(body.radius - 100.0) < 0.2
    # Lit from one side alone: the edge of its shadow is no outline.
    one = np.zeros((260, 300))
    one[30:230, 70:270] = np.nan_to_num(stokes[0, 0])
    body = pbrdf.sphere(one)
    assert np.allclose(body.center, (129.5, 169.5), atol=0.5) and abs(body.radius - 100.0) < 0.5


def test_the_edges_of_a_cylinder_are_found():
    body = pbrdf.cylinder((300, 300), center=(150.0, 140.0), radius=60.0, tilt=5.0)
    shade = np.where(body.mask, 1.0 + np.nan_to_num(body.normals[..., 2]), 0.0)
    found = pbrdf.cylinder(shade)
    assert abs(found.radius - 60.0) < 0.2 and abs(found.tilt - 5.0) < 0.1
    assert np.nanmax(np.abs(found.normals - body.normals)[40:-40, 85:195]) < 0.02


def test_bad_input_is_refused_in_a_sentence():
    stokes, normals = pictures(20)
    for wrong, sentence in [
        (lambda: pbrdf.fit_pixels(stokes, normals, LAMPS[:2]), "stokes"),
        (lambda: pbrdf.fit_pixels(stokes, normals[:10], LAMPS), "normals"),
        (lambda: pbrdf.fit_pixels(stokes, normals, [(200.0, 0.0), *LAMPS[1:]]), "lamp"),
        (lambda: pbrdf.fit_pixels(stokes, normals, LAMPS, mask=np.ones((20, 20), dtype=bool)), "no pixel"),
        (lambda: pbrdf.fit_pixels(stokes, normals, LAMPS, mask=np.zeros((3, 3), dtype=bool)), "mask"),
        (lambda: pbrdf.fit_pixels(stokes, normals, LAMPS, max_angle=95.0), "max_angle"),
        (lambda: pbrdf.fit_pixels(stokes, normals, LAMPS, own=["n"]), "own"),
        (lambda: pbrdf.fit_pixels(stokes, normals, LAMPS, scale=0.0), "scale"),
        (lambda: pbrdf.sphere(np.zeros((50, 50))), "nothing bright"),
        (lambda: pbrdf.sphere((50, 50), center=(3.0, 3.0)), "both"),
        (lambda: pbrdf.picture("cauchy", {}, shape="cube"), "cube"),
        (lambda: pbrdf.picture("cauchy", {}, lamp=None), "nothing is lit"),
        (lambda: pbrdf.picture("cauchy", {}, lamp=(200.0, 0.0)), "lamp"),
    ]:
        with pytest.raises(pbrdf.PbrdfError, match=sentence):
            wrong()
