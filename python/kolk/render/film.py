"""The film of a run: mp4 where imageio-ffmpeg is installed, else gif."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from kolk.compare.fields import FrameLike
from kolk.output.atomic import replacing

from . import style
from .flow import panel
from .plane import Extent, Painter, extent
from .quantity import Quantity, Scales, colour_range, quantity, spread, time_label
from .raster import Image, over

Picture = npt.NDArray[np.uint8]
"""(height, width, 3), both even."""

Tick = Callable[[], None]
"""Called after each frame of a film."""

LONGEST = 20.0
"""Seconds that a film may last; frames are shown faster rather than left out."""


def film_path(folder: Path, name: str = "film") -> Path:
    """Where :func:`write_film` writes: .mp4 or .gif, by what is installed."""
    return folder / f"{name}.{'mp4' if find_spec('imageio_ffmpeg') else 'gif'}"


def frames_per_second(count: int) -> float:
    """8 s for a short run, at most 30 frames a second unless the film would last LONGEST."""
    return max(min(count / 8.0, 30.0), count / LONGEST, 5.0)


def flow_film(
    frames: Sequence[FrameLike],
    path: Path,
    field: str = "speed",
    *,
    spacing: float,
    title: str = "",
    scales: Scales | None = None,
    width: float = 8.5,
    tick: Tick = lambda: None,
) -> Path:
    """Film of one field of a two-dimensional run. ``tick`` is called after each frame.

    The surroundings are drawn once; each frame only replaces the picture and the time.
    """
    sample = [frames[i] for i in spread(frames, 8)]
    shown = quantity(field, scales, sample)
    area = extent(sample, spacing)
    scale = colour_range(shown, sample)
    with style.look():
        surroundings = panel(area, shown, scale, title, width)
    pictures = _pictures(frames, spacing, scales, shown, scale, area, surroundings)
    return write_film(path, pictures, len(frames), tick)


def _pictures(
    frames: Sequence[FrameLike],
    spacing: float,
    scales: Scales | None,
    shown: Quantity,
    scale: Normalize,
    area: Extent,
    surroundings: tuple[Figure, Axes],
) -> Iterator[Picture]:
    with style.look():
        stage = Stage(*surroundings)
        painter = Painter(area.view(stage.width), spacing)
        for frame in frames:
            yield stage.picture(painter(frame, shown, scale), time_label(frame.time, scales))


class Stage:
    """The surroundings of a film, drawn once; each frame replaces the picture and the time.

    Made and used inside :func:`kolk.render.style.look`, on a figure of even pixel counts.
    """

    def __init__(self, made: Figure, axes: Axes) -> None:
        self._made = made
        assert isinstance(made.canvas, FigureCanvasAgg)
        self._canvas = made.canvas
        self._clock = axes.text(
            1.0,
            1.02,
            "",
            transform=axes.transAxes,
            ha="right",
            va="bottom",
            fontsize=9,
            animated=True,
        )
        self._canvas.draw()
        self._ground = self._canvas.copy_from_bbox(made.bbox)
        box = axes.get_window_extent()
        self._left, self._top = round(box.x0), round(made.bbox.height - box.y1)
        self.width = round(box.width)
        """Pixels that a picture is wide."""

    def picture(self, image: Image, label: str) -> Picture:
        """The whole frame: ``image`` (height, width, 3), or 4 premultiplied, in its place."""
        self._canvas.restore_region(self._ground)
        self._clock.set_text(label)
        self._made.draw_artist(self._clock)
        whole = np.asarray(self._canvas.buffer_rgba())[..., :3].copy()
        height, width = image.shape[:2]
        place = whole[self._top : self._top + height, self._left : self._left + width]
        image = image[: place.shape[0], : place.shape[1]]
        if image.shape[2] == 4:
            image = over(image, place.astype(np.float32) / np.float32(255.0))
        place[:] = image * 255.0 + 0.5
        return whole


def write_film(
    path: Path, pictures: Iterator[Picture], count: int, tick: Tick = lambda: None
) -> Path:
    """Writes pictures as .mp4 (H.264) or .gif, whole or not at all. ``count``: how many."""
    path.parent.mkdir(parents=True, exist_ok=True)
    rate = frames_per_second(count)
    pictures = _counted(pictures, tick)
    with replacing(path) as part:
        if path.suffix == ".mp4":
            _write_mp4(part, pictures, rate)
        else:
            _write_gif(part, pictures, rate)
    return path


def _counted(pictures: Iterator[Picture], tick: Tick) -> Iterator[Picture]:
    for picture in pictures:
        yield picture
        tick()


def _write_mp4(part: Path, pictures: Iterator[Picture], rate: float) -> None:
    import imageio_ffmpeg

    writer = None
    try:
        for picture in pictures:
            if writer is None:
                height, width = picture.shape[:2]
                writer = imageio_ffmpeg.write_frames(
                    str(part),
                    (width, height),
                    fps=rate,
                    codec="libx264",
                    quality=None,
                    macro_block_size=2,
                    # the name of the part file does not tell ffmpeg the format
                    output_params=["-preset", "veryfast", "-crf", "20", "-f", "mp4"],
                )
                writer.send(None)
            writer.send(np.ascontiguousarray(picture))
    finally:
        if writer is not None:
            writer.close()


def _write_gif(part: Path, pictures: Iterator[Picture], rate: float) -> None:
    from PIL import Image

    # half the size and one palette: a gif of full pictures is tens of megabytes
    small = [Image.fromarray(p).reduce(2) for p in pictures]
    palette = small[len(small) // 2].quantize(255)
    indexed = [s.quantize(palette=palette, dither=Image.Dither.NONE) for s in small]
    indexed[0].save(
        part,
        format="GIF",
        save_all=True,
        append_images=indexed[1:],
        duration=round(1000.0 / rate),
        loop=0,
        optimize=False,
    )
