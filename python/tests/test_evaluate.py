"""Values, Mueller matrices and derivatives at arrays of angles."""

from __future__ import annotations

import csv
import math

import numpy as np
import pbrdf
import pytest

NAMES = tuple(pbrdf.parameters())
# Bars of core/tests/golden.rs: some 500 units in the last place; ratios of lobes that are all below e^-120 lose as many digits as
# their exponents have.
VALUE = 1e-13
GRADIENT = 1e-12
DARK_VALUE = 1e-9
DARK = 1e-52
NEGLIGIBLE = 1e-30


def number(row, column):
    return float(row[column])


def surface(row):
    return {name: number(row, name) for name in pbrdf.models()[row["distribution"]].parameters}


def angles(row):
    return [number(row, name) for name in ("theta_i", "theta_r", "dphi")]


def is_dark(row):
    if "specular" not in row or not (number(row, "kd") > 0 or number(row, "kv") > 0):
        return False
    return all(number(row, lobe) < DARK for lobe in ("specular", "diffuse", "volume"))


def critical_angle_factor(row):
    """sin²β/|N² − sin²β|, at least 1, as core/tests/common has it."""
    theta_i, theta_r, dphi = map(math.radians, angles(row))
    cos_2_beta = math.cos(theta_i) * math.cos(theta_r) + math.sin(theta_i) * math.sin(theta_r) * math.cos(dphi)
    s = (1 - cos_2_beta) / 2
    n, k = number(row, "n"), number(row, "k")
    return max(1.0, s / math.hypot((n - k) * (n + k) - s, 2 * n * k))


def relative_error(value, reference):
    error = abs(value - reference)
    if abs(reference) < NEGLIGIBLE:
        return 0.0 if error <= NEGLIGIBLE else math.inf
    return error / abs(reference)


@pytest.mark.parametrize("table", ["golden.csv", "golden_corners.csv"])
def test_values_are_those_of_60_digit_arithmetic(golden, table):
    rows = golden(table)
    assert len(rows) > 100
    for row in rows:
        found = pbrdf.evaluate(row["distribution"], surface(row), *angles(row), terms=True)
        for column in ("brdf", "dolp", "specular", "diffuse", "volume"):
            bar = DARK_VALUE if column == "dolp" and is_dark(row) else VALUE * critical_angle_factor(row)
            assert relative_error(getattr(found, column), number(row, column)) <= bar, (row["case"], column)


@pytest.mark.parametrize("table", ["golden_jacobian.csv", "golden_corners.csv"])
def test_derivatives_are_those_of_60_digit_arithmetic(golden, table):
    rows = golden(table)
    assert len(rows) > 100
    for row in rows:
        found = pbrdf.evaluate(row["distribution"], surface(row), *angles(row), gradients=NAMES)
        for prefix, gradient in (("dbrdf_d", found.brdf_gradient), ("ddolp_d", found.dolp_gradient)):
            of_dark = prefix == "ddolp_d" and is_dark(row)
            bar = DARK_VALUE if of_dark else GRADIENT * critical_angle_factor(row)
            weights = {name: max(abs(number(row, name)), 1e-3) for name in NAMES}
            references = {name: number(row, f"{prefix}{name}") for name in NAMES}
            scale = max((abs(references[name]) * weights[name] for name in NAMES if math.isfinite(references[name])), default=0)
            for name, reference in references.items():
                if not math.isfinite(reference):
                    continue
                error = abs(float(gradient[name]) - reference)
                if not error <= NEGLIGIBLE:
                    own = error / abs(reference) if reference else math.inf
                    assert min(own, error * weights[name] / scale) <= bar, (row["case"], prefix, name)


