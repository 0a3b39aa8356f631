#pragma once

#include <cstddef>
#include <cstdint>

namespace haptoflow::unity {

/// One call of Unity's: interleaved frames in and out. `in` and `out` may be the same memory, also where the numbers of
/// channels differ.
struct AudioBlock {
    /// Null for none.
    const float* in;
    float* out;
    std::uint32_t frames;
    std::uint32_t inChannels;
    std::uint32_t outChannels;
};

/// Output channel n becomes input channel n, bit for bit; channels that the input lacks become silent.
void passThrough(const AudioBlock& block) noexcept;

}  // namespace haptoflow::unity
