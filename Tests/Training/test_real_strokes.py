"""Recorded pen strokes through the shipped engine and model: no errors, clicks or clipping."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import welch

from haptoflow_benchmark.engine_render import (
    FULL_SCALE_MPS2, onto_table, read_recorded_strokes, read_wav, rendered_samples, write_rows, write_scene
)
from haptoflow_training.errors import InputError
from places import DEFAULT, ENGINE, ROOT

STROKES = ROOT.parent / "shared" / "strokes" / "vr-pen-on-surface" / "strokes.csv"

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


def test_the_engine_follows_a_scribble_within_a_pose_interval_lead_and_hop(tmp_path: Path) -> None:
    """The lag at which the log level of the vibration correlates best with the log speed of a scribble of 2 Hz."""
    assert ENGINE.is_file(), f"{ENGINE} is missing: build it with `npm run build`"
    scene, table, wav = (tmp_path / name for name in ("scene.json", "stroke.csv", "out.wav"))
    turn, metres = 4.0 * np.pi, 0.02
    times = np.arange(0.0, 4.0, 0.001)
    along = metres * np.sin(turn * times)
    write_scene(scene, "wood", 90.0, 0.5)
    write_rows(table, np.c_[times, 0.8 * along, np.full(len(times), 0.25), 0.6 * along, np.ones(len(times))])
    waves = [
        rendered_samples(ENGINE, scene, table, wav, model=DEFAULT, seed=seed, options=("--quiet",))
        for seed in (1, 2, 3)
    ]
    window = np.hanning(25)
    level = np.log(np.convolve(np.mean(np.square(waves), axis=0), window / window.sum(), mode="same") + 1e-20)
    index = np.arange(600, 7600)
    speed = metres * turn * np.abs(np.cos(turn * index / 2000.0))
    index, logarithm = index[speed > 0.02], np.log(speed[speed > 0.02])
    lags = np.arange(-20, 160)
    lag_ms = 0.5 * lags[np.argmax([np.corrcoef(logarithm, level[index + lag])[0, 1] for lag in lags])]
    assert 2.0 < lag_ms < 11.1 + 8.0 + 5.0


LABELS = ("rubber", "wood", "stone")
RATE_HZ = 8000
GRAVITY_MPS2 = 9.81
PERIOD_SECONDS = 0.7
TAP_SECONDS = 0.25
# About the heights from which a finger falls.
HEIGHTS_METRES = np.linspace(0.02, 0.09, 16)


def _drops(path: Path) -> NDArray[np.float64]:
    """Strokes that fall freely from each height onto the plane y = 0, rest and are lifted; returns the landing
    times."""
    rows, landings = [], []
    for number, height in enumerate(HEIGHTS_METRES):
        # Each begins at another phase of the frames.
        begin = number * PERIOD_SECONDS + 0.0013 * number
        fall = np.sqrt(2.0 * height / GRAVITY_MPS2)
        for time in np.arange(0.0, PERIOD_SECONDS, 0.002):
            falling = 0.002 + height - 0.5 * GRAVITY_MPS2 * time**2
            lifted = 0.002 + height * np.clip((time - 0.45) / 0.2, 0.0, 1.0)
            y = max(0.0005, falling) if time < 0.45 else max(0.0005, lifted)
            rows.append((begin + time, 0.0, y, 0.0, 0.5))
        landings.append(begin + fall)
    np.savetxt(path, np.array(rows), fmt="%.6f", delimiter=",", header="t,x,y,z,force", comments="")
    return np.array(landings)


def _render(folder: Path, label: str, stroke: Path, effects: str) -> NDArray[np.float64]:
    scene, wav = folder / "scene.json", folder / "out.wav"
    write_scene(scene, label, 90.0, tip_radius_metres=0.002)
    command = [str(ENGINE), "render", str(scene), "--stroke", str(stroke), "-o", str(wav), "--quiet"]
    done = subprocess.run(
        [*command, "--rate", str(RATE_HZ), "--effects", effects], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    wave: NDArray[np.float64] = read_wav(wav).astype(np.float64) * FULL_SCALE_MPS2
    return wave


@pytest.fixture(scope="module")
def taps(tmp_path_factory: pytest.TempPathFactory) -> dict[str, NDArray[np.float64]]:
    """Each label's taps [heights, samples] in m/s^2, from the landing on."""
    folder = tmp_path_factory.mktemp("taps")
    landings = _drops(folder / "drops.csv")
    count = int(TAP_SECONDS * RATE_HZ)
    cut = {}
    for label in LABELS:
        wave = _render(folder, label, folder / "drops.csv", "texture,impact,edge")
        starts = [int(round(landing * RATE_HZ)) for landing in landings]
        cut[label] = np.stack([wave[start : start + count] for start in starts])
    return cut


def _spectrum(tap: NDArray[np.float64]) -> NDArray[np.float64]:
    """Level of third octaves from 22 Hz to 900 Hz in dB, over their mean, so that strength does not matter."""
    frequency, power = welch(tap, RATE_HZ, nperseg=1024, noverlap=768)
    bands = np.digitize(frequency, 22.4 * 2.0 ** (np.arange(17) / 3.0))
    levels = 10.0 * np.log10(np.array([power[bands == band].sum() for band in range(1, 17)]) + 1e-10)
    spectrum: NDArray[np.float64] = levels - levels.mean()
    return spectrum


def test_every_drop_gives_one_impact_and_higher_drops_give_stronger_ones(taps: dict[str, NDArray[np.float64]]) -> None:
    for label, waves in taps.items():
        peaks = np.abs(waves).max(axis=1)
        assert peaks.min() > 1.0, label
        assert np.corrcoef(peaks, np.sqrt(HEIGHTS_METRES))[0, 1] > 0.9, label


def test_a_classifier_distinguishes_unseen_taps_on_rubber_wood_and_stone_by_spectrum(
    taps: dict[str, NDArray[np.float64]]
) -> None:
    spectra = {label: np.stack([_spectrum(tap) for tap in waves]) for label, waves in taps.items()}
    centres = {label: known[::2].mean(axis=0) for label, known in spectra.items()}
    named = [
        (label, min(LABELS, key=lambda other: float(np.square(asked - centres[other]).sum())))
        for label, known in spectra.items()
        for asked in known[1::2]
    ]
    right = sum(label == guess for label, guess in named)
    assert right >= 0.95 * len(named), named
