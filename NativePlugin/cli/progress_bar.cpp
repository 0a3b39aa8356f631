#include "progress_bar.hpp"

#include <chrono>
#include <cstdio>
#include <iostream>
#include <string>
#include <utility>

#if defined(_WIN32)
#include <io.h>
#else
#include <unistd.h>
#endif

namespace haptoflow::cli {
namespace {

bool standardErrorIsTerminal() {
#if defined(_WIN32)
    return _isatty(_fileno(stderr)) != 0;
#else
    return isatty(STDERR_FILENO) != 0;
#endif
}

}  // namespace

ProgressBar progressLines(std::string_view command, std::function<double()> clockSeconds,
                          std::function<void(const std::string&)> say) {
    constexpr double betweenLinesSeconds = 10.0;
    return [command = std::string(command), clockSeconds, say = std::move(say),
            nextSeconds = clockSeconds() + betweenLinesSeconds](double share, std::string_view what) mutable {
        const double nowSeconds = clockSeconds();
        if (nowSeconds >= nextSeconds) {
            nextSeconds = nowSeconds + betweenLinesSeconds;
            say(command + ": " + std::to_string(static_cast<int>(share * 100.0)) + " %" +
                (what.empty() ? "" : " " + std::string(what)));
        }
    };
}

ProgressBar progressBar(std::string_view command, bool quiet) {
    if (quiet) {
        return [](double, std::string_view) {};
    }
    if (!standardErrorIsTerminal()) {
        const auto clockSeconds = [] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
        };
        return progressLines(command, clockSeconds, [](const std::string& line) { std::cerr << line << '\n'; });
    }
    return [command = std::string(command), lastPercent = -1, lastWhat = std::string()](double share,
                                                                                        std::string_view what) mutable {
        constexpr int width = 40;
        const int percent = static_cast<int>(share * 100.0);
        if (percent == lastPercent && what == lastWhat) {
            return;
        }
        lastPercent = percent;
        lastWhat = what;
        const auto filled = static_cast<std::size_t>(percent * width / 100);
        std::fprintf(stderr, "\r%s [%s%s] %3d %% %-12s%s", command.c_str(), std::string(filled, '#').c_str(),
                     std::string(width - filled, ' ').c_str(), percent, lastWhat.c_str(), percent == 100 ? "\n" : "");
        std::fflush(stderr);
    };
}

}  // namespace haptoflow::cli
