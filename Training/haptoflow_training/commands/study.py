"""`haptoflow-training study`: the two user studies, from simulated participants to the report."""

from __future__ import annotations

import argparse

from haptoflow_training.commands import (
    study_analyse,
    study_budget,
    study_check,
    study_golden,
    study_merge,
    study_power,
    study_simulate,
    study_validate,
)

_STEPS = {
    "simulate": (study_simulate, "write the logs of simulated participants"),
    "check": (study_check, "list broken, missing and duplicate logs of a folder"),
    "merge": (study_merge, "write all sessions of a study as one table"),
    "analyse": (study_analyse, "write the report of a folder of logs"),
    "power": (study_power, "estimate the power of a planned number of participants"),
    "validate": (study_validate, "analyse simulated studies with known results"),
    "budget": (study_budget, "add up the parts of the delay beside the thresholds of the paper"),
    "golden": (study_golden, "write the plans that the Unity package must agree with"),
}


def register(subparsers: argparse._SubParsersAction[argparse.ArgumentParser], summary: str) -> None:
    parser = subparsers.add_parser(
        "study",
        help=summary,
        description="Logs of the delay tolerance study and of the similarity study: simulate, check, merge, analyse.",
        epilog="`haptoflow-training study STEP --help` explains one step with examples.",
    )
    steps = parser.add_subparsers(dest="step", required=True, metavar="STEP")
    for name, (module, words) in _STEPS.items():
        module.register(steps.add_parser(name, help=words, formatter_class=argparse.RawDescriptionHelpFormatter))
