#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::cli {

/// How many letters must be added, removed, changed or swapped with their neighbour to make one word of the other;
/// capitals count as small letters, `_` and `-` as a space.
[[nodiscard]] std::size_t lettersApart(std::string_view one, std::string_view other);

/// The `count` candidates nearest to a word, the nearest first; of equally near ones those that hold the word, or are
/// held by it, then in the order given.
[[nodiscard]] std::vector<std::string> nearestWords(std::string_view word, std::span<const std::string> candidates,
                                                    std::size_t count);

/// "did you mean 'a', 'b' or 'c'?"
[[nodiscard]] std::string didYouMean(std::span<const std::string> words);

/// The candidate that a misspelt word was meant to be; empty where none is near enough.
[[nodiscard]] std::string meantWord(std::string_view word, std::span<const std::string> candidates);

}  // namespace haptoflow::cli
