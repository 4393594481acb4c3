"""Closed surfaces as triangles, and files of them, written by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Triangles = tuple[FloatArray, npt.NDArray[np.int64]]


def box(low: list[float], high: list[float]) -> Triangles:
    """A box of twelve triangles, normals outwards."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return np.array(low) + corners * (np.array(high) - np.array(low)), np.array(faces)


def ball(radius: float, halvings: int = 4) -> Triangles:
    """An octahedron whose edges are halved, its corners on a sphere."""
    corners = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
    points = [np.array(c, float) for c in corners]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    for _ in range(halvings):
        middles: dict[tuple[int, int], int] = {}

        def middle(a: int, b: int, middles: dict[tuple[int, int], int] = middles) -> int:
            key = (min(a, b), max(a, b))
            if key not in middles:
                between = points[a] + points[b]
                middles[key] = len(points)
                points.append(between / np.linalg.norm(between))
            return middles[key]

        faces = [
            part
            for a, b, c in faces
            for ab, bc, ca in [(middle(a, b), middle(b, c), middle(c, a))]
            for part in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))
        ]
    return radius * np.array(points), np.array(faces)


def write_stl(path: Path, solid: Triangles) -> Path:
    """ASCII STL: corners repeated for every triangle."""
    corners, faces = solid
    lines = ["solid made"]
    for face in faces:
        a, b, c = corners[face]
        normal = np.cross(b - a, c - a)
        lines.append("facet normal {} {} {}".format(*normal))
        lines.append("outer loop")
        lines += ["vertex {!r} {!r} {!r}".format(*map(float, x)) for x in (a, b, c)]
        lines += ["endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid made"]), encoding="utf-8")
    return path


def write_obj(path: Path, solid: Triangles) -> Path:
    """Wavefront OBJ."""
    corners, faces = solid
    lines = ["v {!r} {!r} {!r}".format(*map(float, x)) for x in corners]
    lines += ["f {} {} {}".format(*(face + 1)) for face in faces]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def write_ply(path: Path, solid: Triangles) -> Path:
    """ASCII PLY."""
    corners, faces = solid
    head = ["ply", "format ascii 1.0", f"element vertex {len(corners)}"]
    head += [f"property double {axis}" for axis in "xyz"]
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    lines = ["{!r} {!r} {!r}".format(*map(float, x)) for x in corners]
    lines += ["3 {} {} {}".format(*face) for face in faces]
    path.write_text("\n".join([*head, *lines]) + "\n", encoding="utf-8")
    return path
