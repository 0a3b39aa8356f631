#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace haptoflow::model {

/// True if the text has a control character of ASCII: a line feed, a tab, an escape.
[[nodiscard]] bool hasControlCharacter(std::string_view text) noexcept;

[[nodiscard]] bool isUtf8(std::string_view text) noexcept;

/// The text for a message: control characters, of ASCII and of Unicode, and bytes that are not UTF-8 as "\x1B". A
/// terminal obeys the original.
[[nodiscard]] std::string printable(std::string_view text);

/// At most `bytes` bytes from the text's beginning, without a part of a character at the end.
[[nodiscard]] std::string_view shortened(std::string_view text, std::size_t bytes) noexcept;

/// A number with six significant digits at most and a decimal point, in every locale: "0.0823", "12.5", "1e-06".
[[nodiscard]] std::string shortNumber(double value);

/// Eight digits: "00c0ffee".
[[nodiscard]] std::string hexadecimal(std::uint32_t value);

/// What all spellings of one label have in common, in UTF-8: its canonical decomposition (Unicode's NFD, which is equal
/// where NFC is) in capitals, letter by letter and in no language. Bytes that are not UTF-8 stay as they are. The C# of
/// the Unity package compares labels alike, by the golden file Tests/Golden/labels.
[[nodiscard]] std::string labelKey(std::string_view label);

}  // namespace haptoflow::model
