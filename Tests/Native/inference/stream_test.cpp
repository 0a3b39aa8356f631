#include "skeleton/stream.hpp"

#include "inference/golden_file.hpp"
#include "skeleton/condition.hpp"
#include "skeleton/skeleton_tensors.hpp"
#include "skeleton_model.hpp"
#include "support/counting_new.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace haptoflow::skeleton::testing {
namespace {

using ::testing::FloatNear;
using ::testing::Pointwise;

constexpr NoiseKey key{.seed = 5, .voice = 1, .segment = 2};

/// Reads `samples` in calls of at most `size`, in m/s^2.
std::vector<float> read(Stream& stream, const Skeleton* skeleton, std::size_t samples, std::size_t size) {
    std::vector<float> wave(samples);
    for (std::size_t done = 0; done < samples; done += size) {
        const auto piece = std::span(wave).subspan(done, std::min(size, samples - done));
        stream.next(skeleton, piece);
        std::ranges::for_each(piece, [&stream](float& sample) { sample *= stream.nextRampedLevelMps2(); });
    }
    return wave;
}

class StreamTest : public ::testing::Test {
protected:
    StreamTest() {
        testContact = contactOf(*testSkeleton, {0.5F, -1.0F, 0.25F}, {0.06F, -0.08F, 1.0F}, {60.0, -130.0, 31.0});
        testContact.levelMps2 = 0.5F;
        testContact.surface = 7;
        testContact.path = {.startMetres = {0.013, -0.021, 0.008}, .stepMetres = {3e-5, -4e-5, 0.0}};
        testContact.isPlaced = true;
        testContact.ribs = {WaveVector{1.0F, 0.0F}, WaveVector{0.0F, 1.625F}};
    }

    static StreamParameters contactOf(const Skeleton& skeleton, const std::array<float, embeddingSize>& embedding,
                                      const Motion& motion, const std::array<double, familyCount>& ratesHz) {
        StreamParameters contact;
        Phases phases{};
        for (std::size_t family = 0; family < familyCount; ++family) {
            phases[familyCount + family] = static_cast<float>(ratesHz[family]);
            contact.families[family] = {.phase = {.cycles = 0.25, .rateHz = ratesHz[family]}, .isPlaced = true};
        }
        contact.skeleton = skeleton.parametersFor(conditionOf(embedding, motion, phases), ratesHz);
        return contact;
    }

    [[nodiscard]] Stream begun() const {
        Stream stream;
        stream.begin(testContact, 3.0, key);
        return stream;
    }

    static void expectNear(const std::vector<float>& found, const std::vector<float>& expected, double limit) {
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t n = 0; n < found.size(); ++n) {
            ASSERT_NEAR(found[n], expected[n], limit) << n;
        }
    }

    std::shared_ptr<const Skeleton> testSkeleton = readSkeleton(testing::read(skeletonModel()));
    StreamParameters testContact;
};

TEST_F(StreamTest, ReadInPiecesOfAnySizeItHasTheSameSamples) {
    const auto waveOf = [&](std::size_t size) {
        Stream stream = begun();
        std::vector<float> wave = read(stream, testSkeleton.get(), 100, size);
        StreamParameters other = testContact;
        other.path.startMetres[0] += 0.001;
        other.families[1].phase.cycles += 0.3;
        other.levelMps2 = 1.5F;
        stream.follow(other, 7.25);
        const std::vector<float> rest = read(stream, testSkeleton.get(), 300, size);
        wave.insert(wave.end(), rest.begin(), rest.end());
        return wave;
    };
    const std::vector<float> whole = waveOf(300);
    for (const std::size_t size : {1U, 5U, 11U, 32U}) {
        SCOPED_TRACE(size);
        expectNear(waveOf(size), whole, 1e-5);
    }
}

