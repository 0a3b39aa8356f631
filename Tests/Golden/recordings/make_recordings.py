"""Makes the recordings of this folder and the one right answer for each, expected.json.

The answers are computed from what is written, not by a reader. Run it with Debian's Python and NumPy:
`/usr/bin/python3 Tests/Golden/recordings/make_recordings.py`; it gives the same bytes every time.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

FOLDER = Path(__file__).parent
FILES = FOLDER / "files"
GRAVITY_MPS2 = 9.80665

_Numbers = NDArray[np.float64]
_answers: list[dict[str, Any]] = []


class Stroke:
    """A noise whose level follows the speed, and the motion that made it."""

    def __init__(self, rate_hz: float, seconds: float, seed: int = 1, hertz: float = 0.9) -> None:
        count = round(rate_hz * seconds)
        self.rate_hz = rate_hz
        self.time = np.arange(count) / rate_hz
        turn = 2.0 * np.pi * hertz * self.time
        self.speed = 0.08 + 0.05 * np.sin(turn)
        self.force = 1.2 + 0.3 * np.cos(0.5 * turn)
        noise = np.random.default_rng(seed).standard_normal(count)
        # Long enough runs of equal values would be a frozen sensor: white noise has none.
        self.wave = 40.0 * self.speed * noise
        self.position = np.cumsum(self.speed) / rate_hz

    def axes(self) -> _Numbers:
        """Three axes with gravity on the third."""
        others = np.random.default_rng(9).standard_normal((len(self.time), 2))
        return np.column_stack(
            [self.wave, 20.0 * self.speed[:, None] * others + [0.0, GRAVITY_MPS2]]
        )


def table(columns: dict[str, Sequence[Any] | _Numbers], formats: dict[str, str] | None = None) -> str:
    """A CSV text; a cell that is not finite is left empty."""
    chosen = {"time_s": "%.4f"} | (formats or {})
    lines = [",".join(columns)]
    for row in zip(*columns.values(), strict=True):
        cells = [
            value if isinstance(value, str) else "" if not np.isfinite(value) else chosen.get(name, "%.6f") % value
            for name, value in zip(columns, row, strict=True)
        ]
        lines.append(",".join(cells))
    return "\n".join(lines) + "\n"


def write(name: str, content: str | bytes) -> None:
    path = FILES / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content if isinstance(content, bytes) else content.encode())


def sidecar(name: str, **values: Any) -> None:
    write(name, json.dumps(values) + "\n")


def read(
    file: str,
    why: str,
    rate_hz: float,
    axes: _Numbers,
    speed: _Numbers | float | None,
    force: _Numbers | float | None,
    missing: int = 0,
    samples: int | None = None,
    notes: Sequence[str] = (),
    **texts: Any,
) -> None:
    """The answer for a recording that is read. axes: what was measured, in m/s^2."""
    values = axes.reshape(len(axes), -1)
    _answers.append(
        {
            "file": file,
            "why": why,
            "rate_hz": rate_hz,
            "axes": values.shape[1],
            "samples": len(values) if samples is None else samples,
            "missing_samples": missing,
            "mean_mps2": [round(float(mean), 5) for mean in values.mean(axis=0)],
            "rms_mps2": round(float(np.sqrt(np.mean(np.sum((values - values.mean(axis=0)) ** 2, axis=1)))), 5),
            "speed_mps": None if speed is None else round(float(np.mean(speed)), 5),
            "force_newtons": None if force is None else round(float(np.mean(force)), 5),
            "notes": list(notes),
            "label": "",
            "licence": "",
            "source": "",
            **texts,
        }
    )


def refuse(file: str, why: str, message: str) -> None:
    """The answer for a file that is refused. message: a part of it; FILE stands for its path."""
    _answers.append({"file": file, "why": why, "refused": message})


def wav(samples: _Numbers, rate_hz: int, bits: int, is_float: bool = False, declared: int | None = None) -> bytes:
    values = samples.reshape(len(samples), -1)
    if is_float:
        body = values.astype("<f4").tobytes()
    elif bits == 24:
        whole = np.round(values * (2**23 - 1)).astype("<i4")
        body = b"".join(struct.pack("<i", number)[:3] for number in whole.ravel())
    else:
        body = np.round(values * (2 ** (bits - 1) - 1)).astype(f"<i{bits // 8}").tobytes()
    channels, width = values.shape[1], bits // 8
    form = struct.pack(
        "<HHIIHH", 3 if is_float else 1, channels, rate_hz, rate_hz * channels * width, channels * width, bits
    )
    data = b"data" + struct.pack("<I", len(body) if declared is None else declared) + body
    chunks = b"WAVE" + b"fmt " + struct.pack("<I", len(form)) + form + data
    return b"RIFF" + struct.pack("<I", len(chunks)) + chunks


def plain(stroke: Stroke, **others: Any) -> dict[str, Any]:
    return {
        "time_s": stroke.time,
        "acceleration_mps2": stroke.wave,
        "speed_mps": stroke.speed,
        "force_newtons": stroke.force,
    } | others


def make_columns() -> None:
    s = Stroke(1000.0, 0.5)
    write("plain.csv", table(plain(s)))
    read("plain.csv", "the simplest table", 1000.0, s.wave, s.speed, s.force)
    write(
        "millimetres.csv",
        table({"time_s": s.time, "acceleration_g": s.wave / GRAVITY_MPS2, "speed_mmps": 1000.0 * s.speed,
               "force_millinewtons": 1000.0 * s.force}),
    )  # fmt: skip
    read("millimetres.csv", "other units, which the columns name", 1000.0, s.wave, s.speed, s.force)
    turned = np.deg2rad(30.0)
    write(
        "velocity.csv",
        table({"time_s": s.time, "acceleration_mps2": s.wave, "velocity_x_mps": s.speed * np.cos(turned),
               "velocity_y_mps": s.speed * np.sin(turned), "force_newtons": s.force}),
    )  # fmt: skip
    read("velocity.csv", "a velocity of two axes", 1000.0, s.wave, s.speed, s.force)
    axes = s.axes()
    for name, unit, factor in (("three_axes.csv", "mps2", 1.0), ("three_axes_g.csv", "g", GRAVITY_MPS2)):
        write(
            name,
            table({"time_s": s.time} | {f"acceleration_{axis}_{unit}": axes[:, place] / factor
                   for place, axis in enumerate("xyz")} | {"speed_mps": s.speed, "force_newtons": s.force}),
        )  # fmt: skip
        read(name, f"three axes with gravity, in {unit}", 1000.0, axes, s.speed, s.force)
    long = Stroke(1000.0, 1.2)
    inner = slice(100, 1100)
    for name, unit, factor in (("position_mm.csv", "mm", 1000.0), ("position_m.csv", "m", 1.0)):
        write(
            name,
            table({"time_s": long.time, "acceleration_mps2": long.wave, f"position_x_{unit}": factor * long.position,
                   f"position_y_{unit}": 0.0 * long.position, "force_newtons": long.force},
                  {f"position_x_{unit}": "%.8f"}),
        )  # fmt: skip
        read(name, "positions: the speed is their slope", 1000.0, long.wave, long.speed[inner], long.force,
             speed_from=100, speed_to=1100)  # fmt: skip
    tracked = long.position[8 * (np.arange(len(long.time)) // 8)]
    write(
        "repeated_positions.csv",
        table({"time_s": long.time, "acceleration_mps2": long.wave, "position_x_mm": 1000.0 * tracked,
               "position_y_mm": 0.0 * tracked, "force_newtons": long.force}),
    )  # fmt: skip
    read("repeated_positions.csv", "a tracker of 125 Hz repeats its last position in the rows of a faster sensor: "
         "neither rests nor jumps", 1000.0, long.wave, long.speed[inner], long.force,
         speed_from=100, speed_to=1100)  # fmt: skip
    rare = np.where(np.arange(len(s.time)) % 8 == 0, 1.0, np.nan)
    rare[-1] = 1.0
    write("empty_cells.csv", table(plain(s, speed_mps=s.speed * rare, force_newtons=s.force * rare)))
    read("empty_cells.csv", "motion and force of a slower clock leave cells empty", 1000.0, s.wave, s.speed, s.force)
    write("unknown_columns.csv", table(plain(s, temperature_c=20.0 + 0.0 * s.time)))
    read("unknown_columns.csv", "an unknown column is ignored and named", 1000.0, s.wave, s.speed, s.force,
         notes=["columns temperature_c are not known and are ignored"])  # fmt: skip
    quoted = table(plain(s)).replace("time_s", '"time_s"').replace("\n", "\r\n")
    write("quoted.csv", b"\xef\xbb\xbf" + quoted.encode())
    read("quoted.csv", "byte order mark, quotes and Windows' line ends", 1000.0, s.wave, s.speed, s.force)
    write("Upper.CSV", table({"time_s": s.time, "acceleration_mps2": s.wave}))
    sidecar("Upper.JSON", speed_mps=0.08, force_newtons=1.0, label="Upper")
    read("Upper.CSV", "endings in upper case, as some recorders write them", 1000.0, s.wave, 0.08, 1.0,
         label="Upper")  # fmt: skip
    write("no_motion.csv", table({"time_s": s.time, "acceleration_mps2": s.wave}))
    read("no_motion.csv", "neither motion nor force: they are unknown, and learning asks for them", 1000.0, s.wave,
         None, None)  # fmt: skip


def make_clocks() -> None:
    s = Stroke(1000.0, 0.5)
    write("epoch.csv", table(plain(s, time_s=s.time + 1764057600.0)))
    read("epoch.csv", "seconds since 1970", 1000.0, s.wave, s.speed, s.force)
    write("no_time.csv", table({name: column for name, column in plain(s).items() if name != "time_s"}))
    sidecar("no_time.json", rate_hz=1000)
    read("no_time.csv", "no column time_s: the sidecar's rate", 1000.0, s.wave, s.speed, s.force)
    fast = Stroke(3000.0, 0.3)
    write("few_digits.csv", table(plain(fast), {"time_s": "%.4f"}))
    read("few_digits.csv", "3 kHz with four digits: even, although the digits are not", 3000.0, fast.wave, fast.speed,
         fast.force)  # fmt: skip
    write("rate_192000.csv", table(plain(Stroke(192000.0, 0.004)), {"time_s": "%.9f"}))
    top = Stroke(192000.0, 0.004)
    read("rate_192000.csv", "the highest rate", 192000.0, top.wave, top.speed, top.force)
    missing = s.wave.copy()
    missing[[40, 41, 200]] = np.nan
    write("missing_cells.csv", table(plain(s, acceleration_mps2=missing)))
    read("missing_cells.csv", "a few samples are missing: rows without a number are left out, and the curve goes "
         "through", 1000.0, s.wave, s.speed, s.force, tolerance=0.02,
         notes=["3 of 500 rows have no number of their own in acceleration_mps2 or time_s and are left out"])  # fmt: skip
    kept = (s.time < 0.2) | (s.time > 0.2995)
    write("gap.csv", table({name: column[kept] for name, column in plain(s).items()}))
    read("gap.csv", "a gap above 5 ms is a gap and no straight line", 1000.0, s.wave[kept], s.speed, s.force,
         missing=100, samples=500, tolerance=0.02)  # fmt: skip
    late = np.where(s.time < 0.25, s.time, s.time + 60.0)
    write("pause.csv", table(plain(s, time_s=late)))
    read("pause.csv", "a pause of a minute splits the recording", 1000.0, s.wave, s.speed, s.force, missing=60000,
         samples=60500, tolerance=0.02)  # fmt: skip
    hours = np.where(s.time < 0.25, s.time, s.time + 7200.0)
    write("hours.csv", table(plain(s, time_s=hours)))
    first = slice(0, 250)
    read("hours.csv", "a gap of two hours", 1000.0, s.wave[first], s.speed[first], s.force[first],
         missing=300001 - 250, samples=300001, tolerance=0.1, own_samples=500,
         notes=["only the first 300 s are learnt from, in which time_s has a gap of 7200 s after 0.249 s"])  # fmt: skip
    jitter = s.time + np.random.default_rng(3).uniform(-0.0002, 0.0002, len(s.time))
    slow = 2.0 * np.sin(2.0 * np.pi * 60.0 * jitter)
    write("uneven.csv", table(plain(s, time_s=jitter - jitter[0], acceleration_mps2=slow), {"time_s": "%.7f"}))
    read("uneven.csv", "time stamps that truly tremble are followed", 1000.0, slow, s.speed, s.force, tolerance=0.02,
         rate_tolerance=0.01, samples=round((jitter[-1] - jitter[0]) * 1000.0) + 1, sample_tolerance=1)  # fmt: skip
    write("milliseconds.csv", table(plain(s, time_s=1000.0 * s.time), {"time_s": "%.1f"}))
    refuse("milliseconds.csv", "milliseconds under time_s", "FILE: 1 samples a second by time_s; expected 1000 to "
           "192000; time_s is in seconds")  # fmt: skip
    back = s.time.copy()
    back[100] = back[98]
    write("runs_back.csv", table(plain(s, time_s=back)))
    refuse("runs_back.csv", "a clock that runs back", "FILE:102: column time_s: runs back to 0.098 s")
    write("repeats.csv", table(plain(s), {"time_s": "%.2f"}))
    refuse("repeats.csv", "a clock with too few digits", "FILE:3: column time_s: repeats the time before it, as 449 "
           "of 500 rows do; expected every time later than the one before: write more digits, or leave the column out "
           "and give the key rate_hz")  # fmt: skip


def make_sidecars() -> None:
    s = Stroke(1000.0, 0.5)
    wave = {"time_s": s.time, "acceleration_mps2": s.wave}
    write("constant.csv", table(wave))
    sidecar("constant.json", speed_mps=0.08, force_newtons=1.5, label="denim", licence="CC0 1.0", source="a tailor")
    read("constant.csv", "constants in the sidecar", 1000.0, s.wave, 0.08, 1.5, label="denim", licence="CC0 1.0",
         source="a tailor")  # fmt: skip
    write("folder/one.csv", table(wave))
    write("folder/two.csv", table(wave))
    sidecar("folder/recordings.json", velocity_mps=[0.0, 0.1], force_newtons=0.5, licence="CC BY 4.0")
    sidecar("folder/two.json", speed_mps=0.2)
    read("folder/one.csv", "defaults of the folder", 1000.0, s.wave, 0.1, 0.5, licence="CC BY 4.0")
    read("folder/two.csv", "a sidecar overrides the folder: its speed replaces the velocity", 1000.0, s.wave, 0.2, 0.5,
         licence="CC BY 4.0")  # fmt: skip
    write("tracked.csv", table(wave))
    own = np.arange(0.0, 0.5, 0.01)
    motion = {"time_s": own, "speed_mps": 0.05 + 0.0 * own, "force_newtons": 0.7 + 0.0 * own}
    write("tracked.motion.csv", table(motion))
    sidecar("tracked.json", motion="tracked.motion.csv")
    read("tracked.csv", "motion in a file with a clock of its own", 1000.0, s.wave, 0.05, 0.7)
    write("slow_motion.csv", table(wave))
    write("slow_motion.motion.csv", table(motion | {"time_s": 1000.0 * own}, {"time_s": "%.1f"}))
    sidecar("slow_motion.json", motion="slow_motion.motion.csv")
    refuse("slow_motion.csv", "milliseconds in the motion file", "column time_s rises by 10 s from reading to reading "
           "in the median; expected seconds, with a reading every 0.25 s at least: divide milliseconds by 1000")  # fmt: skip
    for name, text, message in (
        ("outside", {"motion": "../victim.csv"}, "key 'motion' names ../victim.csv, which is outside the folder of "
         "outside.json; expected a table beside the recording: copy it there"),
        ("absent", {"motion": "nowhere.csv"}, "key 'motion' names nowhere.csv, which is not there; expected a table "
         "beside the recording"),
        ("unknown_key", {"speed": 0.1}, "unknown key 'speed'; expected keys of label, full_scale_mps2"),
        ("two_speeds", {"speed_mps": 0.1, "velocity_mps": [0.1, 0.0]}, "keys speed_mps and velocity_mps; expected one "
         "of them"),
        ("fast", {"speed_mps": 80}, "key 'speed_mps' is 80; expected metres a second, 0 to 10 (a thousandth of mm/s)"),
        ("two_lines", {"label": "oak\ntable"}, "key 'label' is \"oak\\ntable\"; expected one line of text"),
    ):  # fmt: skip
        write(f"{name}.csv", table(wave))
        sidecar(f"{name}.json", **text)
        refuse(f"{name}.csv", f"a sidecar with {next(iter(text))}", f"{name}.json: {message}")
    write("broken.csv", table(wave))
    write("broken.json", '{"label": "denim",}')
    refuse("broken.csv", "a sidecar that is no JSON", "broken.json: not JSON")


def make_waves() -> None:
    s = Stroke(2000.0, 0.3)
    scaled = s.wave / 25.0
    for name, bits, is_float in (("wave_16.wav", 16, False), ("wave_24.wav", 24, False), ("wave_float.wav", 32, True)):
        write(name, wav(scaled, 2000, bits, is_float))
        sidecar(name.replace(".wav", ".json"), full_scale_mps2=25.0, speed_mps=0.08, force_newtons=1.0)
        read(name, f"WAV of {bits} bits", 2000.0, s.wave, 0.08, 1.0, tolerance=0.001)
    axes = s.axes()
    write("wave_axes.wav", wav(axes / 50.0, 2000, 32, True))
    sidecar("wave_axes.json", full_scale_mps2=50.0, velocity_mps=[0.06, 0.08], force_newtons=1.0)
    read("wave_axes.wav", "three channels, and a velocity of two axes", 2000.0, axes, 0.1, 1.0)
    write("wave_alone.wav", wav(scaled, 2000, 16))
    refuse("wave_alone.wav", "WAV without a full scale", "wave_alone.json: no key 'full_scale_mps2' for "
           "wave_alone.wav; expected \"full_scale_mps2\": the acceleration in m/s^2 that +-1 stands for")  # fmt: skip
    write("wave_cut.wav", wav(scaled, 2000, 16)[:700])
    sidecar("wave_cut.json", full_scale_mps2=25.0)
    refuse("wave_cut.wav", "half a WAV file", "FILE: cannot be read to its end; expected a whole file; is it cut off?")
    pcm = wav(scaled, 2000, 16)
    form, body = pcm[12:36], pcm[44:]
    unsaid = ["does not say how many samples it has"]

    def wave_file(name: str, why: str, content: bytes, notes: Sequence[str] = ()) -> None:
        write(name, content)
        sidecar(name[:-4] + ".json", full_scale_mps2=25.0, speed_mps=0.08, force_newtons=1.0)
        read(name, why, 2000.0, s.wave, 0.08, 1.0, notes=notes, tolerance=0.001)

    def riff(*chunks: bytes, tag: bytes = b"RIFF", size: int | None = None) -> bytes:
        content = b"WAVE" + b"".join(chunks)
        return tag + struct.pack("<I", len(content) if size is None else size) + content

    def chunk(tag: bytes, content: bytes, size: int | None = None) -> bytes:
        return tag + struct.pack("<I", len(content) if size is None else size) + content

    for name, size in (("piped", 0xFFFFFFFF), ("zero", 0), ("sox", 0x7FFFF000), ("arecord", 0x80000000),
                       ("less_a_head", 0xFFFFFFFF - 36)):  # fmt: skip
        wave_file(f"wave_{name}.wav", f"a writer that could not seek leaves the size {size:#x}",
                  riff(form, chunk(b"data", body, size), size=size), unsaid)  # fmt: skip
    odd = chunk(b"LIST", b"INFOIART\x05\x00\x00\x00Anna\x00")
    wave_file("wave_list.wav", "a chunk of odd size that is not filled up", riff(form, odd, chunk(b"data", body)))
    wave_file("wave_list_filled.wav", "the same filled up", riff(form, odd, b"\0", chunk(b"data", body)))
    wave_file("wave_list_letter.wav", "filled up with a letter", riff(form, odd, b"x", chunk(b"data", body)))

    def sizes(data: int) -> bytes:
        return chunk(b"ds64", struct.pack("<QQQI", 0, data, data // 2, 0))

    unknown = 0xFFFFFFFF
    wave_file("wave_rf64.wav", "RF64", riff(sizes(len(body)), form, chunk(b"data", body, unknown), chunk(b"LIST", b"INFO"),
              tag=b"RF64", size=unknown))  # fmt: skip
    wave_file("wave_rf64_piped.wav", "RF64 whose writer could not seek",
              riff(sizes(0), form, chunk(b"data", body, unknown), tag=b"RF64", size=unknown), unsaid)  # fmt: skip

    def wave64(tag: bytes, content: bytes, size: int | None = None) -> bytes:
        whole = len(content) + 24 if size is None else size
        rest = b"\xf3\xac\xd3\x11\x8c\xd1\x00\xc0\x4f\x8e\xdb\x8a"
        return tag + rest + struct.pack("<Q", whole) + content + b"\0" * (-len(content) % 8)

    riff64 = b"riff\x2e\x91\xcf\x11\xa5\xd6\x28\xdb\x04\xc1\x00\x00"
    wave_id = b"wave\xf3\xac\xd3\x11\x8c\xd1\x00\xc0\x4f\x8e\xdb\x8a"
    chunks = wave64(b"fmt ", form[8:]) + wave64(b"fact", struct.pack("<Q", len(s.wave))) + wave64(b"levl", b"odd")
    for name, size, notes in (("wave.w64", len(body) + 24, ()), ("wave_piped.w64", 0, unsaid)):
        wave_file(name, "Sony Wave64", riff64 + struct.pack("<Q", 0) + wave_id + chunks + wave64(b"data", body, size),
                  notes)  # fmt: skip
    write("wave_cut.w64", (riff64 + struct.pack("<Q", 0) + wave_id + chunks + wave64(b"data", body))[:-500])
    sidecar("wave_cut.json", full_scale_mps2=25.0)
    refuse("wave_cut.w64", "half a Wave64 file", "FILE: cannot be read to its end")
    write("wave_cut_rf64.wav", riff(sizes(len(body)), form, chunk(b"data", body[:300], unknown), tag=b"RF64"))
    sidecar("wave_cut_rf64.json", full_scale_mps2=25.0)
    refuse("wave_cut_rf64.wav", "half an RF64 file", "FILE: cannot be read to its end")
    write("wave_empty.wav", riff(form, chunk(b"data", b""), chunk(b"LIST", b"INFO")))
    sidecar("wave_empty.json", full_scale_mps2=25.0)
    refuse("wave_empty.wav", "no sample, which another chunk after it shows", "FILE: 0 samples; expected 4 at least")
    write("flac.wav", b"fLaC" + body)
    sidecar("flac.json", full_scale_mps2=25.0)
    refuse("flac.wav", "another format under the name of WAV", "FILE: is FLAC; expected a WAV file")
    write("wave_stereo.wav", wav(np.column_stack([scaled, scaled]), 2000, 16))
    sidecar("wave_stereo.json", full_scale_mps2=25.0)
    refuse("wave_stereo.wav", "two channels", "FILE: 2 channels; expected 1 or 3: one axis, or X, Y and Z")


def make_laboratory_tables() -> None:
    """What spreadsheets and instruments make of a table."""
    s = Stroke(1000.0, 0.5)
    text = table(plain(s))
    rows = text.splitlines()

    def answer(name: str, why: str, *notes: str, force: _Numbers = s.force) -> None:
        read(name, why, 1000.0, s.wave, s.speed, force, notes=notes)

    def beside(heads: str, cells: str, rows: Sequence[str] = rows) -> str:
        return "\n".join([rows[0] + heads, *(row + cells for row in rows[1:])]) + "\n"

    ignored = "are not known and are ignored"
    write("empty_columns.csv", beside(",,,", ",,,"))
    answer("empty_columns.csv", "a spreadsheet's empty columns", f"columns (without a name) {ignored}")
    write("repeated_columns.csv", beside(",Untitled,Untitled", ",0.1,7"))
    answer("repeated_columns.csv", "ignored columns of one name", f"columns Untitled {ignored}")
    write("quoted_columns.csv", beside(',"Remark, of the ""day"""', ',"rough, then\n""smooth"", 5"'))
    answer("quoted_columns.csv", "an ignored column with separators, quotes and line ends in its cells",
           f'columns Remark, of the ""day"" {ignored}')  # fmt: skip
    write("inches.csv", beside(",Size", ',5"'))
    answer("inches.csv", "a quote that opens nothing", f"columns Size {ignored}")
    write("latin1.csv", beside(",Temp (\xb0C),Ma\xdf", ",21\xb0,\xfc").encode("latin-1"))
    answer("latin1.csv", "an ignored column in Latin-1", f"columns Temp (\\xB0C), Ma\\xDF {ignored}")
    write("left_off.csv", beside(",Remark,,", "", rows[:-1]) + rows[-1] + ",smooth,,\n")
    answer("left_off.csv", "rows without the empty cells of ignored columns at their ends")
    _answers[-1]["notes"] = [f"columns Remark, (without a name) {ignored}"]
    write("semicolons.csv", text.replace(",", ";"))
    answer("semicolons.csv", "semicolons between columns")
    write("tabs.csv", text.replace(",", "\t"))
    answer("tabs.csv", "tabs between columns")
    write("blanks.csv", "".join("  " + line.replace(",", "   ") + " \n" for line in rows))
    answer("blanks.csv", "blanks between columns")
    write("excel.csv", "sep=;\r\n" + text.replace(",", ";").replace(".", ",").replace("\n", "\r\n"))
    answer("excel.csv", "Excel's line sep=; and its decimal commas")
    write("excel_bars.csv", '"sep=|"\n' + text.replace(",", "|"))
    answer("excel_bars.csv", "a separator that only the line sep= names")
    write("quoted_commas.csv", "\n".join(",".join(f'"{cell.replace(".", ",")}"' for cell in row.split(","))
          for row in rows) + "\n")  # fmt: skip
    answer("quoted_commas.csv", "decimal commas in quotes")
    write("comment.csv", "# " + text.replace(",", " "))
    answer("comment.csv", "names behind a mark of comments, as NumPy writes them")
    write("carriage_returns.csv", text.replace("\n", "\r"))
    answer("carriage_returns.csv", "lines that end with a carriage return alone")
    write("minus_signs.csv", text.replace("-", "\u2212"))
    answer("minus_signs.csv", "the minus sign of Swedish programs")
    words = ["N/A", "null", "NULL", "None", "NaN", "#N/A", "na", "-nan(ind)", "-", ""]
    cells = [f"{force:.6f}" if i % 8 == 0 or i == len(s.time) - 1 else words[i % len(words)]
             for i, force in enumerate(s.force)]  # fmt: skip
    write("words_for_nothing.csv", table(plain(s, force_newtons=cells)))
    answer("words_for_nothing.csv", "words for a missing number")
    write("mixed_marks.csv", text.replace(",", ";").replace("0.08", "0,08"))
    refuse("mixed_marks.csv", "points and commas in the numbers of one file", "expected a number with a decimal point")
    write("known_twice.csv", beside(",speed_mps", ",0.1"))
    refuse("known_twice.csv", "a known column twice", "FILE: column speed_mps twice; expected it once")
    write("truncated.csv", "\n".join([*rows[:-1], ",".join(rows[-1].split(",")[:3])]))
    refuse("truncated.csv", "a last row that was cut", "FILE:501: 3 values; expected 4 as in the first line")


