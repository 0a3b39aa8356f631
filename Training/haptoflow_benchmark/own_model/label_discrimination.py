"""Discrimination: strokes outside the training, rendered for every label and classified by a classifier of
recordings."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from itertools import repeat
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.stats import spearmanr

from haptoflow_benchmark.engine.engine_render import EngineRender, render_motion
from haptoflow_benchmark.metrics.label_classifier import LabelClassifier, WindowFeatures, concatenate, window_features
from haptoflow_benchmark.own_model.own_accuracy import HeldOutPart
from haptoflow_training.errors import InputError
from haptoflow_training.markdown import table
from haptoflow_training.model_stamp import model_line, picture_metadata
from haptoflow_training.preprocessing.pipeline import PreparedRecording, preprocess_recording
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.recordings.synthetic import (
    HELD_OUT_SPECIMEN,
    Material,
    hand_conditions,
    record_hand_condition,
)

_SLIDING_MPS = 0.01
# Own recordings are short: windows of a second overlap more, and fewer suffice.
_OWN_STEP_SAMPLES, _MINIMUM_OWN_WINDOWS = 250, 12


@dataclass(frozen=True)
class StrokeOutcome:
    """One stroke on one label: the labels assigned to render and recording, and their RMS while sliding, m/s^2."""

    label: str
    stroke: str
    named_render: str
    named_recording: str
    render_rms_mps2: float
    recording_rms_mps2: float
    seam_jump_ratio: float
    seam_outlier_share: float

    @property
    def level_error_db(self) -> float:
        return 20.0 * float(np.log10((self.render_rms_mps2 + 1e-9) / (self.recording_rms_mps2 + 1e-9)))


@dataclass(frozen=True)
class DiscriminationReport:
    """All outcomes, with the figures of the acceptance criteria."""

    labels: list[str]
    outcomes: list[StrokeOutcome]

    @property
    def render_accuracy(self) -> float:
        return float(np.mean([outcome.named_render == outcome.label for outcome in self.outcomes]))

    @property
    def recording_accuracy(self) -> float:
        return float(np.mean([outcome.named_recording == outcome.label for outcome in self.outcomes]))

    def _levels(self, field: str) -> NDArray[np.float64]:
        """Geometric mean over the strokes of each label."""
        return np.array(
            [
                np.mean([np.log(getattr(entry, field)) for entry in self.outcomes if entry.label == label])
                for label in self.labels
            ]
        )

    @property
    def level_order_spearman(self) -> float:
        return float(spearmanr(self._levels("render_rms_mps2"), self._levels("recording_rms_mps2")).statistic)

    @property
    def level_error_median_db(self) -> float:
        return float(np.median([outcome.level_error_db for outcome in self.outcomes]))

    @property
    def level_error_p90_db(self) -> float:
        return float(np.quantile([abs(outcome.level_error_db) for outcome in self.outcomes], 0.9))

    def confusion(self) -> NDArray[np.int64]:
        """Counts of the renders by [true label, assigned label]."""
        matrix = np.zeros((len(self.labels), len(self.labels)), dtype=np.int64)
        for outcome in self.outcomes:
            if outcome.named_render in self.labels:
                matrix[self.labels.index(outcome.label), self.labels.index(outcome.named_render)] += 1
        return matrix


def _prepared(material: Material, recordings: int, seed: int) -> list[tuple[str, PreparedRecording]]:
    return [
        (
            identity.name,
            preprocess_recording(
                record_hand_condition(
                    material, identity, seed=seed, specimen=HELD_OUT_SPECIMEN, accelerometer_noise=False
                ),
                PreprocessingSettings(),
            ),
        )
        for identity in hand_conditions(material, seed=seed, recordings=recordings)
    ]


def _training_features(material: Material, recordings: int, seed: int) -> WindowFeatures:
    prepared = _prepared(material, recordings, seed)
    return concatenate([window_features(entry.waveform_mps2, entry.motion) for _, entry in prepared])


def train_classifier(
    materials: Sequence[Material],
    recordings_per_label: int,
    seed: int,
    advance: Callable[[int], object],
    workers: int = 1,
) -> LabelClassifier:
    """Train on new hand recordings of every material; `advance` is called with each label's number of recordings."""
    training: dict[str, WindowFeatures] = {}
    with ProcessPoolExecutor(max_workers=workers) as pool:
        made = pool.map(_training_features, materials, repeat(recordings_per_label), repeat(seed))
        for material, features in zip(materials, made, strict=False):
            training[material.label] = features
            advance(recordings_per_label)
    return LabelClassifier(training)


def _sliding_rms(wave: NDArray[np.floating], motion: NDArray[np.floating]) -> float:
    count = min(len(wave), len(motion))
    sliding = np.hypot(motion[:count, 0], motion[:count, 1]) > _SLIDING_MPS
    return float(np.sqrt(np.square(wave[:count][sliding], dtype=np.float64).mean() + 1e-12))


def discriminate(
    classifier: LabelClassifier,
    materials: Sequence[Material],
    *,
    engine: Path,
    model: Path | None,
    strokes_per_label: int,
    seed: int,
    folder: Path,
    advance: Callable[[int], object],
) -> DiscriminationReport:
    """Render every stroke on its label and classify it; the recording of the same stroke is the reference."""
    outcomes: list[StrokeOutcome] = []
    for material in materials:
        for number, (name, truth) in enumerate(_prepared(material, strokes_per_label, seed)):
            features = window_features(truth.waveform_mps2, truth.motion)
            if len(features) == 0:
                continue
            render = render_motion(engine, material.label, truth.motion, folder, model=model, seed=seed + number)
            rendered = window_features(render.waveform_mps2, truth.motion[: len(render.waveform_mps2)])
            part = HeldOutPart(name, material.label, truth.waveform_mps2, truth.motion)
            outcomes.append(_outcome(classifier, part, render, rendered, features))
        advance(strokes_per_label)
    return DiscriminationReport([material.label for material in materials], outcomes)


