#include "model/plain_text.hpp"

#include <algorithm>
#include <cstddef>
#include <iomanip>
#include <locale>
#include <sstream>

namespace haptoflow::model {
namespace {

unsigned byteAt(std::string_view text, std::size_t index) noexcept {
    return static_cast<unsigned char>(text[index]);
}

bool isContinuation(unsigned byte) noexcept {
    return (byte & 0xC0U) == 0x80U;
}

bool isControl(unsigned byte) noexcept {
    return byte < 0x20U || byte == 0x7FU;
}

/// Bytes of the character that the text begins with; 0 if it is not UTF-8 (RFC 3629: no longer form than needed, no
/// surrogates, nothing above U+10FFFF). The text is not empty.
std::size_t characterBytes(std::string_view text) noexcept {
    const unsigned first = byteAt(text, 0);
    if (first < 0x80U) {
        return 1;
    }
    const std::size_t count = first < 0xC2U ? 0 : first < 0xE0U ? 2 : first < 0xF0U ? 3 : first < 0xF5U ? 4 : 0;
    if (count == 0 || text.size() < count) {
        return 0;
    }
    for (std::size_t index = 1; index < count; ++index) {
        if (!isContinuation(byteAt(text, index))) {
            return 0;
        }
    }
    const unsigned second = byteAt(text, 1);
    const bool isOutside = (first == 0xE0U && second < 0xA0U) || (first == 0xEDU && second >= 0xA0U) ||
                           (first == 0xF0U && second < 0x90U) || (first == 0xF4U && second >= 0x90U);
    return isOutside ? 0 : count;
}

void appendEscape(std::string& text, unsigned byte) {
    constexpr std::string_view digits = "0123456789ABCDEF";
    text += "\\x";
    text += digits[byte >> 4U];
    text += digits[byte & 0xFU];
}

}  // namespace

bool hasControlCharacter(std::string_view text) noexcept {
    return std::ranges::any_of(text, [](char each) { return isControl(static_cast<unsigned char>(each)); });
}

bool isUtf8(std::string_view text) noexcept {
    while (!text.empty()) {
        const std::size_t count = characterBytes(text);
        if (count == 0) {
            return false;
        }
        text.remove_prefix(count);
    }
    return true;
}

std::string printable(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const std::size_t count = std::max<std::size_t>(characterBytes(text), 1);
        const unsigned first = byteAt(text, 0);
        // U+0080 to U+009F are control characters, too: some terminals take U+009B for an escape sequence.
        const bool isUnicodeControl = count == 2 && first == 0xC2U && byteAt(text, 1) < 0xA0U;
        if (isControl(first) || isUnicodeControl || (count == 1 && first >= 0x80U)) {
            for (std::size_t index = 0; index < count; ++index) {
                appendEscape(result, byteAt(text, index));
            }
        } else {
            result += text.substr(0, count);
        }
        text.remove_prefix(count);
    }
    return result;
}

std::string_view shortened(std::string_view text, std::size_t bytes) noexcept {
    if (text.size() <= bytes) {
        return text;
    }
    while (bytes > 0 && isContinuation(byteAt(text, bytes))) {
        --bytes;
    }
    return text.substr(0, bytes);
}

std::string shortNumber(double value) {
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    stream << value;
    return stream.str();
}

std::string hexadecimal(std::uint32_t value) {
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    stream << std::hex << std::setw(8) << std::setfill('0') << value;
    return stream.str();
}

}  // namespace haptoflow::model
