#include "effects/relief.hpp"
#include "effects/carrier_rendering.hpp"

#include "effects/relief_normals.hpp"
#include "support/counting_new.hpp"
#include "support/wave_measures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace haptoflow::effects::relief_tests {
namespace {

using ::testing::HasSubstr;

constexpr double rateHz = 48000.0;
constexpr double wholeTurn = 2.0 * std::numbers::pi;

/// A map of 64 mm x 64 mm, tiled, of heights given in metres.
ReliefMap mapOf(const std::function<double(double x, double y)>& heightMetres, double tipRadiusMetres = 0.0,
                std::uint32_t texels = 512, double sizeMetres = 0.064) {
    std::vector<float> heights;
    for (std::uint32_t row = 0; row < texels; ++row) {
        for (std::uint32_t column = 0; column < texels; ++column) {
            const double texelMetres = sizeMetres / texels;
            heights.push_back(
                static_cast<float>(heightMetres((column + 0.5) * texelMetres, (row + 0.5) * texelMetres)));
        }
    }
    return {heights,
            {.columns = texels,
             .rows = texels,
             .sizeMetres = {sizeMetres, sizeMetres},
             .depthMetres = 0.02,
             .tipRadiusMetres = tipRadiusMetres,
             .isTiled = true}};
}

/// A sine of amplitude 0.1 mm, in whole waves along both sides of the map.
ReliefMap sineMap(double wavesAcross, double wavesDown) {
    return mapOf([=](double x, double y) {
        return 1e-4 * (1.0 + std::cos(wholeTurn * (wavesAcross * x + wavesDown * y) / 0.064));
    });
}

struct Stroke {
    const ReliefMap* map = nullptr;
    std::array<double, 2> startMetres{};
    std::array<double, 2> velocityMps{};
    double newtons = 2.0;
    double largestMps2 = 1e5;
    double stateHz = 72.0;
    double outputHz = rateHz;
    double scale = 1.0;
    double turnRadians = 0.0;
    double stiffness = ReliefContact{}.stiffnessNewtonsPerMetre;
};

/// What a straight stroke adds, told by states of exact places.
std::vector<float> played(const Stroke& stroke, double seconds, Relief* relief = nullptr) {
    Relief own(stroke.outputHz);
    relief = relief != nullptr ? relief : &own;
    std::vector<float> wave(static_cast<std::size_t>(seconds * stroke.outputHz));
    const auto samples = static_cast<std::size_t>(stroke.outputHz / stroke.stateHz);
    for (std::size_t first = 0; first < wave.size(); first += samples) {
        const double now = static_cast<double>(first) / stroke.outputHz;
        ReliefContact contact{.map = stroke.map,
                              .forceNewtons = stroke.newtons,
                              .largestMps2 = stroke.largestMps2,
                              .stiffnessNewtonsPerMetre = stroke.stiffness};
        contact.arrivalSeconds = static_cast<double>(samples) / stroke.outputHz;
        for (std::size_t side = 0; side < 2; ++side) {
            const double sizeMetres = stroke.map->description().sizeMetres[side];
            contact.place[side] = (stroke.startMetres[side] + stroke.velocityMps[side] * now) / sizeMetres;
        }
        contact.speedMps = std::hypot(stroke.velocityMps[0], stroke.velocityMps[1]);
        relief->follow(contact);
        const auto piece = std::span(wave).subspan(first, std::min(samples, wave.size() - first));
        for (std::size_t done = 0; done < piece.size(); done += 64) {
            relief->process(piece.subspan(done, std::min<std::size_t>(64, piece.size() - done)));
        }
    }
    return wave;
}

using haptoflow::testing::rms;

std::span<const float> settled(const std::vector<float>& wave) {
    return std::span(wave).subspan(wave.size() / 4);
}
double decibels(double ratio) {
    return 20.0 * std::log10(ratio);
}

double amplitudeAt(std::span<const float> wave, double hz) {
    return haptoflow::testing::amplitudeAt(wave, hz, rateHz);
}

/// What the contact makes of a sine's acceleration, with the band's lower limit.
double transfer(double hz, double k = ReliefContact{}.stiffnessNewtonsPerMetre) {
    const double w = wholeTurn * hz;
    const double m = Relief::tipKilograms;
    const double c = 2.0 * Relief::dampingRatio * std::sqrt(k * m);
    const double ratio = hz / 10.0;
    return std::abs(std::complex<double>(k, c * w) / std::complex<double>(k - m * w * w, c * w)) * ratio * ratio /
           std::sqrt(1.0 + std::pow(ratio, 4.0));
}

TEST(ReliefTest, ASineGivesTheAccelerationOfItsFormulaAtEveryAngleAndSpeed) {
    for (const auto& [across, down] : {std::pair{32.0, 0.0}, std::pair{0.0, 16.0}, std::pair{24.0, 10.0}}) {
        const ReliefMap map = sineMap(across, down);
        const double wavesPerMetre = std::hypot(across, down) / 0.064;
        for (const double hz : {12.0, 20.0, 30.0}) {
            for (const double turn : {0.0, 0.5, -1.1}) {
                const double angle = std::atan2(down, across) + turn;
                const double speed = hz / wavesPerMetre / std::cos(turn);
                const std::vector<float> wave = played(
                    {.map = &map, .velocityMps = {speed * std::cos(angle), speed * std::sin(angle)}, .newtons = 5.0},
                    2.0);
                const double found = amplitudeAt(std::span(wave).last(48000), hz);
                EXPECT_NEAR(decibels(found / (1e-4 * std::pow(wholeTurn * hz, 2.0) * transfer(hz))), 0.0, 0.5)
                    << across << " x " << down << " at " << hz << " Hz, turned by " << turn;
            }
        }
    }
}

TEST(ReliefTest, TheMaterialsStiffnessSetsTheResonance) {
    const ReliefMap map = sineMap(32.0, 0.0);
    const double hz = 40.0;
    for (const double stiffness : {400.0, 1200.0, 5000.0}) {
        const std::vector<float> wave =
            played({.map = &map, .velocityMps = {0.002 * hz, 0.0}, .newtons = 12.0, .stiffness = stiffness}, 2.0);
        const double found = amplitudeAt(std::span(wave).last(48000), hz);
        const double expected = 1e-4 * std::pow(wholeTurn * hz, 2.0) * transfer(hz, stiffness);
        EXPECT_NEAR(decibels(found / expected), 0.0, 0.5) << stiffness;
    }
}

TEST(ReliefTest, AnotherMaterialUnderTheTipMakesNoStep) {
    const ReliefMap map = sineMap(32.0, 0.0);
    const auto playedWith = [&](auto&& stiffnessAt) {
        Relief relief(rateHz);
        std::vector<float> wave;
        for (int state = 0; state < 200; ++state) {
            ReliefContact contact{.map = &map, .speedMps = 0.05, .forceNewtons = 2.0, .largestMps2 = 200.0};
            contact.place = {0.05 * 0.01 * state / 0.064, 0.5};
            contact.arrivalSeconds = 0.01;
            contact.stiffnessNewtonsPerMetre = stiffnessAt(state);
            relief.follow(contact);
            std::vector<float> piece(480);
            relief.process(piece);
            wave.insert(wave.end(), piece.begin(), piece.end());
        }
        return haptoflow::testing::largestStep(std::span(wave).subspan(24000));
    };
    const float hard = playedWith([](int) { return 5000.0; });
    // Wood and glass in turn; without care the spring's 2 N would become 8 N, 400 m/s^2 on 15 g.
    const float inTurn = playedWith([](int state) { return state % 10 < 5 ? 1200.0 : 5000.0; });
    EXPECT_LT(inTurn, 4.0F * hard);
    // Numbers of no use count as the softest.
    EXPECT_LT(playedWith([](int state) { return state % 2 == 0 ? std::nan("") : -1.0; }), 2.0F * hard);
}

/// The amplitudes that a motor of one frequency gets for a wave at 48 kHz, one for each frame.
std::vector<WaveFrame> motorFrames(const std::vector<float>& wave, double frameSeconds) {
    return framesOf(decimated(wave, 24),
                    {.frameSeconds = frameSeconds, .minFrequencyHz = 160.0, .maxFrequencyHz = 160.0});
}

TEST(ReliefTest, AMotorTellsGroovesApartThatATipCrossesEveryTenthOfASecond) {
    // Four grooves of 4 mm in the tile, 16 mm apart.
    const ReliefMap map = mapOf([](double x, double) { return std::fmod(x, 0.016) < 0.004 ? 0.0 : 0.0005; }, 0.0005);
    const std::vector<float> wave = played({.map = &map, .velocityMps = {0.16, 0.0}}, 2.0);
    const std::vector<WaveFrame> frames = motorFrames(wave, 0.014);
    // From 1 s on, each tenth of a second has a strong frame and one that is 6 dB weaker at least.
    for (std::size_t tenth = 10; tenth < 19; ++tenth) {
        float strongest = 0.0F;
        float weakest = 1e9F;
        for (const WaveFrame& frame : frames) {
            const double seconds = static_cast<double>(frame.firstSample) / WaveFeatures::sampleRateHz;
            if (seconds >= 0.1 * static_cast<double>(tenth) && seconds < 0.1 * static_cast<double>(tenth + 1)) {
                strongest = std::max(strongest, frame.amplitudeMps2);
                weakest = std::min(weakest, frame.amplitudeMps2);
            }
        }
        EXPECT_GT(strongest, 2.0F * weakest) << tenth;
        EXPECT_GT(strongest, 1.0F) << tenth;
    }
}

TEST(ReliefTest, ForAMotorRibsAreOneSteadyAmplitudeThatGrowsWithTheSpeedUpToTheResonance) {
    const ReliefMap map = sineMap(32.0, 0.0);
    float before = 0.0F;
    for (const double speed : {0.05, 0.07, 0.1}) {
        const std::vector<WaveFrame> frames =
            motorFrames(played({.map = &map, .velocityMps = {speed, 0.0}}, 1.5), 0.014);
        const auto settledFrames = std::span(frames).subspan(frames.size() / 2, frames.size() / 3);
        const auto [weakest, strongest] = std::ranges::minmax_element(settledFrames, {}, &WaveFrame::amplitudeMps2);
        EXPECT_LT(strongest->amplitudeMps2, 1.2F * weakest->amplitudeMps2) << speed;
        EXPECT_GT(weakest->amplitudeMps2, 1.2F * before) << speed;
        before = strongest->amplitudeMps2;
    }
}

TEST(ReliefTest, AtEveryOutputRateTheLevelIsTheSame) {
    const ReliefMap map = sineMap(32.0, 0.0);
    const double expected = rms(settled(played({.map = &map, .velocityMps = {0.1, 0.0}}, 2.0)));
    for (const double otherHz : {8000.0, 24000.0, 44100.0, 96000.0, 192000.0}) {
        const std::vector<float> wave = played({.map = &map, .velocityMps = {0.1, 0.0}, .outputHz = otherHz}, 2.0);
        EXPECT_NEAR(decibels(rms(settled(wave)) / expected), 0.0, 0.3) << otherHz;
    }
}

/// A step up of that height, and a gentle slope back.
ReliefMap stepMap(double heightMetres) {
    return mapOf([=](double x, double) { return x < 0.016 ? 0.0 : heightMetres * (0.064 - x) / 0.048; }, 0.0005);
}

double largest(std::span<const float> wave) {
    return static_cast<double>(haptoflow::testing::peak(wave));
}

TEST(ReliefTest, AStepIsFeltMoreStronglyWhereItIsHigherAndWhereTheTipIsFaster) {
    double before = 0.0;
    for (const double height : {0.00005, 0.0001, 0.0003, 0.001}) {
        const ReliefMap map = stepMap(height);
        const double peak = largest(played({.map = &map, .velocityMps = {0.1, 0.0}}, 0.6));
        EXPECT_GT(peak, 1.15 * before) << height;
        before = peak;
    }
    const ReliefMap map = stepMap(0.0003);
    before = 0.0;
    for (const double speed : {0.03, 0.1, 0.3, 1.0}) {
        const double peak = largest(played({.map = &map, .velocityMps = {speed, 0.0}}, 0.06 / speed));
        EXPECT_GT(peak, 1.5 * before) << speed;
        before = peak;
    }
}

TEST(ReliefTest, AStepIsAsStrongInAFinerMap) {
    const auto step = [](double x, double) { return x < 0.016 ? 0.0 : 0.0003 * (0.064 - x) / 0.048; };
    const ReliefMap coarse = mapOf(step, 0.0005, 512);
    const ReliefMap fine = mapOf(step, 0.0005, 1000);
    const auto peakOf = [](const ReliefMap& map) {
        return largest(played({.map = &map, .velocityMps = {0.1, 0.0}}, 0.6));
    };
    EXPECT_NEAR(decibels(peakOf(fine) / peakOf(coarse)), 0.0, 2.0);
}

ReliefMap noiseMap(double tipRadiusMetres = 0.0005) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0.0, 2e-4);
    return mapOf([&](double, double) { return uniform(random); }, tipRadiusMetres);
}

