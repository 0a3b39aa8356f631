#include "recordings/decimal_number.hpp"

#include <charconv>
#include <locale>
#include <sstream>
#include <string>
#include <system_error>
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

}  // namespace

std::optional<double> decimalNumber(std::string_view text) {
    if (text.starts_with('+') && !text.starts_with("+-")) {
        text.remove_prefix(1);
    }
    return unsignedOrNegative(text);
}

}  // namespace haptoflow::recordings
