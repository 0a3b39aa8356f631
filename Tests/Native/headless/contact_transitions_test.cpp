#include "headless/contact_transitions.hpp"

#include "headless/contact_tracker.hpp"
#include "test_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace haptoflow::headless {
namespace {

using testing::play;
using testing::sampledPath;
using testing::sceneOf;
using testing::surfaceOf;
using testing::turned;

constexpr double pi = std::numbers::pi;
constexpr double tipRadius = 0.001;

SceneSurface blockAt(const glm::dvec3& centre, const glm::dvec3& size = {0.1, 0.1, 0.1}) {
    return surfaceOf(Box{size}, {centre, {1.0, 0.0, 0.0, 0.0}});
}

/// Two plates left and right of x = 0 with their tops at y = 0 and y = `step`.
std::vector<SceneSurface> plates(double step) {
    return {blockAt({-0.5, -0.05, 0.0}, {1.0, 0.1, 1.0}), blockAt({0.5, -0.05 + step, 0.0}, {1.0, 0.1, 1.0})};
}

struct Events {
    std::uint32_t touches = 0;
    std::uint32_t landings = 0;
    std::uint32_t edges = 0;
    double height = 0.0;
    double approach = 0.0;
};

template <typename Path>
Events eventsOf(const Scene& scene, double seconds, double rateHz, Path&& path) {
    ContactTracker tracker(scene);
    Events events;
    for (const ContactReading& reading : play(tracker, sampledPath(seconds, rateHz, path))) {
        if (reading.landingCounter != events.landings) {
            events.approach = reading.approachSpeedMps;
        }
        events = {reading.touchCounter, reading.landingCounter, reading.edgeCounter, reading.edgeHeightMetres,
                  events.approach};
        EXPECT_TRUE(testing::isSane(reading));
    }
    return events;
}

/// Visits the speeds of hands and frame rates of headsets, with several phases of an event between two frames.
template <typename Visit>
void forEachStroke(Visit&& visit) {
    for (const double rateHz : {45.0, 72.0, 90.0, 120.0}) {
        for (const double speed : {0.05, 0.15, 0.5, 1.5}) {
            for (const double phase : {0.0, 0.13, 0.37, 0.51, 0.88}) {
                SCOPED_TRACE(std::to_string(speed) + " m/s, " + std::to_string(rateHz) + " Hz, phase " +
                             std::to_string(phase));
                visit(speed, rateHz, phase * speed / rateHz);
            }
        }
    }
}

TEST(ContactTransitionsTest, ASlideAgainstAWallIsOneLandingAtTheSpeedOfTheSlide) {
    const Scene scene = sceneOf({surfaceOf(Plane{}), blockAt({0.5, 0.0, 0.0}, {0.6, 1.0, 1.0})});
    forEachStroke([&](double speed, double rateHz, double offset) {
        // 2 mm deep in the floor, as a hand without force feedback presses; the wall begins at 0.2.
        const Events events = eventsOf(scene, 0.15 / speed, rateHz, [&](double time) {
            return glm::dvec3(0.1 + offset + speed * time, -0.001, 0.0);
        });
        EXPECT_EQ(events.touches, 1U);
        EXPECT_EQ(events.landings, 1U);
        EXPECT_NEAR(events.approach, speed, 0.01 * speed);
        EXPECT_EQ(events.edges, 0U);
    });
}

TEST(ContactTransitionsTest, AWallOfTheSameMeshIsLandedOnLikeAnotherSurface) {
    // A floor and a wall as one open mesh, with its front towards the tip.
    testing::RawMesh corner;
    corner.vertices = {{-1.0, 0.0, -1.0}, {-1.0, 0.0, 1.0}, {0.2, 0.0, 1.0},
                       {0.2, 0.0, -1.0},  {0.2, 1.0, 1.0},  {0.2, 1.0, -1.0}};
    corner.triangles = {{0, 1, 2}, {0, 2, 3}, {3, 2, 4}, {3, 4, 5}};
    const Scene scene = sceneOf({surfaceOf(testing::meshOf(corner))});
    const Events events =
        eventsOf(scene, 0.6, 90.0, [](double time) { return glm::dvec3(0.1 + 0.2 * time, 0.0004, 0.0); });
    EXPECT_EQ(events.landings, 1U);
    EXPECT_NEAR(events.approach, 0.2, 0.005);
    EXPECT_EQ(events.edges, 0U);
}

TEST(ContactTransitionsTest, FlushPlatesHaveNeitherEdgeNorLandingAtAnyForce) {
    forEachStroke([&](double speed, double rateHz, double offset) {
        for (const double depth : {0.0002, 0.0008, 0.0015, 0.004, 0.012}) {
            for (const double press : {0.0, 0.7}) {
                const Events events = eventsOf(sceneOf(plates(0.0)), 0.2 / speed, rateHz, [&](double time) {
                    const double height = tipRadius - depth * (1.0 + press * std::sin(2.0 * pi * 9.0 * time));
                    return glm::dvec3(-0.1 + offset + speed * time, height, 0.0);
                });
                EXPECT_EQ(events.landings, 0U) << depth;
                EXPECT_EQ(events.edges, 0U) << depth;
            }
        }
    });
}

TEST(ContactTransitionsTest, AStepBetweenPlatesIsOneEdgeOfItsHeightInBothDirections) {
    for (const double step : {0.0003, -0.0003, -0.0008, -0.0015}) {
        forEachStroke([&](double speed, double rateHz, double offset) {
            const Events events = eventsOf(sceneOf(plates(step)), 0.2 / speed, rateHz, [&](double time) {
                return glm::dvec3(-0.1 + offset + speed * time, -0.001, 0.0);
            });
            EXPECT_EQ(events.edges, 1U) << step;
            // The tip falls by at most its radius before it is off the rim.
            EXPECT_LT(events.height, 1.1 * std::abs(step) + 0.00002) << step;
            EXPECT_GT(events.height, std::min(0.9 * std::abs(step), 0.99 * tipRadius) - 0.00002) << step;
            EXPECT_EQ(events.landings, 0U);
        });
    }
}

TEST(ContactTransitionsTest, ATipThatSlidesOffABoxCrossesOneRim) {
    const Scene scene = sceneOf({blockAt({0.0, -0.05, 0.0})});
    forEachStroke([&](double speed, double rateHz, double offset) {
        for (const double height : {0.0008, 0.0, -0.003}) {
            const Events events = eventsOf(scene, 0.1 / speed, rateHz,
                                           [&](double time) { return glm::dvec3(offset + speed * time, height, 0.0); });
            EXPECT_EQ(events.edges, 1U) << height;
            EXPECT_DOUBLE_EQ(events.height, tipRadius);
            EXPECT_EQ(events.landings, 0U);
        }
    });
}

TEST(ContactTransitionsTest, ATipThatRollsOverTheRimOfABoxCrossesItOnceHoweverSlowly) {
    for (const double speed : {0.005, 0.04, 0.3}) {
        const double depth = 0.0005;
        const double around = 0.004 - depth;
        const Events events =
            eventsOf(sceneOf({blockAt({0.0, 0.0, 0.0})}, 0.004), 0.04 / speed, 240.0, [&](double time) {
                const double path = speed * time - 0.02;
                const double arc = around * pi / 2.0;
                const double angle = std::clamp(path / around, 0.0, pi / 2.0);
                return glm::dvec3(0.05 + std::min(0.0, path) + around * std::sin(angle),
                                  0.05 + around * std::cos(angle) - std::max(0.0, path - arc), 0.0);
            });
        EXPECT_EQ(events.edges, 1U) << speed;
        EXPECT_DOUBLE_EQ(events.height, 0.004);
        EXPECT_EQ(events.touches, 1U);
    }
}

TEST(ContactTransitionsTest, AnOpenQuadHasARimOnAllSides) {
    testing::RawMesh quad;
    quad.vertices = {{-0.05, 0.0, -0.05}, {-0.05, 0.0, 0.05}, {0.05, 0.0, 0.05}, {0.05, 0.0, -0.05}};
    quad.triangles = {{0, 1, 2}, {0, 2, 3}};
    const Scene scene = sceneOf({surfaceOf(testing::meshOf(quad))});
    for (const double direction : {0.0, 0.7, 1.6, 3.1, 4.4}) {
        const Events events = eventsOf(scene, 0.5, 90.0, [&](double time) {
            return glm::dvec3(0.2 * time * std::cos(direction), 0.0005, 0.2 * time * std::sin(direction));
        });
        EXPECT_EQ(events.edges, 1U) << direction;
    }
}

TEST(ContactTransitionsTest, ALiftIsNoEdgeAtAnyAngleAndAnyDistanceFromTheRim) {
    const Scene scene = sceneOf({blockAt({0.0, -0.05, 0.0})});
    for (const double up : {0.02, 0.2, 1.0}) {
        for (const double along : {0.0, 0.1, 0.5, -0.5}) {
            for (const double from : {0.0, 0.03, 0.0485}) {
                // A tip that passes the rim before it is lifted has slid off.
                if (from + along * 0.0009 / up > 0.049) {
                    continue;
                }
                for (const double rateHz : {72.0, 120.0}) {
                    const Events events = eventsOf(scene, 0.3, rateHz, [&](double time) {
                        const double moving = std::clamp(time - 0.1, 0.0, 0.0014 / std::max(0.02, up));
                        const double away = std::max(0.0, time - 0.1);
                        return glm::dvec3(from + along * moving, 0.0006 + up * away, 0.0);
                    });
                    EXPECT_EQ(events.edges, 0U) << up << ' ' << along << ' ' << from;
                    EXPECT_EQ(events.landings, 0U);
                }
            }
        }
    }
}

TEST(ContactTransitionsTest, RoundShapesHaveNoEdges) {
    const std::vector<Shape> shapes{Sphere{0.05}, Sphere{0.02}, Capsule{0.02, 0.3}, Sphere{0.5},
                                    testing::meshOf(testing::rawTorus(0.06, 0.02, 48, 24))};
    const std::vector<double> radii{0.05, 0.02, 0.02, 0.5, 0.08};
    for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
        for (const double speed : {0.02, 0.15, 0.6}) {
            // In the plane y = 0, around the shape, and then straight ahead.
            const double around = radii[shape] + 0.0006;
            const double seconds = 4.0 * around / speed;
            const Events events = eventsOf(sceneOf({surfaceOf(shapes[shape])}), seconds, 90.0, [&](double time) {
                const double angle = std::min(speed * time / around, 3.0);
                const double beyond = std::max(0.0, speed * time - 3.0 * around);
                return glm::dvec3(around * std::cos(angle) - beyond * std::sin(angle), 0.0,
                                  around * std::sin(angle) + beyond * std::cos(angle));
            });
            EXPECT_GT(events.touches, 0U);
            EXPECT_EQ(events.edges, 0U) << shape << " at " << speed;
            EXPECT_EQ(events.landings, 0U);
        }
    }
}

