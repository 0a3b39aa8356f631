#pragma once

#include <cstddef>
#include <cstdint>

namespace haptoflow::unity {

/// Interleaved input and output frames of one callback. `in` and `out` may be the same memory, even if the numbers of
/// channels differ.
struct AudioBlock {
    /// Null for no input.
    const float* in;
    float* out;
    std::uint32_t frames;
    std::uint32_t inChannels;
    std::uint32_t outChannels;
};

/// Copies input channel n to output channel n. Output channels without an input channel become silent.
void passThrough(const AudioBlock& block) noexcept;

}  // namespace haptoflow::unity