double correlation(std::span<const float> one, std::span<const float> other) {
    double product = 0.0;
    for (std::size_t n = 0; n < one.size(); ++n) {
        product += static_cast<double>(one[n]) * static_cast<double>(other[n]);
    }
    return product / static_cast<double>(one.size()) / (rms(one) * rms(other));
}

TEST(ReliefTest, ASecondPassOverAPlaceIsTheFirstAgainInBothDirectionsAndAtEveryStateRate) {
    const ReliefMap map = noiseMap();
    for (const double direction : {1.0, -1.0}) {
        Stroke stroke{.map = &map, .startMetres = {0.03, 0.03}, .velocityMps = {direction * 0.08, direction * 0.03}};
        const std::vector<float> first = played(stroke, 0.5);
        stroke.stateHz = 120.0;
        const std::vector<float> second = played(stroke, 0.5);
        // Each is a state late.
        constexpr std::size_t earlier = 48000 / 72 - 48000 / 120;
        const auto last = std::span(second).first(second.size() - earlier).last(20000);
        EXPECT_GT(correlation(std::span(first).last(20000), last), 0.99);
    }
}

TEST(ReliefTest, APlaceThatIsToldInAnotherTileIsTheSame) {
    // As another triangle of a mesh may tell it.
    const ReliefMap map = noiseMap();
    const auto passed = [&map](std::array<double, 2> tile) {
        Relief relief(rateHz);
        ReliefContact contact{
            .map = &map, .place = {0.2, 0.4}, .speedMps = 0.1, .forceNewtons = 1.0, .largestMps2 = 1e5};
        relief.follow(contact);
        contact.place = {0.35 + tile[0], 0.44 + tile[1]};
        contact.arrivalSeconds = 0.1;
        relief.follow(contact);
        std::vector<float> wave(4800);
        relief.process(wave);
        return wave;
    };
    const std::vector<float> wave = passed({0.0, 0.0});
    const std::vector<float> again = passed({-3.0, 7.0});
    EXPECT_GT(rms(wave), 1.0);
    for (std::size_t n = 0; n < wave.size(); ++n) {
        ASSERT_NEAR(wave[n], again[n], 1e-3F) << n;
    }
}

