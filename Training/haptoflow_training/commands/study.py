"""`haptoflow-training study`: the two user studies, from simulated participants to the report.

What computes is imported by the step that needs it.
"""

from __future__ import annotations

import argparse
import json
import math
import os
from pathlib import Path

from tqdm import tqdm

from haptoflow_training.errors import InputError
from haptoflow_training.model_stamp import read_measured_page, with_measured_words
from haptoflow_training.studies.plans import golden_text
from haptoflow_training.studies.log_table import LATENCY, SIMILARITY, STUDIES
from haptoflow_training.studies.session_file import merged_csv, read_faultless, read_folder
from haptoflow_training.studies.simulation import (
    MATERIALS, METHODS, PLANNED_DZ, latency_power, planned_signed_rank_power, planted, rating_power, simulate_latency,
    simulate_similarity
)
from haptoflow_training.whole_file import write_whole

_PUBLISHED = Path("Training") / "results" / "benchmarks.md"


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = "Logs of the delay tolerance study and of the similarity study: simulate, check, merge, analyse."
    parser.epilog = "`haptoflow-training study STEP --help` explains one step with examples."
    parser.formatter_class = argparse.HelpFormatter
    steps = parser.add_subparsers(dest="step", required=True, metavar="STEP")
    for name, (add_step, words) in _STEPS.items():
        add_step(steps.add_parser(name, help=words, formatter_class=argparse.RawDescriptionHelpFormatter))


def _add_simulate(parser: argparse.ArgumentParser) -> None:
    parser.description = "Write the logs of a study with simulated participants, to try the analysis or a plan."
    parser.epilog = f"""examples:
  haptoflow-training study simulate --study latency --participants 24 --seed 1 --out simulated
  haptoflow-training study simulate --study similarity --participants 24 --seed 1 --difference 0 --out no-difference

Answers to delays follow the paper's two curves. Ratings are alike but for the last method, which is rated lower on
every second material by --difference standard deviations of the differences (Cohen's d_z; the paper planned with
{PLANNED_DZ}).
Every file says that it is simulated, and real and simulated logs are never analysed together.
"""
    parser.add_argument("--study", required=True, choices=STUDIES)
    parser.add_argument("--participants", type=int, default=24, help="1 to 999 (default 24)")
    parser.add_argument("--seed", type=int, default=1, help="of plans and answers, 0 or more (default 1)")
    parser.add_argument("--difference", type=float, default=PLANNED_DZ, help="similarity only: 0 to 5 (default 0.67)")
    parser.add_argument("--out", required=True, type=Path, help="folder to write into")
    parser.set_defaults(run=_simulate)


def _simulate(options: argparse.Namespace) -> int:
    _require_range("--participants", options.participants, 1, 999)
    if not 0 <= options.seed < 1 << 64:
        raise InputError(f"--seed {options.seed}: expected 0 to 2^64 - 1")
    _require_range("--difference", options.difference, 0, 5)
    with tqdm(total=options.participants, unit="participant", disable=None) as progress:
        if options.study == LATENCY:
            simulate_latency(options.out, options.participants, options.seed, advance=progress.update)
        else:
            model = planted(MATERIALS, METHODS, options.difference)
            simulate_similarity(options.out, options.participants, options.seed, model, advance=progress.update)
    print(f"{options.out}: {options.participants} simulated participants of the {options.study} study")
    return 0


def _add_check(parser: argparse.ArgumentParser) -> None:
    parser.description = "Read every session below a folder and list what is broken, missing or duplicate."
    parser.epilog = """examples:
  haptoflow-training study check logs

Every problem is a line that names file, row and column. The exit code is 0 without problems, 3 with some.
"""
    parser.add_argument("folder", type=Path, help="with the logs, in folders of their own or not")
    parser.set_defaults(run=_check)


def _check(options: argparse.Namespace) -> int:
    read = read_folder(options.folder)
    for problem in read.problems:
        print(problem)
    for note in read.notes:
        print(f"note: {note}")
    for study in STUDIES:
        sessions = read.of(study)
        if sessions:
            simulated = sum(session.is_simulated for session in sessions)
            trials = sum(len(session.rows) for session in sessions)
            print(f"{study}: {len(sessions)} sessions, {simulated} of them simulated, {trials} answered trials")
    print(f"{len(read.problems)} problem{'' if len(read.problems) == 1 else 's'}")
    return 3 if read.problems else 0


def _add_merge(parser: argparse.ArgumentParser) -> None:
    parser.description = "Write all sessions of a study as one table, a row an answered trial, practice included."
    parser.epilog = """examples:
  haptoflow-training study merge logs --out tables

writes tables/latency.csv and tables/similarity.csv, as far as there are sessions, for a statistics program of your own.
"""
    parser.add_argument("folder", type=Path, help="with the logs")
    parser.add_argument("--out", required=True, type=Path, help="another folder, for the tables")
    parser.set_defaults(run=_merge)


