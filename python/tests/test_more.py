"""Metals, simulations, choices of angles, and draws."""

from __future__ import annotations

import csv
import json
import os
import signal
import threading

import numpy as np
import pbrdf
import pytest

SURFACE = {"n": 2.07, "k": 2.9, "sigma": 0.35}


def test_metals_are_those_of_the_command_line(program):
    printed = json.loads(program("metals", "Cu", "--wavelength", "650", "--json"))["rows"]
    sources = pbrdf.metals("copper")
    assert [source.source for source in sources] == [row["source"] for row in printed] and len(sources) >= 2
    for source, row in zip(sources, printed, strict=True):
        assert source.citation == row["citation"]
        if row["n"] is not None:
            # np.interp rounds once more than the core.
            assert source.index_at(650) == pytest.approx((row["n"], row["k"]), rel=1e-14)
    assert len({source.metal for source in pbrdf.metals()}) > 10


def test_what_is_no_metal_is_refused():
    with pytest.raises(pbrdf.PbrdfError, match='"cheese" is not among the tabulated metals; expected one of Ag'):
        pbrdf.metals("cheese")
    with pytest.raises(pbrdf.PbrdfError, match="1 nm is outside the tabulated range"):
        pbrdf.metals("Cu")[0].index_at([600, 1])
    with pytest.raises(pbrdf.PbrdfError, match="nan nm is outside"):
        pbrdf.metals("Cu")[0].index_at(float("nan"))


def test_a_simulation_is_that_of_the_command_line(program, tmp_path):
    path = tmp_path / "steel.csv"
    program("simulate", "--set", "n=2.07,k=2.9,sigma=0.35", "--theta-i", "30,50", "--theta-r", "20:60:5", "--noise", "0.005", "--seed", "7", "-o", path)
    ours, theirs = pbrdf.simulate("cauchy", SURFACE, [30, 50], np.arange(20, 61, 5), seed=7), pbrdf.read(path)
    assert ours.dolp.tolist() == theirs.dolp.tolist() and ours.theta_r.tolist() == theirs.theta_r.tolist()
    with pytest.raises(pbrdf.PbrdfError, match="noise = -1; expected a standard deviation of 0 or more"):
        pbrdf.simulate("cauchy", SURFACE, 30, 40, noise=-1)
    with pytest.raises(pbrdf.PbrdfError, match='predicts DoLP only, not a BRDF; simulate columns="dolp"'):
        pbrdf.simulate("fresnel", {}, 30, 40, columns="both")
    with pytest.raises(pbrdf.PbrdfError, match="columns: there is no `all`"):
        pbrdf.simulate("cauchy", {}, 30, 40, columns="all")


def test_chosen_angles_are_those_of_the_command_line(program):
    fixed = ["--fix", "ks"]
    printed = json.loads(
        program(
            *["plan", "--set", "n=2.07,k=2.9,sigma=0.35", "--theta-i", "10:80:10", "--theta-r", "0:80:10", "--noise", "0.005"],
            *["--choose", "12", "--json", *fixed],
        )
    )
    chosen = pbrdf.choose_angles("cauchy", SURFACE, range(10, 90, 10), range(0, 90, 10), count=12, fix="ks")
    expected = [(row["theta_i"], row["theta_r"], row["dphi"], row["repeats"]) for row in printed["chosen"]]
    assert list(zip(chosen.theta_i, chosen.theta_r, chosen.dphi, chosen.repeats, strict=True)) == expected
    assert chosen.efficiency == printed["criterion"]["efficiency"] and chosen.std_error == printed["std_error"]


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"count": 0}, "count = 0; expected a whole number from 1 on"),
        ({"count": 3}, "3 values cannot determine"),
        ({"noise": None}, "neither noise nor brdf_noise is given"),
        ({"noise": 0}, "noise = 0; expected a standard deviation above 0"),
        ({"theta_i": [95]}, "theta_i = 95 is outside"),
        ({"theta_i": []}, "a list of angles is empty"),
        ({"wanted": "m"}, '"m" is no parameter'),
        ({"wanted": "n", "fix": "n"}, "n is not free: its error cannot be made small"),
        ({"parameters": []}, "the list is empty; expected at least one surface"),
        ({"parameters": 3}, "parameters: expected values by name"),
        ({"given": 3}, "given: expected a Measurement"),
    ],
)
def test_a_choice_that_is_none_is_refused(changes, said):
    arguments = {"parameters": SURFACE, "theta_i": range(10, 90, 20), "theta_r": range(0, 80, 20), "count": 12} | changes
    with pytest.raises(pbrdf.PbrdfError, match=said):
        pbrdf.choose_angles("cauchy", **arguments)


def test_draws_are_those_of_the_command_line(program, example, tmp_path):
    path = tmp_path / "draws.csv"
    options = ["--model", "specular", "--draws", "200", "--chains", "2", "--prior", "k=normal(2.9, 0.5)"]
    program("posterior", example, *options, "-o", path)
    rows = list(csv.DictReader(line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")))
    result = pbrdf.fit(pbrdf.read(example), model="specular", starts=1, intervals="linear")
    told = []
    sample = pbrdf.posterior(result, draws=200, chains=2, priors={"k": ("normal", 2.9, 0.5)}, progress=told.append)
    for name, draws in sample.draws.items():
        assert draws.shape == (2, 200) and draws.ravel().tolist() == [float(row[name]) for row in rows]
        assert sample.summary[name].mean == pytest.approx(draws.mean())
    assert sample.log_posterior.ravel().tolist() == [float(row["log_posterior"]) for row in rows]
    assert told and all(0 <= share <= 1 for share in told) and sample.verdict in str(sample)


def test_ctrl_c_stops_draws(example):
    result = pbrdf.fit(pbrdf.read(example), model="specular", starts=1, intervals="linear")
    # So many draws take hours: only the signal can end them.
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        pbrdf.posterior(result, draws=10**7, chains=1)
    timer.join()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"draws": 10}, "10 draws of 4 chains are too few"),
        ({"chains": 0}, "chains = 0; expected a whole number from 1 on"),
        ({"priors": {"k": ("gauss", 1, 2)}}, r"priors\['k'\] is .*; expected \(\"normal\", mean, sd\)"),
        ({"priors": {"m": ("normal", 1, 2)}}, '"m" is no parameter'),
        ({"priors": {"kd": ("normal", 1, 2)}}, "kd"),
        ({"priors": {"k": ("normal", 1, -2)}}, "k"),
    ],
)
def test_a_posterior_that_is_none_is_refused(options, said):
    data = pbrdf.Measurement([30, 50, 70], [40, 50, 70], dolp=[0.13, 0.27, 0.52])
    result = pbrdf.fit(data, model="specular", starts=1, intervals="none")
    with pytest.raises(pbrdf.PbrdfError, match=said):
        pbrdf.posterior(result, **options)
    with pytest.raises(pbrdf.PbrdfError, match="expected a FitResult"):
        pbrdf.posterior(data)