TEST(ContactTransitionsTest, TheRimsOfAHexagonalPencilAreEdges) {
    testing::RawMesh pencil;
    constexpr std::uint32_t sides = 6;
    for (std::uint32_t side = 0; side < sides; ++side) {
        const double angle = 2.0 * pi * side / sides;
        pencil.vertices.emplace_back(0.004 * std::cos(angle), 0.004 * std::sin(angle), -0.1);
        pencil.vertices.emplace_back(0.004 * std::cos(angle), 0.004 * std::sin(angle), 0.1);
    }
    for (std::uint32_t side = 0; side < sides; ++side) {
        const std::uint32_t here = 2 * side;
        const std::uint32_t next = 2 * ((side + 1) % sides);
        pencil.triangles.push_back({here, next, next + 1});
        pencil.triangles.push_back({here, next + 1, here + 1});
    }
    const auto mesh = testing::meshOf(pencil);
    const Events events = eventsOf(sceneOf({surfaceOf(mesh)}), 2.0, 90.0, [&](double time) {
        // Over six rims, half a millimetre deep.
        const double angle = 0.1 + (2.0 * pi + 0.5) * std::min(time, 1.8) / 1.8;
        const double within = std::remainder(angle - pi / 6.0, pi / 3.0);
        const double out = 0.004 * std::cos(pi / 6.0) / std::cos(within) + 0.0004;
        return glm::dvec3(out * std::cos(angle), out * std::sin(angle), 0.0);
    });
    EXPECT_EQ(events.touches, 1U);
    EXPECT_EQ(events.edges, 6U);
}

