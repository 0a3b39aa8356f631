"""The files of a run beside its weights: metrics as CSV, their plot, configuration and provenance."""

from __future__ import annotations

import csv
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any


def source_commit(folder: Path) -> str:
    """The commit of the source tree, with `+changes` if it is not clean; `unknown` outside git."""
    try:
        commit = subprocess.run(
            ["git", "rev-parse", "HEAD"], cwd=folder, capture_output=True, text=True, check=True
        ).stdout.strip()
        changes = subprocess.run(
            ["git", "status", "--porcelain", "--untracked-files=no"],
            cwd=folder,
            capture_output=True,
            text=True,
            check=True,
        ).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return commit + ("+changes" if changes else "")


class MetricsLog:
    """Appends rows to metrics.csv; a resumed run drops the rows after its checkpoint."""

    def __init__(self, path: Path, columns: tuple[str, ...], keep_until_step: int) -> None:
        self._path, self._columns = path, columns
        rows: list[dict[str, str]] = []
        if path.exists():
            with path.open(newline="", encoding="utf-8") as file:
                rows = [row for row in csv.DictReader(file) if int(row["step"]) <= keep_until_step]
        with path.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, columns, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)

    def append(self, row: Mapping[str, Any]) -> None:
        with self._path.open("a", newline="", encoding="utf-8") as file:
            csv.DictWriter(file, self._columns, lineterminator="\n").writerow(
                {key: f"{value:.6g}" if isinstance(value, float) else value for key, value in row.items()}
            )

    def rows(self) -> list[dict[str, str]]:
        with self._path.open(newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))


def last_step(path: Path) -> int:
    """The step of the last complete row of a metrics.csv; 0 if there is none."""
    try:
        rows = path.read_text(encoding="utf-8").splitlines()[1:]
    except OSError:
        return 0
    steps = [row.split(",", 1)[0] for row in rows]
    return max((int(step) for step in steps if step.isdigit()), default=0)


def plot_metrics(log: MetricsLog, path: Path) -> None:
    """Plot every figure of the log over the steps, one panel a figure."""
    from matplotlib.figure import Figure

    rows = log.rows()
    if not rows:
        return
    names = [name for name in rows[0] if name not in ("step", "phase", "seconds")]
    figure = Figure(figsize=(4.2 * len(names), 3.2))
    axes = figure.subplots(1, len(names), squeeze=False)
    for axis, name in zip(axes[0], names, strict=True):
        points = [(int(row["step"]), float(row[name])) for row in rows if row[name] not in ("", "nan")]
        if points:
            axis.plot(*zip(*points, strict=True), linewidth=1.0)
            values = [value for _, value in points]
            if 0.0 < min(values) and max(values) > 50.0 * min(values):
                axis.set_yscale("log")
        axis.set_title(name.replace("_", " "))
        axis.set_xlabel("step")
        axis.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(path, dpi=100)
