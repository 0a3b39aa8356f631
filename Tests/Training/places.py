"""Files of the tree that several tests use."""

from __future__ import annotations

import os
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TRAINING = ROOT / "Training"
ENGINE = Path(os.environ.get("HAPTOFLOW_ENGINE", ROOT / "build" / "native" / "haptoflow"))
DEFAULT = ROOT / "Packages" / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"
# A small model with a skeleton.
SMALL = ROOT / "Tests" / "Golden" / "model" / "skeleton.haptoflow"
