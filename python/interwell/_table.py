"""Answers: tables of arrays, with pictures."""

from __future__ import annotations

import json
import os
import tempfile
from typing import TYPE_CHECKING, Any, Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from . import _interwell
from ._errors import Fault, SceneError

if TYPE_CHECKING:
    import pandas
    import xarray

Array = npt.NDArray[Any]


def _write(path: str | os.PathLike[str], content: bytes) -> None:
    """Write a file whole or not at all."""
    path = os.fspath(path)
    folder = os.path.dirname(path) or "."
    handle, temporary = tempfile.mkstemp(dir=folder, prefix=".interwell-")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(temporary, 0o666 & ~umask)
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


class Picture:
    """A picture, which a notebook shows.

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

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the picture; the name ends in ``.svg``, ``.png`` or ``.pdf``."""
        kind = os.path.splitext(os.fspath(path))[1].lstrip(".").lower()
        _write(path, self._bytes(kind))


class Table(Mapping[str, Array]):
    """Named columns of one length, in SI units unless the name says otherwise.

    ``table["x_m"]`` is the column ``x_m``. Columns of numbers are float64, with NaN where a value is missing;
    counts are int64, or float64 with NaN where one is missing; words are strings, empty where one is missing.
    """

    def __init__(self, answer: _interwell.Answer) -> None:
        self._answer = answer
        self._arrays: dict[str, Array] = {}

    def __getitem__(self, name: str) -> Array:
        if name not in self._arrays:
            values = self._answer.values(name)
            if not isinstance(values, np.ndarray):
                missing = any(value is None for value in values)
                values = np.array(values, dtype=float) if missing else np.array(values)
            self._arrays[name] = values
        return self._arrays[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._answer.names)

    def __len__(self) -> int:
        return len(self._answer.names)

    @property
    def columns(self) -> list[str]:
        """Names of the columns."""
        return self._answer.names

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column; empty for a pure number, a count or a word."""
        return dict(zip(self._answer.names, self._answer.units))

    @property
    def words(self) -> list[str]:
        """Sentences about the answer."""
        return self._answer.words

    @property
    def rows(self) -> int:
        """Number of rows."""
        names = self._answer.names
        return len(self._answer.values(names[0])) if names else 0

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.rows} rows: {', '.join(self.columns)}>"

    def csv(self) -> str:
        """Return the table as CSV, byte for byte as the command line writes it."""
        return self._answer.csv()

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write the table as CSV."""
        ending = os.path.splitext(os.fspath(path))[1].lower()
        if ending not in ("", ".csv", ".txt"):
            problem = f"tables are written as CSV: name a .csv, or take to_pandas() for {ending}"
            fault = Fault("", None, "path", os.fspath(path), problem)
            raise SceneError(f"path = {os.fspath(path)}: {problem}", [fault])
        _write(path, self.csv().encode())

    def to_pandas(self) -> pandas.DataFrame:
        """Return a data frame; ``attrs["units"]`` has the units."""
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
        quantity
            Of a grid the column; of a run the panels, such as ``"displacement,power"``; of a spectrum
            ``"amplitude"`` or ``"psd"``.
        x, y
            Ranges of the axes, in their units. Of a run ``x`` is a range of times in s.
        dark
            Whether the colours are those of a dark page.
        width_mm, height_mm
            Size on paper in mm; without it the picture is for a screen.

        Returns
        -------
        Picture
            A notebook shows it; ``save("map.pdf")`` writes it.
        """
        options = {
            "quantity": quantity,
            "x": x,
            "y": y,
            "dark": dark,
            "width_mm": width_mm,
            "height_mm": height_mm,
        }
        return Picture(self._answer, options)


class Grid(Table):
    """A table with a row for each cell of a grid over fields.

    ``grid["rms_velocity_m_per_s"]`` has the shape of the grid: one axis for each field, the slowest first.
    With a walk both ways there is one more axis before the last one: up, then down.
    """

    def __init__(
        self, answer: _interwell.Answer, over: Mapping[str, Array], carry: str | None = None
    ) -> None:
        super().__init__(answer)
        self.over: dict[str, Array] = dict(over)
        """The values of each field."""
        self._carry = carry

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the axes: the columns of the fields, and ``direction`` with a walk both ways."""
        fields = self._answer.names[: len(self.over)]
        return (*fields[:-1], "direction", fields[-1]) if self._carry == "both" else tuple(fields)

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the axes."""
        lengths = [len(values) for values in self.over.values()]
        return (*lengths[:-1], 2, lengths[-1]) if self._carry == "both" else tuple(lengths)

    def __getitem__(self, name: str) -> Array:
        column = super().__getitem__(name)
        if column.shape == self.shape:
            return column
        array = column.reshape(self.shape)
        # a walk down has its rows from the last value to the first
        if self._carry == "down":
            array = array[..., ::-1]
        elif self._carry == "both":
            array = array.copy()
            array[..., 1, :] = array[..., 1, ::-1].copy()
        self._arrays[name] = array
        return array

    def to_pandas(self) -> pandas.DataFrame:
        """Return a data frame with a row for each cell, in the order of :meth:`csv`."""
        return Table(self._answer).to_pandas()

    def to_xarray(self) -> xarray.Dataset:
        """Return a data set over the fields; each variable has its unit as the attribute ``units``."""
        import xarray

        coordinates: dict[str, Any] = {}
        units = self.units
        fields = [dim for dim in self.dims if dim != "direction"]
        for dim, values in zip(fields, self.over.values()):
            coordinates[dim] = (dim, values, {"units": units[dim]})
        if "direction" in self.dims:
            coordinates["direction"] = ["up", "down"]
        variables = {
            name: (self.dims, self[name], {"units": units[name]})
            for name in self.columns
            if name not in coordinates
        }
        return xarray.Dataset(variables, coordinates)


class Run:
    """One run of a scene.

    Attributes
    ----------
    samples
        ``t_s, x_m, v_m_per_s, base_accel_m_per_s2, phase``; with a transducer also
        ``voltage_v, current_a, power_w``.
    """

    def __init__(self, run: _interwell.Run, mass_kg: float, scene: Any) -> None:
        self._run = run
        self._mass_kg = mass_kg
        self._scene = scene
        self._summary: dict[str, Any] | None = None
        self._events: Array | None = None
        self.samples = Table(run.samples)

    @property
    def t(self) -> Array:
        """Times in s, shape (n,)."""
        return self.samples["t_s"]

    @property
    def x(self) -> Array:
        """Displacement of the mass relative to its base in m, shape (n,)."""
        return self.samples["x_m"]

    @property
    def v(self) -> Array:
        """Velocity relative to the base in m/s, shape (n,)."""
        return self.samples["v_m_per_s"]

    @property
    def base_accel(self) -> Array:
        """Acceleration of the base in m/s², shape (n,)."""
        return self.samples["base_accel_m_per_s2"]

    @property
    def phase(self) -> Array:
        """What the mass does: words such as ``free`` or ``rest``, shape (n,)."""
        return self.samples["phase"]

    @property
    def energy(self) -> Array:
        """Kinetic and potential energy relative to the base in J, shape (n,)."""
        potential = self._scene.curve(self.x)["potential_j"]
        energy: Array = 0.5 * self._mass_kg * self.v**2 + potential
        return energy

    @property
    def summary(self) -> dict[str, Any]:
        """Statistics of the run, as the option ``--summary`` of the command line writes them.

        The keys have the units: ``rms_velocity_m_per_s``.
        """
        if self._summary is None:
            summary = json.loads(self._run.summary())
            for key in ("arguments", "wall_s"):
                summary.pop(key, None)
            self._summary = summary
        return self._summary

    @property
    def events(self) -> Array:
        """Events in order of time: a structured array, ``events["t_s"]``, ``events["kind"]``."""
        if self._events is None:
            table = Table(self._run.events)
            columns = [table[name] for name in table.columns]
            kinds = [(name, column.dtype) for name, column in zip(table.columns, columns)]
            events = np.empty(table.rows, dtype=kinds)
            for name, column in zip(table.columns, columns):
                events[name] = column
            self._events = events
        return self._events

    def plot(self, panels: str | Sequence[str] | None = None, **options: Any) -> Picture:
        """Draw the run; see :meth:`Table.plot`.

        Parameters
        ----------
        panels
            Some of ``displacement``, ``velocity``, ``acceleration``, ``power``, ``energy``, ``portrait``.
        """
        names = panels if panels is None or isinstance(panels, str) else ",".join(panels)
        return self.samples.plot(names, **options)

    def _repr_svg_(self) -> str:
        return self.plot()._repr_svg_()

    def __repr__(self) -> str:
        return f"<Run of {self.samples.rows} samples, {self._run.outcome()}>"


class Basins(Table):
    """Basins of attraction: a row for each start."""

    def __init__(self, starts: _interwell.Answer, attractors: _interwell.Answer) -> None:
        super().__init__(starts)
        self.attractors = Table(attractors)
        """A row for each attractor."""


class Identified(Table):
    """What was identified from a record: rows over amplitude, impact or position."""

    def __init__(self, answer: _interwell.Answer, summary: str) -> None:
        super().__init__(answer)
        parsed = json.loads(summary)
        for key in ("arguments", "wall_s", "cpu_s"):
            parsed.pop(key, None)
        self.summary: dict[str, Any] = parsed
        """The numbers that sum the record up, with their 95 % intervals."""

