"""The engine's noise once more in plain Python: Philox-4x32-10 and Box-Muller, for golden values."""

from __future__ import annotations

import math
import struct

import numpy as np

MASK = 0xFFFFFFFF


def philox(counter: list[int], key: list[int]) -> list[int]:
    """Ten rounds on four 32-bit words of counter and two of key (Salmon et al. 2011)."""
    for _ in range(10):
        even = 0xD2511F53 * counter[0]
        odd = 0xCD9E8D57 * counter[2]
        counter = [(odd >> 32) ^ counter[1] ^ key[0], odd & MASK,
                   (even >> 32) ^ counter[3] ^ key[1], even & MASK]
        key = [(key[0] + 0x9E3779B9) & MASK, (key[1] + 0xBB67AE85) & MASK]
    return counter


def standard_normal(seed: int, voice: int, segment: int, count: int) -> np.ndarray:
    """`count` numbers, float32."""
    values: list[float] = []
    for block in range((count + 1) // 2):
        words = philox([block, voice, segment & MASK, segment >> 32], [seed & MASK, seed >> 32])
        first = ((((words[0] << 32) | words[1]) >> 12) + 0.5) * 2.0**-52
        second = ((((words[2] << 32) | words[3]) >> 12) + 0.5) * 2.0**-52
        radius = math.sqrt(-2.0 * math.log(first))
        angle = 2.0 * math.pi * (second - 0.125)
        values += [radius * math.cos(angle), radius * math.sin(angle)]
    return np.array(values[:count], dtype=np.float32)


def latent_noise(noise: np.ndarray, count: int) -> np.ndarray:
    """The start of a latent tier's solver: noise keyed by a hash of a segment's noise (FNV-1a over 32-bit
    words)."""
    state = 0xCBF29CE484222325
    for (word,) in struct.iter_unpack("<I", noise.astype("<f4").tobytes()):
        state = ((state ^ word) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return standard_normal(state, 0, 0, count)
