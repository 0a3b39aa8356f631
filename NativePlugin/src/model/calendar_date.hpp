#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace haptoflow::model {

/// True if `text` is a valid date in the form YYYY-MM-DD.
[[nodiscard]] inline bool isCalendarDate(const std::string& text) {
    const std::string_view pattern = "0000-00-00";
    if (text.size() != pattern.size()) {
        return false;
    }
    for (std::size_t index = 0; index < text.size(); ++index) {
        const bool digit = text[index] >= '0' && text[index] <= '9';
        if (pattern[index] == '0' ? !digit : text[index] != '-') {
            return false;
        }
    }
    const int month = std::stoi(text.substr(5, 2));
    const int day = std::stoi(text.substr(8, 2));
    return month >= 1 && month <= 12 && day >= 1 && day <= 31;
}

}  // namespace haptoflow::model
