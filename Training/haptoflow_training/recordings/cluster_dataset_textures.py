"""Reads texture_list.xlsx, which names the texture of an id."""

from __future__ import annotations

from pathlib import Path

from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError
from haptoflow_training.recordings.dataset_layout import TEXTURE_LIST_FILE, published_name
from haptoflow_training.recordings.dataset_writer import TextureEntry

_ID_HEADINGS = ("id", "texture id", "texture_id", "no", "no.", "number", "index", "#")
_NAME_HEADINGS = (
    "name", "texture name", "texture_name", "texture", "material", "material name", "material_name"
)
_EXPECTED = "a sheet with headings id and name"
_SEARCHED_ROWS = 10


def read_texture_list(root: Path) -> dict[int, TextureEntry]:
    """Entries by id; friction coefficients are the numeric columns whose heading contains friction or mu.

    The headings may stand below a title and be spelled in several ways. Empty if the file is missing; DatasetFileError
    if it cannot be understood.
    """
    import pandas

    path = Path(root) / TEXTURE_LIST_FILE
    if not path.is_file():
        return {}
    try:
        sheet = pandas.read_excel(path, header=None, engine="openpyxl")
    except Exception as error:  # a damaged workbook raises what zip, XML and openpyxl raise
        raise DatasetFileError(path, f"not a workbook ({error})", _EXPECTED) from error
    for row in range(min(_SEARCHED_ROWS, len(sheet))):
        headings = [str(cell).strip() for cell in sheet.iloc[row]]
        plain = [heading.casefold() for heading in headings]
        identifier = next((plain.index(heading) for heading in _ID_HEADINGS if heading in plain), None)
        name = next((plain.index(heading) for heading in _NAME_HEADINGS if heading in plain), None)
        if identifier is not None and name is not None:
            body = sheet.iloc[row + 1 :]
            break
    else:
        raise DatasetFileError(path, "no heading row with an id and a name", _EXPECTED)
    friction = [
        column for column, text in enumerate(plain) if "friction" in text or text in (
            "mu", "μ", "µ"
        ) or "cof" in text
    ]
    entries: dict[int, TextureEntry] = {}
    for _, cells in body.iterrows():
        number = pandas.to_numeric(cells.iloc[identifier], errors="coerce")
        text = cells.iloc[name]
        if pandas.isna(number) or pandas.isna(text):
            continue
        values = {
            headings[column]: pandas.to_numeric(cells.iloc[column], errors="coerce") for column in friction
        }
        entries[int(number)] = TextureEntry(
            int(number), str(text).strip(), {
                key: float(value) for key, value in values.items() if not pandas.isna(value)
            }
        )
    return entries


def texture_names(
    texture_ids: set[int], listed: dict[int, TextureEntry], *, published: bool
) -> dict[int, str]:
    """A name for every id: from the list, else the published one (for the published data set), else one derived from
    the id."""
    return {
        texture_id: listed[texture_id].name
        if texture_id in listed
        else (published_name(texture_id) if published else f"texture {texture_id}")
        for texture_id in sorted(texture_ids)
    }
