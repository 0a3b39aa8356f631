#include "headless/scene_file.hpp"

#include "headless/command_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

namespace haptoflow::headless {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

json goodScene() {
    return json::parse(R"({
        "surfaces": [
            {"name": "desk", "shape": {"box": {"size": [0.4, 0.02, 0.3]}}, "position": [0.1, 0.2, 0.3],
             "rotation": [0, 0, 0, 2], "material": "wood", "stiffness": 800, "grain": [0, 0, 1], "variation": 0.4,
             "relief": {"image": "planks.png", "size": [0.2, 0.1], "depth": 0.001, "tiled": false}},
            {"name": "ball", "shape": {"sphere": {"radius": 0.05}}, "material": {"cork": 3, "wood": 1},
             "motion": {"loop": true, "keyframes": [{"t": 0}, {"t": 1, "position": [1, 0, 0]}]}},
            {"name": "pill", "shape": {"capsule": {"radius": 0.02, "height": 0.1}}, "material": "wood"},
            {"name": "floor", "shape": {"plane": {}}, "material": "wood"},
            {"name": "sheet", "shape": {"mesh": {"vertices": [[0,0,0],[0,0,1],[1,0,0]], "triangles": [[0,1,2]]}},
             "material": "wood"}
        ],
        "stylus": {"tip_radius": 0.002}, "update_rate": 120})");
}

/// The reader's error for the valid scene after `change`.
template <typename Change>
std::string complaintAfter(Change&& change) {
    json document = goodScene();
    change(document);
    try {
        static_cast<void>(parseScene(document, "scene.json"));
    } catch (const InputError& error) {
        return error.what();
    }
    return "no complaint";
}

std::string complaintAbout(const std::string& pointer, const json& value) {
    return complaintAfter([&](json& document) { document[json::json_pointer(pointer)] = value; });
}

std::string complaintAboutText(const std::string& text) {
    try {
        static_cast<void>(parseSceneText(text, "scene.json"));
    } catch (const InputError& error) {
        return error.what();
    }
    return "no complaint";
}

