"""Compares a model with own recordings: held-out parts, rendered by the engine with their own motion.

Makes no assumption about labels, speeds or protocols. Figures are computed over windows in which the tip moves: their
level, and the spectra of all windows of one range of speed together, so that a few loud windows do not dominate.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.engine_render import render_motion
from haptoflow_benchmark.waveform_metrics import gfc_recording, level_error_db, log_spectral_distance_db, power_spectrum
from haptoflow_training.export.learning import joined, learn_material
from haptoflow_training.model_stamp import model_line, picture_metadata, table
from haptoflow_training.recordings.native_recording import MaterialRecording
from haptoflow_training.training.found_wave_vectors import turned_vectors
from haptoflow_training.waveform import SAMPLE_RATE_HZ
from haptoflow_training.whole_file import write_json, write_text, write_whole

_Floats = NDArray[np.floating]

_WINDOW_SAMPLES = 400
# The engine's start from a seed, and the end of its resampler.
_SETTLING_SAMPLES = 200
_MINIMUM_SPEED_MPS = 0.005
# Spectra of fewer samples are mostly chance.
_MINIMUM_SAMPLES_OF_A_SPECTRUM = 1024
_SPEED_BORDERS_MPS = (0.02, 0.04, 0.08, 0.16, 0.32, 0.64)
_LSD_WINDOW = 256


@dataclass(frozen=True)
class HeldOutPart:
    """recorded [n] in m/s^2 at 2 kHz; motion [n, 3]: vx, vy in m/s, force in N."""

    name: str
    label: str
    recorded: _Floats
    motion: _Floats


@dataclass(frozen=True)
class RenderedPart:
    """The same motion rendered by the engine, as long as its recording."""

    part: HeldOutPart
    rendered: _Floats


@dataclass(frozen=True)
class LabelAccuracy:
    """seconds: compared. level_errors_db: of each window, positive is too strong. gfc, lsd_db: means over ranges of
    speed; None if no range has enough samples. by_speed: (lowest m/s, level error in dB) of each range."""

    label: str
    parts: int
    seconds: float
    level_errors_db: tuple[float, ...]
    gfc: float | None
    lsd_db: float | None
    by_speed: tuple[tuple[float, float], ...]

    @property
    def level_error_median_db(self) -> float:
        return float(np.median(self.level_errors_db))

    @property
    def level_error_p90_db(self) -> float:
        """The 90th percentile of the level error's magnitude."""
        return float(np.quantile(np.abs(self.level_errors_db), 0.9))

    def to_json(self) -> dict[str, Any]:
        return {
            "label": self.label,
            "parts": self.parts,
            "seconds": round(self.seconds, 2),
            "level_error_median_db": round(self.level_error_median_db, 3),
            "level_error_p90_db": round(self.level_error_p90_db, 3),
            "gfc": None if self.gfc is None else round(self.gfc, 4),
            "lsd_db": None if self.lsd_db is None else round(self.lsd_db, 3),
            "level_error_db_by_speed_mps": [[low, round(error, 2)] for low, error in self.by_speed],
        }


def render_parts(
    parts: Sequence[HeldOutPart], *, engine: Path, model: Path, folder: Path, advance: Callable[[int], object]
) -> list[RenderedPart]:
    """InputError carries the command line's own message if it fails."""
    rendered = []
    for number, part in enumerate(parts):
        made = render_motion(engine, part.label, part.motion, folder, model=model, seed=1 + number)
        rendered.append(RenderedPart(part, made.waveform_mps2))
        advance(1)
    return rendered


def label_accuracy(label: str, rendered: Sequence[RenderedPart]) -> LabelAccuracy | None:
    """None if the label's parts hold no window in which the tip moves."""
    windows: list[tuple[_Floats, _Floats, float]] = []
    for entry in rendered:
        count = min(len(entry.rendered), len(entry.part.recorded))
        speed = np.hypot(entry.part.motion[:count, 0], entry.part.motion[:count, 1])
        for start in range(_SETTLING_SAMPLES, count - _WINDOW_SAMPLES + 1, _WINDOW_SAMPLES):
            window = slice(start, start + _WINDOW_SAMPLES)
            if speed[window].mean() > _MINIMUM_SPEED_MPS:
                windows.append((entry.rendered[window], entry.part.recorded[window], float(speed[window].mean())))
    if not windows:
        return None
    classes = np.digitize([speed for _, _, speed in windows], _SPEED_BORDERS_MPS)
    gfc, lsd, by_speed = [], [], []
    for speed_class in np.unique(classes):
        own = [window for window, found in zip(windows, classes, strict=True) if found == speed_class]
        made, reference = (np.concatenate([window[side] for window in own]) for side in (0, 1))
        by_speed.append(((0.0, *_SPEED_BORDERS_MPS)[speed_class], level_error_db(made, reference)))
        if len(made) >= _MINIMUM_SAMPLES_OF_A_SPECTRUM:
            gfc.append(gfc_recording(made, reference))
            lsd.append(log_spectral_distance_db(made, reference))
    return LabelAccuracy(
        label,
        len(rendered),
        len(windows) * _WINDOW_SAMPLES / SAMPLE_RATE_HZ,
        tuple(level_error_db(made, reference) for made, reference, _ in windows),
        float(np.mean(gfc)) if gfc else None,
        float(np.mean(lsd)) if lsd else None,
        tuple(by_speed),
    )


