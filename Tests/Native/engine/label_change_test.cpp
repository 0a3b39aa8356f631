// A change of label of the shipped model in mid-stroke.

#include "engine/offline_renderer.hpp"
#include "model/model_file.hpp"
#include "simulated_device.hpp"
#include "support/model_generator.hpp"
#include "support/wave_measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::engine {
namespace {

constexpr std::size_t labelSamples = 200;

class LabelChangeTest : public ::testing::TestWithParam<std::pair<const char*, const char*>> {
protected:
    [[nodiscard]] std::uint32_t labelOf(const std::string& name) const {
        const auto& labels = model_.header().labels;
        return static_cast<std::uint32_t>(std::ranges::find(labels, name, &model::Label::name) - labels.begin());
    }

    /// The waveform of a stroke that changes between two labels every 100 ms.
    [[nodiscard]] std::vector<float> alternating(std::uint32_t first, std::uint32_t second) const {
        const auto generator = haptoflow::testing::generatorOf(model_, 1, "sketch");
        const auto hand = [&](double seconds) {
            ContactState state = testing::sliding();
            state.velocityMps = {0.1F, 0.0F};
            state.material = {};
            state.material.add(static_cast<int>(seconds * 10.0 + 1e-6) % 2 == 0 ? first : second, 1.0F);
            return state;
        };
        constexpr double updateHz = 100.0;
        const auto states = testing::statesOf(16.0, hand, updateHz);
        return renderOffline(model_, *generator, states, {.fullScaleMps2 = 1e5F, .tailSeconds = 0.0}).waveformMps2;
    }

    model::ModelFile model_ = model::ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
};

TEST_P(LabelChangeTest, FiveMillisecondsAfterAChangeBothLabelsHaveTheirOwnLevel) {
    const auto [loud, quiet] = GetParam();
    const std::vector<float> wave = alternating(labelOf(loud), labelOf(quiet));
    const auto levelOf = [&](std::size_t label, std::size_t first, std::size_t last) {
        std::vector<float> gathered;
        for (std::size_t change = (2 + label) * labelSamples; change + labelSamples <= wave.size();
             change += 2 * labelSamples) {
            gathered.insert(gathered.end(), wave.begin() + static_cast<std::ptrdiff_t>(change + first),
                            wave.begin() + static_cast<std::ptrdiff_t>(change + last));
        }
        return haptoflow::testing::levelDecibels(gathered);
    };
    EXPECT_NEAR(levelOf(0, 10, 20), levelOf(0, 100, 200), 4.0) << loud;
    EXPECT_NEAR(levelOf(1, 10, 20), levelOf(1, 100, 200), 4.0) << quiet;
}

INSTANTIATE_TEST_SUITE_P(Pairs, LabelChangeTest,
                         ::testing::Values(std::pair{"stone", "plastic"}, std::pair{"stone", "fur"},
                                           std::pair{"sandpaper", "carpet"}, std::pair{"metal", "rubber"}));

}  // namespace
}  // namespace haptoflow::engine
