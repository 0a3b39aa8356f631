"""`haptoflow-benchmark measure-carriers`: what a device with one carrier plays of every label."""

from __future__ import annotations

import argparse
import json
import tempfile
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from haptoflow_benchmark.carriers.carrier_figures import (
    FRAME_SECONDS,
    JUST_NOTICEABLE_RATIO,
    WAVE_RATE_HZ,
    CarrierCase,
    Frames,
    case_of,
    distances,
    distances_at_one_motion,
    medians_by_label,
    modulation_left,
    step_delays_ms,
    step_percentiles_db,
    taps_on_noise,
)
from haptoflow_benchmark.engine.engine_render import render_motion
from haptoflow_benchmark.engine.wave_frames import wave_frames
from haptoflow_benchmark.full_scale.measurement import model_labels
from haptoflow_training.markdown import table
from haptoflow_training.model_stamp import model_line, sha256_of
from haptoflow_training.native_library import NativeLibrary
from haptoflow_training.whole_file import check_writable, write_whole

SPEEDS_MPS = (0.03, 0.1, 0.3)
FORCES_NEWTONS = (0.5, 1.0, 2.0)
_STROKE_SECONDS = 2.5
# The start of a stroke is no part of its steady carrier.
_SETTLED_SECONDS = 0.5
_MODULATIONS_HZ = (2.0, 5.0, 10.0)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Renders steady strokes on every label through the engine's command line, converts them to frames of 5 ms for a "
        "device with one carrier, and reports how far the carriers of labels lie apart, how much the amplitude changes "
        "from frame to frame, and what is left of taps, slow modulation, starts and stops."
    )
    parser.epilog = (
        "example:\n  haptoflow-benchmark measure-carriers --engine build/native/haptoflow \\\n"
        "    --library build/native/libaudioplugin_haptoflow.so \\\n"
        "    --model Packages/com.haptoflow.runtime/Runtime/Models/default.haptoflow --out carriers.json"
    )
    parser.add_argument("--engine", type=Path, required=True, help="the built command line, build/native/haptoflow")
    parser.add_argument("--library", type=Path, required=True, help="the built native library")
    parser.add_argument("--model", type=Path, required=True, help="the .haptoflow file")
    parser.add_argument(
        "--speeds", type=float, nargs="+", default=list(SPEEDS_MPS), help="m/s (default: 0.03 0.1 0.3)"
    )
    parser.add_argument(
        "--forces", type=float, nargs="+", default=list(FORCES_NEWTONS), help="newtons (default: 0.5 1 2)"
    )
    parser.add_argument(
        "--range", type=float, nargs=2, default=[60.0, 400.0], metavar=("LOW", "HIGH"),
        help="the device's range in Hz (default: 60 400)",
    )  # fmt: skip
    parser.add_argument("--workers", type=int, default=2, help="renders at a time (default: 2)")
    parser.add_argument("--out", type=Path, required=True, help="the report, JSON")


def run(options: argparse.Namespace) -> int:
    check_writable(options.out)
    library = NativeLibrary(options.library)
    low, high = options.range
    frames = partial(_frames, library, low, high)
    motions = [(speed, force) for speed in options.speeds for force in options.forces]
    labels = model_labels(options.engine, options.model)
    with tqdm(total=len(labels) * len(motions), unit="render") as bar, ThreadPoolExecutor(options.workers) as pool:

        def measure(case: tuple[str, tuple[float, float]]) -> CarrierCase:
            label, (speed, force) = case
            rows = frames(_stroke(options.engine, options.model, label, speed, force))
            bar.update()
            return case_of(label, speed, force, rows[rows["seconds"] >= _SETTLED_SECONDS])

        cases = list(pool.map(measure, [(label, motion) for label in labels for motion in motions]))
    report = {"model_sha256": sha256_of(options.model), "range_hz": [low, high], **summarise(cases, frames)}
    write_whole(options.out, (json.dumps(report, indent=1) + "\n").encode())
    print(f"{model_line(report['model_sha256'])}\n\n{carrier_table(report)}\n\n{label_table(report)}")
    return 0


def _frames(library: NativeLibrary, low: float, high: float, wave: NDArray[np.floating]) -> NDArray[np.void]:
    return wave_frames(library, wave, WAVE_RATE_HZ, FRAME_SECONDS, low, high)


