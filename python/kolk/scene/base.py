"""What every part of a scene shares: frozen, no unknown key, and errors that a user can act on.

Pydantic's own errors never leave this file: each becomes a :class:`~kolk.errors.SceneError` that
names the key's path, what was found, what is allowed, and the nearest key for a misspelt one.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from typing import Annotated, Any

import numpy as np
from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    Strict,
    StringConstraints,
    ValidationError,
)
from pydantic_core import ErrorDetails

from kolk.errors import Problem, SceneError


def _plain_number(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _plain_list(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value


LARGEST = 1e60
"""Numbers beyond it are slips, and those nearer to zero than its inverse are zero: the cube of
either would leave the range of f64."""


def within_range(value: float) -> float:
    """``value``, or 0 where it is next to nothing. Raises ValueError beyond LARGEST."""
    if not abs(value) <= LARGEST:
        raise ValueError(f"found {value:g}, must not exceed {LARGEST:g}")
    return value if abs(value) >= 1.0 / LARGEST else 0.0


# Strict: a number in quotes or a bool is a mistake, not a number.
Real = Annotated[
    float,
    Strict(),
    Field(allow_inf_nan=False),
    BeforeValidator(_plain_number),
    AfterValidator(within_range),
]
Positive = Annotated[Real, Field(gt=0)]
NotNegative = Annotated[Real, Field(ge=0)]
Whole = Annotated[int, Strict(), BeforeValidator(_plain_number)]
Flag = Annotated[bool, Strict()]
Text = Annotated[str, Strict()]
# Two or three components; which of them, the scene's dimension says.
Vector = Annotated[
    tuple[Real, ...], Field(min_length=2, max_length=3), BeforeValidator(_plain_list)
]
Interval = Annotated[tuple[Real, Real], BeforeValidator(_plain_list)]
# Names become file names and parts of a key's path.
Name = Annotated[
    str, Strict(), StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$", max_length=60)
]


def nearest(word: str, known: Iterable[str]) -> str:
    """``"; did you mean 'x'?"`` for the known word nearest to ``word``, else an empty string."""
    near = difflib.get_close_matches(word, list(known), n=1, cutoff=0.6)
    return f"; did you mean '{near[0]}'?" if near else ""


class Model(BaseModel):
    """Base of all parts of a scene."""

    model_config = ConfigDict(
        extra="forbid",
        frozen=True,
        validate_by_name=True,
        validate_by_alias=True,
        serialize_by_alias=True,
        arbitrary_types_allowed=True,
    )

    def __init__(self, /, **data: Any) -> None:
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise SceneError(problems=_problems(type(self), data, error)) from None

    @classmethod
    def keys(cls) -> list[str]:
        """The keys of this part as a scene file spells them."""
        return [f.alias or name for name, f in cls.model_fields.items() if not f.exclude]


def _problems(model: type[Model], data: Mapping[str, Any], error: ValidationError) -> list[Problem]:
    found: list[Problem] = []
    for detail in error.errors(include_url=False):
        path = _named(tuple(detail["loc"]), data)
        inner = detail.get("ctx", {}).get("error")
        if isinstance(inner, SceneError) and inner.problems:
            found.extend(p.under(path) for p in inner.problems)
        else:
            found.append(Problem(path, _message(model, detail)))
    found = _without_misspelt(model, error, found)
    # A list whose items are wrong is also "too short": only the items are news.
    return [
        p
        for p in found
        if not any(len(q.path) > len(p.path) and q.path[: len(p.path)] == p.path for q in found)
    ]


def _without_misspelt(
    model: type[Model], error: ValidationError, found: list[Problem]
) -> list[Problem]:
    """``found`` less the keys that are missing only because they are misspelt."""
    details = error.errors(include_url=False)
    unknown = [str(d["loc"][-1]) for d in details if d["type"] == "extra_forbidden"]
    missing = {str(d["loc"][-1]) for d in details if d["type"] == "missing"}
    meant = {m for word in unknown for m in difflib.get_close_matches(word, model.keys(), 1)}
    return [p for p in found if p.path not in {(key,) for key in missing & meant}]


def _named(path: tuple[str | int, ...], data: Mapping[str, Any]) -> tuple[str | int, ...]:
    """A list item under its name, where it has one: ``fluid.water`` rather than ``fluid[1]``."""
    named: list[str | int] = []
    here: Any = data
    for part in path:
        try:
            here = here[part]
        except (LookupError, TypeError):
            here = None
        name = here.get("name") if isinstance(here, Mapping) else getattr(here, "name", None)
        named.append(name if isinstance(part, int) and isinstance(name, str) else part)
    return tuple(named)


_ALLOWED = {
    "float_type": "a number",
    "int_type": "a whole number",
    "bool_type": "true or false",
    "string_type": "text in quotes",
    "finite_number": "a finite number",
    "tuple_type": "a list of numbers",
    "list_type": "a list",
    "model_type": "a table { key = value }",
    "model_attributes_type": "a table { key = value }",
    "dict_type": "a table { key = value }",
}


def shown(value: Any) -> str:
    """``value`` as a message shows it: as in a scene file, and never longer than a line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, tuple):
        value = list(value)
    text = repr(value) if not isinstance(value, str) else f'"{value}"'
    return text if len(text) <= 60 else text[:57] + "..."


def _message(model: type[Model], detail: ErrorDetails) -> str:
    kind, context, value = detail["type"], detail.get("ctx", {}), detail["input"]
    if kind == "extra_forbidden":
        key = str(detail["loc"][-1])
        hint = nearest(key, model.keys()) or "."
        return f"unknown key{hint} Allowed here: {', '.join(model.keys())}"
    if kind == "missing":
        return "is missing: add it"
    if kind == "value_error":
        return str(context["error"])
    found = f"found {shown(value)}"
    if kind in _ALLOWED:
        return f"{found}, must be {_ALLOWED[kind]}"
    if kind == "literal_error":
        expected = str(context["expected"]).replace("'", '"')
        options = [part.strip(' "') for part in expected.replace(" or ", ", ").split(",")]
        hint = nearest(value, options) if isinstance(value, str) else ""
        return f"{found}, must be {expected}{hint}"
    if kind == "greater_than":
        return f"{found}, must be greater than {context['gt']:g}"
    if kind == "greater_than_equal":
        return f"{found}, must be {context['ge']:g} or more"
    if kind == "less_than":
        return f"{found}, must be less than {context['lt']:g}"
    if kind == "less_than_equal":
        return f"{found}, must be {context['le']:g} or less"
    if kind in ("too_short", "too_long"):
        low, high = context.get("min_length"), context.get("max_length")
        bound = f"at least {low}" if low is not None else f"at most {high}"
        return f"{found}, must have {bound} entries"
    if kind == "string_pattern_mismatch":
        return f"{found}, must consist of letters, digits, '-' and '_' and begin with no mark"
    return f"{found}: {detail['msg']}"
