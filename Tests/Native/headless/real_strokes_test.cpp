#include "headless/contact_tracker.hpp"
#include "headless/tip_path.hpp"

#include "test_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <glm/matrix.hpp>
#include <map>
#include <sstream>
#include <string>
#include <utility>

namespace haptoflow::headless {
namespace {

using Strokes = std::map<std::string, std::vector<TipSample>>;

std::filesystem::path strokesPath() {
    return std::filesystem::path(HAPTOFLOW_TEST_GOLDEN_DIR) / "../../../shared/strokes/vr-pen-on-surface/strokes.csv";
}

Strokes readStrokes() {
    Strokes strokes;
    std::ifstream file(strokesPath());
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) {
        std::istringstream cells(line);
        std::string name;
        std::getline(cells, name, ',');
        std::array<double, 4> values{};
        for (double& value : values) {
            std::string cell;
            std::getline(cells, cell, ',');
            value = std::stod(cell);
        }
        strokes[name].push_back({values[0], {values[1], values[2], values[3]}, std::nullopt, std::nullopt});
    }
    return strokes;
}

double medianOf(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Height of the table over the x-y plane, z = a + b x + c y, by iteratively re-weighted least squares, so that lifted
/// parts of a stroke do not tilt it.
glm::dvec3 fitTable(const std::vector<TipSample>& samples) {
    glm::dvec3 plane(0.0);
    for (int round = 0; round < 20; ++round) {
        glm::dmat3 normal(0.0);
        glm::dvec3 right(0.0);
        for (const TipSample& sample : samples) {
            const glm::dvec3 row(1.0, sample.positionMetres.x, sample.positionMetres.y);
            const double residual = sample.positionMetres.z - glm::dot(plane, row);
            const double weight = round == 0 ? 1.0 : 1.0 / std::max(std::abs(residual), 1e-4);
            normal += weight * glm::outerProduct(row, row);
            right += weight * sample.positionMetres.z * row;
        }
        plane = glm::inverse(normal) * right;
    }
    return plane;
}

glm::dquat turnedFromUp(const glm::dvec3& normal) {
    const glm::dvec3 up(0.0, 1.0, 0.0);
    return glm::normalize(glm::dquat(1.0 + glm::dot(up, normal), glm::cross(up, normal)));
}

/// Reference of the speed along the table by another method: the tracker measures steadily at 60 Hz, and the time
/// stamps are those at which an app received the measurement. Therefore the distinct positions are distributed evenly
/// over the stroke and differentiated over two measurements. It uses later samples, which a live estimate cannot.
class EvenlyTickedReference {
public:
    EvenlyTickedReference(const std::vector<TipSample>& samples, const glm::dvec3& normal) : normal_(normal) {
        for (const TipSample& sample : samples) {
            if (ticks_.empty() || ticks_.back() != sample.positionMetres) {
                ticks_.push_back(sample.positionMetres);
                lastSeconds_ = sample.timeSeconds;
            }
        }
        firstSeconds_ = samples.front().timeSeconds;
        tickSeconds_ = (lastSeconds_ - firstSeconds_) / static_cast<double>(ticks_.size() - 1);
    }

    [[nodiscard]] double speedAt(double timeSeconds) const {
        const double tick = std::round((timeSeconds - firstSeconds_) / tickSeconds_);
        const double inside = std::clamp(tick, 1.0, static_cast<double>(ticks_.size() - 2));
        const auto index = static_cast<std::size_t>(inside);
        const glm::dvec3 step = ticks_[index + 1] - ticks_[index - 1];
        return glm::length(step - normal_ * glm::dot(normal_, step)) / (2.0 * tickSeconds_);
    }

private:
    glm::dvec3 normal_;
    std::vector<glm::dvec3> ticks_;
    double firstSeconds_ = 0.0;
    double lastSeconds_ = 0.0;
    double tickSeconds_ = 0.0;
};

TEST(RealStrokesTest, SpeedsOfRealStrokesAreWithinTenPercentOfANonCausalReference) {
    if (!std::filesystem::exists(strokesPath())) {
        GTEST_SKIP() << strokesPath() << " is missing: the repository does not contain real strokes";
    }
    // Half a window, and the age of a repeated position.
    const double lagSeconds = 0.020;
    // Pens rest at the ends of their strokes, where a relative error is meaningless.
    const double movingMps = 0.05;
    const Strokes strokes = readStrokes();
    ASSERT_EQ(strokes.size(), 20U);
    for (const auto& [name, samples] : strokes) {
        SCOPED_TRACE(name);
        const glm::dvec3 plane = fitTable(samples);
        const glm::dvec3 normal = glm::normalize(glm::dvec3(-plane.y, -plane.z, 1.0));
        SceneSurface table = testing::surfaceOf(Plane{});
        table.pose = {{0.0, 0.0, plane.x}, turnedFromUp(normal)};
        // With a tip of 5 mm around the pen's tracked point, a few millimetres of tracking error do not end the touch.
        ContactTracker tracker(testing::sceneOf({table}, 0.005));
        const EvenlyTickedReference reference(samples, normal);

        std::vector<double> speeds;
        std::vector<double> references;
        std::vector<double> errors;
        for (const TipSample& sample : samples) {
            const ContactReading reading = tracker.update(sample);
            ASSERT_TRUE(testing::isSane(reading));
            EXPECT_LT(testing::speedOf(reading), 3.0);
            const double expected = reference.speedAt(sample.timeSeconds - lagSeconds);
            const bool settled = sample.timeSeconds > samples.front().timeSeconds + 0.06;
            if (settled && reading.touching && expected > movingMps) {
                speeds.push_back(testing::speedOf(reading));
                references.push_back(expected);
                errors.push_back(std::abs(speeds.back() - expected) / expected);
            }
        }
        ASSERT_GT(speeds.size(), 15U);
        EXPECT_NEAR(medianOf(speeds), medianOf(references), 0.1 * medianOf(references));
        EXPECT_LT(medianOf(errors), 0.07);
        EXPECT_EQ(tracker.statistics().teleports, 0U);
    }
}

TEST(RealStrokesTest, AStrokeOverFlushTilesHasNoEventsAt30MmAndFewAt15Mm) {
    if (!std::filesystem::exists(strokesPath())) {
        GTEST_SKIP() << strokesPath() << " is missing: the repository does not contain real strokes";
    }
    std::size_t crossings = 0;
    std::size_t events = 0;
    for (const auto& [name, samples] : readStrokes()) {
        const glm::dvec3 plane = fitTable(samples);
        const glm::dvec3 normal = glm::normalize(glm::dvec3(-plane.y, -plane.z, 1.0));
        const glm::dquat turn = turnedFromUp(normal);
        glm::dvec3 middle(0.0);
        for (const TipSample& sample : samples) {
            middle += sample.positionMetres / static_cast<double>(samples.size());
        }
        middle.z = plane.x + plane.y * middle.x + plane.z * middle.y;
        // The recordings begin with the pen pressed down: an approach from above makes the tip enter a tile through its
        // top.
        std::vector<TipSample> stroke;
        for (int frame = 0; frame < 30; ++frame) {
            TipSample sample = samples.front();
            sample.timeSeconds -= (30 - frame) / 90.0;
            sample.positionMetres += normal * (0.001 * (30 - frame));
            stroke.push_back(sample);
        }
        stroke.insert(stroke.end(), samples.begin(), samples.end());
        for (const double tileMetres : {0.03, 0.015}) {
            std::vector<SceneSurface> tiles;
            const int half = static_cast<int>(0.5 / tileMetres);
            for (int row = -half; row <= half; ++row) {
                for (int column = -half; column <= half; ++column) {
                    SceneSurface tile = testing::surfaceOf(Box{{tileMetres, 0.05, tileMetres}});
                    tile.pose = {middle + turn * glm::dvec3(row * tileMetres, -0.025, column * tileMetres), turn};
                    tiles.push_back(std::move(tile));
                }
            }
            for (const double tipRadius : {0.001, 0.005}) {
                ContactTracker tracker(testing::sceneOf(tiles, tipRadius));
                ContactReading last;
                for (const TipSample& sample : stroke) {
                    const ContactReading reading = tracker.update(sample);
                    crossings += reading.touching && last.touching && reading.surfaceIndex != last.surfaceIndex ? 1 : 0;
                    last = reading;
                }
                events += last.landingCounter + last.edgeCounter;
                if (tileMetres > 0.02) {
                    EXPECT_EQ(last.landingCounter, 0U) << name << ", tip of " << tipRadius;
                    EXPECT_EQ(last.edgeCounter, 0U) << name << ", tip of " << tipRadius;
                }
            }
        }
    }
    // If a fast pen jumps over a tile of 15 mm at a depth of a quarter of it, the tile's sides are as near as its top.
    EXPECT_GT(crossings, 3000U);
    EXPECT_LE(events, crossings / 1000);
}

}  // namespace
}  // namespace haptoflow::headless
