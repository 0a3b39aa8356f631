"""Renders a stroke over a scene, one stroke over eight labels, taps and boards, and makes out/demo: the WAV files, report.json
with their figures, and the page index.html. `./run demo` runs this; the argument describes the machine."""

from __future__ import annotations

import base64
import io
import json
import re
import shutil
import sys
from dataclasses import dataclass
from html import escape
from pathlib import Path

import numpy as np
from drawings import Range, draw_contact, draw_render, draw_scene, spectrogram_levels
from matplotlib import colormaps
from matplotlib.colors import to_hex
from renders import ROOT, SAMPLES, Render, colour_of, contacts_of, read_wave, render_file
from scipy.io import wavfile

SCENES = SAMPLES / "HeadlessScenes"
FOLDER = ROOT / "out/demo"
TRACED_LABELS = ("wood", "metal mesh", "corduroy", "sandpaper", "glass", "rubber", "jute", "stone")
# The default of the command line, equal to the one in the C header.
FULL_SCALE_MPS2 = 200.0
RANGE_DB = 60
FIGURES = ("seconds", "rms_mps2", "peak", "segments", "inference_ms", "nonfinite", "underruns")
TIMES = ("p50", "p99")


@dataclass(frozen=True)
class Shown:
    """A render with its scene and stroke; report: what `haptoflow render --report` wrote."""

    name: str
    scene: dict
    path: np.ndarray
    felt: Render
    report: dict

    @property
    def slug(self) -> str:
        return slug(self.name)


def slug(name: str) -> str:
    """For file names and anchors."""
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")


def planned() -> list[tuple[str, dict, str, tuple[str, ...]]]:
    """Name, scene, stroke and further words of each render: the crossing, the plate of each label, the taps with all
    effects, the boards with their relief."""

    def scene_of(name: str) -> dict:
        return json.loads((SCENES / f"{name}.scene.json").read_text(encoding="utf-8"))

    plate = scene_of("tracing")
    traced = [
        (label, {**plate, "surfaces": [{**surface, "material": label} for surface in plate["surfaces"]]}, "tracing", ())
        for label in TRACED_LABELS
    ]
    taps = ("taps and rims", scene_of("taps"), "taps", ("--effects", "texture,impact,edge"))
    boards = scene_of("boards")
    # A scene names its maps relative to its own file, and the demo writes scenes elsewhere.
    relief = boards["surfaces"][0]["relief"]
    relief["image"] = str(SCENES / relief["image"])
    return [("crossing", scene_of("crossing"), "crossing", ()), *traced, taps, ("boards", boards, "tracing", ())]


def rendered(name: str, scene: dict, stroke_name: str, words: tuple[str, ...]) -> Shown:
    stroke = SCENES / f"{stroke_name}.stroke.csv"
    wav, report = FOLDER / f"{slug(name)}.wav", FOLDER / f"{slug(name)}.report.json"
    scene_file = FOLDER / "scenes" / f"{slug(name)}.scene.json"
    scene_file.write_text(json.dumps(scene, indent=2) + "\n", encoding="utf-8")
    render_file(scene_file, stroke, wav, "--report", report, "--seed", 1, *words)
    rate_hz, samples = read_wave(wav)
    path = np.loadtxt(stroke, delimiter=",", skiprows=1)[:, :4]
    path[:, 0] -= path[0, 0]
    felt = Render(rate_hz, FULL_SCALE_MPS2 * samples, contacts_of(scene_file, stroke))
    return Shown(name, scene, path, felt, json.loads(report.read_text(encoding="utf-8")))


def report_of(shown: list[Shown]) -> dict:
    return {
        "model": shown[0].report["model"],
        "renders": [
            {"name": each.name, "labels": each.report["labels"], "wav": f"{each.slug}.wav"}
            | {key: each.report[key] for key in FIGURES}
            | {"inference_ms": {key: each.report["inference_ms"][key] for key in TIMES}}
            for each in shown
        ],
    }


def common_gain(shown: list[Shown]) -> float:
    """The gain at which the loudest of all peaks at -1 dB of full scale; 1 where all are silent."""
    loudest = max(float(np.abs(each.felt.acceleration_mps2).max()) for each in shown) / FULL_SCALE_MPS2
    return 10.0 ** (-1.0 / 20.0) / loudest if loudest > 0.0 else 1.0


def nice_ceiling(value: float) -> float:
    """The smallest round number that is not below `value`; 1 for zero."""
    if value <= 0.0:
        return 1.0
    power = 10.0 ** np.floor(np.log10(value))
    return next(step * power for step in (1, 1.2, 1.5, 2, 3, 4, 5, 6, 8, 10) if step * power >= value * (1 - 1e-9))


def range_of(shown: list[Shown]) -> Range:
    """One scale of all waveforms and of all spectrograms, so that their heights and colours can be compared."""
    loudest = max(float(spectrogram_levels(each.felt).max()) for each in shown)
    top_db = 5 * int(np.ceil(loudest / 5.0)) if loudest > -200.0 else 0
    peak = max(float(np.abs(each.felt.acceleration_mps2).max()) for each in shown)
    return Range(nice_ceiling(peak), top_db - RANGE_DB, top_db)


