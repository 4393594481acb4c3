"""The child process of :mod:`kolk.render.surface`: reconstructs and draws, then ends.

Called with the folder that holds ``scene.npz`` and ``cloud*.npz``; leaves ``picture*.npy``, RGBA.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

WATER_LIGHT: dict[str, Any] = {"ambient": 0.35, "diffuse": 0.75, "specular": 0.3}


def main(folder: Path) -> None:
    """Draws every cloud in ``folder``."""
    import pyvista

    scene = np.load(folder / "scene.npz")
    left, right, bottom, top = scene["window"]
    width = int(scene["width"])
    height = max(round(width * (top - bottom) / (right - left)), 2)
    plotter = pyvista.Plotter(off_screen=True, window_size=[width, height], lighting="none")
    _light(plotter, pyvista, scene)
    _surroundings(plotter, pyvista, scene)
    _aim(plotter, scene, (left, right, bottom, top))
    plotter.enable_anti_aliasing("ssaa")
    for i in range(int(scene["count"])):
        cloud = np.load(folder / f"cloud{i}.npz")
        actor = _water(plotter, pyvista, cloud["position"], cloud["rgb"], float(scene["spacing"]))
        picture = plotter.screenshot(transparent_background=True, return_img=True)
        np.save(folder / f"picture{i}.npy", np.asarray(picture, np.uint8))
        if actor is not None:
            plotter.remove_actor(actor)
    plotter.close()


def _aim(plotter: Any, scene: Any, window: tuple[float, float, float, float]) -> None:
    left, right, bottom, top = window
    # the middle of the window, carried back from the picture plane into space
    middle = 0.5 * (left + right) * scene["right"] + 0.5 * (bottom + top) * scene["up"]
    away = 10.0 * max(right - left, top - bottom)
    camera = plotter.camera
    camera.focal_point = middle
    camera.position = middle + away * scene["toward"]
    camera.up = scene["up"]
    camera.parallel_projection = True
    camera.parallel_scale = 0.5 * (top - bottom)
    camera.clipping_range = (0.01 * away, 3.0 * away)


def _light(plotter: Any, pyvista: Any, scene: Any) -> None:
    for share, (right, up, toward) in ((0.85, (-0.4, 0.7, 0.7)), (0.35, (0.8, 0.1, 0.6))):
        towards = right * scene["right"] + up * scene["up"] + toward * scene["toward"]
        light = pyvista.Light(position=towards, focal_point=(0, 0, 0), intensity=share)
        light.positional = False
        plotter.add_light(light)


def _surroundings(plotter: Any, pyvista: Any, scene: Any) -> None:
    for low, high in scene["solids"]:
        bounds = np.stack([low, high], -1).ravel()
        plotter.add_mesh(pyvista.Box(bounds=bounds), color="#8d97a2", ambient=0.3, diffuse=0.7)
    for start, end in scene["edges"]:
        plotter.add_mesh(pyvista.Line(start, end), color="#66727f", line_width=2.0, lighting=False)


def _water(plotter: Any, pyvista: Any, position: Any, rgb: Any, spacing: float) -> Any:
    if len(position) < 4:
        return None
    import pysplashsurf

    reconstructed: Any = pysplashsurf.reconstruction_pipeline(
        np.ascontiguousarray(position, np.float32),
        attributes_to_interpolate={"rgb": np.ascontiguousarray(rgb, np.float32)},
        particle_radius=0.5 * spacing,
        # these two in particle radii
        smoothing_length=2.0,
        cube_size=1.3,
        iso_surface_threshold=0.6,
        mesh_cleanup=True,
        mesh_smoothing_weights=True,
        mesh_smoothing_iters=15,
        compute_normals=True,
        normals_smoothing_iters=8,
    )
    mesh = reconstructed[0]
    vertices = np.asarray(mesh.mesh.vertices)
    if not len(vertices):
        return None
    surface = pyvista.make_tri_mesh(vertices, np.asarray(mesh.mesh.triangles).astype(np.int64))
    colour = np.asarray(mesh.point_attributes["rgb"])
    surface.point_data["rgb"] = np.clip(colour * 255.0 + 0.5, 0.0, 255.0).astype(np.uint8)
    surface.point_data.active_normals = np.asarray(mesh.point_attributes["normals"], np.float32)
    return plotter.add_mesh(
        surface, scalars="rgb", rgb=True, smooth_shading=True, specular_power=30, **WATER_LIGHT
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]))
