#include "recordings/table_rows.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <locale>
#include <sstream>
#include <system_error>
#include <utility>
#include <version>

namespace haptoflow::recordings {
namespace {

#ifdef __cpp_lib_to_chars

std::optional<double> unsignedOrNegative(std::string_view text) {
    double value = 0.0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size()) {
        return std::nullopt;
    }
    return value;
}

#else

// Before version 20, libc++'s from_chars reads whole numbers only.
std::optional<double> unsignedOrNegative(std::string_view text) {
    if (text.empty() || text.find_first_not_of("0123456789.eE+-") != std::string_view::npos || text.front() == '+') {
        return std::nullopt;
    }
    std::istringstream stream{std::string(text)};
    stream.imbue(std::locale::classic());
    double value = 0.0;
    stream >> value;
    if (stream.fail() || stream.peek() != std::istringstream::traits_type::eof()) {
        return std::nullopt;
    }
    return value;
}

#endif

constexpr std::string_view asciiOfNumbers = "0123456789.eE+-";
constexpr std::size_t longestForeignBytes = 64;
/// What programs write under other languages: the minus sign of Swedish and Persian, marks of direction before it, and
/// the decimal separator of Persian and Arabic.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> foreignMarks{
    {{"\xE2\x88\x92", "-"}, {"\xE2\x80\x8E", ""}, {"\xE2\x80\x8F", ""}, {"\xD9\xAB", "."}}};

}  // namespace

std::optional<double> decimalNumber(std::string_view text) {
    if (text.size() > longestForeignBytes || text.find_first_not_of(asciiOfNumbers) == std::string_view::npos) {
        if (text.starts_with('+') && !text.starts_with("+-")) {
            text.remove_prefix(1);
        }
        return unsignedOrNegative(text);
    }
    std::string plain(text);
    for (const auto& [foreign, ascii] : foreignMarks) {
        for (std::size_t at = plain.find(foreign); at != std::string::npos; at = plain.find(foreign, at)) {
            plain.replace(at, foreign.size(), ascii);
        }
    }
    return plain.find_first_not_of(asciiOfNumbers) == std::string::npos ? decimalNumber(plain) : std::nullopt;
}

namespace {

constexpr std::array separators{',', ';', '\t', ' '};
/// A quote that is not closed within so many bytes is a character of its cell.
constexpr std::size_t longestQuotedBytes = 65'536;

bool isBlankBeside(char character, char separator) {
    return (character == ' ' || character == '\t') && character != separator;
}

bool isLineEnd(char character) {
    return character == '\n' || character == '\r';
}

/// Splits a line without quoted cells.
void split(std::string_view line, char separator, std::vector<std::string_view>& cells) {
    if (separator == ' ') {
        line = trimmed(line);
    }
    for (std::size_t start = 0; start <= line.size();) {
        const std::size_t end = std::min(line.find(separator, start), line.size());
        cells.push_back(trimmed(line.substr(start, end - start)));
        start = separator == ' ' ? std::min(line.find_first_not_of(' ', end), line.size() + 1) : end + 1;
    }
}

}  // namespace

TableRows::TableRows(std::string_view text, std::span<const std::string_view> knownNames) : text_(text) {
    if (text_.starts_with("\xEF\xBB\xBF")) {
        text_.remove_prefix(3);
    }
    takeSeparatorLine();
    if (at_ == text_.size()) {
        return;
    }
    line_ = nextLine_;
    // Programs for numbers mark the names as a comment.
    at_ += text_[at_] == '#' ? 1U : 0U;
    Extent extent = read(at_, separator_, names_);
    const auto known = [&](const std::vector<std::string_view>& names) {
        return std::count_if(names.begin(), names.end(), [&](std::string_view name) {
            return std::ranges::find(knownNames, name) != knownNames.end();
        });
    };
    for (const char separator : separators) {
        std::vector<std::string_view> names;
        const Extent other = isSeparatorGiven_ ? extent : read(at_, separator, names);
        if (known(names) > known(names_)) {
            names_ = std::move(names);
            separator_ = separator;
            extent = other;
        }
    }
    at_ = extent.next;
    nextLine_ += extent.lines;
}

void TableRows::takeSeparatorLine() {
    const std::size_t end = lineEnd(0);
    std::string_view line = text_.substr(0, end);
    line.remove_prefix(line.starts_with('"') ? 1 : 0);
    constexpr std::string_view word = "sep=";
    if (lowerCase(line.substr(0, word.size())) != word) {
        return;
    }
    line.remove_prefix(word.size());
    // A spreadsheet fills the line up with separators.
    if (line.find_first_not_of(line.substr(0, 1)) != std::string_view::npos && line.substr(1) != "\"") {
        return;
    }
    isSeparatorGiven_ = !line.empty() && line.front() != '"';
    separator_ = isSeparatorGiven_ ? line.front() : ',';
    at_ = afterLineEnd(end);
    ++nextLine_;
}

std::size_t TableRows::lineEnd(std::size_t start) {
    if (feed_ < start || start == 0) {
        feed_ = std::min(text_.find('\n', start), text_.size());
    }
    const std::size_t length = text_.substr(start, feed_ - start).find('\r');
    return length == std::string_view::npos ? feed_ : start + length;
}

std::size_t TableRows::afterLineEnd(std::size_t end) const {
    return std::min(end + (text_.substr(end, 2) == "\r\n" ? 2 : 1), text_.size());
}

