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
    """

    faults: tuple[Fault, ...]

    def __init__(self, message: str, faults: Sequence[Fault] = ()) -> None:
        super().__init__(message)
        self.faults = tuple(faults)


class ComputationError(RuntimeError):
    """Scene and arguments are right, but there is no answer, as the message says."""
