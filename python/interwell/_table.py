"""Answers: tables of arrays, with pictures."""

from __future__ import annotations

import json
import os
import tempfile
from typing import TYPE_CHECKING, Any, Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from . import _interwell
from ._check import _entries, _near, _real, _shown, _wrong

if TYPE_CHECKING:
    import pandas
    import xarray

Array = npt.NDArray[Any]

# earlier names of columns
_EARLIER = {"mean_power_w": "mean_load_power_w"}
# columns of yes or no, and columns of words that may have no rows
_FLAGS = ("crossing_undecided", "settled", "stable", "steady", "sure", "undecided")
_WORDS = ("direction", "event", "kind", "phase", "side")


def _column(name: str, values: list[Any]) -> Array:
    """Return an array of words, of counts, or of yes and no."""
    if not values:
        return np.array([], dtype=bool if name in _FLAGS else str if name in _WORDS else int)
    kinds = set(values)
    if kinds <= {"true", "false", ""} and (name in _FLAGS or kinds != {""}):
        flags = [None if value == "" else value == "true" for value in values]
        return np.array(flags, dtype=object if "" in kinds else bool)
    return np.array(values, dtype=float) if None in kinds else np.array(values)


def _write(path: str | os.PathLike[str], content: bytes) -> None:
    """Write a file whole or not at all."""
    path = os.fspath(path)
    folder = os.path.dirname(path) or "."
    try:
        handle, temporary = tempfile.mkstemp(dir=folder, prefix=".interwell-")
    except OSError as error:
        raise OSError(error.errno, error.strerror, path) from None
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(temporary, 0o666 & ~umask)
        os.replace(temporary, path)
    except BaseException as error:
        os.unlink(temporary)
        if isinstance(error, OSError):
            raise OSError(error.errno, error.strerror, path) from None
        raise


def _unpicklable(thing: object, instead: str) -> TypeError:
    return TypeError(f"a {type(thing).__name__} cannot be pickled: pass {instead} on")


