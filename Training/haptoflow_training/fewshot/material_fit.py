"""Fits a material to its recordings: frame, level, embedding, tone, exponents, seeds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from haptoflow_training.errors import InputError
from haptoflow_training.export.material_file import Material, MaterialProvenance, model_space
from haptoflow_training.fewshot.embedding_fit import EmbeddingFit, EmbeddingFitter, FitOptions
from haptoflow_training.fewshot.exponents import frequency_exponent
from haptoflow_training.fewshot.label_prior import LabelPrior
from haptoflow_training.fewshot.level_law import MINIMUM_SPEED_MPS, LevelLaw, fit_level
from haptoflow_training.fewshot.seeds import choose_seeds
from haptoflow_training.fewshot.sound_fit import (
    LEVEL_HOP_SAMPLES,
    LEVEL_WINDOW_SAMPLES,
    Rendered,
    band_distance_db,
    calibrated,
    chunks_of,
    fit_sound,
    render_chunks,
)
from haptoflow_training.fewshot.stroke_recording import Frame, StrokeRecording, windows_of
from haptoflow_training.fewshot.tone_fit import ToneOptions
from haptoflow_training.fewshot.voice import Voice
from haptoflow_training.models.file_model import FileModel, FileTier
from haptoflow_training.preprocessing.wave_vectors import estimate_wave_vectors
from haptoflow_training.recordings.material_recording import MaterialRecording
from haptoflow_training.waveform import SAMPLE_RATE_HZ

# The partials of ribs move with the speed, but a tone does not, so a ruled material's tone may only shape the broad
# spectrum.
RULED_TONE = ToneOptions(size=0.5, step=0.15, bend=0.1, speed_step=0.12)
MINIMUM_SECONDS = 2.0
RECOMMENDED_SECONDS = 10.0
_LONG_ENOUGH_SAMPLES = 1000
_CHUNKS = 24
# A tier whose spectra are further off than the default tier's by this much is reported.
TIER_TOLERANCE_DB = 0.3


@dataclass(frozen=True)
class FittedMaterial:
    """frame: the material's orientation in its recording. plain: the voice without tone. nearest: index of the label
    the fit began from. distances_db: by tier, the distance in narrow bands between the spectra of the recording and
    of closed-loop output."""

    voice: Voice
    plain: Voice
    frame: Frame
    prior: LabelPrior
    recordings: tuple[StrokeRecording, ...]
    rendered: Rendered
    fit: EmbeddingFit
    seconds: float
    distances_db: dict[str, float]

    @property
    def far_tiers(self) -> list[str]:
        """Tiers with a larger distance than the first tier, for which the tone was fitted."""
        first, *others = self.distances_db
        return [name for name in others if self.distances_db[name] > self.distances_db[first] + TIER_TOLERANCE_DB]


def prepared(
    recordings: Sequence[MaterialRecording], wave_vectors_per_mm: Sequence[tuple[float, float]] | None
) -> tuple[Frame, tuple[StrokeRecording, ...]]:
    """The material's frame and its recordings in that frame. wave_vectors_per_mm: None estimates them."""
    vectors = estimate_wave_vectors(recordings) if wave_vectors_per_mm is None else tuple(wave_vectors_per_mm)
    frame = Frame.of(vectors)
    usable = [each for each in recordings if len(each.vibration_mps2) >= _LONG_ENOUGH_SAMPLES]
    seconds = sum(len(each.vibration_mps2) for each in usable) / 2000.0
    if seconds < MINIMUM_SECONDS:
        raise InputError(
            f"{seconds:.1f} s of recording are left in stretches of {_LONG_ENOUGH_SAMPLES / SAMPLE_RATE_HZ:g} s "
            "or more; a "
            f"material needs {MINIMUM_SECONDS:g} s at least, {RECOMMENDED_SECONDS:g} s are recommended"
        )
    turned = tuple(StrokeRecording.of(each, frame) for each in usable)
    return frame, turned


