"""`haptoflow-paper evaluate`: measure accuracy and time of every row of the plan."""

from __future__ import annotations

import argparse
import hashlib
import datetime
import os
import sys
from pathlib import Path
from typing import Any

from tqdm import tqdm

from haptoflow_paper.rows.reference_conditions import conditions
from haptoflow_paper.rows.reference_set import CODEC_ROW, ReferencePair, reference_set
from haptoflow_paper.report.accuracy_time import annotate_model, machine_words, table, timed_rows, with_times
from haptoflow_paper.report.accuracy_time_chart import draw_chart, draw_spectra
from haptoflow_paper.report.accuracy_time_report import write_document
from haptoflow_paper.rows import accuracy
from haptoflow_paper.rows.accuracy import Yardstick
from haptoflow_paper.rows.row_plan import PlannedRow, load_plan
from haptoflow_paper.rows.row_runner import UPDATE_RATE_HZ, generator_of, made_from, measure_rows
from haptoflow_paper.rows.workplace import Workplace, stored_row, train_models
from haptoflow_paper.rows.untrained import make_untrained
from haptoflow_paper.rows.timing import TimedSource, append_run, published_run, time_sources, timing_run
from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.model_stamp import SHIPPED_MODEL, sha256_of
from haptoflow_training.recordings.synthetic import load_materials
from haptoflow_training.training.run_log import source_commit
from haptoflow_training.whole_file import write_json

_PACKAGE = Path(__file__).resolve().parents[1]
_ROOT = _PACKAGE.parents[1]
# Pages and report show it.
_CHART = _ROOT / "Documentation~" / "images" / "accuracy-time.png"


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Measures every row of the plan on held-out recordings: accuracy in open and closed loop, and milliseconds"
        " for a segment in the engine. Trains the models that rows need (about eight minutes of one core each), "
        "stores measured rows, and resumes after an interruption. A stored row is measured again only if its "
        "configuration or its model has changed; a network that is not on this machine is timed untrained. Every timing run is added to timing-history.json; the first "
        "complete one of the shipped model is published. `haptoflow-benchmark evaluate` compares a model of your "
        "own with its recordings."
    )
    parser.epilog = (
        "examples:\n"
        "  haptoflow-paper evaluate --quick        trained models only, on a quarter of the recordings\n"
        "  haptoflow-paper evaluate --rows plain-euler-1 standard\n"
    )
    parser.add_argument("--plan", type=Path, default=_PACKAGE / "configs" / "rows.toml")
    parser.add_argument("--rows", nargs="+", metavar="NAME", help="only these rows (default: all)")
    parser.add_argument("--quick", action="store_true", help="only rows marked quick; nothing is trained or published")
    parser.add_argument("--no-train", action="store_true", help="leave out rows whose models are not trained yet")
    parser.add_argument("--work", type=Path, default=_ROOT / "out" / "evaluate", help="folder for trainings and models")
    parser.add_argument(
        "--store", type=Path, default=_ROOT / "out" / "train" / "default" / "store", help="prepared recordings"
    )
    parser.add_argument(
        "--out", type=Path, default=_PACKAGE / "results", metavar="DIR",
        help="for accuracy-time.json and the measured rows (default: Training/haptoflow_paper/results)",
    )  # fmt: skip
    parser.add_argument("--document", type=Path, default=_PACKAGE / "results" / "accuracy-and-time.md")
    parser.add_argument("--lanes", type=int, default=os.cpu_count() or 1, help="trainings at a time (default: cores)")
    parser.add_argument(
        "--workers", type=int, default=os.cpu_count() or 1, help="processes that record and measure (default: cores)"
    )


def graphs_sha256(path: Path) -> str:
    """SHA-256 of a model file's graphs. The header is left out, because it holds figures measured with the model."""
    graphs = read_model_file(path).graphs
    return hashlib.sha256(b"".join(graphs[name] for name in sorted(graphs))).hexdigest()