def make_signs_of_force() -> None:
    """A force whose sign or zero is not what the column says, and what corrects it."""
    s = Stroke(1000.0, 2.0)
    still = s.speed < 0.05
    sliding = ~still

    def measured(name: str, force: _Numbers, **words: Any) -> None:
        write(f"{name}.csv", table(plain(s, force_newtons=force), {"force_newtons": "%.3f"}))
        if words:
            sidecar(f"{name}.json", **words)

    keys = 'give the key "force_sign": -1 in'
    measured("compression", -s.force)
    refuse("compression.csv", "pressing counted as negative", "FILE: force_newtons is negative in 100 % of the "
           "sliding, between -1.5 N and -0.9 N; expected a force that grows from 0 as the tip presses: where pressing "
           f"counts as negative, {keys} compression.json or --force-sign -1")  # fmt: skip
    measured("compression_known", -s.force, force_sign=-1)
    read("compression_known.csv", "the sidecar says the sign", 1000.0, s.wave, s.speed, s.force)
    low = s.force - 1.2
    share = 100.0 * np.mean(low[s.speed > 0.2 * np.quantile(s.speed, 0.95)] < -0.03)
    assert 20.0 < share < 80.0
    measured("offset", low)
    refuse("offset.csv", "a sensor that was zeroed while pressed", f"FILE: force_newtons is negative in {share:.3g} % "
           "of the sliding, between -0.3 N and 0.3 N; expected a force that grows from 0 as the tip presses: where the "
           'sensor was not zeroed, subtract what it reads in the air, by the key "force_rest_newtons"')  # fmt: skip
    measured("offset_known", low, force_rest_newtons=-1.2)
    read("offset_known.csv", "the sidecar says what the sensor reads at rest", 1000.0, s.wave, s.speed, s.force)
    measured("offset_turned", -low, force_sign=-1, force_rest_newtons=1.2)
    read("offset_turned.csv", "sign and rest: the rest is what the column reads", 1000.0, s.wave, s.speed, s.force)
    measured("drift_down", s.force - 1.5 * s.time)
    refuse("drift_down.csv", "a sensor that drifts below nothing", "% of the sliding, between -1.5")
    measured("drift_up", s.force + 1.5 * s.time)
    read("drift_up.csv", "a force that rises while the level stays", 1000.0, s.wave, s.speed, s.force + 1.5 * s.time,
         notes=["over the recording, and the level does not follow; does the sensor drift?"])  # fmt: skip
    strong = s.wave * s.force / 1.2
    write("turned_above_zero.csv", table(plain(s, acceleration_mps2=strong, force_newtons=3.0 - s.force)))
    read("turned_above_zero.csv", "pressing counted as negative from a rest of 3 N", 1000.0, strong, s.speed,
         3.0 - s.force, notes=["force_newtons: the vibration grows weaker where it grows, as force^-1", "does the "
         "column count pressing as negative?"])  # fmt: skip
    write("follows.csv", table(plain(s, acceleration_mps2=strong)))
    read("follows.csv", "a vibration that grows with the force", 1000.0, strong, s.speed, s.force)
    lifted = np.where(s.time > 1.2, 0.0, 1.0)
    quiet = s.wave * lifted + 0.0005 * np.random.default_rng(4).standard_normal(len(s.time))
    write("rest_in_air.csv", table(plain(s, acceleration_mps2=quiet, force_newtons=s.force * lifted + 0.5)))
    read("rest_in_air.csv", "a sensor that measures a force in the air", 1000.0, quiet, s.speed, s.force * lifted + 0.5,
         notes=["force_newtons is 0.5 N where the tip moves without a sound, which is in the air; is the sensor "
                "zeroed?"])  # fmt: skip
    air = s.force * lifted - 0.05 * (1.0 - lifted)
    write("zero_below.csv", table(plain(s, acceleration_mps2=quiet, force_newtons=air)))
    read("zero_below.csv", "a zero a little below nothing in the air", 1000.0, quiet, s.speed, s.force * lifted,
         notes=["force_newtons is below 0 in 40 % of its samples, down to -0.05 N, and taken as 0 there; is the sensor "
                "zeroed?"])  # fmt: skip


