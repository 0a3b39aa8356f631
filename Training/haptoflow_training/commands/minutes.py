"""`--minutes N` of `train` and `train-tiers`: how much of N minutes remains for training once preparation, measurement and
export have theirs."""

from __future__ import annotations

import copy
import time
from dataclasses import dataclass

from haptoflow_training.closed_loop.level_calibration import Extent
from haptoflow_training.closed_loop.measured_levels import seconds_of_a_measurement
from haptoflow_training.export.trained_tier import TrainedTier, tier_of
from haptoflow_training.models.haptoflow_model import HaptoFlowModel
from haptoflow_training.training.config import TrainingConfig
from haptoflow_training.training.recordings_source import Source
from haptoflow_training.training.trainer import TimeLimit

MINIMUM_MINUTES = 0.1
# Levels are measured once without level tables and at most twice with them.
_ROUNDS = 3.0
_MAXIMUM_SHARE_AFTER = 0.25
_MINIMUM_SHARE_OF_TRAINING = 0.3
_LONGEST_COMPARED_SAMPLES = 16000
_MINIMUM_RECORDINGS = 2
# Of a whole model's training, with one round of networks.
_BASE_SHARE, _NETWORK_SHARE, _LEVELS_SHARE = 0.35, 0.57, 0.08
# What the library takes for level and tone of one label.
_SECONDS_OF_A_LABELS_FIT = 2.0


@dataclass(frozen=True)
class Minutes:
    """limit: the time limit of training. extent: how much is compared when levels are measured afterwards."""

    limit: TimeLimit
    extent: Extent


def share_out(
    minutes: float, begun: float, config: TrainingConfig, source: Source, untrained: HaptoFlowModel, *, exports: bool
) -> Minutes:
    """Share out the minutes. What measuring levels and writing graphs takes is timed on the untrained network, because
    training does not change it.

    begun: time.monotonic() when the command began. Training gets at least three tenths of the minutes, even if
    preparing the recordings took most of them.
    """
    whole = 60.0 * minutes
    extent = Extent(longest_samples=_LONGEST_COMPARED_SAMPLES)
    after = 0.0
    if exports and config.recipe.embedding_steps:
        after = _SECONDS_OF_A_LABELS_FIT * len(source.labels)
    elif exports:
        model = copy.deepcopy(untrained).eval().requires_grad_(False)
        tier = tier_of(config, list(source.store.labels), model)
        started = time.monotonic()
        tier.graphs()
        after = 1.5 * (time.monotonic() - started) + 1.0
        if config.calibrates_level:
            extent, seconds = affordable_extent(tier, source, _MAXIMUM_SHARE_AFTER * whole - after)
            after += seconds
    training = whole - (time.monotonic() - begun) - after
    return Minutes(TimeLimit(max(training, _MINIMUM_SHARE_OF_TRAINING * whole), after), extent)


def affordable_extent(tier: TrainedTier, source: Source, seconds: float) -> tuple[Extent, float]:
    """How much can be compared within so many seconds, two recordings of each label at least; and how long it takes."""
    one = Extent(_MINIMUM_RECORDINGS, _LONGEST_COMPARED_SAMPLES)
    each = _ROUNDS * seconds_of_a_measurement(tier, source, one) / one.recordings_per_label
    count = min(Extent().recordings_per_label, max(_MINIMUM_RECORDINGS, int(max(0.0, seconds) / max(each, 1e-6))))
    return Extent(count, _LONGEST_COMPARED_SAMPLES), each * count


@dataclass(frozen=True)
class TiersMinutes:
    """Seconds of a wall clock: of the base, of each network, and of the level measurement at the end."""

    base: float
    network: float
    levels: float

    @classmethod
    def of(cls, minutes: float, begun: float, networks: int, lanes: int) -> TiersMinutes:
        """Share out what is left of the minutes, as the shipped model's training does. At least three tenths of them,
        even if preparing the recordings took most."""
        whole = 60.0 * minutes
        left = max(whole - (time.monotonic() - begun), _MINIMUM_SHARE_OF_TRAINING * whole)
        rounds = -(-networks // max(1, lanes))
        unit = left / (_BASE_SHARE + rounds * _NETWORK_SHARE + _LEVELS_SHARE)
        return cls(_BASE_SHARE * unit, _NETWORK_SHARE * unit, _LEVELS_SHARE * unit)
