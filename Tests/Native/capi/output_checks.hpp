#pragma once

#include "open_engine.hpp"

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace haptoflow::capi::testing {

/// -60 dB.
constexpr float silence = 0.001F;
/// 0.04 m/s^2 at the default full scale: four times the fingertip's lowest detection threshold.
constexpr float perceptibleLevel = 0.0002F;

/// The signal before the limiter, whose curve is a hyperbola from the knee at 0.7 towards 1.
inline std::vector<float> unlimited(const std::vector<float>& output) {
    constexpr float knee = 0.7F;
    constexpr float headroom = 1.0F - knee;
    std::vector<float> given = output;
    for (float& sample : given) {
        const float magnitude = std::abs(sample);
        if (magnitude > knee) {
            sample = std::copysign(knee - headroom + headroom * headroom / (1.0F - magnitude), sample);
        }
    }
    return given;
}

/// Expects that the signal, from its beginning, has no step larger than resampler and gate can produce.
inline void expectNoStep(const std::vector<float>& output) {
    const std::vector<float> wave = unlimited(output);
    EXPECT_LE(largestStepFrom(0.0F, wave), haptoflow::testing::steepestStep(48000.0) * peak(wave));
}

/// Lifts off and appends the remaining output: below -60 dB after a block and 5 ms, and exactly zero after that.
inline void expectSilenceAfterLiftOff(OpenEngine& open, uint32_t touchCounter, std::vector<float>& output) {
    const std::vector<float> fade = open.update(liftedState(touchCounter), 256 + 240);
    const std::vector<float> end = open.render(4800);
    EXPECT_LT(peak(std::span(fade).subspan(256)), silence) << "after the end of contact";
    EXPECT_EQ(peak(end), 0.0F) << "after the end of contact";
    output.insert(output.end(), fade.begin(), fade.end());
    output.insert(output.end(), end.begin(), end.end());
}

/// Appends a part of the output after checking that it is finite and within +-1.
inline void appendChecked(std::vector<float>& output, const std::vector<float>& part, uint32_t update) {
    EXPECT_TRUE(allFinite(part)) << "update " << update;
    EXPECT_LE(peak(part), 1.0F) << "update " << update;
    output.insert(output.end(), part.begin(), part.end());
}

/// A model and a quality for hard cases.
struct Subject {
    const char* name;
    const std::string* modelPath;
    haptoflow_quality quality;
};

inline const auto subjects =
    ::testing::Values(Subject{"ShippedDraft", &defaultModelPath, HAPTOFLOW_QUALITY_DRAFT},
                      Subject{"ShippedStandard", &defaultModelPath, HAPTOFLOW_QUALITY_STANDARD},
                      Subject{"ShippedSketch", &defaultModelPath, HAPTOFLOW_QUALITY_SKETCH},
                      Subject{"Untrained", &tinyModelPath, HAPTOFLOW_QUALITY_DRAFT});

/// The test name of a subject and a named case.
inline const auto subjectAndCaseName = [](const auto& parameters) {
    return std::string(std::get<0>(parameters.param).name) + std::get<1>(parameters.param).name;
};

}  // namespace haptoflow::capi::testing