def spectra_db(rendered: Sequence[RenderedPart]) -> tuple[_Floats, _Floats, _Floats]:
    """(Hz, recorded, rendered): mean power of a label's parts, dB over 1 (m/s^2)^2 per bin of 7.8 Hz."""
    frequency = np.fft.rfftfreq(_LSD_WINDOW, 1.0 / SAMPLE_RATE_HZ)
    waves = [(one.part.recorded, one.rendered) for one in rendered]
    sums = []
    for side in (0, 1):
        spectra = [power_spectrum(pair[side], _LSD_WINDOW) for pair in waves if len(pair[side]) >= 2 * _LSD_WINDOW]
        scale = 2.0 / (_LSD_WINDOW * np.square(np.hanning(_LSD_WINDOW + 1)[:-1]).sum())
        sums.append(10.0 * np.log10(scale * np.mean(spectra, axis=0) + 1e-9) if spectra else np.zeros(len(frequency)))
    return frequency, sums[0], sums[1]


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


def render_learnt(
    seen: Sequence[HeldOutPart], held_out: Sequence[HeldOutPart], turned_degrees: Mapping[str, float], *,
    base: Path, engine: Path, folder: Path, advance: Callable[[int], object],
) -> list[RenderedPart]:  # fmt: skip
    """Learns each label of the held-out parts from its seen ones, as materials of the model file `base`, and renders the
    held-out parts with them. turned_degrees: of the parts, by label; learning turns the recordings' own frame itself."""
    rendered = []
    for label in dict.fromkeys(part.label for part in held_out):
        back = -turned_degrees.get(label, 0.0)
        recordings = [_recording(_turned(part, back)) for part in seen if part.label == label]
        text, report = learn_material(base, joined(recordings), label)
        material = folder / "learnt.haptomaterial"
        write_whole(material, text.encode())
        for number, part in enumerate(each for each in held_out if each.label == label):
            moved = _turned(part, back + report["turn_degrees"])
            made = render_motion(
                engine, label, moved.motion, folder, model=base, seed=1 + number, options=("--material", str(material))
            )
            rendered.append(RenderedPart(part, made.waveform_mps2))
        advance(1)
    return rendered


def verdict(model: Sequence[LabelAccuracy], learnt: Sequence[LabelAccuracy]) -> tuple[str, bool]:
    """One line for a terminal, and whether the model is behind learning in at least two of level, GFC and LSD. model,
    learnt: the same labels."""
    ours, theirs = _figures(model), _figures(learnt)
    behind = sum(own > other for own, other in zip(ours, theirs, strict=True))
    words = "not worth using" if behind >= 2 else "worth using"
    shown = [f"level {level:.2f} dB, GFC {1.0 - gfc:.3f}, LSD {lsd:.2f} dB" for level, gfc, lsd in (ours, theirs)]
    return f"{words}: {shown[0]}; `haptoflow learn` on the same recordings: {shown[1]}", behind >= 2


def _figures(found: Sequence[LabelAccuracy]) -> tuple[float, float, float]:
    """Median over labels of the size of the level error, of what GFC lacks to 1, and of LSD: smaller is better."""
    return (
        float(np.median([np.median(np.abs(one.level_errors_db)) for one in found])),
        float(np.median([1.0 - one.gfc for one in found if one.gfc is not None] or [1.0])),
        float(np.median([one.lsd_db for one in found if one.lsd_db is not None] or [np.inf])),
    )


def _turned(part: HeldOutPart, degrees: float) -> HeldOutPart:
    return replace(part, motion=np.column_stack([turned_vectors(part.motion[:, :2], degrees), part.motion[:, 2]]))


def _recording(part: HeldOutPart) -> MaterialRecording:
    return MaterialRecording(np.asarray(part.recorded, np.float32), np.asarray(part.motion, np.float32))
