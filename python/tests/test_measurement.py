"""Measurements from arrays and files."""

from __future__ import annotations

import math

import numpy as np
import pbrdf
import pytest


def test_arrays_come_back():
    data = pbrdf.Measurement(
        30, [10, 20, -30], dolp=[0.1, 0.2, 0.3], dolp_sigma=0.01, brdf=[1.0, None, 3.0], masked=[False, True, False], name="A"
    )
    assert len(data) == 3 and data.name == "A"
    assert data.theta_i.tolist() == [30, 30, 30] and data.theta_r.tolist() == [10, 20, 30] and data.dphi.tolist() == [180, 180, 0]
    assert data.dolp.tolist() == [0.1, 0.2, 0.3] and data.dolp_sigma.tolist() == [0.01] * 3
    assert np.array_equal(data.brdf, [1.0, math.nan, 3.0], equal_nan=True) and np.isnan(data.brdf_sigma).all()
    assert data.masked.tolist() == [False, True, False]


def test_masked_arrays_say_what_was_not_measured():
    values = np.ma.masked_invalid([0.1, math.nan, 0.3])
    data = pbrdf.Measurement(30, [10, 20, 30], dolp=values)
    assert np.isnan(data.dolp).tolist() == [False, True, False] and data.masked.tolist() == [False, True, False]