def test_values_equal_those_of_the_command_line(program, tmp_path):
    generator = np.random.default_rng(1)
    theta_i, theta_r, dphi = generator.uniform(0, 89, (2, 60)).tolist() + [generator.uniform(0, 360, 60).tolist()]
    values = {"n": 2.07, "k": 2.9, "sigma": 0.3, "ks": 0.9, "kd": 0.1, "kv": 0.05, "q": 2.0, "c": 0.2, "sigma_v": 0.5}
    table = tmp_path / "angles.csv"
    with table.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["distribution", *values, "theta_i", "theta_r", "dphi"])
        writer.writerows(["cauchy", *values.values(), *point] for point in zip(theta_i, theta_r, dphi, strict=True))
    printed = list(csv.DictReader(program("evaluate", table, "--mueller", "--gradient").splitlines()))
    found = pbrdf.evaluate("cauchy", values, theta_i, theta_r, dphi, terms=True, mueller=True, gradients=True)
    columns = {name: getattr(found, name) for name in ("brdf", "dolp", "specular", "diffuse", "volume")}
    columns |= {f"m{i}{j}": found.mueller[:, i, j] for i in range(4) for j in range(4)}
    columns |= {f"dbrdf_d{name}": found.brdf_gradient[name] for name in values}
    columns |= {f"ddolp_d{name}": found.dolp_gradient[name] for name in values}
    for name, column in columns.items():
        expected = np.array([float(row[name]) for row in printed])
        # Elements that cancel are compared by the size of the column.
        np.testing.assert_allclose(column, expected, rtol=1e-13, atol=1e-13 * np.abs(expected).max(), err_msg=name)


def test_angles_broadcast():
    theta_i, theta_r = np.array([[30.0], [60.0]]), np.arange(0.0, 80.0, 10.0)
    found = pbrdf.evaluate("cauchy", {"n": 2.07}, theta_i, theta_r, mueller=True, gradients=["k", "n"])
    assert found.brdf.shape == found.dolp.shape == (2, 8) and found.mueller.shape == (2, 8, 4, 4)
    assert list(found.brdf_gradient) == ["n", "k"]
    for i, j in np.ndindex(2, 8):
        one = pbrdf.evaluate("cauchy", {"n": 2.07}, theta_i[i, 0], theta_r[j], mueller=True, gradients=["n", "k"])
        assert one.brdf == found.brdf[i, j] and one.dolp == found.dolp[i, j]
        assert (one.mueller == found.mueller[i, j]).all()
        assert one.brdf_gradient["k"] == found.brdf_gradient["k"][i, j]
        assert one.dolp_gradient["n"] == found.dolp_gradient["n"][i, j]


def test_the_first_row_of_a_mueller_matrix_is_the_brdf():
    found = pbrdf.evaluate("cauchy", {}, 60, [30, 50], 170, mueller=True)
    np.testing.assert_allclose(found.mueller[:, 0, 0], found.brdf, rtol=1e-13)


def test_prepared_angles_give_the_same_bits_at_any_number_of_points():
    theta_r = np.linspace(0, 89, 40_001)
    geometries = pbrdf.prepare(60, theta_r, 170)
    assert geometries.shape == (40_001,)
    for model in ("cauchy", "gauss", "hyde"):
        if model in pbrdf.models():
            once = pbrdf.evaluate(model, {"n": 1.5}, 60, theta_r, 170, gradients=["n"])
            again = geometries.evaluate(model, {"n": 1.5}, gradients=["n"])
            assert (once.brdf == again.brdf).all() and (once.dolp == again.dolp).all()
            assert (once.brdf_gradient["n"] == again.brdf_gradient["n"]).all()


def test_a_negative_angle_of_view_is_the_backscatter_side():
    assert pbrdf.evaluate("cauchy", {}, 40, -20).brdf == pbrdf.evaluate("cauchy", {}, 40, 20, 0).brdf


def test_no_points_give_no_values():
    assert pbrdf.evaluate("cauchy", {}, [], 30).brdf.shape == (0,)


@pytest.mark.parametrize("dtype", [np.float32, np.int64, np.float16])
def test_other_types_of_numbers_are_converted(dtype):
    theta_r = np.array([10, 20, 30], dtype=dtype)
    assert (pbrdf.evaluate("cauchy", {}, 60, theta_r).brdf == pbrdf.evaluate("cauchy", {}, 60, [10.0, 20.0, 30.0]).brdf).all()


