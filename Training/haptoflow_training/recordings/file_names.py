"""Names of recordings' files, whose endings may be in either case (some recorders and Windows write .CSV and .WAV)."""

from __future__ import annotations

from pathlib import Path


def ending_of(path: Path) -> str:
    """The ending in lower case, with its dot."""
    return path.suffix.lower()


def beside(path: Path, name: str) -> Path:
    """The file `name` in the folder of `path`, in whatever case it is written there; as given if there is none, or if
    one of exactly this name exists."""
    wanted = path.parent / name
    if wanted.is_file() or not path.parent.is_dir():
        return wanted
    same = sorted(one for one in wanted.parent.glob("*") if one.name.lower() == wanted.name.lower() and one.is_file())
    return same[0] if same else wanted


def sidecar_of(path: Path) -> Path:
    """NAME.json of a recording, whether it exists or not."""
    return beside(path, path.with_suffix(".json").name)
