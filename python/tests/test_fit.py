"""Fits, their results, and their refusals."""

from __future__ import annotations

import dataclasses
import json
import math
import multiprocessing
import os
import pickle
import signal
import threading
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pbrdf
import pytest

TRUTH = {"n": 2.07, "k": 2.9, "sigma": 0.3, "ks": 1.0, "kd": 0.1, "kv": 0.05, "c": 0.0}
# Times are no result.
TIMES = ("elapsed_ms", "intervals_ms", "trace")


def simulated(name="", **changes):
    """DoLP and BRDF without noise."""
    theta_i, theta_r = (grid.ravel() for grid in np.meshgrid([30.0, 50.0, 70.0], np.arange(0.0, 80.0, 10.0)))
    values = pbrdf.evaluate("cauchy", TRUTH | changes, theta_i, theta_r)
    return pbrdf.Measurement(theta_i, theta_r, dolp=values.dolp, brdf=values.brdf, name=name)


def without_times(document):
    return {key: value for key, value in document.items() if key not in TIMES}


@pytest.mark.parametrize(
    ("options", "arguments"),
    [
        ({}, []),
        ({"model": "gauss", "starts": 1, "intervals": "linear"}, ["--model", "gauss", "--starts", "1", "--intervals", "linear"]),
        (
            {"fix": {"ks": 1.0}, "bounds": {"n": (0.5, 4.0)}, "start": {"k": 3.0}, "seed": 3, "loss": "huber", "weights": "sigma"},
            "--fix ks=1 --bounds n=0.5..4 --start k=3 --seed 3 --loss huber --weights sigma".split(),
        ),
    ],
)
def test_a_fit_equals_that_of_the_command_line(program, example, options, arguments):
    printed = json.loads(program("fit", example, "--json", *arguments))
    result = pbrdf.fit(pbrdf.read(example), **options)
    assert without_times(result.to_dict()) == without_times(printed)
    for name, estimate in printed["parameters"].items():
        assert result.parameters[name].value == estimate["value"] and result.parameters[name].std_error == estimate["std_error"]


def test_a_fit_of_several_equals_that_of_the_command_line(program, tmp_path):
    paths = [tmp_path / "A.csv", tmp_path / "B.csv"]
    for path, n in zip(paths, (1.8, 2.2), strict=True):
        simulated(n=n).write(path)
    printed = json.loads(program("fit", *paths, "--own", "n", "--fix", "ks=1", "--starts", "3", "--intervals", "linear", "--json"))
    result = pbrdf.fit([pbrdf.read(path) for path in paths], own="n", fix={"ks": 1}, starts=3, intervals="linear")
    for item in printed["sets"]:
        # What the command knows of its files.
        assert item.pop("file") and item.pop("rows") == 24
    assert without_times(result.to_dict()) == without_times(printed)


def test_a_fit_finds_the_surface_that_the_data_are_of():
    result = pbrdf.fit(simulated(), fix={"c": 0.0}, starts=4)
    assert result.model == "cauchy" and result.objective < 1e-9
    for name, value in TRUTH.items():
        # What the search leaves of exact data.
        assert result.parameters[name].value == pytest.approx(value, rel=1e-5), name
    assert not result.parameters["c"].free and result.parameters["c"].interval95 is None
    assert result.values()["n"] == result.parameters["n"].value
    assert result.evaluate(60, 40).dolp == pbrdf.evaluate("cauchy", result.values(), 60, 40).dolp


def test_intervals_contain_the_value_and_each_other(example):
    result = pbrdf.fit(pbrdf.read(example))
    closed = [item for item in result.parameters.values() if item.interval95 and None not in item.interval95]
    assert closed
    for estimate in closed:
        (low, high), (wide_low, wide_high) = estimate.interval68, estimate.interval95
        assert wide_low <= low <= estimate.value <= high <= wide_high
    assert result.minima[0].objective == pytest.approx(result.objective) and result.minima[0].reached >= 1
    size = len(result.correlations.names)
    assert result.correlations.matrix.shape == (size, size)


def test_what_the_data_leave_open_is_said():
    data = pbrdf.Measurement([30, 50, 70], [40, 50, 70], dolp=[0.13, 0.29, 0.67])
    result = pbrdf.fit(data, starts=1)
    assert result.undetermined and result.stop_reason == "underdetermined"
    assert any(str(estimate) == "not determined" for estimate in result.parameters.values())
    assert result.undetermined[0] in str(result) and result.undetermined[0] in repr(result)
    assert "<table>" in result._repr_html_() and "n" in result._repr_html_()


