"""`haptoflow-paper place`: whether a place of a surface feels the same twice, and what that costs in accuracy."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from tqdm import tqdm

from haptoflow_benchmark.engine_render import model_labels, read_recorded_strokes
from haptoflow_paper.studies.creeping import (
    CREEPING_LABELS, HOP_SAMPLES, creeping, hand_overs, held_silent, holds, recorder_without_noise
)
from haptoflow_paper.studies.place_study import Renderer, measure_likeness, steps_of
from haptoflow_paper.studies.place_report import accuracy_report, measure_cells, page_words, steady_pairs
from haptoflow_paper.rows.reference_set import reference_set
from haptoflow_training.model_stamp import read_measured_page, sha256_of, with_measured_words
from haptoflow_training.training.run_log import source_commit
from haptoflow_training.waveform import SAMPLE_RATE_HZ
from haptoflow_training.whole_file import check_writable, write_json, write_whole

_EXAMPLES = """examples:
  haptoflow-paper place --engine build/native/haptoflow \\
    --model Packages/com.haptoflow.runtime/Runtime/Models/default.haptoflow \\
    --baseline older/build/native/haptoflow --work work/place \\
    --strokes ../shared/strokes/vr-pen-on-surface/strokes.csv \\
    --results Training/haptoflow_paper/results/place.json --page Training/haptoflow_paper/results/place.md

Passes alone take a minute or two. With --work, the reference recordings are made there (some minutes, once) and
rendered from end to end by both engines.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Render passes over one place with the engine's command line: again, faster, slower, backwards, beside, on the "
        "moved object and on another one, and compare them over place. With --baseline and --work, compare the "
        "accuracy of both engines on the reference recordings."
    )
    parser.epilog = _EXAMPLES
    parser.add_argument("--engine", required=True, type=Path, help="built command line (build/native/haptoflow)")
    parser.add_argument("--model", required=True, type=Path, help="the .haptoflow file")
    parser.add_argument("--baseline", type=Path, help="an older command line, for the columns before")
    parser.add_argument("--work", type=Path, help="folder of the reference recordings; without it, no accuracy")
    parser.add_argument("--strokes", type=Path, help="CSV: stroke_id,t_s,x_m,y_m,z_m; its held pens must be silent")
    parser.add_argument("--labels", nargs="+", help="labels of the passes (default: all)")
    parser.add_argument("--workers", type=int, default=2, help="renders at a time (default 2)")
    parser.add_argument("--results", required=True, type=Path, help="JSON file to write")
    parser.add_argument("--page", type=Path, help="page whose measured part is replaced")


def run(options: argparse.Namespace) -> int:
    for place in (options.results, options.page):
        if place is not None:
            check_writable(place)
    page = None if options.page is None else read_measured_page(options.page)
    labels = options.labels or model_labels(options.engine, options.model)
    engines = [each for each in (options.engine, options.baseline) if each is not None]
    renderers = [Renderer(each, options.model) for each in engines]
    with tqdm(total=steps_of(labels, len(engines)), unit="label") as bar:
        found = measure_likeness(
            renderers[0], renderers[1] if len(renderers) > 1 else None, labels, options.workers, lambda: bar.update(1)
        )
    results = {
        "commit": source_commit(Path(__file__).parent),
        "model_sha256": sha256_of(options.model),
        "likeness": found,
    }
    results["creeping"] = {
        label: {"now": creeping(renderers[0], label), "recorder": recorder_without_noise(label)}
        for label in tqdm(CREEPING_LABELS, unit="label", desc="creeping")
    }
    results["hand_overs"] = {
        label: [hand_overs(replace(each, update_rate_hz=SAMPLE_RATE_HZ / HOP_SAMPLES), label) for each in renderers]
        for label in tqdm(labels, unit="label", desc="hand-overs")
    }
    if options.strokes is not None:
        results["held"] = held_silent(renderers[0], holds(read_recorded_strokes(options.strokes)))
    if options.work is not None:
        results["accuracy"] = _accuracy(options, engines)
    write_json(options.results, results)
    words = page_words(results)
    if options.page is not None and page is not None:
        write_whole(options.page, with_measured_words(page, words).encode())
    print(words)
    return 0


def _accuracy(options: argparse.Namespace, engines: list[Path]) -> dict[str, object]:
    with tqdm(unit="recording", desc="reference recordings") as bar:
        pairs = steady_pairs(reference_set(options.work / "reference.npz", options.workers, bar.update))
    with tqdm(total=len(pairs) * len(engines), unit="render") as bar:
        cells = [
            measure_cells(engine, options.model, pairs, options.workers, lambda: bar.update(1)) for engine in engines
        ]
    return accuracy_report(cells[0], cells[1] if len(cells) > 1 else None)
