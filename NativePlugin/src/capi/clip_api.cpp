#include "capi/handles.hpp"
#include "capi/voice_table.hpp"
#include "clips/clip_formats.hpp"
#include "clips/clip_making.hpp"
#include "effects/clip_sound.hpp"
#include "effects/wave_features.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

using namespace haptoflow;
using namespace haptoflow::capi;

static_assert(static_cast<int>(clips::ClipFormat::haptic) == HAPTOFLOW_CLIP_HAPTIC);
static_assert(static_cast<int>(clips::ClipFormat::ahap) == HAPTOFLOW_CLIP_AHAP);
static_assert(static_cast<int>(clips::ClipFormat::hjif) == HAPTOFLOW_CLIP_HJIF);

namespace haptoflow::capi {

struct OpenClip {
    explicit OpenClip(clips::ReadClip given) : read(std::move(given)), omitted(clips::omittedText(read)) {}

    /// The wave that voices play, made once.
    [[nodiscard]] std::shared_ptr<const std::vector<float>> wave() {
        const std::lock_guard lock(mutex_);
        if (wave_ == nullptr) {
            wave_ =
                std::make_shared<const std::vector<float>>(clips::waveOf(read.clip, effects::ClipSound::waveRateHz));
        }
        return wave_;
    }

    const clips::ReadClip read;
    const std::string omitted;

private:
    std::mutex mutex_;
    std::shared_ptr<const std::vector<float>> wave_;
};

}  // namespace haptoflow::capi

namespace {

/// Runs an action; a ClipError of it becomes std::invalid_argument, whose status is that of a wrong argument.
template <typename Action>
auto withClipErrors(Action&& action) {
    try {
        return action();
    } catch (const clips::ClipError& error) {
        throw std::invalid_argument(std::string("the clip: ") + error.what());
    }
}

/// Copies a result of `count` elements to a caller's array, unless the capacity is 0.
template <typename Element>
void copyOut(std::span<const Element> result, Element* target, std::uint64_t capacity, std::uint64_t* count,
             const char* name) {
    *require(count, "the count") = result.size();
    if (capacity == 0) {
        return;
    }
    if (capacity < result.size()) {
        throw std::invalid_argument("capacity is " + std::to_string(capacity) + "; expected at least " +
                                    std::to_string(result.size()));
    }
    std::ranges::copy(result, require(target, name));
}

}  // namespace

haptoflow_status haptoflow_clip_create(const haptoflow_clip_options* options, haptoflow_clip** clip) {
    return guarded([&] {
        const auto given = readDescriptor(options, "options");
        (void)require(clip, "clip");
        const std::size_t count = countOf(given.sample_count, "sample_count");
        const std::span wave(count > 0 ? require(given.wave_mps2, "wave_mps2") : given.wave_mps2, count);
        const std::vector<float> slow = effects::decimated(wave, decimationOf(given.sample_rate_hz));
        *clip = openClips().open(withClipErrors([&] {
            return std::make_shared<OpenClip>(clips::ReadClip{
                .clip = clips::clipOf(slow, {.isLoop = given.is_loop != 0,
                                             .origin = {.title = textOf(given.title),
                                                        .description = textOf(given.description),
                                                        .editor = std::string("HaptoFlow ") + haptoflow_version(),
                                                        .source = textOf(given.source)}})});
        }));
    });
}

haptoflow_status haptoflow_clip_read(const char* text, uint64_t length, haptoflow_clip** clip) {
    return guarded([&] {
        (void)require(text, "text");
        (void)require(clip, "clip");
        *clip = openClips().open(withClipErrors([&] {
            return std::make_shared<OpenClip>(clips::readClip(std::string_view(text, countOf(length, "length"))));
        }));
    });
}

haptoflow_status haptoflow_clip_close(haptoflow_clip** clip) {
    return guarded([&] { closeHandle(openClips(), clip, "clip"); });
}

