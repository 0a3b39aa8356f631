#pragma once

#include "engine/contact_messages.hpp"
#include "engine/rib_phase.hpp"
#include "inference/surface_noise.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace haptoflow::engine {

/// The way of the tip over its surface during one segment.
struct SurfaceStretch {
    /// Key of the surface's noise.
    std::uint64_t surface = 0;
    /// In metres of the material: divided by the contact's spatial scale.
    inference::SurfacePath path{};
    /// Where the tip is along the two axes of the velocity, in the material's metres, if ribs have their phase from it.
    std::optional<std::array<double, 2>> ribPlaceMetres{};
};

/// Tells where on its surface the tip will be when a segment sounds. Where the caller says no place, adds up velocities
/// from the touch-down on. A small value, which threads hand to each other; allocates nothing.
class PlaceTrack {
public:
    /// `seed` and `voice` key the noise.
    PlaceTrack(std::uint64_t seed, std::uint32_t voice) noexcept : seed_(seed), voice_(voice) {}

    /// Begins a stream.
    void begin() noexcept;
    /// The stretch of a segment that begins at the waveform sample `start`, `secondsAhead` after the contact was
    /// published. The tip is assumed to keep the contact's velocity.
    ///
    /// Ribs have their phase from the place only while that is right for a whole segment: inside the trained range,
    /// where the network's speed is the tip's, and on a flat surface, whose axes do not turn.
    [[nodiscard]] SurfaceStretch at(const PublishedContact& contact, std::int64_t start, double secondsAhead) noexcept;
    /// The segment of the newest stretch was sent.
    void add(std::int64_t start, const SurfaceStretch& stretch) noexcept;

private:
    [[nodiscard]] std::uint64_t keyOf(const PublishedContact& contact) const noexcept;
    [[nodiscard]] bool isFlat(const ContactState& state) noexcept;

    std::uint64_t seed_;
    std::uint32_t voice_;
    // Way so far of a touch without a place: the newest stretch and its start.
    std::uint64_t touch_ = 0;
    std::int64_t start_ = 0;
    inference::SurfacePath integrated_{};
    /// The surface and the tip's place on it, with the axes there.
    struct Anchor {
        std::uint32_t surfaceSeed = 0;
        std::array<float, 3> placeMetres{};
        std::array<float, 3> firstAxis{};
        std::array<float, 3> secondAxis{};
    };
    // Where the axes last turned; empty before the first place. The surface counts as flat once the tip has moved far
    // enough from there.
    std::optional<Anchor> anchor_;
    bool isFlat_ = false;
};

}  // namespace haptoflow::engine
