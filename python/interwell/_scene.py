"""Scenes and the questions about them."""

from __future__ import annotations

import json
import os
from typing import Any, Callable, Iterable, Iterator, Mapping, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _interwell
from ._check import Over, Progress, _count, _entries, _mapping, _names, _near, _number, _numbers, _over
from ._check import _real, _shown, _whole, _without, _word, _wrong
from ._errors import SceneError
from ._studies import Studies
from ._table import Array, Basins, Grid, Identified, Run, Table, _write


# fields whose values are texts
_TEXTS = ("title", "notes", "path", "field")


def _begin(begin: Any) -> Any:
    """Return the motion that is meant: nothing, the number of its impacts, or its state."""
    if begin is None:
        return None
    if np.ndim(begin) == 0:
        return {"Impacts": _whole("begin", begin, 2**63)}
    state = _numbers("begin", begin)
    if len(state) not in (2, 3):
        raise _wrong("begin", begin, "give (x_mm, v_m_per_s), with A or V of a circuit as a third number")
    x_mm, v, *electrical = state.tolist()
    return {"State": {"x": 1e-3 * x_mm, "v": v, "electrical": electrical[0] if electrical else 0.0}}


def _value(value: Any) -> str:
    """Return a value as a scene file has it."""
    if hasattr(value, "__array__"):
        value = np.asarray(value).tolist()
    if value is None:
        return "None"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        # counts are read back as floats, and a file has them without a point
        whole = value.is_integer() and abs(value) < 2**53
        return str(int(value)) if whole else {"nan": "NaN"}.get(repr(value), repr(value))
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(item) for item in value) + "]"
    if isinstance(value, Mapping):
        return _choice(value) if _is_choice(value) else f"({_struct(value)})"
    return str(value)


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _is_choice(value: Any) -> bool:
    """Whether a value is a choice with its fields: ``{"Sine": {..}}``."""
    return isinstance(value, Mapping) and len(value) == 1 and str(*value)[:1].isupper()


def _choice(value: Mapping[str, Any]) -> str:
    [(name, inner)] = value.items()
    is_struct = isinstance(inner, Mapping) and not _is_choice(inner)
    return f"{name}({_struct(inner) if is_struct else _value(inner)})"


def _struct(fields: Mapping[str, Any]) -> str:
    def written(name: str, value: Any) -> str:
        text = _value(value)
        return _quoted(text) if name in _TEXTS and text[:1] != '"' else text

    return ", ".join(f"{name}: {written(name, value)}" for name, value in fields.items())


def _changes(fields: Mapping[str, Any], prefix: str = "") -> list[tuple[str, str]]:
    """Return nested fields as dotted paths with their values."""
    changes: list[tuple[str, str]] = []
    for name, value in fields.items():
        path = f"{prefix}{name}"
        if isinstance(value, Mapping) and not _is_choice(value):
            changes += _changes(value, f"{path}.")
        else:
            changes.append((path, _value(value)))
    return changes


def _uncertain(field: str, law: Any) -> str:
    """Return an uncertain field as the command line writes it."""
    value, sigma = law if isinstance(law, tuple) and len(law) == 2 else ("", law)
    if not all(isinstance(part, (str, int, float, np.number)) for part in (value, sigma)):
        raise _wrong(field, _shown(law), "give a standard deviation, or a value and one: (0.023, 0.002)")
    return f"{field}={_value(value)}+-{_value(sigma)}"


def _starts(name: str, value: Any, drawn: bool) -> tuple[float, float, int] | tuple[float, float]:
    """Return the range of starts and how many; drawn at random they need no number."""
    low, high, *number = _entries(name, value, "(first, last, count)", *((2, 3) if drawn else (3,)))
    count = number[0] if number else 1.0
    if not (count.is_integer() and 0 <= count < 2**32):
        raise _wrong(name, _shown(value), "give a whole number of starts in (first, last, count)")
    return (low, high) if drawn else (low, high, int(count))


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
        if not (progress is None or isinstance(progress, bool) or callable(progress)):
            problem = "give True, False, or a function of the parts that are done and all of them"
            raise _wrong("progress", _shown(progress), problem)
        self._bar = _Bar(unit) if progress is True else None
        self._told = self._bar if progress is True else (progress or None)

    def __enter__(self) -> Any:
        return self._told

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()


def presets() -> dict[str, str]:
    """Return the names of the built-in scenes, each with its title.

    Returns
    -------
    dict of str to str

    Examples
    --------
    >>> iw.presets()["paper"]
    'Prototype with travel limits'
    """
    return dict(_interwell.presets())


