"""Solids from files: closed surfaces of triangles (STL, OBJ, PLY) in 3D, closed polylines in 2D.

A file is read and checked once. Distances of surfaces are libigl's: the nearest point of a tree of
triangles, the sign from the winding number (Barill et al., ACM Trans. Graph. 37 (2018) 43), which
small faults of a surface do not upset.
"""

from __future__ import annotations

import functools
import math
from abc import abstractmethod
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
from pydantic import Field, model_validator

from . import distance
from .base import Positive, Real, Text, Vector
from .shapes import Axis, Bounds, Shape, fitted, problem

FloatArray = npt.NDArray[np.float64]

SURFACES = (".stl", ".obj", ".ply")
"""Files of triangles that a mesh is read from."""

SHOWN = 3
"""Holes and other faults that an error names one by one."""

MERGED = 1e-9
"""Corners nearer than this share of the surface's size are one: STL repeats every corner."""


class FromFile(Shape):
    """A closed surface read from a file: its inside is solid, or its outside."""

    file: Text = Field(description="path, relative to the scene file")
    scale: Positive = Field(default=1.0, description="m per unit of the file: 0.001 for mm")
    translate: Vector | None = Field(default=None, description="after scaling, m")
    offset: Real = Field(default=0.0, description="m by which the surface is moved outwards")
    solid: Literal["inside", "outside"] = Field(
        default="inside", description='"outside": a vessel, whose inside the surface encloses'
    )

    @abstractmethod
    def _signed(self, points: FloatArray) -> FloatArray:
        """Signed distance from the surface: negative on its inner side."""

    @abstractmethod
    def _corners(self) -> Bounds:
        """Lowest and highest corner (D,) of the placed surface, m."""

    def _placed(self, points: FloatArray) -> FloatArray:
        """Points of the file in the scene, m."""
        placed = self.scale * points
        return placed if self.translate is None else placed + np.array(self.translate)

    def hollow(self) -> bool:
        return self.solid == "outside"

    def distance(self, points: FloatArray) -> FloatArray:
        signed = self._signed(np.ascontiguousarray(points, np.float64)) - self.offset
        return -signed if self.hollow() else signed

    def bounds(self, thickness: float = 0.0) -> Bounds:
        low, high = self._corners()
        beyond = self.offset + (thickness if self.hollow() else 0.0)
        return low - beyond, high + beyond

    def axes(self, spacing: float, layers: int = 0) -> list[Axis]:
        """Fitted between the bounds of the surface, and carried on beyond them for a vessel."""
        beyond = layers if self.hollow() else 0
        axes = []
        low, high = self._corners()
        for a, b in zip(low - self.offset, high + self.offset, strict=True):
            inner = fitted(a, b, spacing)
            steps = np.arange(-beyond, len(inner.at) + beyond) + 0.5
            axes.append(Axis(np.asarray(a + inner.step * steps, np.float64), inner.step))
        return axes


class Mesh(FromFile):
    """A closed surface of triangles in 3D, from an STL, OBJ or PLY file."""

    @model_validator(mode="after")
    def _readable(self) -> Mesh:
        if self.translate is not None and len(self.translate) != 3:
            raise problem("translate", f"found {len(self.translate)} numbers, must have 3")
        self.surface()
        return self

    def surface(self) -> Surface:
        """Its triangles in the units of the file, checked."""
        path = _existing(self.file, SURFACES, "a closed polyline in 2D is an 'outline'")
        return _surface(str(path), path.stat().st_mtime_ns)

    def triangles(self) -> FloatArray:
        """Corners (m, 3, 3) of its triangles in m, normals out of the surface."""
        surface = self.surface()
        return self._placed(surface.corners)[surface.faces]

    def _signed(self, points: FloatArray) -> FloatArray:
        igl = _igl()
        surface = self.surface()
        corners = self._placed(surface.corners)
        squared = igl.point_mesh_squared_distance(points, corners, surface.faces)[0]
        # The winding number is 1 inside and 0 outside, approximately: only its sign is used.
        inside = igl.fast_winding_number(corners, surface.faces, points) > 0.5
        nearest = np.sqrt(np.asarray(squared, np.float64))
        return np.asarray(np.where(inside, -nearest, nearest))

    def _corners(self) -> Bounds:
        corners = self._placed(self.surface().corners)
        return corners.min(axis=0), corners.max(axis=0)

    def size(self) -> float:
        if self.hollow():
            return super().size()
        a, b, c = np.moveaxis(self.triangles(), 1, 0)
        return float(np.sum(a * np.cross(b, c)) / 6.0)

    def exact_size(self) -> float | None:
        return None if self.hollow() or self.offset else self.size()

    def dimensions(self) -> set[int]:
        return {3}


