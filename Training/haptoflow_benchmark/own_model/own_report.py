"""The output of `evaluate --model --recordings`: a table, its figures as JSON, and a picture of every label's
spectra."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from haptoflow_benchmark.own_model.own_accuracy import LabelAccuracy, RenderedPart, spectra_db
from haptoflow_training.markdown import table
from haptoflow_training.model_stamp import model_line, picture_metadata
from haptoflow_training.training.run_log import write_json, write_text

_HEADINGS = ("label", "parts", "seconds", "level dB, median", "level dB, p90", "GFC", "LSD dB")


def table_rows(found: Sequence[LabelAccuracy]) -> Iterator[tuple[str, ...]]:
    """Headings, a row for each label, and the median of all labels if there are several."""
    yield _HEADINGS
    for one in found:
        yield (
            one.label, str(one.parts), f"{one.seconds:.1f}", f"{one.level_error_median_db:+.2f}",
            f"{one.level_error_p90_db:.2f}", _shown(one.gfc, 4), _shown(one.lsd_db, 2),
        )  # fmt: skip
    if len(found) > 1:
        errors = np.concatenate([one.level_errors_db for one in found])
        gfc, lsd = [[value for value in values if value is not None] for values in (
            [one.gfc for one in found], [one.lsd_db for one in found]
        )]  # fmt: skip
        yield (
            "all", str(sum(one.parts for one in found)), f"{sum(one.seconds for one in found):.1f}",
            f"{np.median(errors):+.2f}", f"{np.quantile(np.abs(errors), 0.9):.2f}",
            _shown(float(np.median(gfc)) if gfc else None, 4), _shown(float(np.median(lsd)) if lsd else None, 2),
        )  # fmt: skip


def _shown(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}f}"


def lines(found: Sequence[LabelAccuracy]) -> Iterator[str]:
    """The table for a terminal."""
    rows = list(table_rows(found))
    widths = [max(len(row[place]) for row in rows) for place in range(len(_HEADINGS))]
    for row in rows:
        first, *others = (cell.ljust(width) if place == 0 else cell.rjust(width) for place, (cell, width) in enumerate(
            zip(row, widths, strict=True)
        ))  # fmt: skip
        yield "  ".join([first, *others])


def write_own_report(
    out: Path, found: Sequence[LabelAccuracy], rendered: dict[str, list[RenderedPart]], model_sha256: str
) -> None:
    """Write own-accuracy.json, .md and .png into `out`."""
    out.mkdir(parents=True, exist_ok=True)
    write_json(out / "own-accuracy.json", {"model_sha256": model_sha256, "labels": [one.to_json() for one in found]})
    heading, *rows = table_rows(found)
    parts = ["# A model beside recordings that it was not trained on", model_line(model_sha256), table(heading, rows)]
    write_text(out / "own-accuracy.md", "\n\n".join(parts) + "\n")
    _draw(out / "own-accuracy.png", found, rendered, model_sha256)


def _draw(
    path: Path, found: Sequence[LabelAccuracy], rendered: dict[str, list[RenderedPart]], model_sha256: str
) -> None:
    from matplotlib.figure import Figure

    columns = min(4, len(found))
    rows = -(-len(found) // columns)
    figure = Figure(figsize=(3.4 * columns, 2.6 * rows))
    axes = figure.subplots(rows, columns, squeeze=False)
    for axis, one in zip(axes.flat, found, strict=False):
        frequency, recorded, made = spectra_db(rendered[one.label])
        axis.semilogx(frequency[2:], recorded[2:], color="0.35", label="recorded")
        axis.semilogx(frequency[2:], made[2:], color="tab:orange", label="rendered")
        axis.set_title(f"{one.label}: {one.level_error_median_db:+.1f} dB", fontsize=9)
        axis.set_xlabel("Hz", fontsize=8)
        axis.set_ylabel("dB of 1 m/s²", fontsize=8)
        axis.tick_params(labelsize=7)
    for axis in list(axes.flat)[len(found) :]:
        axis.set_axis_off()
    axes.flat[0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=100, metadata=picture_metadata(model_sha256))