def signed(number: str) -> str:
    """With its sign, a true minus."""
    return ("+" if float(number) > 0.0 else "") + number.replace("-", "\u2212")


def article(each: Shown, shared: Range, gain: float, is_whole: bool) -> str:
    """A player with the pictures that it plays."""
    file = io.BytesIO()
    played = np.clip(gain * each.felt.acceleration_mps2 / FULL_SCALE_MPS2, -1.0, 1.0)
    wavfile.write(file, each.felt.rate_hz, np.round(32767.0 * played).astype(np.int16))
    audio = base64.b64encode(file.getvalue()).decode()
    name = escape(each.name)
    level = f"<span>{name} <em>{each.report['rms_mps2']:.1f} m/s² RMS</em></span>"
    own = f'<i style="background:{colour_of(each.name)}"></i>{level}'
    title = "<span>The whole stroke</span>" if is_whole else own
    return f"""<article class="render" id="{each.slug}"><h3><button type="button" data-name="{name}"></button>{title}
<output>{each.felt.seconds:.1f} s</output></h3>
{draw_render(each.name, each.scene, each.felt, shared, is_whole)}
<audio preload="metadata" src="data:audio/wav;base64,{audio}"></audio></article>"""


def table(report: dict) -> str:
    strongest = max(render["rms_mps2"] for render in report["renders"]) or 1.0
    return "\n".join(
        f"""<tr><th scope="row"><a href="#{slug(each["name"])}">{escape(each["name"])}</a></th>
<td class="bar"><span style="width:{100 * each["rms_mps2"] / strongest:.1f}%;background:{colour_of(each["name"])}">
</span></td><td>{each["rms_mps2"]:.2f}</td><td>{each["peak"] * FULL_SCALE_MPS2:.1f}</td><td>{each["segments"]}</td>
<td>{each["inference_ms"]["p50"]:.2f}</td><td>{each["inference_ms"]["p99"]:.2f}</td><td>{each["underruns"]}</td>
<td>{each["nonfinite"]}</td></tr>"""
        for each in report["renders"]
    )


def legend(shared: Range) -> str:
    bottom, top = (signed(str(level)) for level in (shared.bottom_db, shared.top_db))
    stops = ",".join(to_hex(colormaps["inferno"](step / 16)) for step in range(17))
    return f"""<div class="legend" role="img" aria-label="Colours of the spectrograms: dark is {shared.bottom_db} dB, bright
is {shared.top_db} dB, relative to 1 m/s²"><span>{bottom} dB</span>
<i style="background:linear-gradient(to right,{stops})"></i><span>{top} dB re 1 m/s²</span></div>"""


def page(shown: list[Shown], machine: str) -> str:
    """One self-contained HTML file. The crossing is the first of `shown`, taps and boards are the last two."""
    report, gain, shared = report_of(shown), common_gain(shown), range_of(shown)
    first, *traced, taps, boards = (article(each, shared, gain, each in (shown[0], *shown[-2:])) for each in shown)
    above, front = draw_scene(shown[0].scene, shown[0].path, shown[0].felt)
    folder = Path(__file__).parent
    content = {
        "style": (folder / "page.css").read_text(encoding="utf-8"),
        "script": (folder / "player.js").read_text(encoding="utf-8"),
        "model": escape(report["model"]),
        "fromAbove": above,
        "fromFront": front,
        "scale": f"±{shared.top_mps2:g} m/s²",
        "surfaces": str(len(shown[0].scene["surfaces"])),
        "crossing": first,
        "traced": "\n".join(traced),
        "tracedCount": str(len(traced)),
        "taps": taps,
        "boards": boards,
        "contact": draw_contact(shown[1].felt, "plate"),
        "table": table(report),
        "legend": legend(shared),
        "gain": f"{signed(f'{20.0 * np.log10(gain):.1f}')} dB",
        "fullScale": f"{FULL_SCALE_MPS2:g}",
        "machine": escape(machine),
    }
    text = (folder / "page.html").read_text(encoding="utf-8")
    return re.sub(r"\{\{(\w+)\}\}", lambda found: content[found[1]], text)


def main() -> None:
    shutil.rmtree(FOLDER, ignore_errors=True)
    (FOLDER / "scenes").mkdir(parents=True)
    shown = []
    for plan in planned():
        each = rendered(*plan)
        figures = each.report
        print(f"demo: {each.name}: {figures['seconds']:.1f} s, {figures['segments']} segments, "
              f"{figures['inference_ms']['p50']:.2f} ms each", flush=True)  # fmt: skip
        shown.append(each)
    (FOLDER / "report.json").write_text(json.dumps(report_of(shown), indent=2) + "\n", encoding="utf-8")
    (FOLDER / "index.html").write_text(page(shown, sys.argv[1]), encoding="utf-8")


if __name__ == "__main__":
    main()