TEST(SceneFileTest, EveryKeyOfASceneIsRead) {
    const Scene scene = parseScene(goodScene(), "scene.json");
    ASSERT_EQ(scene.surfaces.size(), 5U);
    EXPECT_DOUBLE_EQ(scene.tipRadiusMetres, 0.002);
    EXPECT_DOUBLE_EQ(scene.updateRateHz, 120.0);
    const SceneSurface& desk = scene.surfaces[0];
    EXPECT_EQ(desk.name, "desk");
    EXPECT_EQ(std::get<Box>(desk.shape).sizeMetres, glm::dvec3(0.4, 0.02, 0.3));
    EXPECT_EQ(desk.pose.positionMetres, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(desk.pose.rotation, glm::dquat(1.0, 0.0, 0.0, 0.0));
    EXPECT_EQ(desk.grain, glm::dvec3(0.0, 0.0, 1.0));
    EXPECT_DOUBLE_EQ(desk.variation, 0.4);
    EXPECT_DOUBLE_EQ(scene.surfaces[1].variation, 0.0);
    ASSERT_TRUE(desk.relief);
    EXPECT_EQ(desk.relief->image, "planks.png");
    EXPECT_FALSE(desk.relief->isNormalMap);
    EXPECT_FALSE(desk.relief->isTiled);
    EXPECT_EQ(desk.relief->sizeMetres, (std::array<double, 2>{0.2, 0.1}));
    EXPECT_DOUBLE_EQ(desk.relief->depthMetres, 0.001);
    EXPECT_DOUBLE_EQ(desk.relief->share, 0.5);
    EXPECT_FALSE(scene.surfaces[1].relief);
    EXPECT_DOUBLE_EQ(desk.stiffnessNewtonsPerMetre.value_or(0.0), 800.0);
    EXPECT_EQ(desk.material, (std::vector<std::pair<std::string, double>>{{"wood", 1.0}}));
    const SceneSurface& ball = scene.surfaces[1];
    EXPECT_EQ(ball.material, (std::vector<std::pair<std::string, double>>{{"cork", 0.75}, {"wood", 0.25}}));
    ASSERT_TRUE(ball.motion);
    EXPECT_DOUBLE_EQ(ball.motion->poseAt(0.5).positionMetres.x, 0.5);
    EXPECT_FALSE(ball.stiffnessNewtonsPerMetre);
    EXPECT_DOUBLE_EQ(std::get<Capsule>(scene.surfaces[2].shape).heightMetres, 0.1);
    EXPECT_FALSE(std::get<std::shared_ptr<const TriangleMesh>>(scene.surfaces[4].shape)->isClosed());
}

TEST(SceneFileTest, StylusAndUpdateRateHaveDefaults) {
    json document = goodScene();
    document.erase("stylus");
    document.erase("update_rate");
    const Scene scene = parseScene(document, "scene.json");
    EXPECT_DOUBLE_EQ(scene.tipRadiusMetres, 0.001);
    EXPECT_DOUBLE_EQ(scene.updateRateHz, 90.0);
}

TEST(SceneFileTest, ErrorsForWrongValuesNameFilePathAndExpectedValue) {
    const std::vector<std::tuple<std::string, json, std::string, std::string>> mistakes{
        {"/surfaces/0/shape/box/size", {0.4, 0.0, 0.3}, "surfaces[0].shape.box.size", "edge lengths"},
        {"/surfaces/0/shape/box/size", {0.4, -0.1, 0.3}, "surfaces[0].shape.box.size", "edge lengths"},
        {"/surfaces/0/shape/box/size", {0.4, 0.1}, "surfaces[0].shape.box.size", "edge lengths"},
        {"/surfaces/0/shape/box/size/1", "x", "surfaces[0].shape.box.size[1]", "a number"},
        {"/surfaces/0/shape/box/size/1", nullptr, "surfaces[0].shape.box.size[1]", "a number"},
        {"/surfaces/1/shape/sphere/radius", 0, "surfaces[1].shape.sphere.radius", "metres"},
        {"/surfaces/1/shape/sphere/radius", true, "surfaces[1].shape.sphere.radius", "metres"},
        {"/surfaces/2/shape/capsule/height", 0.03, "surfaces[2].shape.capsule.height", "twice the radius"},
        {"/surfaces/0/position", {0, 0}, "surfaces[0].position", "[x, y, z]"},
        {"/surfaces/0/position/2", 1e12, "surfaces[0].position[2]", "1e9"},
        {"/surfaces/0/rotation", {0, 0, 0, 0}, "surfaces[0].rotation", "other than zero"},
        {"/surfaces/0/rotation", {0, 0, 0}, "surfaces[0].rotation", "quaternion"},
        {"/surfaces/0/grain", {0, 0, 0}, "surfaces[0].grain", "direction"},
        {"/surfaces/0/stiffness", -1, "surfaces[0].stiffness", "N/m"},
        {"/surfaces/0/variation", 1.1, "surfaces[0].variation", "from 0 to 1"},
        {"/surfaces/0/variation", "much", "surfaces[0].variation", "from 0 to 1"},
        {"/surfaces/0/relief/depth", 1.0, "surfaces[0].relief.depth", "0.001 is a millimetre"},
        {"/surfaces/0/relief/size", {0.1}, "surfaces[0].relief.size", "metres"},
        {"/surfaces/0/relief/size", {0.1, 0.0}, "surfaces[0].relief.size", "metres"},
        {"/surfaces/0/relief/normals", "n.png", "surfaces[0].relief", "one of the keys"},
        {"/surfaces/0/relief/tiled", "yes", "surfaces[0].relief.tiled", "true or false"},
        {"/surfaces/0/relief/share", 2, "surfaces[0].relief.share", "0 to 1"},
        {"/surfaces/0/relief/depht", 2, "surfaces[0].relief", "depht"},
        {"/surfaces/0/name", "", "surfaces[0].name", "a name"},
        {"/surfaces/1/name", "desk", "surfaces[1].name", "all other surfaces"},
        {"/surfaces/0/material", 3, "surfaces[0].material", "a label"},
        {"/surfaces/0/material", {{"wood", -1}}, "surfaces[0].material.wood", "weight"},
        {"/surfaces/0/material", {{"wood", 0}}, "surfaces[0].material", "above 0"},
        {"/surfaces/0/material", json::object(), "surfaces[0].material", "above 0"},
        {"/surfaces/0/shape",
         {{"box", {{"size", {1, 1, 1}}}}, {"plane", json::object()}},
         "surfaces[0].shape",
         "one key"},
        {"/surfaces/0/shape", "box", "surfaces[0].shape", "an object"},
        {"/surfaces/1/motion/keyframes", {{{"t", 0}}}, "surfaces[1].motion.keyframes", "two or more"},
        {"/surfaces/1/motion/keyframes/1/t", 0, "surfaces[1].motion.keyframes[1].t", "after"},
        {"/surfaces/1/motion/keyframes/1/rotation", {0, 0, 0, 0}, "surfaces[1].motion.keyframes[1].rotation", "zero"},
        {"/surfaces/1/motion/loop", 1, "surfaces[1].motion.loop", "true or false"},
        {"/surfaces/1/position", {0, 0, 0}, "surfaces[1]", "both a motion and a position"},
        {"/surfaces/4/shape/mesh/triangles/0", {0, 1, 3}, "surfaces[4].shape.mesh.triangles[0]", "0 to 2"},
        {"/surfaces/4/shape/mesh/triangles/0", {0, -1, 2}, "surfaces[4].shape.mesh.triangles[0]", "0 to 2"},
        {"/surfaces/4/shape/mesh/triangles/0", {0, 1, 1}, "surfaces[4].shape.mesh", "area"},
        {"/surfaces/4/shape/mesh/triangles", json::array(), "surfaces[4].shape.mesh.triangles", "one or more"},
        {"/surfaces/4/shape/mesh/vertices/0", {0, 0}, "surfaces[4].shape.mesh.vertices[0]", "vertex"},
        {"/surfaces", json::array(), "surfaces", "one or more"},
        {"/stylus/tip_radius", 0, "stylus.tip_radius", "metres"},
        {"/update_rate", 0, "update_rate", "Hz"},
        {"/update_rate", "90", "update_rate", "Hz"}};
    for (const auto& [pointer, value, path, expectation] : mistakes) {
        EXPECT_THAT(complaintAbout(pointer, value),
                    AllOf(HasSubstr("scene.json: " + path + ": "), HasSubstr(expectation)))
            << pointer << " = " << value;
    }
}

std::string keyframesAt(double unitsPerSecond, int count, double keyframesPerSecond) {
    nlohmann::json keyframes;
    for (int i = 0; i < count; ++i) {
        const double seconds = i / keyframesPerSecond;
        keyframes.push_back({{"t", seconds * unitsPerSecond}, {"position", {0.3 * seconds, 0, 0}}});
    }
    return nlohmann::json{{"surfaces",
                           {{{"name", "lift"},
                             {"shape", {{"plane", nlohmann::json::object()}}},
                             {"material", "wood"},
                             {"motion", {{"keyframes", keyframes}}}}}}}
        .dump();
}

TEST(SceneFileTest, KeyframesInMillisecondsAreRefused) {
    for (const auto& [count, perSecond] : {std::pair{300, 90.0}, {10, 10.0}, {4, 1.0}, {2, 0.5}}) {
        SCOPED_TRACE(count);
        EXPECT_EQ(complaintAboutText(keyframesAt(1.0, count, perSecond)), "no complaint");
        EXPECT_THAT(complaintAboutText(keyframesAt(1e3, count, perSecond)),
                    HasSubstr("scene.json: surfaces[0].motion.keyframes: t rises by "));
        EXPECT_THAT(complaintAboutText(keyframesAt(1e3, count, perSecond)),
                    HasSubstr("are these milliseconds? Divide them by 1000"));
    }
}

TEST(SceneFileTest, ErrorsForUnknownAndMissingKeysNameTheKnownOnes) {
    EXPECT_THAT(complaintAbout("/surfaces/0/colour", "red"),
                AllOf(HasSubstr("surfaces[0]: unknown key \"colour\""), HasSubstr("material, stiffness")));
    EXPECT_THAT(complaintAbout("/surfaces/0/shape/box/radius", 1), HasSubstr("surfaces[0].shape.box: unknown key"));
    EXPECT_THAT(complaintAbout("/surfaces/3/shape/plane/size", 1), HasSubstr("surfaces[3].shape.plane: unknown key"));
    for (const json& seed : {json(1.5), json(-1), json(4294967296), json("seven")}) {
        EXPECT_THAT(complaintAbout("/surfaces/0/seed", seed), HasSubstr("surfaces[0].seed: expected a whole number"));
    }
    EXPECT_EQ(complaintAbout("/surfaces/0/seed", 4294967295), "no complaint");
    EXPECT_THAT(complaintAbout("/surfaces/0/shape/cube", 1), HasSubstr("surfaces[0].shape: unknown key \"cube\""));
    EXPECT_THAT(complaintAbout("/updateRate", 90), HasSubstr("top level: unknown key \"updateRate\""));
    EXPECT_THAT(complaintAfter([](json& document) { document["surfaces"][0].erase("material"); }),
                HasSubstr("surfaces[0]: missing key \"material\""));
    EXPECT_THAT(complaintAfter([](json& document) { document = json::array(); }), HasSubstr("top level: expected"));
}

TEST(SceneFileTest, ErrorsForInvalidJsonNameLineAndColumn) {
    EXPECT_THAT(complaintAboutText("{\n  \"surfaces\": [\n    {,}\n"), HasSubstr(".json:3:6: not valid JSON"));
    EXPECT_THAT(complaintAboutText(""), HasSubstr(".json:1:1: not valid JSON"));
    EXPECT_THAT(complaintAboutText("{\"surfaces\": NaN}"), HasSubstr("not valid JSON"));
    EXPECT_THAT(complaintAboutText("{\"update_rate\": 1e999}"), HasSubstr("too large"));
    EXPECT_THAT(complaintAboutText("{\"name\": \"\xff\"}"), HasSubstr("not valid JSON"));
    EXPECT_THAT(complaintAboutText(R"({"update_rate": 90, "update_rate": 72})"),
                HasSubstr("\"update_rate\" occurs twice"));
    EXPECT_THROW(static_cast<void>(readSceneFile("no/such/scene.json")), InputError);
}

TEST(SceneFileTest, TheSchemaKnowsTheSameKeysAsTheReader) {
    std::ifstream file(HAPTOFLOW_TEST_DOCUMENTATION_DIR "/scene.schema.json");
    const json schema = json::parse(file);
    for (const auto& [inSchema, inScene] : std::vector<std::pair<std::string, std::string>>{
             {"", ""},
             {"/$defs/surface", "/surfaces/0"},
             {"/$defs/shape", "/surfaces/0/shape"},
             {"/$defs/motion", "/surfaces/1/motion"},
             {"/$defs/keyframe", "/surfaces/1/motion/keyframes/0"},
             {"/properties/stylus", "/stylus"},
             {"/$defs/shape/properties/box", "/surfaces/0/shape/box"},
             {"/$defs/shape/properties/sphere", "/surfaces/1/shape/sphere"},
             {"/$defs/shape/properties/capsule", "/surfaces/2/shape/capsule"},
             {"/$defs/shape/properties/mesh", "/surfaces/4/shape/mesh"},
             {"/$defs/relief", "/surfaces/0/relief"}}) {
        std::set<std::string> documented;
        for (const auto& [key, unused] : schema.at(json::json_pointer(inSchema)).at("properties").items()) {
            documented.insert(key);
        }
        const std::string complaint = complaintAbout(inScene + "/unheard-of", 1);
        std::istringstream names(complaint.substr(complaint.find("known are ") + 10));
        std::set<std::string> known;
        for (std::string name; std::getline(names >> std::ws, name, ',');) {
            known.insert(name);
        }
        EXPECT_EQ(documented, known) << inSchema;
    }
}

}  // namespace
}  // namespace haptoflow::headless
