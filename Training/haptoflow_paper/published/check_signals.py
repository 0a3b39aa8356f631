"""Levels and spectra of what a model generates at 40 mm/s and .75 N, label by label, beside what others measured on the
real data set (960 recordings of ten specimens)."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.waveform_metrics import log_spectral_distance_db, power_spectrum
from haptoflow_paper.published.check_lines import Line, inapplicable, judged
from haptoflow_paper.published.level_measurement import band_rms, reference_motions, render_waves
from haptoflow_paper.published.published_file import REFERENCE_LEVEL_MPS2
from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_training.waveform import SAMPLE_RATE_HZ

# Measured on the data set: share of the power from 24 to 1,000 Hz that lies below 500 Hz, and what two recordings of one
# condition differ by.
REFERENCE_SHARE_BELOW_500_HZ = 0.965
REPEAT_DB = 1.7
# Ten specimens of 118, and one speed and force of six.
_LEVEL_TOLERANCE_DB = 6.0
_SHARE_TOLERANCE = 0.03
# Nobody feels less (waveform_metrics.py).
_LEAST_FELT_MPS2 = 0.01
# Labels differ by more than one label from itself.
_LEAST_SPREAD = 1.2
_COMPARED_LABELS = 30
_WINDOW = 256
_PART = "signal"
_DATA_SET = "Cluster Haptic Texture Dataset"


@dataclass(frozen=True)
class LabelWaves:
    """One label for each row of the embedding. waves [L, 2, 800] in m/s^2: both ways along one diagonal. total: how many
    labels there are; fewer are rendered where the time was up."""

    names: tuple[str, ...]
    categories: tuple[str, ...]
    waves: NDArray[np.float32]
    total: int

    @property
    def rms(self) -> NDArray[np.float64]:
        """Above 24 Hz, [L]."""
        each = band_rms(self.waves.reshape(-1, self.waves.shape[2])).reshape(self.waves.shape[:2])
        return np.asarray(np.sqrt(np.square(each).mean(axis=1)))

    def spectrum(self, label: int) -> NDArray[np.float64]:
        """Mean power, [129]."""
        return np.asarray(np.mean([power_spectrum(wave, _WINDOW) for wave in self.waves[label]], axis=0))


def render_labels(
    generator: EngineGenerator, seconds: float, advance: Callable[[int], None] = lambda count: None
) -> LabelWaves:
    """Renders the labels until the time is up, in an order that spreads over the list; advance: told of each label."""
    rows = _labels_of_rows(generator.header["labels"])
    # Steps of the golden ratio, so that any part of the order is spread over the data set's categories.
    order = sorted(range(len(rows)), key=lambda place: (place * 0.6180339887) % 1.0)
    began, rendered = time.monotonic(), {}
    for place in order:
        if rendered and time.monotonic() - began > seconds:
            break
        label = rows[place]
        embedding = generator.embeddings[label : label + 1]
        rendered[place] = render_waves(generator, embedding, reference_motions())[0]
        advance(1)
    kept = sorted(rendered)
    labels = [generator.header["labels"][rows[place]] for place in kept]
    return LabelWaves(
        tuple(str(label["name"]) for label in labels),
        tuple(str(label.get("category") or "other") for label in labels),
        np.stack([rendered[place] for place in kept]),
        len(rows),
    )


def count_of_labels(header: dict[str, object]) -> int:
    labels = header["labels"]
    assert isinstance(labels, list)
    return len(_labels_of_rows(labels))


def _labels_of_rows(labels: list[dict[str, object]]) -> list[int]:
    """The first label of each row: second names sound the same."""
    seen: dict[object, int] = {}
    for place, label in enumerate(labels):
        seen.setdefault(label["embedding_row"], place)
    return list(seen.values())


def signal_lines(found: LabelWaves, header: dict[str, object]) -> list[Line]:
    lines = [_finite(found)]
    if lines[0].verdict != "pass":
        return lines
    lines += [_silence(found), _spread(found)]
    normalisation, provenance = header.get("normalisation"), header.get("provenance")
    assumed = isinstance(normalisation, dict) and bool(normalisation.get("assumed"))
    recordings = str(provenance.get("recordings", "")) if isinstance(provenance, dict) else ""
    if _DATA_SET not in recordings:
        why = f"the file's recordings are not the {_DATA_SET}'s"
        remedy = "nothing to do: the data set's figures say nothing about other recordings"
        return [*lines, *(inapplicable(_PART, name, why, remedy) for name in ("level", "power below 500 Hz"))]
    return [*lines, _level(found, assumed), _low_frequencies(found)]


def _finite(found: LabelWaves) -> Line:
    bad = [name for name, waves in zip(found.names, found.waves, strict=True) if not np.isfinite(waves).all()]
    rendered = f"{len(found.names)} of {found.total} labels rendered"
    return judged(
        _PART, "finite numbers", not bad, f"{rendered}, all finite" if not bad else f"not finite: {', '.join(bad[:5])}",
        "all", "download the weights again: a damaged file", rendered=len(found.names), labels=found.total,
    )  # fmt: skip


def _silence(found: LabelWaves) -> Line:
    rms = found.rms
    silent = [name for name, level in zip(found.names, rms, strict=True) if level < _LEAST_FELT_MPS2]
    named = f"; silent: {', '.join(silent[:5])}" if silent else ""
    return judged(
        _PART, "no label is silent", not silent,
        f"weakest {rms.min():.3g}, strongest {rms.max():.3g} m/s²{named}", f"{_LEAST_FELT_MPS2:g} m/s² and more",
        "state the level with --peak-g or --dataset-info on import, or send this report",
        rms_mps2={name: round(float(level), 4) for name, level in zip(found.names, rms, strict=True)},
    )  # fmt: skip


def _level(found: LabelWaves, assumed: bool) -> Line:
    name, median = "level", float(np.median(found.rms))
    difference = 20.0 * np.log10(median / REFERENCE_LEVEL_MPS2)
    words = f"median of the labels {median:.3g} m/s² ({difference:+.1f} dB)"
    if assumed:
        return inapplicable(
            _PART, name, f"{words}: level assumed, so the figure says nothing",
            "import with --dataset-info dataset_info.json, or --peak-g",
        )  # fmt: skip
    return judged(
        _PART, name, abs(difference) <= _LEVEL_TOLERANCE_DB, words,
        f"{REFERENCE_LEVEL_MPS2:g} m/s² within {_LEVEL_TOLERANCE_DB:g} dB (ten specimens of the data set)",
        "check the peak that the import was told (--peak-g is in g) and send this report", median_mps2=median,
    )  # fmt: skip


def _low_frequencies(found: LabelWaves) -> Line:
    frequency = np.fft.rfftfreq(_WINDOW, 1.0 / SAMPLE_RATE_HZ)
    power = np.median([found.spectrum(label) for label in range(len(found.names))], axis=0)
    heard = frequency >= 24.0
    share = float(power[heard & (frequency < 500.0)].sum() / power[heard].sum())
    low, high = REFERENCE_SHARE_BELOW_500_HZ - _SHARE_TOLERANCE, REFERENCE_SHARE_BELOW_500_HZ + _SHARE_TOLERANCE
    return judged(
        _PART, "power below 500 Hz", low <= share <= high, f"{100 * share:.1f} % of 24-1000 Hz",
        f"{100 * REFERENCE_SHARE_BELOW_500_HZ:.1f} % within {100 * _SHARE_TOLERANCE:g}",
        "see the parity lines first: if they pass, the model itself is duller or brighter; send this report",
        share=share,
    )  # fmt: skip


def _spread(found: LabelWaves) -> Line:
    name = "labels differ"
    if len(found.names) < 2:
        return inapplicable(_PART, name, "one label", "nothing to do")
    waves = found.waves[np.linspace(0, len(found.names) - 1, min(_COMPARED_LABELS, len(found.names))).astype(int)]
    within = float(np.median([log_spectral_distance_db(first, second) for first, second in waves]))
    between = float(np.median([log_spectral_distance_db(one[0], other[0]) for one, other in combinations(waves, 2)]))
    return judged(
        _PART, name, between >= _LEAST_SPREAD * within,
        f"LSD between labels {between:.1f} dB, between two ways over one {within:.1f} dB",
        f"{_LEAST_SPREAD:g} times as much between labels (two real recordings of one condition differ by {REPEAT_DB:g} dB)",
        "see the parity lines: labels that sound alike come from an embedding that was not read", between_db=between,
        within_db=within,
    )  # fmt: skip
