"""The two pictures of the report."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from haptoflow_paper.published.check.points import BUDGET_MS, Measured
from haptoflow_paper.published.check.signals import LabelWaves
from haptoflow_training.model_stamp import picture_metadata
from haptoflow_training.waveform import SAMPLE_RATE_HZ

_COLUMNS = 3


def draw_chart(found: list[Measured], path: Path, model_sha256: str) -> None:
    """Distance from the best tier over milliseconds at the live pace; the best one is at 0 and only marks its time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 4.4))
    best = found[-1]
    panels = (("difference", "RMS of the difference / level"), ("lsd_db", "log-spectral distance, dB"))
    for axis, (key, title) in zip(figure.subplots(1, 2), panels, strict=True):
        for family in dict.fromkeys(each.point.family for each in found):
            rows = sorted((each for each in found if each.point.family == family), key=lambda each: each.point.steps)
            times = [each.paced.p50 for each in rows]
            axis.plot(times, [getattr(each, key) for each in rows], marker="o", label=family)
            for each in rows:
                words = str(each.point.steps) if each.point.steps else each.point.name
                place = (each.paced.p50, getattr(each, key))
                axis.annotate(words, place, xytext=(4, 4), textcoords="offset points", fontsize=8)
        axis.axvline(BUDGET_MS, color="0.6", linestyle=":", label=f"budget of auto, {BUDGET_MS:.2g} ms")
        axis.set_xlim(left=0.0)
        axis.set_xlabel("ms a segment, one core, paced at 72 Hz, median")
        axis.set_title(f"{title}, from {best.point.name}", fontsize=10)
        axis.grid(alpha=0.25)
        axis.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=100, metadata=picture_metadata(model_sha256))


def draw_spectra(found: LabelWaves, path: Path, model_sha256: str) -> None:
    """Every label's mean spectrum at 40 mm/s and .75 N, a panel a category, with their median."""
    from matplotlib.figure import Figure

    categories = list(dict.fromkeys(sorted(found.categories)))
    rows = -(-len(categories) // _COLUMNS)
    figure = Figure(figsize=(4.0 * _COLUMNS, 2.7 * rows))
    axes = figure.subplots(rows, _COLUMNS, squeeze=False, sharex=True, sharey=True)
    frequency = np.fft.rfftfreq(256, 1.0 / SAMPLE_RATE_HZ)
    for axis, category in zip(axes.flat, categories, strict=False):
        places = [place for place, own in enumerate(found.categories) if own == category]
        decibels = 10.0 * np.log10(np.array([found.spectrum(place) for place in places]) + 1e-9)
        axis.semilogx(frequency[2:], decibels[:, 2:].T, color="0.7", linewidth=0.8)
        axis.semilogx(frequency[2:], np.median(decibels, axis=0)[2:], color="#d1495b", linewidth=1.6)
        axis.set_title(f"{category}: {len(places)}", fontsize=10)
        axis.grid(alpha=0.25)
    for axis in list(axes.flat)[len(categories) :]:
        axis.set_axis_off()
    figure.supxlabel("Hz", fontsize=9)
    figure.supylabel("dB", fontsize=9)
    figure.tight_layout()
    figure.savefig(path, dpi=100, metadata=picture_metadata(model_sha256))