TableRows::Extent TableRows::read(std::size_t start, char separator, std::vector<std::string_view>& cells) {
    cells.clear();
    const std::size_t end = lineEnd(start);
    const std::string_view line = text_.substr(start, end - start);
    if (line.find('"') != std::string_view::npos) {
        return readQuoted(start, separator, cells);
    }
    split(line, separator, cells);
    return {.next = afterLineEnd(end), .lines = 1};
}

TableRows::Extent TableRows::readQuoted(std::size_t start, char separator, std::vector<std::string_view>& cells) const {
    Extent extent{.next = start, .lines = 1};
    const auto skipBlanks = [&](std::size_t place) {
        while (place < text_.size() &&
               (isBlankBeside(text_[place], separator) || (separator == ' ' && text_[place] == ' '))) {
            ++place;
        }
        return place;
    };
    const auto isCellEnd = [&](std::size_t place) {
        return place >= text_.size() || text_[place] == separator || isLineEnd(text_[place]);
    };
    /// The place of the quote that closes a cell; the place of the first one if none does.
    const auto closing = [&](std::size_t first) {
        const std::size_t limit = std::min(text_.size(), first + longestQuotedBytes);
        for (std::size_t place = first + 1; place < limit; ++place) {
            if (text_[place] == '"') {
                if (place + 1 < text_.size() && text_[place + 1] == '"') {
                    ++place;
                } else {
                    return isCellEnd(separator == ' ' ? place + 1 : skipBlanks(place + 1)) ? place : first;
                }
            }
        }
        return first;
    };
    std::size_t place = separator == ' ' ? skipBlanks(start) : start;
    while (true) {
        const std::size_t first = skipBlanks(place);
        const std::size_t last = first < text_.size() && text_[first] == '"' ? closing(first) : first;
        if (last > first) {
            const std::string_view cell = text_.substr(first + 1, last - first - 1);
            for (std::size_t i = 0; i < cell.size(); ++i) {
                extent.lines += cell[i] == '\n' || (cell[i] == '\r' && cell.substr(i, 2) != "\r\n") ? 1U : 0U;
            }
            cells.push_back(trimmed(cell));
            place = separator == ' ' ? last + 1 : skipBlanks(last + 1);
        } else {
            while (!isCellEnd(place)) {
                ++place;
            }
            cells.push_back(trimmed(text_.substr(first, place - first), " \t\r\""));
        }
        if (place < text_.size() && text_[place] == separator) {
            place = separator == ' ' ? skipBlanks(place) : place + 1;
            if (separator != ' ' || !isCellEnd(place)) {
                continue;
            }
        }
        extent.next = place < text_.size() ? afterLineEnd(place) : text_.size();
        return extent;
    }
}

bool TableRows::next() {
    if (at_ >= text_.size()) {
        return false;
    }
    const Extent extent = read(at_, separator_, cells_);
    at_ = extent.next;
    line_ = nextLine_;
    nextLine_ += extent.lines;
    return true;
}

bool TableRows::isBlank() const {
    return std::ranges::all_of(cells_, [](std::string_view cell) { return cell.empty(); });
}

bool TableRows::isComplete() const {
    return cells_.size() >= names_.size() &&
           std::all_of(cells_.begin() + static_cast<std::ptrdiff_t>(names_.size()), cells_.end(),
                       [](std::string_view cell) { return cell.empty(); });
}

std::optional<double> TableRows::decimal(std::size_t column) {
    const std::string_view cell = cells_[column];
    const std::size_t mark = cell.find_first_of(".,");
    if (mark != std::string_view::npos) {
        const bool isOther = decimalMark_ != 0 && decimalMark_ != cell[mark];
        if (isOther || cell.find_first_of(".,", mark + 1) != std::string_view::npos) {
            return std::nullopt;
        }
        decimalMark_ = cell[mark];
        if (decimalMark_ == ',') {
            return decimalNumber(withPoint(column));
        }
    }
    return decimalNumber(cell);
}

std::string TableRows::withPoint(std::size_t column) const {
    std::string text(cells_[column]);
    std::replace(text.begin(), text.end(), ',', '.');
    return text;
}

std::string_view otherEncoding(std::string_view text) {
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
        return "text in UTF-16";
    }
    return text.find('\0') != std::string_view::npos ? "not text: it has bytes of zero" : "";
}

bool isMissing(std::string_view cell) {
    constexpr std::array<std::string_view, 10> words{"nan",  "nan(ind)", "na",  "n/a",      "#n/a",
                                                     "null", "none",     "inf", "infinity", "-"};
    constexpr std::size_t longestWord = 9;
    if (cell.empty()) {
        return true;
    }
    // Nearly every cell is a number.
    if (cell.size() > longestWord || (cell.back() >= '0' && cell.back() <= '9')) {
        return false;
    }
    std::string word = lowerCase(cell);
    if (word.size() > 1 && (word.front() == '-' || word.front() == '+')) {
        word.erase(0, 1);
    }
    return std::ranges::find(words, word) != words.end();
}

std::string lowerCase(std::string_view text) {
    std::string lower(text);
    std::ranges::transform(lower, lower.begin(), [](char letter) {
        return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    });
    return lower;
}

std::string_view trimmed(std::string_view text, std::string_view blank) {
    const std::size_t first = text.find_first_not_of(blank);
    return first == std::string_view::npos ? std::string_view()
                                           : text.substr(first, text.find_last_not_of(blank) - first + 1);
}

}  // namespace haptoflow::recordings
