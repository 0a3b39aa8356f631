"""`haptoflow-training add-material`: fit a new material to seconds of recording, as a file of its own or as a
further label."""

from __future__ import annotations

import argparse
import json
import math
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tqdm import tqdm

from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import read_model_file, require_new_name, with_label, write_model_file
from haptoflow_training.export.learning import DEFAULT_SECONDS_LIMIT, joined, learn_material
from haptoflow_training.preprocessing.pipeline import preprocess_parts
from haptoflow_training.recordings.dataset import UNKNOWN
from haptoflow_training.recordings.native_recording import MaterialRecording
from haptoflow_training.recordings.open_recordings import RecordingFile, open_recordings
from haptoflow_training.recordings.own_files import open_own, read_own
from haptoflow_training.whole_file import check_writable, write_whole

SUFFIX = ".haptomaterial"

_EXAMPLES = """examples:
  haptoflow-training add-material --model default.haptoflow --recording doormat.csv
      writes doormat.haptomaterial: scenes, the command line and Unity use it together with default.haptoflow
  haptoflow-training add-material --model default.haptoflow --recording slow.wav fast.wav --name mat -o mine.haptoflow
      writes a model file with a further label
  haptoflow-training add-material --model default.haptoflow --recording rack.csv --wave-vector 0.8 0 --name rack
      ribs 1.25 mm apart, across the recording's first axis

At least 10 s are recommended: slow and fast slides, 20 to 200 mm/s, light and firm. Ribs are estimated; a ruled
material's first axis is put across its clearest ribs. Takes about eight seconds of one core. `haptoflow learn` does the
same for one recording.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Fit the embedding, level and tone of one material to its recordings; for a model without a skeleton, seeds, too. "
        "The networks of the model and all of its labels stay as they are."
    )
    parser.epilog = _EXAMPLES
    parser.add_argument("--model", required=True, type=Path, help=".haptoflow file")
    parser.add_argument(
        "--recording", required=True, nargs="+", type=Path, metavar="FILE",
        help="recordings of one material, or a folder",
    )
    parser.add_argument("--name", help="of the material (default: the recordings' label, or the first file's name)")
    parser.add_argument(
        "-o", "--out", type=Path,
        help=f"NAME{SUFFIX} (default, from --name or the first file's name) writes a material file, NAME.haptoflow a "
        "model file",
    )  # fmt: skip
    parser.add_argument("--category", default="", help="for example cloth (default: the start label's)")
    parser.add_argument("--description", default="", help="one or two sentences")
    parser.add_argument(
        "--wave-vector", nargs=2, type=float, action="append", metavar=("X", "Y"),
        help="ribs in cycles per millimetre along the recording's axes, at most twice (default: estimated); 0 0: none",
    )  # fmt: skip
    parser.add_argument("--seed", type=int, default=1, help="the same seed gives the same material (default 1)")
    parser.add_argument(
        "--seconds-limit", type=float, default=DEFAULT_SECONDS_LIMIT,
        help=f"stop fitting after this many seconds (default {DEFAULT_SECONDS_LIMIT:g}); a fit that is not stopped gives "
        "the same result on every run",
    )  # fmt: skip


def run(options: argparse.Namespace) -> int:
    out = _default_out(options) if options.out is None else options.out
    if out.suffix not in (SUFFIX, ".haptoflow"):
        raise InputError(f"{out}: expected a name that ends in {SUFFIX} or .haptoflow")
    if not 0.0 < options.seconds_limit <= 3600.0:
        raise InputError(f"--seconds-limit {options.seconds_limit:g}: expected above 0 to 3600")
    wave_vectors = _wave_vectors(options.wave_vector)
    files = material_files(options.recording)
    # One file is learnt as `haptoflow learn` does it, byte for byte; several are joined as training prepares them.
    is_one_file = len(options.recording) == 1 and options.recording[0].is_file()
    read = read_own(options.recording[0]) if is_one_file else None
    name = _name(options, files, read.material_name if read else None)
    model = read_model_file(options.model)
    if out.suffix != SUFFIX:
        require_new_name(model, name)
    check_writable(out)
    for note in read.notes if read else ():
        _tell(note)
    licence, origin = _origin(options.recording, files)
    recording = open_own(options.recording[0]) if read else joined(read_material_recordings(files), origin)
    with tqdm(total=100, desc=name, unit="%", disable=None) as progress:
        text, report = learn_material(
            options.model,
            recording,
            name,
            category=options.category,
            description=options.description,
            licence=licence,
            seed=options.seed,
            seconds_limit=options.seconds_limit,
            wave_vectors_per_mm=wave_vectors,
            progress=lambda share, _: progress.update(round(100.0 * share) - progress.n) and None,
        )
    if out.suffix == SUFFIX:
        write_whole(out, text.encode())
    else:
        write_model_file(out, with_label(model, json.loads(text)))
    _report(out, name, report)
    return 0


def _tell(line: str) -> None:
    print(line, file=sys.stderr)


def material_files(paths: Sequence[Path]) -> list[RecordingFile]:
    """Every recording in files and folders (own files, or the published data set's layout), described and not yet read.

    Says which recordings of a folder cannot be used. InputError, naming file, column or key, what was found and what is
    expected, if a file that was named itself cannot be used, or if nothing can.
    """
    files: list[RecordingFile] = []
    for path in paths:
        dataset = open_recordings(path)
        found = (*dataset.recordings, *dataset.unlabelled)
        for problem in dataset.problems:
            if not found:
                raise InputError(str(problem))
            _tell(f"skipped: {problem}")
        files += found
    if not files:
        raise InputError(f"{', '.join(map(str, paths))}: no recording; expected .csv, .parquet or .wav files")
    return files


def read_material_recordings(files: Sequence[RecordingFile]) -> list[MaterialRecording]:
    """The samples of recordings, prepared as for training. Says which cannot be used, and what the reader ignored or
    corrected. InputError if none can be used."""
    recordings: list[MaterialRecording] = []
    for entry in files:
        try:
            read = entry.load()
            parts = preprocess_parts(read)
        except InputError as error:
            if len(files) == 1:
                raise
            _tell(f"skipped: {error}")
            continue
        for note in read.notes:
            _tell(note)
        recordings += [MaterialRecording(part.waveform_mps2, part.motion) for part in parts]
    if not recordings:
        raise InputError("no recording could be used")
    return recordings


def _name(options: argparse.Namespace, files: Sequence[RecordingFile], of_one_file: str | None) -> str:
    if options.name is not None:
        if not options.name.strip():
            raise InputError("--name is empty; expected a name such as doormat")
        return str(options.name.strip().lower())
    if of_one_file is not None:
        return of_one_file
    labels = sorted({file.label for file in files if file.label})
    if len(labels) > 1:
        raise InputError(
            f"the recordings are of {len(labels)} labels ({', '.join(labels)}); a material is fitted to one: give its "
            "files alone, or --name if they are the same material"
        )
    return (labels[0] if labels else options.recording[0].stem).lower()


def _default_out(options: argparse.Namespace) -> Path:
    """Named by words of the command line alone, because a name in a file must not choose a path."""
    words = options.recording[0].resolve().stem if options.name is None else options.name
    # Letters and digits of any script, dots and dashes; everything else becomes a dash.
    name = re.sub(r"[^\w.-]+", "-", words).strip("-.") or "material"
    return Path(f"{name}{SUFFIX}")


def _wave_vectors(given: list[list[float]] | None) -> tuple[tuple[float, float], ...] | None:
    if given is None:
        return None
    if len(given) > 2:
        raise InputError(f"--wave-vector is given {len(given)} times; a material has two at most")
    return tuple((x, y) for x, y in given if (x, y) != (0.0, 0.0))


def _origin(paths: Sequence[Path], files: Sequence[RecordingFile]) -> tuple[str, str]:
    """Licence and provenance of the recordings."""
    licences = sorted({file.licence for file in files})
    sources = sorted({file.source for file in files if file.source not in ("", UNKNOWN)})
    names = [path.name for path in paths]
    return "; ".join(licences), ", ".join([*names, *sources])


def _report(out: Path, name: str, report: dict[str, Any]) -> None:
    slow, fast = (1000.0 * speed for speed in report["speed_mps"])
    light, firm = report["force_newtons"]
    exponents = report["level_exponents"]
    print(f"{out}: '{name}' from {report['sliding_seconds']:.1f} s of sliding, nearest label {report['nearest_label']}")
    print(
        f"  recorded {slow:.0f}-{fast:.0f} mm/s, {light:.2f}-{firm:.2f} N; level grows as "
        f"speed^{exponents['speed']:.2f} force^{exponents['force']:.2f}"
    )
    noise = report["sensor_noise"]
    if noise["from"] != "none":
        print(f"  the sensor's noise, {noise['mps2']:.2g} m/s^2 RMS by the {noise['from']}, was removed")
    ribs = [math.hypot(each["x_cycles_per_mm"], each["y_cycles_per_mm"]) for each in report["wave_vectors"]]
    if ribs:
        found = ", ".join(f"{1.0 / length:.2f} mm" for length in ribs)
        where = f"{report['turn_degrees']:.0f} degrees from the recording's"
        print(f"  ribs every {found}; the material's first axis lies across them, {where}")
    print(f"  distance of the spectra on the recording: {report['spectral_distance_db']:.1f} dB")
    for other in report["other_tiers"]:
        if other["further_off"]:
            print(f"  tier {other['tier']} is further off: {other['spectral_distance_db']:.1f} dB")
    if report["record_next"]:
        print(f"  to gain most, {report['record_next']}")
    for warning in report["warnings"]:
        print(f"  {warning}")
