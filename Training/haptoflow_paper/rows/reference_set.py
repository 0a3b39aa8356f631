"""The reference recordings of the evaluation: outside all training, each with two further ones of the same motion.

The independent one is of another place on the held-out specimen: a draw of the true process, the best that any
generator can score. The third is of another specimen of the label: what two pieces of one material differ by.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.waveform_metrics import power_spectrum
from haptoflow_paper.rows.reference_conditions import Condition, conditions, is_on_other_label, motion_of
from haptoflow_training import preprocessing
from haptoflow_training.preprocessing.pipeline import PreparedRecording, preprocess_recording
from haptoflow_training.preprocessing.settings import SETTINGS
from haptoflow_training.recordings import synthetic
from haptoflow_training.recordings.synthetic import (
    FURTHER_SPECIMENS, HELD_OUT_SPECIMEN, Material, load_materials, record_condition
)
from haptoflow_training.training.closed_loop import phases_of
from haptoflow_training.waveform import SAMPLE_RATE_HZ

_Floats = NDArray[np.float32]

_INDEPENDENT_SEED = 100_000


@dataclass(frozen=True)
class ReferencePair:
    """recorded, independent and other_specimen [n] in m/s^2; motion [n, 3] of all. start_mm: the place on the surface
    where `recorded` begins. wander_turns [n, 3]: of its waves, as a store has them (preprocessing/store.py)."""

    condition: Condition
    recorded: _Floats
    independent: _Floats
    motion: _Floats
    start_mm: tuple[float, float] = (0.0, 0.0)
    wander_turns: _Floats | None = None
    other_specimen: _Floats | None = None


def _record(material: Material, motion: NDArray[np.float64], seed: int, specimen: int) -> PreparedRecording:
    """One recording of the motion [n, 3] at 2 kHz on a specimen, trimmed like every recording, without the
    accelerometer's noise: nobody should be asked to reproduce it."""
    recording = record_condition(
        material,
        velocity_mps=(motion[:, 0], motion[:, 1]),
        force_newtons=motion[:, 2],
        duration_seconds=len(motion) / SAMPLE_RATE_HZ,
        seed=seed,
        specimen=specimen,
        accelerometer_noise=False,
    )
    return preprocess_recording(recording)


def record_pair(task: tuple[Condition, Material, Material]) -> ReferencePair:
    """The pair of a condition: its material and, for a change, the other one alternately."""
    condition, material, other = task
    trim = SETTINGS.trim_seconds
    motion = motion_of(condition, material, trim)
    further = FURTHER_SPECIMENS[condition.seed % len(FURTHER_SPECIMENS)]
    takes = [
        (condition.seed, HELD_OUT_SPECIMEN),
        (condition.seed + _INDEPENDENT_SEED, HELD_OUT_SPECIMEN),
        (condition.seed + 2 * _INDEPENDENT_SEED, further),
    ]
    prepared = [_record(material, motion, *take) for take in takes]
    waves = [entry.waveform_mps2 for entry in prepared]
    lead = round(trim * SAMPLE_RATE_HZ)
    length = min(len(motion) - 2 * lead, *(len(wave) for wave in waves))
    if condition.kind == "change":
        elsewhere = is_on_other_label(length)
        for number, take in enumerate(takes):
            there = _record(other, motion, *take).waveform_mps2[:length]
            waves[number] = np.where(elsewhere, there, waves[number][:length])
    # The motion is prescribed and known exactly; the sensors' noise on it is not measured.
    known_motion = motion[lead : lead + length].astype(np.float32)
    travelled = _travelled_mm(known_motion)
    # Averaged over the recording, because a single reading is off by up to 0.1 mm.
    start = (prepared[0].position_mm[:length] - travelled).mean(axis=0)
    # Whole turns do not matter; a float keeps the rest.
    wander = np.mod(prepared[0].wander_turns[:length], 1.0).astype(np.float32)
    return ReferencePair(
        condition, waves[0][:length], waves[1][:length], known_motion, (float(start[0]), float(start[1])), wander,
        waves[2][:length],
    )  # fmt: skip


def _travelled_mm(motion: _Floats) -> NDArray[np.float64]:
    """The position of the tip before each sample, relative to the first, [n, 2]."""
    step = motion[:, :2].astype(np.float64) * (1000.0 / SAMPLE_RATE_HZ)
    return np.cumsum(step, axis=0) - step


def known_phases(pair: ReferencePair, embedding: _Floats, samples: NDArray[np.int64]) -> _Floats:
    """The phases [n, 6] (models/label_embedding.py) of the recording at these samples, for an embedding [64]; the rates
    are those over a hop."""
    count, hop = len(pair.motion), SAMPLE_RATE_HZ // 72
    last = np.minimum(samples + hop, count - 1)
    vectors = embedding[-4:].astype(np.float64).reshape(2, 2)
    turns = np.zeros((count, 3))
    turns[:, :2] = (np.asarray(pair.start_mm) + _travelled_mm(pair.motion)) @ vectors.T
    if pair.wander_turns is not None:
        turns += pair.wander_turns
    steps = np.diff(turns, axis=0, append=turns[-1:])
    advanced = np.concatenate([np.zeros((1, 3)), np.cumsum(steps - np.rint(steps), axis=0)])
    rates = (advanced[last] - advanced[samples]) * (SAMPLE_RATE_HZ / np.maximum(last - samples, 1))[:, None]
    return phases_of(turns[samples], rates)