def test_each_of_several_has_its_own_parameters():
    data = [simulated(name="A", n=1.8), simulated(name="B", n=2.2)]
    result = pbrdf.fit(data, own=["n"], fix={"ks": 1.0, "c": 0.0}, starts=3, intervals="linear")
    assert result.parameters["n@A"].value == pytest.approx(1.8, rel=1e-5)
    assert result.parameters["n@B"].value == pytest.approx(2.2, rel=1e-5)
    assert "n" not in result.parameters and "k" in result.parameters
    assert [item.name for item in result.sets] == ["A", "B"]
    assert result.sets[1].parameters["n"] == result.parameters["n@B"] and result.sets[1].parameters["k"] == result.parameters["k"]
    assert result.values(1)["n"] == result.parameters["n@B"].value
    held = pbrdf.fit(data, own="n", fix={"ks": 1.0, "n@B": 2.5}, starts=1, intervals="linear")
    assert held.parameters["n@B"].value == 2.5 and held.parameters["n@A"].free


def test_measurements_and_results_go_to_other_processes(example):
    data = [pbrdf.read(example), simulated(name="B"), pbrdf.Measurement(30, [40, 50, -60], dolp=[0.1, None, 0.3], masked=[0, 0, 1])]
    for one in data:
        again = pickle.loads(pickle.dumps(one))
        assert again.name == one.name and again.metadata == one.metadata
        for key in ("theta_i", "theta_r", "dphi", "dolp", "dolp_sigma", "brdf", "brdf_sigma", "masked"):
            assert np.array_equal(getattr(again, key), getattr(one, key), equal_nan=key != "masked"), key
    here = pbrdf.fit(data[0], "specular", starts=1)
    # A fork would have none of the threads of this process.
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as executor:
        there = executor.submit(pbrdf.fit, data[0], "specular", starts=1).result()
    assert without_times(there.to_dict()) == without_times(here.to_dict())
    assert str(there) == str(here) and there.undetermined == here.undetermined and there.values() == here.values()


def test_a_result_from_another_process_is_drawn_from_and_plotted(example):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    here = pbrdf.fit(pbrdf.read(example), "specular", starts=2, intervals="linear")
    there = pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(here))))
    drawn = [pbrdf.posterior(result, draws=200, chains=2).draws["n"] for result in (here, there)]
    assert np.array_equal(*drawn)
    assert there.plot() is not None
    matplotlib.pyplot.close("all")


def test_a_parameter_that_is_not_there_is_said():
    data = [simulated(name="A", n=1.8), simulated(name="B", n=2.2)]
    result = pbrdf.fit(data, own="n", fix={"ks": 1.0}, starts=1, intervals="none")
    with pytest.raises(KeyError, match=r"each measurement has its own n: ask for 'n@A' or 'n@B', or for sets\[0\].parameters\['n'\]"):
        result.parameters["n"]
    with pytest.raises(KeyError, match="there is no parameter 'm'; there are "):
        result.parameters["m"]
    assert result.parameters.get("n") is None and "n" not in result.parameters
    with pytest.raises(KeyError, match="there is no parameter 'm'; there are "):
        result.sets[0].parameters["m"]


def test_parameters_of_a_result_are_values_of_a_surface():
    result = pbrdf.fit(simulated(), starts=1, intervals="none")
    assert pbrdf.evaluate("cauchy", result.parameters, 60, 40).dolp == result.evaluate(60, 40).dolp
    assert float(result.parameters["n"]) == result.parameters["n"].value
    again = pbrdf.fit(simulated(), start=result.parameters, fix=result.parameters, intervals="none")
    assert again.values() == result.values()
    with pytest.raises(pbrdf.PbrdfError, match=r"parameters is a FitResult; expected values by name.*; its values\(\) returns them"):
        pbrdf.evaluate("cauchy", result, 60, 40)


def test_a_range_without_rows_is_said():
    data = [simulated(name="A"), pbrdf.Measurement(30, [-10, -20, 5], dolp=[0.1, 0.1, 0.1], name="B")]
    with pytest.raises(pbrdf.PbrdfError, match="no row lies in the range.* θr 80° to 85°; the rows have θi 30° to 70° and θr 0° to 70°"):
        pbrdf.fit(data[0], theta_r_range=(80, 85))
    with pytest.warns(UserWarning, match="B: no row lies in the range.*; the rows have θi 30° to 30° and θr -20° to 5°"):
        assert pbrdf.fit(data, theta_r_range=(10, 85), starts=1, intervals="none").objective is not None
    with pytest.raises(pbrdf.PbrdfError, match="no row lies in the range that is fitted, θi 80° to 90°"):
        pbrdf.fit(data, theta_i_range=(80, 90))


