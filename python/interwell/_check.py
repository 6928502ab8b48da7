"""Checks of arguments."""

from __future__ import annotations

import difflib
import reprlib
from typing import Any, Callable, Iterable, Mapping, Union

import numpy as np
import numpy.typing as npt

from ._errors import Fault, SceneError

Over = Mapping[str, npt.ArrayLike]
Progress = Union[bool, Callable[[int, Union[int, None]], None]]


def _wrong(field: str, value: str, problem: str) -> SceneError:
    return SceneError(f"{field} = {value}: {problem}", [Fault("", None, field, value, problem)])


def _shown(value: object) -> str:
    """Return a value as a message shows it: one short line."""
    return " ".join(reprlib.repr(value).split())


def _without(problem: str, **arguments: tuple[object, object]) -> None:
    """Refuse the first argument whose value is not its default, given as ``(value, default)``."""
    for name, (value, default) in arguments.items():
        if value is not default and value != default:
            raise _wrong(name, _shown(value), problem)


def _numbers(name: str, values: npt.ArrayLike) -> npt.NDArray[Any]:
    """Return the values as an array of one axis."""
    try:
        array = np.atleast_1d(np.asarray(values, dtype=float))
    except (TypeError, ValueError) as error:
        raise _wrong(name, _shown(values), "give numbers, such as numpy.linspace(0, 2, 101)") from error
    if array.ndim != 1:
        raise _wrong(name, f"an array of shape {array.shape}", "give values along one axis")
    return array


def _entries(name: str, value: Any, form: str, *lengths: int) -> list[float]:
    """Return the numbers of a tuple; ``form`` is how a message shows it, such as ``(low, high)``."""
    try:
        items = [] if isinstance(value, (str, bytes, Mapping)) else list(value)
        numbers = [] if any(isinstance(item, (str, bytes)) for item in items) else [float(i) for i in items]
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) not in lengths:
        raise _wrong(name, _shown(value), f"give the numbers {form}")
    return numbers


def _number(name: str, value: Any) -> float:
    """Return a number that is no text."""
    try:
        if not isinstance(value, (str, bytes)):
            return float(value)
    except (TypeError, ValueError):
        pass
    raise _wrong(name, _shown(value), "give a number")


def _real(name: str, value: Any) -> float | None:
    """Return a number that may be left out."""
    return None if value is None else _number(name, value)


def _whole(name: str, value: Any, below: int = 2**32) -> int:
    """Return a whole number that is not negative."""
    if not isinstance(value, (int, np.integer)) or not 0 <= value < below:
        raise _wrong(name, _shown(value), "give a whole number from 0 up")
    return int(value)


def _count(name: str, value: int | None, below: int = 2**32) -> int | None:
    """Return a whole number that is not negative, or that is left out."""
    return None if value is None else _whole(name, value, below)


def _names(name: str, value: Iterable[str] | str) -> list[str]:
    """Return one text or several as a list."""
    try:
        names = [value] if isinstance(value, str) else list(value)
    except TypeError:
        names = [value]  # type: ignore[list-item]
    if not all(isinstance(item, str) for item in names):
        raise _wrong(name, _shown(value), "give a text or a list of texts")
    return names


def _mapping(name: str, value: Any, example: str) -> Mapping[str, Any]:
    """Return a mapping whose keys are texts."""
    if not isinstance(value, Mapping) or not all(isinstance(key, str) for key in value):
        raise _wrong(name, _shown(value), f"give a dict by the paths of fields, such as {example}")
    return value


def _near(name: str, names: list[str]) -> str:
    """Return which of the names may be meant, as the end of a sentence."""
    last = name.rpartition(".")[2]
    found = [known for known in names if known.rpartition(".")[2] == last]
    found = found or [known for known in names if last and known.rpartition(".")[2].startswith(last)]
    found = found or difflib.get_close_matches(name, names, n=3)
    if not found:
        near = difflib.get_close_matches(last, [known.rpartition(".")[2] for known in names], n=1)
        found = [known for known in names if known.rpartition(".")[2] in near]
    return f"; did you mean {' or '.join(found[:3])}?" if found else ""


def _word(name: str, value: str | None, words: tuple[str, ...]) -> str | None:
    """Return one of some words, or nothing."""
    if value is not None and value not in words:
        given = value if isinstance(value, str) else _shown(value)
        raise _wrong(name, given, f"give one of {', '.join(words)}")
    return value


def _over(over: Over | None) -> tuple[list[tuple[str, list[float]]], dict[str, npt.NDArray[Any]]]:
    given = _mapping("over", {} if over is None else over, '{"mass_g": [10, 20]}')
    arrays = {field: _numbers(field, values) for field, values in given.items()}
    return [(field, array.tolist()) for field, array in arrays.items()], arrays