def _recorder_crc32() -> str:
    """CRC-32 of the code that records and prepares; cached recordings are made again if it has changed."""
    folders = [Path(module.__file__ or "").parent for module in (synthetic, preprocessing)]
    sources = b"".join(path.read_bytes() for folder in folders for path in sorted(folder.glob("*.py")))
    return f"{zlib.crc32(sources):08x}"


def reference_set(
    cache: Path, workers: int, advance: Callable[[int], None] = lambda count: None
) -> list[ReferencePair]:
    """Record all pairs, or read them from `cache` if they were made from the same materials, conditions and code."""
    materials = load_materials()
    wanted = conditions(materials)
    made_from = json.dumps([[asdict(entry) for entry in wanted], [asdict(entry) for entry in materials], _recorder_crc32()])
    if cache.exists():
        with np.load(cache) as stored:
            if str(stored["made_from"]) == made_from:
                advance(len(wanted))
                return [
                    ReferencePair(
                        entry, stored[f"recorded{i}"], stored[f"independent{i}"], stored[f"motion{i}"],
                        (float(stored["starts_mm"][i, 0]), float(stored["starts_mm"][i, 1])), stored[f"wander{i}"],
                        stored[f"other{i}"],
                    )
                    for i, entry in enumerate(wanted)
                ]  # fmt: skip
    pairs: list[ReferencePair] = []
    with ProcessPoolExecutor(max_workers=workers) as pool:
        tasks = [(entry, materials[entry.label_index], materials[entry.other_index]) for entry in wanted]
        for pair in pool.map(record_pair, tasks):
            pairs.append(pair)
            advance(1)
    cache.parent.mkdir(parents=True, exist_ok=True)
    arrays: dict[str, Any] = {
        "made_from": np.array(made_from), "starts_mm": np.array([pair.start_mm for pair in pairs]),
    }  # fmt: skip
    for i, pair in enumerate(pairs):
        arrays |= {f"recorded{i}": pair.recorded, f"independent{i}": pair.independent, f"motion{i}": pair.motion}
        arrays |= {f"wander{i}": pair.wander_turns, f"other{i}": pair.other_specimen}
    temporary = cache.with_suffix(".part.npz")
    np.savez(temporary, **arrays)
    temporary.replace(cache)
    return pairs


REFERENCE_ROWS = ("independent-draw", "another-specimen", "mean-spectrum", "white-noise", "silence")
# The recordings encoded and decoded by the small codec: the best that a row in its latents can score.
CODEC_ROW = "small-codec-reconstruction"
_ENVELOPE_SAMPLES = 200
_SPECTRUM_WINDOW = 400


def _true_level(wave: NDArray[np.floating]) -> NDArray[np.float64]:
    """Moving RMS over 100 ms, [n]."""
    kernel = np.ones(_ENVELOPE_SAMPLES) / _ENVELOPE_SAMPLES
    power = np.convolve(np.square(np.asarray(wave, dtype=np.float64)), kernel, mode="same")
    return np.sqrt(power + 1e-12)


def _shaped_noise(spectrum: NDArray[np.float64], samples: int, generator: np.random.Generator) -> NDArray[np.float64]:
    """Gaussian noise of RMS 1 whose power spectrum is proportional to `spectrum` (any number of bins, 0 to 1 kHz)."""
    white = np.fft.rfft(generator.standard_normal(samples))
    places = np.linspace(0.0, 1.0, len(white))
    gain = np.sqrt(np.interp(places, np.linspace(0.0, 1.0, len(spectrum)), spectrum))
    shaped = np.fft.irfft(white * gain, samples)
    return np.asarray(shaped / np.sqrt(np.square(shaped).mean() + 1e-30))


def _of_another_specimen(pair: ReferencePair) -> _Floats:
    if pair.other_specimen is None:
        raise ValueError(f"{pair.condition}: nothing was recorded of another specimen")
    return pair.other_specimen


def reference_waves(name: str, pairs: list[ReferencePair], seed: int) -> list[_Floats]:
    """One waveform for each pair, as long as its recording, m/s^2.

    independent-draw: another recording of the same condition, on the same specimen. another-specimen: on another piece
    of the material. mean-spectrum: noise with the label's mean spectrum over all its conditions, at the recording's own
    level. white-noise: at that level too.
    """
    generator = np.random.default_rng(seed)
    if name == "independent-draw":
        return [pair.independent for pair in pairs]
    if name == "another-specimen":
        return [_of_another_specimen(pair) for pair in pairs]
    if name == "silence":
        return [np.zeros_like(pair.recorded) for pair in pairs]
    if name == "white-noise":
        return [
            (_true_level(pair.recorded) * generator.standard_normal(len(pair.recorded))).astype(np.float32)
            for pair in pairs
        ]
    if name == "mean-spectrum":
        shapes: dict[str, list[NDArray[np.float64]]] = {}
        for pair in pairs:
            spectrum = power_spectrum(pair.independent, _SPECTRUM_WINDOW)
            shapes.setdefault(pair.condition.label, []).append(spectrum / spectrum.sum())
        means = {label: np.mean(spectra, axis=0) for label, spectra in shapes.items()}
        return [
            (
                _true_level(pair.recorded)
                * _shaped_noise(means[pair.condition.label], len(pair.recorded), generator)
            ).astype(np.float32)
            for pair in pairs
        ]
    raise ValueError(f"unknown reference row '{name}', expected one of {', '.join(REFERENCE_ROWS)}")