def run(options: argparse.Namespace) -> int:
    plan = load_plan(options.plan)
    chosen = [row for row in plan if not options.rows or row.name in options.rows]
    if options.rows and len(chosen) != len(set(options.rows)):
        unknown = set(options.rows) - {row.name for row in plan}
        raise InputError(f"{options.plan}: no row {', '.join(sorted(unknown))}")
    if options.quick:
        chosen = [row for row in chosen if row.quick]
    place = Workplace(_ROOT, options.plan, options.work, options.store, options.out, options.quick)
    yardstick = accuracy.make_yardstick(_pairs(options))
    if not (options.quick or options.no_train):
        wanted = [(row, seed) for row in chosen for seed in place.seeds_of(row)]
        train_models(place, [entry for entry in wanted if not _is_stored(place, yardstick, *entry)], options.lanes)
    measured = _measured(place, yardstick, chosen, options.workers)
    if not options.quick:
        for row in plan:
            if row.name not in measured and (kept := _stored(place, yardstick, row)):
                measured[row.name] = kept
    timed = [row for row in chosen if not row.is_reference and row.name in measured]
    with tqdm(desc="untrained networks, to time them", unit="network") as bar:
        make_untrained(place, timed, options.lanes, lambda finished: bar.update(finished - bar.n))
    run = _time_rows(place, timed, options.quick, is_complete=not (options.rows or options.quick))
    if options.quick:
        _print(with_times(table(plan, measured), run))
        return 0
    _write(options, place, yardstick.pairs, plan, table(plan, measured), run)
    return 0


def _measured(
    place: Workplace, yardstick: Yardstick, rows: list[PlannedRow], workers: int
) -> dict[str, list[dict[str, Any]]]:
    """Figures of every row whose first seed can be measured, first seed first; prints which rows are left out."""
    wanted: list[tuple[PlannedRow, int]] = []
    for row in rows:
        seeds = [seed for seed in place.seeds_of(row) if _can_be_measured(place, yardstick, row, seed)]
        if row.seeds[0] in seeds:
            wanted += [(row, seed) for seed in seeds]
        else:
            named = row.model or str(place.codec_checkpoint)
            missing = f"{named} has no tier '{row.tier}'" if row.tier else f"{named} is not trained yet"
            tqdm.write(f"evaluate: {row.name} is left out: {missing}", file=sys.stderr)
    with tqdm(total=len(wanted), desc="rows and seeds", unit="row") as bar:
        figures = measure_rows(place, yardstick, wanted, workers, bar.update)
    measured: dict[str, list[dict[str, Any]]] = {}
    for row, seed in wanted:
        measured.setdefault(row.name, []).append(figures[row.name, seed])
    return measured


def _stored(place: Workplace, yardstick: Yardstick, row: PlannedRow) -> list[dict[str, Any]]:
    """The stored figures of a row that are still valid, first seed first; empty without the first seed."""
    found = [stored_row(place, row, seed, made_from(place, yardstick, row, seed)) for seed in place.seeds_of(row)]
    return [result for result in found if result is not None] if found and found[0] is not None else []


def _is_stored(place: Workplace, yardstick: Yardstick, row: PlannedRow, seed: int) -> bool:
    return stored_row(place, row, seed, made_from(place, yardstick, row, seed)) is not None


def _can_be_measured(place: Workplace, yardstick: Yardstick, row: PlannedRow, seed: int) -> bool:
    if row.name == CODEC_ROW:
        return place.codec_checkpoint.exists() or _is_stored(place, yardstick, row, seed)
    is_there = row.is_reference or _is_there(place.model_file(row, seed), row.tier)
    return is_there or _is_stored(place, yardstick, row, seed)


def _is_there(model: Path, tier: str) -> bool:
    if not model.exists():
        return False
    return not tier or any(entry["name"] == tier for entry in read_model_file(model).header["tiers"])


def _pairs(options: argparse.Namespace) -> list[ReferencePair]:
    with tqdm(total=len(conditions(load_materials())), desc="recordings", unit="recording") as bar:
        return reference_set(options.work / "reference.npz", options.workers, bar.update)


