"""Scenes and the questions about them."""

from __future__ import annotations

import os
from typing import Any, Callable, Iterable, Mapping, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _interwell
from ._errors import Fault, SceneError
from ._table import Array, Basins, Grid, Identified, Run, Table, _write

Over = Mapping[str, npt.ArrayLike]
Progress = Union[bool, Callable[[int, Union[int, None]], None]]


def _value(value: Any) -> str:
    """Return a value as a scene file has it."""
    if isinstance(value, np.generic):
        value = value.item()
    if value is None:
        return "None"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return {"nan": "NaN"}.get(repr(value), repr(value))
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(_value(item) for item in value) + "]"
    return str(value)


def _changes(fields: Mapping[str, Any], prefix: str = "") -> list[tuple[str, str]]:
    """Return nested fields as dotted paths with their values."""
    changes: list[tuple[str, str]] = []
    for name, value in fields.items():
        path = f"{prefix}{name}"
        if isinstance(value, Mapping):
            changes += _changes(value, f"{path}.")
        else:
            changes.append((path, _value(value)))
    return changes


def _numbers(name: str, values: npt.ArrayLike) -> Array:
    """Return the values as an array of one axis."""
    try:
        array = np.atleast_1d(np.asarray(values, dtype=float))
    except (TypeError, ValueError) as error:
        raise _wrong(name, repr(values), "give numbers, such as numpy.linspace(0, 2, 101)") from error
    if array.ndim != 1:
        raise _wrong(name, f"an array of shape {array.shape}", "give values along one axis")
    return array


def _over(over: Over | None) -> tuple[list[tuple[str, list[float]]], dict[str, Array]]:
    arrays: dict[str, Array] = {}
    for field, values in (over or {}).items():
        arrays[field] = _numbers(field, values)
    return [(field, array.tolist()) for field, array in arrays.items()], arrays


def _count(name: str, value: int | None, below: int = 2**32) -> int | None:
    """Return a whole number that is not negative."""
    if value is None:
        return None
    if not isinstance(value, (int, np.integer)) or not 0 <= value < below:
        raise _wrong(name, repr(value), "give a whole number from 0 up")
    return int(value)


def _wrong(field: str, value: str, problem: str) -> SceneError:
    return SceneError(f"{field} = {value}: {problem}", [Fault("", None, field, value, problem)])


class _Bar:
    """Progress by tqdm, where it is installed."""

    def __init__(self, unit: str) -> None:
        try:
            from tqdm.auto import tqdm
        except ImportError:
            self._bar: Any = None
        else:
            self._bar = tqdm(unit=f" {unit}")

    def __call__(self, done: int, total: int | None) -> None:
        if self._bar is not None:
            if total != self._bar.total:
                self._bar.reset(total)
            self._bar.update(done - self._bar.n)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()


class _Told:
    """The function that is told of progress; a bar is closed at the end."""

    def __init__(self, progress: Progress, unit: str) -> None:
        self._bar = _Bar(unit) if progress is True else None
        self._told = self._bar if progress is True else (progress or None)

    def __enter__(self) -> Any:
        return self._told

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()


def presets() -> dict[str, str]:
    """Return the names of the built-in scenes, each with its title."""
    return dict(_interwell.presets())