def test_arrays_with_gaps_in_memory_are_read_as_they_are_meant():
    theta = np.arange(0.0, 80.0)
    strided = pbrdf.evaluate("cauchy", {}, 60, theta[::-3])
    assert (strided.brdf == pbrdf.evaluate("cauchy", {}, 60, theta[::-3].copy()).brdf).all()
    crossed = pbrdf.evaluate("cauchy", {}, 60, theta.reshape(8, 10).T)
    assert (crossed.brdf.T.ravel() == pbrdf.evaluate("cauchy", {}, 60, theta).brdf).all()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("cauchy", {}, 95, 30), "theta_i = 95 is outside 0 ≤ θi < 90 degrees"),
        (("cauchy", {}, 30, [[10, 20], [30, 90]]), r"theta_r = 90 is outside 0 ≤ θr < 90 degrees \(at \[1, 1\]\)"),
        (("cauchy", {}, 30, [10, math.nan]), r"theta_r = NaN is outside .* \(at \[1\]\)"),
        (("cauchy", {}, 30, 10, math.inf), "dphi = inf is not a finite angle"),
        (("cauchy", {}, 30, -10, 90), "a negative theta_r is the backscatter side, allowed only where dphi is 180"),
        (("cauchy", {}, [1, 2], [1, 2, 3]), r"do not broadcast: theta_i \(2,\), theta_r \(3,\), dphi \(\); add an axis"),
        (("cauchy", {}, "steep", 30), "theta_i is 'steep'; expected numbers"),
        (("cauchy", {}, [[1, 2], [3]], 30), "expected numbers, all rows of one length"),
        (("cauchy", {}, 1 + 2j, 30), "expected real numbers"),
        (("cauchy", {"m": 1}, 30, 30), '"m" is no parameter; expected one of n, k,'),
        (("cauchy", {"n": math.nan}, 30, 30), "n = NaN is not allowed"),
        (("cauchy", {"n": 1e308}, 30, 30), "n = 1e308 is not allowed"),
        (("cauchy", {}, 1e300, 30), "theta_i = 1e300 is outside"),
        (("cauchy", {"sigma": -1}, 30, 30), "sigma = -1 is not allowed"),
        (("cauchy", {"n": 0, "k": 0}, 30, 30), "n and k are both 0"),
        (("cauchy", {"n": [1, 2]}, 30, 30), r"parameters\['n'\] has the shape \(2,\); expected one number"),
        (("cauchy", [1, 2], 30, 30), "expected values by name"),
        (("cauchi", {}, 30, 30), '"cauchi" is no model; expected one of fresnel'),
        ((3, {}, 30, 30), "model is 3; expected a name"),
    ],
)
def test_what_is_wrong_is_refused_in_one_sentence(arguments, said):
    with pytest.raises(pbrdf.PbrdfError, match=said) as caught:
        pbrdf.evaluate(*arguments)
    assert isinstance(caught.value, ValueError) and "\n" not in str(caught.value)


def test_an_unknown_derivative_is_refused():
    with pytest.raises(pbrdf.PbrdfError, match='"m" is no parameter'):
        pbrdf.evaluate("cauchy", {}, 30, 30, gradients=["n", "m"])
    with pytest.raises(pbrdf.PbrdfError, match="theta_i = 95"):
        pbrdf.prepare(95, 30)


def test_a_value_that_the_model_does_not_have_is_warned_of():
    for call in (
        lambda: pbrdf.evaluate("gauss", {"n": 2.0, "q": 2.5}, 30, 40),
        lambda: pbrdf.prepare(30, 40).evaluate("gauss", {"q": 2.5}),
        lambda: pbrdf.picture("gauss", {"q": 2.5}, size=8),
        lambda: pbrdf.simulate("gauss", {"q": 2.5}, 30, 40),
    ):
        with pytest.warns(UserWarning, match="the model gauss has no q; what is given for it changes nothing") as caught:
            call()
        # Where the user wrote it.
        assert caught[0].filename == __file__
    with pytest.raises(pbrdf.PbrdfError, match='"m" is no parameter'):
        pbrdf.evaluate("gauss", {"m": 2.5}, 30, 40)


def test_values_by_name_come_from_whatever_has_keys():
    pandas = pytest.importorskip("pandas")
    expected = pbrdf.evaluate("cauchy", {"n": 2.0, "k": 2.5}, 30, 40).dolp
    assert pbrdf.evaluate("cauchy", pandas.Series({"n": 2.0, "k": 2.5}), 30, 40).dolp == expected
    with pytest.raises(pbrdf.PbrdfError, match="expected values by name"):
        pbrdf.evaluate("cauchy", [2.0, 2.5], 30, 40)
