#include "model/plain_text.hpp"

#include "model/letter_tables.hpp"

#include <algorithm>
#include <array>
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

/// The first character of UTF-8 text, which it loses.
char32_t takeLetter(std::string_view& text) {
    const std::size_t count = characterBytes(text);
    char32_t letter = count == 1 ? byteAt(text, 0) : byteAt(text, 0) & (0x7FU >> count);
    for (std::size_t index = 1; index < count; ++index) {
        letter = letter << 6U | (byteAt(text, index) & 0x3FU);
    }
    text.remove_prefix(count);
    return letter;
}

void appendLetter(std::string& text, char32_t letter) {
    const auto append = [&text](char32_t byte) { text += static_cast<char>(static_cast<unsigned char>(byte)); };
    if (letter < 0x80) {
        append(letter);
    } else if (letter < 0x800) {
        append(0xC0 | letter >> 6U);
        append(0x80 | (letter & 0x3F));
    } else if (letter < 0x10000) {
        append(0xE0 | letter >> 12U);
        append(0x80 | (letter >> 6U & 0x3F));
        append(0x80 | (letter & 0x3F));
    } else {
        append(0xF0 | letter >> 18U);
        append(0x80 | (letter >> 12U & 0x3F));
        append(0x80 | (letter >> 6U & 0x3F));
        append(0x80 | (letter & 0x3F));
    }
}

template <std::size_t Count>
std::int32_t valueOf(const std::array<LetterRun, Count>& runs, char32_t letter) {
    const auto run = std::ranges::find_if(runs, [letter](const LetterRun& each) {
        return letter >= each.first && (letter - each.first) / each.step < each.count &&
               (letter - each.first) % each.step == 0;
    });
    return run == runs.end() ? 0 : run->value;
}

char32_t capitalOf(char32_t letter) {
    return letter >= U'a' && letter <= U'z'
               ? letter - U'a' + U'A'
               : static_cast<char32_t>(static_cast<std::int32_t>(letter) + valueOf(capitals, letter));
}

/// Null for a letter that does not decompose.
const Decomposition* decompositionOf(char32_t letter) {
    const auto* const found =
        std::lower_bound(decompositions.begin(), decompositions.end(), letter,
                         [](const Decomposition& each, char32_t wanted) { return each.letter < wanted; });
    return found != decompositions.end() && found->letter == letter ? found : nullptr;
}

void decompose(char32_t letter, std::u32string& letters) {
    constexpr char32_t firstSyllable = 0xAC00;
    constexpr char32_t syllables = 11172;
    constexpr char32_t vowels = 21;
    constexpr char32_t finals = 28;
    if (letter >= firstSyllable && letter < firstSyllable + syllables) {
        const char32_t index = letter - firstSyllable;
        letters += static_cast<char32_t>(0x1100 + index / (vowels * finals));
        letters += static_cast<char32_t>(0x1161 + index / finals % vowels);
        if (index % finals > 0) {
            letters += static_cast<char32_t>(0x11A7 + index % finals);
        }
        return;
    }
    const auto* found = decompositionOf(letter);
    if (found == nullptr) {
        // The table leaves out small letters that decompose as their capitals do.
        found = decompositionOf(capitalOf(letter));
    }
    if (found == nullptr) {
        letters += letter;
        return;
    }
    decompose(found->first, letters);
    if (found->second != 0) {
        decompose(found->second, letters);
    }
}

/// Marks on one letter that do not touch each other come in the order of their classes.
void orderMarks(std::u32string& letters) {
    const auto classOf = [](char32_t letter) { return valueOf(combiningClasses, letter); };
    for (auto first = letters.begin(); first != letters.end();) {
        if (classOf(*first) == 0) {
            ++first;
            continue;
        }
        const auto last = std::find_if(first, letters.end(), [&](char32_t letter) { return classOf(letter) == 0; });
        std::stable_sort(first, last, [&](char32_t a, char32_t b) { return classOf(a) < classOf(b); });
        first = last;
    }
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

std::string labelKey(std::string_view label) {
    if (!isUtf8(label)) {
        return std::string(label);
    }
    std::u32string letters;
    while (!label.empty()) {
        decompose(takeLetter(label), letters);
    }
    orderMarks(letters);
    std::string key;
    for (const char32_t letter : letters) {
        appendLetter(key, capitalOf(letter));
    }
    return key;
}

}  // namespace haptoflow::model