TEST(ReliefTest, ATileThatIsShorterThanTheWayBetweenTwoStatesIsFeltAtItsRate) {
    // One wave of 2 mm; at 72 states a second each is 1.4 mm from the one before.
    const ReliefMap map =
        mapOf([](double x, double) { return 1e-4 * (1.0 + std::cos(wholeTurn * x / 0.002)); }, 0.0, 32, 0.002);
    Stroke stroke{.map = &map, .velocityMps = {0.1, 0.0}};
    const std::vector<float> wave = played(stroke, 2.0);
    EXPECT_GT(amplitudeAt(std::span(wave).last(48000), 50.0), 9.9);
    stroke.velocityMps = {-0.1, 0.0};
    const std::vector<float> back = played(stroke, 2.0);
    EXPECT_NEAR(decibels(rms(settled(back)) / rms(settled(wave))), 0.0, 0.5);
}

TEST(ReliefTest, NothingOfItIsAboveAKilohertzAtAnySpeed) {
    const ReliefMap map = noiseMap();
    for (const double speed : {0.05, 0.3, 1.0, 5.0}) {
        const std::vector<float> wave = played({.map = &map, .velocityMps = {speed, 0.37 * speed}}, 1.0);
        const auto part = std::span(wave).last(32768);
        double above = 0.0;
        double below = 0.0;
        for (int hz = 20; hz < 12000; hz += 41) {
            const double amplitude = amplitudeAt(part, static_cast<double>(hz));
            (hz > 1500 ? above : below) += amplitude * amplitude;
        }
        EXPECT_LT(10.0 * std::log10(above / below), -20.0) << speed;
    }
}