class Scene:
    """A scene: mass, mechanism, damping, stops, excitation, start and run.

    Parameters
    ----------
    source
        A scene file (RON), or the name of a built-in scene such as ``"paper"``; :func:`presets` lists them.

    Raises
    ------
    SceneError
        If the scene cannot be read, or has faults; ``error.faults`` lists them all.

    Notes
    -----
    A scene does not change: :meth:`set` returns another one. Fields, units and ranges are those of scene
    files.
    """

    def __init__(self, source: str | os.PathLike[str]) -> None:
        self._simulation = _interwell.Simulation.load(os.fspath(source))

    @classmethod
    def _of(cls, simulation: _interwell.Simulation) -> Scene:
        scene = cls.__new__(cls)
        scene._simulation = simulation
        return scene

    @classmethod
    def preset(cls, name: str) -> Scene:
        """Return a built-in scene."""
        return cls._of(_interwell.Simulation.preset(name))

    @classmethod
    def from_text(cls, text: str, name: str = "scene") -> Scene:
        """Return the scene of a text in RON; ``name`` stands for it in messages."""
        return cls._of(_interwell.Simulation.from_text(name, text))

    def set(self, changes: Mapping[str, Any] | None = None, /, **fields: Any) -> Scene:
        """Return the scene with fields changed.

        Parameters
        ----------
        changes
            Values by dotted path, ``{"stops.travel_limit_mm": 1.5}``, or nested as in ``fields``.
        **fields
            Values by name, nested: ``excitation={"amplitude_g": 1.3}``. A text is a value as a scene file has
            it: ``stops="Rigid(travel_limit_mm: 4, restitution: 0.36)"``.

        Raises
        ------
        SceneError
            If a field is not known, or the changed scene has faults.
        """
        return self._of(self._simulation.with_all(_changes({**(changes or {}), **fields})))

    def with_force(
        self,
        force: Callable[[float], float],
        range: tuple[float, float],
        *,
        tolerance: float = 1e-8,
        breaks: Iterable[float] = (),
    ) -> Scene:
        """Return the scene with the force of a function in place of its mechanism.

        The function is sampled once and becomes a piecewise polynomial; it is not called again.

        Parameters
        ----------
        force
            Force in N that holds the mass at a position in m; the derivative of the potential.
        range
            First and last position in m.
        tolerance
            Largest error of the curve, relative to the largest force between the wells, 1e-10 to 0.1. The
            error that was found is in the field ``mechanism.error_n``.
        breaks
            Positions in m at which the force has a corner, where they are known. Others are found.
        """
        ends = (float(range[0]), float(range[1]))
        places = [float(place) for place in breaks]
        simulation, _ = self._simulation.with_force(force, ends, float(tolerance), places)
        return self._of(simulation)

    def with_drive(
        self,
        acceleration: Callable[[float], float] | npt.ArrayLike,
        frequency_hz: float,
        *,
        tolerance: float = 1e-6,
    ) -> Scene:
        """Return the scene with a periodic drive of one's own in place of its excitation.

        The drive becomes a sum of sines, the trigonometric interpolation of the function or of the samples. The
        function is not called again.

        Parameters
        ----------
        acceleration
            Acceleration of the base in m/s²: a function of the time in s, of which the period from 0 on is used,
            or 1 to 4096 evenly spaced samples of one period, the first at time 0, without the period's end.
        frequency_hz
            One over the period, in Hz, with at most 11 digits.
        tolerance
            Largest difference from a function, relative to its largest value, 1e-12 to 0.1. It holds at all
            places that were compared, four in each interval between samples.

        Raises
        ------
        SceneError
            If a value is not finite, or if 2048 harmonics do not follow the function: it jumps.
        """
        given: Callable[[float], float] | list[float]
        if callable(acceleration):
            given = acceleration
        else:
            given = _numbers("acceleration", acceleration).tolist()
        return self._of(self._simulation.with_drive(given, float(frequency_hz), float(tolerance)))

    def __getitem__(self, field: str) -> Any:
        """Return the value of a field by its dotted path: a number, or a word such as the name of a choice."""
        number, word = self._simulation.get(field)
        if number is None and word is None and field not in self._simulation.fields:
            raise KeyError(field)
        return word if number is None else number

    @property
    def fields(self) -> list[str]:
        """Dotted paths of all fields."""
        return self._simulation.fields

    @property
    def name(self) -> str:
        """Name in messages."""
        return self._simulation.name

    @property
    def title(self) -> str:
        """Title."""
        return self._simulation.title

    @property
    def notes(self) -> str:
        """Notes for the reader."""
        return self._simulation.notes

    @property
    def text(self) -> str:
        """The scene as the text of a scene file."""
        return self._simulation.text

    @property
    def warnings(self) -> list[str]:
        """Values that are valid but probably not meant, each in a sentence."""
        return self._simulation.warnings

    @property
    def equilibria(self) -> list[tuple[float, bool]]:
        """Positions of equilibrium in m, each with whether it is stable."""
        return self._simulation.equilibria

    @property
    def barrier_j(self) -> tuple[float, float] | None:
        """Height of the barrier in J, seen from the left and from the right well; None without one."""
        return self._simulation.barrier_j

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the scene as a scene file."""
        _write(path, self.text.encode())

    def __repr__(self) -> str:
        return f"<Scene {self.name}: {self.title}>"

    def run(
        self,
        dt: float | None = None,
        *,
        at: npt.ArrayLike | None = None,
        until_settled: float | None = None,
    ) -> Run:
        """Run the scene once.

        Parameters
        ----------
        dt
            Time between samples in s; by default a 60th of the forcing period.
        at
            Times of the samples in s, in place of ``dt``.
        until_settled
            Go on, window after window, until the motion repeats, or up to this time in s.
        """
        times = None if at is None else np.atleast_1d(np.asarray(at, dtype=float)).tolist()
        run = self._simulation.run(dt, times, until_settled)
        return Run(run, 1e-3 * self["mass_g"], self)

    def curve(self, positions: npt.ArrayLike | None = None) -> Table:
        """Return ``x_m, force_n, potential_j, stiffness_n_per_m`` of the mechanism.

        Parameters
        ----------
        positions
            Positions in m; by default 401 that show equilibria and stops.
        """
        listed = None if positions is None else np.atleast_1d(np.asarray(positions, dtype=float)).tolist()
        return Table(self._simulation.curve(listed))

    def sweep(
        self,
        over: Over,
        *,
        columns: Sequence[str] | str = (),
        until_settled: float | None = None,
        carry: str | None = None,
        threads: int | None = None,
        progress: Progress = False,
    ) -> Grid:
        """Run the scene for each cell of a grid.

        Parameters
        ----------
        over
            Fields and their values, the slowest first.
        columns
            Columns of the answer, names of the summary, or ``"all"``; by default ``rms_velocity_m_per_s,
            regime, crossings, impacts, max_abs_x_m, period, outcome``.
        until_settled
            Let each run go on until its motion repeats, or up to this time in s.
        carry
            Walk the last field ``"up"``, ``"down"`` or ``"both"`` ways: each run begins in the state of the
            one before.
        threads
            Threads; by default all processors. The answer has the same bits for any number.
        progress
            Whether to show a bar (by tqdm, where it is installed), or a function that is called with the
            cells that are done and all cells.

        Returns
        -------
        Grid
            ``grid["rms_velocity_m_per_s"]`` has the shape of the grid.
        """
        names = [columns] if isinstance(columns, str) else list(columns)
        axes, arrays = _over(over)
        if not axes:
            raise _wrong("over", "{}", "name a field and its values")
        with _Told(progress, "cells") as told:
            answer = self._simulation.sweep(axes, names, until_settled, carry, _count("threads", threads), told)
        return Grid(answer, arrays, carry)

    def section(
        self,
        over: Over | None = None,
        *,
        at: str = "phase",
        phase_deg: float = 0.0,
        skip: int | None = None,
        keep: int | None = None,
        until_settled: float | None = None,
        carry: str | None = None,
        threads: int | None = None,
        progress: Progress = False,
    ) -> Table:
        """Return the state once a forcing period, or at every impact; over a field a bifurcation diagram.

        Parameters
        ----------
        over
            Fields and their values, the slowest first; without it the section is that of the scene.
        at
            ``"phase"`` or ``"impacts"``.
        phase_deg
            Phase of the drive in degrees.
        skip, keep
            Forcing periods that are skipped, and those that are kept, in place of the scene's run.
        until_settled, carry, threads, progress
            See :meth:`sweep`.
        """
        axes, _ = _over(over)
        with _Told(progress, "runs") as told:
            answer = self._simulation.section(
                axes,
                at,
                phase_deg,
                _count("skip", skip, 2**64),
                _count("keep", keep, 2**64),
                until_settled,
                carry,
                _count("threads", threads),
                told,
            )
        return Table(answer)

    def threshold(
        self,
        field: str = "excitation.amplitude_g",
        range: tuple[float, float] = (0.0, 2.0),
        *,
        of: str = "crossing",
        step: float | None = None,
        resolution: float | None = None,
        over: Over | None = None,
        until_settled: float | None = None,
        threads: int | None = None,
        progress: Progress = False,
    ) -> Table:
        """Return the least value of a field at which something begins.

        Parameters
        ----------
        field, range, step
            The field, its first and last value, and the step between values that are tried first.
        of
            ``"release"`` (the mass leaves the stop it rests on), ``"crossing"`` (the settled motion crosses)
            or ``"interwell"`` (its crossings repeat).
        resolution
            How closely the threshold is located, in the unit of the field.
        over
            Fields and their values: a row for each cell.
        until_settled, threads, progress
            See :meth:`sweep`.

        Returns
        -------
        Table
            ``of, value, low, high, undecided, windows`` after the fields.
        """
        axes, _ = _over(over)
        ends = f"{_value(float(range[0]))}:{_value(float(range[1]))}"
        searched = f"{field}={ends}" + ("" if step is None else f":{_value(float(step))}")
        with _Told(progress, "values") as told:
            answer = self._simulation.threshold(
                axes, searched, of, resolution, until_settled, _count("threads", threads), told
            )
        return Table(answer)

    def basins(
        self,
        x_mm: tuple[float, float, int],
        v_m_per_s: tuple[float, float, int],
        *,
        random: int | None = None,
        seed: int = 0,
        threads: int | None = None,
        progress: Progress = False,
    ) -> Basins:
        """Return the attractor that each start goes to.

        Parameters
        ----------
        x_mm, v_m_per_s
            First and last displacement in mm and velocity in m/s of the starts, and how many.
        random, seed
            Draw so many starts from both ranges, in place of a grid.
        """
        seeds = (_count("random", random, 2**64) or 0, _count("seed", seed, 2**64) or 0)
        drawn = None if random is None else seeds
        ranges = [("x_mm", x_mm), ("v_m_per_s", v_m_per_s)]
        starts_x, starts_v = ((low, high, _count(name, count) or 0) for name, (low, high, count) in ranges)
        with _Told(progress, "starts") as told:
            starts, attractors = self._simulation.basins(
                starts_x, starts_v, drawn, _count("threads", threads), told
            )
        return Basins(starts, attractors)

    def orbit(self, period: int | None = None, *, phase_deg: float = 0.0) -> Table:
        """Return the periodic motion near the settled motion of a run, with its multipliers: one row.

        Parameters
        ----------
        period
            Forcing periods after which it repeats; by default those of the settled motion.
        phase_deg
            Phase of the drive in degrees at which the state is taken.
        """
        return Table(self._simulation.orbit(_count("period", period), phase_deg))

    def branch(
        self,
        field: str,
        start: float,
        end: float,
        *,
        period: int | None = None,
        phase_deg: float = 0.0,
        progress: Progress = False,
    ) -> Table:
        """Follow the periodic motion over a field, through folds; a row for each motion.

        Parameters
        ----------
        field, start, end
            The field, its value at the first motion, and that towards which the branch goes.
        period, phase_deg
            See :meth:`orbit`.
        """
        with _Told(progress, "motions") as told:
            answer = self._simulation.branch(
                field, (start, end), _count("period", period), phase_deg, told
            )
        return Table(answer)

    def exponents(
        self,
        over: Over | None = None,
        *,
        periods: int | None = None,
        until_settled: float | None = None,
        threads: int | None = None,
        progress: Progress = False,
    ) -> Table:
        """Return the Lyapunov exponents of the settled motion in 1/s.

        Parameters
        ----------
        over
            Fields and their values: a row for each cell.
        periods
            Forcing periods that a motion is averaged over which does not repeat; by default 1000.
        until_settled, threads, progress
            See :meth:`sweep`.
        """
        axes, arrays = _over(over)
        with _Told(progress, "cells") as told:
            answer = self._simulation.exponents(
                axes, _count("periods", periods), until_settled, _count("threads", threads), told
            )
        return Grid(answer, arrays) if arrays else Table(answer)

    def spectrum(
        self,
        of: str = "x",
        *,
        taper: str = "auto",
        rate_hz: float | None = None,
        until_settled: float | None = None,
    ) -> Table:
        """Return amplitude and power spectral density of the settled motion.

        Parameters
        ----------
        of
            ``"x"``, ``"v"`` or ``"accel"``.
        taper
            ``"hann"``, ``"none"``, or ``"auto"``: none where the motion repeats.
        rate_hz
            Samples a second.
        until_settled
            See :meth:`run`.
        """
        return Table(self._simulation.spectrum(of, taper, rate_hz, until_settled))

    def compare(
        self,
        *others: Scene | str | os.PathLike[str],
        until_settled: float | None = None,
        threads: int | None = None,
        progress: Progress = False,
    ) -> Table:
        """Rate this scene and others under the sine of this one; a row for each.

        Parameters
        ----------
        *others
            Scenes, scene files, or names of built-in scenes.
        """
        scenes = [other if isinstance(other, Scene) else Scene(other) for other in others]
        names = [scene.name.removeprefix("built-in ") for scene in (self, *scenes)]
        pairs = [(name, scene._simulation) for name, scene in zip(names[1:], scenes)]
        with _Told(progress, "parts") as told:
            answer = self._simulation.compare(
                names[0], pairs, until_settled, _count("threads", threads), told
            )
        return Table(answer)

    def best(
        self,
        over: Mapping[str, tuple[float, ...]],
        *,
        maximise: str = "rms_velocity_m_per_s",
        subject_to: Sequence[str] | str = (),
        environment: Sequence[str] | str = (),
        vary: Mapping[str, float | str] | None = None,
        seed: int = 1,
        until_settled: float | None = None,
        threads: int | None = None,
        progress: Progress = False,
    ) -> Table:
        """Search the best design for an environment; one row, with its margins.

        Parameters
        ----------
        over
            Fields of the design, each with its least and largest value, and the step of the first scan:
            ``{"stops.travel_limit_mm": (0.5, 7)}``.
        maximise
            The number of the summary that is to be largest.
        subject_to
            What every environment must keep to: ``"max_abs_x_m<=0.003"``.
        environment
            In place of the scene's own excitation: scenes, records (CSV), or values of a field,
            ``"excitation.amplitude_g=0.8,1,1.2"``.
        vary
            Tolerances of fields: ``{"stops.travel_limit_mm": "1%"}``.
        """
        ranges = [f"{field}=" + ":".join(_value(end) for end in ends) for field, ends in over.items()]
        varied = [f"{field}=+-{_value(by)}" for field, by in (vary or {}).items()]
        limits = [subject_to] if isinstance(subject_to, str) else list(subject_to)
        places = [environment] if isinstance(environment, str) else list(environment)
        with _Told(progress, "runs") as told:
            answer = self._simulation.best(
                ranges,
                maximise,
                limits,
                places,
                varied,
                _count("seed", seed, 2**64) or 0,
                until_settled,
                _count("threads", threads),
                told,
            )
        return Table(answer)


def identify(
    path: str | os.PathLike[str],
    of: str,
    *,
    time: str | None = None,
    time_unit: str | None = None,
    column: str | None = None,
    unit: str | None = None,
    position: str | None = None,
    position_unit: str | None = None,
    base: str | None = None,
    base_unit: str | None = None,
    start: float | None = None,
    end: float | None = None,
    impact_times: bool = False,
    left_mm: float | None = None,
    right_mm: float | None = None,
    points: int | None = None,
) -> Identified:
    """Identify damping, restitution or force from a measured record.

    Parameters
    ----------
    path
        The record: CSV with a header.
    of
        ``"damping"`` (of a free decay), ``"restitution"`` (of impacts on stops) or ``"force"`` (over
        position, of a slow pull).
    time, time_unit, column, unit, position, position_unit, base, base_unit
        Columns and their units; by default found by the units in their names.
    start, end
        Leave out what was recorded before and after these times in s.
    impact_times
        Of restitution: the rows are impacts, and their times are all that is known.
    left_mm, right_mm
        Of restitution: about where the stops are.
    points
        Of force: points of the curve, 4 to 100000.
    """
    answer, summary = _interwell.identify(
        os.fspath(path),
        of,
        [time, time_unit],
        [column, unit],
        [position, position_unit],
        [base, base_unit],
        [start, end],
        impact_times,
        [left_mm, right_mm],
        _count("points", points),
    )
    return Identified(answer, summary)
