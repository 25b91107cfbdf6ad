"""Many fits: the same numbers wherever they are made, and nothing lost or done twice when a run dies."""

import concurrent.futures
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import pbrdf

SURFACE = {"n": 2.07, "k": 2.9, "sigma": 0.35}
OPTIONS = {"fix": {"ks": 1.0}, "starts": 1, "intervals": "linear"}


def measured(count, theta_r=range(0, 90, 10)):
    made = (pbrdf.simulate("cauchy", SURFACE, [30, 50, 70], theta_r, noise=0.005, seed=seed) for seed in range(count))
    return [data.renamed(f"run{number:03}") for number, data in enumerate(made)]


def files(folder, count):
    for data in measured(count):
        data.write(folder / f"{data.name}.csv")
    return sorted(folder.glob("run*.csv"))


def test_the_numbers_are_those_of_single_fits():
    data = measured(6)
    table = pbrdf.map_fits(data, **OPTIONS)
    assert table["file"].tolist() == [item.name for item in data]
    for row, item in zip(table, data):
        single = pbrdf.fit(item, **OPTIONS)
        assert row["objective"] == single.objective
        for name, estimate in single.parameters.items():
            assert row[name] == estimate.value
            assert row[f"{name}_std_error"] == estimate.std_error
        assert row["undetermined"] == ("; ".join(single.undetermined) or None)


def test_what_cannot_be_fitted_is_a_row_with_its_sentence(tmp_path):
    good = files(tmp_path, 2)
    damaged = tmp_path / "damaged.csv"
    damaged.write_text("theta_i,theta_r,dolp\n30,95,0.1\n")
    empty = pbrdf.Measurement([30, 40], [30, 40], dolp=[0.1, 0.2], masked=[True, True], name="masked")
    table = pbrdf.map_fits([good[0], damaged, empty, tmp_path / "none.csv", good[1]], **OPTIONS)
    assert np.isfinite(table["n"]).tolist() == [True, False, True, False, True]
    assert set(table.failures) == {str(damaged), str(tmp_path / "none.csv")}
    # Nothing to fit is an ending of a fit, as on the command line.
    assert table["stop_reason"][2] == "no_data"
    assert "line 2" in table.failures[str(damaged)]


def test_a_file_with_several_measurements_becomes_several_rows(tmp_path):
    path = tmp_path / "lab.csv"
    path.write_text("theta_i,theta_r,dolp,set\n30,30,0.1,a\n50,50,0.2,a\n60,60,0.3,b\n70,70,0.4,b\n")
    table = pbrdf.map_fits([path], "specular", **OPTIONS)
    assert table["set"].tolist() == ["a", "b"]


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_rows_stream_to_a_file_and_are_not_made_twice(tmp_path, ending):
    if ending == "parquet":
        pytest.importorskip("pyarrow")
    output = tmp_path / f"results.{ending}"
    data = measured(12)
    first = pbrdf.map_fits(data[:5], output=output, **OPTIONS)
    told = []
    whole = pbrdf.map_fits(data, output=output, progress=lambda *far: told.append(far), **OPTIONS)
    # The first five are there at once, without a time that is left.
    assert told[4][:2] == (5, 12) and told[4][2] is None and told[-1] == (12, 12, 0.0)
    assert list(whole)[:5] == list(first)
    assert list(whole) == list(pbrdf.map_fits(data, **OPTIONS))
    with pytest.raises(pbrdf.PbrdfError, match="other options"):
        pbrdf.map_fits(data, output=output, seed=2, **OPTIONS)


def test_rows_are_those_of_the_command_line(tmp_path, program):
    paths = files(tmp_path, 3)
    program("fit", "--batch", tmp_path / "run*.csv", "-o", tmp_path / "theirs.csv", "--fix", "ks=1", "--starts", "1", "--intervals", "linear")
    pbrdf.map_fits(paths, output=tmp_path / "ours.csv", **OPTIONS)

    def rows(name):
        return [line.split(",") for line in (tmp_path / name).read_text().splitlines() if not line.startswith("#")]

    def value(cell):
        try:
            return float(cell)
        except ValueError:
            return cell

    for ours, theirs in zip(rows("ours.csv"), rows("theirs.csv"), strict=True):
        assert list(map(value, ours)) == list(map(value, theirs))