def _outcome(
    classifier: LabelClassifier,
    part: HeldOutPart,
    render: EngineRender,
    rendered: WindowFeatures,
    recorded: WindowFeatures,
) -> StrokeOutcome:
    return StrokeOutcome(
        label=part.label,
        stroke=part.name,
        named_render=classifier.name(rendered),
        named_recording=classifier.name(recorded),
        render_rms_mps2=_sliding_rms(render.waveform_mps2, part.motion),
        recording_rms_mps2=_sliding_rms(part.recorded, part.motion),
        seam_jump_ratio=render.report["seams"]["jump_ratio"],
        seam_outlier_share=render.report["seams"]["outlier_share"],
    )


def discriminate_parts(
    seen: Sequence[HeldOutPart],
    held_out: Sequence[HeldOutPart],
    *,
    engine: Path,
    model: Path,
    seed: int,
    folder: Path,
    advance: Callable[[int], object],
) -> DiscriminationReport:
    """As `discriminate`, for own recordings: a classifier of the training recordings classifies the held-out ones.
    InputError if a label has too little of either, or if there is only one label."""
    training: dict[str, list[WindowFeatures]] = {}
    for part in seen:
        training.setdefault(part.label, []).append(window_features(part.recorded, part.motion, _OWN_STEP_SAMPLES))
    together = {label: concatenate(found) for label, found in training.items()}
    if len(together) < 2:
        raise InputError(f"only {', '.join(together) or 'nothing'} to tell apart: --recordings needs two labels at least")
    for label, features in together.items():
        if len(features) < _MINIMUM_OWN_WINDOWS:
            raise InputError(
                f"label '{label}' has {len(features)} windows of a second of sliding to learn from, expected "
                f"{_MINIMUM_OWN_WINDOWS}: record 10 s at least, above 10 mm/s and 0.05 N"
            )
    classifier = LabelClassifier(together, _MINIMUM_OWN_WINDOWS)
    outcomes: list[StrokeOutcome] = []
    for number, part in enumerate(held_out):
        features = window_features(part.recorded, part.motion, _OWN_STEP_SAMPLES)
        if len(features) > 0 and part.label in together:
            render = render_motion(engine, part.label, part.motion, folder, model=model, seed=seed + number)
            rendered = window_features(render.waveform_mps2, part.motion[: len(render.waveform_mps2)], _OWN_STEP_SAMPLES)
            if len(rendered) > 0:
                outcomes.append(_outcome(classifier, part, render, rendered, features))
        advance(1)
    if not outcomes:
        raise InputError("no held-out part holds a second of sliding: record 10 s of each label at least")
    return DiscriminationReport([label for label in together if any(o.label == label for o in outcomes)], outcomes)


def write_report(report: DiscriminationReport, out: Path, model_sha256: str) -> None:
    """Write label-discrimination.json, .md and .png into `out`, each with the model's SHA-256."""
    out.mkdir(parents=True, exist_ok=True)
    figures = {
        "model_sha256": model_sha256,
        "render_accuracy": report.render_accuracy,
        "recording_accuracy": report.recording_accuracy,
        "level_order_spearman": report.level_order_spearman,
        "level_error_median_db": report.level_error_median_db,
        "level_error_p90_db": report.level_error_p90_db,
        "outcomes": [asdict(outcome) for outcome in report.outcomes],
    }
    (out / "label-discrimination.json").write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    said = (
        f"Engine renders named right: {report.render_accuracy:.1%}; recordings of the same strokes: "
        f"{report.recording_accuracy:.1%}. Level order of the labels: Spearman {report.level_order_spearman:.3f}. "
        f"Level error of a stroke: median {report.level_error_median_db:+.2f} dB, 90 % within "
        f"{report.level_error_p90_db:.2f} dB."
    )
    headings = ("label", "strokes", "renders right", "recordings right", "taken for", "level error, median dB")
    rows = []
    for label in report.labels:
        own = [outcome for outcome in report.outcomes if outcome.label == label]
        others = sorted({outcome.named_render for outcome in own} - {label})
        right = [str(sum(o.named_render == label for o in own)), str(sum(o.named_recording == label for o in own))]
        error = f"{np.median([o.level_error_db for o in own]):+.2f}"
        rows.append([label, str(len(own)), *right, ", ".join(others), error])
    parts = ["# Which label is it?", model_line(model_sha256), said, table(headings, rows)]
    (out / "label-discrimination.md").write_text("\n\n".join(parts) + "\n", encoding="utf-8")
    _draw_confusion(report, out / "label-discrimination.png", model_sha256)


def _draw_confusion(report: DiscriminationReport, path: Path, model_sha256: str) -> None:
    from matplotlib.figure import Figure

    matrix = report.confusion().astype(float)
    matrix /= np.maximum(matrix.sum(axis=1, keepdims=True), 1.0)
    figure = Figure(figsize=(7.5, 6.5))
    axis = figure.subplots()
    image = axis.imshow(matrix, cmap="viridis", vmin=0.0, vmax=1.0)
    axis.set_xticks(range(len(report.labels)), report.labels, rotation=90)
    axis.set_yticks(range(len(report.labels)), report.labels)
    axis.set_xlabel("named by the classifier")
    axis.set_ylabel("rendered by the engine")
    figure.colorbar(image, label="share of strokes")
    figure.tight_layout()
    figure.savefig(path, dpi=100, metadata=picture_metadata(model_sha256))
