from typing import Any, Callable, Sequence

import numpy as np
import numpy.typing as npt

__version__: str

_Over = Sequence[tuple[str, Sequence[float]]]
_Told = Callable[[int, int | None], None] | None

class Answer:
    @property
    def names(self) -> list[str]: ...
    @property
    def units(self) -> list[str]: ...
    @property
    def words(self) -> list[str]: ...
    def values(self, name: str) -> npt.NDArray[np.float64] | list[Any]: ...
    def csv(self) -> str: ...
    def picture(
        self,
        kind: str,
        quantity: str | None = None,
        x: tuple[float, float] | None = None,
        y: tuple[float, float] | None = None,
        dark: bool = False,
        width_mm: float | None = None,
        height_mm: float | None = None,
    ) -> bytes: ...

class Run:
    @property
    def samples(self) -> Answer: ...
    @property
    def events(self) -> Answer: ...
    @property
    def mass_g(self) -> float: ...
    def summary(self) -> str: ...
    def potential(self) -> npt.NDArray[np.float64]: ...
    def outcome(self) -> str: ...

class Simulation:
    @staticmethod
    def load(spec: str) -> Simulation: ...
    @staticmethod
    def preset(name: str) -> Simulation: ...
    @staticmethod
    def from_text(name: str, text: str) -> Simulation: ...
    def with_all(self, changes: Sequence[tuple[str, str]]) -> Simulation: ...
    def with_force(
        self,
        force: Callable[[float], float],
        range: tuple[float, float],
        tolerance: float,
        breaks: Sequence[float],
    ) -> tuple[Simulation, float]: ...
    def with_force_samples(
        self, x_m: Sequence[float], force_n: Sequence[float], tolerance: float
    ) -> Simulation: ...
    def with_drive(
        self,
        acceleration: Callable[[float], float] | Sequence[float],
        frequency_hz: float,
        tolerance: float,
    ) -> Simulation: ...
    @property
    def name(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def notes(self) -> str: ...
    @property
    def text(self) -> str: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def fields(self) -> list[str]: ...
    def get(self, field: str) -> tuple[float | None, str | None]: ...
    @property
    def equilibria(self) -> list[tuple[float, bool]]: ...
    @property
    def barrier_j(self) -> tuple[float, float] | None: ...
    def run(
        self,
        dt: float | None = None,
        at: Sequence[float] | None = None,
        until_settled: float | None = None,
    ) -> Run: ...
    def curve(self, positions: Sequence[float] | None = None) -> Answer: ...

def sweep(
    scene: Simulation,
    over: _Over,
    columns: Sequence[str],
    until_settled: float | None = None,
    carry: str | None = None,
    uncertain: Sequence[str] = (),
    draws: int | None = None,
    seed: int | None = None,
    threads: int | None = None,
    progress: _Told = None,
) -> Answer: ...
def ask(
    study: str,
    scene: Simulation,
    arguments: dict[str, Any],
    threads: int | None = None,
    progress: _Told = None,
) -> tuple[Answer, list[Answer]]: ...
def compare(
    scene: Simulation,
    name: str,
    others: Sequence[tuple[str, Simulation]],
    until_settled: float | None = None,
    threads: int | None = None,
    progress: _Told = None,
) -> Answer: ...
def best(
    scene: Simulation,
    over: Sequence[str],
    maximise: str,
    subject_to: Sequence[str],
    environment: Sequence[str],
    vary: Sequence[str],
    seed: int,
    until_settled: float | None = None,
    runs_to: str | None = None,
    threads: int | None = None,
    progress: _Told = None,
) -> Answer: ...
def identify(
    path: str,
    of: str,
    time: Sequence[str | None],
    column: Sequence[str | None],
    position: Sequence[str | None],
    base: Sequence[str | None],
    between: Sequence[float | None],
    impact_times: bool,
    points: int | None = None,
) -> tuple[Answer, str, float | None]: ...
def presets() -> list[tuple[str, str]]: ...
