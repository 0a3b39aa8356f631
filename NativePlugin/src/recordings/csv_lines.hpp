#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace haptoflow::recordings {

/// The lines of a CSV text, without a byte order mark. Home-made: strokes and recordings need the number of a line for
/// errors and no quoted commas, and the build has no CSV library.
class CsvLines {
public:
    /// The text must outlive the lines.
    explicit CsvLines(std::string_view text);

    /// Moves to the next line; returns false at the end of the text.
    bool next();
    /// The present line without its line feed.
    [[nodiscard]] std::string_view line() const noexcept { return line_; }
    /// Number of the present line, from 1; 0 before the first.
    [[nodiscard]] std::size_t number() const noexcept { return number_; }

private:
    std::string_view rest_;
    std::string_view line_;
    std::size_t number_ = 0;
};

/// Replaces the content of `cells` by the text between the line's commas, untrimmed; an empty line is one empty cell.
void splitCells(std::string_view line, std::vector<std::string_view>& cells);

/// The text without `blank` characters at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text, std::string_view blank = " \t\r");

}  // namespace haptoflow::recordings