def test_help_knows_every_attribute():
    found = [pbrdf.FitResult.parameters, pbrdf.FitResult.sets, pbrdf.Posterior.draws, pbrdf.Posterior.summary, pbrdf.Posterior.log_evidence]
    found += [pbrdf.FitTable.columns, pbrdf.PixelFit.fit, pbrdf.PixelFit.used, pbrdf.PixelFit.s0_residuals, pbrdf.PixelFit.noise_polarised]
    assert all(isinstance(attribute, property) and attribute.__doc__ for attribute in found)
    for one in (found for found in vars(pbrdf).values() if dataclasses.is_dataclass(found)):
        assert all(f"\n    {field.name}: " in one.__doc__ for field in dataclasses.fields(one)), one
    assert pbrdf.Summary.q50.__doc__ == "Median." and pbrdf.ModelInfo.citation.__doc__ == "Where it comes from."
    result = pbrdf.fit(simulated(), starts=1, intervals="none")
    # What is made in __init__ alone has no place in help().
    for one in (result, pbrdf.posterior(result, draws=200, chains=1), pbrdf.map_fits([simulated()], starts=1, intervals="none")):
        assert [name for name in vars(one) if not name.startswith("_")] == []


def test_what_notebooks_show():
    data = [simulated(name="A", n=1.8), simulated(name="<B>", n=2.2)]
    joint = pbrdf.fit(data, own="n", fix={"ks": 1.0, "c": 0.0}, starts=1, intervals="linear")
    page = joint._repr_html_()
    assert "<th>A</th><th>&lt;B&gt;</th>" in page and joint.sets[1].parameters["n"].text in page
    # What is shared stands once.
    assert page.count(f"<td>{joint.parameters['k'].text}</td>") == 1
    rows = data[1]._repr_html_()
    assert "24 rows" in rows and "and 12 more rows" in rows and "<td>30</td>" in rows and "dolp_sigma" not in rows
    sample = pbrdf.posterior(pbrdf.fit(data[0], "specular", starts=1, intervals="none"), draws=200, chains=2)
    assert f"{sample.summary['n'].q50:.4g}" in sample._repr_html_() and sample.verdict.split(";")[0] in sample._repr_html_()
    chosen = pbrdf.choose_angles("specular", {"n": 2.07, "k": 2.9}, range(10, 90, 20), range(0, 80, 20), count=6, fix="ks")
    assert "<th>θi / °</th>" in chosen._repr_html_() and "n: standard error" in chosen._repr_html_() and "6 readings" in repr(chosen)
    assert "<td>A</td>" in pbrdf.map_fits(data, starts=1, intervals="none")._repr_html_()


def test_a_tied_parameter_follows_the_other():
    result = pbrdf.fit(simulated(), fix={"ks": 1.0, "c": 0.0}, tie={"kv": (0.5, "kd")}, starts=3)
    assert result.parameters["kv"].value == pytest.approx(0.5 * result.parameters["kd"].value, rel=1e-12)
    # The truth has this ratio.
    assert result.parameters["kd"].value == pytest.approx(TRUTH["kd"], rel=1e-5)


def test_a_range_of_angles_leaves_the_other_rows_out():
    data = simulated()
    ranged = pbrdf.fit(data, starts=1, intervals="linear", theta_i_range=(40, 60), theta_r_range=(10, 50))
    rows = (data.theta_i >= 40) & (data.theta_i <= 60) & (data.theta_r >= 10) & (data.theta_r <= 50)
    assert 0 < rows.sum() < len(data)
    masked = pbrdf.Measurement(data.theta_i, data.theta_r, dolp=data.dolp, brdf=data.brdf, masked=~rows)
    expected = pbrdf.fit(masked, starts=1, intervals="linear")
    assert without_times(ranged.to_dict()) == without_times(expected.to_dict())


def test_a_plot_has_points_and_curves():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    result = pbrdf.fit(simulated(), starts=1, intervals="none")
    axes = result.plot("brdf", ax=plt.figure().add_subplot())
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["θi = 30°", "θi = 50°", "θi = 70°"]
    points = [line for line in axes.lines if line.get_marker() == "o"]
    assert sum(len(line.get_xdata()) for line in points) == 24
    plt.close("all")
    with pytest.raises(pbrdf.PbrdfError, match='expected "dolp" or "brdf"'):
        result.plot("radiance")
    with pytest.raises(pbrdf.PbrdfError, match="set = 3; expected 0 to 0"):
        result.plot(set=3)


def test_progress_is_told_and_falls():
    told = []
    result = pbrdf.fit(simulated(), starts=1, intervals="none", progress=lambda *event: told.append(event))
    assert told and all(len(event) == 3 for event in told)
    assert told[-1][2] <= told[0][2] and result.objective <= told[0][2]


