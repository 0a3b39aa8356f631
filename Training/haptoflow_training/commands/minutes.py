"""`train --minutes N`: how much of N minutes remains for training once preparation, measurement and export have
theirs."""

from __future__ import annotations

import copy
import time
from dataclasses import dataclass

from haptoflow_training.closed_loop.level_calibration import Extent
from haptoflow_training.closed_loop.measured_levels import seconds_of_a_measurement
from haptoflow_training.export.onnx_graphs import export_level_model
from haptoflow_training.export.trained_tier import tier_of
from haptoflow_training.models.haptoflow_model import HaptoFlowModel
from haptoflow_training.training.config import TrainingConfig
from haptoflow_training.training.recordings_source import Source
from haptoflow_training.training.trainer import TimeLimit

MINIMUM_MINUTES = 0.1
# Levels are measured once without level tables and at most twice with them.
_ROUNDS = 3.0
_MAXIMUM_SHARE_AFTER = 0.25
_MINIMUM_SHARE_OF_TRAINING = 0.3
_MAXIMUM_COMPARED_SAMPLES = 16000
_MINIMUM_RECORDINGS = 2
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
    extent = Extent(longest_samples=_MAXIMUM_COMPARED_SAMPLES)
    after = 0.0
    if exports and config.recipe.embedding_steps:
        after = _SECONDS_OF_A_LABELS_FIT * len(source.labels)
    elif exports:
        model = copy.deepcopy(untrained).eval().requires_grad_(False)
        tier = tier_of(config, list(source.store.labels), model)
        started = time.monotonic()
        tier.graphs()
        export_level_model(model.level)
        after = 1.5 * (time.monotonic() - started) + 1.0
        if config.calibrates_level:
            one = Extent(_MINIMUM_RECORDINGS, extent.longest_samples)
            seconds = _ROUNDS * seconds_of_a_measurement(tier, source, one) / one.recordings_per_label
            affordable = int(max(0.0, _MAXIMUM_SHARE_AFTER * whole - after) / max(seconds, 1e-6))
            count = min(extent.recordings_per_label, max(_MINIMUM_RECORDINGS, affordable))
            extent = Extent(count, extent.longest_samples)
            after += seconds * count
    training = whole - (time.monotonic() - begun) - after
    return Minutes(TimeLimit(max(training, _MINIMUM_SHARE_OF_TRAINING * whole), after), extent)
