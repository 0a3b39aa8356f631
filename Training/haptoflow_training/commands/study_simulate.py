"""`haptoflow-training study simulate`: write the logs of simulated participants."""

from __future__ import annotations

import argparse
from pathlib import Path

from tqdm import tqdm

from haptoflow_training.errors import InputError
from haptoflow_training.studies.log_columns import LATENCY, STUDIES
from haptoflow_training.studies.simulated_participants import MATERIALS, METHODS, PLANNED_DZ, planted
from haptoflow_training.studies.simulation import simulate_latency, simulate_similarity

_EXAMPLES = f"""examples:
  haptoflow-training study simulate --study latency --participants 24 --seed 1 --out simulated
  haptoflow-training study simulate --study similarity --participants 24 --seed 1 --difference 0 --out no-difference

Answers to delays follow the paper's two curves. Ratings are alike but for the last method, which is rated lower on
every second material by --difference standard deviations of the differences (Cohen's d_z; the paper planned with
{PLANNED_DZ}).
Every file says that it is simulated, and real and simulated logs are never analysed together.
"""


def register(parser: argparse.ArgumentParser) -> None:
    parser.description = "Write the logs of a study with simulated participants, to try the analysis or a plan."
    parser.epilog = _EXAMPLES
    parser.add_argument("--study", required=True, choices=STUDIES)
    parser.add_argument("--participants", type=int, default=24, help="1 to 999 (default 24)")
    parser.add_argument("--seed", type=int, default=1, help="of plans and answers, 0 or more (default 1)")
    parser.add_argument("--difference", type=float, default=PLANNED_DZ, help="similarity only: 0 to 5 (default 0.67)")
    parser.add_argument("--out", required=True, type=Path, help="folder to write into")
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    if not 1 <= options.participants <= 999:
        raise InputError(f"--participants {options.participants}: expected 1 to 999")
    if not 0 <= options.seed < 1 << 64:
        raise InputError(f"--seed {options.seed}: expected 0 to 2^64 - 1")
    if not 0.0 <= options.difference <= 5.0:
        raise InputError(f"--difference {options.difference:g}: expected 0 to 5")
    with tqdm(total=options.participants, unit="participant", disable=None) as progress:
        if options.study == LATENCY:
            simulate_latency(options.out, options.participants, options.seed, advance=progress.update)
        else:
            model = planted(MATERIALS, METHODS, options.difference)
            simulate_similarity(options.out, options.participants, options.seed, model, advance=progress.update)
    print(f"{options.out}: {options.participants} simulated participants of the {options.study} study")
    return 0
