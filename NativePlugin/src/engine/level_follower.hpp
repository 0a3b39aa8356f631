#pragma once

#include "engine/piece_list.hpp"

#include <cstdint>
#include <span>

namespace haptoflow::engine {

/// Gives the played waveform the level of the newest contact state, without the lead after which a segment of that
/// state takes over: each sample is divided by the level that its segment was generated for and multiplied by the
/// newest one. Where a segment takes over, both change together, so the seam keeps its level.
///
/// Levels change along a ramp of 4 ms. The gain is limited to 12 dB up, because quiet segments have the sensors' noise,
/// and 40 dB down. Audio thread; allocates nothing.
class LevelFollower {
public:
    /// A stream begins at a sample with a seed of this level in m/s^2 RMS.
    void begin(std::int64_t start, float levelMps2) noexcept;
    /// A segment that was generated for this level takes over at `start`, and with it every earlier one that starts
    /// there or later is dropped.
    void takeOver(std::int64_t start, float levelMps2) noexcept;
    /// The newest state's level.
    void setLevel(float levelMps2) noexcept;
    /// Applies the gain to the samples from `start` on.
    void process(std::int64_t start, std::span<float> samples) noexcept;

private:
    struct Piece {
        std::int64_t start = 0;
        // Natural logarithm of the level in m/s^2.
        float logLevel = 0.0F;
    };

    PieceList<Piece> pieces_;
    float logLevel_ = 0.0F;
    float target_ = 0.0F;
    float step_ = 0.0F;
};

}  // namespace haptoflow::engine
