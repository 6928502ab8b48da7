"""The package as a person uses it: objects, errors, interruption, types, notebooks."""

from __future__ import annotations

import copy
import inspect
import os
import pathlib
import pickle
import random
import signal
import subprocess
import sys
import textwrap
import threading
import types

import numpy as np
import pytest

import interwell as iw
from conftest import ROOT


def test_the_example_of_the_documents(tmp_path: pathlib.Path) -> None:
    scene = iw.Scene.preset("paper").set(excitation={"amplitude_g": 1.3})
    assert scene["excitation.amplitude_g"] == 1.3
    run = scene.run(dt=1e-3)
    assert run.t.shape == run.x.shape == run.v.shape == run.energy.shape == (10001,)
    assert run.t is run.t and type(run.t.base).__name__ == "PySliceContainer", "no copy is made"
    assert run.summary["rms_velocity_m_per_s"] > 0.0
    assert run.events.dtype.names == ("t_s", "kind", "side", "v_in_m_per_s", "v_out_m_per_s")
    assert {"impact", "release"} <= set(run.events["kind"])
    grid = scene.sweep(
        {
            "stops.travel_limit_mm": np.linspace(0.5, 7, 5),
            "excitation.amplitude_g": np.linspace(0, 2, 9),
        },
        progress=True,
    )
    assert grid["rms_velocity_m_per_s"].shape == grid.shape == (5, 9)
    assert grid.to_pandas().attrs["units"]["rms_velocity_m_per_s"] == "m/s"
    data = grid.to_xarray()
    assert data.rms_velocity_m_per_s.dims == ("travel_limit_mm", "amplitude_g")
    assert data.rms_velocity_m_per_s.attrs["units"] == "m/s"
    assert scene.threshold("excitation.amplitude_g", (0, 2))["value"][0] > 0.0
    picture = grid.plot("rms_velocity_m_per_s")
    assert picture._repr_svg_().startswith("<svg")
    picture.save(tmp_path / "map.pdf")
    assert (tmp_path / "map.pdf").read_bytes().startswith(b"%PDF")
    assert os.listdir(tmp_path) == ["map.pdf"]


def test_energy_is_kept_without_losses() -> None:
    scene = iw.Scene.preset("nominal-cubic").set(
        damping="None", stops="None", excitation="None", start="At(x_mm: 3, v_m_per_s: 0)"
    )
    energy = scene.run().energy
    assert np.ptp(energy) < 1e-7 * np.abs(energy).max()
    run = scene.run()
    assert run.energy is run.energy and not run.energy.flags.writeable
    whole = 0.5 * (1e-3 * scene["mass_g"]) * run.v**2 + scene.curve(run.x)["potential_j"]
    assert (run.energy == whole).all() and (energy == whole).all()


def test_walks_have_the_order_of_the_fields() -> None:
    scene = iw.Scene.preset("duffing").set({"run.duration_s": 60, "run.settle_s": 30})
    over = {"damping.c_n_s_per_m": [0.02, 0.03], "excitation.amplitude_g": [0.02, 0.03, 0.04]}
    both = scene.sweep(over, carry="both")
    assert both.shape == (2, 2, 3) and both.dims == ("c_n_s_per_m", "direction", "amplitude_g")
    assert (both["amplitude_g"] == np.array([0.02, 0.03, 0.04])).all()
    for index, way in enumerate(["up", "down"]):
        one = scene.sweep(over, carry=way)
        assert (one["amplitude_g"] == np.array([0.02, 0.03, 0.04])).all()
        assert (one["rms_velocity_m_per_s"] == both["rms_velocity_m_per_s"][:, index]).all()
    assert both.to_xarray().rms_velocity_m_per_s.sel(direction="down").shape == (2, 3)


@pytest.mark.parametrize("carry", ["up", "down", "both"])
def test_walks_over_one_field(carry: str) -> None:
    scene = iw.Scene.preset("duffing").set({"run.duration_s": 60, "run.settle_s": 30})
    field, values = "excitation.amplitude_g", np.array([0.02, 0.03, 0.04])
    grid = scene.sweep({field: values}, carry=carry)
    assert grid.shape == ((2, 3) if carry == "both" else (3,))
    assert (grid["amplitude_g"] == values).all()
    data, frame = grid.to_xarray(), grid.to_pandas()
    assert (data.amplitude_g == values).all()
    for way in ["up", "down"] if carry == "both" else [carry]:
        order = values if way == "up" else values[::-1]
        rows = frame[frame.direction == way].reset_index(drop=True)
        assert (rows.amplitude_g == order).all(), "rows are those of the CSV"
        walked = data.sel(direction=way) if carry == "both" else data
        assert (walked.direction == way).all()
        for value, rms in zip(rows.amplitude_g, rows.rms_velocity_m_per_s):
            assert walked.rms_velocity_m_per_s.sel(amplitude_g=value) == rms
    assert len(set(frame.rms_velocity_m_per_s)) > 2, "the order matters"