TEST(ReliefTest, BesideASmallLimitALargeReliefKeepsToItAndASmallOneIsUnchanged) {
    const ReliefMap deep = stepMap(0.001);
    EXPECT_LE(largest(played({.map = &deep, .velocityMps = {0.5, 0.0}, .largestMps2 = 20.0}, 0.4)), 20.0);
    const ReliefMap gentle = sineMap(8.0, 0.0);
    const double free = rms(settled(played({.map = &gentle, .velocityMps = {0.1, 0.0}}, 1.0)));
    const double kept = rms(settled(played({.map = &gentle, .velocityMps = {0.1, 0.0}, .largestMps2 = 20.0}, 1.0)));
    EXPECT_NEAR(decibels(kept / free), 0.0, 0.2);
}

TEST(ReliefTest, ATipThatRestsIsIdleAndOneThatMovesOnIsNot) {
    const ReliefMap map = sineMap(32.0, 0.0);
    Relief relief(rateHz);
    EXPECT_TRUE(relief.isIdle());
    (void)played({.map = &map, .velocityMps = {0.1, 0.0}}, 0.5, &relief);
    EXPECT_FALSE(relief.isIdle());
    (void)played({.map = &map, .startMetres = {0.05, 0.0}}, 0.5, &relief);
    EXPECT_TRUE(relief.isIdle());
    (void)played({.map = &map, .startMetres = {0.05, 0.0}}, 0.1, &relief);
    EXPECT_TRUE(relief.isIdle()) << "states of a rest do not wake it";
    (void)played({.map = &map, .startMetres = {0.05, 0.0}, .velocityMps = {0.1, 0.0}}, 0.1, &relief);
    EXPECT_FALSE(relief.isIdle());
}

