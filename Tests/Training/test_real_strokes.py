"""Recorded pen strokes through the shipped engine and model: no errors, clicks or clipping."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from haptoflow_benchmark.engine_render import onto_table, read_recorded_strokes, read_wav
from haptoflow_training.errors import InputError

ROOT = Path(__file__).parents[2]
STROKES = ROOT.parent / "shared" / "strokes" / "vr-pen-on-surface" / "strokes.csv"
ENGINE = Path(os.environ.get("HAPTOFLOW_ENGINE", ROOT / "build" / "native" / "haptoflow"))
UPDATE_RATE_HZ = 72.0

# From left to right under every stroke: hard, periodic, soft and rough surfaces side by side.
MATERIALS = ("wood", "metal mesh", "rubber", "sandpaper", "corduroy", "glass")


def _read_strokes() -> dict[str, NDArray[np.float64]]:
    if not STROKES.is_file():
        pytest.skip(f"the recorded strokes are not beside this checkout ({STROKES.relative_to(ROOT.parent)})")
    return read_recorded_strokes(STROKES)


def _scene(path: Path) -> None:
    width = 0.12
    surfaces = [
        {
            "name": material,
            "shape": {"box": {"size": [width, 0.02, 2.0]}},
            "position": [width * (index - (len(MATERIALS) - 1) / 2), -0.01, 0.0],
            "rotation": [0.0, 0.0, 0.0, 1.0],
            "material": material,
        }
        for index, material in enumerate(MATERIALS)
    ]
    for side in (-1.0, 1.0):
        surfaces.append(
            {
                "name": f"table {side:+.0f}",
                "shape": {"box": {"size": [2.0, 0.02, 2.0]}},
                "position": [side * (1.0 + width * len(MATERIALS) / 2), -0.01, 0.0],
                "rotation": [0.0, 0.0, 0.0, 1.0],
                "material": "stone",
            }
        )
    scene = {"surfaces": surfaces, "stylus": {"tip_radius": 0.002}, "update_rate": UPDATE_RATE_HZ}
    path.write_text(json.dumps(scene), encoding="utf-8")


@pytest.fixture(scope="module")
def renders(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[dict[str, object], NDArray[np.float32]]]:
    strokes = _read_strokes()
    assert ENGINE.is_file(), f"{ENGINE} is missing: build it with `npm run build`"
    folder = tmp_path_factory.mktemp("strokes")
    scene = folder / "scene.json"
    _scene(scene)
    results = {}
    for number, (name, stroke) in enumerate(strokes.items()):
        path, wav, report = (folder / f"{number}{ending}" for ending in (".csv", ".wav", ".json"))
        np.savetxt(path, onto_table(stroke), fmt="%.7f", delimiter=",", header="t,x,y,z", comments="")
        subprocess.run(
            [str(ENGINE), "render", str(scene), "--stroke", str(path), "-o", str(wav), "--report", str(report),
             "--rate", "48000", "--seed", "3", "--quiet"],
            check=True, capture_output=True,
        )  # fmt: skip
        results[name] = (json.loads(report.read_text(encoding="utf-8")), read_wav(wav))
    return results


Renders = dict[str, tuple[dict[str, object], NDArray[np.float32]]]


def test_every_stroke_touches_and_vibrates(renders: Renders) -> None:
    assert len(renders) == 20
    for name, (report, samples) in renders.items():
        assert report["segments"], name
        assert np.abs(samples).max() > 1e-3, name


def test_no_sample_is_non_finite_or_clipped(renders: Renders) -> None:
    for name, (report, samples) in renders.items():
        assert np.isfinite(samples).all(), name
        assert np.abs(samples).max() < 1.0, name
        assert report["nonfinite"] == 0 and report["failures"] == 0 and report["underruns"] == 0, name


def test_hop_boundaries_do_not_stand_out_from_the_waveform(renders: Renders) -> None:
    seams = [report["seams"] for report, _ in renders.values()]
    counts = np.array([seam["count"] for seam in seams], dtype=float)  # type: ignore[index]
    shares = np.array([seam["outlier_share"] for seam in seams])  # type: ignore[index]
    ratios = np.array([seam["jump_ratio"] for seam in seams])  # type: ignore[index]
    assert (counts * shares).sum() / counts.sum() <= 0.005
    assert np.sqrt((counts * ratios**2).sum() / counts.sum()) <= 1.3


def test_a_stroke_on_a_tilted_table_is_mapped_onto_its_plane_and_lifts_stay_above() -> None:
    generator = np.random.default_rng(4)
    plane = generator.uniform(-0.3, 0.3, size=(300, 2))
    height = 0.02 + 0.05 * plane[:, 0] - 0.03 * plane[:, 1]
    height[280:] += 0.04
    placed = onto_table(np.c_[5.0 + np.arange(300) / 90.0, plane, height])
    assert placed[0, 0] == 0.0 and np.abs(placed[:280, 2]).max() < 1e-9
    assert np.abs(placed[280:, 2] - 0.04).max() < 1e-9


@pytest.mark.parametrize(
    ("text", "message"),
    [("stroke_id,t_s,x_m,y_m,z_m\na,0,0,oops,0\n", ":2: expected"), ("stroke_id,t_s,x_m,y_m\na,0,0,0\n", ":2: expected"),
     ("stroke_id,t_s,x_m,y_m,z_m\n", "holds no stroke")],
)  # fmt: skip
def test_a_damaged_stroke_file_is_refused_with_the_line_named(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "strokes.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=message):
        read_recorded_strokes(path)
