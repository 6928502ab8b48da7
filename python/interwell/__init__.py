"""Simulation of bistable mechanisms with hard travel limits.

A :class:`Scene` describes a proof mass on a bistable mechanism, with stops, damping and excitation. Its
methods are the questions of the command line; they answer with tables of NumPy arrays in SI units.

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