TEST(ReliefTest, LiftedOffItIsSilentWithinFiveMillisecondsWithoutAStep) {
    const ReliefMap map = noiseMap();
    Relief relief(rateHz);
    const std::vector<float> before = played({.map = &map, .velocityMps = {0.2, 0.0}}, 0.3, &relief);
    relief.follow({});
    std::vector<float> after(240 + 64);
    relief.process(after);
    EXPECT_TRUE(relief.isIdle());
    EXPECT_EQ(largest(std::span(after).last(64)), 0.0);
    EXPECT_LE(std::abs(after[0] - before.back()), haptoflow::testing::largestStep(before));
}

TEST(ReliefTest, AMapThatIsExchangedAndAPlaceThatJumpsMakeNoStep) {
    const ReliefMap map = noiseMap();
    const ReliefMap other = stepMap(0.001);
    Relief relief(rateHz);
    std::vector<float> wave;
    for (int part = 0; part < 12; ++part) {
        const std::vector<float> next = played(
            {.map = part % 2 == 0 ? &map : &other, .startMetres = {0.7 * part, 0.01}, .velocityMps = {0.1, 0.02}}, 0.02,
            &relief);
        wave.insert(wave.end(), next.begin(), next.end());
    }
    const std::vector<float> usual = played({.map = &map, .velocityMps = {0.1, 0.02}}, 0.3);
    EXPECT_LT(largest(wave), 3.0 * largest(usual) + 5.0);
}