TEST_F(StreamTest, ACopyGoesOnAsTheOriginal) {
    Stream stream = begun();
    (void)read(stream, testSkeleton.get(), 77, 11);
    Stream copy = stream;
    EXPECT_EQ(read(copy, testSkeleton.get(), 300, 11), read(stream, testSkeleton.get(), 300, 11));
}

TEST_F(StreamTest, AnUnchangedContactThatIsToldAgainChangesNothing) {
    Stream one = begun();
    Stream other = begun();
    const std::vector<float> whole = read(one, testSkeleton.get(), 400, 11);
    std::vector<float> parts;
    for (std::size_t done = 0; done < 400; done += 25) {
        if (done > 0) {
            other.follow(testContact, 3.0 + static_cast<double>(done));
        }
        const std::vector<float> part = read(other, testSkeleton.get(), 25, 11);
        parts.insert(parts.end(), part.begin(), part.end());
    }
    expectNear(parts, whole, 1e-5);
}

TEST_F(StreamTest, ANewLevelIsReachedAfterFourSamplesWhateverRingsOn) {
    for (const float level : {0.5F / 64.0F, 500.0F}) {
        SCOPED_TRACE(level);
        Stream stream = begun();
        (void)read(stream, testSkeleton.get(), 400, 32);
        Stream unchanged = stream;
        unchanged.follow(testContact, 403.0);
        StreamParameters other = testContact;
        other.levelMps2 = level;
        stream.follow(other, 403.0);
        const std::vector<float> wanted = read(unchanged, testSkeleton.get(), 100, 32);
        const std::vector<float> found = read(stream, testSkeleton.get(), 100, 32);
        const float change = level / testContact.levelMps2;
        const float first = level > testContact.levelMps2 ? 0.75F + 0.25F * change : std::pow(change, 0.25F);
        EXPECT_NEAR(found[0] / wanted[0], first, 1e-3F * first) << "no step";
        for (std::size_t n = 4; n < found.size(); ++n) {
            ASSERT_NEAR(found[n], change * wanted[n], 1e-3F * change) << n;
        }
    }
}

/// Of two equal pairs of poles, whose waveform of unit scale has the variance 1.
ReflectionFilter resonance(double frequencyHz, double radius) {
    const double first = -2.0 * radius * std::cos(2.0 * std::numbers::pi * frequencyHz / waveformRateHz);
    const double second = radius * radius;
    ReflectionFilter filter;
    filter.coefficients = {2.0 * first, first * first + 2.0 * second, 2.0 * first * second, second * second};
    filter.logGain = -0.5 * std::log(filter.variance());
    return filter;
}

TEST_F(StreamTest, APastThatWouldRingLouderInAnotherFilterIsLeftAcrossASpliceAndTheNewLevelHolds) {
    // What a wide filter made would ring on in a narrow one, and grow.
    const std::array<ReflectionFilter, 2> filters{resonance(700.0, 0.3), resonance(30.0, 0.9)};
    testContact.skeleton = {};
    const auto squaresAfterAChange = [&](std::size_t first) {
        double squares = 0.0;
        for (std::uint64_t trial = 0; trial < 400; ++trial) {
            testContact.surface = trial;
            testContact.skeleton.filter = filters[0];
            Stream stream;
            stream.begin(testContact, 0.0, {.seed = trial});
            (void)read(stream, testSkeleton.get(), 60, 32);
            testContact.skeleton.filter = filters[1];
            stream.follow(testContact, 0.0);
            const std::vector<float> wave = read(stream, testSkeleton.get(), first + 10, 32);
            for (const float sample : std::span(wave).last(10)) {
                squares += static_cast<double>(sample) * static_cast<double>(sample) / 4000.0;
            }
        }
        return squares / (0.5 * 0.5);
    };
    EXPECT_NEAR(10.0 * std::log10(squaresAfterAChange(4)), 0.0, 1.5);
    EXPECT_NEAR(10.0 * std::log10(squaresAfterAChange(100)), 0.0, 1.5);
}

