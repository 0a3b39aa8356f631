// The network with its own output as previous waveform, for a long time at constant input: level and spectrum must stay
// constant. HAPTOFLOW_TEST_LOOP_SECONDS sets the duration for a label; the soak test uses ten minutes on every label.
#include "open_engine.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <string>

namespace haptoflow::capi::testing {
namespace {

using haptoflow::testing::levelDecibels;

constexpr double outputHz = 8000.0;
constexpr std::size_t decimation = 4;
constexpr std::size_t frameSamples = 400;
constexpr std::size_t bins = frameSamples / 2;

double loopSeconds() {
    const char* given = std::getenv("HAPTOFLOW_TEST_LOOP_SECONDS");
    return given != nullptr ? std::strtod(given, nullptr) : 24.0;
}

/// Mean magnitude spectrum over frames that overlap by half, 0 to 1 kHz in steps of 5 Hz.
std::vector<double> meanSpectrum(const std::vector<float>& waveform) {
    static const auto cycles = [] {
        std::array<std::complex<double>, frameSamples> table;
        for (std::size_t i = 0; i < frameSamples; ++i) {
            table[i] = std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(i) / frameSamples);
        }
        return table;
    }();
    std::vector<double> sum(bins);
    for (std::size_t begin = 0; begin + frameSamples <= waveform.size(); begin += frameSamples / 2) {
        for (std::size_t bin = 0; bin < bins; ++bin) {
            std::complex<double> value;
            for (std::size_t i = 0; i < frameSamples; ++i) {
                const double window = 0.5 - 0.5 * cycles[i].real();
                value += window * static_cast<double>(waveform[begin + i]) * cycles[bin * i % frameSamples];
            }
            sum[bin] += std::abs(value);
        }
    }
    return sum;
}

/// Goodness-of-fit coefficient: the cosine between two spectra.
double goodnessOfFit(const std::vector<double>& first, const std::vector<double>& second) {
    const auto product = [](const std::vector<double>& one, const std::vector<double>& other) {
        return std::inner_product(one.begin(), one.end(), other.begin(), 0.0);
    };
    return product(first, second) / std::sqrt(product(first, first) * product(second, second));
}

class ClosedLoopTest : public ::testing::TestWithParam<uint32_t> {};

TEST_P(ClosedLoopTest, LevelAndSpectrumStayConstantForAConstantInput) {
    OpenEngine open(defaultModelPath, false, HAPTOFLOW_QUALITY_STANDARD, 1, outputHz);
    uint32_t labels = 0;
    ASSERT_EQ(haptoflow_model_label_count(open.model, &labels), HAPTOFLOW_OK);
    ASSERT_LT(GetParam(), labels);
    const double seconds = loopSeconds();
    haptoflow_contact_state state = slidingState(0.12F, 1.0F);
    state.labels[0] = GetParam();

    std::vector<float> waveform;
    double rendered = 0.0;
    std::size_t phase = 0;
    for (uint32_t update = 0; rendered < seconds; ++update) {
        open.publish(state);
        (void)open.render(0, outputHz);
        open.step();
        const auto frames =
            static_cast<uint32_t>(outputHz * (update + 1) / 72.0) - static_cast<uint32_t>(outputHz * update / 72.0);
        const std::vector<float> block = open.render(frames, outputHz);
        ASSERT_TRUE(allFinite(block));
        for (const float sample : block) {
            if (phase++ % decimation == 0) {
                waveform.push_back(sample);
            }
        }
        rendered += static_cast<double>(frames) / outputHz;
    }
    EXPECT_EQ(open.statistics().underruns, 0U);
    // The limiter is for exceptions: in ten minutes, one impulse of concrete exceeded full scale, in two samples.
    EXPECT_LE(open.statistics().limited_samples, static_cast<std::uint64_t>(1e-6 * outputHz * seconds));

    // The first second still contains the seed.
    const auto part = static_cast<std::ptrdiff_t>(2000.0 * std::min(60.0, seconds / 3.0));
    const std::vector<float> first(waveform.begin() + 2000, waveform.begin() + 2000 + part);
    const std::vector<float> last(waveform.end() - part, waveform.end());
    const double levelChange = levelDecibels(last) - levelDecibels(first);
    const double fit = goodnessOfFit(meanSpectrum(first), meanSpectrum(last));
    RecordProperty("level_change_db", std::to_string(levelChange));
    RecordProperty("spectrum_gfc", std::to_string(fit));
    EXPECT_LT(std::abs(levelChange), 1.0);
    EXPECT_GE(fit, 0.98);
}

INSTANTIATE_TEST_SUITE_P(Label, ClosedLoopTest,
                         ::testing::Range(0U, 20U, std::getenv("HAPTOFLOW_TEST_LOOP_SECONDS") != nullptr ? 1U : 5U));

}  // namespace
}  // namespace haptoflow::capi::testing
