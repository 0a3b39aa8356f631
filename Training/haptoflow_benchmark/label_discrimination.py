"""A simple classifier of materials: averaged spectrum and level, given the speed and force of the stroke."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from itertools import repeat
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.signal import welch
from scipy.stats import spearmanr

from haptoflow_benchmark.engine_render import EngineRender, render_motion
from haptoflow_benchmark.own_accuracy import HeldOutPart
from haptoflow_training.errors import InputError
from haptoflow_training.model_stamp import model_line, picture_metadata, table
from haptoflow_training.preprocessing.pipeline import PreparedRecording, preprocess_recording
from haptoflow_training.recordings.synthetic import HELD_OUT_SPECIMEN, Material, hand_conditions, record_condition_of
from haptoflow_training.waveform import SAMPLE_RATE_HZ

WINDOW_SECONDS = 1.0
_WINDOW = int(SAMPLE_RATE_HZ * WINDOW_SECONDS)
_BAND_EDGES_HZ = 22.4 * 2.0 ** (np.arange(17) / 3.0)
_MINIMUM_SPEED_MPS = 0.01


@dataclass(frozen=True)
class WindowFeatures:
    """spectra [n, 17]: band levels in dB (m/s^2), third octaves from 22 Hz to 900 Hz, which include the level.
    conditions [n, 6]: 1, log speed, its square, log force, and cosine and sine of twice the direction."""

    spectra: NDArray[np.float64]
    conditions: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.spectra)


def window_features(
    waveform_mps2: NDArray[np.floating], motion: NDArray[np.floating], step_samples: int = _WINDOW // 2
) -> WindowFeatures:
    """Features of every whole second of sliding (mean speed above 10 mm/s, force above 0.05 N), a window every
    `step_samples`.

    waveform_mps2: [n] at 2 kHz. motion: [n, 3] vx, vy (m/s), force (N).
    """
    spectra, conditions = [], []
    for start in range(0, len(waveform_mps2) - _WINDOW + 1, step_samples):
        part = motion[start : start + _WINDOW]
        velocity, force = part[:, :2], part[:, 2].mean()
        speed = np.hypot(velocity[:, 0], velocity[:, 1])
        if np.quantile(speed, 0.2) < _MINIMUM_SPEED_MPS or force < 0.05:
            continue
        frequency, power = welch(waveform_mps2[start : start + _WINDOW], SAMPLE_RATE_HZ, nperseg=400)
        bands = np.digitize(frequency, _BAND_EDGES_HZ)
        energy = np.array([power[bands == band].sum() for band in range(1, len(_BAND_EDGES_HZ))])
        spectra.append(10.0 * np.log10(energy * (frequency[1] - frequency[0]) + 1e-8))
        axial = (velocity[:, 0] + 1j * velocity[:, 1]) ** 2 / np.square(speed + 1e-6)
        mean_log_speed = np.log(speed + 0.002).mean()
        conditions.append([1.0, mean_log_speed, mean_log_speed**2, np.log(force), axial.real.mean(), axial.imag.mean()])
    count = len(_BAND_EDGES_HZ) - 1
    return WindowFeatures(np.array(spectra).reshape(-1, count), np.array(conditions).reshape(-1, 6))


def concatenate(parts: list[WindowFeatures]) -> WindowFeatures:
    """The windows of several recordings as one set."""
    return WindowFeatures(
        np.concatenate([part.spectra for part in parts]), np.concatenate([part.conditions for part in parts])
    )


class LabelClassifier:
    """A linear prediction of the spectrum from the condition and a covariance for each label; the most likely label
    wins.

    Gaussian discriminant analysis with the condition as covariate; covariances are drawn a fifth towards their mean.
    (scikit-learn is no dependency of this project.)
    """

    def __init__(self, training: dict[str, WindowFeatures], fewest_windows: int = 30) -> None:
        self.labels = list(training)
        self._coefficients, covariances = [], []
        for label, features in training.items():
            if len(features) < fewest_windows:
                raise ValueError(
                    f"label '{label}' has {len(features)} windows of sliding, expected {fewest_windows} or more"
                )
            coefficients, *_ = np.linalg.lstsq(features.conditions, features.spectra, rcond=None)
            self._coefficients.append(coefficients)
            covariances.append(np.cov((features.spectra - features.conditions @ coefficients).T))
        mean = np.mean(covariances, axis=0)
        shrunk = [0.8 * covariance + 0.2 * mean + 0.1 * np.eye(len(mean)) for covariance in covariances]
        self._precisions = [np.linalg.inv(covariance) for covariance in shrunk]
        self._log_determinants = [np.linalg.slogdet(covariance)[1] for covariance in shrunk]

    def log_likelihood(self, features: WindowFeatures) -> NDArray[np.float64]:
        """[windows, labels], up to a constant."""
        columns = []
        for coefficients, precision, determinant in zip(
            self._coefficients, self._precisions, self._log_determinants, strict=True
        ):
            residual = features.spectra - features.conditions @ coefficients
            columns.append(-0.5 * (np.einsum("ij,jk,ik->i", residual, precision, residual) + determinant))
        return np.stack(columns, axis=1)

    def name(self, features: WindowFeatures) -> str:
        """The label of one stroke: the likelihoods of its windows are averaged, because neighbouring windows
        overlap."""
        return self.labels[int(self.log_likelihood(features).mean(axis=0).argmax())]


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
                record_condition_of(
                    material, identity, seed=seed, specimen=HELD_OUT_SPECIMEN, accelerometer_noise=False
                ),
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
        prepared = _prepared(material, strokes_per_label, seed)
        parts = [HeldOutPart(name, material.label, truth.waveform_mps2, truth.motion) for name, truth in prepared]
        outcomes += _outcomes(classifier, parts, _WINDOW // 2, engine, model, seed, folder, advance)
    return DiscriminationReport([material.label for material in materials], outcomes)


def _outcomes(
    classifier: LabelClassifier,
    parts: Sequence[HeldOutPart],
    step_samples: int,
    engine: Path,
    model: Path | None,
    seed: int,
    folder: Path,
    advance: Callable[[int], object],
) -> list[StrokeOutcome]:
    """Of the parts whose label is known and that slide for a second."""
    outcomes: list[StrokeOutcome] = []
    for number, part in enumerate(parts):
        recorded = window_features(part.recorded, part.motion, step_samples)
        if len(recorded) > 0 and part.label in classifier.labels:
            render = render_motion(engine, part.label, part.motion, folder, model=model, seed=seed + number)
            rendered = window_features(render.waveform_mps2, part.motion[: len(render.waveform_mps2)], step_samples)
            if len(rendered) > 0:
                outcomes.append(_outcome(classifier, part, render, rendered, recorded))
        advance(1)
    return outcomes


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
    outcomes = _outcomes(classifier, held_out, _OWN_STEP_SAMPLES, engine, model, seed, folder, advance)
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
