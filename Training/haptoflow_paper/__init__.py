"""The paper's apparatus: rivals, codecs, recipes, the rows of the table of accuracy and time, and their stored results.

Builds on haptoflow_benchmark and haptoflow_training, which never import it. Importing this package makes its networks,
codecs and objectives available in run configurations.
"""

from __future__ import annotations

from haptoflow_training.extensions import register
from haptoflow_training.training.config import ARCHITECTURES

for _name in ARCHITECTURES:
    register("architecture", _name, "haptoflow_paper.rivals:build_rival")
for _name in ("small-codec", "encodec"):
    register("representation", _name, "haptoflow_paper.codec.representation:build_codec_representation")
register("objective", "average-velocity", "haptoflow_paper.objectives.mean_flow:mean_flow_loss")
register("objective", "reflow", "haptoflow_paper.objectives.reflow:ReflowPairs")