def test_yes_and_no() -> None:
    paper = iw.Scene.preset("paper")
    assert paper["run.recurrence"] is True and paper["mechanism.plane_strain"] is False
    assert paper.set(title="true")["title"] == "true"
    assert paper.orbit()["stable"].dtype == paper.threshold()["undecided"].dtype == bool
    settled = paper.sweep({"mass_g": [10, 15]}, columns="settled")
    assert settled["settled"].tolist() == [True, True] and "true" in settled.csv()
    starts = iw.Scene.preset("paper").basins((-4, 4, 5), (-0.2, 0.2, 3))
    assert starts["sure"].dtype == object and set(starts["sure"]) == {True, None}
    assert starts["x_mm"].reshape(5, 3)[:, 0].tolist() == [-4, -2, 0, 2, 4]
    assert np.isnan(starts["attractor"]).tolist() == [sure is None for sure in starts["sure"]]
    quiet = paper.set(excitation="None", stops="None").run().events
    assert len(quiet) == 0 and quiet.dtype["kind"].kind == "U"


def test_arrays_are_made_once_and_stay(tmp_path: pathlib.Path) -> None:
    scene = iw.Scene.preset("paper")
    grid, run = scene.sweep({"mass_g": [10, 15]}, carry="down"), scene.run()
    for array in (grid["mass_g"], grid["regime"], run.events, run["phase"], run.x):
        assert not array.flags.writeable
    assert grid["regime"] is grid["regime"]
    grid.to_xarray().rms_velocity_m_per_s[0] = 0.0
    assert run["x_m"] is run.x and run.csv() == run.samples.csv() and list(run) == run.samples.columns
    assert run.to_pandas().equals(run.samples.to_pandas())
    run.to_csv(tmp_path / "run.csv")
    assert (tmp_path / "run.csv").read_text() == run.csv()


def test_a_column_is_named_without_its_unit_or_by_a_hint() -> None:
    scene = iw.Scene.preset("nominal-cubic").set({"run.duration_s": 2, "run.settle_s": 1})
    full = scene.sweep({"mass_g": [10, 12]}, columns=["rms_velocity_m_per_s", "max_abs_x_m"])
    short = scene.sweep({"mass_g": [10, 12]}, columns=["rms_velocity", "max_abs_x"])
    assert short.csv() == full.csv()
    assert "travel_m" in scene.sweep({"mass_g": [10, 12]}, columns="travel").columns
    with pytest.raises(iw.SceneError, match="did you mean `rms_velocity_m_per_s`"):
        scene.sweep({"mass_g": [10, 12]}, columns="rms_velocty")
    with pytest.raises(KeyError, match="did you mean rms_velocity_m_per_s. There are "):
        full["rms_velocity"]


def test_a_scene_is_a_mapping_that_stays() -> None:
    scene = iw.Scene.preset("paper")
    assert "stops" in scene and "stop" not in scene and 3 not in scene
    assert list(scene) == scene.fields and dict(scene)["mass_g"] == scene["mass_g"]
    for field, meant in [("amplitude_g", "excitation.amplitude_g"), ("mas_g", "mass_g")]:
        with pytest.raises(KeyError, match=f"did you mean {meant}"):
            scene[field]
    with pytest.raises(AttributeError, match="set\\(mass_g="):
        scene.mass_g = 3
    changed = scene.set(mass_g=20)
    assert changed != scene and changed.set(mass_g=scene["mass_g"]) == scene != "paper"
    assert len({scene, iw.Scene("paper"), changed}) == 2
    assert "changed" in repr(changed) and "changed" not in repr(scene)
    for thing in (scene, scene.sweep({"mass_g": [15]}), scene.run()):
        assert thing._ipython_key_completions_() == list(thing)


def test_values_of_set() -> None:
    xarray = pytest.importorskip("xarray")
    scene = iw.Scene.preset("paper")
    for value in (np.array(3.5), xarray.DataArray(3.5), np.float32(3.5)):
        assert scene.set(mass_g=value)["mass_g"] == 3.5
    count = "mechanism.parallel.count"
    assert scene.set({count: scene[count]}) == scene, "a count is read as a float"
    parts = [{"Linear": {"n_per_m": 3}}, {"Cubic": {"linear_n_per_m": -40, "cubic_n_per_m3": np.float64(8e5)}}]
    written = "Sum([Linear(n_per_m: 3), Cubic(linear_n_per_m: -40, cubic_n_per_m3: 8e5)])"
    assert scene.set(mechanism={"Sum": parts}) == scene.set(mechanism=written)
    table = scene.set(mechanism={"Table": {"path": pathlib.Path("force_dl2.7.csv"), "tolerance": 1e-4}})
    assert table["mechanism.path"] == "force_dl2.7.csv"
    for name in iw.presets():
        scene = iw.Scene.preset(name).set({"run.duration_s": 0.1, "run.settle_s": 0.05})
        assert scene.set(scene.run().summary["scene"]) == scene, name
    open_circuit = iw.Scene.preset("harvester").set({"transducer.load_ohm": float("inf")})
    assert open_circuit.set(open_circuit.run().summary["scene"]) == open_circuit


