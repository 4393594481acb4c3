"""The frame of a report: one file with its style and its pictures inside."""

from __future__ import annotations

import base64
import html
import io
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LARGEST_FILM = 16_000_000
"""Bytes of a film that still goes into the file."""

STYLE = """
:root { color-scheme: light; --ink: #1d2b3a; --quiet: #66727f; --line: #e3e7eb; --run: #0b5fa5; }
body { font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; color: var(--ink); background: #fff;
  max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; margin: 0 0 .2rem; } h2 { font-size: 1.15rem; margin: 2.2rem 0 .6rem;
  border-bottom: 1px solid var(--line); padding-bottom: .2rem; }
p.lead { color: var(--quiet); margin-top: 0; } .bad { color: #b3261e; font-weight: 600; }
img, video { max-width: 100%; height: auto; display: block; margin: .6rem 0; }
table { border-collapse: collapse; margin: .6rem 0; font-size: .9rem; display: block;
  overflow-x: auto; }
th, td { padding: .25rem .7rem .25rem 0; text-align: left; border-bottom: 1px solid var(--line);
  font-variant-numeric: tabular-nums; vertical-align: top; }
td.number, th.number { text-align: right; }
.bar { background: var(--run); height: .7rem; display: inline-block; }
pre { background: #f5f7f9; padding: .8rem; overflow-x: auto; font-size: .82rem; }
figure { margin: 0 0 1rem; } figcaption { color: var(--quiet); font-size: .85rem; }
.grid { display: grid; grid-template-columns: repeat(auto-fit, minmax(24rem, 1fr)); gap: 1rem; }
details summary { cursor: pointer; color: var(--run); }
"""


def page(title: str, lead: str, sections: Iterable[tuple[str, str]]) -> str:
    """The whole file: sections are headings with their HTML; empty ones are left out."""
    body = "\n".join(
        f"<section>\n<h2>{escape(heading)}</h2>\n{content}\n</section>"
        for heading, content in sections
        if content
    )
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(title)}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n"
        f'<h1>{escape(title)}</h1>\n<p class="lead">{lead}</p>\n{body}\n</body>\n</html>\n'
    )


def escape(text: object) -> str:
    """Text as HTML."""
    return html.escape(str(text))


def items(lines: Iterable[str]) -> str:
    """Sentences as a list; empty for none."""
    found = "".join(f"<li>{escape(line)}</li>" for line in lines)
    return f"<ul>{found}</ul>" if found else ""


def table(heads: Sequence[str], rows: Iterable[Sequence[object]], numbers: int = 10**6) -> str:
    """A table; all columns but the first, up to the number `numbers`, are set flush right."""

    def cell(kind: str, i: int, content: object) -> str:
        mark = ' class="number"' if 0 < i <= numbers else ""
        text = content if isinstance(content, Raw) else escape(content)
        return f"<{kind}{mark}>{text}</{kind}>"

    head = "".join(cell("th", i, name) for i, name in enumerate(heads))
    lines = [
        "<tr>" + "".join(cell("td", i, content) for i, content in enumerate(row)) + "</tr>"
        for row in rows
    ]
    return f"<table><tr>{head}</tr>{''.join(lines)}</table>" if lines else ""


class Raw(str):
    """HTML that is not to be escaped."""

    __slots__ = ()


def bar(share: float) -> Raw:
    """A bar as long as a share of 12 rem."""
    return Raw(f'<span class="bar" style="width:{12.0 * min(max(share, 0.0), 1.0):.2f}rem"></span>')


def data_uri(content: bytes, kind: str) -> str:
    """Bytes inside the file."""
    return f"data:{kind};base64,{base64.b64encode(content).decode('ascii')}"


KINDS = {".png": "image/png", ".gif": "image/gif", ".mp4": "video/mp4"}


def picture(path: Path, caption: str = "") -> str:
    """A picture or a film from a file; a word in its place where it is too large."""
    kind = KINDS.get(path.suffix)
    if kind is None or not path.is_file():
        return ""
    told = f"<figcaption>{escape(caption or path.stem)}</figcaption>"
    if path.stat().st_size > LARGEST_FILM:
        return f"<figure><p>{escape(path.name)} is too large for this file.</p>{told}</figure>"
    source = data_uri(path.read_bytes(), kind)
    if kind.startswith("video"):
        shown = f'<video controls muted loop src="{source}"></video>'
    else:
        shown = f'<img alt="{escape(caption or path.stem)}" src="{source}">'
    return f"<figure>{shown}{told}</figure>"


def drawn(figure: Figure, caption: str = "") -> str:
    """A Matplotlib figure."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=110)
    told = f"<figcaption>{escape(caption)}</figcaption>" if caption else ""
    source = data_uri(buffer.getvalue(), "image/png")
    return f'<figure><img alt="{escape(caption)}" src="{source}">{told}</figure>'


def download(name: str, text: str) -> str:
    """A link that saves a text kept inside the file."""
    source = data_uri(text.encode("utf-8"), "text/plain")
    return f'<a download="{escape(name)}" href="{source}">{escape(name)}</a>'


def folded(title: str, content: str) -> str:
    """Something long, folded away."""
    return f"<details><summary>{escape(title)}</summary>{content}</details>"