class Outline(FromFile):
    """Closed polylines in 2D, from a file of points: ``x, y`` a line, a blank line between two.

    What an odd number of them encloses is inside: a ring within a ring is a hole.
    """

    @model_validator(mode="after")
    def _readable(self) -> Outline:
        if self.translate is not None and len(self.translate) != 2:
            raise problem("translate", f"found {len(self.translate)} numbers, must have 2")
        self.rings()
        return self

    def rings(self) -> list[FloatArray]:
        """Corners (k, 2) of each closed polyline in m."""
        path = _existing(self.file, (), "")
        return [self._placed(ring) for ring in _rings(str(path), path.stat().st_mtime_ns)]

    def layers(self, spacing: float, count: int) -> FloatArray | None:
        """Along the polylines, as far apart as divides their length: no steps of a lattice."""
        import shapely

        solid = functools.reduce(
            shapely.symmetric_difference, [shapely.Polygon(ring) for ring in self.rings()]
        )
        side = -1.0 if self.solid == "inside" else 1.0
        found = []
        for layer in range(count):
            depth = self.offset + side * (layer + 0.5) * spacing
            edge = shapely.buffer(solid, depth, join_style="mitre").boundary
            for line in shapely.get_parts(edge):
                number = max(1, round(line.length / spacing))
                at = line.length * (np.arange(number) + 0.5) / number
                found.append(shapely.get_coordinates(shapely.line_interpolate_point(line, at)))
        return np.concatenate(found) if found else None

    def _signed(self, points: FloatArray) -> FloatArray:
        signed = np.stack([distance.polygon(points, ring) for ring in self.rings()])
        inside = np.sum(signed < 0.0, axis=0) % 2 == 1
        nearest = np.abs(signed).min(axis=0)
        return np.asarray(np.where(inside, -nearest, nearest))

    def _corners(self) -> Bounds:
        corners = np.concatenate(self.rings())
        return corners.min(axis=0), corners.max(axis=0)

    def size(self) -> float:
        if self.hollow():
            return super().size()
        return float(sum(abs(distance.polygon_area(ring)) for ring in self.rings()))

    def exact_size(self) -> float | None:
        # A ring within a ring is a hole, whose area counts twice too much.
        whole = not self.hollow() and not self.offset and len(self.rings()) == 1
        return self.size() if whole else None

    def dimensions(self) -> set[int]:
        return {2}


@dataclass(frozen=True)
class Surface:
    """Triangles that enclose a solid: corners (n, 3) in the file's units, faces (m, 3)."""

    corners: FloatArray
    faces: npt.NDArray[np.int64]


def place_shapes(data: Any, folder: Path) -> None:
    """Make the paths of surfaces and polylines in the plain ``data`` of a scene relative to
    ``folder``."""
    if isinstance(data, dict):
        for key, part in data.items():
            if key in ("mesh", "outline") and isinstance(part, dict):
                if isinstance(part.get("file"), str):
                    part["file"] = str(folder / part["file"])
            elif key in ("fluid", "wall", "shape", "union", "difference", "of", "minus"):
                place_shapes(part, folder)
    elif isinstance(data, list):
        for part in data:
            place_shapes(part, folder)


