#include "capi/voice_table.hpp"

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>

namespace haptoflow::capi {
namespace {

constexpr haptoflow_voice placeBits = 0xFF;
constexpr int generationShift = 8;

// Constructed when the library is loaded, because the first user may be an audio thread, and never destroyed, because
// an audio thread may also be the last.
union Lasting {
    Lasting() : table() {}
    Lasting(const Lasting&) = delete;
    Lasting& operator=(const Lasting&) = delete;
    ~Lasting() {}
    VoiceTable table;
};
Lasting lasting;

}  // namespace

VoiceTable& voices() noexcept {
    return lasting.table;
}

bool VoiceTable::Use::isClosed() const noexcept {
    return get()->voice->channels.controls.closing.load();
}

void VoiceTable::Use::endOnceSilent() const noexcept {
    if (isClosed() && !get()->voice->channels.audible.load(std::memory_order_relaxed)) {
        place_->handle.store(0);
    }
}

haptoflow_voice VoiceTable::open(std::unique_ptr<OpenVoice> voice) {
    Ended ended;
    const std::lock_guard lock(mutex_);
    collect(ended);
    if (freePlace() == nullptr) {
        collect(ended, true);
    }
    Place* place = freePlace();
    if (place == nullptr) {
        throw std::invalid_argument("all " + std::to_string(capacity) + " voices are in use: destroy one first");
    }
    ++place->generation;
    const auto index = static_cast<haptoflow_voice>(place - places_.data());
    const haptoflow_voice handle = (place->generation << generationShift) | index;
    place->voice = std::move(voice);
    place->handle.store(handle);
    return handle;
}

bool VoiceTable::close(haptoflow_voice handle) {
    Ended ended;
    const std::lock_guard lock(mutex_);
    const std::size_t index = placeOf(handle);
    if (index == capacity) {
        return false;
    }
    beginToClose(places_[index]);
    collect(ended);
    return true;
}

void VoiceTable::closeAll(const engine::LiveEngine& engine) {
    Ended ended;
    const std::lock_guard lock(mutex_);
    for (Place& place : places_) {
        if (place.voice != nullptr && place.voice->engine.get() == &engine) {
            beginToClose(place);
        }
    }
    collect(ended);
}

VoiceTable::Place* VoiceTable::freePlace() noexcept {
    const auto found = std::ranges::find_if(places_, [](const Place& place) { return place.voice == nullptr; });
    return found == places_.end() ? nullptr : &*found;
}

void VoiceTable::beginToClose(Place& place) noexcept {
    OpenVoice& closing = *place.voice;
    if (!closing.voice->channels.controls.closing.exchange(true)) {
        closing.engine->removeVoice(*closing.voice);
        place.closedAt = std::chrono::steady_clock::now();
    }
}

void VoiceTable::collect(Ended& ended, bool endsFades) {
    const auto now = std::chrono::steady_clock::now();
    for (Place& place : places_) {
        if (place.voice == nullptr || !place.voice->voice->channels.controls.closing.load()) {
            continue;
        }
        // A block that began before the voice was closed may still make it audible; a later one cannot.
        const bool isSilent = place.users.load() == 0 && !place.voice->voice->channels.audible.load();
        if (isSilent || endsFades || now - place.closedAt > fadeLimit) {
            place.handle.store(0);
        }
        // All operations are sequentially consistent, so that either this thread sees a user or the user sees that the
        // handle is gone.
        if (place.handle.load() == 0 && place.users.load() == 0) {
            ended.push_back(std::move(place.voice));
        }
    }
}

VoiceTable::Use VoiceTable::useToRender(haptoflow_voice handle) noexcept {
    const std::size_t index = handle & placeBits;
    if (handle == 0 || index >= capacity) {
        return {};
    }
    Place& place = places_[index];
    place.users.fetch_add(1);
    if (place.handle.load() != handle) {
        place.users.fetch_sub(1, std::memory_order_release);
        return {};
    }
    return Use(&place);
}

VoiceTable::Use VoiceTable::use(haptoflow_voice handle) noexcept {
    Use found = useToRender(handle);
    return found && !found.isClosed() ? std::move(found) : Use{};
}

VoiceTable::Use VoiceTable::useAt(std::size_t place) noexcept {
    return place < capacity ? useToRender(places_[place].handle.load()) : Use{};
}

std::size_t VoiceTable::placeOf(haptoflow_voice handle) noexcept {
    return use(handle) ? static_cast<std::size_t>(handle & placeBits) : capacity;
}

namespace {

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
    target.forEachFrame(0, target.frameCount,
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
        target.forEachFrame(done, block.size(), [block](std::size_t index, std::span<float> frame) {
            std::ranges::fill(frame, block[index]);
        });
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
