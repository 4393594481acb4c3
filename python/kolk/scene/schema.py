"""The JSON schema of scene files, for editors. ``python -m kolk.scene.schema`` writes it anew."""

from __future__ import annotations

import json
from importlib import resources
from pathlib import Path
from typing import Any

from .model import Scene

FILE = "scene.schema.json"


def schema() -> dict[str, Any]:
    """The schema as the model has it now."""
    made = Scene.model_json_schema(by_alias=True)
    made["title"] = "kolk scene"
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **made}


def text() -> str:
    """The schema as the file holds it."""
    return json.dumps(schema(), indent=1, ensure_ascii=False) + "\n"


def shipped() -> str:
    """The file that the package ships."""
    return (resources.files(__package__) / FILE).read_text(encoding="utf-8")


if __name__ == "__main__":
    (Path(__file__).parent / FILE).write_text(text(), encoding="utf-8")
