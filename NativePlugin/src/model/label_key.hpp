#pragma once

#include <string>
#include <string_view>

namespace haptoflow::model {

/// What all spellings of one label have in common, in UTF-8: its canonical decomposition (Unicode's NFD, which is equal
/// where NFC is) in capitals, letter by letter and in no language. Bytes that are not UTF-8 stay as they are. The C# of
/// the Unity package compares labels alike, by the golden file Tests/Golden/labels.
[[nodiscard]] std::string labelKey(std::string_view label);

}  // namespace haptoflow::model