def _time_rows(place: Workplace, rows: list[PlannedRow], quick: bool, is_complete: bool) -> dict[str, Any]:
    """Time the rows; returns a run of the timing history."""
    before = os.getloadavg()
    untrained = [row.name for row in rows if place.timed_file(row) != place.model_file(row, row.seeds[0])]
    generators = [generator_of(place, row, place.timed_file(row)) for row in rows]
    sources = [TimedSource(row.name, generator) for row, generator in zip(rows, generators, strict=True)]
    blocks = 4 if quick else 10
    with tqdm(total=2 * blocks * len(rows), desc="times", unit="block") as bar:
        hot = time_sources(sources, blocks=blocks, runs_per_block=60, period_seconds=0.0, seed=5, advance=bar.update)
        paced = time_sources(
            sources, blocks=blocks, runs_per_block=30, period_seconds=1.0 / UPDATE_RATE_HZ, seed=6, advance=bar.update
        )
    for generator in generators:
        generator.close()
    return timing_run(
        hot, paced, date=datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        commit=source_commit(place.root), graphs_sha256=graphs_sha256(place.root / SHIPPED_MODEL),
        is_complete=is_complete, untrained=untrained, machine=machine_words(), load_before=before, load_after=os.getloadavg(),
    )  # fmt: skip


def _print(result: dict[str, Any]) -> None:
    names = (
        ("ms", 8), ("level dB", 10), ("p90", 7), ("GFC", 8), ("LSD dB", 8), ("crest", 7), ("ln kurt", 8), ("modul.", 7),
        ("ribs", 7), ("told %", 7),
    )  # fmt: skip
    print(f"{'row':24}" + "".join(f"{name:>{width}}" for name, width in names))
    for row in result["rows"]:
        hot = row["ms_per_segment"]
        print(
            f"{row['name']:24}{_shown(hot and hot['p50'], 8, 3)}{_shown(row.get('level_error_db'), 10, 2)}"
            f"{_shown(row.get('level_error_p90_db'), 7, 2)}{_shown(row.get('gfc_recording'), 8, 4)}"
            f"{_shown(row.get('lsd_db'), 8, 2)}{_shown(_median(row, 'crest_error_db'), 7, 2)}"
            f"{_shown(_median(row, 'kurtosis_log_ratio'), 8, 2)}{_shown(_median(row, 'modulation_error_db'), 7, 2)}"
            f"{_shown(_median(row, 'rib_modulation_error_db'), 7, 1)}{_shown(_median(row, 'told_apart_percent'), 7, 0)}"
        )


def _median(row: dict[str, Any], key: str) -> float | None:
    spread = row.get(key)
    return None if spread is None else float(spread["median"])


def _shown(value: float | None, width: int, digits: int) -> str:
    return " " * width if value is None else f"{value:{width}.{digits}f}"


def _write(
    options: argparse.Namespace,
    place: Workplace,
    pairs: list[ReferencePair],
    plan: list[PlannedRow],
    result: dict[str, Any],
    run: dict[str, Any],
) -> None:
    out = options.out / "accuracy-time.json"
    options.out.mkdir(parents=True, exist_ok=True)
    history = append_run(options.out / "timing-history.json", run)
    shipped = place.root / SHIPPED_MODEL
    result = with_times(result, published_run(history, graphs_sha256(shipped), timed_rows(result)))
    _print(result)
    # Annotate the file's own tiers first: that changes its bytes, and the figures must name the shipped file.
    _annotate(place, plan, result)
    result = {**result, "model_sha256": sha256_of(shipped), "model_bytes": shipped.stat().st_size}
    write_json(out, result)
    chart, spectra = _CHART, options.document.parent / "label-spectra.png"
    draw_chart(result, chart)
    standard = next((row for row in plan if row.extended and place.model_file(row, row.seeds[0]).exists()), None)
    if standard is not None:
        model = place.model_file(standard, standard.seeds[0])
        steady = [pair for pair in pairs if pair.condition.is_steady]
        with generator_of(place, standard, model) as generator:
            made = accuracy.generate_set(generator, steady, update_rate_hz=UPDATE_RATE_HZ, seed=31, open_loop=False)
        draw_spectra(steady, made.closed, spectra, sha256_of(model))
    write_document(result, options.document, chart, None if standard is None else spectra)
    print(f"evaluate: {out} and {options.document}")


def _annotate(place: Workplace, plan: list[PlannedRow], result: dict[str, Any]) -> None:
    """Write the tiers' figures into the shipped model."""
    measured = {row["name"]: row for row in result["rows"]}
    tiers = {row.tier: row for row in plan if row.tier and row.name in measured and row.model.endswith(".haptoflow")}
    for file in {row.model for row in tiers.values()}:
        rows = {tier: measured[row.name] for tier, row in tiers.items() if row.model == file}
        parity = place.root / "Tests" / "Golden" / "model" / "default.parity.json"
        annotate_model(place.root / file, result["machine"], rows, parity)
