#pragma once

#include "capi/voice_table.hpp"
#include "haptoflow/haptoflow.h"

#include <cstdint>
#include <span>

namespace haptoflow::capi {

/// The destination of a voice's samples: one channel of interleaved frames, or all.
struct ChannelTarget {
    static constexpr std::uint32_t maximumChannels = 64;

    float* interleaved = nullptr;
    std::uint32_t frameCount = 0;
    std::uint32_t channelCount = 0;
    /// HAPTOFLOW_ALL_CHANNELS or an index.
    std::int32_t channel = HAPTOFLOW_ALL_CHANNELS;

    [[nodiscard]] bool isValid() const noexcept;
};

// RealtimeSanitizer checks that functions with this attribute, and their callees, do only what an audio callback may
// do.
#if defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::nonblocking)
#define HAPTOFLOW_NONBLOCKING [[clang::nonblocking]]
#endif
#endif
#ifndef HAPTOFLOW_NONBLOCKING
#define HAPTOFLOW_NONBLOCKING
#endif

/// Renders the voice into a valid target; writes zeros if there is no voice, or if another thread renders it.
/// Wait-free, for the audio callback.
[[nodiscard]] haptoflow_status renderInto(const VoiceTable::Use& use, const ChannelTarget& target,
                                          double sampleRateHz) noexcept HAPTOFLOW_NONBLOCKING;

/// The same for the sum of several voices, limited as a whole. Sets a handle to 0 whose voice has ended, and leaves out
/// a voice that another thread renders (HAPTOFLOW_BUSY).
[[nodiscard]] haptoflow_status renderSum(VoiceTable& table, std::span<haptoflow_voice> voices,
                                         const ChannelTarget& target,
                                         double sampleRateHz) noexcept HAPTOFLOW_NONBLOCKING;

}  // namespace haptoflow::capi
