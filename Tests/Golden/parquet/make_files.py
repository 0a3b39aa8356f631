"""Makes the Parquet files beside this: by Apache's C++ library (Program.cs) and by DuckDB (duckdb.mjs).

PYTHONPATH=Training:Tests/Training python3 Tests/Golden/parquet/make_files.py FOLDER
FOLDER lies outside the repository and holds node_modules/@duckdb/node-api 1.5.6-r.1; dotnet with SDK 10 is on PATH.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas
from parquet_samples import COLUMNS, GOLDEN, HUB_FILES, HUB_NAMES, column_table, hub_recording, hub_tables

from haptoflow_training.recordings.dataset_layout import TextureEntry, write_texture_list

ROWS, GROUP_ROWS, FEW_ROWS = 3000, 700, 200
CODECS = ("Uncompressed", "Snappy", "Gzip", "Brotli", "Zstd", "Lz4Hadoop")
_TYPES = {"int64": "int64", "int32": "int32", "float32": "float", "float64": "double"}
_SQL_TYPES = {"int64": "BIGINT", "int32": "INTEGER", "float32": "FLOAT", "float64": "DOUBLE"}


def main() -> None:
    work = Path(sys.argv[1]).resolve()
    (work / "csv").mkdir(exist_ok=True)
    for folder in (COLUMNS, HUB_FILES):
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
    write_with_apache(work)
    write_with_duckdb(work)


def write_with_apache(work: Path) -> None:
    jobs = []

    def add(table: pandas.DataFrame, target: Path, codec: str, group_rows: int) -> None:
        target.parent.mkdir(parents=True, exist_ok=True)
        source = work / "csv" / f"{len(jobs)}.csv"
        write_typed(table, source, "?")
        jobs.append(f"{source}\t{target}\t{codec}\t{group_rows}\n")

    add(column_table(ROWS), COLUMNS / "row-groups.parquet", "Snappy", GROUP_ROWS)
    for codec in CODECS:
        add(column_table(FEW_ROWS), COLUMNS / f"codec-{codec.lower()}.parquet", codec, FEW_ROWS)
    stamped = column_table(FEW_ROWS)[["time_ns", "X"]].astype({"time_ns": object})
    stamped.loc[3, "time_ns"] = None
    add(stamped, COLUMNS / "missing-time.parquet", "Snappy", FEW_ROWS)
    add(pandas.DataFrame({"time_ns": [1, 2], "X": ["rough", "soft"]}), COLUMNS / "text.parquet", "Snappy", 9)
    add(own_table(), COLUMNS / "own.parquet", "Snappy", 9999)
    for number, name in enumerate(HUB_NAMES):
        for kind, table in hub_tables(hub_recording(name)).items():
            target = HUB_FILES / f"{kind}_{name}.parquet"
            add(table, target, "Snappy" if number == 0 else "Zstd", 1000 if number == 1 else 1 << 20)
    names = {0: "Nyatoh", 38: "Granite", 49: "HDPE"}
    write_texture_list(HUB_FILES, [TextureEntry(texture, name, {}) for texture, name in names.items()])
    (work / "jobs.txt").write_text("".join(jobs), encoding="utf-8")
    project = work / "writer"
    shutil.rmtree(project, ignore_errors=True)
    project.mkdir()
    for name in ("Program.cs", "writer.csproj"):
        shutil.copy(GOLDEN / name, project)
    subprocess.run(["dotnet", "run", "--project", str(project), "--", str(work / "jobs.txt")], check=True)


def own_table() -> pandas.DataFrame:
    """A recording of one's own (own-materials.md), one axis, 2 s at 2 kHz, with a column of text."""
    row = np.arange(4000)
    return pandas.DataFrame(
        {
            "time_s": row / 2000,
            "acceleration_mps2": (((row * 37) % 101 - 50) / 25).astype(np.float32),
            "speed_mmps": np.full(4000, 80.0),
            "force_newtons": np.full(4000, 1.0),
            "remark": ["slow"] * 4000,
        }
    )


def write_typed(table: pandas.DataFrame, path: Path, optional: str) -> None:
    names = []
    for name, dtype in table.dtypes.items():
        known = _TYPES.get(str(dtype)) or ("int64" if name == "time_ns" else "text")
        names.append(f"{name}:{known}" + ("" if known == "text" or known == "int32" else optional))
    text = table.to_csv(index=False, header=False, na_rep="")
    path.write_text(",".join(names) + "\n" + text, encoding="utf-8")


def write_with_duckdb(work: Path) -> None:
    table = column_table(ROWS)
    table.to_csv(work / "csv" / "duckdb.csv", index=False, na_rep="")
    types = ", ".join(f"'{name}': '{_SQL_TYPES[str(dtype)]}'" for name, dtype in table.dtypes.items())
    read = f"read_csv('{work / 'csv' / 'duckdb.csv'}', header = true, columns = {{{types}}})"
    nested = f"SELECT *, {{'x': X, 'deep': {{'y': Y}}}} AS tip, [X, Y] AS pair, true AS touched, " \
        f"make_timestamp_ns(time_ns) AS clock, count::DECIMAL(6, 2) / 4 AS quarter FROM {read}"
    write = "COPY ({}) TO '{}' (FORMAT parquet, ROW_GROUP_SIZE 2048, CODEC '{}', PARQUET_VERSION {})"
    statements = [
        write.format(nested, COLUMNS / "nested-v1.parquet", "snappy", "v1"),
        write.format(nested, COLUMNS / "nested-v2.parquet", "zstd", "v2"),
    ]
    (work / "statements.sql").write_text(";\n".join(statements), encoding="utf-8")
    subprocess.run(["node", str(GOLDEN / "duckdb.mjs"), str(work / "statements.sql")], cwd=work, check=True)


main()
