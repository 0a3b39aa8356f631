"""`haptoflow-training add-material`: fit a new material to seconds of recording, as a file of its own or as a
further label."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Sequence
from datetime import date
from pathlib import Path

import torch
from tqdm import tqdm

from haptoflow_training.errors import InputError
from haptoflow_training.export.material_file import (
    SUFFIX,
    UNKNOWN_LICENCE,
    Material,
    MaterialProvenance,
    write_material,
)
from haptoflow_training.export.model_file import read_model_file, write_model_file
from haptoflow_training.fewshot.add_label import with_label
from haptoflow_training.fewshot.embedding_fit import FitOptions
from haptoflow_training.fewshot.material_fit import (
    RECOMMENDED_SECONDS,
    FittedMaterial,
    as_material,
    fit_material,
    steps_of,
)
from haptoflow_training.models.file_model import FileModel
from haptoflow_training.recordings.material_recording import MaterialRecording, read_material_recordings

_EXAMPLES = """examples:
  haptoflow-training add-material --model default.haptoflow --recording doormat.csv
      writes doormat.haptomaterial: scenes, the command line and Unity use it together with default.haptoflow
  haptoflow-training add-material --model default.haptoflow --recording slow.wav fast.wav --name mat -o mine.haptoflow
      writes a model file with a further label
  haptoflow-training add-material --model default.haptoflow --recording rack.csv --wave-vector 0.8 0 --name rack
      ribs 1.25 mm apart, across the recording's first axis

At least 10 s are recommended: slow and fast slides, 20 to 200 mm/s, light and firm. Ribs are estimated; a ruled
material's first axis is put across its clearest ribs. Takes about half a minute of one core.
"""


def register(subparsers: argparse._SubParsersAction[argparse.ArgumentParser], summary: str) -> None:
    parser = subparsers.add_parser(
        "add-material",
        help=summary,
        description="Fit the embedding, level, tone and seeds of one material to its recordings. The networks of the "
        "model and all of its labels stay as they are.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
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
    parser.add_argument("--category", default="", help="for example cloth (default: the nearest label's)")
    parser.add_argument("--description", default="", help="one or two sentences")
    parser.add_argument(
        "--wave-vector", nargs=2, type=float, action="append", metavar=("X", "Y"),
        help="ribs in cycles per millimetre along the recording's axes, at most twice (default: estimated); 0 0: none",
    )  # fmt: skip
    parser.add_argument("--seed", type=int, default=1, help="the same seed gives the same material (default 1)")
    parser.add_argument("--steps", type=int, default=FitOptions.steps, help=f"of the fit (default {FitOptions.steps})")
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    if options.steps < 1:
        raise InputError(f"--steps {options.steps}: expected 1 or more")
    recordings = read_material_recordings(options.recording)
    name = _name(options, recordings)
    out = _default_out(options) if options.out is None else options.out
    if out.suffix not in (SUFFIX, ".haptoflow"):
        raise InputError(f"{out}: expected a name that ends in {SUFFIX} or .haptoflow")
    model = FileModel(read_model_file(options.model))
    fit_options = FitOptions(steps=options.steps)
    torch.set_num_threads(1)
    with tqdm(total=steps_of(model, fit_options), desc=name, unit="step", disable=None) as progress:
        fitted = fit_material(
            model,
            recordings,
            seed=options.seed,
            wave_vectors_per_mm=_wave_vectors(options.wave_vector),
            options=fit_options,
            advance=lambda: progress.update(1) and None,
        )
    material = as_material(
        model,
        fitted,
        name=name,
        category=options.category,
        description=options.description,
        provenance=_provenance(recordings, fitted),
    )
    if out.suffix == SUFFIX:
        write_material(out, material)
    else:
        write_model_file(out, with_label(model.file, material))
    _report(out, model, material, fitted)
    return 0


def _name(options: argparse.Namespace, recordings: Sequence[MaterialRecording]) -> str:
    if options.name is not None:
        if not options.name.strip():
            raise InputError("--name is empty; expected a name such as doormat")
        return str(options.name.strip())
    labels = sorted({recording.label for recording in recordings if recording.label})
    if len(labels) > 1:
        raise InputError(
            f"the recordings are of {len(labels)} labels ({', '.join(labels)}); a material is fitted to one: give its "
            "files alone, or --name if they are the same material"
        )
    return labels[0] if labels else options.recording[0].stem


def _default_out(options: argparse.Namespace) -> Path:
    """Named by words of the command line alone, because a name in a file must not choose a path."""
    words = options.recording[0].resolve().stem if options.name is None else options.name
    return Path(f"{_file_name(words)}{SUFFIX}")


def _file_name(name: str) -> str:
    """A file name for the material: letters and digits of any script, dots and dashes; everything else becomes a
    dash."""
    return re.sub(r"[^\w.-]+", "-", name).strip("-.") or "material"


def _wave_vectors(given: list[list[float]] | None) -> tuple[tuple[float, float], ...] | None:
    if given is None:
        return None
    if len(given) > 2:
        raise InputError(f"--wave-vector is given {len(given)} times; a material has two at most")
    return tuple((x, y) for x, y in given if (x, y) != (0.0, 0.0))


def _provenance(recordings: Sequence[MaterialRecording], fitted: FittedMaterial) -> MaterialProvenance:
    licences = sorted({recording.licence or UNKNOWN_LICENCE for recording in recordings})
    sources = sorted({recording.source for recording in recordings if recording.source not in ("", "unknown")})
    return MaterialProvenance(
        statement="fitted to a recording by haptoflow-training add-material",
        recordings="; ".join(sources) or ", ".join(sorted({recording.name for recording in recordings})),
        licence="; ".join(licences),
        seconds=round(fitted.seconds, 2),
        created=date.today().isoformat(),
    )


def _report(out: Path, model: FileModel, material: Material, fitted: FittedMaterial) -> None:
    nearest = model.labels[fitted.fit.nearest]["name"]
    print(f"{out}: '{material.name}' from {fitted.seconds:.1f} s, nearest label {nearest}")
    slow, fast = (1000.0 * speed for speed in material.speed_range_mps)
    light, firm = material.force_range_newtons
    law = f"speed^{material.speed_exponent:.2f} force^{material.force_exponent:.2f}"
    print(f"  recorded {slow:.0f}-{fast:.0f} mm/s, {light:.2f}-{firm:.2f} N; level grows as {law}")
    if fitted.frame.is_ruled:
        numbers = fitted.frame.wave_numbers.reshape(2, 2)
        found = ", ".join(f"{1.0 / float((row[0] ** 2 + row[1] ** 2) ** 0.5):.2f} mm" for row in numbers if row.any())
        turn = math.degrees(fitted.frame.turn_radians)
        where = f"{turn:.0f} degrees from the recording's"
        print(f"  ribs every {found}; the material's first axis lies across them, {where}")
    distances = ", ".join(f"{name} {distance:.1f} dB" for name, distance in fitted.distances_db.items())
    print(f"  distance of the spectra on the recording: {distances}")
    for tier in fitted.far_tiers:
        fitted_for = next(iter(fitted.distances_db))
        print(f"  tier {tier} is further off by more than 0.3 dB: the tone was fitted for {fitted_for}")
    # Recordings are trimmed at both ends, so a little less than the recommended time is accepted.
    if fitted.seconds < RECOMMENDED_SECONDS - 1.0:
        print(f"  {fitted.seconds:.1f} s is little; {RECOMMENDED_SECONDS:g} s of slow and fast slides are recommended")
