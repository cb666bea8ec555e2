# SPDX-License-Identifier: BSD-3-Clause
"""Certified distances between convex shapes, and virtual force feedback on robot arms.

Lengths in [m], angles in [rad], forces in [N], torques in [N m], times in [s] unless a name says
otherwise. `X_AB` is the pose of frame B in A: a rigid 4x4 matrix, or a pair of position (3,) and
unit quaternion w x y z (4,). What cannot be used is refused with `SetupError`.
"""

from typing import TYPE_CHECKING, Any

from . import _repel
from ._errors import SetupError, how_to_have
from ._repel import (QUERY_ENDS, ArmKinematics, Cell, Command, ForceLaw, QueryOptions, Separation,
                     Shape, Tick, WarmStart, WarmStarts, World, separation)
from ._rerun import CellLog, rerun
from ._separations import SEPARATION, separations
from .description import Admittance, Arm, Capacities, Kinematics, Link, Loose, Obstacle, Part
from .program import program, run, view
from .recording import Recording, read_recording

if TYPE_CHECKING:
    from ._repel import (Cover, DepthCamera, LiveView, Scene, ScriptedOperator, SimulatedArm, cover,
                         load_scene)

__version__ = "0.2.0"

__all__ = ["Admittance", "Arm", "ArmKinematics", "Capacities", "Cell", "CellLog", "Command",
           "Cover", "DepthCamera", "ForceLaw", "Kinematics", "Link", "LiveView", "Loose",
           "Obstacle", "Part", "QUERY_ENDS", "QueryOptions", "Recording", "SEPARATION", "Scene",
           "ScriptedOperator", "Separation", "SetupError", "Shape", "SimulatedArm", "Tick",
           "WarmStart", "WarmStarts", "World", "cover", "load_scene", "program", "read_recording",
           "rerun", "run", "separation", "separations", "view"]

#: What a build leaves out when packages are missing, and the part of it that is left out.
_PARTS = {"Scene": "scenes", "ScriptedOperator": "scenes", "SimulatedArm": "scenes",
          "load_scene": "scenes", "Cover": "covers", "cover": "covers", "DepthCamera": "cameras",
          "LiveView": "views"}

for _name in _PARTS:
    if hasattr(_repel, _name):
        globals()[_name] = getattr(_repel, _name)
    else:
        __all__.remove(_name)


def __getattr__(name: str) -> Any:
    if name in _PARTS:
        raise AttributeError(f"repel.{name} is not in this build: {how_to_have(_PARTS[name])}")
    raise AttributeError(f"module 'repel' has no attribute {name!r}")
