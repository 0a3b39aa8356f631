// Engines with some of their model's tiers loaded, and others added later.
#include "engine/live_engine.hpp"

#include "fake_generators.hpp"
#include "simulated_device.hpp"
#include "test_model.hpp"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>
#include <vector>

namespace haptoflow::engine {
namespace {

class LoadedTiersTest : public ::testing::Test {
protected:
    static constexpr std::size_t tierCount = 3;

    std::unique_ptr<testing::FakeGenerator> tier(std::size_t index) {
        auto made = std::make_unique<testing::FakeGenerator>(testing::continueTone, static_cast<float>(index + 1));
        seen_[index] = made.get();
        return made;
    }
    EngineTiers only(std::size_t index) {
        EngineTiers tiers(tierCount);
        tiers[index] = tier(index);
        return tiers;
    }
    static LiveEngineSettings settings(std::optional<std::size_t> fixedTier) {
        LiveEngineSettings settings;
        settings.quality.fixedTier = fixedTier;
        settings.hasWorker = false;
        return settings;
    }
    /// Publishes a contact state, renders until the next one and runs a round.
    static void update(LiveEngine& engine, LiveVoice& voice) {
        std::vector<float> block(256);
        engine.publish(voice, testing::sliding());
        for (int blocks = 0; blocks < 3; ++blocks) {
            voice.renderer.render(block, 48000.0);
        }
        (void)engine.step();
    }
    [[nodiscard]] int generatedBy(std::size_t index) const {
        return seen_[index] == nullptr ? 0 : seen_[index]->generated;
    }

    std::shared_ptr<const model::ModelFile> model_ = std::make_shared<const model::ModelFile>(testing::smallModel());
    std::array<testing::FakeGenerator*, tierCount> seen_{};
};

TEST_F(LoadedTiersTest, ASingleLoadedTierKeepsItsIndexInTheModel) {
    for (std::size_t index = 0; index < tierCount; ++index) {
        LiveEngine engine(model_, only(index), 1, settings(index));
        const auto voice = engine.addVoice(48000.0);
        update(engine, *voice);
        EXPECT_EQ(generatedBy(index), 1);
        const EngineStatistics& statistics = engine.statistics();
        EXPECT_EQ(statistics.tier, index);
        ASSERT_EQ(engine.tierCount(), tierCount);
        for (std::size_t other = 0; other < tierCount; ++other) {
            EXPECT_EQ(engine.tierTimes(other).runs, other == index ? 1U : 0U);
        }
    }
}

TEST_F(LoadedTiersTest, AQualityThatIsNotLoadedIsRejectedAndThePresentOneContinues) {
    LiveEngine engine(model_, only(0), 1, settings(0));
    EXPECT_THROW(engine.setQuality({.fixedTier = 2}), std::invalid_argument);
    EXPECT_THROW(engine.setQuality({.fixedTier = std::nullopt}), std::invalid_argument);
    const auto voice = engine.addVoice(48000.0);
    update(engine, *voice);
    EXPECT_EQ(generatedBy(0), 1);
    EXPECT_EQ(engine.statistics().tier, 0U);
}

TEST_F(LoadedTiersTest, ATierAddedLaterTakesOverWithTheNextSegment) {
    LiveEngine engine(model_, only(0), 1, settings(0));
    const auto voice = engine.addVoice(48000.0);
    update(engine, *voice);
    engine.addTier(2, tier(2));
    EXPECT_TRUE(engine.hasTier(2));
    EXPECT_FALSE(engine.hasTier(1));
    update(engine, *voice);
    EXPECT_EQ(generatedBy(2), 0) << "the tier is not in use yet";
    engine.setQuality({.fixedTier = 2});
    update(engine, *voice);
    EXPECT_EQ(generatedBy(0), 2);
    EXPECT_EQ(generatedBy(2), 1);
    EXPECT_EQ(engine.statistics().tier, 2U);
}

TEST_F(LoadedTiersTest, ALoadedTierIsNotReplaced) {
    LiveEngine engine(model_, only(0), 1, settings(0));
    testing::FakeGenerator* const first = seen_[0];
    engine.addTier(0, tier(0));
    const auto voice = engine.addVoice(48000.0);
    update(engine, *voice);
    EXPECT_EQ(first->generated, 1);
}

TEST_F(LoadedTiersTest, AnEngineWithoutItsStartTierIsRejected) {
    EXPECT_THROW(LiveEngine(model_, only(0), 1, settings(1)), std::invalid_argument);
    EXPECT_THROW(LiveEngine(model_, only(0), 0, settings(std::nullopt)), std::invalid_argument);
    EXPECT_THROW(LiveEngine(model_, EngineTiers(tierCount), 0, settings(0)), std::invalid_argument);
}

}  // namespace
}  // namespace haptoflow::engine
