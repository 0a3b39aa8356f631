#include "messages.hpp"

#include "headless/scene.hpp"
#include "headless/stroke_file.hpp"
#include "model/plain_text.hpp"
#include "recordings/recording.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <iostream>
#include <locale>
#include <sstream>
#include <utility>

#include <unistd.h>

namespace haptoflow::cli {

std::string fixedDecimals(double value, int digits) {
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    const double unit = std::pow(10.0, -digits);
    stream << std::fixed << std::setprecision(digits) << std::round(value / unit) * unit + 0.0;
    return stream.str();
}

std::string inMillimetres(double metres) {
    return fixedDecimals(1000.0 * metres, 0);
}

void complain(std::string_view text) {
    std::cerr << "haptoflow: " << model::printable(text) << '\n';
}

void note(std::string_view text) {
    std::cerr << "haptoflow: note: " << model::printable(text) << '\n';
}

void noteLateKeyframes(const headless::Scene& scene, const headless::Stroke& stroke, const std::string& sceneName) {
    constexpr double longAfter = 50.0;
    const double seconds = stroke.samples.back().timeSeconds - std::min(stroke.samples.front().timeSeconds, 0.0);
    for (const headless::SceneSurface& surface : scene.surfaces) {
        if (surface.motion && surface.motion->keyframes().back().timeSeconds > longAfter * std::max(seconds, 1.0)) {
            note(sceneName + ": the motion of \"" + surface.name + "\" goes on to " +
                 recordings::plainNumber(surface.motion->keyframes().back().timeSeconds) + " s, the stroke to " +
                 recordings::plainNumber(stroke.samples.back().timeSeconds) +
                 " s; keyframes are in seconds: divide milliseconds by 1000");
        }
    }
}

std::ostream& resultStream() {
    return headless::isStandardOutputTaken() ? std::cerr : std::cout;
}

ProgressBar progressLines(std::string_view command, const std::function<double()>& clockSeconds,
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
    if (isatty(STDERR_FILENO) == 0) {
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