class Picture:
    """A picture, which a notebook shows; the answer of :meth:`Table.plot` and :meth:`Run.plot`.

    It is drawn by the program's own painter; :meth:`save` writes the same picture as a file.
    """

    def __init__(self, answer: _interwell.Answer, options: Mapping[str, Any]) -> None:
        self._answer = answer
        self._options = dict(options)
        self._svg = self._bytes("svg")

    def _bytes(self, kind: str) -> bytes:
        return self._answer.picture(kind, **self._options)

    def _repr_svg_(self) -> str:
        return self._svg.decode()

    def __repr__(self) -> str:
        return "<Picture: a notebook shows it, save(path) writes it>"

    def __reduce__(self) -> Any:
        raise _unpicklable(self, "the file of save(path)")

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the picture; the file appears whole or not at all.

        Parameters
        ----------
        path : str or path
            The file; its name ends in ``.svg``, ``.png`` or ``.pdf``.

        Raises
        ------
        SceneError
            If the name ends otherwise.
        OSError
            If the file cannot be written.

        Examples
        --------
        >>> scene.curve().plot().save("curve.pdf")
        """
        kind = os.path.splitext(os.fspath(path))[1].lstrip(".").lower()
        _write(path, self._bytes(kind))


class Table(Mapping[str, Array]):
    """Named columns of one length, in SI units unless the name says otherwise.

    ``table["x_m"]`` is the column ``x_m``. Columns of numbers are float64, with NaN where a value is missing;
    counts are int64, or float64 with NaN where one is missing; words are strings, empty where one is missing.
    Answers of yes or no are bool, or objects, True, False and None, where one is missing; in :meth:`csv` they
    are ``true`` and ``false``.

    Notes
    -----
    A table is a mapping: ``len(table)`` is the number of columns, ``dict(table)`` has all arrays. The arrays
    are read-only; ``table["x_m"].copy()`` can be written to. Tables are equal if all columns are.

    Examples
    --------
    >>> table = scene.curve([0.0, 7e-3])
    >>> table.columns
    ['x_m', 'force_n', 'potential_j', 'stiffness_n_per_m']
    >>> table.rows
    2
    """

    def __init__(self, answer: _interwell.Answer) -> None:
        self._answer = answer
        self._arrays: dict[str, Array] = {}

    def __getitem__(self, name: str) -> Array:
        """Return a column.

        Parameters
        ----------
        name : str
            Name of the column; :attr:`columns` lists them.

        Returns
        -------
        ndarray, shape (rows,)
            float64, int64, strings or bool; read-only.

        Raises
        ------
        KeyError
            If there is no such column.
        """
        if name not in self._arrays and name not in self._answer.names:
            name = _EARLIER.get(name, name)
        if name not in self._arrays:
            if name not in self._answer.names:
                near = _near(str(name), self.columns)
                there = "There are" if near else "; there are"
                raise KeyError(f"no column {name!r}{near}{' ' if near else ''}{there} {self._listed()}")
            values = self._answer.values(name)
            if not isinstance(values, np.ndarray):
                values = _column(name, values)
            values.flags.writeable = False
            self._arrays[name] = values
        return self._arrays[name]

    def _listed(self) -> str:
        return ", ".join(self.columns)

    def __iter__(self) -> Iterator[str]:
        return iter(self._answer.names)

    def __len__(self) -> int:
        return len(self._answer.names)

    def __contains__(self, name: object) -> bool:
        return name in self._answer.names

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Table):
            return NotImplemented
        if type(self) is not type(other) or self.columns != other.columns:
            return False
        pairs = [(self[name], other[name]) for name in self.columns]
        return all(np.array_equal(a, b, equal_nan=a.dtype.kind == b.dtype.kind == "f") for a, b in pairs)

    def __reduce__(self) -> Any:
        raise _unpicklable(self, "to_pandas(), csv() or dict(table)")

    def __copy__(self) -> Any:
        return self

    def __deepcopy__(self, _: Any) -> Any:
        return self

    def _ipython_key_completions_(self) -> list[str]:
        return self.columns

    @property
    def columns(self) -> list[str]:
        """Names of the columns, a list of str."""
        return self._answer.names

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column by its name; empty for a pure number, a count or a word.

        Examples
        --------
        >>> scene.curve().units["stiffness_n_per_m"]
        'N/m'
        """
        return dict(zip(self._answer.names, self._answer.units))

    @property
    def words(self) -> list[str]:
        """Sentences about the answer, a list of str; empty where there is nothing to say. The repr has them.

        Of a branch: where it ended inside the range and why; of a spectrum: its settings; of basins: each
        attractor; of a best design, a record, escapes and exponents of one scene: the result; of thresholds
        and compared scenes: what their rows lack, and why.
        """
        return self._answer.words

    @property
    def rows(self) -> int:
        """Number of rows."""
        names = self._answer.names
        return len(self._answer.values(names[0])) if names else 0

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.rows} rows: {self._listed()}{self._told()}>"

    def _told(self) -> str:
        """Return the sentences about the answer, each on a line of its own."""
        return "".join(f"\n  {line}" for line in self.words)

    def csv(self) -> str:
        """Return the table as CSV, byte for byte as the command line writes it.

        Returns
        -------
        str
            A header and a line for each row. Numbers are the shortest decimals that read back as the same
            float64; a missing value is an empty cell.

        Examples
        --------
        >>> scene.curve([0.0]).csv().splitlines()
        ['x_m,force_n,potential_j,stiffness_n_per_m', '0,0,0,-40']
        """
        return self._answer.csv()

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write the table as CSV; the file appears whole or not at all.

        Parameters
        ----------
        path : str or path
            The file; its name ends in ``.csv``, ``.txt`` or has no ending.

        Raises
        ------
        SceneError
            If the name ends otherwise, such as in ``.parquet``: take :meth:`to_pandas` for other formats.
        OSError
            If the file cannot be written.
        """
        ending = os.path.splitext(os.fspath(path))[1].lower()
        if ending not in ("", ".csv", ".txt"):
            problem = f"tables are written as CSV: name a .csv, or take to_pandas() for {ending}"
            raise _wrong("path", os.fspath(path), problem)
        _write(path, self.csv().encode())

    def to_pandas(self) -> pandas.DataFrame:
        """Return a data frame; ``attrs["units"]`` has the units.

        Returns
        -------
        pandas.DataFrame
            A column for each of the table, a row for each row.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        import pandas

        frame = pandas.DataFrame({name: Table.__getitem__(self, name) for name in self.columns})
        frame.attrs["units"] = self.units
        return frame

    def plot(
        self,
        quantity: str | None = None,
        *,
        x: tuple[float, float] | None = None,
        y: tuple[float, float] | None = None,
        dark: bool = False,
        width_mm: float | None = None,
        height_mm: float | None = None,
    ) -> Picture:
        """Draw the picture that the command line draws of this answer.

        Parameters
        ----------
        quantity : str, optional
            Of a grid the column, whose unit may be left out; of a run the panels, such as ``"displacement,power"``; of a spectrum
            ``"amplitude"`` or ``"psd"``.
        x, y : (float, float), optional
            Ranges of the axes, in their units, the lower end first. Of a run ``x`` is a range of times in s.
        dark : bool
            Whether the colours are those of a dark page.
        width_mm, height_mm : float, optional
            Size on paper in mm: the width 68 to 2000, the height 40 to 2000, as a PNG at most 508; without a
            width, which a height needs, the picture is for a screen.

        Returns
        -------
        Picture
            A notebook shows it; ``save("map.pdf")`` writes it.

        Raises
        ------
        SceneError
            If this table has no picture (an orbit, one threshold or one row of exponents, a best design,
            attractors, events), a grid is over more fields than can be drawn, there is no such quantity, a
            range is empty or, of a run, outside it, or the size is out of its range.

        Examples
        --------
        >>> scene.run().samples.plot("displacement", x=(8, 10), width_mm=85).save("run.pdf")
        """
        ranges: dict[str, tuple[float, float] | None] = {"x": None, "y": None}
        for name, given in (("x", x), ("y", y)):
            if given is not None:
                low, high = _entries(name, given, "(low, high)", 2)
                if not -np.inf < low < high < np.inf:
                    raise _wrong(name, _shown(given), "give two finite numbers, the lower first")
                ranges[name] = (low, high)
        if height_mm is not None and width_mm is None:
            raise _wrong("height_mm", _shown(height_mm), "give width_mm too: a picture on paper has both")
        options = {
            "quantity": quantity,
            **ranges,
            "dark": dark,
            "width_mm": _real("width_mm", width_mm),
            "height_mm": _real("height_mm", height_mm),
        }
        return Picture(self._answer, options)


