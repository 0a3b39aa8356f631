#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::headless {

/// Edit distance: the number of letters to add, remove, change or swap with their neighbour to turn one word into the
/// other (Damerau-Levenshtein). Case is ignored; `_` and `-` count as a space. Home-made: CLI11 has no suggestions.
[[nodiscard]] std::size_t lettersApart(std::string_view one, std::string_view other);

/// The `count` candidates nearest to a word, nearest first. Among equally near ones, those that contain the word or are
/// contained in it come first, then the given order decides.
[[nodiscard]] std::vector<std::string> nearestWords(std::string_view word, std::span<const std::string> candidates,
                                                    std::size_t count);

/// "did you mean 'a', 'b' or 'c'?"
[[nodiscard]] std::string didYouMean(std::span<const std::string> words);

/// The candidate that a misspelt word probably stands for; empty if none is near enough.
[[nodiscard]] std::string likelyWord(std::string_view word, std::span<const std::string> candidates);

}  // namespace haptoflow::headless