TEST_F(StreamTest, TheLevelRisesEvenlyInAmplitudeAndFallsEvenlyInDecibelsWithinFourSamples) {
    Stream stream = begun();
    const auto levelsAfter = [&stream, this](float levelMps2) {
        testContact.levelMps2 = levelMps2;
        stream.follow(testContact, 4.0);
        std::array<float, 5> levels{};
        std::ranges::generate(levels, [&stream] { return stream.nextRampedLevelMps2(); });
        return levels;
    };
    EXPECT_FLOAT_EQ(stream.nextRampedLevelMps2(), 0.5F);
    EXPECT_THAT(levelsAfter(8.0F), Pointwise(FloatNear(1e-5F), {2.375F, 4.25F, 6.125F, 8.0F, 8.0F}));
    EXPECT_THAT(levelsAfter(0.5F), Pointwise(FloatNear(1e-5F), {4.0F, 2.0F, 1.0F, 0.5F, 0.5F}));
}

TEST_F(StreamTest, AStateOfTheSameLevelLeavesARampAsItIsAndOneOfAnotherBeginsItsOwnThere) {
    Stream stream = begun();
    const auto next = [&stream, this](float levelMps2) {
        testContact.levelMps2 = levelMps2;
        stream.follow(testContact, 4.0);
        return stream.nextRampedLevelMps2();
    };
    EXPECT_NEAR(next(4.5F), 1.5F, 1e-5F);
    EXPECT_NEAR(next(4.5F), 2.5F, 1e-5F);
    EXPECT_NEAR(next(10.5F), 4.5F, 1e-5F);
    EXPECT_NEAR(next(4.5F), 4.5F, 1e-5F);
    EXPECT_EQ(next(4.5F), 4.5F);
}

TEST_F(StreamTest, PhasesAreDrawnToThePlaceByAtMostATenthOfATurnPerState) {
    Stream stream = begun();
    const auto turnsAfterAState = [&](std::size_t family, double offset) {
        Stream drawn = stream;
        StreamParameters other = testContact;
        other.families[family].phase.cycles += offset;
        drawn.follow(other, 3.0);
        (void)read(drawn, testSkeleton.get(), 100, 11);
        return static_cast<double>(drawn.phases()[family]);
    };
    for (const std::size_t family : {0U, 1U}) {
        const double untouched = turnsAfterAState(family, 0.0);
        EXPECT_NEAR(std::remainder(turnsAfterAState(family, 0.06) - untouched, 1.0), 0.03, 1e-5);
        EXPECT_NEAR(std::remainder(turnsAfterAState(family, 0.4) - untouched, 1.0), 0.1, 1e-5);
        EXPECT_NEAR(std::remainder(turnsAfterAState(family, -0.4) - untouched, 1.0), -0.1, 1e-5);
    }
}

TEST_F(StreamTest, ASlowFamilyIsNeverMetBackwardsWhileItIsDrawnToThePlace) {
    testContact.families[0].phase.rateHz = 2.0;
    Stream stream = begun();
    testContact.families[0].phase.cycles -= 0.4;
    stream.follow(testContact, 3.0);
    float before = stream.phases()[0];
    for (int n = 0; n < 40; ++n) {
        (void)read(stream, testSkeleton.get(), 1, 1);
        EXPECT_GT(stream.phases()[0], before) << n;
        before = stream.phases()[0];
    }
}

TEST_F(StreamTest, ARibThatChangesItsFamilyTakesItsTurnsAlong) {
    Stream stream = begun();
    (void)read(stream, testSkeleton.get(), 50, 11);
    const Phases before = stream.phases();
    std::swap(testContact.ribs[0], testContact.ribs[1]);
    std::swap(testContact.families[0], testContact.families[1]);
    testContact.families[0].isPlaced = testContact.families[1].isPlaced = false;
    stream.follow(testContact, 53.0);
    const Phases swapped = stream.phases();
    EXPECT_EQ(swapped, (Phases{before[1], before[0], before[2], before[4], before[3], before[5]}));
}

