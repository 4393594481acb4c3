"""Which effects a scene runs, why, and what each of them costs.

`kolk explain SCENE` prints it; :func:`explain` gives the same as an object.
"""

from __future__ import annotations

from .report import Cost, EffectReport, Explanation, Suggestion, explain

__all__ = ["Cost", "EffectReport", "Explanation", "Suggestion", "explain"]