def make_broken_files() -> None:
    s = Stroke(1000.0, 0.2)
    text = table(plain(s))
    rows = text.splitlines()
    write("decimal_commas.csv", "\n".join([rows[0], *(row.replace(".", ",") for row in rows[1:])]) + "\n")
    refuse("decimal_commas.csv", "decimal commas", "FILE:2: 8 values; expected 4 as in the first line (decimals need "
           "a point, not a comma)")  # fmt: skip
    cells = rows[10].split(",")
    write("text_cell.csv", "\n".join([*rows[:10], ",".join([*cells[:2], "fast", cells[3]]), *rows[11:]]) + "\n")
    refuse("text_cell.csv", "a word among the numbers", 'FILE:11: column speed_mps: is "fast"; expected a number with '
           'a decimal point')  # fmt: skip
    write("utf16.csv", b"\xff\xfe" + text.encode("utf-16-le"))
    refuse("utf16.csv", "UTF-16", "FILE: is text in UTF-16; expected a table in UTF-8: save it as CSV UTF-8")
    write("binary.csv", bytes(range(256)) * 8)
    refuse("binary.csv", "no text at all", "FILE: is not text: it has bytes of zero; expected a table in UTF-8")
    write("empty.csv", "")
    refuse("empty.csv", "an empty file", "FILE: is empty; expected a table (CSV)")
    write("short.csv", "\n".join(rows[:4]) + "\n")
    refuse("short.csv", "three rows", "FILE: 3 rows; expected 4 rows at least")
    write("two_forms.csv", table(plain(s, speed_mmps=1000.0 * s.speed)))
    refuse("two_forms.csv", "the motion twice", "FILE: motion in several forms (speed_mps and speed_mmps); expected "
           "one of velocity_x_mps, velocity_y_mps | speed_mps")  # fmt: skip
    axes = s.axes()
    write("two_axes.csv", table({"time_s": s.time, "acceleration_x_mps2": axes[:, 0], "acceleration_y_mps2":
          axes[:, 1], "speed_mps": s.speed, "force_newtons": s.force}))  # fmt: skip
    refuse("two_axes.csv", "two axes of three", "without acceleration_z_mps2; expected acceleration_x_mps2, "
           "acceleration_y_mps2, acceleration_z_mps2")  # fmt: skip
    write("table.parquet", b"PAR1")
    refuse("table.parquet", "Parquet", "FILE: has the ending '.parquet'; expected a recording that ends with .csv, "
           ".wav or .w64")  # fmt: skip


