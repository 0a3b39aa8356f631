"""EnCodec at the rate of this project: 200 samples at 2 kHz in, latent of 128 x 8, 200 samples out."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from haptoflow_paper.codec.encodec import ENCODEC_RATE_HZ, FRAME_SAMPLES, LATENT_CHANNELS, EnCodec
from haptoflow_paper.codec.latent_normaliser import LatentNormaliser
from haptoflow_paper.codec.polyphase_resampler import PolyphaseResampler
from haptoflow_training.waveform import SEGMENT_SAMPLES

WAVEFORM_RATE_HZ = 2_000
# EnCodec was trained on sound within +-1; waveforms in unit scale have an RMS of 1 and peaks of several.
DEFAULT_WAVEFORM_SCALE = 0.1

_FACTOR = ENCODEC_RATE_HZ // WAVEFORM_RATE_HZ
_SAMPLES_24_KHZ = SEGMENT_SAMPLES * _FACTOR


class ResampledEnCodec(nn.Module):
    """Scale, upsample 12 times, encode, normalise; and the inverse. Input and output are in unit scale at 2 kHz."""

    latent_shape = (LATENT_CHANNELS, -(-_SAMPLES_24_KHZ // FRAME_SAMPLES))

    def __init__(self, codec: EnCodec, waveform_scale: float = DEFAULT_WAVEFORM_SCALE) -> None:
        super().__init__()
        self.codec = codec
        self.waveform_scale = waveform_scale
        self.resampler = PolyphaseResampler(_FACTOR)
        self.normaliser = LatentNormaliser(LATENT_CHANNELS)

    def encode_unnormalised(self, waveform: Tensor) -> Tensor:
        """[B, 1, 200] in unit scale to EnCodec's own latent [B, 128, 8]."""
        return self.codec.encode(self.resampler.upsample(waveform * self.waveform_scale))

    def encode(self, waveform: Tensor) -> Tensor:
        """[B, 1, 200] in unit scale to the normalised latent [B, 128, 8]."""
        return self.normaliser(self.encode_unnormalised(waveform))

    def decode(self, latent: Tensor) -> Tensor:
        """[B, 128, 8] normalised to [B, 1, 200] in unit scale."""
        decoded = self.codec.decode(self.normaliser.inverse(latent), _SAMPLES_24_KHZ)
        return self.resampler.downsample(decoded) / self.waveform_scale

    @torch.no_grad()
    def fit_normaliser(self, waveforms: Tensor, batch: int = 64) -> None:
        """Fit the latent statistics to waveforms [K, 1, 200] in unit scale; `normaliser.save` keeps them."""
        self.normaliser.fit(torch.cat([self.encode_unnormalised(part) for part in waveforms.split(batch)]))
