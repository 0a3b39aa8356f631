#include "engine/material_library.hpp"

#include "engine/material.hpp"
#include "inference/golden_file.hpp"
#include "model/material_builder.hpp"
#include "small_library.hpp"
#include "support/wave_measures.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

namespace haptoflow::engine {
namespace {

using haptoflow::testing::gainDecibels;
using nlohmann::json;
using testing::SmallLibrary;

/// A valid material file for a model, changed by the test.
model::MaterialFile materialOf(const model::ModelFile& model, const std::function<void(json&)>& change = {}) {
    json text = model::testing::validMaterial(model::spaceOf(model.header()));
    if (change) {
        change(text);
    }
    return model::parseMaterial(text.dump());
}

std::string nameOf(const MaterialLibrary& library, std::size_t index) {
    std::string name;
    library.showLabel(index, [&name](const model::Label& label) { name = label.name; });
    return name;
}

void withoutLevel(json& material) {
    material.erase("level");
    material.erase("level_offset_db");
}

TEST(MaterialLibraryTest, ARegisteredMaterialHasAnIndexAfterTheLabels) {
    SmallLibrary small;
    EXPECT_EQ(small.library.add(materialOf(small.model), small.levels()), 2U);
    EXPECT_EQ(small.library.add(materialOf(small.model, [](json& text) { text["name"] = "jeans"; }), small.levels()),
              3U);
    EXPECT_EQ(small.library.registeredCount(), 2U);
    EXPECT_EQ(nameOf(small.library, 3), "jeans");
    const Ingredients alone = small.ingredients({{2, 1.0F}});
    EXPECT_EQ(alone.heaviest().index, 2U);
    EXPECT_EQ(resolveMaterial(alone).embedding[63], 0.5F);
    EXPECT_EQ(small.ingredients({{4, 1.0F}}).heaviest().index, 0U) << "no material is registered at that index yet";
}

TEST(MaterialLibraryTest, AFullLibraryAndInvalidIndicesAreRejected) {
    SmallLibrary small;
    for (std::size_t count = 0; count < MaterialLibrary::maximumRegistered; ++count) {
        EXPECT_EQ(small.library.add(materialOf(small.model), small.levels()), 2U + count);
    }
    EXPECT_THROW((void)small.library.add(materialOf(small.model), small.levels()), std::invalid_argument);
    for (const std::size_t index : {std::size_t{0}, std::size_t{1}, std::size_t{66}, std::size_t{1000000}}) {
        EXPECT_THROW(small.library.replace(index, materialOf(small.model), small.levels()), std::invalid_argument);
        EXPECT_THROW((void)nameOf(small.library, index), std::invalid_argument);
    }
}

TEST(MaterialLibraryTest, OnlyAMaterialWithoutItsOwnLevelUsesTheLevelGraph) {
    SmallLibrary small;
    (void)small.library.add(materialOf(small.model, withoutLevel), small.levels());
    const std::array<float, 3> motion{0.1F, 0.0F, 2.0F};
    EXPECT_NEAR(small.ingredients({{2, 1.0F}}).levelMps2(motion), testing::MotionGenerator::levelMps2(motion), 0.1F);
    (void)small.library.add(materialOf(small.model), []() -> inference::LevelEstimator& {
        throw std::logic_error("the level graph must not be used");
    });
}

TEST(MaterialLibraryTest, ABlendsLevelIsTheMeanOfItsMaterialsInDecibels) {
    SmallLibrary small;
    (void)small.library.add(materialOf(small.model), small.levels());
    const std::array<float, 3> motion{0.1F, 0.0F, 1.0F};
    const float own = small.ingredients({{2, 1.0F}}).levelMps2(motion);
    const float graph = small.ingredients({{0, 1.0F}}).levelMps2(motion);
    EXPECT_NEAR(small.ingredients({{0, 0.75F}, {2, 0.25F}}).levelMps2(motion),
                std::pow(own, 0.25F) * std::pow(graph, 0.75F), 1e-4F);
}

TEST(MaterialLibraryTest, LevelsAndKernelsMatchTheGoldenFiles) {
    const json golden = haptoflow::testing::readGolden("material/expected.json");
    for (const auto& [modelPath, name] :
         {std::pair<std::string, std::string>{HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow", "ribbed"},
          {HAPTOFLOW_TEST_DEFAULT_MODEL, "denim"}}) {
        SmallLibrary small(model::ModelFile::read(modelPath));
        const auto index = static_cast<std::uint32_t>(small.library.add(
            model::readMaterial(HAPTOFLOW_TEST_GOLDEN_DIR "/material/" + name + ".haptomaterial"), small.levels()));
        const Ingredients alone = small.ingredients({{index, 1.0F}});
        const json& expected = golden.at("materials").at(name);
        ASSERT_GT(expected.at("levels").size(), 20U);
        for (const json& level : expected.at("levels")) {
            const std::array<float, 3> motion{level.at("speed_mps").get<float>(), 0.0F,
                                              level.at("force_newtons").get<float>()};
            EXPECT_NEAR(alone.heaviest().material->logLevel(motion), level.at("log_level").get<double>(), 1e-5)
                << name << level;
        }
        ASSERT_GT(expected.at("kernels").size(), 5U);
        for (const json& kernel : expected.at("kernels")) {
            const auto tone = resolveTone(alone, kernel.at("speed_mps").get<double>(), 1.0, 0.0, designTilt());
            ASSERT_TRUE(tone);
            const dsp::ToneKernel found = dsp::toneKernel(*tone);
            const auto taps = kernel.at("taps").get<std::vector<double>>();
            for (std::size_t tap = 0; kernel.at("at_table_speed").get<bool>() && tap < taps.size(); ++tap) {
                EXPECT_NEAR(found[tap], taps[tap], 1e-5) << name << ' ' << kernel.at("speed_mps") << ' ' << tap;
            }
            for (double frequencyHz = 20.0; frequencyHz < 900.0; frequencyHz *= 1.3) {
                EXPECT_NEAR(gainDecibels(found, frequencyHz), gainDecibels(taps, frequencyHz), 1.0);
            }
        }
    }
}

TEST(MaterialLibraryTest, ATiltAddsToTheMaterialsToneAbout150Hz) {
    SmallLibrary small;
    (void)small.library.add(materialOf(small.model), small.levels());
    const dsp::ToneCepstrum tilt = designTilt();
    EXPECT_FALSE(resolveTone(small.ingredients({{0, 1.0F}}), 0.1, 1.0, 0.0, tilt));
    const auto responseDb = [](const dsp::ToneCepstrum& cepstrum, double frequencyHz) {
        return gainDecibels(dsp::toneKernel(cepstrum), frequencyHz);
    };
    const auto bright = resolveTone(small.ingredients({{0, 1.0F}}), 0.1, 1.0, 3.0, tilt);
    const auto plain = resolveTone(small.ingredients({{2, 1.0F}}), 0.1, 1.0, 0.0, tilt);
    const auto both = resolveTone(small.ingredients({{2, 1.0F}}), 0.1, 1.0, 3.0, tilt);
    ASSERT_TRUE(bright && plain && both);
    EXPECT_NEAR(responseDb(*bright, 150.0), 0.0, 0.5);
    EXPECT_NEAR(responseDb(*bright, 600.0), 6.0, 0.5);
    EXPECT_NEAR(responseDb(*bright, 75.0), -3.0, 0.5);
    for (const double frequencyHz : {80.0, 150.0, 400.0, 800.0}) {
        EXPECT_NEAR(responseDb(*both, frequencyHz), responseDb(*plain, frequencyHz) + responseDb(*bright, frequencyHz),
                    0.3);
    }
}

TEST(MaterialLibraryTest, PublishersReadConsistentMaterialsDuringConcurrentReplacement) {
    SmallLibrary small;
    // All values of a material equal the number of its generation, so a reader of a partly replaced material would find
    // two different values.
    const auto generation = [&small](int number) {
        return materialOf(small.model, [number](json& text) {
            text["embedding"] = std::vector<double>(64, number);
            text["name"] = std::string(100, static_cast<char>('a' + number % 26));
        });
    };
    (void)small.library.add(generation(0), small.levels());
    std::atomic<bool> ended{false};
    std::atomic<std::uint64_t> looks{0};
    std::atomic<int> torn{0};
    std::vector<std::thread> readers;
    for (int reader = 0; reader < 3; ++reader) {
        readers.emplace_back([&] {
            while (!ended) {
                const MaterialLibrary::ReadScope reading(small.library);
                const Ingredients found = reading.ingredients(testing::blendOf({{2, 1.0F}}));
                const PreparedMaterial& material = *found.heaviest().material;
                const float first = material.embedding[0];
                const auto letter = static_cast<char>('a' + static_cast<int>(first) % 26);
                const bool isWhole = std::ranges::all_of(material.embedding, [first](float v) { return v == first; }) &&
                                     material.label->name == std::string(100, letter);
                torn += isWhole ? 0 : 1;
                ++looks;
            }
        });
    }
    for (int number = 1; number < 100; ++number) {
        small.library.replace(2, generation(number), small.levels());
    }
    ended = true;
    std::ranges::for_each(readers, [](std::thread& reader) { reader.join(); });
    EXPECT_EQ(torn, 0);
    EXPECT_GT(looks, 100U);
}

}  // namespace
}  // namespace haptoflow::engine