TEST(ContactTransitionsTest, ATipAtRestInACornerHasNoEventsInSpiteOfTrackerNoise) {
    const Scene scene = sceneOf({surfaceOf(Plane{}), blockAt({0.5, 0.0, 0.0}, {0.6, 1.0, 1.0})});
    const Events events = eventsOf(scene, 10.0, 90.0, [](double time) {
        const double tremble = 0.0002 * std::sin(2.0 * pi * 8.0 * time);
        return glm::dvec3(0.1995 + tremble, 0.0005 - tremble, 0.05 * std::sin(time));
    });
    EXPECT_EQ(events.landings, 0U);
    EXPECT_EQ(events.edges, 0U);
}

TEST(ContactTransitionsTest, ARotatedSceneHasTheSameEvents) {
    const glm::dquat turn = turned(73.0, {1.0, -2.0, 0.5});
    const glm::dvec3 shift(3.0, -1.0, 7.0);
    std::vector<SceneSurface> surfaces{blockAt({-0.1, -0.05, 0.0}, {0.2, 0.1, 0.1}),
                                       blockAt({0.3, 0.3, 0.0}, {0.6, 1.0, 1.0})};
    for (SceneSurface& surface : surfaces) {
        surface.pose.positionMetres = shift + turn * surface.pose.positionMetres;
        surface.pose.rotation = turn;
    }
    for (const double depth : {0.0006, 0.005}) {
        // Along the block's top against the wall behind it, back, and off the block's other end.
        const Events events = eventsOf(sceneOf(surfaces), 2.0, 90.0, [&](double time) {
            const double x = time < 0.6 ? -0.14 + 0.3 * time : 0.04 - 0.3 * (time - 0.6);
            return shift + turn * glm::dvec3(x, tipRadius - depth, 0.0);
        });
        EXPECT_EQ(events.landings, 1U) << depth;
        EXPECT_NEAR(events.approach, 0.3, 0.003);
        EXPECT_EQ(events.edges, 1U) << depth;
    }
}