TEST(ReliefTest, EverythingAtOnceForTenMinutesStaysBoundedAndAllocatesNothing) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> uniform;
    std::vector<ReliefMap> maps;
    maps.push_back(noiseMap());
    maps.push_back(mapOf([&](double, double) { return uniform(random) < 0.01 ? 0.02 : 0.0; }, 0.0005, 64));
    maps.push_back(mapOf([](double, double) { return 0.01; }, 0.0, 1));
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double outputHz : {8000.0, 48000.0}) {
        Relief relief(outputHz);
        std::array<float, 64> block{};
        float most = 0.0F;
        const std::size_t allocations = haptoflow::testing::allocationCount();
        const int states = static_cast<int>(600.0 * outputHz) / static_cast<int>(block.size());
        for (int state = 0; state < states; ++state) {
            const auto any = [&](double size) { return (2.0 * uniform(random) - 1.0) * size; };
            ReliefContact contact{.map = uniform(random) < 0.05 ? nullptr : &maps[random() % maps.size()],
                                  .place = {any(5.0), any(5.0)},
                                  .arrivalSeconds = any(0.05),
                                  .speedMps = std::abs(any(25.0)),
                                  .forceNewtons = any(50.0),
                                  .largestMps2 = uniform(random) < 0.5 ? 1e6 : 30.0};
            if (uniform(random) < 0.1) {
                contact.place[0] = contact.arrivalSeconds = contact.speedMps = contact.forceNewtons = nan;
                contact.largestMps2 = uniform(random) < 0.5 ? nan : 30.0;
            }
            relief.follow(contact);
            block.fill(0.0F);
            relief.process(block);
            for (const float sample : block) {
                ASSERT_TRUE(std::isfinite(sample));
                most = std::max(most, std::abs(sample));
            }
        }
        EXPECT_LT(most, 1e5F);
        EXPECT_EQ(haptoflow::testing::allocationCount(), allocations);
        relief.follow({});
        for (int n = 0; n < 30; ++n) {
            block.fill(0.0F);
            relief.process(block);
        }
        EXPECT_EQ(block.back(), 0.0F);
        EXPECT_TRUE(relief.isIdle());
    }
}

TEST(ReliefMapTest, HeightsBetweenTexelsAreThoseOfASmoothSurfaceAndRimsMeetWhereItIsTiled) {
    const ReliefMap map = sineMap(16.0, 8.0);
    for (const double u : {0.0, 0.123, 0.777, 0.99999, -0.25, 3.1}) {
        for (const double v : {0.0, 0.4567, 1.0}) {
            const double expected = 1e-4 * (1.0 + std::cos(wholeTurn * (16.0 * u + 8.0 * v)));
            EXPECT_NEAR(map.heightMetres({u, v}), expected, 2e-7) << u << ", " << v;
        }
    }
}

TEST(ReliefMapTest, AGrooveNarrowerThanTheTipIsShallow) {
    const auto groove = [](double x, double) { return std::abs(x - 0.032) < 0.0005 ? 0.0 : 0.001; };
    const ReliefMap point = mapOf(groove, 0.0);
    const ReliefMap ball = mapOf(groove, 0.002);
    EXPECT_LT(point.heightMetres({0.5, 0.5}), 0.0002);
    // The sagitta of the ball over the groove's width.
    EXPECT_NEAR(ball.heightMetres({0.5, 0.5}), 0.001 - 0.0005 * 0.0005 / (2.0 * 0.002), 2e-5);
}

TEST(ReliefMapTest, AverageHeightsAreKeptInEveryResolutionOfAnOddMapAndOfANarrowOne) {
    for (const auto& [columns, rows] : {std::pair{53U, 37U}, std::pair{4U, 64U}, std::pair{64U, 4U}}) {
        std::vector<float> heights;
        for (std::uint32_t row = 0; row < rows; ++row) {
            for (std::uint32_t column = 0; column < columns; ++column) {
                heights.push_back(0.001F * static_cast<float>((row * 7 + column * 3) % 11));
            }
        }
        const ReliefMap map(
            heights,
            {.columns = columns, .rows = rows, .sizeMetres = {0.001 * columns, 0.001 * rows}, .depthMetres = 0.02});
        double mean = 0.0;
        for (const float height : heights) {
            mean += static_cast<double>(height) / static_cast<double>(heights.size());
        }
        EXPECT_NEAR(map.heightMetres({0.5, 0.5}, map.resolutionFor(1e9)), mean, 1e-4) << columns << " x " << rows;
    }
}

