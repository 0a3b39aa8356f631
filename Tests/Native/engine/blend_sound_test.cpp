// Blends of the shipped model, rendered in closed loop.
#include "engine/offline_renderer.hpp"
#include "model/model_file.hpp"
#include "support/model_generator.hpp"
#include "support/wave_measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <initializer_list>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace haptoflow::engine {
namespace {

class BlendSoundTest : public ::testing::Test {
protected:
    [[nodiscard]] testing::LabelWeight part(const std::string& label, float weight) const {
        return {static_cast<std::uint32_t>(std::ranges::find(model_.header().labels, label, &model::Label::name) -
                                           model_.header().labels.begin()),
                weight};
    }

    /// The waveform played while a tip slides over a blend, without the touch-down.
    std::vector<float> played(const std::vector<testing::LabelWeight>& blend, std::array<float, 2> velocityMps,
                              double seconds) {
        std::vector<TimedContactState> states;
        for (int update = 0; update < static_cast<int>(seconds * 72.0); ++update) {
            states.push_back(stateOf(update, velocityMps, blend));
        }
        return render(states);
    }
    std::vector<float> render(const std::vector<TimedContactState>& states) {
        std::vector<float> wave =
            renderOffline(model_, *generator_, states, {.fullScaleMps2 = 1e5F, .tailSeconds = 0.0}).waveformMps2;
        wave.erase(wave.begin(), wave.begin() + 400);
        return wave;
    }
    static TimedContactState stateOf(int update, std::array<float, 2> velocityMps,
                                     const std::vector<testing::LabelWeight>& blend) {
        TimedContactState state;
        state.timeSeconds = update / 72.0;
        state.touching = true;
        state.touchCounter = 1;
        state.velocityMps = velocityMps;
        state.forceNewtons = 1.0F;
        state.material = testing::blendOf(blend);
        return state;
    }

    /// The share of the power within 2 % of a frequency.
    static double shareOfLine(const std::vector<float>& wave, double frequencyHz) {
        double line = 0.0;
        double whole = 0.0;
        for (double hz = 4.0; hz < 990.0; hz += 0.5) {
            std::complex<double> sum = 0.0;
            const std::complex<double> step = std::polar(1.0, -2.0 * std::numbers::pi * hz / 2000.0);
            std::complex<double> turn = 1.0;
            for (const float sample : wave) {
                sum += static_cast<double>(sample) * turn;
                turn *= step;
            }
            whole += std::norm(sum);
            line += std::abs(hz - frequencyHz) <= 0.02 * frequencyHz ? std::norm(sum) : 0.0;
        }
        return line / whole;
    }

    model::ModelFile model_ = model::ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
    std::unique_ptr<inference::TierGenerator> generator_ = haptoflow::testing::generatorOf(model_, 4, "draft");
};

TEST_F(BlendSoundTest, EveryBlendLiesWithinHalfADecibelOfItsLabels) {
    const std::size_t labels = model_.header().labels.size();
    for (const float speedMps : {0.03F, 0.3F}) {
        const std::array<float, 2> velocity{0.8F * speedMps, 0.6F * speedMps};
        std::vector<double> alone;
        for (std::uint32_t label = 0; label < labels; ++label) {
            alone.push_back(haptoflow::testing::levelDecibels(played({{label, 1.0F}}, velocity, 5.0)));
        }
        for (std::uint32_t first = 0; first < labels; ++first) {
            for (std::uint32_t second = first + 1; second < labels; ++second) {
                const double blend =
                    haptoflow::testing::levelDecibels(played({{first, 0.5F}, {second, 0.5F}}, velocity, 4.0));
                const auto [softer, louder] = std::minmax(alone[first], alone[second]);
                EXPECT_GT(blend, softer - 0.5) << model_.header().labels[first].name << " and "
                                               << model_.header().labels[second].name << " at " << speedMps;
                EXPECT_LT(blend, louder + 0.5) << model_.header().labels[first].name << " and "
                                               << model_.header().labels[second].name << " at " << speedMps;
            }
        }
    }
}

TEST_F(BlendSoundTest, ABlendOfWoodAndCorduroyHasWeakerRibsOfTheSamePitch) {
    // 0.15 m/s over ribs with a period of 2.5 mm gives 60 Hz. A mean of wave vectors would give 30 Hz.
    const std::array<float, 2> velocity{0.15F, 0.0F};
    const double pure = shareOfLine(played({part("corduroy", 1.0F)}, velocity, 4.0), 60.0);
    const std::vector<float> blend = played({part("wood", 0.5F), part("corduroy", 0.5F)}, velocity, 4.0);
    const double half = shareOfLine(blend, 60.0);
    const double wood = shareOfLine(played({part("wood", 1.0F)}, velocity, 4.0), 60.0);
    EXPECT_GT(half, 2.0 * wood) << "the ribs are present";
    EXPECT_LT(half, 0.8 * pure) << "the ribs are weaker";
    EXPECT_GT(half, 3.0 * shareOfLine(blend, 30.0)) << "there are no ribs at half the pitch";
}

}  // namespace
}  // namespace haptoflow::engine