TEST(ContactTransitionsTest, TeleportsLostTrackingAndClockRestartsAreNoEdges) {
    const Scene scene =
        sceneOf({blockAt({-0.5, -0.05, 0.0}, {1.0, 0.1, 1.0}), blockAt({0.5, 0.0, 0.0}, {0.6, 1.0, 1.0})});
    for (int kind = 0; kind < 3; ++kind) {
        ContactTracker tracker(scene);
        std::vector<TipSample> samples = sampledPath(0.5, 90.0, [](double time) {
            return time < 0.25 ? glm::dvec3(-0.5 + 0.1 * time, 0.0005, 0.0) : glm::dvec3(0.1995, 0.2 + 0.1 * time, 0.0);
        });
        if (kind == 1) {
            for (std::size_t frame = 15; frame < 30; ++frame) {
                samples[frame].positionMetres.x = testing::nan;
            }
        }
        for (std::size_t frame = 23; kind == 2 && frame < samples.size(); ++frame) {
            samples[frame].timeSeconds -= 0.2;
        }
        const ContactReading last = play(tracker, samples).back();
        EXPECT_EQ(last.landingCounter, 0U) << kind;
        EXPECT_EQ(last.edgeCounter, 0U) << kind;
        EXPECT_EQ(last.surfaceIndex, 1) << kind;
    }
}

TEST(ContactTransitionsTest, ATipWithoutRadiusHasRimsOfTheMinimumHeight) {
    const Events events = eventsOf(sceneOf({blockAt({0.0, -0.05, 0.0})}, 0.0), 0.5, 90.0,
                                   [](double time) { return glm::dvec3(0.2 * time, -0.0004, 0.0); });
    EXPECT_EQ(events.edges, 1U);
    EXPECT_DOUBLE_EQ(events.height, ContactTransitions::minimumRimMetres);
}

}  // namespace
}  // namespace haptoflow::headless
