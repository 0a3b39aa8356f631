#pragma once

#include "capi/voice_table.hpp"

#include <cstddef>
#include <cstdint>

namespace haptoflow::unity {

/// An effect's exclusive right to render the voice at a place. Rendering advances the voice's clock, so of two effects
/// on one voice, each would play only every other block. The first effect to ask gets the place. Another effect gets it
/// after it was given back or has not been used for 100 ms, for example because Unity no longer calls the first effect.
/// Wait-free.
class VoiceClaim {
public:
    static constexpr double abandonedSeconds = 0.1;

    VoiceClaim() noexcept;
    VoiceClaim(const VoiceClaim&) = delete;
    VoiceClaim& operator=(const VoiceClaim&) = delete;
    ~VoiceClaim() { giveBack(); }

    /// Call before rendering `frames` frames. Returns whether this effect may render the voice at `place`, which must
    /// be in range. Gives back any other place.
    [[nodiscard]] bool hold(std::size_t place, std::uint32_t frames, double sampleRateHz) noexcept;
    void giveBack() noexcept;

private:
    static constexpr std::size_t nowhere = capi::VoiceTable::capacity;

    std::uint32_t self_;
    std::size_t place_ = nowhere;
    // Value of the place at the last call, and the number of frames for which it has not changed.
    std::uint64_t found_ = 0;
    std::uint64_t unchangedFrames_ = 0;
};

}  // namespace haptoflow::unity
