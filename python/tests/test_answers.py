"""Every study has the digits of the command line."""

from __future__ import annotations

import csv
import io
import json
import pathlib
from typing import Callable

import numpy as np
import pytest

import interwell as iw

Command = Callable[..., str]


def text(value: float) -> str:
    return repr(float(value))


def test_run(command: Command, tmp_path: pathlib.Path) -> None:
    for name in iw.presets():
        events, summary = tmp_path / "events.csv", tmp_path / "summary.json"
        samples = command("simulate", name, "--events", str(events), "--summary", str(summary))
        run = iw.Scene.preset(name).run()
        assert run.samples.csv() == samples, name
        assert iw.Table(run._run.events).csv() == events.read_text(), name
        written = json.loads(summary.read_text())
        ours = run.summary
        for key in ("cpu_s", "wall_s", "arguments"):
            written.pop(key, None)
            ours.pop(key, None)
        assert ours == written, name


def test_run_with_steps_and_times(command: Command) -> None:
    scene = iw.Scene.preset("paper")
    assert scene.run(dt=1e-3).samples.csv() == command("simulate", "paper", "--dt", "1e-3")
    times = [0.5, 0.25, 3.0]
    listed = ",".join(map(text, times))
    assert scene.run(at=times).samples.csv() == command("simulate", "paper", "--at", listed)
    settled = command("simulate", "paper", "--until-settled", "60")
    assert scene.run(until_settled=60).samples.csv() == settled


def test_sweep(command: Command) -> None:
    limits, amplitudes = np.array([0.5, 1.5, 7.0]), np.linspace(0, 2, 7)
    over = {"stops.travel_limit_mm": limits, "excitation.amplitude_g": amplitudes}
    options = [f"--over={field}={','.join(map(text, values))}" for field, values in over.items()]
    scene = iw.Scene.preset("paper")
    assert scene.sweep(over).csv() == command("sweep", "paper", *options)
    every = scene.sweep(over, columns="all", threads=1)
    assert every.csv() == command("sweep", "paper", *options, "--columns", "all")
    walked = scene.sweep(over, carry="both", columns=["crossings"])
    assert walked.csv() == command("sweep", "paper", *options, "--carry", "both", "--columns", "crossings")
    laws = {"stops.restitution": (0.4, "5%"), "damping.xi": 0.002}
    uncertain = scene.sweep(over, uncertain=laws, draws=9, seed=3)
    drawn = ["--uncertain=stops.restitution=0.4+-5%", "--uncertain=damping.xi=+-0.002", "--draws=9"]
    drawn.append("--seed=3")
    assert uncertain.csv() == command("sweep", "paper", *options, *drawn)
    settled = scene.sweep(over, until_settled=60)
    assert settled.csv() == command("sweep", "paper", *options, "--until-settled", "60")


def test_section(command: Command) -> None:
    scene = iw.Scene.preset("paper-unconstrained")
    assert scene.section(phase_deg=30).csv() == command("section", scene_name(scene), "--phase-deg", "30")
    assert scene.section(at="impacts").csv() == command("section", scene_name(scene), "--at", "impacts")
    over = {"excitation.amplitude_g": [1.0, 1.25, 1.5]}
    diagram = scene.section(over, skip=20, keep=10, carry="both")
    option = "--over=excitation.amplitude_g=1.0,1.25,1.5"
    expected = command(
        "section", scene_name(scene), option, "--skip", "20", "--keep", "10", "--carry", "both"
    )
    assert diagram.csv() == expected


def scene_name(scene: iw.Scene) -> str:
    return scene.name.removeprefix("built-in ")


def test_threshold(command: Command) -> None:
    scene = iw.Scene.preset("paper")
    assert scene.threshold().csv() == command("threshold", "paper")
    limits = {"stops.travel_limit_mm": [1.0, 2.0]}
    found = scene.threshold("excitation.amplitude_g", (0, 2), of="release", step=0.1, over=limits)
    option = "--over=stops.travel_limit_mm=1.0,2.0"
    field = "excitation.amplitude_g=0.0:2.0:0.1"
    assert found.csv() == command("threshold", "paper", "--of", "release", "--field", field, option)


