#include "learning/material_frame.hpp"

#include <cmath>

namespace haptoflow::learning {
namespace {

/// Smaller wave numbers are rounding errors.
constexpr double minimumPerMm = 1e-9;

std::array<double, 2> turned(double x, double y, double radians) {
    const double cosine = std::cos(radians);
    const double sine = std::sin(radians);
    return {x * cosine + y * sine, y * cosine - x * sine};
}

}  // namespace

MaterialFrame MaterialFrame::across(std::span<const WaveVector> vectors) {
    MaterialFrame frame;
    std::size_t next = 0;
    for (const WaveVector& vector : vectors) {
        if ((vector.x == 0.0 && vector.y == 0.0) || next == frame.waveNumbers.size()) {
            continue;
        }
        if (next == 0) {
            frame.turnRadians = std::atan2(vector.y, vector.x);
        }
        const std::array<double, 2> across = turned(vector.x, vector.y, frame.turnRadians);
        // Ribs have no sign; the second family gets the sign that the labels use.
        const double sign = across[1] < -minimumPerMm ? -1.0 : 1.0;
        for (const double component : across) {
            frame.waveNumbers[next++] =
                std::abs(component) < minimumPerMm ? 0.0F : static_cast<float>(sign * component);
        }
    }
    return frame;
}

void MaterialFrame::turn(recordings::PreparedRecording& recording) const {
    if (turnRadians == 0.0) {
        return;
    }
    for (std::array<float, 3>& motion : recording.motion) {
        const std::array<double, 2> velocity = turned(motion[0], motion[1], turnRadians);
        motion[0] = static_cast<float>(velocity[0]);
        motion[1] = static_cast<float>(velocity[1]);
    }
}

}  // namespace haptoflow::learning
