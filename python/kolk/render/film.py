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
from kolk.compare.scales import Scales
from kolk.output.atomic import replacing

from . import style
from .flow import panel
from .plane import Extent, Painter, extent
from .quantity import Quantity, colour_range, quantity, spread, time_label

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
    shown = quantity(field, scales)
    sample = [frames[i] for i in spread(frames, 8)]
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
    made, axes = surroundings
    with style.look():
        canvas = made.canvas
        assert isinstance(canvas, FigureCanvasAgg)
        clock = axes.text(
            1.0, 1.02, "", transform=axes.transAxes, ha="right", va="bottom", fontsize=9, animated=True
        )
        canvas.draw()
        ground = canvas.copy_from_bbox(made.bbox)
        box = axes.get_window_extent()
        painter = Painter(area.view(round(box.width)), spacing)
        left, top = round(box.x0), round(made.bbox.height - box.y1)
        for frame in frames:
            canvas.restore_region(ground)
            clock.set_text(time_label(frame.time, scales))
            made.draw_artist(clock)
            picture = np.asarray(canvas.buffer_rgba())[..., :3].copy()
            image = painter(frame, shown, scale)
            target = picture[top : top + image.shape[0], left : left + image.shape[1]]
            target[:] = image[: target.shape[0], : target.shape[1]] * 255.0 + 0.5
            yield picture


def write_film(path: Path, pictures: Iterator[Picture], count: int, tick: Tick = lambda: None) -> Path:
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