def _merge(options: argparse.Namespace) -> int:
    folder, out = options.folder.resolve(), options.out.resolve()
    if out == folder or folder in out.parents:
        raise InputError(f"{options.out}: lies in the folder of the logs, where only logs may be; name another folder")
    read = read_faultless(options.folder)
    for study in STUDIES:
        sessions = read.of(study)
        if sessions:
            path = options.out / f"{study}.csv"
            write_whole(path, merged_csv(study, sessions).encode())
            print(f"{path}: {len(sessions)} sessions, {sum(len(session.rows) for session in sessions)} trials")
    for note in read.notes:
        print(f"note: {note}")
    return 0


def _add_analyse(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Fit the psychometric curves, test the ratings, and write one report for the studies whose logs a folder holds."
    )
    parser.epilog = """examples:
  haptoflow-training study analyse logs --out report.html
  haptoflow-training study analyse logs --out report.html --results results.json

The report is one file with its figures inside. Logs with a problem are refused; `study check` names all problems.
"""
    parser.add_argument("folder", type=Path, help="with the logs")
    parser.add_argument("--out", required=True, type=Path, help="HTML file to write")
    parser.add_argument("--results", type=Path, help="JSON file with the same figures, for programs")
    parser.add_argument("--seed", type=int, default=0, help="of the resamples, 0 or more (default 0)")
    parser.set_defaults(run=_analyse)


def _analyse(options: argparse.Namespace) -> int:
    from haptoflow_training.studies.analysis import (
        MINIMUM_PARTICIPANTS, analyse_latency, analyse_similarity, too_few_words
    )
    from haptoflow_training.studies.report import Analysed, report, results

    _require_range("--seed", options.seed, 0)
    for out in (options.out, options.results):
        if out is not None and options.folder.resolve() in out.resolve().parents and out.suffix in (".csv", ".json"):
            raise InputError(f"{out}: lies in the folder of the logs, where only logs may be; expected another folder")
    read = read_faultless(options.folder)
    latency, similarity = read.of(LATENCY), read.of(SIMILARITY)
    # A pilot of the one study does not keep back the report of the other.
    is_pilot = bool(latency) and 0 < len(similarity) < MINIMUM_PARTICIPANTS
    analysed = Analysed(
        [*latency, *similarity],
        read.notes,
        analyse_latency(latency, seed=options.seed) if latency else None,
        analyse_similarity(similarity) if similarity and not is_pilot else None,
        too_few_words(len(similarity)) if is_pilot else "",
    )
    write_whole(options.out, report(analysed).encode())
    if options.results is not None:
        write_whole(options.results, (json.dumps(results(analysed), indent=1) + "\n").encode())
    kind = "simulated" if analysed.is_simulated else "real"
    counts = f"{len(latency)} {kind} sessions of the latency study, {len(similarity)} of the similarity study"
    print(f"{options.out}: {counts}")
    return 0


def _add_power(parser: argparse.ArgumentParser) -> None:
    parser.description = "Simulate many studies of a planned size and count what the whole analysis finds in them."
    parser.epilog = """examples:
  haptoflow-training study power --study similarity --participants 24 --methods 4 --difference 0.67
  haptoflow-training study power --study latency --participants 24

A similarity study is one material whose last method is rated lower than all others, which are alike, by --difference
standard deviations of the differences (Cohen's d_z). A latency study follows the paper's two curves. Every figure
stands with the interval of 95 % that so many simulations allow.
"""
    parser.add_argument("--study", required=True, choices=STUDIES)
    parser.add_argument("--participants", type=int, default=24, help="5 to 999 (default 24)")
    parser.add_argument("--methods", type=int, default=4, help="similarity only: 2 to 6 (default 4)")
    parser.add_argument("--difference", type=float, default=0.67, help="similarity only: d_z, 0 to 5 (default 0.67)")
    parser.add_argument(
        "--equivalence-points", type=float, default=0.5, metavar="POINTS",
        help="similarity only: differences below it count as equal, in points of rating, 0.1 to 6 (default 0.5)",
    )  # fmt: skip
    parser.add_argument("--simulations", type=int, default=500, help="studies, 10 to 100000 (default 500)")
    parser.add_argument("--seed", type=int, default=1, help="0 or more (default 1)")
    parser.set_defaults(run=_power)


def _power(options: argparse.Namespace) -> int:
    _require_range("--participants", options.participants, 5, 999)
    _require_range("--methods", options.methods, 2, 6)
    _require_range("--difference", options.difference, 0, 5)
    _require_range("--equivalence-points", options.equivalence_points, 0.1, 6)
    _require_range("--simulations", options.simulations, 10, 100_000)
    _require_range("--seed", options.seed, 0)
    return _latency_power(options) if options.study == LATENCY else _rating_power(options)


