#pragma once

#include "headless/contact_tracker.hpp"
#include "stroke_file.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace haptoflow::cli {

/// Plays a stroke in a scene, frame by frame at the scene's update rate.
class StrokePlayer {
public:
    /// The stroke must outlive the player. Throws InputError if the stroke, named `strokeName`, is too long.
    StrokePlayer(const headless::Scene& scene, const Stroke& stroke, const std::string& strokeName,
                 const headless::ContactSettings& settings);

    /// The next frame; empty after the last.
    std::optional<headless::ContactReading> next();
    [[nodiscard]] std::size_t frames() const noexcept { return frames_; }
    [[nodiscard]] std::size_t played() const noexcept { return frame_; }

private:
    const Stroke& stroke_;
    headless::ContactTracker tracker_;
    std::size_t frames_;
    std::size_t frame_ = 0;
};

/// The number of touch-downs when every sample of the stroke is processed in addition to the frames: a tap may begin
/// and end between two frames.
[[nodiscard]] std::uint64_t touchesOfEverySample(const headless::Scene& scene, const Stroke& stroke,
                                                 const std::string& strokeName,
                                                 const headless::ContactSettings& settings);

}  // namespace haptoflow::cli