def make_wrong_units() -> None:
    s = Stroke(1000.0, 0.5)
    axes = s.axes()

    def three(unit: str, factor: float) -> str:
        columns = {f"acceleration_{axis}_{unit}": factor * axes[:, place] for place, axis in enumerate("xyz")}
        return table({"time_s": s.time} | columns | {"speed_mps": s.speed, "force_newtons": s.force})

    write("mps2_as_g.csv", three("g", 1.0))
    refuse("mps2_as_g.csv", "m/s^2 under a heading of g", "which looks like m/s^2; expected g (1 at rest); name the "
           "columns acceleration_x_mps2 and so on where they are in m/s^2")  # fmt: skip
    write("g_as_mps2.csv", three("mps2", 1.0 / GRAVITY_MPS2))
    refuse("g_as_mps2.csv", "g under a heading of m/s^2", "which looks like g; expected m/s^2 (9.8 at rest); name the "
           "columns acceleration_x_g and so on where they are in g")  # fmt: skip
    write("mg_as_g.csv", three("g", 1000.0 / GRAVITY_MPS2))
    refuse("mg_as_g.csv", "mg under a heading of g", "which looks like mg; expected g (1 at rest): divide by 1000")
    write("mm_as_m.csv", table(plain(s, speed_mps=1000.0 * s.speed)))
    refuse("mm_as_m.csv", "mm/s under a heading of m/s", "m/s; expected m/s; name the column speed_mmps where it is in "
           "mm/s")  # fmt: skip
    write("millinewtons.csv", table(plain(s, force_newtons=1000.0 * s.force)))
    refuse("millinewtons.csv", "mN under a heading of N", "N in the median; expected newtons; name the column "
           "force_millinewtons where it is in mN")  # fmt: skip


