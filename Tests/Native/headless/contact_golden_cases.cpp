#include "contact_golden.hpp"
#include "headless/scenes/scene_file.hpp"
#include "test_scenes.hpp"

#include <exception>
#include <fstream>
#include <iostream>
#include <limits>
#include <numbers>
#include <random>

namespace haptoflow::headless::golden {
namespace {

using nlohmann::json;
using testing::sampledPath;

constexpr double frameRateHz = 90.0;

json sceneWith(json surfaces, double tipRadiusMetres) {
    return {
        {"surfaces", std::move(surfaces)}, {"stylus", {{"tip_radius", tipRadiusMetres}}}, {"update_rate", frameRateHz}};
}

json surfaceWith(const std::string& name, json shape, json material = "wood") {
    return {{"name", name}, {"shape", std::move(shape)}, {"material", std::move(material)}};
}

Case caseOf(const std::string& name, json scene, std::vector<TipSample> samples) {
    return {name, std::move(scene), settingsToJson({}), json::object(), std::move(samples)};
}

Case boxEdge() {
    const json box = surfaceWith("box", {{"box", {{"size", {0.1, 0.04, 0.06}}}}});
    const double lift = 0.0036;
    return caseOf("over the edge of a box and down its side", sceneWith({box}, 0.004),
                  sampledPath(0.8, frameRateHz, [&](double time) {
                      const double path = 0.08 * time - 0.03;
                      const double angle = std::clamp(path / lift, 0.0, 0.5 * std::numbers::pi);
                      return glm::dvec3(
                          0.05 + std::min(0.0, path) + lift * std::sin(angle),
                          0.02 + lift * std::cos(angle) - std::max(0.0, path - 0.5 * std::numbers::pi * lift),
                          0.004 * time);
                  }));
}

Case deepInsideBox() {
    json box = surfaceWith("box", {{"box", {{"size", {0.1, 0.1, 0.1}}}}});
    box["rotation"] = {0.1, 0.2, 0.3, 0.9};
    box["grain"] = {1.0, 2.0, 0.5};
    return caseOf("deep inside a turned box, from one face's side to another's", sceneWith({box}, 0.001),
                  sampledPath(0.6, frameRateHz, [](double time) {
                      const double path = 0.15 * time;
                      const Pose pose = sanitised({{0.0, 0.0, 0.0}, {0.9, 0.1, 0.2, 0.3}});
                      return pose.pointToWorld({path - 0.045, 0.035, 0.0004 * std::sin(90.0 * time)});
                  }));
}

Case spherePole() {
    json sphere = surfaceWith("ball", {{"sphere", {{"radius", 0.05}}}});
    sphere["grain"] = {0.0, 1.0, 0.0};
    sphere["position"] = {0.2, 0.3, -0.1};
    return caseOf("over the grain's pole of a sphere", sceneWith({sphere}, 0.002),
                  sampledPath(1.0, frameRateHz, [](double time) {
                      const double angle = 2.4 * (time - 0.5);
                      return glm::dvec3(0.2 + 0.051 * std::sin(angle), 0.3 + 0.051 * std::cos(angle), -0.0995);
                  }));
}

Case movingPlate() {
    json plate = surfaceWith("plate", {{"box", {{"size", {0.4, 0.02, 0.4}}}}});
    plate["motion"] = {
        {"loop", true},
        {"keyframes",
         {{{"t", 0.0}, {"position", {0.0, 0.0, 0.0}}, {"rotation", {0.0, 0.0, 0.0, 1.0}}},
          {{"t", 0.4}, {"position", {0.05, 0.002, 0.0}}, {"rotation", {0.0, 0.5, 0.0, 0.8660254037844386}}},
          {{"t", 0.8}, {"position", {0.0, 0.0, 0.03}}, {"rotation", {0.0, 0.2, 0.0, 0.9797958971132712}}},
          {{"t", 1.2}, {"position", {0.0, 0.0, 0.0}}, {"rotation", {0.0, 0.0, 0.0, 1.0}}}}}};
    return caseOf("a drawing tip on a plate that slides and turns", sceneWith({plate}, 0.003),
                  sampledPath(1.5, frameRateHz, [](double time) {
                      return glm::dvec3(0.08 * std::cos(5.0 * time), 0.0122, 0.06 * std::sin(7.0 * time));
                  }));
}

/// The same way over a plate before and after it was moved and turned. The tip is lifted in between.
Case carriedPlate() {
    const Pose before{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}};
    const Pose after = sanitised({{0.3, 0.1, -0.2}, {0.8, 0.3, 0.5, 0.1}});
    const auto keyframe = [](double time, const Pose& pose) {
        const glm::dvec3& at = pose.positionMetres;
        return json{{"t", time},
                    {"position", {at.x, at.y, at.z}},
                    {"rotation", {pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w}}};
    };
    json plate = surfaceWith("plate", {{"box", {{"size", {0.4, 0.02, 0.4}}}}});
    plate["motion"] = {{"loop", false}, {"keyframes", {keyframe(0.45, before), keyframe(0.6, after)}}};
    return caseOf(carriedPlateName, sceneWith({plate}, 0.003),
                  sampledPath(2.0 * carriedPlateSeconds, frameRateHz, [&](double time) {
                      const bool isMoved = time >= carriedPlateSeconds - 1e-9;
                      const double local = isMoved ? time - carriedPlateSeconds : time;
                      const glm::dvec3 tip{0.05 * std::cos(9.0 * local), local < 0.4 ? 0.0122 : 0.05,
                                           0.04 * std::sin(9.0 * local)};
                      return (isMoved ? after : before).pointToWorld(tip);
                  }));
}

Case meshAndBlend() {
    const testing::RawMesh raw = testing::rawTorus(0.06, 0.02, 12, 8);
    json vertices = json::array();
    for (const glm::dvec3& vertex : raw.vertices) {
        vertices.push_back({vertex.x, vertex.y, vertex.z});
    }
    json ring = surfaceWith("ring", {{"mesh", {{"vertices", vertices}, {"triangles", raw.triangles}}}},
                            {{"wood", 3.0}, {"cork", 1.0}, {"unknown", 1.0}});
    Case result = caseOf("round a torus mesh with a blend of labels", sceneWith({ring}, 0.002),
                         sampledPath(1.0, frameRateHz, [](double time) {
                             const double around = 3.0 * time;
                             const double along = 2.0 + 4.0 * time;
                             const double distance = 0.06 + 0.0205 * std::cos(along);
                             return glm::dvec3(distance * std::cos(around), 0.0205 * std::sin(along),
                                               distance * std::sin(around));
                         }));
    result.labelStiffness = {{"wood", 900.0}, {"cork", 300.0}};
    return result;
}

Case trackerHold() {
    const json table = surfaceWith("table", {{"plane", json::object()}});
    return caseOf("a tracker at two thirds of the frame rate, then a stop", sceneWith({table}, 0.001),
                  sampledPath(1.0, frameRateHz, [](double time) {
                      const double tick = std::floor(60.0 * std::min(time, 0.6) + 0.2) / 60.0;
                      return glm::dvec3(0.3 * tick, 0.0004, 0.1 * tick);
                  }));
}

Case noisyScribble() {
    const json table = surfaceWith("table", {{"plane", json::object()}});
    std::mt19937 random(7);
    return caseOf("a scribble by a noisy tracker, rest, and an exact stop", sceneWith({table}, 0.001),
                  sampledPath(2.0, frameRateHz, [&](double time) {
                      const double metres = time < 1.0 ? 0.01 * std::sin(6.0 * std::numbers::pi * time) : 0.0;
                      const auto noise = [&] {
                          return time < 1.7 ? 0.0002 * (static_cast<double>(random()) / 4294967296.0 - 0.5) : 0.0;
                      };
                      return glm::dvec3{metres + noise(), 0.0004 + noise(), 0.5 * metres + noise()};
                  }));
}

Case brokenTracking() {
    const json table = surfaceWith("table", {{"plane", json::object()}});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Case result = caseOf("a teleport, lost tracking, a clock that restarts, a measured force",
                         sceneWith({table}, 0.001), sampledPath(1.0, frameRateHz, [](double time) {
                             return glm::dvec3(0.25 * time + (time > 0.3 ? 2.0 : 0.0), 0.0005, 0.0);
                         }));
    for (std::size_t frame = 45; frame < 60; ++frame) {
        result.samples[frame].positionMetres.y = frame % 2 == 0 ? nan : 1e20;
    }
    result.samples[50].timeSeconds = nan;
    for (std::size_t frame = 75; frame < result.samples.size(); ++frame) {
        result.samples[frame].timeSeconds -= 0.5;
        result.samples[frame].forceNewtons = 0.1 * static_cast<double>(frame - 70);
    }
    result.samples[80].forceNewtons = -1.0;
    result.samples[82].timeSeconds = result.samples[81].timeSeconds;
    result.samples[84].timeSeconds = result.samples[83].timeSeconds + 1e-6;
    return result;
}

Case seamAndTaps() {
    json left = surfaceWith("left", {{"box", {{"size", {0.1, 0.1, 0.1}}}}}, "wood");
    left["position"] = {-0.05, -0.05, 0.0};
    left["stiffness"] = 1200.0;
    json right = surfaceWith("right", {{"capsule", {{"radius", 0.03}, {"height", 0.2}}}}, "cork");
    right["position"] = {0.03, -0.029, 0.0};
    right["rotation"] = {0.7071067811865476, 0.0, 0.0, 0.7071067811865476};
    return caseOf("taps and slides across the seam of a box and a lying capsule", sceneWith({left, right}, 0.002),
                  sampledPath(1.6, frameRateHz, [](double time) {
                      return glm::dvec3(0.05 * std::sin(4.0 * time), 0.0028 + 0.0022 * std::cos(19.0 * time),
                                        0.01 * time);
                  }));
}

Case stepsAndWall() {
    json low = surfaceWith("low", {{"box", {{"size", {0.1, 0.02, 0.1}}}}}, "wood");
    low["position"] = {-0.05, -0.01, 0.0};
    json high = surfaceWith("high", {{"box", {{"size", {0.1, 0.02, 0.1}}}}}, "metal");
    high["position"] = {0.05, -0.0097, 0.0};
    json wall = surfaceWith("wall", {{"box", {{"size", {0.02, 0.1, 0.1}}}}}, "stone");
    wall["position"] = {0.09, 0.04, 0.0};
    // To and fro over the step, against the wall, and finally off the low plate's rim.
    return caseOf("over a step, against a wall, back and off the rim", sceneWith({low, high, wall}, 0.001),
                  sampledPath(2.4, frameRateHz, [](double time) {
                      const double x = time < 1.0 ? -0.04 + 0.13 * time : 0.09 - 0.17 * (time - 1.0);
                      return glm::dvec3(x, 0.0002 + 0.0002 * std::sin(31.0 * time), 0.01 * time);
                  }));
}

/// A tray of a passenger's in a vehicle at 60 m/s in a bend, in a frame of its own; the pen comes down on it and draws.
Case trayInAVehicle() {
    json keyframes = json::array();
    for (int index = 0; index <= 16; ++index) {
        const double angle = 0.1 * index;
        keyframes.push_back(
            {{"t", 0.1 * index},
             {"position", {60.0 * std::sin(angle), 0.02 * std::sin(9.0 * angle), 60.0 - 60.0 * std::cos(angle)}},
             {"rotation", {0.0, -std::sin(0.5 * angle), 0.02 * std::sin(7.0 * angle), std::cos(0.5 * angle)}}});
    }
    json tray = surfaceWith("tray", {{"box", {{"size", {0.4, 0.02, 0.3}}}}});
    tray["motion"] = {{"loop", false}, {"keyframes", keyframes}};
    const Scene scene = parseScene(sceneWith({tray}, 0.002), "tray");
    return caseOf("down onto a tray in a vehicle, and a stroke on it", sceneWith({tray}, 0.002),
                  sampledPath(1.5, frameRateHz, [&](double time) {
                      const double height = std::max(0.0112, 0.03 - 0.1 * time);
                      return scene.surfaces[0].poseAt(time).pointToWorld(
                          {0.06 * std::cos(4.0 * time), height, 0.05 * std::sin(5.0 * time)});
                  }));
}

/// A tracker of 60 Hz, carried by a lift that rises at 3 m/s; then it holds its position in the world while the lift
/// goes on beneath.
Case heldInALift() {
    json lift = surfaceWith("lift", {{"box", {{"size", {4.0, 0.02, 4.0}}}}});
    lift["motion"] = {{"loop", false},
                      {"keyframes",
                       {{{"t", 0.0}, {"position", {0.0, 0.0, 0.0}}},
                        {{"t", 0.7}, {"position", {0.0, 2.1, 0.0}}},
                        {{"t", 0.75}, {"position", {0.0, 2.2, 0.0}}},
                        {{"t", 1.5}, {"position", {0.3, 2.2, 0.0}}}}}};
    const Scene scene = parseScene(sceneWith({lift}, 0.002), "lift");
    return caseOf("a slow tracker carried by a lift, then held in the world", sceneWith({lift}, 0.002),
                  sampledPath(1.5, frameRateHz, [&](double time) {
                      const double tick = std::floor(60.0 * time + 0.2) / 60.0;
                      return time < 0.9 ? scene.surfaces[0].poseAt(time).pointToWorld({0.2 * tick, 0.0112, 0.0})
                                        : glm::dvec3(0.25, 2.2112, 0.0);
                  }));
}

/// Snap turns of the rig about the head, half a metre from the pen, which draws on; the last lands it on another board.
Case snapTurns() {
    json desk = surfaceWith("desk", {{"box", {{"size", {3.0, 0.02, 1.2}}}}});
    json other = surfaceWith("other", {{"box", {{"size", {3.0, 0.02, 1.2}}}}}, "stone");
    other["position"] = {0.0, 0.0003, -1.2};
    return caseOf("snap turns of 15, 30 and 90 degrees in a stroke", sceneWith({desk, other}, 0.002),
                  sampledPath(1.2, frameRateHz, [&](double time) {
                      const double degrees = time < 0.4 ? 0.0 : time < 0.6 ? 15.0 : time < 0.8 ? 45.0 : 135.0;
                      const glm::dquat rig = testing::turned(degrees, {0.0, 1.0, 0.0});
                      const glm::dvec3 pen{0.5 + 0.04 * std::cos(5.0 * time), 0.0112, 0.04 * std::sin(5.0 * time)};
                      return glm::dvec3(0.0, 0.0, -0.3) + rig * pen;
                  }));
}

json matMesh(const glm::dvec3& half) {
    const testing::RawMesh raw = testing::rawBoxMesh(half);
    json vertices = json::array();
    for (const glm::dvec3& vertex : raw.vertices) {
        vertices.push_back({vertex.x, vertex.y, vertex.z});
    }
    return {{"mesh", {{"vertices", vertices}, {"triangles", raw.triangles}}}};
}

/// A hand that presses through a mat of 3 mm into the table, slides off the mat's rim, and is lifted.
Case matOnTable(const std::string& kind, json shape) {
    json table = surfaceWith("table", {{"box", {{"size", {0.6, 0.02, 0.4}}}}});
    table["position"] = {0.0, -0.01, 0.0};
    json mat = surfaceWith("mat", std::move(shape), "carpet");
    mat["position"] = {0.0, 0.0015, 0.0};
    return caseOf("through a mat into the table, off the mat, up: the mat is a " + kind, sceneWith({table, mat}, 0.002),
                  sampledPath(1.8, frameRateHz, [](double time) {
                      const double down = 0.006 - 0.014 * std::min(time, 1.0);
                      return glm::dvec3(0.01 + 0.13 * std::max(0.0, std::min(time, 1.6) - 0.6),
                                        time < 1.6 ? down : down + 0.08 * (time - 1.6), 0.01 * time);
                  }));
}

/// Down through a plate of 3 mm in the air, and up again into its lower side.
Case thinPlate() {
    const json box = surfaceWith("box", {{"box", {{"size", {0.1, 0.003, 0.1}}}}});
    json mesh = surfaceWith("mesh", matMesh({0.05, 0.0015, 0.05}));
    mesh["position"] = {0.2, 0.0, 0.0};
    return caseOf("down through a plate in the air and up into its lower side, a box and a mesh",
                  sceneWith({box, mesh}, 0.002), sampledPath(2.4, frameRateHz, [](double time) {
                      const double local = time < 1.2 ? time : time - 1.2;
                      return glm::dvec3((time < 1.2 ? 0.01 : 0.21) + 0.02 * local,
                                        local < 0.6 ? 0.006 - 0.025 * local : -0.009 + 0.012 * (local - 0.6), 0.005);
                  }));
}

/// Passes at 3 m/s between two samples: one touch on each pass, whatever the kind of the shape, moving or not.
Case fastPasses() {
    json box = surfaceWith("box", {{"box", {{"size", {0.1, 0.003, 0.1}}}}});
    json ball = surfaceWith("ball", {{"sphere", {{"radius", 0.01}}}});
    ball["position"] = {0.2, 0.0, 0.0};
    json rod = surfaceWith("rod", {{"capsule", {{"radius", 0.004}, {"height", 0.06}}}});
    rod["position"] = {0.4, 0.0, 0.0};
    rod["rotation"] = {0.7071067811865476, 0.0, 0.0, 0.7071067811865476};
    json plate = surfaceWith("mesh", matMesh({0.05, 0.0015, 0.05}));
    plate["position"] = {0.6, 0.0, 0.0};
    json lift = surfaceWith("lift", {{"box", {{"size", {0.1, 0.003, 0.1}}}}});
    lift["motion"] = {
        {"loop", false},
        {"keyframes", {{{"t", 0.0}, {"position", {0.8, 0.0, 0.0}}}, {{"t", 12.0}, {"position", {0.8, 24.0, 0.0}}}}}};
    return caseOf("passes at 3 m/s and 10 Hz through a box, a ball, a rod, a mesh and a box on a lift",
                  sceneWith({box, ball, rod, plate, lift}, 0.002), sampledPath(9.9, 10.0, [](double time) {
                      const int frame = static_cast<int>(std::lround(10.0 * time));
                      const int shape = frame / 20;
                      const double side = (frame / 3) % 2 == 0 ? 1.0 : -1.0;
                      const double height = side * (0.12 + 0.05 * std::sin(2.1 * frame));
                      return glm::dvec3(0.2 * shape + 0.001, height + (shape == 4 ? 2.0 * time : 0.0), 0.002);
                  }));
}

/// A tip that rests above a platform which lifts it by more than its thickness in every frame.
Case restingOnALift() {
    json lift = surfaceWith("lift", {{"box", {{"size", {0.1, 0.003, 0.1}}}}});
    lift["motion"] = {
        {"loop", false},
        {"keyframes", {{{"t", 0.0}, {"position", {0.0, 0.0, 0.0}}}, {{"t", 2.0}, {"position", {0.0, 6.0, 0.0}}}}}};
    return caseOf("above a platform that is lifted at 3 m/s, then on it", sceneWith({lift}, 0.002),
                  sampledPath(1.0, frameRateHz, [](double time) {
                      return glm::dvec3(0.01, 3.0 * time + (time < 0.5 ? 0.008 : 0.0025), 0.0);
                  }));
}

}  // namespace

