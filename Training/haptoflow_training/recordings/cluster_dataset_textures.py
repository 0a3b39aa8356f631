"""Reads texture_list.xlsx, which names the texture of an id."""

from __future__ import annotations

from pathlib import Path

from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError
from haptoflow_training.recordings.dataset_layout import TEXTURE_LIST_FILE

_ID_HEADINGS = ("id", "texture id", "texture_id", "no", "no.", "number", "index", "#")
_NAME_HEADINGS = (
    "name", "texture name", "texture_name", "texture", "material", "material name", "material_name"
)
_EXPECTED = "a sheet with headings id and name"
_SEARCHED_ROWS = 10


def read_texture_list(root: Path) -> dict[int, str]:
    """Names by id.

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
        plain = [str(cell).strip().casefold() for cell in sheet.iloc[row]]
        identifier = next((plain.index(heading) for heading in _ID_HEADINGS if heading in plain), None)
        name = next((plain.index(heading) for heading in _NAME_HEADINGS if heading in plain), None)
        if identifier is not None and name is not None:
            body = sheet.iloc[row + 1 :]
            break
    else:
        raise DatasetFileError(path, "no heading row with an id and a name", _EXPECTED)
    numbers = pandas.to_numeric(body.iloc[:, identifier], errors="coerce")
    return {
        int(number): str(text).strip()
        for number, text in zip(numbers, body.iloc[:, name], strict=True)
        if not (pandas.isna(number) or pandas.isna(text))
    }
