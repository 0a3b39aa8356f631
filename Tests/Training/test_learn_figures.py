"""`learn-figures`: which ribs count as found, and the contents of its table."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from haptoflow_benchmark.cli import main
from haptoflow_benchmark.few_shot.learn_figures import LearnFigures, _as_table, _families, chosen_materials, table
from haptoflow_training.recordings.material_recording import MaterialRecording
from haptoflow_training.recordings.synthetic import load_materials

JUTE = next(material for material in load_materials() if material.label == "jute")


def test_the_chosen_materials_are_the_same_in_every_run() -> None:
    chosen = chosen_materials(9, 3, 2026)
    assert [bool(material.rulings) for material in chosen] == [False] * 9 + [True] * 3
    assert chosen == chosen_materials(9, 3, 2026)


def test_ribs_count_as_found_in_the_material_s_own_frame() -> None:
    # Jute's families lie along x, 2 mm apart, and along y, 1.7 mm apart; the material is turned by 90 degrees.
    turned = {"wave_vectors": [{"x_cycles_per_mm": 1 / 1.7, "y_cycles_per_mm": 0.0},
                               {"x_cycles_per_mm": 0.0, "y_cycles_per_mm": 0.5}]}  # fmt: skip
    assert _families(JUTE, turned, 1.5707963) == (2, 0)
    assert _families(JUTE, turned, 0.0) == (0, 2)
    assert _families(JUTE, {"wave_vectors": turned["wave_vectors"][:1]}, 1.5707963) == (1, 0)


def test_the_table_has_medians_and_percentiles_of_its_group_only() -> None:
    cells = [{"level_error_db": error, "gfc": 0.9, "lsd_db": 2.0} for error in (-1.0, 1.0, 3.0)]
    rows = {name: cells for name in ("learn", "autoregressive", "other draw")}
    plain = LearnFigures("unseen-01", 0, 0, 0, 8.0, rows)
    ruled = dataclasses.replace(plain, families=2, rows={name: [dict(cells[0], gfc=0.5)] for name in rows})
    assert "| 1 surfaces without ribs: `haptoflow learn` | 1.00 (2.60) | 0.900 (0.900) | 2.00 (2.00) |" in table(
        [plain, ruled], ruled=False
    )
    assert "0.500 (0.500)" in table([plain, ruled], ruled=True)


def test_rides_are_written_to_one_table_with_missing_samples_between() -> None:
    ride = MaterialRecording(
        "", "", np.ones(3, np.float32), np.full((3, 2), 0.1, np.float32), np.ones(3, np.float32), "", ""
    )
    lines = _as_table([ride, ride]).splitlines()
    assert lines[0] == "acceleration_mps2,velocity_x_mps,velocity_y_mps,force_newtons"
    assert lines[1] == "1,0.1,0.1,1"
    assert lines[4:24] == ["nan,0.1,0.1,1"] * 20
    assert len(lines) == 27


def test_a_missing_engine_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    root = Path(__file__).parents[2]
    model = root / "Packages" / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"
    words = ["learn-figures", "--model", str(model), "--engine", str(tmp_path / "none"), "--plain", "1", "--ruled", "0"]
    assert main(words) == 3
    assert "cannot be run" in capsys.readouterr().err