KILLED = """
import pathlib, sys, pbrdf
folder = pathlib.Path(sys.argv[1])
pbrdf.map_fits(sorted(folder.glob("run*.csv")), output=folder / "results.csv")
"""


@pytest.mark.skipif(os.name != "posix", reason="there is no SIGKILL")
def test_a_run_that_was_killed_goes_on_where_it_was(tmp_path, monkeypatch):
    paths = files(tmp_path, 40)
    output = tmp_path / "results.csv"
    running = subprocess.Popen([sys.executable, "-c", KILLED, str(tmp_path)])
    until = time.monotonic() + 120
    while (not output.exists() or output.read_bytes().count(b"\n") < 6) and time.monotonic() < until:
        time.sleep(0.005)
    running.send_signal(signal.SIGKILL)
    running.wait()
    kept = output.read_bytes()
    done = kept.count(b"\n") - 3
    assert 3 <= done < 40
    # As if it had been killed while writing.
    output.write_bytes(kept[:-20])
    made = []
    fit_chunk = pbrdf._many.fit_chunk

    def counted(tables, *rest):
        made.append(len(tables))
        return fit_chunk(tables, *rest)

    monkeypatch.setattr(pbrdf._many, "fit_chunk", counted)
    pbrdf.map_fits(paths, output=output)
    assert sum(made) == 40 - (done - 1)
    whole = tmp_path / "whole.csv"
    pbrdf.map_fits(paths, output=whole)
    assert output.read_bytes() == whole.read_bytes()


def test_executors_of_threads_and_processes(tmp_path):
    data = measured(6)
    here = list(pbrdf.map_fits(data, **OPTIONS))
    with concurrent.futures.ThreadPoolExecutor(2) as threads:
        assert list(pbrdf.map_fits(data, client=threads, **OPTIONS)) == here
    import multiprocessing

    spawned = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=spawned) as processes:
        assert list(pbrdf.map_fits(data, client=processes, **OPTIONS)) == here


@pytest.mark.filterwarnings("default")
def test_a_dask_cluster_of_two_processes(tmp_path):
    distributed = pytest.importorskip("distributed")
    data = measured(40)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            table = pbrdf.map_fits(data, client=client, output=tmp_path / "results.csv", **OPTIONS)
            assert list(table) == list(pbrdf.map_fits(data, **OPTIONS))
        with pytest.raises(pbrdf.PbrdfError, match="client"):
            pbrdf.map_fits(data, client=client, **OPTIONS)


def test_bad_input_is_refused_in_a_sentence(tmp_path):
    data = measured(1)
    for wrong, sentence in [
        (lambda: pbrdf.map_fits("run.csv"), "items"),
        (lambda: pbrdf.map_fits([3]), r"items\[0\]"),
        (lambda: pbrdf.map_fits(data, client=7), "client"),
        (lambda: pbrdf.map_fits(data, "nothing"), "model"),
        (lambda: pbrdf.map_fits(data, fix={"x": 1.0}), "x"),
        (lambda: pbrdf.map_fits(data, fix={"n@run000": 1.0}), "@run000"),
        (lambda: pbrdf.map_fits(data + data, **OPTIONS), "two items"),
        (lambda: pbrdf.map_fits(data, output=tmp_path / "results.txt"), "neither"),
        (lambda: pbrdf.map_fits(data, **OPTIONS)["m"], "no column"),
    ]:
        with pytest.raises(pbrdf.PbrdfError, match=sentence):
            wrong()
    other = tmp_path / "notes.csv"
    other.write_text("what I need\n")
    with pytest.raises(pbrdf.PbrdfError, match="no table"):
        pbrdf.map_fits(data, output=other)
    assert other.read_text() == "what I need\n"


def test_options_that_many_fits_cannot_have_are_refused():
    data = pbrdf.Measurement(30, [40, 50], dolp=[0.1, 0.2])
    with pytest.raises(pbrdf.PbrdfError, match=r"map_fits has no own: each measurement is fitted by itself; fit\(\[...\], own=...\)"):
        pbrdf.map_fits([data], own="n")
    with pytest.raises(pbrdf.PbrdfError, match="map_fits has no option fixed; it has fix, free, bounds"):
        pbrdf.map_fits([data], fixed="n")
