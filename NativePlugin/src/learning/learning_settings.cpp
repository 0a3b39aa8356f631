#include "learning/learning_settings.hpp"

#include "model/header_node.hpp"
#include "model/plain_text.hpp"
#include "recordings/recording.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#if defined(_WIN32)
#include <windows.h>
#else
#include <ctime>
#endif

namespace haptoflow::learning {
namespace {

/// The rules of material files (header_node.hpp): a text that breaks them would be written and never read again.
void requireText(const std::string& text, std::size_t longest, const char* what) {
    if (text.size() > longest || !model::isUtf8(text) || model::hasControlCharacter(text)) {
        throw std::invalid_argument(std::string(what) + " is \"" + model::printable(model::shortened(text, 60)) +
                                    "\" (" + std::to_string(text.size()) + " bytes); expected one line of text in " +
                                    "UTF-8, without control characters, of " + std::to_string(longest) +
                                    " bytes at most");
    }
}

}  // namespace

void checkSettings(const LearningSettings& settings) {
    constexpr double maximumCyclesPerMillimetre = 20.0;
    const bool hasCapitals = std::ranges::any_of(settings.name, [](char each) { return each >= 'A' && each <= 'Z'; });
    requireText(settings.name, model::nameBytes, "name");
    if (settings.name.find_first_not_of(' ') == std::string::npos || hasCapitals) {
        throw std::invalid_argument("name is \"" + settings.name +
                                    "\"; expected text that is not blank and has no capital letters, as labels have");
    }
    requireText(settings.category, model::nameBytes, "category");
    requireText(settings.description, model::maximumTextBytes, "description");
    requireText(settings.licence, model::maximumTextBytes, "licence");
    requireText(settings.recordings, model::maximumTextBytes, "recordings");
    if (settings.waveVectors) {
        for (const double number : *settings.waveVectors) {
            if (!(std::abs(number) <= maximumCyclesPerMillimetre)) {
                throw std::invalid_argument("wave_vectors: " + recordings::plainNumber(number) +
                                            " cycles per millimetre; expected -20 to 20");
            }
        }
    }
}

double threadSeconds() noexcept {
#if defined(_WIN32)
    constexpr double secondsPerTick = 1e-7;
    FILETIME created;
    FILETIME ended;
    FILETIME kernel;
    FILETIME user;
    if (GetThreadTimes(GetCurrentThread(), &created, &ended, &kernel, &user) != 0) {
        const auto ticks = [](const FILETIME& time) {
            return static_cast<double>(time.dwHighDateTime) * 4294967296.0 + static_cast<double>(time.dwLowDateTime);
        };
        return secondsPerTick * (ticks(kernel) + ticks(user));
    }
#elif defined(CLOCK_THREAD_CPUTIME_ID)
    timespec time{};
    if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time) == 0) {
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }
#endif
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace haptoflow::learning