def test_thresholds_of_melnikov_and_in_probability(command: Command) -> None:
    scene = iw.Scene.preset("duffing")
    frequencies = {"excitation.frequency_hz": [0.15, 0.2]}
    found = scene.threshold("excitation.amplitude_g", (0, 0.1), step=0.05, over=frequencies, melnikov=True)
    fields = "--field=excitation.amplitude_g=0.0:0.1:0.05", "--over=excitation.frequency_hz=0.15,0.2"
    assert found.csv() == command("threshold", "duffing", *fields, "--melnikov")
    noise = "Noise(rms_g: 0.3, low_hz: 1, high_hz: 20, seed: 1, lines: 64)"
    noisy = iw.Scene.preset("nominal-cubic").set(excitation=noise)
    limits = {"stops.travel_limit_mm": [2.0, 4.0]}
    found = noisy.threshold("excitation.rms_g", (0, 4), probability=0.25, runs=9, within=2.0, over=limits)
    fields = "--field=excitation.rms_g=0.0:4.0", "--over=stops.travel_limit_mm=2.0,4.0"
    chance = "--probability", "0.25", "--runs", "9", "--within", "2"
    assert found.csv() == command("threshold", "nominal-cubic", "--set", f"excitation={noise}", *fields, *chance)
    assert "melnikov" not in found.csv() and "<svg" in found.plot()._repr_svg_()


def test_basins(command: Command, tmp_path: pathlib.Path) -> None:
    attractors = tmp_path / "attractors.csv"
    found = iw.Scene.preset("paper").basins((-1.5, 1.5, 11), (-0.5, 0.5, 11))
    ranges = ["--x-mm", "-1.5:1.5:11", "--v", "-0.5:0.5:11"]
    assert found.csv() == command("basins", "paper", *ranges, "--attractors", str(attractors))
    assert found.attractors.csv() == attractors.read_text()
    drawn = iw.Scene.preset("paper").basins((-1.5, 1.5, 1), (-0.5, 0.5, 1), random=20, seed=3)
    ranges = ["--x-mm", "-1.5:1.5", "--v", "-0.5:0.5", "--random", "20", "--seed", "3"]
    assert drawn.csv() == command("basins", "paper", *ranges)


def test_loci_and_switched_branches(command: Command) -> None:
    oscillator = iw.Scene.preset("impact-oscillator")
    field, second = "excitation.amplitude_g", "excitation.frequency_hz"
    locus = oscillator.locus("grazing", field, (0.05, 0.07), second, (0.1, 0.116), step=0.02, count=50)
    assert locus.csv() == command(
        "orbit", "impact-oscillator", "--branch", f"{field}=0.05:0.07", "--locus", "grazing",
        "--and", f"{second}=0.1:0.116", "--step", "0.02", "--count", "50",
    )
    assert set(locus["locus"]) == {1} and len(locus["locus"]) == 50
    assert "after the largest number of motions" in " ".join(locus.words)
    assert "<svg" in locus.plot()._repr_svg_()
    branches = oscillator.branch(field, 0.056, 0.0545, switch=2)
    assert branches.csv() == command(
        "orbit", "impact-oscillator", "--branch", f"{field}=0.056:0.0545", "--switch", "2"
    )
    assert sorted(set(branches["branch"])) == [1, 2, 3]
    assert sorted(set(branches["period"])) == [1, 2, 4]


def test_orbit_and_branch(command: Command) -> None:
    scene = iw.Scene.preset("paper")
    assert scene.orbit().csv() == command("orbit", "paper")
    assert scene.orbit(phase_deg=90).csv() == command("orbit", "paper", "--phase-deg", "90")
    free = iw.Scene.preset("duffing")
    branch = free.branch("excitation.amplitude_g", 0.02, 0.03)
    assert branch.csv() == command("orbit", "duffing", "--branch", "excitation.amplitude_g=0.02:0.03")


