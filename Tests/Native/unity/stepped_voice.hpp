#pragma once

#include "capi/open_handles.hpp"
#include "haptoflow/haptoflow.h"
#include "support/wave_measures.hpp"
#include "unity_host.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

namespace haptoflow::unity::testing {

using haptoflow::testing::largestStep;
using haptoflow::testing::largestStepFrom;
using haptoflow::testing::peak;

/// Samples of a display frame in these tests: 10 ms at 48 kHz.
inline constexpr std::size_t frameOfAudio = 480;

/// A voice with its own engine, which is stepped explicitly. Two of them give identical samples.
class SteppedVoice {
public:
    SteppedVoice(const haptoflow_runtime* runtime, const haptoflow_model* model) {
        haptoflow_engine_options options = capi::testing::engineOptions(runtime, model, HAPTOFLOW_QUALITY_STANDARD);
        options.seed = 11;
        *engine_.out() = capi::testing::createEngine(options);
        EXPECT_EQ(haptoflow_voice_create(engine_, 48000.0, &voice_), HAPTOFLOW_OK) << haptoflow_last_message();
    }
    SteppedVoice(const SteppedVoice&) = delete;
    SteppedVoice& operator=(const SteppedVoice&) = delete;
    /// Also renders what is left of the voice, so that its place is free again.
    ~SteppedVoice() {
        close();
        std::array<float, frameOfAudio> rest{};
        while (haptoflow_voice_render(voice_, rest.data(), std::uint32_t{frameOfAudio}, 1, 0, 48000.0) ==
               HAPTOFLOW_OK) {
        }
    }

    void close() { EXPECT_EQ(haptoflow_engine_close(engine_.out()), HAPTOFLOW_OK) << haptoflow_last_message(); }

    /// Publishes a sliding state that differs a little each time.
    void slide() {
        ++slides_;
        publish(1, 0.15F + 0.1F * std::sin(0.7F * static_cast<float>(slides_)));
    }
    void lift() { publish(0, 0.0F); }
    void generate() { EXPECT_EQ(haptoflow_engine_step(engine_), HAPTOFLOW_OK) << haptoflow_last_message(); }

    /// Renders into `sound` through the C interface.
    void renderInto(Sound& sound, std::int32_t channel) const {
        EXPECT_EQ(haptoflow_voice_render(voice_, sound.samples.data(), static_cast<std::uint32_t>(sound.frames),
                                         static_cast<std::uint32_t>(sound.channels), channel, 48000.0),
                  HAPTOFLOW_OK);
    }

    [[nodiscard]] haptoflow_voice_statistics statistics() const { return capi::testing::statisticsOf(voice_); }
    [[nodiscard]] float place() const {
        std::uint32_t place = 0;
        EXPECT_EQ(haptoflow_voice_place(voice_, &place), HAPTOFLOW_OK) << haptoflow_last_message();
        return static_cast<float>(place);
    }

private:
    void publish(std::uint32_t touching, float speedMps) {
        auto state = capi::testing::sized<haptoflow_contact_state>();
        state.touching = touching;
        state.touch_counter = 1;
        state.label_count = 1;
        state.weights[0] = 1.0F;
        state.velocity_mps[0] = speedMps;
        state.force_newtons = 1.0F;
        EXPECT_EQ(haptoflow_voice_publish(voice_, &state), HAPTOFLOW_OK) << haptoflow_last_message();
    }

    capi::testing::EngineHandle engine_;
    haptoflow_voice voice_ = 0;
    int slides_ = 0;
};

/// Fixture with the mixer effect and the tiny model.
class VoiceEffectTest : public capi::testing::WithTinyModel {
protected:
    [[nodiscard]] const AudioEffectDefinition& definition() const { return host_.effect("HaptoFlow Voice"); }

    /// Plays display frames of sliding, one block each.
    static Sound play(SteppedVoice& voice, HostedEffect& effect, int displayFrames, std::size_t channels = 2) {
        Sound output(0, channels);
        for (int i = 0; i < displayFrames; ++i) {
            voice.slide();
            output.append(effect.process(frameOfAudio, channels));
            voice.generate();
        }
        return output;
    }
    /// The expected result, rendered by the C interface into one channel.
    static std::vector<float> reference(SteppedVoice& voice, int displayFrames) {
        Sound output(0, 1);
        for (int i = 0; i < displayFrames; ++i) {
            voice.slide();
            Sound block(frameOfAudio, 1);
            voice.renderInto(block, 0);
            output.append(block);
            voice.generate();
        }
        return output.samples;
    }

    UnityHost host_;
    SteppedVoice voice_{runtime_, model_};
};

}  // namespace haptoflow::unity::testing