haptoflow_status haptoflow_clip_describe(const haptoflow_clip* clip, haptoflow_clip_info* info) {
    return guarded([&] {
        const auto open = openClips().get(clip);
        const clips::HapticClip& content = open->read.clip;
        haptoflow_clip_info described{};
        described.format = static_cast<haptoflow_clip_format>(open->read.format);
        described.duration_seconds = content.durationSeconds;
        described.amplitude_points = static_cast<std::uint32_t>(content.amplitude.size());
        described.frequency_points = static_cast<std::uint32_t>(content.frequencyHz.size());
        described.transients = static_cast<std::uint32_t>(content.transients.size());
        for (const clips::ClipPoint& point : content.amplitude) {
            described.largest_amplitude = std::max(described.largest_amplitude, static_cast<float>(point.value));
        }
        described.title = content.origin.title.c_str();
        described.description = content.origin.description.c_str();
        described.editor = content.origin.editor.c_str();
        described.omitted = open->omitted.c_str();
        writeDescriptor(info, described, "info");
    });
}

haptoflow_status haptoflow_clip_write(const haptoflow_clip* clip, haptoflow_clip_format format, const char* date,
                                      char* text, uint64_t capacity, uint64_t* length) {
    return guarded([&] {
        if (format < 0 || format >= static_cast<haptoflow_clip_format>(clips::clipFormats)) {
            throw std::invalid_argument("format is " + std::to_string(format) + "; expected 0 to 2");
        }
        const clips::WrittenClip written =
            clips::writeClip(openClips().get(clip)->read.clip,
                             {.format = static_cast<clips::ClipFormat>(format), .date = require(date, "date")});
        copyOut(std::span<const char>(written.text), text, capacity, length, "text");
    });
}

haptoflow_status haptoflow_clip_curves(const haptoflow_clip* clip, uint32_t count, float* amplitude,
                                       float* frequency_hz) {
    return guarded([&] {
        const auto open = openClips().get(clip);
        const clips::HapticClip& content = open->read.clip;
        clips::CurveReader amplitudes(content.amplitude, 0.0);
        clips::CurveReader frequencies(content.frequencyHz, clips::usualFrequencyHz);
        for (std::uint32_t i = 0; i < count; ++i) {
            const double seconds = count > 1 ? content.durationSeconds * i / (count - 1.0) : 0.0;
            if (amplitude != nullptr) {
                amplitude[i] = static_cast<float>(amplitudes.at(seconds));
            }
            if (frequency_hz != nullptr) {
                frequency_hz[i] = static_cast<float>(frequencies.at(seconds));
            }
        }
    });
}

haptoflow_status haptoflow_clip_wave(const haptoflow_clip* clip, double sample_rate_hz, float* wave_mps2,
                                     uint64_t capacity, uint64_t* sample_count) {
    return guarded([&] {
        const std::vector<float> wave = clips::waveOf(openClips().get(clip)->read.clip, sample_rate_hz);
        copyOut(std::span<const float>(wave), wave_mps2, capacity, sample_count, "wave_mps2");
    });
}

haptoflow_status haptoflow_voice_play_clip(haptoflow_voice voice, const haptoflow_clip* clip, float gain,
                                           uint32_t is_loop) {
    bool isBusy = false;
    const haptoflow_status status = guarded([&] {
        constexpr float largestGain = 4.0F;
        if (!(gain >= 0.0F && gain <= largestGain)) {
            throw std::invalid_argument("gain is " + std::to_string(gain) + "; expected 0 to 4");
        }
        const VoiceTable::Use use = requireVoice(voice);
        engine::VoiceChannels& channels = use->voice->channels;
        std::shared_ptr<const std::vector<float>> wave = clip == nullptr ? nullptr : openClips().get(clip)->wave();
        if (use->publishing.test_and_set(std::memory_order_acquire)) {
            use->refusedCalls.fetch_add(1, std::memory_order_relaxed);
            isBusy = true;
            return;
        }
        channels.clip.draft() = {.wave = std::move(wave),
                                 .gain = gain,
                                 .isLoop = is_loop != 0,
                                 .publishedSeconds = channels.clock(),
                                 .panics = channels.controls.panics.load(std::memory_order_acquire)};
        channels.clip.post();
        use->publishing.clear(std::memory_order_release);
    });
    return isBusy ? HAPTOFLOW_BUSY : status;
}
