#include "clips/clip_formats.hpp"
#include "haptoflow/haptoflow.h"
#include "web_engine.hpp"
#include "web_imports.hpp"
#include "web_text.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

using nlohmann::json;
using namespace haptoflow;
using namespace haptoflow::web;

// Clips by their addresses, in the memory in which they were opened: see clip.mjs.

namespace {

haptoflow_clip* clipAt(int address) {
    return reinterpret_cast<haptoflow_clip*>(static_cast<std::uintptr_t>(address));
}

struct UnheardVoice {
    UnheardVoice() = default;
    UnheardVoice(const UnheardVoice&) = delete;
    UnheardVoice& operator=(const UnheardVoice&) = delete;
    ~UnheardVoice() { (void)haptoflow_voice_destroy(&voice); }

    haptoflow_voice voice = 0;
};

int addressOf(const haptoflow_clip* clip) {
    return static_cast<int>(reinterpret_cast<std::uintptr_t>(clip));
}

}  // namespace

HAPTO_EXPORT HAPTO_NAMED("hapto_clip_create") int hapto_clip_create(const float* waveMps2, std::uint32_t count,
                                                                    std::uint32_t rateHz, int isLoop, const char* title,
                                                                    const char* description, const char* source) {
    return guarded([&] {
        haptoflow_clip_options options{};
        options.struct_size = sizeof(options);
        options.sample_rate_hz = rateHz;
        options.wave_mps2 = waveMps2;
        options.sample_count = count;
        options.is_loop = isLoop != 0 ? 1 : 0;
        options.title = title;
        options.description = description;
        options.source = source;
        haptoflow_clip* clip = nullptr;
        require(haptoflow_clip_create(&options, &clip));
        return addressOf(clip);
    });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_clip_read") int hapto_clip_read(const char* text, std::uint32_t length) {
    return guarded([&] {
        haptoflow_clip* clip = nullptr;
        require(haptoflow_clip_read(text, length, &clip));
        return addressOf(clip);
    });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_clip_close") int hapto_clip_close(int address) {
    return guarded([&] {
        haptoflow_clip* clip = clipAt(address);
        require(haptoflow_clip_close(&clip));
        return 0;
    });
}

/// Figures of Clip in haptoflow.d.ts.
HAPTO_EXPORT HAPTO_NAMED("hapto_clip_json") const char* hapto_clip_json(int address) {
    return guardedText([&] {
        haptoflow_clip_info info{};
        info.struct_size = sizeof(info);
        require(haptoflow_clip_describe(clipAt(address), &info));
        return dumped({{"format", clips::endingOf(static_cast<clips::ClipFormat>(info.format))},
                       {"seconds", info.duration_seconds},
                       {"amplitudePoints", info.amplitude_points},
                       {"frequencyPoints", info.frequency_points},
                       {"largestAmplitude", info.largest_amplitude},
                       {"title", info.title},
                       {"description", info.description},
                       {"editor", info.editor},
                       {"omitted", info.omitted}});
    });
}

/// The transients of a clip file's text, which the C interface only counts.
HAPTO_EXPORT HAPTO_NAMED("hapto_clip_transients") const
    char* hapto_clip_transients(const char* text, std::uint32_t length) {
    return guardedText([&] {
        json transients = json::array();
        for (const clips::ClipTransient& each : clips::readClip({text, length}).clip.transients) {
            transients.push_back(
                {{"timeSeconds", each.seconds}, {"amplitude", each.amplitude}, {"frequencyHz", each.frequencyHz}});
        }
        return dumped(transients);
    });
}

/// The clip as a file of a format by its haptoflow_clip_format.
HAPTO_EXPORT HAPTO_NAMED("hapto_clip_text") const char* hapto_clip_text(int address, int format, const char* date) {
    return guardedText([&] {
        // Enough for most: to ask for the length first would write twice.
        constexpr std::size_t usualBytes = std::size_t{1} << 20U;
        std::string text(usualBytes, '\0');
        std::uint64_t length = 0;
        const auto write = [&] {
            return haptoflow_clip_write(clipAt(address), format, date, text.data(), text.size(), &length);
        };
        haptoflow_status status = write();
        if (length > text.size()) {
            text.resize(static_cast<std::size_t>(length));
            status = write();
        }
        require(status);
        text.resize(static_cast<std::size_t>(length));
        return text;
    });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_clip_curves") int hapto_clip_curves(int address, std::uint32_t count, float* amplitude,
                                                                    float* frequencyHz) {
    return guarded([&] {
        require(haptoflow_clip_curves(clipAt(address), count, amplitude, frequencyHz));
        return 0;
    });
}

/// Makes the wave that voices play, which takes seconds for a long clip and which the first play would make: on a
/// voice that nobody renders, so that the page's thread never waits for it.
HAPTO_EXPORT HAPTO_NAMED("hapto_clip_prepare") int hapto_clip_prepare(int address) {
    return guarded([&] {
        constexpr double anyRateHz = 48000.0;
        UnheardVoice unheard;
        // Where all voices are in use, the first play makes it.
        if (haptoflow_voice_create(theEngine(), anyRateHz, &unheard.voice) == HAPTOFLOW_OK) {
            require(haptoflow_voice_play_clip(unheard.voice, clipAt(address), 1.0F, 0));
        }
        return 0;
    });
}
