#include "headless/contact_tracker.hpp"
#include "headless/scene_file.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::headless {
namespace {

using nlohmann::json;

const std::string goldenPath = HAPTOFLOW_TEST_GOLDEN_DIR "/contact/contact-states.json";

/// One scene and the stroke played in it, with one update per sample. Tests/Golden/contact/README.md describes the
/// file's format.
struct Case {
    std::string name;
    json scene;
    json settings;
    json labelStiffness;
    json sampleRows;
    std::vector<TipSample> samples;
};

struct Outcome {
    std::vector<ContactReading> readings;
    ContactStatistics statistics;
};

/// Visits every setting of the file with its name.
template <typename Visit>
void visitSettings(ContactSettings& settings, Visit&& visit) {
    visit("maximum_force_newtons", settings.maximumForceNewtons);
    visit("default_stiffness_newtons_per_metre", settings.defaultStiffnessNewtonsPerMetre);
    visit("release_distance_metres", settings.releaseDistanceMetres);
    visit("switch_margin_metres", settings.switchMarginMetres);
    visit("open_mesh_depth_metres", settings.openMeshDepthMetres);
    visit("lost_seconds", settings.lostSeconds);
    visit("velocity_window_seconds", settings.velocity.windowSeconds);
    visit("velocity_approach_seconds", settings.velocity.approachSeconds);
    visit("velocity_hold_seconds", settings.velocity.holdSeconds);
    visit("velocity_stop_seconds", settings.velocity.stopSeconds);
    visit("velocity_longest_gap_seconds", settings.velocity.maximumGapSeconds);
    visit("velocity_shortest_step_seconds", settings.velocity.minimumStepSeconds);
    visit("velocity_smallest_move_metres", settings.velocity.minimumMoveMetres);
    visit("velocity_fastest_mps", settings.velocity.maximumSpeedMps);
    visit("velocity_jump_gain_mps", settings.velocity.jumpGainMps);
    visit("velocity_jump_acceleration_mps2", settings.velocity.jumpAccelerationMps2);
    visit("velocity_shortest_jump_seconds", settings.velocity.minimumJumpSeconds);
}

ContactSettings settingsOf(const Case& testCase) {
    ContactSettings settings;
    visitSettings(settings, [&](const char* name, double& value) { value = testCase.settings.at(name).get<double>(); });
    settings.stiffnessOfLabel = [stiffness = testCase.labelStiffness.get<std::map<std::string, double>>()](
                                    std::string_view label) -> std::optional<double> {
        const auto found = stiffness.find(std::string(label));
        return found == stiffness.end() ? std::nullopt : std::optional(found->second);
    };
    return settings;
}

double numberOrNaN(const json& value) {
    return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

Case caseFromJson(const json& document) {
    Case testCase{document.at("name").get<std::string>(),
                  document.at("scene"),
                  document.at("settings"),
                  document.at("label_stiffness"),
                  document.at("stroke").at("samples"),
                  {}};
    for (const json& row : testCase.sampleRows) {
        TipSample sample{numberOrNaN(row.at(0)),
                         {numberOrNaN(row.at(1)), numberOrNaN(row.at(2)), numberOrNaN(row.at(3))},
                         std::nullopt,
                         std::nullopt};
        if (!row.at(4).is_null()) {
            sample.forceNewtons = row.at(4).get<double>();
        }
        testCase.samples.push_back(sample);
    }
    return testCase;
}

Outcome play(const Case& testCase) {
    ContactTracker tracker(parseScene(testCase.scene, testCase.name), settingsOf(testCase));
    Outcome outcome;
    for (const TipSample& sample : testCase.samples) {
        outcome.readings.push_back(tracker.update(sample));
    }
    outcome.statistics = tracker.statistics();
    return outcome;
}

/// Every number of a reading with the name of its column.
std::vector<std::pair<std::string, double>> fieldsOf(const ContactReading& reading) {
    std::vector<std::pair<std::string, double>> fields{{"t", reading.timeSeconds},
                                                       {"surface_index", static_cast<double>(reading.surfaceIndex)},
                                                       {"touching", reading.touching ? 1.0 : 0.0},
                                                       {"touch_counter", static_cast<double>(reading.touchCounter)}};
    const auto addVector = [&fields](const std::string& name, const glm::dvec3& vector) {
        fields.insert(fields.end(), {{name + "x", vector.x}, {name + "y", vector.y}, {name + "z", vector.z}});
    };
    addVector("p", reading.pointMetres);
    addVector("n", reading.normal);
    fields.insert(fields.end(), {{"penetration_m", reading.penetrationMetres},
                                 {"vx_mps", reading.tangentialVelocityMps.x},
                                 {"vy_mps", reading.tangentialVelocityMps.y},
                                 {"approach_mps", reading.approachSpeedMps},
                                 {"force_n", reading.forceNewtons},
                                 {"landing_counter", static_cast<double>(reading.landingCounter)},
                                 {"edge_counter", static_cast<double>(reading.edgeCounter)},
                                 {"edge_height_m", reading.edgeHeightMetres}});
    addVector("place_", reading.placeMetres);
    addVector("first_", reading.firstAxis);
    addVector("second_", reading.secondAxis);
    return fields;
}

std::vector<std::string> readingColumns() {
    std::vector<std::string> columns;
    for (const auto& [name, unused] : fieldsOf({})) {
        columns.push_back(name);
    }
    return columns;
}

std::vector<double> rowOf(const ContactReading& reading) {
    std::vector<double> row;
    for (const auto& [unused, value] : fieldsOf(reading)) {
        row.push_back(value);
    }
    return row;
}

json statisticsToJson(const ContactStatistics& statistics) {
    return {{"samples", statistics.samples},
            {"sanitised_samples", statistics.sanitisedSamples},
            {"teleports", statistics.teleports},
            {"clock_restarts", statistics.clockRestarts},
            {"touch_downs", statistics.touchDowns}};
}

/// The pose of every moving surface at every sample, for readers without motions.
json movingPoses(const Case& testCase, const Scene& scene) {
    json all = json::array();
    for (std::size_t index = 0; index < scene.surfaces.size(); ++index) {
        if (!scene.surfaces[index].motion) {
            continue;
        }
        json poses = json::array();
        for (const TipSample& sample : testCase.samples) {
            const Pose pose = scene.surfaces[index].poseAt(sample.timeSeconds);
            poses.push_back({pose.positionMetres.x, pose.positionMetres.y, pose.positionMetres.z, pose.rotation.x,
                             pose.rotation.y, pose.rotation.z, pose.rotation.w});
        }
        all.push_back({{"surface_index", index}, {"poses", std::move(poses)}});
    }
    return all;
}

std::string rows(const json& array, const std::string& indent) {
    std::string text = "[";
    for (std::size_t row = 0; row < array.size(); ++row) {
        text += (row == 0 ? "\n" : ",\n") + indent + array[row].dump();
    }
    return text + "]";
}

/// A case as it stands in the file, with one sample or reading per line, computed anew.
std::string caseText(const Case& testCase) {
    const Outcome outcome = play(testCase);
    const Scene scene = parseScene(testCase.scene, testCase.name);
    json readings = json::array();
    for (const ContactReading& reading : outcome.readings) {
        readings.push_back(rowOf(reading));
    }
    std::string poses;
    for (const json& surface : movingPoses(testCase, scene)) {
        poses += (poses.empty() ? "" : ", ") + std::string("{\"surface_index\": ") + surface["surface_index"].dump() +
                 ", \"columns\": [\"px\", \"py\", \"pz\", \"qx\", \"qy\", \"qz\", \"qw\"], \"poses\": " +
                 rows(surface["poses"], "        ") + "}";
    }
    return "    {\"name\": " + json(testCase.name).dump() + ",\n      \"scene\": " + testCase.scene.dump() +
           ",\n      \"settings\": " + testCase.settings.dump() +
           ",\n      \"label_stiffness\": " + testCase.labelStiffness.dump() +
           ",\n      \"stroke\": {\"columns\": [\"t\", \"x\", \"y\", \"z\", \"force\"], \"samples\": " +
           rows(testCase.sampleRows, "        ") + "},\n      \"surface_poses\": [" + poses +
           "],\n      \"expected\": {\"columns\": " + json(readingColumns()).dump() +
           ", \"readings\": " + rows(readings, "        ") +
           "},\n      \"statistics\": " + statisticsToJson(outcome.statistics).dump() + "}";
}

json goldenFile() {
    std::ifstream file(goldenPath, std::ios::binary);
    EXPECT_TRUE(file) << goldenPath << " is missing: see the README.md beside it";
    return json::parse(file);
}

/// Computes every case of the file anew.
void writeGoldenFile() {
    const json document = goldenFile();
    std::string text = "{\"format\": " + document.at("format").dump() +
                       ", \"version\": " + document.at("version").dump() + ",\n  \"cases\": [";
    for (const json& entry : document.at("cases")) {
        text += (text.back() == '[' ? "\n" : ",\n") + caseText(caseFromJson(entry));
    }
    std::ofstream(goldenPath, std::ios::binary) << text << "\n  ]\n}\n";
}

TEST(ContactGoldenTest, EveryReadingOfTheGoldenFileIsReproduced) {
    if (std::getenv("HAPTOFLOW_WRITE_GOLDEN") != nullptr) {
        writeGoldenFile();
    }
    const json document = goldenFile();
    ASSERT_EQ(document.at("format"), "haptoflow contact states");
    ASSERT_EQ(document.at("version"), 2);
    ASSERT_GE(document.at("cases").size(), 8U);
    for (const json& entry : document.at("cases")) {
        const Case testCase = caseFromJson(entry);
        SCOPED_TRACE(testCase.name);
        const Outcome outcome = play(testCase);
        const json& expected = entry.at("expected");
        ASSERT_EQ(expected.at("columns"), readingColumns());
        ASSERT_GE(expected.at("readings").size(), 50U);
        ASSERT_EQ(expected.at("readings").size(), outcome.readings.size());
        for (std::size_t frame = 0; frame < outcome.readings.size(); ++frame) {
            const std::vector<double> actual = rowOf(outcome.readings[frame]);
            const auto wanted = expected.at("readings")[frame].get<std::vector<double>>();
            ASSERT_EQ(wanted.size(), actual.size());
            for (std::size_t column = 0; column < actual.size(); ++column) {
                EXPECT_NEAR(actual[column], wanted[column], 1e-9)
                    << "frame " << frame << ", " << readingColumns()[column];
            }
        }
        EXPECT_EQ(statisticsToJson(outcome.statistics), entry.at("statistics"));
        EXPECT_GT(outcome.statistics.touchDowns, 0U);
    }
}

TEST(ContactGoldenTest, AnObjectThatWasMovedAndTurnedKeepsThePlacesOnIt) {
    const json document = goldenFile();
    const char* const name = "the same way over a plate before and after it was moved and turned";
    const auto entry = std::ranges::find(document.at("cases"), name, [](const json& each) { return each.at("name"); });
    ASSERT_NE(entry, document.at("cases").end());
    const std::vector<ContactReading> readings = play(caseFromJson(*entry)).readings;
    const std::size_t half = readings.size() / 2;
    std::size_t compared = 0;
    for (std::size_t frame = 0; frame < half; ++frame) {
        const ContactReading& before = readings[frame];
        const ContactReading& after = readings[frame + half];
        ASSERT_EQ(before.touching, after.touching) << "frame " << frame;
        if (before.touching) {
            EXPECT_LT(glm::distance(before.placeMetres, after.placeMetres), 1e-9) << "frame " << frame;
            EXPECT_LT(glm::distance(before.firstAxis, after.firstAxis), 1e-9) << "frame " << frame;
            EXPECT_GT(glm::distance(before.pointMetres, after.pointMetres), 0.1) << "frame " << frame;
            ++compared;
        }
    }
    EXPECT_GT(compared, 30U);
}

}  // namespace
}  // namespace haptoflow::headless
