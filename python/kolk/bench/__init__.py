"""How fast this machine runs kolk: whole steps of settled flows, and its share of the peak.

`kolk bench` prints it; :func:`measure` gives the same figures as an object.
"""

from __future__ import annotations

from .measure import Bench, Figures, Rate, measure

__all__ = ["Bench", "Figures", "Rate", "measure"]
