#include "engine/place_track.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace haptoflow::engine {
namespace {

using Vector = std::array<double, 3>;

// Axes that turn by less within the distance belong to a flat surface: its radius of curvature is above 5 m.
// 1e-3 as single precision, in which axes come.
constexpr double steadyTurn = static_cast<double>(1e-3F);
constexpr double flatMetres = 0.005;

double difference(const std::array<float, 3>& left, const std::array<float, 3>& right) noexcept {
    return static_cast<double>(std::hypot(left[0] - right[0], left[1] - right[1], left[2] - right[2]));
}

double dot(const Vector& vector, const std::array<float, 3>& axis) noexcept {
    return vector[0] * static_cast<double>(axis[0]) + vector[1] * static_cast<double>(axis[1]) +
           vector[2] * static_cast<double>(axis[2]);
}

/// Whether the network is told the tip's own velocity.
bool isInsideRange(const PublishedContact& contact) noexcept {
    const auto& motion = contact.ranged.motion;
    const float told = std::hypot(motion[0], motion[1]) * contact.state.spatialScale;
    return contact.ranged.readingRate == 1.0 && std::abs(told - contact.state.speedMps()) <= 1e-3F * told;
}

}  // namespace

void PlaceTrack::begin() noexcept {
    anchor_.reset();
}

SurfaceStretch PlaceTrack::at(const PublishedContact& contact, std::int64_t start, double secondsAhead) noexcept {
    const ContactState& state = contact.state;
    const double scale = state.spatialScale;
    const double vx = static_cast<double>(state.velocityMps[0]) / scale;
    const double vy = static_cast<double>(state.velocityMps[1]) / scale;
    const double secondsPerSample = 1.0 / (inference::waveformRateHz * contact.ranged.readingRate);
    SurfaceStretch stretch{.surface = keyOf(contact)};
    if (state.hasPlace == 0) {
        anchor_.reset();
        if (touch_ != contact.touch) {
            touch_ = contact.touch;
            start_ = start;
            integrated_ = {};
        }
        stretch.path.stepMetres = {vx * secondsPerSample, vy * secondsPerSample, 0.0};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            stretch.path.startMetres[axis] =
                integrated_.startMetres[axis] + integrated_.stepMetres[axis] * static_cast<double>(start - start_);
        }
        return stretch;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double velocity =
            vx * static_cast<double>(state.firstAxis[axis]) + vy * static_cast<double>(state.secondAxis[axis]);
        stretch.path.stepMetres[axis] = velocity * secondsPerSample;
        stretch.path.startMetres[axis] = static_cast<double>(state.placeMetres[axis]) / scale + velocity * secondsAhead;
    }
    if (isFlat(state) && isInsideRange(contact)) {
        stretch.ribPlaceMetres = {dot(stretch.path.startMetres, state.firstAxis),
                                  dot(stretch.path.startMetres, state.secondAxis)};
    }
    return stretch;
}

void PlaceTrack::add(std::int64_t start, const SurfaceStretch& stretch) noexcept {
    start_ = start;
    integrated_ = stretch.path;
}

std::uint64_t PlaceTrack::keyOf(const PublishedContact& contact) const noexcept {
    const ContactState& state = contact.state;
    // Without a place, each touch of each voice has a field of its own: every touch begins at the same coordinates.
    const std::uint64_t surface = state.hasPlace != 0
                                      ? state.surfaceSeed
                                      : (std::uint64_t{1} << 63U) + (std::uint64_t{voice_} << 32U) + contact.touch;
    return seed_ * 0x9E3779B97F4A7C15U + surface;
}

bool PlaceTrack::isFlat(const ContactState& state) noexcept {
    const Anchor here{.surfaceSeed = state.surfaceSeed,
                      .placeMetres = state.placeMetres,
                      .firstAxis = state.firstAxis,
                      .secondAxis = state.secondAxis};
    if (!anchor_) {
        anchor_ = here;
        isFlat_ = true;
        return true;
    }
    const bool hasTurned = difference(anchor_->firstAxis, state.firstAxis) > steadyTurn ||
                           difference(anchor_->secondAxis, state.secondAxis) > steadyTurn;
    if (hasTurned || anchor_->surfaceSeed != state.surfaceSeed) {
        anchor_ = here;
        isFlat_ = false;
    } else if (difference(anchor_->placeMetres, state.placeMetres) > flatMetres) {
        isFlat_ = true;
    }
    return isFlat_;
}

}  // namespace haptoflow::engine