def make_sensor_faults() -> None:
    s = Stroke(1000.0, 0.5)
    spike = s.force.copy()
    spike[250] = 505831.0
    write("force_spike.csv", table(plain(s, force_newtons=spike)))
    refuse("force_spike.csv", "a spike of the force", "FILE:252: column force_newtons: has a spike of 505831 N where "
           "1.5 N is usual; expected no glitches: leave the cell empty")  # fmt: skip
    jump = 1000.0 * s.position
    jump[300:] += 200.0
    write("jump.csv", table({"time_s": s.time, "acceleration_mps2": s.wave, "position_x_mm": jump,
          "position_y_mm": 0.0 * jump, "force_newtons": s.force}))  # fmt: skip
    refuse("jump.csv", "a jump of the tracker", "FILE:302: column position_x_mm: jumps with 200 m/s; expected a "
           "tracker without jumps, at most 10 m/s: leave the cell empty")  # fmt: skip
    tone = 6.0 * np.sin(2.0 * np.pi * 40.0 * s.time)
    write("clipped.csv", table(plain(s, acceleration_mps2=np.clip(tone, -4.0, 4.0)), {"time_s": "%.3f"}))
    refuse("clipped.csv", "half of the wave is clipped", "FILE: acceleration_mps2 is clipped in")
    few = s.wave.copy()
    few[np.argmax(few) : np.argmax(few) + 4] = few.max()
    write("slightly_clipped.csv", table(plain(s, acceleration_mps2=few)))
    read("slightly_clipped.csv", "four clipped samples are said and used", 1000.0, few, s.speed, s.force,
         notes=["acceleration_mps2 is clipped in 0.8 % of its samples, which are used as they are"])  # fmt: skip
    frozen = s.wave.copy()
    frozen[100:350] = frozen[100]
    write("frozen.csv", table(plain(s, acceleration_mps2=frozen)))
    left = np.concatenate([frozen[:100], frozen[350:]])
    read("frozen.csv", "a sensor that stands still for 0.25 s was not measuring", 1000.0, left, s.speed, s.force,
         missing=250, samples=500, tolerance=0.02,
         notes=["the acceleration stays the same in 50 % of its samples, from 0.1 s on; these are left out"])  # fmt: skip
    write("dead.csv", table(plain(s, acceleration_mps2=2.5 + 0.0 * s.wave)))
    refuse("dead.csv", "a dead sensor", "FILE: the acceleration never changes; expected a sensor that is connected")
    slow = Stroke(1000.0, 5.0, hertz=0.4)
    shifted = np.interp(slow.time - 0.15, slow.time, slow.speed)
    # The level must say where the motion is: more of it than a hand's.
    strong = slow.wave * (slow.speed / 0.08) ** 2
    write("late.csv", table(plain(slow, speed_mps=shifted, acceleration_mps2=strong), {"acceleration_mps2": "%.3f",
          "speed_mps": "%.4f", "force_newtons": "%.2f", "time_s": "%.3f"}))  # fmt: skip
    read("late.csv", "a motion that is 150 ms late, which another clock or a filter makes", 1000.0, strong, shifted,
         slow.force, notes=["the motion seems to be 14", "0 ms late: shifted so"])  # fmt: skip


def main() -> None:
    for make in (
        make_columns, make_clocks, make_sidecars, make_waves, make_laboratory_tables, make_signs_of_force, make_broken_files,
        make_wrong_units, make_sensor_faults,
    ):  # fmt: skip
        make()
    (FOLDER / "expected.json").write_text(json.dumps(_answers, indent=1) + "\n", encoding="utf-8")
    print(f"{len(_answers)} recordings")


if __name__ == "__main__":
    main()