def _igl() -> Any:
    try:
        import igl
    except ImportError:
        raise problem(
            "file", "needs the library libigl: install it with  pip install 'kolk[geometry]'"
        ) from None
    return igl


def _existing(file: str, suffixes: tuple[str, ...], hint: str) -> Path:
    path = Path(file)
    if suffixes and path.suffix.lower() not in suffixes:
        raise problem(
            "file",
            f'found "{file}", must end in {", ".join(suffixes[:-1])} or {suffixes[-1]}; {hint}',
        )
    if not path.is_file():
        raise problem("file", f'found no file "{file}": give its path, relative to the scene file')
    return path


@functools.lru_cache(maxsize=16)
def _surface(file: str, _changed: int) -> Surface:
    """The surface in ``file``, whole and turned outwards. Raises SceneError."""
    igl = _igl()
    try:
        corners, faces = igl.read_triangle_mesh(file)
    except (RuntimeError, ValueError, MemoryError) as error:
        raise problem(
            "file", f'"{file}" cannot be read ({error}): export it anew as STL, OBJ or PLY'
        ) from None
    corners = np.asarray(corners, np.float64).reshape(len(corners), -1)
    faces = np.asarray(faces, np.int64)
    if len(faces) == 0 or corners.shape[1] != 3 or faces.shape[1] != 3:
        raise problem("file", f'"{file}" holds no triangles: export a surface, not points or lines')
    if not np.isfinite(corners).all():
        raise problem("file", f'"{file}" has corners that are not finite: export it anew')
    size = float(np.linalg.norm(np.ptp(corners, axis=0)))
    if size == 0.0:
        raise problem("file", f'"{file}" has no extent: all of its corners are one point')
    # Corners that rounding tells apart would be the edges of a slit.
    _, kept, merged = np.unique(
        np.round(corners / (MERGED * size)), axis=0, return_index=True, return_inverse=True
    )
    corners, faces = corners[kept], merged.ravel()[faces]
    distinct = (
        (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    )
    surface = Surface(corners, np.ascontiguousarray(faces[distinct]))
    _check_closed(file, surface)
    volume = _volume(surface)
    if abs(volume) < 1e-12 * size**3:
        raise problem("file", f'"{file}" encloses nothing: give a solid, not a sheet')
    if volume < 0.0:
        # The surface is turned inside out as a whole.
        surface = Surface(surface.corners, np.ascontiguousarray(surface.faces[:, ::-1]))
    return surface


def _volume(surface: Surface) -> float:
    a, b, c = np.moveaxis(surface.corners[surface.faces], 1, 0)
    return float(np.sum(a * np.cross(b, c)) / 6.0)


def _check_closed(file: str, surface: Surface) -> None:
    """Raise SceneError where the surface has holes, or faces that disagree about the outside."""
    # Every edge of a closed, oriented surface is walked once in each direction.
    ends = surface.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    low, high = ends.min(axis=1), ends.max(axis=1)
    edges, inverse, times = np.unique(
        np.stack([low, high], axis=1), axis=0, return_inverse=True, return_counts=True
    )
    open_edges = edges[times == 1]
    if len(open_edges):
        holes = _loops(surface.corners, open_edges)
        listed = "; ".join(holes[:SHOWN]) + ("; ..." if len(holes) > SHOWN else "")
        count = "1 hole" if len(holes) == 1 else f"{len(holes)} holes"
        raise problem(
            "file",
            f'"{file}" is not closed: found {count}, {listed} (in units of the file). Close them '
            "in the program that made it: nothing tells inside from outside",
        )
    forward = np.zeros(len(edges), np.int64)
    np.add.at(forward, inverse.ravel(), np.where(ends[:, 0] == low, 1, -1))
    turned = edges[(forward != 0) | (times % 2 == 1)]
    if len(turned):
        where = ", ".join(_point(surface.corners[edge].mean(axis=0)) for edge in turned[:SHOWN])
        raise problem(
            "file",
            f'"{file}" has {len(turned)} edges whose faces disagree about the outside, such as at '
            f"{where} (in units of the file): make its normals consistent in the program that made "
            "it",
        )


def _loops(corners: FloatArray, edges: npt.NDArray[np.int64]) -> list[str]:
    """The holes that open edges make, the largest first, in words: where, how large, of what."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    used, places = np.unique(edges, return_inverse=True)
    places = places.reshape(edges.shape)
    links = coo_array((np.ones(len(edges)), (places[:, 0], places[:, 1])), shape=(len(used),) * 2)
    count, label = connected_components(links, directed=False)
    holes = []
    for hole in range(count):
        rim = corners[used[label == hole]]
        across = float(np.linalg.norm(np.ptp(rim, axis=0)))
        number = int(np.sum(label[places[:, 0]] == hole))
        words = f"{across:.3g} across at {_point(rim.mean(axis=0))} ({number} edges)"
        holes.append((across, words))
    return [words for _, words in sorted(holes, key=lambda hole: -hole[0])]


def _point(x: FloatArray) -> str:
    return "[" + ", ".join(f"{c:.4g}" for c in x) + "]"


@functools.lru_cache(maxsize=16)
def _rings(file: str, _changed: int) -> tuple[FloatArray, ...]:
    """The closed polylines in ``file``. Raises SceneError."""
    try:
        text = Path(file).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise problem("file", f'"{file}" cannot be read: {error}') from None
    rings: list[list[tuple[float, float]]] = [[]]
    for number, line in enumerate(text.splitlines(), 1):
        words = line.partition("#")[0].replace(",", " ").replace(";", " ").split()
        if not words:
            if rings[-1] and not line.strip():
                rings.append([])
            continue
        try:
            x, y = (float(word) for word in words)
        except ValueError:
            if not rings[-1] and len(rings) == 1:
                continue  # a line of names above the numbers
            raise problem(
                "file", f'"{file}", line {number}: found "{line.strip()}", must be two numbers x, y'
            ) from None
        if not (math.isfinite(x) and math.isfinite(y)):
            raise problem("file", f'"{file}", line {number}: found {line.strip()}, must be finite')
        rings[-1].append((x, y))
    found = tuple(_closed(file, np.array(ring)) for ring in rings if ring)
    if not found:
        raise problem("file", f'"{file}" holds no points: give lines of two numbers, x, y')
    return found


def _closed(file: str, ring: FloatArray) -> FloatArray:
    """One polyline without the repeated last point. Raises SceneError where it is not closed."""
    import shapely

    steps = np.linalg.norm(np.diff(ring, axis=0), axis=1)
    ring = np.concatenate([ring[:1], ring[1:][steps > 0.0]])
    gap = float(np.linalg.norm(ring[-1] - ring[0]))
    if len(ring) > 1 and gap <= 1e-9 * float(np.ptp(ring, axis=0).max()):
        ring = ring[:-1]
    elif len(ring) > 2 and gap > 1.01 * float(steps.max()):
        raise problem(
            "file",
            f'"{file}" has a polyline that is not closed: found a gap of {gap:.3g} between its '
            f"last point {_point(ring[-1])} and its first {_point(ring[0])} (in units of the "
            "file). Repeat the first point at the end if a straight line closes it",
        )
    if len(ring) < 3:
        raise problem("file", f'"{file}" has a polyline of {len(ring)} points, must be 3 or more')
    polygon = shapely.Polygon(ring)
    if not polygon.is_valid or polygon.area == 0.0:
        reason = shapely.is_valid_reason(polygon) if not polygon.is_valid else "no area"
        raise problem(
            "file", f'"{file}" has a polyline that encloses nothing simple ({reason}): mend it'
        )
    return ring