class Grid(Table):
    """A table with a row for each cell of a grid over fields.

    ``grid["rms_velocity_m_per_s"]`` has the shape of the grid: one axis for each field, the slowest first.
    With a walk both ways there is one more axis before the last one: up, then down. Values of a walk down too
    are in the order of the field, unlike the rows of :meth:`csv` and :meth:`to_pandas`.

    Attributes
    ----------
    over : dict of str to ndarray, shape (n,)
        The values of each field, by its dotted path.

    Examples
    --------
    >>> grid = scene.sweep({"stops.travel_limit_mm": [2, 4], "excitation.amplitude_g": [0.5, 1, 1.5]})
    >>> grid.dims, grid.shape
    (('travel_limit_mm', 'amplitude_g'), (2, 3))
    """

    def __init__(
        self, answer: _interwell.Answer, over: Mapping[str, Array], carry: str | None = None
    ) -> None:
        super().__init__(answer)
        self.over: dict[str, Array] = dict(over)
        """The values of each field."""
        self._carry = carry
        self._shaped: dict[str, Array] = {}

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the axes, a tuple of str: the fields, and ``direction`` with a walk both ways."""
        fields = self._answer.names[: len(self.over)]
        return (*fields[:-1], "direction", fields[-1]) if self._carry == "both" else tuple(fields)

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the axes; a tuple of int."""
        lengths = [len(values) for values in self.over.values()]
        return (*lengths[:-1], 2, lengths[-1]) if self._carry == "both" else tuple(lengths)

    def __getitem__(self, name: str) -> Array:
        """Return a column in the shape of the grid.

        Parameters
        ----------
        name : str
            Name of the column; :attr:`columns` lists them.

        Returns
        -------
        ndarray, shape ``grid.shape``
            float64, int64, strings or bool, as in a :class:`Table`.

        Raises
        ------
        KeyError
            If there is no such column.
        """
        if name not in self._shaped:
            array = super().__getitem__(name).reshape(self.shape)
            # a walk down has its rows from the last value to the first
            if self._carry == "down":
                array = array[..., ::-1]
            elif self._carry == "both":
                array = array.copy()
                array[..., 1, :] = array[..., 1, ::-1].copy()
            array.flags.writeable = False
            self._shaped[name] = array
        return self._shaped[name]

    def __repr__(self) -> str:
        return f"<Grid {' x '.join(map(str, self.shape))}: {self._listed()}{self._told()}>"

    def to_pandas(self) -> pandas.DataFrame:
        """Return a data frame with a row for each cell, in the order of :meth:`csv`.

        Returns
        -------
        pandas.DataFrame
            ``attrs["units"]`` has the units.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        return super().to_pandas()

    def to_xarray(self) -> xarray.Dataset:
        """Return a data set over the fields; each variable has its unit as the attribute ``units``.

        Returns
        -------
        xarray.Dataset
            With the dimensions :attr:`dims` and the values of the fields as coordinates.

        Raises
        ------
        ImportError
            If xarray is not installed.
        """
        import xarray

        coordinates: dict[str, Any] = {}
        units = self.units
        fields = [dim for dim in self.dims if dim != "direction"]
        for dim, values in zip(fields, self.over.values()):
            coordinates[dim] = (dim, values, {"units": units[dim]})
        if "direction" in self.dims:
            coordinates["direction"] = ["up", "down"]
        variables = {
            name: (self.dims, self[name].copy(), {"units": units[name]})
            for name in self.columns
            if name not in coordinates
        }
        return xarray.Dataset(variables, coordinates)


class Run:
    """One run of a scene; the answer of :meth:`Scene.run`.

    Attributes
    ----------
    samples : Table
        ``t_s, x_m, v_m_per_s, base_accel_m_per_s2, phase``; with a transducer also
        ``voltage_v, current_a, power_w``. A row for each sample, up to where the run ended. At the instant of
        an event the state is that after it.

    Notes
    -----
    ``t``, ``x``, ``v`` and ``base_accel`` are the columns of ``samples`` and are not copied. ``run["x_m"]``,
    ``run.csv()``, ``run.to_csv(path)`` and ``run.to_pandas()`` are those of ``samples``.

    Examples
    --------
    >>> run = scene.run(dt=0.01)
    >>> run.t.shape
    (1001,)
    >>> run.summary["regime"]
    'interwell'
    """

    def __init__(self, run: _interwell.Run) -> None:
        self._run = run
        self._energy: Array | None = None
        self._summary: dict[str, Any] | None = None
        self._events: Array | None = None
        self.samples = Table(run.samples)

    @property
    def t(self) -> Array:
        """Times in s, float64 of shape (n,)."""
        return self.samples["t_s"]

    @property
    def x(self) -> Array:
        """Displacement of the mass relative to its base in m, float64 of shape (n,)."""
        return self.samples["x_m"]

    @property
    def v(self) -> Array:
        """Velocity relative to the base in m/s, float64 of shape (n,)."""
        return self.samples["v_m_per_s"]

    @property
    def base_accel(self) -> Array:
        """Acceleration of the base in m/s², float64 of shape (n,)."""
        return self.samples["base_accel_m_per_s2"]

    @property
    def phase(self) -> Array:
        """What the mass does, strings of shape (n,).

        ``free``, or ``left_stop`` and ``right_stop`` at rest on that stop (in contact with it, where it is
        compliant).
        """
        return self.samples["phase"]

    @property
    def energy(self) -> Array:
        """Kinetic and potential energy relative to the base in J, float64 of shape (n,), read-only.

        The potential is that of the mechanism, 0 at x = 0; what a compliant stop or a transducer stores is
        left out.
        """
        if self._energy is None:
            mass_kg = 1e-3 * self._run.mass_g
            self._energy = 0.5 * mass_kg * self.v**2 + self._run.potential()
            self._energy.flags.writeable = False
        return self._energy

    @property
    def summary(self) -> dict[str, Any]:
        """Statistics of the run, as the option ``--summary`` of the command line writes them.

        Returns
        -------
        dict of str to object
            The keys have the units: ``rms_velocity_m_per_s``. ``summary["outcome"]`` says how the run ended,
            ``"done"`` at its end; ``summary["ledger"]`` is the energy balance in J; ``summary["scene"]`` is
            the scene, in a form that :meth:`Scene.set` takes.

        Notes
        -----
        Most of it is of the settled window, from ``window_from_s`` to ``window_to_s``. A value that the run
        does not have is None, and what only other scenes have (a transducer, a ramp) is left out: take
        ``summary.get(key)``. A grid has a column for each, with NaN, or empty words, in both cases.
        """
        if self._summary is None:
            summary = json.loads(self._run.summary())
            for key in ("arguments", "wall_s"):
                summary.pop(key, None)
            self._summary = summary
        return self._summary

    @property
    def events(self) -> Array:
        """Events in order of time.

        Returns
        -------
        ndarray, structured, read-only
            Fields ``t_s`` (time in s), ``kind``, ``side`` (``left`` or ``right``: the stop, or the well that
            is entered), ``v_in_m_per_s`` and ``v_out_m_per_s`` (velocity before and after, signed).

            Kinds are ``impact`` (a rebound from a rigid stop), ``rest`` (the mass comes to rest on a stop),
            ``release`` (it leaves that stop), ``crossing`` (it passes the top of the barrier) and, of
            compliant stops, ``contact`` and ``separate``.

        Notes
        -----
        The slow last impacts of a chatter that ends in rest are summed in closed form (Nordmark and Piiroinen
        2009) and appear as its ``rest``.

        Examples
        --------
        >>> str(scene.run().events["kind"][0])
        'rest'
        """
        if self._events is None:
            table = Table(self._run.events)
            columns = [table[name] for name in table.columns]
            kinds = [(name, column.dtype) for name, column in zip(table.columns, columns)]
            events = np.empty(table.rows, dtype=kinds)
            for name, column in zip(table.columns, columns):
                events[name] = column
            events.flags.writeable = False
            self._events = events
        return self._events

    def plot(self, panels: str | Sequence[str] | None = None, **options: Any) -> Picture:
        """Draw the run; see :meth:`Table.plot`.

        Parameters
        ----------
        panels : str or sequence of str, optional
            Some of ``displacement``, ``velocity``, ``acceleration``, ``power``, ``energy``, ``portrait``; by
            default all but ``power`` and ``energy``.
        **options
            ``x``, ``y``, ``dark``, ``width_mm``, ``height_mm`` of :meth:`Table.plot`.

        Returns
        -------
        Picture

        Raises
        ------
        SceneError
            If there is no such panel, or an option is out of its range.
        """
        names = panels if panels is None or isinstance(panels, str) else ",".join(panels)
        return self.samples.plot(names, **options)

    def __getitem__(self, name: str) -> Array:
        """Return a column of the samples; see :meth:`Table.__getitem__`."""
        return self.samples[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.samples)

    def to_pandas(self) -> pandas.DataFrame:
        """Return the samples as a data frame; see :meth:`Table.to_pandas`."""
        return self.samples.to_pandas()

    def csv(self) -> str:
        """Return the samples as CSV; see :meth:`Table.csv`."""
        return self.samples.csv()

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write the samples as CSV; see :meth:`Table.to_csv`."""
        self.samples.to_csv(path)

    def _ipython_key_completions_(self) -> list[str]:
        return self.samples.columns

    def __reduce__(self) -> Any:
        raise _unpicklable(self, "summary, to_pandas() or csv()")

    def __copy__(self) -> Run:
        return self

    def __deepcopy__(self, _: Any) -> Run:
        return self

    def _repr_svg_(self) -> str:
        return self.plot()._repr_svg_()

    def __repr__(self) -> str:
        return f"<Run of {self.samples.rows} samples, {self._run.outcome()}>"