def _stroke(engine: Path, model: Path, label: str, speed_mps: float, force_newtons: float) -> NDArray[np.float64]:
    motion = np.zeros((int(_STROKE_SECONDS * WAVE_RATE_HZ), 3))
    motion[:, 0], motion[:, 2] = speed_mps, force_newtons
    with tempfile.TemporaryDirectory() as folder:
        return render_motion(engine, label, motion, Path(folder), model=model, options=("--quiet",)).waveform_mps2


def summarise(cases: list[CarrierCase], frames: Frames) -> dict[str, Any]:
    """Figures of the strokes, and of synthetic taps, modulations and steps through the same frames."""
    medians = medians_by_label(cases)
    pooled, each = distances(medians), distances_at_one_motion(cases)
    taps = taps_on_noise(frames)
    return {
        "median_carriers_hz": medians,
        "distance_semitones": {"smallest": pooled.smallest, "median": pooled.median, "pairs_apart": pooled.apart},
        "distance_at_one_motion_semitones": {
            "smallest": float(np.median([motion.smallest for motion in each])),
            "median": float(np.median([motion.median for motion in each])),
            "pairs_apart": float(np.median([motion.apart for motion in each])),
        },
        "alike": {
            label: [second if first == label else first for first, second in pooled.alike if label in (first, second)]
            for label in medians
        },
        "alike_at_every_motion": [
            list(pair) for pair in each[0].alike if all(pair in motion.alike for motion in each)
        ],
        "step_db": dict(zip(("p50", "p95"), step_percentiles_db(cases), strict=True)),
        "step_p95_db_by_label": {
            label: step_percentiles_db([case for case in cases if case.label == label])[1] for label in medians
        },
        "taps_on_noise": {
            "peak_db": {"median": float(np.median(taps[:, 0])), "smallest": float(taps[:, 0].min())},
            "delay_ms": {"median": float(np.median(taps[:, 1])), "largest": float(taps[:, 1].max())},
        },
        "step_delay_ms": {
            name: dict(zip(("p50", "p95"), step_delays_ms(frames, ratio), strict=True))
            for name, ratio in (("up 20 dB", 10.0), ("up 6 dB", 2.0), ("down 20 dB", 0.1), ("stop", 0.0))
        },
        "modulation_left": {f"{hertz:g} Hz": modulation_left(frames, hertz) for hertz in _MODULATIONS_HZ},
    }


def carrier_table(report: dict[str, Any]) -> str:
    """A Markdown table of one run: put those of two engines side by side."""
    medians = report["median_carriers_hz"].values()
    pooled, motion = report["distance_semitones"], report["distance_at_one_motion_semitones"]
    taps = report["taps_on_noise"]
    rows = [
        ("median carriers of the labels, Hz", f"{min(medians):.0f}-{max(medians):.0f}"),
        ("smallest / median distance of two labels, semitones", f"{pooled['smallest']:.1f} / {pooled['median']:.1f}"),
        (f"pairs of labels further apart than {JUST_NOTICEABLE_RATIO:.2f} in frequency", f"{pooled['pairs_apart']:.0%}"),
        ("the same at one speed and force", f"{motion['median']:.1f} semitones, {motion['pairs_apart']:.0%}"),
        ("amplitude step from frame to frame, p50 / p95, dB", "{p50:.1f} / {p95:.1f}".format(**report["step_db"])),
        ("tap on a texture: height, median / smallest, dB",
         f"{taps['peak_db']['median']:+.1f} / {taps['peak_db']['smallest']:+.1f}"),
        ("tap on a texture: delay, median / largest, ms",
         f"{taps['delay_ms']['median']:.1f} / {taps['delay_ms']['largest']:.1f}"),
    ]  # fmt: skip
    for name, delay in report["step_delay_ms"].items():
        rows.append((f"delay of a step of noise, {name}, p50 / p95, ms", f"{delay['p50']:.1f} / {delay['p95']:.1f}"))
    for hertz, left in report["modulation_left"].items():
        rows.append((f"modulation of {hertz} that is left", f"{left:.0%}"))
    return table(("figure", "value"), rows)


def label_table(report: dict[str, Any]) -> str:
    """A Markdown table of labels: carrier, steps, and the labels within a just noticeable difference."""
    steps = report["step_p95_db_by_label"]
    return table(
        ("label", "median carrier, Hz", "amplitude step p95, dB", "not told apart by carrier from"),
        [
            (label, f"{hertz:.0f}", f"{steps[label]:.1f}", ", ".join(report["alike"][label]) or "none")
            for label, hertz in sorted(report["median_carriers_hz"].items(), key=lambda item: item[1])
        ],
    )
