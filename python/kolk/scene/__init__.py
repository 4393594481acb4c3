"""Scenes: the model, its shapes and particles, and the files it comes from and goes to."""

from __future__ import annotations

from .composed import Difference, Function, Union
from .fill import Body, Filling
from .load import load, loads
from .mesh import Mesh, Outline
from .model import KERNEL_SUPPORT, Scene
from .parts import (
    FieldProbe,
    Fluid,
    ForceProbe,
    FrontProbe,
    LevelProbe,
    Numerics,
    Output,
    Periodic,
    PressureProbe,
    Probe,
    Wall,
)
from .rheology import HerschelBulkley, Viscosity
from .shapes import Box, Cylinder, Disc, Polygon, Shape, Sphere, Tank
from .template import template

__all__ = [
    "KERNEL_SUPPORT",
    "Body",
    "Box",
    "Cylinder",
    "Difference",
    "Disc",
    "FieldProbe",
    "Filling",
    "Fluid",
    "ForceProbe",
    "FrontProbe",
    "Function",
    "HerschelBulkley",
    "LevelProbe",
    "Mesh",
    "Numerics",
    "Outline",
    "Output",
    "Periodic",
    "Polygon",
    "PressureProbe",
    "Probe",
    "Scene",
    "Shape",
    "Sphere",
    "Tank",
    "Union",
    "Viscosity",
    "Wall",
    "load",
    "loads",
    "template",
]
