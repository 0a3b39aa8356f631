#pragma once

#include "capi/voice_table.hpp"

#include <cstddef>
#include <cstdint>

namespace haptoflow::unity {

/// An effect's claim to be the one that renders the voice at a place. Rendering moves the voice's clock, so two effects
/// that took turns would each play every other block of it. The first to ask has the place; another gets it once it is
/// given back, or was not used for 100 ms, as by an effect that Unity no longer calls. Wait-free.
class VoiceClaim {
public:
    static constexpr double abandonedSeconds = 0.1;

    VoiceClaim() noexcept;
    VoiceClaim(const VoiceClaim&) = delete;
    VoiceClaim& operator=(const VoiceClaim&) = delete;
    ~VoiceClaim() { giveBack(); }

    /// Before each rendering of that many frames. True where this effect may render the voice at `place`, which is in
    /// range; another place that it had is given back.
    [[nodiscard]] bool hold(std::size_t place, std::uint32_t frames, double sampleRateHz) noexcept;
    void giveBack() noexcept;

private:
    static constexpr std::size_t nowhere = capi::VoiceTable::capacity;

    std::uint32_t self_;
    std::size_t place_ = nowhere;
    // As found at the last asking, and for how many frames it has been the same.
    std::uint64_t found_ = 0;
    std::uint64_t unchangedFrames_ = 0;
};

}  // namespace haptoflow::unity