def test_exponents_and_spectrum(command: Command) -> None:
    scene = iw.Scene.preset("duffing-chaos")
    assert scene.exponents(periods=200).csv() == command("exponents", "duffing-chaos", "--periods", "200")
    over = {"excitation.amplitude_g": [0.02, 0.05]}
    option = "--over=excitation.amplitude_g=0.02,0.05"
    duffing = iw.Scene.preset("duffing")
    assert duffing.exponents(over, periods=50).csv() == command("exponents", "duffing", option, "--periods", "50")
    assert duffing.spectrum("v").csv() == command("spectrum", "duffing", "--of", "v")


def test_escape(command: Command) -> None:
    noise = "Noise(rms_g: 1.0, low_hz: 1, high_hz: 20, seed: 1, lines: 64)"
    noisy = iw.Scene.preset("nominal-cubic").set(excitation=noise, stops="None")
    options = "--set", f"excitation={noise}", "--set", "stops=None", "--runs", "9", "--within", "3"
    assert noisy.escape(runs=9, within=3.0).csv() == command("escape", "nominal-cubic", *options)
    found = noisy.escape({"mass_g": [10.0, 20.0]}, runs=9, within=3.0, until="crossing")
    over = "--over=mass_g=10.0,20.0", "--until", "crossing"
    assert found.csv() == command("escape", "nominal-cubic", *options, *over)


def test_curve_compare_and_best(command: Command) -> None:
    paper = iw.Scene.preset("paper")
    assert paper.curve().csv() == command("curve", "paper")
    assert paper.compare("balanced").csv() == command("compare", "paper", "balanced")
    found = paper.best({"stops.travel_limit_mm": (0.5, 7, 0.5)}, subject_to="max_abs_x_m<=0.003")
    option = "--over=stops.travel_limit_mm=0.5:7:0.5"
    assert found.csv() == command("best", "paper", option, "--subject-to", "max_abs_x_m<=0.003")


def test_identify(command: Command, tmp_path: pathlib.Path) -> None:
    still = iw.Scene.preset("nominal-cubic").set(
        excitation="None", stops="None", start="At(x_mm: 8, v_m_per_s: 0)", run={"duration_s": 3}
    )
    run = still.run(dt=1e-3)
    record = tmp_path / "decay.csv"
    rows = "".join(f"{t!r},{x!r}\n" for t, x in zip(run.t.tolist(), run.x.tolist()))
    record.write_text("t_s,x_m\n" + rows)
    summary = tmp_path / "summary.json"
    expected = command("identify", str(record), "--of", "damping", "--summary", str(summary))
    found = iw.identify(record, "damping")
    assert found.csv() == expected
    written = json.loads(summary.read_text())
    assert all(found.summary[key] == written[key] for key in found.summary)


def test_identify_restitution_and_force(command: Command, tmp_path: pathlib.Path) -> None:
    shaken, pull, summary = tmp_path / "shaken.csv", tmp_path / "pull.csv", tmp_path / "summary.json"
    shaken.write_text(command("simulate", "paper", "--dt", "1e-3"))
    pull.write_text(command("curve", "nominal-cubic", "--range-mm=-9:9", "--points", "401"))
    for record, of, options in [
        (shaken, "restitution", {"column": "x_m"}), (pull, "force", {}), (pull, "force", {"points": 51})
    ]:
        given = [f"--{name}={value}" for name, value in options.items()]
        expected = command("identify", str(record), "--of", of, "--summary", str(summary), *given)
        found = iw.identify(record, of, **options)  # type: ignore[arg-type]
        assert found.csv() == expected
        written = json.loads(summary.read_text())
        assert all(found.summary[key] == written[key] for key in found.summary)


def test_force_of_samples(tmp_path: pathlib.Path) -> None:
    x = np.linspace(-9e-3, 9e-3, 181)
    force = -40.0 * x + 40.0 / 49e-6 * x**3
    exact = iw.Scene.preset("nominal-cubic")
    scene = exact.with_force((x, force), tolerance=1e-8)
    assert scene.barrier_j == pytest.approx(exact.barrier_j, rel=1e-6)
    # a slow pull, forth and back
    path = tmp_path / "pull.csv"
    rows = [f"{a},{b}" for a, b in zip([*x, *x[::-1]], [*force, *force[::-1]])]
    path.write_text("x_m,force_n\n" + "\n".join(rows))
    fitted = exact.with_force(iw.identify(path, "force", points=41))
    assert fitted.barrier_j == pytest.approx(exact.barrier_j, rel=1e-2)


