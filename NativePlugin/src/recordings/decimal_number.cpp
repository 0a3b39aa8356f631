#include "recordings/decimal_number.hpp"

#include <array>
#include <charconv>
#include <locale>
#include <sstream>
#include <string>
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

}  // namespace haptoflow::recordings
