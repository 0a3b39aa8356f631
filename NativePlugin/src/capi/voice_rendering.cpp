#include "capi/voice_rendering.hpp"

#include <algorithm>
#include <functional>
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

/// Exclusive use of a voice's renderer for one call; afterwards a closed voice that has become silent ends.
class RenderTurn {
public:
    explicit RenderTurn(const VoiceTable::Use& use) noexcept
        : use_(use), isTaken_(use && !use->rendering.test_and_set(std::memory_order_acquire)) {
        if (use && !isTaken_) {
            use->refusedCalls.fetch_add(1, std::memory_order_relaxed);
        }
    }
    RenderTurn(const RenderTurn&) = delete;
    RenderTurn& operator=(const RenderTurn&) = delete;
    ~RenderTurn() {
        if (isTaken_) {
            use_.endOnceSilent();
            use_->rendering.clear(std::memory_order_release);
        }
    }
    [[nodiscard]] explicit operator bool() const noexcept { return isTaken_; }

private:
    const VoiceTable::Use& use_;
    const bool isTaken_;
};

void silence(const ChannelTarget& target) noexcept {
    forEachFrame(target, 0, target.frameCount,
                 [](std::size_t, std::span<float> frame) { std::ranges::fill(frame, 0.0F); });
}

/// Renders blocks that fit into the voice's own, each finished by `finish`, into the target.
template <typename Finish>
void renderBlocks(OpenVoice& open, const ChannelTarget& target, double sampleRateHz, engine::Limit limit,
                  Finish finish) noexcept {
    for (std::size_t done = 0; done < target.frameCount; done += open.block.size()) {
        const auto block = std::span(open.block).first(std::min(open.block.size(), target.frameCount - done));
        open.voice->renderer.render(block, sampleRateHz, limit);
        finish(block);
        forEachFrame(target, done, block.size(),
                     [block](std::size_t index, std::span<float> frame) { std::ranges::fill(frame, block[index]); });
    }
}

float ceilingOf(const OpenVoice& open) noexcept {
    return open.voice->renderer.voice().limiter().ceiling();
}

/// Adds the voices to a block of the sum's first voice, and limits the sum.
haptoflow_status addAndLimit(OpenVoice& first, std::span<float> sum, VoiceTable& table,
                             std::span<haptoflow_voice> others, double sampleRateHz) noexcept {
    haptoflow_status status = HAPTOFLOW_OK;
    // A ceiling of 0 silences its own voice only; any other one protects the device that all of them share.
    float lowestCeiling = 1.0F;
    const auto admit = [&lowestCeiling](const OpenVoice& open, std::span<float> samples) {
        const float ceiling = ceilingOf(open);
        if (ceiling == 0.0F) {
            std::ranges::fill(samples, 0.0F);
        } else {
            lowestCeiling = std::min(lowestCeiling, ceiling);
        }
    };
    admit(first, sum);
    for (haptoflow_voice& handle : others) {
        const VoiceTable::Use use = table.useToRender(handle);
        handle = use ? handle : 0;
        const RenderTurn turn(use);
        if (turn) {
            const auto block = std::span(use->block).first(sum.size());
            use->voice->renderer.render(block, sampleRateHz, engine::Limit::sum);
            admit(*use.get(), block);
            std::ranges::transform(sum, block, sum.begin(), std::plus());
        } else if (use) {
            status = HAPTOFLOW_BUSY;
        }
    }
    first.voice->renderer.limitSum(sum, lowestCeiling);
    return status;
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
    const RenderTurn turn(use);
    if (!turn) {
        silence(target);
        return use ? HAPTOFLOW_BUSY : HAPTOFLOW_INVALID_ARGUMENT;
    }
    renderBlocks(*use.get(), target, sampleRateHz, engine::Limit::voice, [](std::span<float>) {});
    return HAPTOFLOW_OK;
}

haptoflow_status renderSum(VoiceTable& table, std::span<haptoflow_voice> voices, const ChannelTarget& target,
                           double sampleRateHz) noexcept HAPTOFLOW_NONBLOCKING {
    haptoflow_status status = HAPTOFLOW_OK;
    for (std::size_t index = 0; index < voices.size(); ++index) {
        const VoiceTable::Use use = table.useToRender(voices[index]);
        voices[index] = use ? voices[index] : 0;
        const RenderTurn turn(use);
        if (!turn) {
            status = use ? HAPTOFLOW_BUSY : status;
            continue;
        }
        const std::span<haptoflow_voice> others = voices.subspan(index + 1);
        const bool isAlone = std::ranges::all_of(others, [](haptoflow_voice each) { return each == 0; });
        renderBlocks(*use.get(), target, sampleRateHz, isAlone ? engine::Limit::voice : engine::Limit::sum,
                     [&](std::span<float> block) {
                         if (!isAlone) {
                             status = std::max(status, addAndLimit(*use.get(), block, table, others, sampleRateHz));
                         }
                     });
        return status;
    }
    silence(target);
    return status;
}

}  // namespace haptoflow::capi
