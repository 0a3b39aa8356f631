"""Pages and reports: tables in Markdown, and stamps that name the model a published figure was measured with, by its
SHA-256, in pages, results and pictures."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from haptoflow_training.errors import InputError

SHIPPED_MODEL = Path("Packages") / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"
# Key of the text chunk in a PNG file; the JavaScript and C# tools write the same key.
_PICTURE_KEY = "Model-SHA-256"


def sha256_of(path: Path) -> str:
    """SHA-256 of a file's bytes, in hexadecimal."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def model_line(sha256: str) -> str:
    """The line of a page that names the model of its figures."""
    return f"Model: SHA-256 `{sha256}`."


def picture_metadata(sha256: str) -> dict[str, str]:
    """Metadata for matplotlib's savefig to PNG."""
    return {_PICTURE_KEY: sha256}


def read_measured_page(path: Path) -> str:
    """Read a page whose measured part is to be replaced. InputError if it has none, so that nothing is measured in
    vain."""
    try:
        page = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read as a page ({error})") from error
    try:
        with_measured_words(page, "")
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
    return page


def with_measured_words(page: str, words: str) -> str:
    """The page with `words` between its markers; InputError if it has no markers."""
    found = re.search(r"(<!-- measured: begin [^>]*-->\n).*?(<!-- measured: end -->)", page, re.DOTALL)
    if found is None:
        raise InputError("the page has no `<!-- measured: begin (command) -->` before a `<!-- measured: end -->`")
    return f"{page[: found.end(1)]}\n{words.strip()}\n\n{page[found.start(2) :]}"


def table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of plain cells, without a line break at its end."""
    lines = [f"| {' | '.join(cells)} |" for cells in (headings, *rows)]
    return "\n".join([lines[0], "|" + "---|" * len(headings), *lines[1:]])
