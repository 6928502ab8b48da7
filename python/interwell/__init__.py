"""Simulation of bistable mechanisms with hard travel limits.

A :class:`Scene` describes a proof mass on a bistable mechanism, with stops, damping and excitation. Its
methods are the questions of the command line; they answer with tables of NumPy arrays in SI units.
:func:`identify` takes damping, restitution or force from a measured record.

Notes
-----
Columns and keys have their unit at the end of the name (``x_m``, ``v_m_per_s``); fields of a scene have the
unit of scene files (``mass_g``, ``travel_limit_mm``).

A wrong scene or argument is a :class:`SceneError`, a ``ValueError`` whose ``faults`` have file, line, field,
value and the problem with its remedy. A :class:`ComputationError`, a ``RuntimeError``, says why a right
question has no answer. Ctrl-C ends a question with ``KeyboardInterrupt``.

Examples
--------
>>> import interwell as iw
>>> scene = iw.Scene.preset("paper").set(excitation={"amplitude_g": 1.3})
>>> run = scene.run()
>>> run.summary["regime"]
'interwell'
"""

from ._errors import ComputationError, Fault, SceneError
from ._interwell import __version__
from ._scene import Scene, identify, presets
from ._table import Basins, Grid, Identified, Picture, Run, Table

__all__ = [
    "Basins",
    "ComputationError",
    "Fault",
    "Grid",
    "Identified",
    "Picture",
    "Run",
    "Scene",
    "SceneError",
    "Table",
    "__version__",
    "identify",
    "presets",
]
