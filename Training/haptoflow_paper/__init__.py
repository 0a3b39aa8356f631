"""The paper's apparatus: rivals, codecs, recipes, the rows of the table of accuracy and time, and their stored results.

Builds on haptoflow_benchmark and haptoflow_training, which never import it. Importing this package makes the keys of
runs/configuration.py available in run configurations.
"""

from __future__ import annotations

from haptoflow_training.extensions import use_configuration

use_configuration("haptoflow_paper.runs.configuration:EvaluatedConfig")
