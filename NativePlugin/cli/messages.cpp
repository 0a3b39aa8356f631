#include "messages.hpp"

#include "headless/scenes/command_files.hpp"
#include "headless/scene.hpp"
#include "model/plain_text.hpp"
#include "recordings/recording.hpp"
#include "headless/scenes/stroke_file.hpp"

#include <algorithm>
#include <iostream>

namespace haptoflow::cli {

void complain(std::string_view text) {
    std::cerr << "haptoflow: " << model::printable(text) << '\n';
}

void note(std::string_view text) {
    std::cerr << "haptoflow: note: " << model::printable(text) << '\n';
}

void noteLateKeyframes(const headless::Scene& scene, const Stroke& stroke, const std::string& sceneName) {
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
    return isStandardOutputTaken() ? std::cerr : std::cout;
}

}  // namespace haptoflow::cli