TEST_F(StreamTest, WithoutASkeletonItIsSilentWhilePlacePhasesAndNoiseGoOn) {
    // Over the surface, and at rest.
    for (const SurfacePath& path : {testContact.path, SurfacePath{}}) {
        testContact.path = path;
        Stream silent = begun();
        Stream sounding = begun();
        EXPECT_EQ(read(silent, nullptr, 300, 11), std::vector<float>(300));
        (void)read(sounding, testSkeleton.get(), 300, 11);
        EXPECT_EQ(silent.phases(), sounding.phases());
        std::array<float, segmentSamples> unit{};
        NetworkInput silentInput;
        NetworkInput input;
        silent.next(nullptr, unit, &silentInput);
        EXPECT_EQ(unit, (std::array<float, segmentSamples>{}));
        sounding.next(testSkeleton.get(), unit, &input);
        for (std::size_t n = 0; n < segmentSamples; ++n) {
            EXPECT_NEAR(silentInput.noise[n], input.noise[n], 1e-5) << n;
            EXPECT_EQ(input.segment()[n], unit[n]) << n;
        }
    }
}

TEST_F(StreamTest, ABeginningSoundsAsIfItHadAlwaysGoneOn) {
    testContact.path = {};
    testContact.families = {};
    testContact.skeleton.impulseGains = {};
    Stream longer = begun();
    double power = 0.0;
    constexpr std::size_t samples = 1'000'000;
    for (const float sample : read(longer, testSkeleton.get(), samples, 32)) {
        power += static_cast<double>(sample) * static_cast<double>(sample) / samples;
    }
    constexpr std::uint64_t keys = 20'000;
    std::array<double, 48> powers{};
    for (std::uint64_t voice = 0; voice < keys; ++voice) {
        Stream stream;
        stream.begin(testContact, 0.0, {.seed = voice, .voice = 0, .segment = 9});
        const std::vector<float> wave = read(stream, testSkeleton.get(), powers.size(), 12);
        for (std::size_t n = 0; n < powers.size(); ++n) {
            powers[n] += static_cast<double>(wave[n]) * static_cast<double>(wave[n]) / keys;
        }
    }
    for (std::size_t n = 0; n < powers.size(); ++n) {
        EXPECT_NEAR(10.0 * std::log10(powers[n] / power), 0.0, 0.3) << n;
    }
}

TEST_F(StreamTest, AStreamAllocatesNothing) {
    std::array<float, 77> unit{};
    const std::size_t before = haptoflow::testing::allocationCount();
    Stream stream = begun();
    stream.next(testSkeleton.get(), unit);
    stream.follow(testContact, 80.0);
    Stream copy = stream;
    copy.next(testSkeleton.get(), unit);
    EXPECT_EQ(haptoflow::testing::allocationCount(), before);
    EXPECT_NE(unit[0], 0.0F);
}

