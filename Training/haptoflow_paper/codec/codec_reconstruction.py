"""Recordings encoded and decoded by a codec: the best that a row in its latents can score."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray

from haptoflow_paper.codec.small_codec import SmallCodec
from haptoflow_training.waveform import SEGMENT_SAMPLES

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