def fit_material(
    model: FileModel,
    recordings: Sequence[MaterialRecording],
    *,
    seed: int = 1,
    wave_vectors_per_mm: Sequence[tuple[float, float]] | None = None,
    options: FitOptions = FitOptions(),
    tier: FileTier | None = None,
    weights_learning_rate: float | None = None,
    compare_tiers: bool = True,
    advance: Callable[[], None] = lambda: None,
) -> FittedMaterial:
    """Fit a material. advance is called `steps_of(model, options)` times. tier: the default one; a trainable tier's
    weights are fitted too, with weights_learning_rate."""
    frame, strokes = prepared(recordings, wave_vectors_per_mm)
    prior = LabelPrior.of(model.file)
    level = fit_level(windows_of(strokes, LEVEL_WINDOW_SAMPLES, LEVEL_HOP_SAMPLES), prior)
    chosen = model.tier() if tier is None else tier
    moving = {} if weights_learning_rate is None else {
        "weights": list(chosen.field.weights.values()),
        "weights_learning_rate": weights_learning_rate,
    }
    fitter = EmbeddingFitter(
        model, [chosen], prior, strokes, level, frame.wave_numbers, seed=seed, options=options, **moving
    )
    fit = fitter.fit(advance)
    seconds = sum(len(each) for each in strokes) / 2000.0
    plain = Voice(fit.embedding, level)
    rendered = render_chunks(chosen, plain, chunks_of(strokes, _CHUNKS, seed), seed)
    advance()
    tone, own_level = fit_sound(
        rendered, strokes, level, prior, seconds, RULED_TONE if frame.is_ruled else ToneOptions()
    )
    voice = Voice(fit.embedding, own_level, tone)
    distances = {chosen.name: band_distance_db(rendered, tone)}
    for entry in model.file.header["tiers"] if compare_tiers else []:
        if entry["name"] != chosen.name and entry["representation"] == "raw":
            other = render_chunks(model.tier(entry["name"]), plain, rendered.chunks, seed)
            distances[entry["name"]] = band_distance_db(other, tone)
        advance()
    unlevelled = Voice(fit.embedding, calibrated(rendered, strokes, level, prior, None))
    return FittedMaterial(
        voice, unlevelled, frame, prior, strokes, rendered, fit, seconds, distances
    )


def as_material(
    model: FileModel,
    fitted: FittedMaterial,
    *,
    name: str,
    category: str,
    description: str,
    provenance: MaterialProvenance,
) -> Material:
    """The fitted material as a file states it. What a recording of slides does not contain (stiffness, friction,
    impact) is taken from the nearest label."""
    nearest = model.labels[fitted.fit.nearest]
    windows = windows_of(fitted.recordings, 400, 200)
    speed, force = windows.speed_mps, windows.force_newtons
    moving = speed > MINIMUM_SPEED_MPS
    if not moving.any():
        moving = np.ones_like(moving)
    ruled = fitted.frame.is_ruled
    law: LevelLaw = fitted.voice.level
    tone = fitted.voice.tone
    wave_number = float(np.hypot(*fitted.frame.wave_numbers[:2]))
    return Material(
        space=model_space(model.file),
        name=name,
        embedding=fitted.voice.embedding,
        speed_range_mps=_range(speed[moving]),
        force_range_newtons=_range(force[moving]),
        category=category or nearest.get("category", ""),
        description=description,
        provenance=provenance,
        speed_exponent=law.speed_exponent,
        force_exponent=law.force_exponent,
        frequency_exponent=1.0 if ruled else round(frequency_exponent(windows), 4),
        wavelength_metres=round(1e-3 / wave_number, 7) if ruled else None,
        stiffness_newtons_per_metre=nearest["stiffness_newtons_per_metre"],
        friction_coefficient=nearest["friction_coefficient"],
        impact=nearest.get("impact"),
        level=law.table,
        tone=tone,
        seeds=choose_seeds(fitted.recordings, tone, fitted.fit.turns, ruled=ruled),
    )


def _range(values: np.ndarray) -> tuple[float, float]:
    low, high = (float(value) for value in np.quantile(values, [0.01, 0.99]))
    return round(max(low, 0.0), 5), round(max(high, low, 0.0) + 0.5 * 10**-5, 5)


def steps_of(model: FileModel, options: FitOptions = FitOptions()) -> int:
    """How often `fit_material` calls `advance`."""
    return options.steps + 1 + len(model.file.header["tiers"])