def test_a_file_reads_as_its_columns_say(example):
    lines = [line for line in example.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    header = lines[0].split(",")
    cells = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    data = pbrdf.read(example)
    assert data.name == example.name and data.metadata["simulated"] == "true"
    for name in ("theta_i", "theta_r", "dolp"):
        assert getattr(data, name).tolist() == cells[:, header.index(name)].tolist()


def test_what_is_written_reads_back(tmp_path):
    generator = np.random.default_rng(1)
    data = pbrdf.Measurement(
        generator.uniform(0, 89, 20), generator.uniform(0, 89, 20), generator.uniform(0, 360, 20), dolp=generator.uniform(0, 1, 20), name="A"
    )
    path = tmp_path / "data.csv"
    data.write(path)
    again = pbrdf.read(str(path))
    for name in ("theta_i", "theta_r", "dphi", "dolp"):
        assert getattr(again, name).tolist() == getattr(data, name).tolist()
    assert again.name == "A"


def test_a_file_of_several_is_read_as_a_list(tmp_path):
    path = tmp_path / "two.csv"
    path.write_text("set,theta_i,theta_r,dolp\nA,30,40,0.1\nB,30,40,0.2\n", encoding="utf-8")
    assert [data.name for data in pbrdf.read_all(path)] == ["A", "B"]
    with pytest.raises(pbrdf.PbrdfError, match=r"holds 2 measurements \(A, B\); read_all returns them as a list"):
        pbrdf.read(path)


def test_one_wavelength_of_several_is_the_nearest(tmp_path):
    path = tmp_path / "two.csv"
    path.write_text("Wellenlänge (nm);θi;θr;DoLP [%]\n450;30;40;12,7\n650;30;40;11,0\n", encoding="utf-8")
    assert [data.name for data in pbrdf.read_all(path)] == ["450 nm", "650 nm"]
    assert pbrdf.read(path, wavelength_nm=650).dolp.tolist() == [0.11]
    with pytest.warns(UserWarning, match="640 nm; the nearest was taken, 650 nm"):
        assert pbrdf.read(path, wavelength_nm=640).dolp.tolist() == [0.11]
    with pytest.raises(pbrdf.PbrdfError, match="5000"):
        pbrdf.read(path, wavelength_nm=5000)


def test_columns_can_be_named(tmp_path):
    path = tmp_path / "odd.csv"
    path.write_text("a;b;Messwert\n30;40;12,7\n50;50;26,8\n", encoding="utf-8")
    with pytest.raises(pbrdf.PbrdfError, match="columns=theta_i=1"):
        pbrdf.read(path)
    for columns in ({"theta_i": 1, "theta_r": "b", "dolp": "Messwert:percent"}, "theta_i=1,theta_r=2,dolp=3:percent"):
        assert pbrdf.read(path, columns=columns).dolp.tolist() == pytest.approx([0.127, 0.268], rel=1e-15)
    with pytest.raises(pbrdf.PbrdfError, match="columns: "):
        pbrdf.read(path, columns="theta_x=1")


def test_what_a_reader_has_to_say_is_warned_of(tmp_path):
    path = tmp_path / "more.csv"
    path.write_text("theta_i,theta_r,dolp,operator\n30,40,0.1,7\n", encoding="utf-8")
    for read in (pbrdf.read, pbrdf.read_all):
        with pytest.warns(UserWarning, match="operator") as caught:
            read(path)
        # Where the user wrote it.
        assert caught[0].filename == __file__


def test_rows_beyond_the_horizon_are_left_out_and_written_back(tmp_path):
    path = tmp_path / "far.csv"
    path.write_text("AOI,VA,DoLP\n30,40,0.1\n30,95,0.5\n", encoding="utf-8")
    with pytest.warns(UserWarning, match=r"1 row \(line 3\) at \|θr\| ≥ 90°, where the model ends; left out, and written back as masked"):
        data = pbrdf.read(path)
    assert data.theta_r.tolist() == [40.0]
    data.write(path)
    assert any(line.endswith("30,95,180,0.5,1") for line in path.read_text(encoding="utf-8").splitlines())


def test_columns_are_made_once_and_cannot_be_changed_by_accident():
    data = pbrdf.Measurement(30, [10, 20, 30], dolp=[0.1, 0.2, 0.3])
    for name in ("theta_i", "theta_r", "dphi", "dolp", "dolp_sigma", "brdf", "brdf_sigma", "masked"):
        assert getattr(data, name) is getattr(data, name)
        with pytest.raises(ValueError, match="read-only"):
            getattr(data, name)[0] = 0
    own = data.dolp.copy()
    own[0] = 0.9
    assert data.dolp[0] == 0.1
    pandas = pytest.importorskip("pandas")
    frame = data.to_pandas()
    frame.loc[0, "dolp"] = 0.9
    assert isinstance(frame, pandas.DataFrame) and data.dolp[0] == 0.1


def test_pandas_goes_both_ways():
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame({"theta_i": [30, 30], "theta_r": [40, 50], "dolp": [0.1, math.nan], "brdf": [1.0, 2.0], "who": ["x", "y"]})
    data = pbrdf.Measurement.from_pandas(frame)
    assert np.isnan(data.dolp).tolist() == [False, True]
    assert data.to_pandas()["brdf"].tolist() == [1.0, 2.0] and data.to_pandas()["masked"].tolist() == [False, False]
    with pytest.raises(pbrdf.PbrdfError, match="the column theta_r is missing; the columns are theta_i"):
        pbrdf.Measurement.from_pandas(frame[["theta_i", "dolp"]])


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"dolp": [0.1, math.nan]}, r"dolp\[1\] is NaN; what was not measured is None or masked"),
        ({"dolp": [0.1, 12.0]}, r"dolp\[1\] = 12, expected a DoLP from 0 to 1; divide percent by 100"),
        ({"dolp": [0.1, 1e300]}, r"dolp\[1\] = 1e300, expected"),
        ({"dolp": [0.1, 1.17]}, r"dolp\[1\] = 1.17, .*; divide percent by 100; if it is noise, leave the row out, or mask it"),
        ({"dolp": np.array([0.1 + 0.1j, 0.2])}, "expected real numbers; take its .real, or its absolute values by numpy.abs"),
        ({"dolp": np.array(["0.1", "0.2"])}, r"expected numbers, not text; numpy.asarray\(..., dtype=float\) reads text"),
        ({"dolp": np.array(["2026-01-01", "2026-01-02"], dtype="datetime64[D]")}, "expected numbers, not dates"),
        ({"dolp": [[0.1, 0.2], [0.3]]}, "expected numbers, all rows of one length"),
        ({"dolp": [0.1, -0.1]}, r"dolp\[1\] = -0.1, expected a DoLP from 0 to 1; leave the row out, or mask it"),
        ({"brdf": [0.1, math.inf]}, r"brdf\[1\] = inf, expected a BRDF of 0"),
        ({"dolp_sigma": [0.1, 0.0]}, r"dolp_sigma\[1\] = 0, expected a standard deviation above 0"),
        ({"dolp_sigma": [0.1, math.nan]}, r"dolp_sigma\[1\] = NaN"),
        ({"theta_i": [10, 90]}, r"theta_i = 90 is outside 0 ≤ θi < 90 degrees \(in row 1\)"),
        ({"theta_i": [10, math.nan]}, r"theta_i = NaN .*\(in row 1\)"),
        ({"theta_r": [10, 20, 30]}, "do not broadcast"),
        ({"theta_r": [[10], [20]]}, r"the shape \(2, 2\); expected one row of numbers"),
        ({"dolp": None}, "neither dolp nor brdf is given"),
        ({"dolp": [None, None]}, "no row has a value"),
        ({"dolp": ["a", "b"]}, "expected numbers"),
        ({"dolp": None, "brdf": [1, 2], "dolp_sigma": 0.1}, "dolp_sigma is given without dolp"),
        ({"masked": [0, 3]}, "masked: expected True or False"),
        ({"name": 3}, "name is 3; expected a name"),
    ],
)
def test_what_is_wrong_is_refused_in_one_sentence(changes, said):
    arguments = {"theta_i": [10, 20], "theta_r": [10, 20], "dolp": [0.1, 0.2]} | changes
    with pytest.raises(pbrdf.PbrdfError, match=said) as caught:
        pbrdf.Measurement(**arguments)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("theta_i,theta_r,dolp\n30,40,x\n", r"line 2, column 3 \(dolp\): found \"x\", expected a DoLP from 0 to 1"),
        ("theta_i,theta_r,dolp\n30,40,0.4\n30,50,1.17\n", "found 1.17.*; if the column holds percent, name it dolp_percent.*; a row with # before"),
        ("theta_i,theta_r,dolp\n30,40,12\n", "if the column holds percent, name it dolp_percent"),
        ("", "the file is empty"),
    ],
)
def test_a_damaged_file_is_refused_with_its_place(tmp_path, text, said):
    path = tmp_path / "damaged.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(pbrdf.PbrdfError, match=said) as caught:
        pbrdf.read(path)
    assert str(path) in str(caught.value)


def test_a_file_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(pbrdf.PbrdfError, match="there is no such file"):
        pbrdf.read(tmp_path / "nowhere.csv")
    with pytest.raises(pbrdf.PbrdfError, match="this is a directory"):
        pbrdf.read(tmp_path)
    with pytest.raises(pbrdf.PbrdfError, match="path is a int"):
        pbrdf.read(3)