def test_what_progress_raises_ends_the_fit():
    def refuse(*_):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        pbrdf.fit(simulated(), starts=10**6, progress=refuse)


def test_ctrl_c_stops_a_fit(example):
    data = pbrdf.read(example)
    # So many starts take hours: only the signal can end it.
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        pbrdf.fit(data, starts=10**6)
    timer.join()


def test_other_threads_go_on_during_a_fit(example):
    data = pbrdf.read(example)
    results = [None, None]

    def work(index):
        results[index] = pbrdf.fit(data, starts=2, intervals="linear").to_dict()

    threads = [threading.Thread(target=work, args=(index,)) for index in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert without_times(results[0]) == without_times(results[1])


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"model": "cauchi"}, '"cauchi" is no model; expected one of'),
        ({"fix": {"m": 1}}, '"m" is no parameter; expected one of n, k'),
        ({"model": "specular", "fix": {"kd": 1}}, "the model specular has no parameter kd; it has n, k, sigma, ks, q"),
        ({"fix": {"n": math.nan}}, "n = NaN is not allowed"),
        ({"fix": {"n": "two"}}, r"fix\['n'\] is 'two'; expected numbers"),
        ({"fix": {3: 1}}, "fix has the key 3; expected names"),
        ({"fix": 3}, "fix is 3; expected names"),
        ({"bounds": {"n": (2, 1)}}, "to hold a parameter at one value, fix it"),
        ({"bounds": {"n": (math.nan, 1)}}, "n"),
        ({"bounds": {"n": 3}}, r"bounds\['n'\] is 3; expected \(low, high\)"),
        ({"start": {"n": 9.0}, "bounds": {"n": (1, 2)}}, "n = 9 is outside its bounds 1 … 2"),
        ({"start": {"n@B": 1.0}}, "no measurement is called B; there are 1"),
        ({"starts": 0}, "starts = 0; expected a whole number from 1 on"),
        ({"starts": 1.5}, "starts = 1.5; expected a whole number"),
        ({"seed": -1}, "seed = -1; expected a whole number from 0 on"),
        ({"weights": "sigma"}, "has no dolp_sigma.*; state all standard deviations, or fit without weights"),
        ({"weights": "sigmas"}, "weights: there is no `sigmas`, expected `none` or `sigma`"),
        ({"loss": "cauchy"}, "loss: there is no `cauchy`, expected one of"),
        ({"loss_scale": -1.0}, "loss_scale: expected a number above 0"),
        ({"tie": {"kv": (2.0, "kd"), "kd": (0.5, "kv")}}, "is a circle"),
        ({"tie": {"kv": (0.0, "kd")}}, "expected a factor other than 0"),
        ({"tie": {"kv": "kd"}}, r"tie\['kv'\] is 'kd'; expected a factor and a name"),
        ({"theta_i_range": (60, 40)}, r"theta_i_range is \(60, 40\); expected \(low, high\)"),
        ({"theta_r_range": (math.nan, 40)}, "theta_r_range is .*; expected"),
        ({"progress": 3}, "progress: expected a function"),
    ],
)
def test_what_is_wrong_is_refused_in_one_sentence(options, said):
    data = pbrdf.Measurement([30, 50], [40, 50], dolp=[0.1, 0.2])
    with pytest.raises(pbrdf.PbrdfError, match=said) as caught:
        pbrdf.fit(data, **options)
    assert "\n" not in str(caught.value)


def test_data_that_are_none_are_refused():
    with pytest.raises(pbrdf.PbrdfError, match="the list is empty"):
        pbrdf.fit([])
    for wrong in (3, "steel.csv", [[1, 2, 3]]):
        with pytest.raises(pbrdf.PbrdfError, match="expected a Measurement or a list of them"):
            pbrdf.fit(wrong)
    twice = pbrdf.Measurement(30, [40, 50], dolp=[0.1, 0.2], name="A")
    with pytest.raises(pbrdf.PbrdfError, match="two measurements are called A; give each measurement a name of its own"):
        pbrdf.fit([twice, twice])
    with pytest.raises(pbrdf.PbrdfError, match="the model fresnel predicts DoLP|predicts DoLP only"):
        pbrdf.fit(pbrdf.Measurement(30, [40, 50], brdf=[0.1, 0.2]), model="fresnel")


def test_rows_that_are_all_masked_are_a_result_without_data():
    data = pbrdf.Measurement(30, [40, 50], dolp=[0.1, 0.2], masked=True)
    assert pbrdf.fit(data, starts=1).stop_reason == "no_data"
