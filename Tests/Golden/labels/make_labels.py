"""Makes the pairs of spellings of this folder, labels.json, and the tables of letters that native code compares by.

A label is the same if its canonical decomposition (Unicode, NFD, which is equal where NFC is) is the same in capitals,
letter by letter. Run it with Debian's Python: `/usr/bin/python3 Tests/Golden/labels/make_labels.py`; it gives the same
bytes every time.
"""

from __future__ import annotations

import json
import unicodedata
from collections.abc import Iterator
from pathlib import Path

FOLDER = Path(__file__).parent
TABLES = FOLDER.parents[2] / "NativePlugin" / "src" / "model" / "letter_tables.hpp"
LETTERS = [chr(code) for code in range(0x80, 0x30000) if not 0xD800 <= code < 0xE000]
# Composed by a formula.
HANGUL = range(0xAC00, 0xD7A4)


def capital(letter: str) -> str:
    """One letter, as .NET's invariant culture makes it: none of ASCII for one that is not."""
    upper = letter.upper()
    return upper if len(upper) == 1 and (upper > "\x7f") == (letter > "\x7f") else letter


def key(label: str) -> str:
    return "".join(map(capital, unicodedata.normalize("NFD", label)))


def decompositions() -> Iterator[tuple[int, int, int]]:
    """Letter, first part and second part or 0. Without the ideographs that only other standards had twice, and without
    small letters that decompose as their capitals do."""
    for letter in LETTERS:
        if capital(letter) != letter and unicodedata.decomposition(capital(letter)) and key(letter) == key(capital(letter)):
            continue
        words = unicodedata.decomposition(letter).split()
        is_twice = unicodedata.name(letter, "").startswith("CJK COMPATIBILITY IDEOGRAPH")
        if words and not words[0].startswith("<") and not is_twice and ord(letter) not in HANGUL:
            parts = [int(word, 16) for word in words]
            yield ord(letter), parts[0], parts[1] if len(parts) > 1 else 0


def runs(values: dict[int, int]) -> Iterator[tuple[int, ...]]:
    """First, number and value of letters of one value at every code; at every other one, with 2 as a fourth number."""
    codes = sorted(values)
    while codes:
        first = codes[0]
        lengths = {1: 1, 2: 1}
        for step in lengths:
            while values.get(first + lengths[step] * step) == values[first]:
                lengths[step] += 1
        step = 2 if lengths[2] > lengths[1] else 1
        run = {first + index * step for index in range(lengths[step])}
        yield (first, len(run), values[first], *([2] if step == 2 else []))
        codes = [code for code in codes if code not in run]


def array(name: str, kind: str, what: str, rows: list[tuple[int, ...]]) -> str:
    lines = [f"/// {what}", f"inline constexpr std::array<{kind}, {len(rows)}> {name}{{{{"]
    line = "   "
    for row in rows:
        entry = " {" + ", ".join(f"0x{number:X}" if number > 0xFF else str(number) for number in row) + "},"
        if len(line) + len(entry) > 120:
            lines.append(line)
            line = "   "
        line += entry
    return "\n".join([*lines, line, "}};"])


def write_tables() -> None:
    classes = runs({ord(each): unicodedata.combining(each) for each in LETTERS if unicodedata.combining(each)})
    capitals = runs({ord(each): ord(capital(each)) - ord(each) for each in LETTERS if capital(each) != each})
    TABLES.write_text(
        "#pragma once\n\n#include <array>\n#include <cstdint>\n\n"
        "// Made by Tests/Golden/labels/make_labels.py from the Unicode character database, "
        f"{unicodedata.unidata_version}.\n// clang-format off\n\n"
        "namespace haptoflow::model {\n\n"
        "/// A letter and what it decomposes to; the second part is 0 where there is one.\n"
        "struct Decomposition {\n    char32_t letter;\n    char32_t first;\n    char32_t second;\n};\n\n"
        "/// The letters first, first + step and so on, and their value.\n"
        "struct LetterRun {\n    char32_t first;\n    std::uint32_t count;\n    std::int32_t value;\n    std::uint32_t step = 1;\n};\n\n"
        + array("decompositions", "Decomposition", "In the order of their letters.", list(decompositions())) + "\n\n"
        + array("combiningClasses", "LetterRun", "Canonical combining classes other than 0.", list(classes)) + "\n\n"
        + array("capitals", "LetterRun", "What is added to a letter for its capital.", list(capitals)) + "\n\n"
        "}  // namespace haptoflow::model\n",
        encoding="utf-8",
    )  # fmt: skip


def main() -> None:
    write_tables()
    spellings = [
        "wood", "Wood", "WOOD", "metal mesh", "\u00e4hre", "a\u0308hre", "\u00c4HRE", "A\u0308HRE", "ahre", "stra\u00dfe",
        "strasse", "STRASSE", "istanbul", "ISTANBUL", "\u0130stanbul", "\u0131stanbul", "I\u0307stanbul",
        "vi\u1ec7t", "vie\u0323\u0302t", "vie\u0302\u0323t", "VI\u1ec6T", "\u0395\u03bb\u03ba\u03b7", "\u03b5\u03bb\u03ba\u03b7",
        "\u03c3\u03c3", "\u03c3\u03c2", "\u0439", "\u0438\u0306", "\u0419", "\u304c", "\u304b\u3099", "\ud55c", "\u1112\u1161\u11ab",
        "\u212a", "k", "\u00e5", "\u212b", "A\u030a", "\u1e9b\u0323", "\u01f0", "J\u030c", "\u1fb3", "\u1fbc", "\u03b1\u0345",
        "\u092b\u093c", "\u095e", "\u0641\u0631\u0634", "\u5e03", "\u5e03 ", "\U0001f9f5", "caf\u00e9_1", "CAFE\u0301_1",
    ]  # fmt: skip
    groups: dict[str, list[str]] = {}
    for spelling in spellings:
        groups.setdefault(key(spelling), []).append(spelling)
    (FOLDER / "labels.json").write_text(json.dumps(list(groups.values()), indent=1) + "\n", encoding="utf-8")
    print(f"{len(spellings)} spellings of {len(groups)} labels")


if __name__ == "__main__":
    main()