class Scene(Studies, Mapping[str, Any]):
    """A scene: mass, mechanism, damping, stops, excitation, start and run.

    Parameters
    ----------
    source : str or path
        A scene file (RON), or the name of a built-in scene such as ``"paper"``; :func:`presets` lists them.

    Raises
    ------
    SceneError
        If the scene cannot be read, or has faults; ``error.faults`` lists them all.
    ComputationError
        If its flexures have no solution.

    Notes
    -----
    A scene does not change: :meth:`set` returns another one. It is a mapping of its fields to their values.
    Fields, units and ranges are those of scene files; a field has its unit in its name (``mass_g``,
    ``stops.travel_limit_mm``). The mechanism is solved once, when the scene is made; flexures take longest.

    Scenes with the same text are equal, if files that they name are the same too. A pickled scene is its
    text with absolute paths; where it is loaded, the files are read again and the mechanism is solved again.

    Ctrl-C ends every question with ``KeyboardInterrupt``. The lock of the interpreter is released while a
    question is computed. A wrong argument is a :class:`SceneError`, or a ``TypeError`` or ``ValueError``
    where it has the wrong type.

    Examples
    --------
    The examples of the methods go on with this scene.

    >>> scene = iw.Scene("nominal-cubic")
    >>> scene["stops.travel_limit_mm"]
    4.0
    """

    __slots__ = ("_simulation", "_folder", "_changed", "__weakref__")

    _simulation: _interwell.Simulation
    _folder: str | None
    _changed: bool

    def __init__(self, source: str | os.PathLike[str]) -> None:
        source = os.fspath(source)
        self._simulation = _interwell.Simulation.load(source)
        is_built_in = self._simulation.name == f"built-in {source}"
        self._folder = None if is_built_in else os.path.dirname(os.path.abspath(source))
        self._changed = False

    def _ask(
        self,
        study: str,
        parts: str,
        over: Over | None,
        threads: int | None,
        progress: Progress,
        arguments: dict[str, Any],
        cells: bool,
    ) -> Table:
        axes, arrays = _over(over)
        given = {name: value for name, value in arguments.items() if value is not None}
        if axes:
            given["over"] = axes
        with _Told(progress, parts) as told:
            answer, _ = _interwell.ask(study, self._simulation, given, _count("threads", threads), told)
        return Grid(answer, arrays) if arrays and cells else Table(answer)

    def _orbits(
        self, over: dict[str, Any], period: int | None, phase_deg: float, begin: Any, step: float = 0.01,
        count: int = 5000, progress: Progress = False
    ) -> Table:
        """Return a periodic motion or, with the fields that are covered, a branch or loci."""
        arguments = {
            "period": _count("period", period), "phase_deg": _number("phase_deg", phase_deg),
            "from": _begin(begin), "step": _number("step", step), "count": _whole("count", count, 2**64),
        }
        return self._ask("orbit", "motions", None, None, progress, {**over, **arguments}, False)

    @classmethod
    def _of(cls, simulation: _interwell.Simulation, before: Scene | None = None) -> Scene:
        """Return the scene of a simulation, or the scene that one became."""
        scene = cls.__new__(cls)
        scene._simulation = simulation
        scene._folder = None if before is None else before._folder
        scene._changed = before is not None
        return scene

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in Scene.__slots__:
            raise AttributeError(f"a scene does not change: scene.set({name}=...) returns another one")
        super().__setattr__(name, value)

    def _files(self) -> list[tuple[str, str, str]]:
        """Return the fields of paths, with the path in the text and the absolute one or built-in name."""
        named = [(field, str(self[field])) for field in self.fields if field.endswith(".path")]
        return [(field, path, os.path.join(self._folder or "", path)) for field, path in named]

    def _key(self) -> tuple[str, ...]:
        """Return what equal scenes have in common."""
        text, files = self.text, self._files()
        for _, path, whole in files:
            text = text.replace(f"path: {_quoted(path)}", f"path: {_quoted(whole)}")
        return text, *(whole for _, _, whole in files)

    def __reduce__(self) -> tuple[Any, ...]:
        changes = [(field, _quoted(whole)) for field, path, whole in self._files() if whole != path]
        try:
            text = self._simulation.with_all(changes).text if changes else self.text
        except SceneError as error:
            raise TypeError(f"a scene is pickled with files that can be read: {error}") from error
        return _unpickled, (text, self.name, self._changed)

    def __copy__(self) -> Scene:
        return self

    def __deepcopy__(self, _: Any) -> Scene:
        return self

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        return self is other or self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    @classmethod
    def preset(cls, name: str) -> Scene:
        """Return a built-in scene.

        Parameters
        ----------
        name : str
            Its name; :func:`presets` lists them.

        Returns
        -------
        Scene

        Raises
        ------
        SceneError
            If there is no built-in scene of this name.

        Examples
        --------
        >>> iw.Scene.preset("paper").title
        'Prototype with travel limits'
        """
        return cls._of(_interwell.Simulation.preset(name))

    @classmethod
    def from_text(cls, text: str, name: str = "scene") -> Scene:
        """Return the scene of a text.

        Parameters
        ----------
        text : str
            The scene in RON, as in a scene file. Files that it names must have absolute paths or be built-in
            tables.
        name : str
            What stands for it in messages.

        Returns
        -------
        Scene

        Raises
        ------
        SceneError
            If the text is no scene, or the scene has faults.
        ComputationError
            If its flexures have no solution.

        Examples
        --------
        >>> iw.Scene.from_text(scene.text)["mass_g"]
        15.2
        """
        return cls._of(_interwell.Simulation.from_text(name, text))

    def set(self, changes: Mapping[str, Any] | None = None, /, **fields: Any) -> Scene:
        """Return the scene with fields changed.

        Parameters
        ----------
        changes : mapping, optional
            Values by dotted path, ``{"stops.travel_limit_mm": 1.5}``, or nested as in ``fields``.
        **fields
            Values by name, nested: ``excitation={"amplitude_g": 1.3}``. A choice is a dict with its name,
            ``stops={"Rigid": {"travel_limit_mm": 4, "restitution": 0.36}}``, as ``run.summary["scene"]``
            shows it, or a text as a scene file has it, ``"Rigid(travel_limit_mm: 4, restitution: 0.36)"``.
            ``"None"`` and None are the choice of nothing.

        Returns
        -------
        Scene
            It shares the mechanism with this one if no field of the mechanism is changed.

        Raises
        ------
        SceneError
            If a field is not known, or the changed scene has faults. All changes are made before it is
            checked.
        ComputationError
            If changed flexures have no solution.

        Examples
        --------
        >>> scene.set(excitation={"amplitude_g": 1.3})["excitation.amplitude_g"]
        1.3
        >>> scene.set(mechanism={"Cubic": {"linear_n_per_m": -40, "cubic_n_per_m3": 8e5}})["mechanism"]
        'Cubic'
        """
        given = _mapping("changes", changes or {}, '{"stops.travel_limit_mm": 1.5}')
        return self._of(self._simulation.with_all(_changes({**given, **fields})), self)

    def with_force(
        self,
        force: Callable[[float], float] | Table | tuple[npt.ArrayLike, npt.ArrayLike],
        range: tuple[float, float] | None = None,
        *,
        tolerance: float | None = None,
        breaks: Iterable[float] = (),
    ) -> Scene:
        """Return the scene with a force of one's own in place of its mechanism.

        A function is sampled once and becomes a piecewise polynomial; it is not called again.

        Parameters
        ----------
        force : callable, (array_like, array_like) or Table
            Force in N that holds the mass at a position in m; the derivative of the potential. A function is
            called with one float and returns one. Otherwise positions in m, in ascending order, and the force
            at each, or a table with the columns ``x_m`` and ``force_n``, such as that of :func:`identify`.
        range : (float, float)
            First and last position in m, of a function.
        tolerance : float, optional
            Largest error of the curve, relative to the largest force between the wells, 1e-10 to 0.1: at all
            places that are compared with a function (by default 1e-8), or at the samples (by default 1e-3, of
            an identified force its ``tolerance``). A smaller one needs higher degrees or more pieces, and
            follows the noise of samples, which makes wells of its own.
        breaks : iterable of float
            Positions in m at which a function has a corner, where they are known. Others are found.

        Returns
        -------
        Scene
            The error that was found, in N, is in its field ``mechanism.error_n``.

        Raises
        ------
        SceneError
            If the range, the tolerance or a break is wrong, the force is not finite, has a step or is noisy,
            positions do not ascend, or the scene does not fit the curve: its start lies beyond an end of it,
            or a damping ratio or a start at rest finds no well. An exception of ``force`` is passed on.

        Notes
        -----
        The curve is compared with the function at five places between any two samples; the function is called
        at most 30 000 times. A function that is odd over a symmetric range gives a curve that is odd bit for
        bit.

        Examples
        --------
        >>> cubic = scene.with_force(lambda x: -40 * x + 8e5 * x**3, (-9e-3, 9e-3))
        >>> cubic["mechanism.error_n"] < 1e-9
        True
        """
        if callable(force):
            first, last = _entries("range", range, "(first, last) in m", 2)
            listed = isinstance(breaks, Iterable) and not isinstance(breaks, str)
            places = _numbers("breaks", list(breaks) if listed else breaks).tolist()  # type: ignore[arg-type]
            relative = 1e-8 if tolerance is None else _number("tolerance", tolerance)
            simulation, _ = self._simulation.with_force(force, (first, last), relative, places)
            return self._of(simulation, self)
        if range is not None:
            raise _wrong("range", _shown(range), "leave it out: samples have a first and a last position")
        usual = 1e-3
        if isinstance(force, Table):
            usual = getattr(force, "tolerance", None) or usual
            missing = [name for name in ("x_m", "force_n") if name not in force]
            if missing:
                raise _wrong("force", _shown(force), f"the table has no column {missing[0]}")
            force = (force["x_m"], force["force_n"])
        if not isinstance(force, (tuple, list)) or len(force) != 2:
            problem = "give a function, a pair (x_m, force_n), or a table with these columns"
            raise _wrong("force", _shown(force), problem)
        x, values = _numbers("force", force[0]).tolist(), _numbers("force", force[1]).tolist()
        relative = usual if tolerance is None else _number("tolerance", tolerance)
        return self._of(self._simulation.with_force_samples(x, values, relative), self)

    def with_drive(
        self,
        acceleration: Callable[[float], float] | npt.ArrayLike,
        frequency_hz: float,
        *,
        tolerance: float = 1e-6,
    ) -> Scene:
        """Return the scene with a periodic drive of one's own in place of its excitation.

        The drive becomes a sum of sines, the trigonometric interpolation of the function or of the samples.
        The function is not called again.

        Parameters
        ----------
        acceleration : callable or array_like of float, shape (n,)
            Acceleration of the base in m/s²: a function of the time in s, of which the period from 0 on is
            used, or 1 to 4096 evenly spaced samples of one period, the first at time 0, without the period's
            end.
        frequency_hz : float
            One over the period, in Hz, with at most 11 digits.
        tolerance : float
            Largest difference from a function, relative to its largest value, 1e-12 to 0.1. It holds at all
            places that were compared, four in each interval between samples.

        Returns
        -------
        Scene
            Its excitation is a ``Sum`` of sines.

        Raises
        ------
        SceneError
            If a value is not finite, or if 2048 harmonics do not follow the function: it jumps.

        Examples
        --------
        >>> shaken = scene.with_drive(lambda t: 8 * np.sin(6 * np.pi * t) ** 3, 3.0)
        >>> shaken["excitation"]
        'Sum'
        """
        given: Callable[[float], float] | list[float]
        if callable(acceleration):
            given = acceleration
        else:
            given = _numbers("acceleration", acceleration).tolist()
        frequency, relative = _number("frequency_hz", frequency_hz), _number("tolerance", tolerance)
        return self._of(self._simulation.with_drive(given, frequency, relative), self)

    def __getitem__(self, field: str) -> Any:
        """Return the value of a field.

        Parameters
        ----------
        field : str
            Dotted path; :attr:`fields` lists them.

        Returns
        -------
        float, bool, str or None
            A number in the unit of the field's name (counts are floats too), True or False, or a word: a text
            or the name of a choice. None where the field is neither, such as a list, and for a transducer
            that is not there.

        Raises
        ------
        KeyError
            If the scene has no such field; it names fields that may be meant.
        """
        number, word = self._simulation.get(field)
        if number is not None:
            return number
        if word is None and field not in self._simulation.fields:
            raise KeyError(f"no field {field!r}{_near(field, self.fields)}")
        is_flag = word in ("true", "false") and field.rpartition(".")[2] not in _TEXTS
        return word == "true" if is_flag else word

    def __iter__(self) -> Iterator[str]:
        return iter(self.fields)

    def __len__(self) -> int:
        return len(self.fields)

    def __contains__(self, field: object) -> bool:
        return field in self.fields

    def _ipython_key_completions_(self) -> list[str]:
        return self.fields

    @property
    def fields(self) -> list[str]:
        """Dotted paths of all fields, as a list of str."""
        return self._simulation.fields

    @property
    def name(self) -> str:
        """Name in messages: that of the file, or ``built-in NAME``. It stays when fields are changed."""
        return self._simulation.name

    @property
    def title(self) -> str:
        """Title, one line."""
        return self._simulation.title

    @property
    def notes(self) -> str:
        """Notes for the reader."""
        return self._simulation.notes

    @property
    def text(self) -> str:
        """The scene as the text of a scene file (RON), with all changes."""
        return self._simulation.text

    @property
    def warnings(self) -> list[str]:
        """Values that are valid but probably not meant, each in a sentence; a list of str."""
        return self._simulation.warnings

    @property
    def equilibria(self) -> list[tuple[float, bool]]:
        """Positions of equilibrium in m from left to right, each with whether it is stable.

        Returns
        -------
        list of (float, bool)

        Notes
        -----
        They are those of the force curve without stops; the list is complete.

        Examples
        --------
        >>> [stable for _, stable in scene.equilibria]
        [True, False, True]
        """
        return self._simulation.equilibria

    @property
    def barrier_j(self) -> tuple[float, float] | None:
        """Height of the barrier in J, seen from the left and from the right well; None without one.

        Returns
        -------
        (float, float) or None
        """
        return self._simulation.barrier_j

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the scene as a scene file; the file appears whole or not at all.

        Parameters
        ----------
        path : str or path
            The file, by custom with the ending ``.ron``. One that is there is replaced.

        Raises
        ------
        OSError
            If the file cannot be written.
        """
        _write(path, self.text.encode())

    def __repr__(self) -> str:
        return f"<Scene {self.name!r}{', changed' if self._changed else ''}: {self.title}>"

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
        dt : float, optional
            Time between samples in s; by default a 60th of the forcing period, or without one a thousandth of
            the duration.
        at : array_like of float, shape (n,), optional
            Times of the samples in s within the run, in any order, in place of ``dt``.
        until_settled : float, optional
            Go on, window after window, until the motion repeats, or up to this time in s: at least the
            duration of the scene's run. By default the run ends at its duration.

        Returns
        -------
        Run
            Samples, events and summary. A run that ends early is no error: ``run.summary["outcome"]`` says
            why.

        Raises
        ------
        SceneError
            If ``dt`` and ``at`` are both given, ``dt`` is not above 0 or makes more than 1e7 samples, a time
            lies outside the run, or ``until_settled`` is too short or the drive does not repeat.

        Notes
        -----
        Between events the motion is a Taylor series of order 9 to 23 (Moore 1966; Jorba and Zou 2005);
        impacts are roots of its polynomial, and the rest of a chatter is summed in closed form (Nordmark and
        Piiroinen 2009). Samples come from the same polynomial, so that more of them change nothing.
        ``run.tolerance`` of the scene is the accuracy.

        Examples
        --------
        >>> scene.run(dt=1e-3).x.shape
        (10001,)
        """
        times = None if at is None else _numbers("at", at).tolist()
        longest = _real("until_settled", until_settled)
        return Run(self._simulation.run(_real("dt", dt), times, longest))

    def curve(self, positions: npt.ArrayLike | None = None) -> Table:
        """Return force, potential and stiffness of the mechanism.

        Parameters
        ----------
        positions : array_like of float, shape (n,), optional
            Positions in m; by default 401 that show equilibria and stops.

        Returns
        -------
        Table
            ``x_m``, ``force_n`` (what holds the mass there), ``potential_j`` (0 at x = 0) and
            ``stiffness_n_per_m``, each float64 of shape (n,).

        Raises
        ------
        SceneError
            If a position lies beyond an end of the force curve.

        Notes
        -----
        Flexures are geometrically exact beams (Reissner 1972). Every run computes with this curve.

        Examples
        --------
        >>> scene.curve([0.0])["stiffness_n_per_m"]
        array([-40.])
        """
        listed = None if positions is None else _numbers("positions", positions).tolist()
        return Table(self._simulation.curve(listed))

    def sweep(
        self,
        over: Over,
        *,
        columns: Sequence[str] | str = (),
        until_settled: float | None = None,
        carry: str | None = None,
        uncertain: Mapping[str, float | str | tuple[float, float | str]] | None = None,
        draws: int | None = None,
        seed: int | None = None,
        threads: int | None = None,
        progress: Progress = False,
    ) -> Grid:
        """Run the scene for each cell of a grid.

        Parameters
        ----------
        over : mapping of str to array_like of float, shape (n,)
            Fields by dotted path and their values in the unit of the field, the slowest first. Fields of the
            mechanism may be among them.
        columns : str or sequence of str
            Columns of the answer, names of the summary, whose units may be left out, or ``"all"``; by default
            ``rms_velocity_m_per_s, regime, crossings, impacts, max_abs_x_m, period, outcome``. ``mean_x_m``,
            ``impact_share`` and energies take longer, since they need the energy ledger.
        until_settled : float, optional
            Let each run go on until its motion repeats, or up to this time in s.
        carry : str, optional
            Walk the last field ``"up"``, ``"down"`` or ``"both"`` ways: each run from the end of the one
            before, its last whole forcing period. The drive must repeat.
        uncertain : mapping of str to float, str or tuple, optional
            Fields that are known with a standard deviation: a number in the unit of the field, ``0.002``, or
            a text that is a share of the value, ``"5%"``, alone or behind the value, ``(0.023, 0.002)``.
            Without a value it is that of the scene, of a swept field that of each cell. Not with ``carry``.
        draws : int, optional
            Draws of these fields from independent normal distributions, truncated to the ranges of the
            fields; each is run for each cell. By default 100.
        seed : int, optional
            Seed of the draws, by default 1.
        threads : int, optional
            Threads, at most 1024; by default all processors. The answer has the same bits for any number.
        progress : bool or callable
            Whether to show a bar (by tqdm, where it is installed), or a function that is called some 20 times
            a second with the cells that are done and all cells (None while that is not known).

        Returns
        -------
        Grid
            ``grid["rms_velocity_m_per_s"]`` has the shape of the grid. A cell whose run ends early says why
            in ``grid["outcome"]``. With ``uncertain`` each column of numbers is followed by ``.._low`` and
            ``.._high``, the 2.5 % and 97.5 % quantiles of the draws, each of words by ``.._share``, the share
            of the draws with the word of the cell, and ``draws`` counts those that came to their end.

        Raises
        ------
        SceneError
            If a field, a column or another argument is wrong, or a cell is no valid scene (the first such
            cell is named). With ``carry`` also if the drive does not repeat.

        Notes
        -----
        Walks up and down show hysteresis (Duffing 1918; for the double well Holmes 1979). The runs of a walk
        follow each other; without ``carry`` several runs are integrated by the same instructions.

        Examples
        --------
        >>> scene.sweep({"stops.travel_limit_mm": [2, 4], "excitation.amplitude_g": [0.5, 1, 1.5]})["regime"]
        array([['intrawell', 'interwell', 'interwell'],
               ['rest', 'interwell', 'interwell']], dtype='<U9')
        >>> over = {"excitation.amplitude_g": [1.5]}
        >>> grid = scene.sweep(over, uncertain={"stops.restitution": 0.02}, draws=20)
        >>> bool(grid["rms_velocity_m_per_s_low"][0] < grid["rms_velocity_m_per_s_high"][0])
        True
        """
        names = _names("columns", columns)
        axes, arrays = _over(over)
        if not axes:
            raise _wrong("over", "{}", "name a field and its values")
        laws = _mapping("uncertain", uncertain or {}, '{"damping.xi": 0.002}')
        inputs = [_uncertain(field, law) for field, law in laws.items()]
        with _Told(progress, "runs" if inputs else "cells") as told:
            answer = _interwell.sweep(
                self._simulation,
                axes,
                names,
                _real("until_settled", until_settled),
                carry,
                inputs,
                _count("draws", draws, 2**64),
                _count("seed", seed, 2**64),
                _count("threads", threads),
                told,
            )
        return Grid(answer, arrays, carry)

    def threshold(
        self,
        field: str | None = None,
        range: tuple[float, float] | None = None,
        *,
        of: str = "crossing",
        step: float | None = None,
        resolution: float | None = None,
        over: Over | None = None,
        until_settled: float | None = None,
        melnikov: bool = False,
        probability: float | None = None,
        runs: int | None = None,
        within: float | None = None,
        threads: int | None = None,
        progress: Progress = False,
    ) -> Table:
        """Return the least value of a field at which something begins.

        Parameters
        ----------
        field : str, optional
            The field that is searched, by dotted path; by default the amplitude of the drive, with
            ``probability`` the RMS of the noise.
        range : (float, float), optional
            Its first and last value, in the unit of the field that stands in its name. An amplitude of the
            drive needs none: it is searched upward, as by :meth:`compare`; the RMS from 0 to 2 g.
        of : str
            ``"release"`` (the mass leaves the stop it rests on), ``"crossing"`` (the settled motion crosses)
            or ``"interwell"`` (its crossings repeat).
        step : float, optional
            Step between the values that are tried first; by default a 200th of the range. A window narrower
            than a step can be missed; a smaller one costs more runs.
        resolution : float, optional
            How closely the threshold is located, in the unit of the field; by default a thousandth of a step,
            with ``probability`` a step.
        over : mapping of str to array_like of float, optional
            Fields and their values: a row for each cell.
        until_settled : float, optional
            Time in s up to which each run goes on until its motion repeats; by default 1000 forcing periods
            beyond the scene's run.
        melnikov : bool
            Whether the column ``melnikov_g`` is added, Melnikov's threshold of the amplitude of a sine; of a
            ``Cosine`` or ``Force`` it is ``melnikov_m_per_s2`` or ``melnikov_n``.
        probability : float, optional
            Under a noise: share of the runs, above 0 and below 1, that cross the barrier at the threshold.
        runs : int, optional
            With ``probability``: runs of each cell, 1 to 1e6, by default 100; run number i, from 0, has the
            seed of the scene plus i.
        within : float, optional
            With ``probability``: time in s within which a run is to cross; by default the duration of the
            scene's run.
        threads, progress
            See :meth:`sweep`.

        Returns
        -------
        Table
            The fields of ``over``, ``of``, ``value`` (NaN where none of the range does it), ``low`` and
            ``high`` (the nearest values tried that are known not to do it, and to do it), all three in the
            unit of the field, ``undecided`` (bool), ``windows`` (how often the answer changes above),
            ``step`` and ``resolution`` (distance of the steps beside ``value``, and that of the bisection).
            With ``probability``, ``low`` and ``high`` are a 95 % interval, and ``probability``, ``runs`` and
            ``crossed`` (runs that cross at the end of the range) stand in place of the last four columns.

        Raises
        ------
        SceneError
            If an argument is wrong, no value of the range makes a valid scene, ``of="interwell"`` and the
            drive does not repeat, or ``probability`` is given and the scene has no noise.

        Notes
        -----
        Release under one sine has a closed form. Otherwise each step is run from rest and the first change is
        bisected; the values that cross need not form an interval. With ``probability`` each run is bisected
        with its own random numbers; the interval lies between two of the values found, whose ranks are
        binomial (David and Nagaraja 2003, section 7.1). Melnikov's threshold is that of Guckenheimer and
        Holmes (1983, section 4.5), along the orbit that leaves the top of the barrier and returns to it.

        Examples
        --------
        >>> scene.threshold(of="release")["value"].round(4)
        array([0.7229])
        >>> noisy = scene.set(excitation="Noise(rms_g: 1, low_hz: 0.5, high_hz: 10, seed: 5)")
        >>> found = noisy.threshold("excitation.rms_g", (0, 4), probability=0.5, runs=9, within=2)
        >>> bool(found["low"][0] <= found["value"][0] <= found["high"][0])
        True
        """
        searched = field
        _word("of", of, ("release", "crossing", "interwell"))
        if range is not None:
            low, high = _entries("range", range, "(first, last)", 2)
            if not low < high:
                raise _wrong("range", _shown(range), "give the lower end first, and a higher one")
            searched = f"{field or ''}={_value(low)}:{_value(high)}"
        finest, longest = _real("resolution", resolution), _real("until_settled", until_settled)
        if step is not None:
            if not _number("step", step) > 0:
                raise _wrong("step", _shown(step), "give a number above 0, in the unit of the field")
            if searched is None or range is None:
                raise _wrong("step", _shown(step), "give a `range` too")
            searched += f":{_value(step)}"
        arguments = {
            "field": searched, "of": of, "resolution": finest, "until_settled": longest,
            "probability": _real("probability", probability), "runs": _count("runs", runs),
            "within": _real("within", within), "melnikov": melnikov,
        }
        return self._ask("threshold", "values", over, threads, progress, arguments, False)

    def basins(
        self,
        x_mm: tuple[float, float, int] | tuple[float, float],
        v_m_per_s: tuple[float, float, int] | tuple[float, float],
        *,
        random: int | None = None,
        seed: int = 0,
        threads: int | None = None,
        progress: Progress = False,
    ) -> Basins:
        """Return the attractor that each start goes to.

        Parameters
        ----------
        x_mm, v_m_per_s : (float, float, int)
            First and last displacement in mm and velocity in m/s of the starts, and how many.
        random, seed : int, optional
            Draw so many starts from both ranges, in place of a grid; the two counts then have no effect and
            may be left out.
        threads, progress
            See :meth:`sweep`. Progress counts starts, then once more those that are checked.

        Returns
        -------
        Basins
            A row for each start: ``x_mm``, ``v_m_per_s``, ``attractor`` (from 1), ``periods`` (forcing
            periods until it was known), ``sure`` (bool, or None where missing). Values are missing for starts
            beyond a stop or the curve, and for those that reach no attractor. The rows of a grid go through
            all velocities for the first displacement, then for the next, so that
            ``basins["attractor"].reshape(x_count, v_count)`` has the displacements along its first axis.
            Random starts are in the order in which they were drawn.

        Raises
        ------
        SceneError
            If a range is wrong, there are more than 1e7 starts, all lie beyond a stop or the curve, the drive
            changes and does not repeat, or nothing takes energy.

        Notes
        -----
        Starts that share a release share what follows; others are followed until they enter an ellipse around
        a stable orbit (motions told by their return: Datseris and Wagemakers 2022). Shares of random starts
        are the basin stability of Menck et al. (2013), with the interval of Wilson (1927). ``sure`` says
        that a second run at a thousandth of the tolerance stays beside the first one up to the attractor.

        Examples
        --------
        >>> weak = scene.set(excitation={"amplitude_g": 0.6})
        >>> weak.basins((-4, 4, 5), (-0.2, 0.2, 3)).attractors["side"]
        array(['left', 'right'], dtype='<U5')
        """
        drawn, seed = random is not None, _whole("seed", seed, 2**64)
        arguments: dict[str, Any] = {
            "x_mm": _starts("x_mm", x_mm, drawn),
            "v": _starts("v_m_per_s", v_m_per_s, drawn),
        }
        if drawn:
            arguments |= {"random": _count("random", random, 2**64), "seed": seed}
        with _Told(progress, "starts followed") as told:
            starts, (attractors,) = _interwell.ask(
                "basins", self._simulation, arguments, _count("threads", threads), told
            )
        return Basins(starts, attractors)

    def orbit(
        self,
        period: int | None = None,
        *,
        phase_deg: float = 0.0,
        begin: Sequence[float] | int | None = None,
    ) -> Table:
        """Return the periodic motion near the settled motion of a run, with its multipliers: one row.

        Parameters
        ----------
        period : int, optional
            Forcing periods after which it repeats, 1 to 1000; by default those of the settled motion.
        phase_deg : float
            Phase of the drive in degrees at which the state is taken.
        begin : sequence of float, or int, optional
            The motion that is meant in place of that of the run: its displacement in mm and velocity in m/s at
            the phase, with A or V of a circuit as a third number, or the number of impacts in its period,
            stable or not.

        Returns
        -------
        Table
            ``period``, ``x_m``, ``v_m_per_s``, ``multiplier_1_re``, ``multiplier_1_im``, ``multiplier_2_re``,
            ``multiplier_2_im`` (Floquet multipliers, the larger magnitude first), ``stable``, ``impacts``,
            ``rests``, ``gentlest_impact_m_per_s``, ``nearest_miss_m``; beside a circuit also ``current_a`` or
            ``voltage_v`` and ``multiplier_3_re``, ``multiplier_3_im``.

        Raises
        ------
        SceneError
            If an argument is wrong, or the drive does not repeat or is 0.
        ComputationError
            If the run comes to no motion that repeats, or none is found near it.

        Notes
        -----
        Newton's method on the stroboscopic map, whose derivative is carried through impacts by saltation
        matrices (Müller 1995; Kong et al. 2024). Unstable motions are found too.

        Examples
        --------
        >>> scene.orbit()["period"]
        array([1])
        """
        return self._orbits({}, period, phase_deg, begin)

    def branch(
        self,
        field: str,
        start: float,
        end: float,
        *,
        period: int | None = None,
        phase_deg: float = 0.0,
        step: float = 0.01,
        count: int = 5000,
        switch: int = 0,
        begin: Sequence[float] | int | None = None,
        progress: Progress = False,
    ) -> Table:
        """Follow the periodic motion over a field, through folds; a row for each motion.

        Parameters
        ----------
        field : str
            The field by dotted path; not one of whole numbers.
        start, end : float
            Its value at the first motion, which replaces that of the scene, and that towards which the branch
            goes.
        period, phase_deg, begin
            See :meth:`orbit`.
        step : float
            The longest step, as a share of the range and of the scales of the state, 0.0001 to 0.05.
        count : int
            The largest number of motions, 1 to 1 000 000.
        switch : int
            The levels of branches, 0 to 10, that are followed too: with 1 those that begin at flips and
            breakings of the symmetry, with 2 also those that begin on them.
        progress
            See :meth:`sweep`; the number of all motions is not known.

        Returns
        -------
        Table
            The field, the columns of :meth:`orbit`, and ``event``: empty, ``fold``, ``flip``, ``symmetry`` or
            ``grazing``; with ``switch`` first ``branch``, a number from 1. ``table.words`` says where and why
            a branch ended inside the range.

        Raises
        ------
        SceneError
            As :meth:`orbit`, and if the field or the range is wrong.
        ComputationError
            As :meth:`orbit`, for the first motion.

        Notes
        -----
        Pseudo-arclength continuation (Keller 1977). Events are located to some 1e-9 of the range; two of a
        kind within a hundredth of it can be missed.

        Examples
        --------
        >>> free = scene.set(stops="None")
        >>> branch = free.branch("excitation.amplitude_g", 0.6, 0.75)
        >>> branch["amplitude_g"][branch["event"] == "fold"].round(2)
        array([0.7])
        """
        ends = (_number("start", start), _number("end", end))
        over = {"branch": {"field": field, "range": ends}, "switch": _whole("switch", switch)}
        return self._orbits(over, period, phase_deg, begin, step, count, progress)

    def locus(
        self,
        event: str,
        field: str,
        range: tuple[float, float],
        second: str,
        second_range: tuple[float, float],
        *,
        period: int | None = None,
        phase_deg: float = 0.0,
        step: float = 0.01,
        count: int = 5000,
        begin: Sequence[float] | int | None = None,
        progress: Progress = False,
    ) -> Table:
        """Follow the events of a branch over a second field; a row for each motion.

        Parameters
        ----------
        event : str
            ``"grazing"``, ``"fold"``, ``"flip"`` or ``"symmetry"``.
        field, range
            The field of the branch, its value at the first motion, and that towards which the branch goes.
            See :meth:`branch`.
        second, second_range
            The other field, its value on the branch and that towards which the loci go.
        period, phase_deg, step, count, begin, progress
            See :meth:`branch`.

        Returns
        -------
        Table
            ``locus`` (its number from 1), both fields, the columns of :meth:`orbit`, and ``event``: empty,
            ``cusp``, ``fold-flip``, ``grazing-fold``, ``grazing-flip``, ``grazing-symmetry`` or
            ``grazing-grazing``. ``table.words`` says where and why each locus ended.

        Raises
        ------
        SceneError
            As :meth:`branch`, for both fields.
        ComputationError
            If the branch has no such event.

        Notes
        -----
        Pseudo-arclength in the state and both fields, with the characteristic polynomial of the map at 1 or
        -1 as one more equation (Kuznetsov 2004, section 10.3), or with the touch of the stop.

        Examples
        --------
        >>> oscillator = iw.Scene.preset("impact-oscillator")
        >>> locus = oscillator.locus(
        ...     "grazing", "excitation.amplitude_g", (0.05, 0.07), "excitation.frequency_hz", (0.1, 0.116)
        ... )
        >>> w = 2 * np.pi * locus["frequency_hz"]
        >>> reached = 9.80665 * locus["amplitude_g"] / np.hypot(1 - w**2, 0.2 * w)
        >>> bool(abs(reached - 1).max() < 1e-8)
        True
        """
        over = {
            "branch": {"field": field, "range": _entries("range", range, "(first, last)", 2)},
            "locus": _word("event", event or "", ("fold", "flip", "symmetry", "grazing")),
            "and": {"field": second, "range": _entries("second_range", second_range, "(first, last)", 2)},
        }
        return self._orbits(over, period, phase_deg, begin, step, count, progress)

    def compare(
        self,
        *others: Scene | str | os.PathLike[str],
        until_settled: float | None = None,
        threads: int | None = None,
        progress: Progress = False,
        **named: Scene | str | os.PathLike[str],
    ) -> Table:
        """Rate this scene and others under the sine of this one; a row for each.

        Parameters
        ----------
        *others : Scene, str or path
            Scenes, scene files, or names of built-in scenes.
        until_settled, threads, progress
            See :meth:`sweep`; by default each run goes on for up to 1000 forcing periods beyond the scene's
            run. Progress counts the scenes and the changes of their sizes.
        **named : Scene, str or path
            Further scenes, by the names that they have in the table: ``near=scene.set(...)``.

        Returns
        -------
        Table
            ``scene`` (its name, with ``(changed)`` where fields were changed), ``release_g``,
            ``crossing_g``, ``crossing_low_g``, ``crossing_high_g``, ``crossing_undecided`` (bool),
            ``crossing_step_g``, ``crossing_resolution_g`` (all as :meth:`threshold` has them),
            ``rms_velocity_m_per_s``, ``mean_load_power_w``, ``max_abs_x_m``, ``impact_speed_max_m_per_s``,
            ``crosses_from_hz``, ``crosses_to_hz``, ``threshold_sensitivity`` (a share),
            ``most_sensitive_to``. Values are missing where a scene has no such number.

        Raises
        ------
        SceneError
            If an argument is no scene, the excitation of this scene is no sine or cosine, another scene
            cannot be read, or one has faults under it.

        Notes
        -----
        All scenes start at rest, with the excitation and the run of this one; ``table.words`` names those
        that have others of their own. The sensitivity is the largest
        change of ``crossing_g`` when one length, thickness or gap of the mechanism changes by 1 %. Each row
        scans frequencies and these sizes; flexures are solved anew for each size, which takes seconds.

        Examples
        --------
        >>> table = scene.compare(near=scene.set({"stops.travel_limit_mm": 2}))
        >>> table["scene"]
        array(['nominal-cubic', 'near'], dtype='<U13')
        >>> table["release_g"].round(3)
        array([0.723, 0.493])
        """
        names, scenes = list(named), [_scene(name, given) for name, given in named.items()]
        first: list[str] = []
        unnamed = [self, *(_scene("others", other) for other in others)]
        for scene in unnamed:
            plain = scene.name.removeprefix("built-in ") + (" (changed)" if scene._changed else "")
            number = 1
            while (name := plain if number == 1 else f"{plain} {number}") in (*first, *names):
                number += 1
            first.append(name)
        names, scenes = first + names, unnamed + scenes
        pairs = [(name, scene._simulation) for name, scene in zip(names[1:], scenes[1:])]
        with _Told(progress, "parts") as told:
            answer = _interwell.compare(
                self._simulation, names[0], pairs, _real("until_settled", until_settled),
                _count("threads", threads), told
            )
        return Table(answer)

    def best(
        self,
        over: Mapping[str, tuple[float, ...]],
        *,
        maximise: str = "rms_velocity_m_per_s",
        maximize: None = None,
        subject_to: Sequence[str] | str = (),
        environment: Sequence[str] | str = (),
        vary: Mapping[str, tuple[float | str, float | str]] | None = None,
        seed: int = 1,
        until_settled: float | None = None,
        runs_to: str | os.PathLike[str] | None = None,
        threads: int | None = None,
        progress: Progress = False,
    ) -> Table:
        """Search the best design for an environment; one row, with its margins.

        Parameters
        ----------
        over : mapping of str to (float, float) or (float, float, float)
            One to four fields of the design, each with its least and largest value in the unit of the field,
            and the step of the first scan: ``{"stops.travel_limit_mm": (0.5, 7)}``. A smaller step is surer
            to find a narrow maximum, and costs more runs.
        maximise : str
            The number of the summary that is to be largest, in its unit, which its name may leave out.
        maximize : None
            Refused: the argument is ``maximise``.
        subject_to : str or sequence of str
            What every environment must keep to: ``"max_abs_x_m<=0.003"``.
        environment : str or sequence of str
            In place of the scene's own excitation: scenes, records (CSV), or values of a field,
            ``"excitation.amplitude_g=0.8,1,1.2"``. An ending ``*WEIGHT`` weighs one.
        vary : mapping of str to (float, float) or (str, str), optional
            Tolerances of fields, the least and the largest deviation from the value: numbers are in the unit
            of the field, texts may be shares of the value:
            ``{"stops.travel_limit_mm": ("-1%", "1%"), "mass_g": (-0.1, 0.1)}``.
        seed : int
            Seed of the 200 samples within these tolerances.
        runs_to : str or path, optional
            File (CSV) to which the results of each run are added as soon as it has ended; those that the same
            search kept before it was interrupted are taken from there.
        until_settled, threads, progress
            See :meth:`sweep`; by default each run goes on for up to 1000 forcing periods beyond the scene's
            run. Progress counts the runs that are done and, as far as it is known, those that are left.

        Returns
        -------
        Table
            The fields, ``maximised``, ``value`` (mean over the environments), ``margin_low``, ``margin_high``
            (how far to either side, in the unit of the field, a tenth of it is lost or a constraint broken;
            NaN where that is nowhere in the range), ``worst``, ``quantile_5`` (as ``value``, in the unit of
            what is largest), and where it is safer to step back to. ``table.words`` has the same in
            sentences.

        Raises
        ------
        SceneError
            If an argument is wrong, no place in the range keeps to ``subject_to`` (the nearest is named), or
            no run has the number that is to be largest.

        Notes
        -----
        Results jump where a small change brings the mass to rest, so no gradients are used: the range is
        scanned, and the scan repeated in smaller and smaller boxes around the best places.

        Examples
        --------
        >>> best = scene.best({"stops.travel_limit_mm": (1, 6, 0.5)}, subject_to="max_abs_x_m<=0.003")
        >>> best["travel_limit_mm"].round(2)
        array([3.])
        """
        if maximize is not None:
            raise TypeError("best() has no argument maximize: write maximise=...")
        design = _mapping("over", over, '{"stops.travel_limit_mm": (0.5, 7)}')
        form = "(least, largest) or (least, largest, step)"
        ranges = [
            f"{field}=" + ":".join(map(_value, _entries(field, ends, form, 2, 3)))
            for field, ends in design.items()
        ]
        form = '{"stops.travel_limit_mm": ("-1%", "1%")}'
        varied = []
        for field, ends in _mapping("vary", vary or {}, form).items():
            if not isinstance(ends, tuple) or len(ends) != 2:
                problem = f"give its least and largest deviation, {form}"
                raise _wrong("vary", f"{field}: {_shown(ends)}", problem)
            varied.append(f"{field}={_value(ends[0])}:{_value(ends[1])}")
        limits, places = _names("subject_to", subject_to), _names("environment", environment)
        with _Told(progress, "runs") as told:
            answer = _interwell.best(
                self._simulation,
                ranges,
                maximise,
                limits,
                places,
                varied,
                _count("seed", seed, 2**64) or 0,
                _real("until_settled", until_settled),
                None if runs_to is None else os.fspath(runs_to),
                _count("threads", threads),
                told,
            )
        return Table(answer)


