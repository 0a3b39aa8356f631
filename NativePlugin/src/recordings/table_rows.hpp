#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::recordings {

/// The number that the whole text represents, with a decimal point in every locale and an optional plus sign. The minus
/// may be U+2212, as some languages write it. Empty for any other text, and for numbers too large or too small to
/// represent.
[[nodiscard]] std::optional<double> decimalNumber(std::string_view text);

/// A table of text as spreadsheets and instruments write it: its first row names the columns. Home-made: strokes and
/// recordings need the number of a line for errors, and the build has no CSV library.
///
/// Between the columns are commas, semicolons, tabs or blanks: whichever gives the first row the most of the names that
/// the reader knows, or the one that a line `sep=;` before it names. Rows end with a line feed, a carriage return or
/// both. Cells may be quoted, with separators, line ends and doubled quotes inside. Numbers may have a decimal comma
/// where it separates no columns, in all cells or in none.
class TableRows {
public:
    /// Reads the first row. Text and names must outlive the object.
    TableRows(std::string_view text, std::span<const std::string_view> knownNames);

    /// The first row's cells; empty for an empty text.
    [[nodiscard]] const std::vector<std::string_view>& names() const noexcept { return names_; }

    /// Moves to the next row; returns false at the end of the text.
    bool next();
    /// Cells of the present row, without quotes and blanks at their ends; one empty cell for an empty line.
    [[nodiscard]] const std::vector<std::string_view>& cells() const noexcept { return cells_; }
    /// Number of the line that the present row begins in, from 1.
    [[nodiscard]] std::size_t number() const noexcept { return line_; }
    /// Whether no cell of the present row has text.
    [[nodiscard]] bool isBlank() const;
    /// Whether the present row has as many cells as the first, apart from empty ones after its last name.
    [[nodiscard]] bool isComplete() const;

    /// A cell of the present row, written with a decimal point; empty if it is no number.
    [[nodiscard]] std::optional<double> decimal(std::size_t column);
    /// The same text with a decimal point in place of a decimal comma.
    [[nodiscard]] std::string withPoint(std::size_t column) const;

private:
    /// A row's end and the number of line ends in it.
    struct Extent {
        std::size_t next = 0;
        std::size_t lines = 0;
    };
    Extent read(std::size_t start, char separator, std::vector<std::string_view>& cells);
    Extent readQuoted(std::size_t start, char separator, std::vector<std::string_view>& cells) const;
    [[nodiscard]] std::size_t lineEnd(std::size_t start);
    [[nodiscard]] std::size_t afterLineEnd(std::size_t end) const;
    void takeSeparatorLine();

    std::string_view text_;
    std::size_t at_ = 0;
    /// The first line feed at or after the place that was asked last.
    std::size_t feed_ = 0;
    char separator_ = ',';
    bool isSeparatorGiven_ = false;
    /// The mark that the numbers so far have; 0 while none had one.
    char decimalMark_ = 0;
    std::vector<std::string_view> names_;
    std::vector<std::string_view> cells_;
    std::size_t line_ = 0;
    std::size_t nextLine_ = 1;
};

/// The name of an encoding that is no UTF-8, if the text's first bytes show it: "text in UTF-16". Empty for others.
[[nodiscard]] std::string_view otherEncoding(std::string_view text);

/// True for the words that stand for a missing number: nothing, nan, N/A, null and their kin, in any case.
[[nodiscard]] bool isMissing(std::string_view cell);

/// Of ASCII letters.
[[nodiscard]] std::string lowerCase(std::string_view text);

/// The text without `blank` characters at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text, std::string_view blank = " \t\r");

}  // namespace haptoflow::recordings
