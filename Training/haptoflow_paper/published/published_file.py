"""A published checkpoint as a `.haptoflow` file: tiers, labels, range, level, seeds, provenance."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.engine_library import EngineLibrary
from haptoflow_paper.published.checkpoint import Checkpoint
from haptoflow_paper.published.labels import EmbeddingRows, PublishedLabel, published_labels
from haptoflow_paper.published.published_model import decoder_graph, encoder_graph, field_graph, level_graph
from haptoflow_paper.published.level_measurement import RenderedLevels, render_levels
from haptoflow_paper.published.meta_file import PublishedMeta
from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_training.errors import InputError
from haptoflow_training.export.exponents import LabelExponents
from haptoflow_training.export.model_file import ModelFile, write_model_file
from haptoflow_paper.runs.tier import SEED_SAMPLES
from haptoflow_training.model_stamp import sha256_of
from haptoflow_training.models.conditioning import EMBEDDING_SIZE
from haptoflow_training.models.haptoflow_model import parameter_count
from haptoflow_training.waveform import SAMPLE_RATE_HZ, SEGMENT_SAMPLES

STANDARD_GRAVITY_MPS2 = 9.80665
# Median of the data set at 40 mm/s and .75 N, RMS from 24 to 1,000 Hz over three axes (measured by others on ten of its
# specimens).
REFERENCE_LEVEL_MPS2 = 0.57
BEST_TIER = "published"
_MAXIMUM_STEPS = 16
_MAXIMUM_SEED_GAIN = 16.0
_MEASURING_BATCH = 16
# Equally many strokes of 20, 40 and 60 mm/s have this RMS.
_SPEEDS_MMPS = (20.0, 40.0, 60.0)
LICENCES = (
    ("weights", "github.com/tamago117/HaptoFlow, Apache-2.0 (arXiv 2608.01974, ISMAR 2026)"),
    ("recordings", "Cluster Haptic Texture Dataset, CC BY 4.0"),
    ("codec", "EnCodec 24 kHz (Defossez et al. 2022), whose repository is under MIT and says nothing of the weights"),
)

Progress = Callable[[int], None]


@dataclass(frozen=True)
class TrainedRange:
    """speed_mps, force_newtons: least and greatest of the recordings."""

    speed_mps: tuple[float, float]
    force_newtons: tuple[float, float]

    @classmethod
    def of(cls, meta: PublishedMeta) -> TrainedRange:
        """From means and deviations, because a few samples of overshoot and silence make the extremes: strokes in
        all directions at 20, 40 and 60 mm/s have a known ratio of the speeds to their RMS, and two forces as often lie
        one deviation from their mean."""
        force = meta.controls["force"]
        velocity = [meta.controls[name] for name in ("velocity_x", "velocity_y")]
        rms = math.sqrt(sum(each.mean**2 + each.deviation**2 for each in velocity))
        nominal = math.sqrt(sum(speed**2 for speed in _SPEEDS_MMPS) / len(_SPEEDS_MMPS))
        speeds = (rms * _SPEEDS_MMPS[0] / nominal, rms * _SPEEDS_MMPS[-1] / nominal)
        forces = max(force.mean - force.deviation, force.least, 0.0), min(force.mean + force.deviation, force.greatest)
        if not forces[0] < forces[1]:
            raise InputError(f"control_stats.force: from {forces[0]:g} to {forces[1]:g} N; expected a range above 0 N")
        return cls((round(speeds[0], 4), round(speeds[1], 4)), (round(forces[0], 4), round(forces[1], 4)))


@dataclass(frozen=True)
class Tier:
    name: str
    field: str
    guidance: float
    steps: int


def tiers_of(meta: PublishedMeta) -> list[Tier]:
    """The checkpoint's own tier last; before it fewer steps, and first the fewest without guidance."""
    best = min(meta.steps, _MAXIMUM_STEPS)
    fewer = sorted({max(1, best // 4), max(1, best // 2)} - {best})
    guided = [Tier(f"{BEST_TIER}-{steps}", f"{BEST_TIER}.field", meta.guidance, steps) for steps in fewer]
    tiers = [*guided, Tier(BEST_TIER, f"{BEST_TIER}.field", meta.guidance, best)]
    if not meta.is_guided:
        return tiers
    steps = tiers[0].steps
    return [Tier(f"{BEST_TIER}-{steps}-unguided", f"{BEST_TIER}.unguided", 1.0, steps), *tiers]


@dataclass(frozen=True)
class Level:
    """The acceleration that the network's unit stands for; origin: where it is from, for people."""

    unit_mps2: float
    origin: str
    is_assumed: bool


class PublishedFile:
    """Builds the file of a checkpoint. Graphs are exported once; the engine measures a draft of the file."""

    def __init__(self, checkpoint: Checkpoint) -> None:
        self.checkpoint = checkpoint
        self.meta = checkpoint.model.meta
        self.range = TrainedRange.of(self.meta)
        self.labels = published_labels(self.meta.classes)
        self.tiers = tiers_of(self.meta)
        rows = EmbeddingRows(checkpoint.model.network.label_embed.emb.weight)
        self.embeddings: NDArray[np.float32] = rows.embeddings
        model = checkpoint.model
        self._graphs = {"encoder": encoder_graph(model), "decoder": decoder_graph(model)}
        for tier in self.tiers:
            if tier.field not in self._graphs:
                self._graphs[tier.field] = field_graph(model, rows, tier.guidance)

    def measure(self, engine: EngineLibrary, advance: Progress) -> RenderedLevels:
        """Renders every class with the best tier."""
        with tempfile.TemporaryDirectory() as folder:
            draft = Path(folder) / "draft.haptoflow"
            self.write_draft(draft)
            with EngineGenerator(engine, draft, BEST_TIER, maximum_batch=_MEASURING_BATCH) as generator:
                return render_levels(
                    generator, self.embeddings, self.range.speed_mps, self.range.force_newtons, 1.0, advance
                )

    def write_draft(self, out: Path) -> None:
        """The file in the network's own unit, without seeds and exponents, as the engine measures it."""
        self._write(out, Level(1.0, "a draft", True), None)

    def level(self, measured: RenderedLevels, peak_g: float | None) -> Level:
        """Of a stated peak in g; without one of the data set's measured level. InputError if the model is silent."""
        if not measured.reference > 0.0:
            raise InputError(f"{self.checkpoint.weights}: renders silence at 40 mm/s and .75 N; expected a trained model")
        if peak_g is not None:
            return Level(peak_g * STANDARD_GRAVITY_MPS2, f"level stated: a peak of {peak_g:g} g", False)
        origin = (
            f"level assumed: the median of the labels at 40 mm/s and .75 N is set to {REFERENCE_LEVEL_MPS2:g} m/s^2, "
            "because the checkpoint does not state its peak"
        )
        return Level(REFERENCE_LEVEL_MPS2 / measured.reference, origin, True)

    def write(self, out: Path, level: Level, measured: RenderedLevels) -> int:
        """Write the file; returns its CRC-32."""
        return self._write(out, level, measured)

    def _write(self, out: Path, level: Level, measured: RenderedLevels | None) -> int:
        waves, entries = _seeds(self.labels, measured)
        tensors = {"embedding": self.embeddings, "seeds": waves}
        graphs = {**self._graphs, "level": level_graph(math.log(level.unit_mps2))}
        return write_model_file(out, ModelFile(self._header(level, measured, entries), tensors, graphs))

    def _header(self, level: Level, measured: RenderedLevels | None, seeds: list[dict[str, Any]]) -> dict[str, Any]:
        meta = self.meta
        weights, recordings, codec = (text for _, text in LICENCES)
        source = self.checkpoint.origin or self.checkpoint.weights.name
        return {
            "format": "haptoflow",
            "name": "Published HaptoFlow",
            "description": f"The authors' published weights, {len(meta.classes)} materials. {level.origin}.",
            "provenance": {
                "statement": f"imported from the published weights {source}; {level.origin}",
                "recordings": recordings,
                "licence": f"weights: {weights}; recordings: {recordings}; codec: {codec}",
                "seed": 0,
                "commit": "",
                "configuration": {
                    "sampling": {"solver": meta.solver, "steps": meta.steps, "guidance_scale": meta.guidance},
                    "bandwidth_kbps": meta.bandwidth_kbps,
                    "sha256": {path.name: sha256_of(path) for path in (self.checkpoint.weights, self.checkpoint.codec)},
                },
                "created": "",
            },
            "sample_rate_hz": SAMPLE_RATE_HZ,
            "segment_samples": SEGMENT_SAMPLES,
            "normalisation": {"unit": "m/s^2", "peak_mps2": level.unit_mps2, "assumed": level.is_assumed},
            "range": _range_entry(self.range),
            "embedding_size": EMBEDDING_SIZE,
            "labels": [_label_entry(label, measured) for label in self.labels],
            "tiers": [self._tier_entry(tier) for tier in self.tiers],
            "default_tier": BEST_TIER,
            "seed_bank": {"samples": SEED_SAMPLES, "tensor": "seeds", "entries": seeds},
        }

    def _tier_entry(self, tier: Tier) -> dict[str, Any]:
        is_heun = self.meta.solver == "heun"
        model = self.checkpoint.model
        return {
            "name": tier.name,
            "kind": "flow" if is_heun else "average-velocity",
            "field": tier.field,
            "level": "level",
            "solver": self.meta.solver,
            "steps": tier.steps,
            "parameters": parameter_count(model.network) - parameter_count(model.network.label_embed),
            "representation": "latent",
            "latent_shape": list(model.latent_shape),
            "encoder": "encoder",
            "decoder": "decoder",
            "accuracy": {},
            "cost": {},
        }


def _range_entry(trained: TrainedRange) -> dict[str, Any]:
    def spread(edges: tuple[float, float]) -> list[float]:
        # Of a few nominal values; nothing is known between them.
        return [round(float(value), 5) for value in np.linspace(*edges, 5)]

    return {
        "speed_mps": list(trained.speed_mps),
        "force_newtons": list(trained.force_newtons),
        "speed_percentiles_mps": spread(trained.speed_mps),
        "force_percentiles_newtons": spread(trained.force_newtons),
    }


def _label_entry(label: PublishedLabel, measured: RenderedLevels | None) -> dict[str, Any]:
    exponents = LabelExponents(0.0, 0.0, 0.0) if measured is None else measured.exponents(label.row)
    return {
        "name": label.name,
        "embedding_row": label.row,
        "category": label.category,
        "level_exponents": {"speed": round(exponents.level_speed, 4), "force": round(exponents.level_force, 4)},
        "frequency_exponent": round(exponents.frequency, 4),
        "periodic": False,
        "wavelength_metres": None,
        "stiffness_newtons_per_metre": label.stiffness_newtons_per_metre,
        "friction_coefficient": label.friction_coefficient,
    }


def _seeds(
    labels: list[PublishedLabel], measured: RenderedLevels | None
) -> tuple[NDArray[np.float32], list[dict[str, Any]]]:
    """The ends of the model's own renders, of RMS 1, with their gains in the model's unit. A silent render is no seed;
    a draft has one seed that nobody plays."""
    waves: list[NDArray[np.float32]] = []
    entries: list[dict[str, Any]] = []
    for label in labels if measured is not None else []:
        assert measured is not None
        for motion, end in zip(measured.motions, measured.ends[label.row], strict=True):
            rms = float(np.sqrt(np.square(end, dtype=np.float64).mean()))
            if 1e-6 < rms <= _MAXIMUM_SEED_GAIN:
                waves.append((end / rms).astype(np.float32))
                vx, vy, force = (round(float(value), 5) for value in motion)
                entries.append(
                    {"label": label.name, "velocity_mps": [vx, vy], "force_newtons": force, "gain": round(rms, 6)}
                )
    if not waves:
        waves = [np.ones(SEED_SAMPLES, dtype=np.float32)]
        entries = [{"label": labels[0].name, "velocity_mps": [0.0, 0.0], "force_newtons": 0.0, "gain": 0.0}]
    return np.stack(waves), entries
