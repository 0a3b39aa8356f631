"""Training of the small codec: segments drawn at random, exact resumption, a CSV log.

Every step draws from a generator seeded with (seed, step): a resumed run repeats the uninterrupted one.
"""

from __future__ import annotations

import json
import math
import os
import time
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor
from tqdm import tqdm

from haptoflow_paper.codec.checkpoint_file import load_state, read_tensors
from haptoflow_paper.codec.small_codec import SmallCodec, SmallCodecConfig
from haptoflow_training.errors import InputError
from haptoflow_training.training.batches import HeldOut, clear_spans
from haptoflow_training.training.config import load_config
from haptoflow_training.training.run_log import MetricsLog
from haptoflow_training.waveform import SEGMENT_SAMPLES

_WINDOWS = (16, 32, 64, 128, 200)
_POWER_FLOOR = 1e-4


def _magnitudes(waveform: Tensor, window: int) -> Tensor:
    spectrum = torch.stft(
        waveform.squeeze(1),
        n_fft=window,
        hop_length=max(4, window // 4),
        window=torch.hann_window(window, device=waveform.device),
        center=False,
        return_complex=True,
    )
    # Scaled so that white noise of unit variance has unit power at every resolution.
    return torch.sqrt(spectrum.abs().square() / (0.375 * window) + _POWER_FLOOR)


def time_loss(decoded: Tensor, original: Tensor) -> Tensor:
    """Batch mean of the RMS of the difference, both [B, 1, N]. Not squared, so that good segments still count."""
    return (decoded - original).square().mean(dim=(1, 2)).add(1e-8).sqrt().mean()


def spectral_loss(decoded: Tensor, original: Tensor) -> Tensor:
    """Mean |log magnitude ratio| over Hann windows of 16 to 200 samples, power floor 1e-4; N >= 200."""
    distances = []
    for window in _WINDOWS:
        ratio = _magnitudes(decoded, window) / _magnitudes(original, window)
        distances.append(ratio.log().abs().mean())
    return torch.stack(distances).mean()


@torch.no_grad()
def signal_to_noise_ratio_db(decoded: Tensor, original: Tensor) -> float:
    """10 log10 of the original's power over the error's, over all of [B, 1, N]; infinite without error."""
    signal = original.double().square().sum()
    noise = (decoded.double() - original.double()).square().sum()
    return float(10.0 * torch.log10(signal / noise))


CHECKPOINT_NAME = "checkpoint.pt"
LOG_NAME = "log.csv"
RESULT_NAME = "small-codec.pt"

_LOG_COLUMNS = ("step", "time_loss", "spectral_loss", "validation_snr_db", "learning_rate", "elapsed_seconds")
# The level model that defines unit scale is off by a few dB, so the codec is trained on random gains.
_GAIN_SPREAD_DB = 9.0
# Segments quieter than this share of the store's RMS are not amplified: they contain sensor noise.
_QUIET_RELATIVE_RMS = 0.01
_GRADIENT_LIMIT = 2.0
_WEIGHT_DECAY = 1e-4
_NOT_COMPARED_ON_RESUME = ("output_folder", "threads", "held_out_as")


class RecordingSpan(Protocol):
    """The place of one recording in the store's waveform, in samples; `split` is train, validation or test."""

    @property
    def start(self) -> int: ...
    @property
    def length(self) -> int: ...
    @property
    def split(self) -> str: ...


class WaveformStore(Protocol):
    """Prepared recordings at 2 kHz, one after the other in one array of any scale, and the motion [n, 3] of each sample."""

    @property
    def waveform(self) -> NDArray[np.float32]: ...
    @property
    def motion(self) -> NDArray[np.float32]: ...
    @property
    def recordings(self) -> Sequence[RecordingSpan]: ...


class SegmentSampler:
    """Random segments of one split in unit scale, with uniformly distributed starts outside the held-out bands."""

    def __init__(self, store: WaveformStore, split: str, held_out: HeldOut) -> None:
        spans = [span for span in store.recordings if span.split == split]
        starts = np.array([span.start for span in spans], dtype=np.int64)
        lengths = np.array([span.length for span in spans], dtype=np.int64)
        clear = clear_spans(store.motion, starts, lengths, held_out)
        long_enough = clear.lengths >= SEGMENT_SAMPLES
        if not long_enough.any():
            raise InputError(
                f"the prepared recordings have no segment of split '{split}', expected one; prepare more"
            )
        self._store = store
        self._starts = clear.starts[long_enough]
        self._ends = np.cumsum(clear.lengths[long_enough] - SEGMENT_SAMPLES + 1)
        self._offsets = np.arange(SEGMENT_SAMPLES, dtype=np.int64)
        probe = self._cut(np.random.default_rng(0), 1024)
        self._quiet_rms = _QUIET_RELATIVE_RMS * float(np.sqrt(np.mean(np.square(probe))))
        if not (math.isfinite(self._quiet_rms) and self._quiet_rms > 0.0):
            raise InputError(
                f"the prepared recordings of split '{split}' are silent or not finite; prepare them again"
            )

    def _cut(self, generator: np.random.Generator, count: int) -> NDArray[np.float64]:
        places = generator.integers(0, self._ends[-1], size=count)
        recording = np.searchsorted(self._ends, places, side="right")
        before = np.where(recording > 0, self._ends[recording - 1], 0)
        starts = self._starts[recording] + places - before
        return np.asarray(self._store.waveform[starts[:, None] + self._offsets], dtype=np.float64)

    def draw(self, generator: np.random.Generator, count: int) -> Tensor:
        """[count, 1, 200] float32, RMS 1 times a random gain."""
        segments = self._cut(generator, count)
        rms = np.sqrt(np.mean(np.square(segments), axis=1, keepdims=True))
        gain = 10.0 ** (generator.uniform(-_GAIN_SPREAD_DB, _GAIN_SPREAD_DB, size=(count, 1)) / 20.0)
        unit = segments / np.maximum(rms, self._quiet_rms) * gain
        return torch.from_numpy(unit.astype(np.float32)).unsqueeze(1)


def _learning_rate(config: SmallCodecConfig, step: int) -> float:
    progress = max(0.0, 2.0 * step / config.steps - 1.0)
    return config.learning_rate * (0.02 + 0.98 * 0.5 * (1.0 + math.cos(math.pi * progress)))


def _held_out(config: SmallCodecConfig) -> HeldOut:
    return HeldOut() if config.held_out_as is None else HeldOut.of(load_config(config.held_out_as).batch)


def _comparable(config: SmallCodecConfig, held_out: HeldOut) -> dict[str, Any]:
    """The settings that a resumed run must share with its checkpoint, as JSON. The held-out bands are compared, not
    the file that names them."""
    named = {key: value for key, value in asdict(config).items() if key not in _NOT_COMPARED_ON_RESUME}
    described: dict[str, Any] = json.loads(json.dumps({**named, **asdict(held_out)}))
    return described


class _Run:
    """The contents of a checkpoint: codec, optimiser, steps done, seconds spent."""

    def __init__(self, config: SmallCodecConfig, held_out: HeldOut) -> None:
        self.config = config
        self.comparable = _comparable(config, held_out)
        self.path = config.output_folder / CHECKPOINT_NAME
        with torch.random.fork_rng(devices=[]):
            torch.manual_seed(config.seed)
            self.codec = SmallCodec(config.shape)
        self.optimiser = torch.optim.AdamW(self.codec.parameters(), weight_decay=_WEIGHT_DECAY)
        self.step = 0
        self.elapsed_seconds = 0.0

    def save(self) -> None:
        temporary = self.path.with_suffix(".partial")
        # PyTorch 1.13 does not load plain floats with weights_only: they are stored as text and as a tensor.
        torch.save(
            {
                "config": json.dumps(self.comparable),
                "step": self.step,
                "elapsed_seconds": torch.tensor(self.elapsed_seconds, dtype=torch.float64),
                "codec": self.codec.state_dict(),
                "optimiser": self.optimiser.state_dict()["state"],
            },
            temporary,
        )
        os.replace(temporary, self.path)

    def resume(self) -> None:
        if not self.path.exists():
            return
        content = read_tensors(self.path)
        begun = content.get("config")
        if not isinstance(begun, str):
            raise InputError(
                f"{self.path}: not a checkpoint of the small codec; choose another output_folder or delete it"
            )
        wanted, found = self.comparable, json.loads(begun)
        changed = sorted(key for key in wanted.keys() | found.keys() if wanted.get(key) != found.get(key))
        if changed:
            raise InputError(
                f"{self.path}: was begun with other values of {', '.join(changed)}; restore them, choose "
                "another output_folder, or delete the file to begin anew"
            )
        load_state(self.codec, content["codec"], self.path)
        self.optimiser.load_state_dict({**self.optimiser.state_dict(), "state": content["optimiser"]})
        self.step = int(content["step"])
        self.elapsed_seconds = float(content["elapsed_seconds"])

    def advance(self, original: Tensor) -> tuple[float, float]:
        """One optimiser step; returns time and spectral loss."""
        for group in self.optimiser.param_groups:
            group["lr"] = _learning_rate(self.config, self.step)
        decoded = self.codec.decode(self.codec.encode(original))
        in_time, in_spectrum = time_loss(decoded, original), spectral_loss(decoded, original)
        self.optimiser.zero_grad(set_to_none=True)
        (in_time + self.config.spectral_weight * in_spectrum).backward()
        torch.nn.utils.clip_grad_norm_(self.codec.parameters(), _GRADIENT_LIMIT)
        self.optimiser.step()
        self.step += 1
        return float(in_time.detach()), float(in_spectrum.detach())


@torch.no_grad()
def validate(codec: SmallCodec, segments: Tensor) -> float:
    """Signal-to-noise ratio in dB of [K, 1, 200] segments coded and decoded."""
    return signal_to_noise_ratio_db(codec.decode(codec.encode(segments)), segments)


def train_small_codec(store: WaveformStore, config: SmallCodecConfig) -> SmallCodec:
    """Train, or resume from output_folder's checkpoint; returns the codec with fitted statistics, in eval mode.

    Writes checkpoint.pt, log.csv and small-codec.pt into output_folder. Raises InputError if a split is empty or the
    checkpoint belongs to another configuration.
    """
    torch.set_num_threads(config.threads)
    config.output_folder.mkdir(parents=True, exist_ok=True)
    held_out = _held_out(config)
    training, validation = (SegmentSampler(store, split, held_out) for split in ("train", "validation"))
    unseen = validation.draw(np.random.default_rng([config.seed, 0]), config.validation_segments)
    run = _Run(config, held_out)
    run.resume()

    log = MetricsLog(config.output_folder / LOG_NAME, _LOG_COLUMNS, run.step)
    spent_before, began = run.elapsed_seconds, time.perf_counter()
    with tqdm(total=config.steps, initial=run.step, desc="small codec", disable=None) as progress:
        while run.step < config.steps:
            batch = training.draw(np.random.default_rng([config.seed, 1, run.step]), config.batch)
            in_time, in_spectrum = run.advance(batch)
            progress.update()
            if run.step % config.validate_every_steps == 0 or run.step == config.steps:
                run.elapsed_seconds = spent_before + time.perf_counter() - began
                snr_db = validate(run.codec, unseen)
                rate = _learning_rate(config, run.step)
                row = (run.step, in_time, in_spectrum, snr_db, rate, run.elapsed_seconds)
                log.append(dict(zip(_LOG_COLUMNS, row, strict=True)))
                run.save()
                progress.set_postfix_str(f"validation {snr_db:.1f} dB")

    codec = run.codec.eval()
    with torch.no_grad():
        drawn = training.draw(np.random.default_rng([config.seed, 2]), max(config.validation_segments, 256))
        codec.normaliser.fit(codec.encoder(drawn))
    codec.save(config.output_folder / RESULT_NAME)
    return codec


# Vibration below 0.01 m/s^2 cannot be felt; such segments are set to silence.
_QUIET_RMS_MPS2 = 0.01
_SEGMENTS_AT_A_TIME = 512

_Wave = NDArray[np.float32]


@torch.no_grad()
def codec_reconstruction(checkpoint: Path | str, waves: Sequence[_Wave], hop_samples: int = 28) -> list[_Wave]:
    """Waves [n] in m/s^2 at 2 kHz, encoded and decoded by the small codec in `checkpoint`, at their original length.

    Processed like a latent row: a segment of 200 samples begins at every hop (28 samples are 72 Hz), in unit scale by
    its own RMS, and its first `hop_samples` are played. InputError if the checkpoint is not a small codec's.
    """
    codec = SmallCodec.load(checkpoint).eval()
    return [_reconstructed(codec, np.asarray(wave, dtype=np.float32), hop_samples) for wave in waves]


def _reconstructed(codec: SmallCodec, wave: _Wave, hop_samples: int) -> _Wave:
    padded = np.concatenate([wave, np.zeros(SEGMENT_SAMPLES, dtype=np.float32)])
    segments = np.lib.stride_tricks.sliding_window_view(padded, SEGMENT_SAMPLES)[: len(wave) : hop_samples]
    rms = np.sqrt(np.square(segments, dtype=np.float64).mean(axis=1, keepdims=True))
    level = np.maximum(rms, _QUIET_RMS_MPS2).astype(np.float32)
    unit = torch.from_numpy(segments / level).unsqueeze(1)
    decoded = torch.cat([codec.decode(codec.encode(part)) for part in unit.split(_SEGMENTS_AT_A_TIME)])
    hops: _Wave = decoded.squeeze(1).numpy()[:, :hop_samples] * level
    return hops.reshape(-1)[: len(wave)]
