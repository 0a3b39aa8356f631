"""The HTML elements of a report; all text is escaped."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from html import escape

_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 62em; margin: 2em auto; padding: 0 1em; color: #222 }
table { border-collapse: collapse; margin: 1em 0; font-size: 13px }
th, td { border-bottom: 1px solid #ddd; padding: 0.25em 0.7em; text-align: left }
th { background: #f4f4f4 }
figure { margin: 1em 0 }
figure img { max-width: 100% }
figcaption { font-size: 13px; color: #555 }
.simulated { background: #b00020; color: white; padding: 0.6em 1em; font-weight: bold }
"""


def page(title: str, banner: str, parts: Sequence[str]) -> str:
    """banner: shown above everything and before the title; none if empty."""
    head = f"{banner} - {title}" if banner else title
    shown = f'<p class="simulated" role="alert">{escape(banner)}</p>\n' if banner else ""
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{escape(head)}</title>\n'
        f"<style>{_STYLE}</style>\n</head>\n<body>\n{shown}<h1>{escape(title)}</h1>\n"
        + "\n".join(parts)
        + "\n</body>\n</html>\n"
    )


def heading(words: str, level: int = 2) -> str:
    return f"<h{level}>{escape(words)}</h{level}>"


def paragraph(words: str) -> str:
    return f"<p>{escape(words)}</p>"


def listing(entries: Sequence[str]) -> str:
    return "<ul>\n" + "\n".join(f"<li>{escape(entry)}</li>" for entry in entries) + "\n</ul>"


def table(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    head = "".join(f"<th>{escape(words)}</th>" for words in headings)
    body = "\n".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table>\n<tr>{head}</tr>\n{body}\n</table>"


def picture(svg: str, caption: str) -> str:
    """The figure embedded as an image: several inline SVG trees would share their identifiers."""
    data = base64.b64encode(svg.encode()).decode()
    words = escape(caption, quote=True)
    image = f'<img src="data:image/svg+xml;base64,{data}" alt="{words}">'
    return f"<figure>{image}<figcaption>{words}</figcaption></figure>"
