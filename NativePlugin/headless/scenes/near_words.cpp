#include "headless/scenes/near_words.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace haptoflow::headless {
namespace {

std::string plain(std::string_view word) {
    std::string text(word);
    for (char& letter : text) {
        if (letter >= 'A' && letter <= 'Z') {
            letter = static_cast<char>(letter - 'A' + 'a');
        } else if (letter == '_' || letter == '-') {
            letter = ' ';
        }
    }
    return text;
}

}  // namespace

std::size_t lettersApart(std::string_view one, std::string_view other) {
    const std::string a = plain(one);
    const std::string b = plain(other);
    // Rows of the dynamic-programming table: [0] two letters before, [1] the previous letter, [2] the present one.
    std::array<std::vector<std::size_t>, 3> rows;
    rows.fill(std::vector<std::size_t>(b.size() + 1));
    for (std::size_t j = 0; j <= b.size(); ++j) {
        rows[1][j] = j;
    }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        rows[2][0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t changed = rows[1][j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U);
            rows[2][j] = std::min({rows[1][j] + 1, rows[2][j - 1] + 1, changed});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                rows[2][j] = std::min(rows[2][j], rows[0][j - 2] + 1);
            }
        }
        std::swap(rows[0], rows[1]);
        std::swap(rows[1], rows[2]);
    }
    return rows[1][b.size()];
}

std::vector<std::string> nearestWords(std::string_view word, std::span<const std::string> candidates,
                                      std::size_t count) {
    const std::string wanted = plain(word);
    std::vector<std::tuple<std::size_t, bool, std::size_t>> ranked;
    for (std::size_t index = 0; index < candidates.size(); ++index) {
        const std::string candidate = plain(candidates[index]);
        const bool holds = candidate.find(wanted) != std::string::npos || wanted.find(candidate) != std::string::npos;
        ranked.emplace_back(lettersApart(wanted, candidate), !holds, index);
    }
    std::ranges::sort(ranked);
    std::vector<std::string> nearest;
    for (std::size_t rank = 0; rank < std::min(count, ranked.size()); ++rank) {
        nearest.push_back(candidates[std::get<2>(ranked[rank])]);
    }
    return nearest;
}

std::string didYouMean(std::span<const std::string> words) {
    std::string text = "did you mean ";
    for (std::size_t index = 0; index < words.size(); ++index) {
        const bool isLast = index + 1 == words.size();
        text += (index == 0 ? "'" : isLast ? " or '" : ", '") + words[index] + "'";
    }
    return text + "?";
}

std::string likelyWord(std::string_view word, std::span<const std::string> candidates) {
    const std::vector<std::string> nearest = nearestWords(word, candidates, 1);
    const bool isNear =
        !nearest.empty() && lettersApart(word, nearest.front()) <= std::max<std::size_t>(1, word.size() / 3);
    return isNear ? nearest.front() : std::string();
}

}  // namespace haptoflow::headless
