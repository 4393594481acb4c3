"""Pictures: the right pixels, whole files, no trace in the user's Matplotlib."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import Normalize
from matplotlib.image import imread

from kolk import cases, references, render
from kolk.render import (
    curves,
    exact,
    film,
    flow,
    plane,
    quantity,
    raster,
    space,
    splat,
    style,
    surface,
)
from kolk.render.camera import look_at

SPACING = 0.02


@dataclass
class MadeFrame:
    """Fluid first, then one wall body."""

    time: float
    position: np.ndarray
    count: int
    arrays: dict[str, np.ndarray]

    @property
    def fields(self) -> tuple[str, ...]:
        return ("position", *self.arrays)

    def rows(self, kind: str) -> np.ndarray:
        wet = np.arange(len(self.position)) < self.count
        return wet if kind == "fluid" else ~wet

    def field(self, name: str) -> np.ndarray:
        return self.arrays[name]


@dataclass
class MadeRun:
    scene: Any
    folder: Path
    frames: list[MadeFrame]
    probes: dict[str, pd.DataFrame] = field(default_factory=dict)


def lattice(*sides: tuple[float, float]) -> np.ndarray:
    axes = [np.arange(low + SPACING / 2, high, SPACING) for low, high in sides]
    return np.stack([a.ravel() for a in np.meshgrid(*axes, indexing="ij")], -1)


def made_frame(time: float, dimension: int = 2) -> MadeFrame:
    if dimension == 2:
        water = lattice((0.0, 0.3 + time), (0.0, 0.2))
        around = lattice((-0.06, 1.06), (-0.06, 0.4))
    else:
        water = lattice((0.0, 0.3 + time), (0.0, 0.3), (0.0, 0.2))
        around = lattice((-0.04, 1.04), (-0.04, 0.34), (-0.04, 0.4))
    top = np.array([1.0, 0.4] if dimension == 2 else [1.0, 0.3, 0.4])
    wall = around[~np.all((around > 0.0) & (around < top), axis=1)]
    x = np.concatenate([water, wall])
    velocity = np.zeros_like(x)
    velocity[: len(water), 0] = 1.0 + time
    pressure = 9810.0 * (0.2 - x[:, -1])
    return MadeFrame(time, x, len(water), {"velocity": velocity, "pressure": pressure})


@pytest.fixture
def frames() -> list[MadeFrame]:
    return [made_frame(t) for t in (0.0, 0.1, 0.2, 0.3, 0.4)]


def test_the_nearest_particle_owns_a_pixel() -> None:
    got = raster.owners(np.array([[10.0, 10.0], [16.0, 10.0]]), 5.0, 30, 20)
    assert got[10, 10] == 0 and got[10, 16] == 1
    assert got[10, 12] == 0 and got[10, 14] == 1
    assert got[0, 0] == raster.EMPTY
    outside = raster.owners(np.array([[-50.0, 3.0], [1e9, -1e9]]), 5.0, 30, 20)
    assert (outside == raster.EMPTY).all()


@pytest.mark.parametrize("radius", [0.4, 2.5, 6.0])
def test_discs_on_the_rim_of_a_picture_are_cut_by_it(radius: float) -> None:
    x, y = np.meshgrid(np.arange(-8.0, 20.0), np.arange(-8.0, 16.0))
    for one in np.stack([x.ravel(), y.ravel()], axis=-1)[:, None]:
        whole = raster.owners(one + 20.0, radius, 52, 48)
        assert np.array_equal(raster.owners(one, radius, 12, 8), whole[20:28, 20:32])


def test_painting_fills_a_lattice_and_leaves_the_rest_clear() -> None:
    view = raster.View(0.0, 1.0, 0.0, 0.5, 200, 100)
    x = lattice((0.0, 0.5), (0.0, 0.5))
    rgb = np.tile(np.array([[0.2, 0.4, 0.6]], np.float32), (len(x), 1))
    picture = raster.paint(view, x, rgb, 0.85 * SPACING)
    assert picture.shape == (100, 200, 4)
    assert picture[5:95, 5:95, 3].min() == 1.0
    assert picture[:, 110:, 3].max() == 0.0
    assert picture[50, 50, :3] == pytest.approx([0.2, 0.4, 0.6], abs=0.003)
    ground = np.ones((100, 200, 3), np.float32)
    assert raster.over(picture, ground)[50, 150] == pytest.approx([1.0, 1.0, 1.0])


@pytest.mark.parametrize("field_name", ["speed", "pressure"])
def test_colour_maps_rise_in_lightness(field_name: str) -> None:
    rgb = style.colours(field_name)(np.linspace(0.0, 1.0, 64))[:, :3]
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    luminance = linear @ [0.2126, 0.7152, 0.0722]
    assert np.all(np.diff(np.cbrt(luminance)) > 0.0)


def test_walls_set_the_view_and_a_lost_drop_does_not(frames: list[MadeFrame]) -> None:
    before = plane.extent(frames, SPACING)
    frames[-1].position[0] = [500.0, -300.0]
    after = plane.extent(frames, SPACING)
    assert after.right - after.left < 1.4 * (before.right - before.left)
    assert before.left == pytest.approx(-0.05 - 1.5 * SPACING)


def test_ranges_and_labels(frames: list[MadeFrame]) -> None:
    speed = quantity.quantity("speed")
    scale = quantity.colour_range(speed, frames)
    assert (scale.vmin, scale.vmax) == (0.0, pytest.approx(1.4))
    scales = quantity.Scales(depth=0.3, gravity=9.81, density=1000.0)
    pressure = quantity.quantity("pressure", scales)
    assert pressure.of(frames[0])[1].max() == pytest.approx(0.19 / 0.3)
    assert quantity.time_label(0.5) == "t = 0.50 s"
    assert "2.86" in quantity.time_label(0.5, scales)
    assert quantity.spread(frames, 4) == [1, 2, 3, 4]
    assert quantity.spread(frames[:2], 4) == [0, 1]


def test_the_free_surface_is_the_side_without_a_wall() -> None:
    # A block of water on a floor, against a wall on its left.
    water = lattice((0.0, 0.4), (0.0, 0.3))
    wall = lattice((-0.08, 0.6), (-0.08, 0.5))
    wall = wall[(wall[:, 0] < 0.0) | (wall[:, 1] < 0.0)]
    frame = MadeFrame(0.0, np.concatenate([water, wall]), len(water), {})
    shown = quantity.FreeSurface(
        "free surface", "", 1.0, 2 * SPACING, "wendland-c2", SPACING, (None, None)
    )
    x, on = shown.of(frame)
    np.testing.assert_array_equal(x, water)
    right, top = x[:, 0] > 0.4 - SPACING, x[:, 1] > 0.3 - SPACING
    # Where the surface meets a wall it may be called either.
    met = (x[:, 0] < 2 * SPACING) & top | (x[:, 1] < 2 * SPACING) & right
    np.testing.assert_array_equal((on == 1.0)[~met], (right | top)[~met])


def test_units_suit_the_values() -> None:
    def slow(size: float) -> MadeFrame:
        x = lattice((0.0, 0.2), (0.0, 0.2))
        velocity = np.full((len(x), 2), size)
        return MadeFrame(
            0.0, x, len(x), {"velocity": velocity, "pressure": size * 10 + x[:, 0] * 0}
        )

    labels = [quantity.quantity("speed", None, [slow(u)]).label for u in (0.0, 2e-5, 0.2, 3.0)]
    assert labels == ["speed [m/s]", "speed [µm/s]", "speed [m/s]", "speed [m/s]"]
    labels = [quantity.quantity("pressure", None, [slow(u)]).label for u in (1e-3, 3.0, 500.0)]
    assert labels == ["pressure [mPa]", "pressure [Pa]", "pressure [kPa]"]


@pytest.mark.parametrize("name", ["poiseuille", "still-water", "taylor-green"])
def test_exact_solutions_are_drawn(tmp_path: Path, name: str) -> None:
    (asked,) = cases.get(name).comparisons
    given = asked.parameters
    side = given.get("width", given.get("surface", given.get("length")))
    x = np.random.default_rng(5).random((300, 2)) * side
    still = {"velocity": np.ones((300, 2)), "pressure": np.zeros(300)}
    frames = [MadeFrame(t, x, 300, still) for t in (0.0, 0.1, 0.2)]
    path = exact.exact_picture(frames, asked, tmp_path / "exact.png", name)
    assert imread(path).shape[0] > 300


def test_sheet_and_frame(tmp_path: Path, frames: list[MadeFrame]) -> None:
    sheet = flow.flow_sheet(frames, tmp_path / "flow.png", spacing=SPACING, title="Made up")
    one = flow.frame_picture(frames[-1], tmp_path / "one.png", "pressure", spacing=SPACING)
    for path in (sheet, one):
        picture = imread(path)
        assert picture.shape[0] > 300 and picture[..., :3].std() > 0.05
    assert [p.name for p in sorted(tmp_path.iterdir())] == ["flow.png", "one.png"]


def test_tall_scenes_get_their_times_side_by_side(tmp_path: Path) -> None:
    def tall(time: float) -> MadeFrame:
        x = lattice((0.0, 0.2), (0.0, 0.6))
        return MadeFrame(time, x, len(x), {"velocity": x, "pressure": x[:, 1]})

    path = flow.flow_sheet([tall(t) for t in range(5)], tmp_path / "flow.png", spacing=SPACING)
    height, width = imread(path).shape[:2]
    assert width > 0.8 * height


@pytest.mark.parametrize("suffix", ["mp4", "gif"])
def test_film(tmp_path: Path, frames: list[MadeFrame], suffix: str) -> None:
    if suffix == "mp4":
        pytest.importorskip("imageio_ffmpeg")
    ticks: list[int] = []
    path = film.flow_film(
        frames, tmp_path / f"film.{suffix}", spacing=SPACING, tick=lambda: ticks.append(1)
    )
    assert len(ticks) == len(frames)
    head = path.read_bytes()[:12]
    assert head[4:8] == b"ftyp" if suffix == "mp4" else head[:6] == b"GIF89a"
    if suffix == "gif":
        from PIL import Image

        with Image.open(path) as made:
            assert made.n_frames == len(frames)


def test_a_film_that_breaks_leaves_no_file(tmp_path: Path, frames: list[MadeFrame]) -> None:
    del frames[3].arrays["velocity"]
    with pytest.raises(KeyError):
        film.flow_film(frames, tmp_path / "film.gif", spacing=SPACING)
    assert not list(tmp_path.iterdir())


def test_nearer_spheres_hide_farther_ones() -> None:
    camera = look_at([0.0, 0.0, 0.0], [1.0, 1.0, 1.0])
    middle = np.full(3, 0.5)
    x = np.stack([middle + 0.3 * camera.toward, middle - 0.3 * camera.toward])
    rgb = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], np.float32)
    for order in ([0, 1], [1, 0]):
        picture = splat.spheres(camera, 120, x[order], rgb[order], 0.1)
        covered = picture[..., 3] == 1.0
        assert covered.any()
        assert picture[covered][:, 0].min() > 0.3 and picture[covered][:, 1].max() == 0.0


def test_camera_shows_the_whole_box_upright() -> None:
    camera = look_at([0.0, 0.0, 0.0], [3.0, 1.0, 1.0])
    frame = np.stack([camera.right, camera.up, camera.toward])
    assert frame @ frame.T == pytest.approx(np.eye(3))
    assert np.linalg.det(frame) == pytest.approx(1.0)
    assert camera.up[2] > 0.0 and camera.right[0] > 0.0 and camera.aspect > 1.5


def test_the_inside_of_a_tank_is_found() -> None:
    made = made_frame(0.0, dimension=3)
    low, high = space.inside(made.position[made.rows("wall")], SPACING)
    assert low == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)
    assert high == pytest.approx([1.0, 0.3, 0.4], abs=1e-9)


def test_space_sheet_and_film_of_particles(tmp_path: Path) -> None:
    frames = [made_frame(t, 3) for t in (0.0, 0.2)]
    sheet = space.space_sheet(frames, tmp_path / "flow.png", spacing=SPACING, surface=False)
    assert imread(sheet)[..., :3].std() > 0.03
    made = space.space_film(frames, tmp_path / "film.gif", spacing=SPACING)
    assert made.stat().st_size > 1000


def test_surface_is_drawn_or_given_up_without_harm() -> None:
    camera = look_at([0.0, 0.0, 0.0], [1.0, 0.3, 0.4])
    water = made_frame(0.0, 3).position[:1000]
    rgb = np.full((1000, 3), 0.5, np.float32)
    drawn = surface.surfaces([surface.Cloud(water, rgb)], camera, 160, SPACING)
    if drawn is not None:
        (picture,) = drawn
        assert picture.shape[1:] == (160, 4)
        assert 0.02 < (picture[..., 3] > 0.5).mean() < 0.9


def test_a_crash_of_the_surface_process_is_survived(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(surface, "available", lambda: True)
    monkeypatch.setattr(surface.sys, "executable", "/bin/false")
    camera = look_at([0.0, 0.0, 0.0], [1.0, 1.0, 1.0])
    cloud = surface.Cloud(np.zeros((1, 3)), np.zeros((1, 3), np.float32))
    assert surface.surfaces([cloud], camera, 100, SPACING) is None


def made_probe(name: str, column: str) -> pd.DataFrame:
    record = references.load(name)
    pressure = record.values(column) * 2934.0
    return pd.DataFrame({"time": record.time * 0.17487 - 0.02, "value": pressure})


def test_render_run_draws_everything(tmp_path: Path, frames: list[MadeFrame]) -> None:
    probes = {
        "P1": made_probe("lobovsky-sensor1", "pressure"),
        "P2": made_probe("lobovsky-sensor2-band", "median"),
    }
    scene = cases.get("dam-break").scene
    run = MadeRun(scene, tmp_path / "run", frames, probes)
    before = dict(mpl.rcParams)
    made = render.render_run(run, film=False, quiet=True)
    assert {p.name for p in made} == {
        "flow.png",
        "pressure.png",
        "field-pressure.png",
        "field-speed.png",
        "field-free-surface.png",
        "probe-P1.png",
        "probe-P2.png",
    }
    assert all(p.parent == tmp_path / "run" / "pictures" and p.stat().st_size for p in made)
    assert dict(mpl.rcParams) == before


def test_a_run_of_ones_own_needs_no_reference(tmp_path: Path, frames: list[MadeFrame]) -> None:
    for each in frames:
        del each.arrays["pressure"]
    scene = cases.get("dam-break").scene.replace(name="my-own")
    table = pd.DataFrame({"time": [0.0, 0.1], "x": [0.0, 1.0], "moment": [0.0, 0.1]})
    run = MadeRun(scene, tmp_path, frames, {"load": table})
    names = [p.name for p in render.render_run(run, film=True, quiet=True)]
    assert names[:3] == ["flow.png", "field-speed.png", "field-free-surface.png"]
    assert names[3] == "probe-load.png"
    assert names[4].startswith("film.")


def test_a_surge_that_never_arrives_is_drawn_too(tmp_path: Path) -> None:
    asked = cases.get("dam-break").comparisons[0]
    table = pd.DataFrame({"time": [0.0, 0.1, 0.2], "value": [0.0, 0.0, 0.0]})
    path = curves.probe_picture("P2", table, tmp_path / "p.png", asked)
    assert path.stat().st_size > 0


def test_missing_says_how_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(render, "find_spec", lambda name: None)
    lines = render.missing()
    assert len(lines) == 3
    assert render.missing(2) == [line for line in lines if "film" in line]
    assert all("kolk[pictures]" in line for line in lines)
    monkeypatch.setattr(render, "find_spec", lambda name: object())
    assert render.missing() == []


def test_pyplot_is_never_imported() -> None:
    code = (
        "import sys, kolk.render.studio; "
        "sys.exit('matplotlib.pyplot' in sys.modules or 'pyvista' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_given_range_is_kept(tmp_path: Path, frames: list[MadeFrame]) -> None:
    path = flow.frame_picture(
        frames[0], tmp_path / "a.png", spacing=SPACING, shown_range=Normalize(0.0, 10.0)
    )
    assert path.exists()
