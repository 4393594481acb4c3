"""What a scene is before it runs: its particles, its numbers, its warnings, and a picture.

:func:`check` does the whole validation, particles included, :func:`describe` says it in words, and
:func:`picture` draws it. None of them needs the engine.

| module | idea |
|---|---|
| `report` | the scene in figures and in words |
| `numbers` | sound speed, resolution, time step, viscosity |
| `walls` | walls that are too thin, overlap or leave gaps |
| `places` | particles on top of each other, fluid that touches nothing, probes inside walls |
| `picture` | the set-up drawn |
"""

from __future__ import annotations

from .picture import picture
from .report import BodyReport, Report, check, describe

__all__ = ["BodyReport", "Report", "check", "describe", "picture"]
