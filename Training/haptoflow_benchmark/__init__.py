"""The measurements behind the published tables: rivals, codecs, rows, studies.

Builds on haptoflow_training, which never imports it. Importing this package makes its networks, codecs and objectives
available in run configurations.
"""

from __future__ import annotations

from haptoflow_training.extensions import register
from haptoflow_training.training.config import ARCHITECTURES

for _name in ARCHITECTURES:
    register("architecture", _name, "haptoflow_benchmark.rivals:build_rival")
for _name in ("small-codec", "encodec"):
    register("representation", _name, "haptoflow_benchmark.codec.representation:build_codec_representation")
register("objective", "average-velocity", "haptoflow_benchmark.objectives.mean_flow:mean_flow_loss")
register("objective", "reflow", "haptoflow_benchmark.objectives.reflow:ReflowPairs")
