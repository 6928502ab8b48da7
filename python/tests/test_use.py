"""The package as a person uses it: objects, errors, interruption, types, notebooks."""

from __future__ import annotations

import os
import pathlib
import random
import signal
import subprocess
import sys
import textwrap
import threading

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


def coil() -> iw.Scene:
    return iw.Scene.preset("harvester").set({"transducer.inductance_mh": 10})


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
    (lambda: coil().sweep({"mass_g": [10, 20]}, carry="up"), "transducer", ""),
    (lambda: iw.Scene.preset("paper").threshold("mass_g", (2, 1)), "FROM", "field"),
    (lambda: iw.Scene.preset("paper").threshold(of="bliss"), "of", "of"),
    (lambda: iw.Scene.preset("paper").basins((1, -1, 3), (0, 1, 2)), "reversed", "x_mm"),
    (lambda: iw.Scene.preset("paper").orbit(phase_deg=float("inf")), "phase_deg", "phase_deg"),
    (lambda: iw.Scene.preset("paper").branch("mass_g", 1, 1), "both", "branch"),
    (lambda: iw.Scene.preset("paper").section(skip=3), "keep", "skip"),
    (lambda: iw.Scene.preset("paper").exponents(periods=0), "periods", "periods"),
    (lambda: iw.Scene.preset("paper").spectrum("y"), "of", "of"),
    (lambda: iw.Scene.preset("paper").spectrum(rate_hz=-1), "rate_hz", "rate_hz"),
    (lambda: iw.Scene.preset("paper").best({}), "over", "over"),
    (lambda: iw.Scene.preset("paper").best({"mass_g": (1, 2)}, maximise="joy"), "maximise", "maximise"),
    (lambda: iw.Scene.preset("paper").with_force(lambda x: 1 / 0, (-1, 1)), None, None),
    (lambda: iw.Scene.preset("paper").with_force(lambda x: float("nan"), (-1, 1)), "finite", "force"),
    (lambda: iw.Scene.preset("paper").with_force(lambda x: x, (1, -1)), "range", "force"),
    (lambda: iw.identify("no.csv", "damping"), "no.csv", ""),
    (lambda: iw.identify("no.csv", "joy"), "of", "of"),
    (lambda: iw.Scene.preset("paper").orbit().plot(), "picture", "plot"),
    (lambda: iw.Scene.preset("paper").sweep({}), "over", "over"),
    (lambda: iw.Scene.preset("paper").sweep({"mass_g": [15]}, threads=0), "threads", "threads"),
    (lambda: iw.Scene.preset("paper").sweep({"mass_g": [15]}, threads=-1), "threads", "threads"),
    (lambda: iw.Scene.preset("paper").basins((0, 1, -1), (0, 1, 2)), "x_mm", "x_mm"),
    (lambda: iw.Scene.preset("paper").orbit(period=0), "period", "period"),
    (lambda: iw.Scene.preset("paper").exponents(periods=-1), "periods", "periods"),
    (lambda: iw.Scene.preset("paper").curve().to_csv("curve.parquet"), "to_pandas", "path"),
    (lambda: iw.Scene.preset("paper").curve([99.0]), "99", "positions"),
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


def test_other_threads_go_on() -> None:
    count, over = 0, threading.Event()

    def counted() -> None:
        nonlocal count
        while not over.is_set():
            count += 1

    thread = threading.Thread(target=counted)
    scene = iw.Scene.preset("paper-unconstrained").set({"run.duration_s": 2000})
    thread.start()
    before = count
    scene.run()
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


def test_progress_is_told() -> None:
    told: list[tuple[int, int | None]] = []
    scene = iw.Scene.preset("paper-unconstrained").set({"run.duration_s": 100})
    scene.sweep({"excitation.amplitude_g": np.linspace(1, 1.4, 60)}, progress=lambda *now: told.append(now))
    assert told[-1] == (60, 60)
    with pytest.raises(ZeroDivisionError):
        scene.sweep({"excitation.amplitude_g": np.linspace(1, 1.4, 60)}, progress=lambda *now: 1 / 0)


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