def _unpickled(text: str, name: str, changed: bool) -> Scene:
    scene = Scene.from_text(text, name)
    scene._changed = changed
    return scene


def _scene(argument: str, given: Any) -> Scene:
    """Return an argument of :meth:`Scene.compare` as a scene."""
    if isinstance(given, Scene):
        return given
    if not isinstance(given, (str, os.PathLike)):
        one = "one by one, compare(*scenes)" if argument == "others" else "by name"
        problem = f"give scenes, scene files or names of built-in scenes {one}"
        raise _wrong(argument, _shown(given), problem)
    return Scene(given)


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
    points: int | None = None,
) -> Identified:
    """Identify damping, restitution or force from a measured record.

    Parameters
    ----------
    path : str or path
        The record: CSV with a header, a row a sample.
    of : str
        ``"damping"`` (of a free decay), ``"restitution"`` (of impacts on stops) or ``"force"`` (over
        position, of a slow pull).
    time, time_unit, column, unit, position, position_unit, base, base_unit : str, optional
        Columns and their units; by default found by the units in their names. ``base`` is the acceleration of
        the base, of restitution.
    start, end : float, optional
        Leave out what was recorded before and after these times in s. Not of force.
    impact_times : bool
        Of restitution: the rows are impacts, and their times are all that is known.
    points : int, optional
        Of force: points of the curve, 4 to 100000; by default 101, or as many as the samples allow. More
        follow the samples more closely and average fewer of them.

    Returns
    -------
    Identified
        A row for some eight turning points, for an impact, or for a position, with 95 % intervals;
        ``summary`` has the numbers of the whole record.

    Raises
    ------
    SceneError
        If the file cannot be read, a column is not found, an argument does not belong to ``of``, or nothing
        can be identified; the message says why and what would help.

    Notes
    -----
    Damping: an exponential envelope through the turning points, each weighted by its error; the damping ratio
    is the logarithmic decrement d over half a period as d/sqrt(pi² + d²). Some ten samples a period are
    needed. Restitution: polynomials through the flights on either side of an impact; a rebound should have 8
    samples. Force: cubics over neighbouring points, the mean of both directions of the pull.

    Examples
    --------
    >>> decay = iw.identify("decay.csv", "damping")
    >>> round(decay.summary["damping_ratio"]["value"], 4)
    0.02
    """
    answer, summary, known = _interwell.identify(
        os.fspath(path),
        of,
        [time, time_unit],
        [column, unit],
        [position, position_unit],
        [base, base_unit],
        [_real("start", start), _real("end", end)],
        impact_times,
        _count("points", points),
    )
    return Identified(answer, summary, known)
