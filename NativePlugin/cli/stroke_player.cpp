#include "stroke_player.hpp"

namespace haptoflow::cli {

StrokePlayer::StrokePlayer(const headless::Scene& scene, const Stroke& stroke, const std::string& strokeName,
                           const headless::ContactSettings& settings)
    : stroke_(stroke), tracker_(scene, settings), frames_(frameCount(stroke, scene.updateRateHz, strokeName)) {}

std::optional<headless::ContactReading> StrokePlayer::next() {
    if (frame_ == frames_) {
        return std::nullopt;
    }
    return tracker_.update(frameAt(stroke_, tracker_.scene().updateRateHz, frame_++));
}

std::uint64_t touchesOfEverySample(const headless::Scene& scene, const Stroke& stroke, const std::string& strokeName,
                                   const headless::ContactSettings& settings) {
    headless::ContactTracker tracker(scene, settings);
    const std::size_t frames = frameCount(stroke, scene.updateRateHz, strokeName);
    std::uint64_t touches = 0;
    bool wasTouching = false;
    const auto look = [&](const headless::TipSample& sample) {
        const bool isTouching = tracker.update(sample).touching;
        touches += isTouching && !wasTouching ? 1U : 0U;
        wasTouching = isTouching;
    };
    auto sample = stroke.samples.begin();
    for (std::size_t frame = 0; frame < frames; ++frame) {
        const headless::TipSample atFrame = frameAt(stroke, scene.updateRateHz, frame);
        for (; sample != stroke.samples.end() && sample->timeSeconds < atFrame.timeSeconds; ++sample) {
            look(*sample);
        }
        look(atFrame);
    }
    for (; sample != stroke.samples.end(); ++sample) {
        look(*sample);
    }
    return touches;
}

}  // namespace haptoflow::cli
