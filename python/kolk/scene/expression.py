"""Functions of position written in a scene file: ``"cos(2*pi*x) * sin(2*pi*y)"``.

Numbers, ``x y z pi``, ``+ - * / **`` and a few functions. Parsed by Python's
own parser and evaluated over NumPy arrays by a walk over the allowed nodes: nothing else runs.
"""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from .base import nearest, shown

FloatArray = npt.NDArray[np.float64]

FUNCTIONS: dict[str, Callable[..., Any]] = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "exp": np.exp,
    "log": np.log,
    "sqrt": np.sqrt,
    "tanh": np.tanh,
    "sinh": np.sinh,
    "cosh": np.cosh,
    "abs": np.abs,
    "min": np.minimum,
    "max": np.maximum,
    "atan2": np.arctan2,
    "hypot": np.hypot,
}
_TWO_ARGUMENTS = {"min", "max", "atan2", "hypot"}
_BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: np.true_divide,
    ast.Pow: np.power,
}
_AXES = "xyz"
_HELP = f"allowed are numbers, x, y, z, pi, + - * / ** and {', '.join(FUNCTIONS)}"


class Expression:
    """A function of position from its text. Raises ValueError where the text is none."""

    __slots__ = ("_tree", "text")

    def __init__(self, text: str) -> None:
        self.text = text
        try:
            self._tree = ast.parse(text, mode="eval").body
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            raise ValueError(f"found {shown(text)}, which is no expression: {_HELP}") from None
        _check(self._tree, text)

    def __call__(self, position: FloatArray) -> FloatArray:
        """Values (n,) at ``position`` (n, D) in m; a z in 2D raises ValueError."""
        names = {axis: position[:, i] for i, axis in enumerate(_AXES[: position.shape[1]])}
        with np.errstate(all="ignore"):
            value = _evaluate(self._tree, names)
        return np.broadcast_to(np.asarray(value, np.float64), len(position)).copy()

    @property
    def names(self) -> set[str]:
        """The axes that the expression uses."""
        found = {n.id for n in ast.walk(self._tree) if isinstance(n, ast.Name)}
        return found & set(_AXES)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Expression) and self.text == other.text

    def __hash__(self) -> int:
        return hash(self.text)

    def __repr__(self) -> str:
        return f'"{self.text}"'


def _check(node: ast.expr, text: str) -> None:
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return
    if isinstance(node, ast.Name):
        if node.id in _AXES or node.id == "pi":
            return
        hint = nearest(node.id, [*FUNCTIONS, "x", "y", "z", "pi"]) or ";"
        raise ValueError(f"unknown name '{node.id}' in {shown(text)}{hint} {_HELP}")
    if isinstance(node, ast.BinOp) and type(node.op) in _BINARY:
        _check(node.left, text)
        _check(node.right, text)
        return
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.UAdd):
        _check(node.operand, text)
        return
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        name = node.func.id
        if name not in FUNCTIONS:
            hint = nearest(name, FUNCTIONS) or ";"
            raise ValueError(f"unknown function '{name}' in {shown(text)}{hint} {_HELP}")
        wanted = 2 if name in _TWO_ARGUMENTS else 1
        if len(node.args) != wanted:
            raise ValueError(
                f"'{name}' takes {wanted} argument(s), found {len(node.args)} in {shown(text)}"
            )
        for argument in node.args:
            _check(argument, text)
        return
    raise ValueError(f"found {shown(text)}, which goes beyond an expression: {_HELP}")


def _evaluate(node: ast.expr, names: dict[str, FloatArray]) -> Any:
    if isinstance(node, ast.Constant):
        # In floats throughout: 10**1000 must be infinite, not an integer that fills the memory.
        return np.float64(node.value)  # type: ignore[arg-type]
    if isinstance(node, ast.Name):
        if node.id == "pi":
            return np.pi
        if node.id not in names:
            raise ValueError(f"'{node.id}' does not exist in {len(names)}D")
        return names[node.id]
    if isinstance(node, ast.BinOp):
        return _BINARY[type(node.op)](_evaluate(node.left, names), _evaluate(node.right, names))
    if isinstance(node, ast.UnaryOp):
        value = _evaluate(node.operand, names)
        return -value if isinstance(node.op, ast.USub) else value
    assert isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
    return FUNCTIONS[node.func.id](*(_evaluate(a, names) for a in node.args))