def _rating_power(options: argparse.Namespace) -> int:
    with tqdm(total=options.simulations, unit="study", disable=None) as progress:
        found = rating_power(
            options.participants, options.methods, options.difference,
            simulations=options.simulations, seed=options.seed, bound=options.equivalence_points,
            advance=progress.update,
        )  # fmt: skip
    planned = planned_signed_rank_power(options.participants, options.difference)
    print(f"{options.participants} participants, {options.methods} methods, d_z {options.difference:g}:")
    if options.methods > 2:
        print(f"  Friedman's test finds a difference in        {found.friedman}")
    print(f"  the pair of first and last method differs in {found.pair}, after correction")
    print(f"  that pair tested alone differs in            {found.pair_alone}")
    print(f"  planned for it by the formula, not rounded:  {100 * planned:.1f} %")
    if found.equivalence is not None:
        print(f"  methods that are alike differ in             {found.false_pair}")
        within = f"within {options.equivalence_points:g} points"
        print(f"  the first two methods are equivalent in      {found.equivalence}, {within}, after correction")
    return 0


def _latency_power(options: argparse.Namespace) -> int:
    with tqdm(total=options.simulations, unit="study", disable=None) as progress:
        found = latency_power(
            options.participants, simulations=options.simulations, seed=options.seed, advance=progress.update
        )
    print(f"{options.participants} participants:")
    for condition, width in found.widths_ms.items():
        covered = found.covered[condition]
        print(f"  {condition}: the threshold's interval is {width:.1f} ms wide and holds the truth in {covered}")
    print(f"  the thresholds differ in {found.differ}")
    if found.without_interval:
        print(f"  {found.without_interval} of {options.simulations} studies have no interval")
    return 0


def _add_budget(parser: argparse.ArgumentParser) -> None:
    parser.description = "Add up pose interval, inference, audio block and device, beside the thresholds of the paper."
    parser.epilog = """examples:
  haptoflow-training study budget
  haptoflow-training study budget --bench out/bench.json --device-ms 25
  haptoflow-training study budget --page Training/results/delay-budget.md --chart Documentation~/images/delay-budget.png

The first reads the tables of Training/results/benchmarks.md, the second those of `npm run bench` on this machine with a
device delay that you measured. The third writes the page anew after `npm run bench -- --publish`.
"""
    parser.add_argument("--bench", type=Path, default=_PUBLISHED, help="bench.json, or the page that publishes it")
    parser.add_argument("--device-ms", type=float, help="from the audio callback to the hand, as you measured it")
    parser.add_argument("--page", type=Path, help="page whose measured part is written anew")
    parser.add_argument("--chart", type=Path, help="PNG file to write")
    parser.set_defaults(run=_budget)


def _budget(options: argparse.Namespace) -> int:
    from haptoflow_training.studies.delay_budget import page_words, read_bench, write_chart

    if options.device_ms is not None:
        _require_range("--device-ms", options.device_ms, 0, 1000)
    bench = read_bench(options.bench)
    if "standard" not in bench.inference_ms:
        raise InputError(f"{options.bench}: no quality 'standard'; expected the benchmark of the shipped model")
    chart = options.chart
    if options.page is not None and chart is None:
        chart = options.page.parent / "images" / "delay-budget.png"
    address = "" if chart is None else Path(os.path.relpath(chart, (options.page or chart).parent)).as_posix()
    words = page_words(bench, address, options.device_ms)
    if options.page is not None:
        write_whole(options.page, with_measured_words(read_measured_page(options.page), words).encode())
    if chart is not None:
        write_chart(chart, bench, options.device_ms)
    print(words)
    return 0


def _add_golden(parser: argparse.ArgumentParser) -> None:
    parser.description = "Write plans of several participants, seeds and sizes, which the Unity package must reproduce."
    parser.epilog = """examples:
  haptoflow-training study golden --out Tests/Golden/studies/plans.json

Write it anew only when the plans are meant to change, because participants' numbers then mean other orders.
"""
    parser.add_argument("--out", required=True, type=Path, help="JSON file to write")
    parser.set_defaults(run=_golden)


def _golden(options: argparse.Namespace) -> int:
    write_whole(options.out, golden_text().encode())
    print(f"{options.out}: written")
    return 0


def _require_range(name: str, value: float, lowest: float, highest: float = math.inf) -> None:
    if not lowest <= value <= highest:
        expected = f"{lowest:g} or more" if math.isinf(highest) else f"{lowest:g} to {highest:g}"
        raise InputError(f"{name} {value:.10g}: expected {expected}")


_STEPS = {
    "simulate": (_add_simulate, "write the logs of simulated participants"),
    "check": (_add_check, "list broken, missing and duplicate logs of a folder"),
    "merge": (_add_merge, "write all sessions of a study as one table"),
    "analyse": (_add_analyse, "write the report of a folder of logs"),
    "power": (_add_power, "estimate the power of a planned number of participants"),
    "budget": (_add_budget, "add up the parts of the delay beside the thresholds of the paper"),
    "golden": (_add_golden, "write the plans that the Unity package must agree with"),
}