def test_corners_need_no_names() -> None:
    def force(x: float) -> float:
        return -40.0 * x + 8e5 * x**3 + 20.0 * max(0.0, x - 4e-3)

    found, named = (
        iw.Scene.preset("paper").with_force(force, (-9e-3, 9e-3), breaks=breaks).run().summary
        for breaks in ([], [4e-3])
    )
    assert found["rms_velocity_m_per_s"] == pytest.approx(named["rms_velocity_m_per_s"], rel=1e-5)


def test_drive_of_ones_own() -> None:
    scene = iw.Scene.preset("nominal-cubic")
    cubed = scene.with_drive(lambda t: 20.0 * np.sin(6.0 * np.pi * t) ** 3, 3.0)
    times = np.linspace(0.0, 1.0, 97)
    exact = 20.0 * np.sin(6.0 * np.pi * times) ** 3
    assert np.abs(cubed.run(at=times).base_accel - exact).max() < 20.0 * 1e-6
    samples = 20.0 * np.sin(2.0 * np.pi * np.arange(16) / 16) ** 3
    sampled = scene.with_drive(samples, 3.0)
    assert np.abs(sampled.run(at=times).base_accel - exact).max() < 1e-11
    assert sampled.orbit()["period"][0] >= 1


def test_force_of_a_function(command: Command, tmp_path: pathlib.Path) -> None:
    def force(x: float) -> float:
        return -40.0 * x + 40.0 / 49e-6 * x**3

    scene = iw.Scene.preset("nominal-cubic").with_force(force, (-9e-3, 9e-3))
    exact = iw.Scene.preset("nominal-cubic")
    positions = np.random.default_rng(1).uniform(-9e-3, 9e-3, 500)
    curve = scene.curve(positions)
    assert np.abs(curve["force_n"] - [force(x) for x in positions]).max() <= 1.5 * scene["mechanism.error_n"]
    ours, theirs = scene.run().summary, exact.run().summary
    assert ours["rms_velocity_m_per_s"] == pytest.approx(theirs["rms_velocity_m_per_s"], rel=1e-6)
    # the scene is a file like any other
    path = tmp_path / "cubic.ron"
    scene.save(path)
    assert command("simulate", str(path)) == scene.run().samples.csv()
    grid = scene.sweep({"excitation.amplitude_g": [0.5, 1.0]})
    assert grid.csv() == command("sweep", str(path), "--over=excitation.amplitude_g=0.5,1.0")


def test_pictures_are_those_of_the_command_line(command: Command, tmp_path: pathlib.Path) -> None:
    path = tmp_path / "map.svg"
    over = {"stops.travel_limit_mm": [0.5, 1.5, 2.5], "excitation.amplitude_g": [0.0, 1.0, 2.0]}
    options = [f"--over={field}={','.join(map(text, values))}" for field, values in over.items()]
    command("sweep", "paper", *options, "--out", str(tmp_path / "map.csv"), "--plot", str(path))
    ours = iw.Scene.preset("paper").sweep(over).plot()._repr_svg_()
    assert drawn(ours) == drawn(path.read_text())


def drawn(svg: str) -> str:
    """The picture without the arguments that made it."""
    return svg[svg.index("</metadata>") :] if "</metadata>" in svg else svg


def test_columns_of_the_csv(command: Command) -> None:
    grid = iw.Scene.preset("paper").sweep({"excitation.amplitude_g": np.linspace(0, 2, 11)}, columns="all")
    rows = list(csv.DictReader(io.StringIO(grid.csv())))
    for name in grid.columns:
        for value, row in zip(grid[name].tolist(), rows):
            written = row[name]
            if isinstance(value, str):
                assert value == written
            elif value is None or isinstance(value, bool):
                assert written == {None: "", True: "true", False: "false"}[value]
            elif written == "":
                assert np.isnan(value) or np.isinf(value)
            else:
                assert float(written) == value
