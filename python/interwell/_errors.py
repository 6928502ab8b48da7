"""Exceptions."""

from __future__ import annotations

from typing import NamedTuple, Sequence


class Fault(NamedTuple):
    """One thing that is wrong with a scene or an argument."""

    file: str
    """The scene file, or ``built-in NAME``; empty for an argument."""
    line: int | None
    """Line in the file, where the value is written there."""
    field: str
    """Dotted path of the field, or name of the argument."""
    value: str
    """The value as written."""
    problem: str
    """The problem and its remedy."""


class SceneError(ValueError):
    """A scene or an argument is wrong.

    The message has a line for each fault; ``faults`` has the same as data.

    Parameters
    ----------
    message : str
        The message.
    faults : sequence of Fault
        The faults.

    Attributes
    ----------
    faults : tuple of Fault
        Each with file, line, field, value, and the problem with its remedy.

    Examples
    --------
    >>> try:
    ...     scene.set({"stops.restitution": 1.2})
    ... except iw.SceneError as error:
    ...     print(error.faults[0].field, error.faults[0].value)
    stops.restitution 1.2
    """

    faults: tuple[Fault, ...]

    def __init__(self, message: str, faults: Sequence[Fault] = ()) -> None:
        super().__init__(message)
        self.faults = tuple(faults)


class ComputationError(RuntimeError):
    """Scene and arguments are right, but there is no answer, as the message says.

    Flexures may have no solution, a run may end before a question is answered, or there is no motion that
    repeats near that of the run. A run or a cell of a grid that ends early is no error; its ``outcome`` says
    why.
    """