class Basins(Table):
    """Basins of attraction: a row for each start; the answer of :meth:`Scene.basins`.

    Attributes
    ----------
    attractors : Table
        A row for each attractor: ``attractor`` (from 1), ``regime``, ``period``, ``side``,
        ``rms_velocity_m_per_s``, ``x_m`` and ``v_m_per_s`` (one of its states at time 0 of the drive),
        ``starts`` (how many go to it), ``share`` of all starts, ``share_low`` and ``share_high`` (95 %
        interval of Wilson 1927).
    """

    def __init__(self, starts: _interwell.Answer, attractors: _interwell.Answer) -> None:
        super().__init__(starts)
        self.attractors = Table(attractors)
        """A row for each attractor."""


class Identified(Table):
    """What was identified from a record: rows over amplitude, impact or position.

    The answer of :func:`identify`. Columns whose names hold ``low`` and ``high`` are the ends of 95 %
    intervals. ``words`` has the columns that were read, the numbers and the remarks.

    Attributes
    ----------
    summary : dict
        The numbers of the whole record, each a dict of ``value`` and of ``low`` and ``high``, the 95 %
        interval, which are None of a count; and ``of``, ``samples``, ``step_s``, ``jitter_s``, ``gaps``,
        ``remarks``.
    tolerance : float or None
        Of a force, how closely it is known: the tolerance that :meth:`Scene.with_force` takes for it.
    """

    def __init__(self, answer: _interwell.Answer, summary: str, tolerance: float | None) -> None:
        super().__init__(answer)
        self.tolerance = tolerance
        """How closely a force is known, as a share."""
        parsed = json.loads(summary)
        for key in ("arguments", "wall_s", "cpu_s"):
            parsed.pop(key, None)
        self.summary: dict[str, Any] = parsed
        """The numbers that sum the record up, with their 95 % intervals."""

