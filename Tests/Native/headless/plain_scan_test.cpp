#include "plain_scan.hpp"

#include "random_scenes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <set>
#include <variant>

namespace haptoflow::headless {
namespace {

using testing::PlainScan;
using testing::RandomScenes;

/// The bits of a reading, so that a comparison distinguishes 0 and -0.
std::array<std::uint64_t, 15> bitsOf(const ContactReading& reading) {
    const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
    const glm::dvec3& point = reading.pointMetres;
    const glm::dvec3& normal = reading.normal;
    return {bits(reading.timeSeconds),
            reading.touching ? 1U : 0U,
            reading.touchCounter,
            static_cast<std::uint64_t>(reading.surfaceIndex),
            bits(point.x),
            bits(point.y),
            bits(point.z),
            bits(normal.x),
            bits(normal.y),
            bits(normal.z),
            bits(reading.penetrationMetres),
            bits(reading.tangentialVelocityMps.x),
            bits(reading.tangentialVelocityMps.y),
            bits(reading.approachSpeedMps),
            bits(reading.forceNewtons)};
}

/// Plays the stroke through both implementations and returns the touched surfaces.
std::set<int> expectSameReadings(const Scene& scene, const std::vector<TipSample>& stroke, PlainScan& scan) {
    ContactTracker tracker(scene);
    std::set<int> touched;
    ContactReading touchDown;
    for (const TipSample& sample : stroke) {
        const ContactReading reading = tracker.update(sample);
        ContactReading plain = scan.update(sample);
        if (reading.touchCounter != touchDown.touchCounter) {
            touchDown = reading;
        } else if (reading.touching && reading.landingCounter != touchDown.landingCounter) {
            // The plain scan does not implement landings within a touch.
            plain.approachSpeedMps = reading.approachSpeedMps;
        }
        EXPECT_EQ(bitsOf(reading), bitsOf(plain)) << "at " << sample.timeSeconds << " s";
        if (::testing::Test::HasFailure()) {
            break;
        }
        touched.insert(reading.surfaceIndex);
    }
    touched.erase(-1);
    return touched;
}

TEST(PlainScanTest, ReadingsEqualThoseOfAPlainScanToTheLastBit) {
    for (const auto& [count, scenes] : {std::pair(10, 40), std::pair(100, 8), std::pair(1000, 3)}) {
        std::size_t touchedSurfaces = 0;
        int planes = 0;
        int movers = 0;
        int ties = 0;
        for (int seed = 0; seed < scenes; ++seed) {
            const double offCentreMetres = seed % 2 == 0 ? 0.0 : 1e5;
            RandomScenes random(static_cast<std::uint32_t>(seed), static_cast<std::size_t>(count),
                                glm::dvec3(offCentreMetres));
            const Scene scene = random.scene();
            PlainScan scan(scene);
            const std::set<int> touched = expectSameReadings(scene, random.strokeOver(scene, 2000), scan);
            ASSERT_FALSE(HasFailure()) << count << " surfaces, seed " << seed;
            touchedSurfaces += touched.size();
            ties += scan.ties();
            for (const int index : touched) {
                const SceneSurface& surface = scene.surfaces[static_cast<std::size_t>(index)];
                planes += std::holds_alternative<Plane>(surface.shape) ? 1 : 0;
                movers += surface.motion ? 1 : 0;
            }
        }
        EXPECT_GT(touchedSurfaces, 100U) << count << " surfaces";
        EXPECT_GT(planes, 2) << count << " surfaces";
        EXPECT_GT(movers, 5) << count << " surfaces";
        EXPECT_GT(ties, 100) << count << " surfaces";
    }
}

}  // namespace
}  // namespace haptoflow::headless
