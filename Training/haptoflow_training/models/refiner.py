"""The refinement: a network's correction of the skeleton, in one evaluation.

The flow begins at the skeleton instead of at white noise, a data-dependent prior as in PriorGrad (Lee et al. 2022) and
SpecGrad (Koizumi et al. 2022), and takes one step; the energy distance trains that step directly. The correction starts
at zero, so the untrained network is the skeleton. Material and motion act through FiLM parameters, which a perceptron
predicts outside the graph, in native code.
"""

from __future__ import annotations

import torch
from torch import Tensor, nn

from haptoflow_training.models.conditioning import ConditionPerceptron
from haptoflow_training.models.skeleton import SWING_HARMONICS, SkeletonParts
from haptoflow_training.models.label_embedding import RATE_FEATURES, rate_features

def _unit_length(features: Tensor) -> Tensor:
    """Channels [B, C, 1, P] divided by their length: RMS normalisation up to a factor that the following layer
    absorbs."""
    return features / (features.norm(p=2, dim=1, keepdim=True) + 1e-3)


def _convolution(inputs: int, outputs: int, width: int, stride: int = 1) -> nn.Conv2d:
    return nn.Conv2d(inputs, outputs, (1, width), stride=(1, stride), padding=(0, width // 2))


class PositionMixer(nn.Module):
    """A dense layer across positions, shared within each channel group: the last patch can affect the whole segment.

    A ruled surface keeps its phase over a segment; convolutions of width 3 alone would need many layers for that.
    """

    def __init__(self, channels: int, positions: int) -> None:
        super().__init__()
        self.mix = nn.Linear(positions, positions)
        self.project = _convolution(channels, channels, 1)
        nn.init.zeros_(self.project.weight)
        nn.init.zeros_(self.project.bias)

    def forward(self, features: Tensor) -> Tensor:
        return features + self.project(nn.functional.silu(self.mix(features)))


class FilmBlock(nn.Module):
    """Residual block: norm, FiLM, SiLU, convolution, SiLU, convolution, plus position mixing."""

    def __init__(self, inputs: int, outputs: int, positions: int) -> None:
        super().__init__()
        self.channels = inputs
        self.first = _convolution(inputs, outputs, 3)
        self.second = _convolution(outputs, outputs, 3)
        self.shortcut = _convolution(inputs, outputs, 1) if inputs != outputs else nn.Identity()
        self.mixer = PositionMixer(outputs, positions)

    def forward(self, features: Tensor, scale: Tensor, shift: Tensor) -> Tensor:
        modulated = nn.functional.silu(_unit_length(features) * scale + shift)
        change = self.second(nn.functional.silu(self.first(modulated)))
        return self.mixer(self.shortcut(features) + change)


class PatchUnet(nn.Module):
    """A U-Net over patches of the segment, with FiLM at every level, and what the segment continues concatenated at
    each.

    entering: channels that go in; channels: that come out, and of each of the `pasts`. levels: 2 for a U-Net whose
    second level has half the positions; 1 for its first block alone, in less than half the time.
    """

    newest_first: Tensor

    def __init__(
        self,
        *,
        entering: int,
        channels: int = 1,
        pasts: int = 1,
        positions: int = 200,
        patch: int = 8,
        width: int = 64,
        previous_width: int = 32,
        levels: int = 2,
    ) -> None:
        super().__init__()
        if levels not in (1, 2):
            raise ValueError(f"levels: 1 or 2, not {levels}")
        self.levels = levels
        if positions % patch != 0:
            raise ValueError(f"{positions} positions do not divide into patches of {patch}")
        self.channels, self.positions, self.patch = channels, positions, patch
        self.patches = positions // patch
        coarse = (self.patches + 1) // 2

        newest_first = torch.arange(positions - 1, -1, -1)
        self.register_buffer("newest_first", newest_first, persistent=False)

        self.enter = nn.Conv2d(entering, width, (1, patch), stride=(1, patch))
        self.previous_fine = nn.Conv2d(
            pasts * channels, previous_width, (1, 3 * patch), stride=(1, patch), padding=(0, patch)
        )
        self.fine_down = FilmBlock(width + previous_width, width, self.patches)
        blocks = [self.fine_down]
        if levels == 2:
            self.previous_coarse = _convolution(previous_width, previous_width, 3, stride=2)
            self.down = _convolution(width, 2 * width, 3, stride=2)
            self.coarse = FilmBlock(2 * width + previous_width, 2 * width, coarse)
            self.up = nn.ConvTranspose2d(
                2 * width, width, (1, 3), stride=(1, 2), padding=(0, 1), output_padding=(0, 1 - self.patches % 2)
            )
            self.fine_up = FilmBlock(2 * width, width, self.patches)
            blocks += [self.coarse, self.fine_up]
        self.leave = nn.ConvTranspose2d(width, channels, (1, patch), stride=(1, patch))
        nn.init.zeros_(self.leave.weight)
        nn.init.zeros_(self.leave.bias)
        self.film_sizes = [size for block in blocks for size in (block.channels, block.channels)]

    def film_scales(self) -> tuple[Tensor, Tensor]:
        """[F] each: factors on the FiLM parameters (a block's norm is that of the sum, not of the mean), and their
        values at the start of training before the factors: 1 for scales, 0 for shifts."""
        repeats = torch.tensor(self.film_sizes)
        roots = [part for size in self.film_sizes[::2] for part in (size**0.5, 1.0)]
        starts = [1.0, 0.0] * (len(self.film_sizes) // 2)
        return torch.tensor(roots).repeat_interleave(repeats), torch.tensor(starts).repeat_interleave(repeats)

    def through(self, entering: Tensor, mirrored: Tensor, film: Tensor) -> Tensor:
        """[B, C, N], from entering [B, E, 1, N], the pasts newest sample first [B, pasts * C, 1, N] and FiLM parameters
        [B, F]."""
        parts = film.reshape(-1, sum(self.film_sizes), 1, 1).split(self.film_sizes, dim=1)
        past = self.previous_fine(mirrored)
        entered = self.enter(entering)
        fine = self.fine_down(torch.cat([entered, past], dim=1), parts[0], parts[1])
        if self.levels == 2:
            past_coarse = self.previous_coarse(nn.functional.silu(past))
            coarse = self.coarse(torch.cat([self.down(fine), past_coarse], dim=1), parts[2], parts[3])
            fine = self.fine_up(torch.cat([self.up(coarse), fine], dim=1), parts[4], parts[5])
        return self._leave(fine)

    def _leave(self, features: Tensor) -> Tensor:
        """The transposed convolution `leave`, [B, C, N]: since patches do not overlap, one linear layer for each
        place in a patch followed by a transposition, in half the time of ONNX Runtime's transposed convolution."""
        width, channels, patch = len(self.leave.weight), self.channels, self.patch
        weight = self.leave.weight.reshape(width, channels * patch).t().reshape(channels * patch, width, 1, 1)
        samples = nn.functional.conv2d(features, weight, self.leave.bias.repeat_interleave(patch))
        return samples.reshape(-1, channels, patch, self.patches).transpose(2, 3).reshape(-1, channels, self.positions)


ENTERING = 2 + 2 * SWING_HARMONICS
# What was played, with all corrections, and the skeleton's own past.
PASTS = 2
_HIDDEN = 128


class Refiner(PatchUnet):
    """Corrections [B, 1, 200] of skeletons, in unit scale, after what was played and the skeleton's own past, previous
    [B, 2, 200]."""

    film_factors: Tensor

    def __init__(self, *, width: int = 48, previous_width: int = 16, levels: int = 2) -> None:
        super().__init__(entering=ENTERING, pasts=PASTS, width=width, previous_width=previous_width, levels=levels)
        factors, starts = self.film_scales()
        self.condition = ConditionPerceptron(len(factors), _HIDDEN, RATE_FEATURES)
        self.register_buffer("film_factors", factors, persistent=False)
        with torch.no_grad():
            self.condition.layers[-1].bias += starts

    def film(self, embedding: Tensor, motion: Tensor, phases: Tensor) -> Tensor:
        """FiLM parameters [B, F]."""
        return self.condition(embedding, motion, rate_features(phases)) * self.film_factors

    @staticmethod
    def entering(parts: SkeletonParts) -> Tensor:
        """What the network sees, [B, 12, 200]: the skeleton, the impulses that drove it, and the harmonics of the
        surface's waves, those of all families added."""
        waves = torch.cat([parts.cosines.sum(dim=1), parts.sines.sum(dim=1)], dim=1)
        return torch.cat([parts.segment, parts.impulses, waves], dim=1)

    def forward(
        self, parts: SkeletonParts, previous: Tensor, embedding: Tensor, motion: Tensor, phases: Tensor
    ) -> Tensor:
        mirrored = previous[:, :, self.newest_first]
        film = self.film(embedding, motion, phases)
        return self.through(self.entering(parts).unsqueeze(2), mirrored.unsqueeze(2), film)
