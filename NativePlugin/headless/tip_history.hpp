#pragma once

#include "headless/contact_types.hpp"
#include "headless/tip_path.hpp"

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace haptoflow::headless {

/// The tip's last positions in the world, of which the path over a surface is made when the tip comes to it. Whether a
/// step is a jump only a surface can tell.
class TipHistory {
public:
    static constexpr std::size_t capacity = 64;

    struct Frame {
        double timeSeconds = 0.0;
        glm::dvec3 worldMetres{0.0};
    };

    explicit TipHistory(const VelocitySettings& settings);

    /// Adds a frame; time and position must be usable. Every result but `continued` means that the history was dropped.
    TipStep add(double timeSeconds, const glm::dvec3& worldMetres);
    void clear() noexcept { frames_.clear(); }
    /// Oldest first.
    [[nodiscard]] std::span<const Frame> frames() const noexcept { return frames_; }

private:
    VelocitySettings settings_;
    std::vector<Frame> frames_;
    double latestSeconds_ = 0.0;
};

}  // namespace haptoflow::headless