std::vector<Case> goldenCases() {
    return {boxEdge(),
            deepInsideBox(),
            spherePole(),
            movingPlate(),
            meshAndBlend(),
            trackerHold(),
            noisyScribble(),
            brokenTracking(),
            seamAndTaps(),
            stepsAndWall(),
            carriedPlate(),
            matOnTable("box", {{"box", {{"size", {0.2, 0.003, 0.2}}}}}),
            matOnTable("mesh", matMesh({0.1, 0.0015, 0.1})),
            thinPlate(),
            fastPasses(),
            restingOnALift(),
            trayInAVehicle(),
            heldInALift(),
            snapTurns()};
}

}  // namespace haptoflow::headless::golden

int main(int argc, char** argv) {
    if (argc != 3 || std::string(argv[1]) != "--write-golden") {
        std::cerr << "usage: haptoflow_contact_golden --write-golden Tests/Golden/contact/contact-states.json\n";
        return 2;
    }
    try {
        std::ofstream file(argv[2], std::ios::binary);
        file << haptoflow::headless::golden::fileText(haptoflow::headless::golden::goldenCases());
        file.close();
        if (!file) {
            std::cerr << argv[2] << ": cannot be written; expected a path in a folder that exists\n";
            return 3;
        }
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 4;
    }
    return 0;
}
