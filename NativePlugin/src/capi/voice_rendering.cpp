#include "capi/voice_rendering.hpp"

#include <algorithm>
#include <span>

namespace haptoflow::capi {
namespace {

/// Calls `action` with the samples of each frame that belong to the target.
template <typename Action>
void forEachFrame(const ChannelTarget& target, std::size_t firstFrame, std::size_t frames, Action action) noexcept {
    const std::size_t channels = target.channelCount;
    const bool isAll = target.channel == HAPTOFLOW_ALL_CHANNELS;
    const std::size_t width = isAll ? channels : 1;
    float* sample = target.interleaved + firstFrame * channels + (isAll ? 0 : static_cast<std::size_t>(target.channel));
    for (std::size_t frame = 0; frame < frames; ++frame, sample += channels) {
        action(frame, std::span(sample, width));
    }
}

}  // namespace

bool ChannelTarget::isValid() const noexcept {
    const bool channelFits =
        channel == HAPTOFLOW_ALL_CHANNELS || (channel >= 0 && static_cast<std::uint32_t>(channel) < channelCount);
    return (interleaved != nullptr || frameCount == 0) && channelCount >= 1 && channelCount <= maximumChannels &&
           channelFits;
}

haptoflow_status renderInto(const VoiceTable::Use& use, const ChannelTarget& target,
                            double sampleRateHz) noexcept HAPTOFLOW_NONBLOCKING {
    const bool isBusy = use && use->rendering.test_and_set(std::memory_order_acquire);
    if (!use || isBusy) {
        forEachFrame(target, 0, target.frameCount,
                     [](std::size_t, std::span<float> frame) { std::ranges::fill(frame, 0.0F); });
        if (isBusy) {
            use->refusedCalls.fetch_add(1, std::memory_order_relaxed);
        }
        return isBusy ? HAPTOFLOW_BUSY : HAPTOFLOW_INVALID_ARGUMENT;
    }
    for (std::size_t done = 0; done < target.frameCount; done += use->block.size()) {
        const auto block = std::span(use->block).first(std::min(use->block.size(), target.frameCount - done));
        use->voice->renderer.render(block, sampleRateHz);
        forEachFrame(target, done, block.size(),
                     [block](std::size_t index, std::span<float> frame) { std::ranges::fill(frame, block[index]); });
    }
    use->rendering.clear(std::memory_order_release);
    return HAPTOFLOW_OK;
}

}  // namespace haptoflow::capi