TEST(ReliefMapTest, AMapThatCannotBeFeltIsRefusedWithTheReason) {
    const auto messageOf = [](std::vector<float> heights, ReliefDescription description) -> std::string {
        try {
            (void)ReliefMap(heights, description);
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "";
    };
    const ReliefDescription good{.columns = 2, .rows = 1, .sizeMetres = {1.0, 1.0}, .depthMetres = 0.001};
    EXPECT_EQ(messageOf({0.0F, 0.0F}, good), "");
    const auto changed = [&good](auto change) {
        ReliefDescription description = good;
        change(description);
        return description;
    };
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(messageOf({0.0F}, good), HasSubstr("a height for each"));
    EXPECT_THAT(messageOf({0.0F, nan}, good), HasSubstr("finite"));
    const auto refusal = [&](auto change) { return messageOf({0.0F, 0.0F}, changed(change)); };
    EXPECT_THAT(refusal([](auto& d) { d.columns = 0; }), HasSubstr("texels"));
    EXPECT_THAT(refusal([](auto& d) { d.columns = d.rows = 1U << 20U; }), HasSubstr("texels"));
    EXPECT_THAT(refusal([](auto& d) { d.sizeMetres[1] = 0.0; }), HasSubstr("size"));
    EXPECT_THAT(refusal([](auto& d) { d.depthMetres = nan; }), HasSubstr("depth"));
    EXPECT_THAT(refusal([](auto& d) { d.tipRadiusMetres = -1.0; }), HasSubstr("radius"));
}

/// Normals by central differences, as image editors make them.
std::vector<float> normalsOf(const std::vector<float>& heights, int columns, int rows, double texelMetres,
                             bool isTiled) {
    const auto at = [&](int column, int row) {
        const auto in = [isTiled](int index, int count) {
            return isTiled ? (index + count) % count : std::clamp(index, 0, count - 1);
        };
        return heights[static_cast<std::size_t>(in(row, rows)) * static_cast<std::size_t>(columns) +
                       static_cast<std::size_t>(in(column, columns))];
    };
    std::vector<float> normals;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const auto step = static_cast<float>(2.0 * texelMetres);
            normals.push_back(-(at(column + 1, row) - at(column - 1, row)) / step);
            normals.push_back(-(at(column, row + 1) - at(column, row - 1)) / step);
            normals.push_back(1.0F);
        }
    }
    return normals;
}

TEST(ReliefNormalsTest, ANormalMapGivesTheHeightsItWasMadeFromWithinADecibel) {
    for (const auto& [columns, rows] : {std::pair{128, 64}, std::pair{100, 60}}) {
        for (const bool isTiled : {true, false}) {
            std::vector<float> heights;
            for (int row = 0; row < rows; ++row) {
                for (int column = 0; column < columns; ++column) {
                    const double x = wholeTurn * (column + 0.5) / columns;
                    const double y = wholeTurn * (row + 0.5) / rows;
                    heights.push_back(static_cast<float>(1e-3 * (1.0 + 0.5 * std::cos(3.0 * x + y) +
                                                                 0.3 * std::cos(5.0 * x - 4.0 * y + 1.0) +
                                                                 (isTiled ? 0.0 : 0.4 * std::cos(0.5 * x)))));
                }
            }
            const std::vector<float> found =
                heightsOfNormals(normalsOf(heights, columns, rows, 1e-3, isTiled), static_cast<std::uint32_t>(columns),
                                 static_cast<std::uint32_t>(rows), {1e-3 * columns, 1e-3 * rows}, isTiled);
            const auto centred = [](std::vector<float> values) {
                double mean = 0.0;
                for (const float value : values) {
                    mean += static_cast<double>(value) / static_cast<double>(values.size());
                }
                std::ranges::for_each(values, [mean](float& value) { value -= static_cast<float>(mean); });
                return values;
            };
            const std::vector<float> one = centred(heights);
            const std::vector<float> other = centred(found);
            EXPECT_NEAR(decibels(rms(other) / rms(one)), 0.0, 1.0) << columns << " x " << rows << ", tiled " << isTiled;
            EXPECT_GT(correlation(one, other), 0.99) << columns << " x " << rows << ", tiled " << isTiled;
            EXPECT_GE(*std::ranges::min_element(found), 0.0F);
        }
    }
}

TEST(ReliefNormalsTest, AFlatMapWithASlantedSeamAndNormalsWithoutLengthGivesFiniteHeights) {
    std::vector<float> normals(std::size_t{3} * 16 * 16, 0.0F);
    for (std::size_t texel = 0; texel < 128; ++texel) {
        normals[3 * texel] = 0.3F;
        normals[3 * texel + 2] = 1.0F;
    }
    for (const float height : heightsOfNormals(normals, 16, 16, {0.016, 0.016}, true)) {
        EXPECT_TRUE(std::isfinite(height));
    }
    EXPECT_THROW((void)heightsOfNormals(normals, 16, 15, {1.0, 1.0}, true), std::invalid_argument);
}

}  // namespace
}  // namespace haptoflow::effects::relief_tests