TEST_F(StreamTest, LevelAndKurtosisDoNotDependOnHowOftenStatesCome) {
    const model::ModelFile model = model::ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
    const auto skeleton = readSkeleton(model);
    std::array<float, embeddingSize> embedding{};
    // Label 4 is brick, whose impulses raise the kurtosis.
    std::ranges::copy(model.embedding(4), embedding.begin());
    const auto measuresOf = [&](std::size_t samplesPerState) {
        constexpr std::size_t samples = 240'000;
        double squares = 0.0;
        double fourths = 0.0;
        Stream stream;
        for (std::size_t done = 0; done < samples; done += samplesPerState) {
            // From 40 to 160 mm/s and back, every two seconds.
            const double turn = std::numbers::pi * static_cast<double>(done) / 2000.0;
            const double speedMps = 0.1 - 0.06 * std::cos(turn);
            StreamParameters contact = contactOf(*skeleton, embedding, {static_cast<float>(speedMps), 0.0F, 1.0F}, {});
            contact.path = {
                .startMetres = {5e-5 * static_cast<double>(done) - 0.06 / std::numbers::pi * std::sin(turn)},
                .stepMetres = {speedMps / 2000.0}};
            contact.isPlaced = true;
            contact.levelMps2 = 1.0F;
            done == 0 ? stream.begin(contact, 0.0, key) : stream.follow(contact, 0.0);
            for (const float sample : read(stream, skeleton.get(), samplesPerState, 32)) {
                const double square = static_cast<double>(sample) * static_cast<double>(sample);
                squares += square / samples;
                fourths += square * square / samples;
            }
        }
        return std::pair(10.0 * std::log10(squares), fourths / (squares * squares));
    };
    const auto [seldomDb, seldomKurtosis] = measuresOf(100);
    const auto [oftenDb, oftenKurtosis] = measuresOf(4);
    EXPECT_NEAR(oftenDb, seldomDb, 0.05);
    // The kurtosis of a stroke varies by up to a fifth from one surface to the next, because it depends on a few
    // impulses.
    EXPECT_NEAR(oftenKurtosis / seldomKurtosis, 1.0, 0.2) << seldomKurtosis;
    EXPECT_GT(seldomKurtosis, 3.5) << "without impulses the test says little";
}

TEST(StreamGoldenTest, AStreamOverChangesOfItsParametersAgreesWithPythonInCallsOfAnySize) {
    const nlohmann::json golden = haptoflow::testing::readGolden("model/skeleton.stream.json");
    const model::ModelFile model = model::ModelFile::read(HAPTOFLOW_TEST_GOLDEN_DIR "/model/skeleton.haptoflow");
    const auto skeleton = readSkeleton(model);
    Synthesis synthesis;
    synthesis.begin(golden.at("begun").get<std::array<float, filterOrder>>());
    std::vector<float> expected;
    std::vector<float> found;
    for (const auto& state : haptoflow::testing::goldenRows(golden, "states")) {
        const auto noise = state.at("noise").get<std::vector<float>>();
        const auto unitWave = state.at("unit").get<std::vector<float>>();
        expected.insert(expected.end(), unitWave.begin(), unitWave.end());
        std::array<float, embeddingSize> embedding{};
        std::ranges::copy(model.embedding(state.at("label").get<std::size_t>()), embedding.begin());
        const auto phases = state.at("phases").get<std::array<double, 2 * familyCount>>();
        std::array<double, familyCount> ratesHz{};
        Phases given{};
        std::copy(phases.begin() + familyCount, phases.end(), ratesHz.begin());
        std::ranges::transform(phases, given.begin(), [](double each) { return static_cast<float>(each); });
        const SkeletonParameters parameters =
            skeleton->parametersFor(conditionOf(embedding, state.at("motion").get<Motion>(), given), ratesHz);
        synthesis.limitPast();
        std::size_t size = 1;
        for (std::size_t done = 0; done < noise.size(); size = size * 3 % 30 + 2) {
            const std::size_t samples = std::min(size, noise.size() - done);
            std::array<FamilyPhase, familyCount> families{};
            for (std::size_t family = 0; family < familyCount; ++family) {
                const double passed = static_cast<double>(done) / waveformRateHz;
                families[family] = {.cycles = phases[family] + ratesHz[family] * passed, .rateHz = ratesHz[family]};
            }
            Piece unit{};
            synthesis.next(skeleton->impulses(), parameters, families, std::span(noise).subspan(done, samples),
                           std::span(unit).first(samples));
            found.insert(found.end(), unit.begin(), unit.begin() + static_cast<std::ptrdiff_t>(samples));
            done += samples;
        }
    }
    double power = 0.0;
    for (const float sample : expected) {
        power += static_cast<double>(sample) * static_cast<double>(sample) / static_cast<double>(expected.size());
    }
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t n = 0; n < found.size(); ++n) {
        EXPECT_NEAR(found[n], expected[n], 1e-5 * std::sqrt(power)) << n;
    }
}

}  // namespace
}  // namespace haptoflow::skeleton::testing
