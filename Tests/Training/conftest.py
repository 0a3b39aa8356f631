"""Makes the packages of the tree and the helpers of this folder importable."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parents[2] / "Training"), str(Path(__file__).parent)]
