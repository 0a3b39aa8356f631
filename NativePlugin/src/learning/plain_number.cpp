#include "learning/plain_number.hpp"

#include <cmath>
#include <locale>
#include <sstream>

namespace haptoflow::learning {

std::string plainNumber(double value) {
    constexpr double beyondDigits = 1000.0;
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(3);
    if (std::abs(value) >= beyondDigits) {
        text.precision(0);
        text << std::fixed;
    }
    text << value;
    return text.str();
}

}  // namespace haptoflow::learning