def test_scenes_are_pickled(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cubic = iw.Scene.preset("nominal-cubic")
    of_a_function = cubic.with_force(lambda x: -40 * x + 8e5 * x**3, (-9e-3, 9e-3))
    for scene in (iw.Scene.preset("walking"), cubic.set(mass_g=20), of_a_function):
        assert copy.copy(scene) is copy.deepcopy(scene) is scene
        again = pickle.loads(pickle.dumps(scene))
        assert again == scene and hash(again) == hash(scene) and repr(again) == repr(scene)
        assert again.run().csv() == scene.run().csv()
    # a scene with a file beside it
    (tmp_path / "force.csv").write_text(cubic.curve().csv())
    path = str(tmp_path / "force.csv")
    table = cubic.set(mechanism={"Table": {"path": path, "tolerance": 1e-6}})
    (tmp_path / "scene.ron").write_text(table.text.replace(path, "force.csv"))
    monkeypatch.chdir(tmp_path)
    scene = iw.Scene("scene.ron")
    pickled = pickle.dumps(scene)
    monkeypatch.chdir("/")
    again = pickle.loads(pickled)
    assert again == scene and again["mechanism.path"] == path and hash(again) == hash(scene)
    assert again.run().csv() == scene.run().csv()
    (tmp_path / "force.csv").unlink()
    monkeypatch.chdir(tmp_path)
    with pytest.raises(TypeError, match="force.csv"):
        pickle.dumps(scene)


def test_answers_are_compared_and_not_pickled() -> None:
    scene = iw.Scene.preset("paper")
    run, grid = scene.run(), scene.sweep({"mass_g": [15]}, columns="all")
    assert run.samples == scene.run().samples != scene.run(dt=0.1).samples
    assert grid == scene.sweep({"mass_g": [15]}, columns="all") != run.samples
    assert copy.deepcopy(grid) is grid and copy.deepcopy(run) is run
    for answer, instead in [(run, "summary"), (grid, "to_pandas"), (run.plot(), "save")]:
        with pytest.raises(TypeError, match=instead):
            pickle.dumps(answer)


def test_names_of_compared_scenes() -> None:
    cubic = iw.Scene.preset("nominal-cubic")
    near = cubic.set({"stops.travel_limit_mm": 2})
    table = cubic.compare(near, near, "monostable", near=near)
    names = ["nominal-cubic", "nominal-cubic (changed)", "nominal-cubic (changed) 2", "monostable", "near"]
    assert table["scene"].tolist() == names
    assert len(set(table["release_g"][[1, 2, 4]])) == 1
    assert near.compare(cubic)["scene"].tolist() == ["nominal-cubic (changed)", "nominal-cubic"]


def test_what_is_shown() -> None:
    scene = iw.Scene.preset("paper")
    over = {"mass_g": [10, 15], "excitation.amplitude_g": [0.5, 1, 1.5]}
    assert repr(scene.sweep(over)).startswith("<Grid 2 x 3: mass_g, amplitude_g, ")
    assert repr(scene.curve().plot()).startswith("<Picture")
    assert repr(scene) == "<Scene 'built-in paper': Prototype with travel limits>"


def test_a_missing_folder_is_named(tmp_path: pathlib.Path) -> None:
    scene, path = iw.Scene.preset("paper"), tmp_path / "no" / "file.csv"
    for write in (scene.save, scene.curve().to_csv, scene.curve().plot().save):
        place = path.with_suffix(".svg") if "save" in write.__name__ else path
        with pytest.raises(FileNotFoundError) as caught:
            write(place)
        assert caught.value.filename == str(place)
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(OSError) as failed:
        scene.curve().to_csv(tmp_path / "folder.csv")
    assert failed.value.filename == str(tmp_path / "folder.csv")
    assert os.listdir(tmp_path) == ["folder.csv"]


def test_maximize_is_not_the_word() -> None:
    with pytest.raises(TypeError, match="maximise"):
        iw.Scene.preset("paper").best({"mass_g": (1, 2)}, maximize="max_abs_x_m")



def coil() -> iw.Scene:
    return iw.Scene.preset("harvester").set({"transducer.inductance_mh": 10})


def test_a_sweep_with_a_coil_carries_its_state_up_and_down() -> None:
    scene = coil().set({"stops": "None", "excitation.frequency_hz": 12})
    amplitudes = np.arange(0.2, 2.3, 0.2)
    up, down = (
        scene.sweep({"excitation.amplitude_g": amplitudes}, carry=direction)["rms_velocity_m_per_s"]
        for direction in ("up", "down")
    )
    # All of these motions repeat. Up to 1.2 g and from 1.6 g on both directions end on the same one; at 1.4 g the way
    # up is still intrawell, the way down still interwell.
    same = np.arange(len(amplitudes)) != 6
    np.testing.assert_allclose(up[same], down[same], rtol=1e-6)
    assert down[6] > 2.5 * up[6]


BAD = [
    (lambda: iw.Scene.preset("papre"), "papre", ""),
    (lambda: iw.Scene("no/such.ron"), "no/such.ron", ""),
    (lambda: iw.Scene.from_text("(title: 3)"), "scene", ""),
    (lambda: iw.Scene.preset("paper").set(mass_g=-1), "mass_g", "mass_g"),
    (lambda: iw.Scene.preset("paper").set(mass=1), "mass", ""),
    (lambda: iw.Scene.preset("paper").set(stops={"travel_limit_mm": float("nan")}), "travel", ""),
    (lambda: iw.Scene.preset("paper").set(stops="Rigid(travel_limit_mm: 1"), "stops", ""),
    (lambda: iw.Scene.preset("paper").run(dt=0), "dt", "dt"),
    (lambda: iw.Scene.preset("paper").run(dt=1e-12), "dt", "dt"),
    (lambda: iw.Scene.preset("paper").run(at=[99.0]), "at", "at"),
    (lambda: iw.Scene.preset("paper").run(until_settled=1), "until_settled", "until_settled"),
    (lambda: iw.Scene.preset("paper").sweep({"stops.limit": [1]}), "stops.limit", "stops.limit"),
    (lambda: iw.Scene.preset("paper").sweep({"stops.travel_limit_mm": []}), "no values", ""),
    (lambda: iw.Scene.preset("paper").sweep({"stops.travel_limit_mm": ["x"]}), "numbers", ""),
    (lambda: iw.Scene.preset("paper").sweep({"stops.travel_limit_mm": [[1, 2]]}), "shape", ""),
    (lambda: iw.Scene.preset("paper").sweep({"stops.travel_limit_mm": [-1]}), "stops.travel_limit_mm", ""),
    (lambda: iw.Scene.preset("paper").sweep({"mass_g": [1]}, columns="rms"), "columns", "columns"),
    (lambda: iw.Scene.preset("paper").sweep({"mass_g": [1]}, carry="left"), "carry", "carry"),
    (lambda: coil().escape(), "no noise", ""),
    (lambda: iw.Scene.preset("paper").threshold("mass_g", (2, 1)), "lower end first", "range"),
    (lambda: iw.Scene.preset("paper").threshold(step="a"), "number", "step"),
    (lambda: iw.Scene.preset("paper").threshold(step=0), "above 0", "step"),
    (lambda: iw.Scene.preset("paper").threshold(of="bliss"), "of", "of"),
    (lambda: iw.Scene.preset("paper").threshold(runs=5), "`probability`", "runs"),
    (lambda: iw.Scene.preset("paper").threshold(probability=0.5, melnikov=True), "`probability`", "melnikov"),
    (lambda: iw.Scene.preset("paper").threshold(probability=1.5), "below 1", "probability"),
    (lambda: iw.Scene.preset("paper").threshold(probability=0.5), "noise", ""),
    (lambda: iw.Scene.preset("paper").basins((1, -1, 3), (0, 1, 2)), "reversed", "x_mm"),
    (lambda: iw.Scene.preset("paper").orbit(phase_deg=float("inf")), "phase_deg", "phase_deg"),
    (lambda: iw.Scene.preset("paper").branch("mass_g", 1, 1), "both", "end"),
    (lambda: iw.Scene.preset("paper").branch("mass_g", 1, 2, step=1), "0.05", "step"),
    (lambda: iw.Scene.preset("paper").branch("mass_g", 1, 2, count=0), "count", "count"),
    (lambda: iw.Scene.preset("paper").branch("mass_g", 1, 2, switch=11), "switch", "switch"),
    (lambda: iw.Scene.preset("paper").branch("run.tolerance", 1e-9, 1e-8), "does not depend", "field"),
    (lambda: iw.Scene.preset("paper").locus("bang", "mass_g", (1, 2), "mass_g", (1, 2)), "event", "event"),
    (lambda: iw.Scene.preset("paper").locus("fold", "mass_g", (1, 2), "mass_g", (1, 2)), "already", "second"),
    (lambda: iw.Scene.preset("paper").section(skip=3), "keep", "skip"),
    (lambda: iw.Scene.preset("paper").exponents(periods=0), "periods", "periods"),
    (lambda: iw.Scene.preset("paper").spectrum("y"), "of", "of"),
    (lambda: iw.Scene.preset("paper").spectrum(rate_hz=-1), "rate_hz", "rate_hz"),
    (lambda: iw.Scene.preset("paper").best({}), "over", "over"),
    (lambda: iw.Scene.preset("paper").best({"mass_g": (1, 2)}, maximise="joy"), "maximise", "maximise"),
    (lambda: iw.Scene.preset("paper").with_force(lambda x: 1 / 0, (-1, 1)), None, None),
    (lambda: iw.Scene.preset("paper").with_force(lambda x: float("nan"), (-1, 1)), "finite", "force"),
    (lambda: iw.Scene.preset("paper").with_force(lambda x: x, (1, -1)), "smaller first", "range"),
    (lambda: iw.Scene.preset("paper").with_force(lambda x: x, (-1, 1), tolerance="a"), "number", "tolerance"),
    (lambda: iw.Scene.preset("paper").with_force(lambda x: x, (-1, 1), tolerance=1), "1e-10", "tolerance"),
    (lambda: iw.Scene.preset("paper").with_force(lambda x: x, (-1, 1), breaks="a"), "numbers", "breaks"),
    (lambda: iw.Scene.preset("paper").with_force(lambda x: x, (-1, 1), breaks=[2]), "inside", "breaks"),
    (lambda: iw.Scene.preset("paper").with_force(lambda x: "a", (-1, 1)), "must return a number", "force"),
    (lambda: iw.Scene.preset("paper").with_force(([0, 1, 2, 2], [0, 1, 2, 3])), "sort them", "force"),
    (lambda: iw.Scene.preset("paper").with_force(([0, 1], [0, 1]), (0, 1)), "leave it out", "range"),
    (lambda: iw.Scene.preset("paper").with_force([1, 2, 3]), "a function", "force"),
    (lambda: iw.Scene.preset("paper").with_drive(lambda t: float("inf"), 3.0), "finite", "acceleration"),
    (lambda: iw.Scene.preset("paper").with_drive(lambda t: float(t > 0.1), 3.0), "Recorded", "acceleration"),
    (lambda: iw.Scene.preset("paper").with_drive([], 3.0), "0 samples", "acceleration"),
    (lambda: iw.Scene.preset("paper").with_drive([1.0, 2.0], 1 / 3), "0.33333333333", "frequency_hz"),
    (lambda: iw.Scene.preset("paper").with_drive([1.0, 2.0], "a"), "number", "frequency_hz"),
    (lambda: iw.Scene.preset("paper").with_drive([1.0, 2.0], 3.0, tolerance="a"), "number", "tolerance"),
    (lambda: iw.identify("no.csv", "damping"), "no.csv", ""),
    (lambda: iw.identify("no.csv", "joy"), "of", "of"),
    (lambda: iw.identify("no.csv", "damping", start=5, end=2), "`end`, which is 2", "start"),
    (lambda: iw.identify("no.csv", "damping", base="accel_g"), "restitution", "base"),
    (lambda: iw.Scene.preset("paper").orbit().plot(), "picture", "plot"),
    (lambda: iw.Scene.preset("paper").sweep({}), "over", "over"),
    (lambda: iw.Scene.preset("paper").sweep({"mass_g": [15]}, threads=0), "threads", "threads"),
    (lambda: iw.Scene.preset("paper").sweep({"mass_g": [15]}, threads=-1), "threads", "threads"),
    (lambda: iw.Scene.preset("paper").sweep({"mass_g": [15]}, threads=1025), "give 1 to 1024", "threads"),
    (lambda: iw.Scene.preset("paper").basins((0, 1, 2), (0, 1, 2), threads=5000), "1024", "threads"),
    (lambda: iw.Scene.preset("paper").basins((0, 1, -1), (0, 1, 2)), "x_mm", "x_mm"),
    (lambda: iw.Scene.preset("paper").orbit(period=0), "period", "period"),
    (lambda: iw.Scene.preset("paper").exponents(periods=-1), "periods", "periods"),
    (lambda: iw.Scene.preset("paper").curve().to_csv("curve.parquet"), "to_pandas", "path"),
    (lambda: iw.Scene.preset("paper").curve([99.0]), "99", "positions"),
    (lambda: iw.Scene.preset("paper").curve("x"), "numbers", "positions"),
    (lambda: iw.Scene.preset("paper").set([("mass_g", 3)]), "dict", "changes"),
    (lambda: iw.Scene.preset("paper").run(at=[[0, 1], [2, 3]]), "shape (2, 2)", "at"),
    (lambda: iw.Scene.preset("paper").with_force(lambda x: x, (-1, 0, 1)), "(first, last)", "range"),
    (lambda: iw.Scene.preset("paper").threshold(range=(0, 1, 2)), "(first, last)", "range"),
    (lambda: iw.Scene.preset("paper").threshold(range="01"), "(first, last)", "range"),
    (lambda: iw.Scene.preset("paper").threshold(range=1), "(first, last)", "range"),
    (lambda: iw.Scene.preset("paper").basins((0, 1), (0, 1, 2)), "(first, last, count)", "x_mm"),
    (lambda: iw.Scene.preset("paper").basins((0, 1, 2), (0, "a", 2)), "numbers", "v_m_per_s"),
    (lambda: iw.Scene.preset("paper").basins((0, 1, 2), (1, -1, 3)), "reversed", "v_m_per_s"),
    (lambda: iw.Scene.preset("paper").sweep({"mass_g": [15]}, uncertain={"damping.xi": float("nan")}),
     "not finite", "uncertain"),
    (lambda: iw.Scene.preset("paper").basins((0, 1, 2.5), (0, 1, 2)), "whole number", "x_mm"),
    (lambda: iw.Scene.preset("paper").basins((0, 1, 2, 3), (0, 1), random=9), "count", "x_mm"),
    (lambda: iw.Scene.preset("paper").best({"mass_g": (1,)}), "largest", "mass_g"),
    (lambda: iw.Scene.preset("paper").best({"mass_g": (1, 2, 3, 4)}), "step", "mass_g"),
    (lambda: iw.Scene.preset("paper").best([("mass_g", 1, 2)]), "dict", "over"),
    (lambda: iw.Scene.preset("paper").best({"mass_g": (1, 2)}, vary=["mass_g"]), "dict", "vary"),
    (lambda: iw.Scene.preset("paper").best({"mass_g": (1, 2)}, vary={"mass_g": 0.1}), "deviation", "vary"),
    (lambda: iw.Scene.preset("paper").best({"mass_g": (1, 2)}, subject_to=3), "text", "subject_to"),
    (lambda: iw.Scene.preset("paper").sweep([("mass_g", [1])]), "dict", "over"),
    (lambda: iw.Scene.preset("paper").sweep({"mass_g": [15]}, columns=[3]), "text", "columns"),
    (lambda: iw.Scene.preset("paper").sweep({"mass_g": [15]}, progress="yes"), "function", "progress"),
    (lambda: iw.Scene.preset("paper").compare(["balanced"]), "one by one", "others"),
    (lambda: iw.Scene.preset("paper").compare(until=60), "scenes", "until"),
    (lambda: iw.Scene.preset("paper").curve().plot(x=(2, 1)), "lower first", "x"),
    (lambda: iw.Scene.preset("paper").curve().plot(y=(1, float("inf"))), "finite", "y"),
    (lambda: iw.Scene.preset("paper").run().plot(x=(1,)), "(low, high)", "x"),
    (lambda: iw.Scene.preset("paper").curve().plot(height_mm=60), "width_mm", "height_mm"),
    (lambda: iw.Scene.preset("paper").curve().plot(width_mm=50), "room for text", "width_mm"),
    (lambda: iw.Scene.preset("paper").run().plot(x=(8, 12)), "within the run", "x"),
    (lambda: iw.Scene.preset("paper").run().plot("speed"), "no such panel", "panels"),
    (lambda: iw.Scene.preset("paper").spectrum().plot("phase"), "amplitude or psd", "quantity"),
    (lambda: iw.Scene.preset("paper").exponents({"mass_g": [1, 2], "damping.xi": [0.1, 0.2]}).plot(),
     "over one field", "plot"),
]


@pytest.mark.parametrize("number", range(len(BAD)))
def test_bad_input_is_one_clear_error(number: int) -> None:
    make, text, field = BAD[number]
    if text is None:
        with pytest.raises(ZeroDivisionError):
            make()
        return
    with pytest.raises(iw.SceneError) as caught:
        make()
    message = str(caught.value)
    assert text in message and message.strip()
    assert "--" not in message, "arguments have the names of Python"
    faults = caught.value.faults
    assert faults and all(isinstance(fault, iw.Fault) and fault.problem for fault in faults)
    if field:
        assert field in [fault.field for fault in faults]


def test_a_text_in_place_of_a_number_is_a_fault_of_its_argument() -> None:
    arguments = {
        "sweep": ({"mass_g": [15]},),
        "branch": ("mass_g", 1, 2),
        "locus": ("fold", "mass_g", (1, 2), "damping.xi", (0.1, 0.2)),
        "basins": ((0, 1, 2), (0, 1, 2)),
        "best": ({"mass_g": (1, 2)},),
        "with_force": (lambda x: x, (-1, 1)),
        "with_drive": ([1.0, 2.0], 3.0),
        "identify": ("no.csv", "force"),
    }
    scene = iw.Scene.preset("paper")
    questions = [getattr(scene, name) for name in dir(iw.Scene) if not name.startswith("_")]
    questions = [question for question in questions if callable(question)]
    tried = 0
    for question in [*questions, iw.identify, scene.curve().plot]:
        signature = inspect.signature(question)
        for name, parameter in signature.parameters.items():
            if str(parameter.annotation).removesuffix(" | None") not in ("float", "int"):
                continue
            given = signature.bind(*arguments.get(question.__name__, ())).arguments
            if question.__name__ == "threshold" and name in ("runs", "within"):
                given["probability"] = 0.5
            with pytest.raises(iw.SceneError) as caught:
                question(**{**given, name: "a"})
            assert [fault.field for fault in caught.value.faults] == [name], (question, name)
            tried += 1
    assert tried > 40, "the signatures are read"


def test_an_answer_has_remarks() -> None:
    one_well = iw.Scene("monostable")
    assert "no barrier between two wells" in " ".join(one_well.threshold().words)
    weak = iw.Scene("paper").threshold(range=(0, 0.1), step=0.05, over={"mass_g": [15, 16]})
    assert "2 of 2 rows have no value" in weak.words[0] and "--" not in " ".join(weak.words)
    noisy = iw.Scene("paper").set(excitation="Noise(rms_g: 0.8, low_hz: 0.5, high_hz: 20, seed: 1)")
    assert "of 3 runs escaped" in noisy.escape(runs=3, within=1).words[0]
    few = noisy.threshold("excitation.rms_g", (0, 0.01), probability=0.5, runs=3, within=1)
    assert "`within` a longer time" in few.words[0]
    compared = one_well.compare("paper").words
    assert any("no release_g: it rests on no stop" in words for words in compared)
    assert len(iw.Scene("duffing").exponents(periods=5).words) == 1


def test_a_noisy_force_is_followed_as_closely_as_it_is_known(tmp_path: pathlib.Path) -> None:
    places = np.linspace(-8e-3, 8e-3, 401)
    pull = np.concatenate([places, places[::-1]])
    noise = 5e-3 * np.random.default_rng(1).standard_normal(len(pull))
    path = tmp_path / "pull.csv"
    rows = np.column_stack([pull, -40 * pull + 8e5 * pull**3 + noise])
    np.savetxt(path, rows, delimiter=",", header="x_m,force_n", comments="")
    fitted = iw.identify(path, "force")
    assert fitted.tolerance is not None and 0.01 < fitted.tolerance < 0.1
    scene = iw.Scene("nominal-cubic").with_force(fitted)
    assert scene["mechanism.error_n"] > 1e-3
    wells = [place for place, is_stable in scene.equilibria if is_stable]
    assert len(wells) == 2 and abs(wells[1] - 0.05**0.5 / 1e3**0.5) < 1e-4
    exact = iw.Scene("nominal-cubic").with_force(fitted, tolerance=1e-3)
    assert exact["mechanism.error_n"] < scene["mechanism.error_n"]


def test_texts_at_random_make_no_panic() -> None:
    texts = [path.read_bytes() for path in sorted((ROOT / "tests/corpus/scene").iterdir())]
    chance = random.Random(7)
    for _ in range(300):
        whole = bytearray(chance.choice(texts))
        for _ in range(chance.randrange(4)):
            if whole:
                whole[chance.randrange(len(whole))] = chance.randrange(256)
        try:
            iw.Scene.from_text(whole.decode(errors="replace"))
        except (iw.SceneError, iw.ComputationError):
            pass


def in_a_process(program: str, interrupted: bool = False) -> subprocess.CompletedProcess[str]:
    process = subprocess.Popen(
        [sys.executable, "-u", "-c", textwrap.dedent(program)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    if interrupted:
        assert process.stdout is not None
        assert process.stdout.readline() == "begun\n"
        process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=120)
    return subprocess.CompletedProcess([], process.returncode, out, err)


@pytest.mark.parametrize(
    "question",
    [
        "scene.run(dt=1e3)",
        "scene.sweep({'excitation.amplitude_g': np.linspace(1, 1.4, 4000)})",
        "scene.exponents(periods=10_000_000)",
        "iw.Scene('duffing-chaos').orbit(period=1000)",
    ],
)
def test_interruption_ends_a_question(question: str) -> None:
    done = in_a_process(
        f"""
        import threading, time
        import numpy as np
        import interwell as iw
        scene = iw.Scene.preset("paper-unconstrained").set({{
            "excitation.amplitude_g": 1.3, "run.duration_s": 1e6, "run.recurrence": False}})
        threading.Timer(0.5, lambda: print("begun", flush=True)).start()
        try:
            {question}
        except KeyboardInterrupt:
            print("interrupted")
        """,
        interrupted=True,
    )
    assert done.stdout.endswith("interrupted\n"), done.stderr


@pytest.mark.parametrize("question", ["run", "plot", "csv"])
def test_other_threads_go_on(question: str) -> None:
    count, over = 0, threading.Event()

    def counted() -> None:
        nonlocal count
        while not over.is_set():
            count += 1

    thread = threading.Thread(target=counted)
    scene = iw.Scene.preset("paper-unconstrained").set({"run.duration_s": 2000})
    run = scene.run()
    asked = {"run": scene.run, "plot": run.plot, "csv": run.csv}[question]
    thread.start()
    before = count
    asked()
    after = count
    over.set()
    thread.join()
    assert after - before > 1000, "the interpreter's lock is free while a question is answered"


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
def test_a_forked_process_has_threads_of_its_own() -> None:
    done = in_a_process(
        """
        import multiprocessing
        import interwell as iw
        def rows(limit):
            return iw.Scene.preset("paper").sweep({"stops.travel_limit_mm": [limit, 2.0]}).csv()
        if __name__ == "__main__":
            first = rows(1.0)
            with multiprocessing.get_context("fork").Pool(2) as pool:
                assert pool.map(rows, [1.0, 1.0]) == [first, first]
            print("same")
        """
    )
    assert done.stdout == "same\n", done.stderr


@pytest.mark.skipif(sys.platform != "linux", reason="the size of a process is read as Linux gives it")
def test_a_thread_that_cannot_be_started_is_a_fault_with_its_value() -> None:
    done = in_a_process(
        """
        import resource, threading
        import interwell as iw
        scene, over = iw.Scene.preset("paper"), threading.Event()
        # stacks of threads that have ended are kept for the next ones, so that others have to take them
        threading.stack_size(16 << 20)
        for _ in range(4):
            threading.Thread(target=over.wait, daemon=True).start()
        with open("/proc/self/statm") as size:
            pages = int(size.read().split()[0])
        resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + (8 << 20),) * 2)
        try:
            scene.curve()
        except iw.SceneError as error:
            (fault,) = error.faults
            print(fault.field, fault.value, fault.problem)
        over.set()
        """
    )
    assert done.stdout == "threads 1 the system gives no thread; close another program\n", done.stderr


def test_progress_is_told() -> None:
    told: list[tuple[int, int | None]] = []
    scene = iw.Scene.preset("paper-unconstrained").set({"run.duration_s": 100})
    scene.sweep({"excitation.amplitude_g": np.linspace(1, 1.4, 60)}, progress=lambda *now: told.append(now))
    assert told[-1] == (60, 60)
    with pytest.raises(ZeroDivisionError):
        scene.sweep({"excitation.amplitude_g": np.linspace(1, 1.4, 60)}, progress=lambda *now: 1 / 0)


def test_bars_name_the_phases_of_basins(monkeypatch: pytest.MonkeyPatch) -> None:
    bars = []

    class Bar:
        def __init__(self, unit: str) -> None:
            self.unit, self.total, self.n = unit, None, 0
            bars.append(self)

        def reset(self, total: int) -> None:
            self.total, self.n = total, 0

        def update(self, more: int) -> None:
            self.n += more

        def close(self) -> None:
            pass

    monkeypatch.setitem(sys.modules, "tqdm", types.ModuleType("tqdm"))
    monkeypatch.setitem(sys.modules, "tqdm.auto", types.SimpleNamespace(tqdm=Bar))
    scene = iw.Scene.preset("nominal-cubic").set({"excitation.amplitude_g": 0.6})
    scene.basins((-4, 4, 5), (-0.2, 0.2, 3), progress=True)
    assert [bar.unit.strip() for bar in bars] == ["starts followed"]
    assert (bars[0].n, bars[0].total) == (15, 15)


def test_types() -> None:
    mypy = pytest.importorskip("mypy.api")
    folder = ROOT / "python"
    out, err, status = mypy.run(["--config-file", str(folder / "pyproject.toml"), str(folder / "interwell")])
    assert status == 0, out + err


@pytest.mark.parametrize("name", ["first_steps", "map_and_bifurcation"])
def test_notebooks(name: str, tmp_path: pathlib.Path) -> None:
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("matplotlib")
    pytest.importorskip("ipykernel")
    notebook = nbformat.read(ROOT / f"python/notebooks/{name}.ipynb", as_version=4)
    resources = {"metadata": {"path": str(tmp_path)}}
    nbclient.NotebookClient(notebook, timeout=300, resources=resources).execute()
