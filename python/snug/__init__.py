"""Proved answers about the limit surfaces of subdivision meshes.

    a, b = snug.read("bracket.obj"), snug.read("pin.obj")
    hit = snug.collide(a, b, pose_b=T)

Lengths are in the units of the meshes. Arrays of answers are read-only; indices are uint32, or int64 where -1 means none.
Do not change an array while a call with it is under way in another thread.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any, List

from ._errors import FileError, MeshError, MeshWarning, PoseError, UndecidedError
from ._snug import (
    Clearance,
    ClearanceSpans,
    ClosestPoint,
    Collision,
    ContactArea,
    ContactRegions,
    Contacts,
    Containment,
    Deviation,
    Distance,
    Enclosures,
    Envelope,
    Hull,
    Hulls,
    IntersectionCurve,
    Measures,
    Mesh,
    OneSidedDistance,
    Penetration,
    QuickHit,
    RayHits,
    Robot,
    SelfContact,
    SelfContactPairs,
    SignedDistance,
    Surface,
    SurfacePoint,
    Tessellation,
    TimeOfContact,
    Trajectory,
    __version__,
    clearance,
    collide,
    contacts,
    deviation,
    distance,
    inspect,
    penetration,
    read,
    read_assembly,
    time_of_contact,
    urdf,
)

__all__ = [
    "Clearance",
    "ClearanceSpans",
    "ClosestPoint",
    "Collision",
    "CollisionManager",
    "ContactArea",
    "ContactRegions",
    "Contacts",
    "Containment",
    "Deviation",
    "Distance",
    "Enclosures",
    "Envelope",
    "FileError",
    "Hull",
    "Hulls",
    "IntersectionCurve",
    "Measures",
    "Mesh",
    "MeshError",
    "MeshWarning",
    "OneSidedDistance",
    "Page",
    "Penetration",
    "PoseError",
    "QuickHit",
    "RayHits",
    "Robot",
    "SelfContact",
    "SelfContactPairs",
    "SignedDistance",
    "Surface",
    "SurfacePoint",
    "Tessellation",
    "TimeOfContact",
    "Trajectory",
    "UndecidedError",
    "__version__",
    "clearance",
    "collide",
    "collision",
    "contacts",
    "deviation",
    "distance",
    "inspect",
    "penetration",
    "proximity",
    "read",
    "read_assembly",
    "time_of_contact",
    "urdf",
    "view",
]

if TYPE_CHECKING:
    from . import collision, proximity
    from ._view import Page, view
    from .collision import CollisionManager


def __dir__() -> List[str]:
    """What users need."""
    return sorted(__all__)


def __getattr__(name: str) -> Any:
    """What is imported on first use."""
    if name in ("Page", "view"):
        from . import _view

        return getattr(_view, name)
    if name == "CollisionManager":
        return importlib.import_module("snug.collision").CollisionManager
    if name in ("collision", "proximity"):
        return importlib.import_module(f"snug.{name}")
    raise AttributeError(f"module 'snug' has no attribute '{name}'")
