#include "headless/scene_file.hpp"

#include "headless/command_files.hpp"
#include "headless/stroke_file.hpp"
#include "model/plain_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

namespace haptoflow::headless {
namespace {

using nlohmann::json;

constexpr double maximumMetres = 1e9;

std::string inWords(const json& value) {
    if (value.is_structured()) {
        return (value.is_array() ? "an array of " : "an object of ") + std::to_string(value.size());
    }
    const std::string text = value.dump();
    return text.size() > 40 ? std::string(model::shortened(text, 40)) + "..." : text;
}

/// A JSON value with its path, for error messages.
class Node {
public:
    Node(const json& value, const std::string& file, std::string path)
        : value_(&value), file_(&file), path_(std::move(path)) {}

    [[noreturn]] void fail(const std::string& expected) const {
        failWith("expected " + expected + ", found " + inWords(*value_));
    }

    [[noreturn]] void failWith(const std::string& complaint) const {
        throw InputError(*file_ + ": " + (path_.empty() ? "top level" : path_) + ": " + complaint);
    }

    /// Requires an object with no other keys than `known`.
    void requireObject(std::initializer_list<std::string_view> known) const {
        std::string names;
        for (const std::string_view name : known) {
            names += (names.empty() ? "" : ", ") + std::string(name);
        }
        if (!value_->is_object()) {
            fail("an object with the keys " + names);
        }
        for (const auto& [key, unused] : value_->items()) {
            if (std::find(known.begin(), known.end(), key) == known.end()) {
                failWith("unknown key \"" + key + "\"; known are " + (names.empty() ? "none" : names));
            }
        }
    }

    [[nodiscard]] bool has(const std::string& key) const { return value_->contains(key); }

    [[nodiscard]] Node at(const std::string& key) const {
        const auto found = value_->find(key);
        if (found == value_->end()) {
            failWith("missing key \"" + key + "\"");
        }
        return {*found, *file_, path_.empty() ? key : path_ + "." + key};
    }

    [[nodiscard]] std::vector<Node> elements(std::size_t minimumCount, const std::string& expected) const {
        if (!value_->is_array() || value_->size() < minimumCount) {
            fail(expected);
        }
        std::vector<Node> nodes;
        nodes.reserve(value_->size());
        for (std::size_t index = 0; index < value_->size(); ++index) {
            nodes.emplace_back((*value_)[index], *file_, path_ + "[" + std::to_string(index) + "]");
        }
        return nodes;
    }

    [[nodiscard]] double number(double lowest, double highest, const std::string& expected) const {
        const double number = value_->is_number() ? value_->get<double>() : std::numeric_limits<double>::quiet_NaN();
        if (!(number >= lowest && number <= highest)) {
            fail(expected);
        }
        return number;
    }

    /// Reads a number into `target` where the object has the key.
    template <typename Target>
    void readNumber(const std::string& key, Target& target, double lowest, double highest,
                    const std::string& expected) const {
        if (has(key)) {
            target = at(key).number(lowest, highest, expected);
        }
    }

    void readBoolean(const std::string& key, bool& target) const {
        if (has(key)) {
            if (!at(key).raw().is_boolean()) {
                at(key).fail("true or false");
            }
            target = at(key).raw().get<bool>();
        }
    }

    [[nodiscard]] double positiveMetres() const { return number(1e-9, maximumMetres, "metres from 1e-9 to 1e9"); }

    template <std::size_t Size>
    [[nodiscard]] std::array<double, Size> numbers(const std::string& expected) const {
        if (value_->size() != Size) {
            fail(expected);
        }
        std::array<double, Size> result{};
        std::ranges::transform(elements(Size, expected), result.begin(), [](const Node& element) {
            return element.number(-maximumMetres, maximumMetres, "a number within +-1e9");
        });
        return result;
    }

    [[nodiscard]] glm::dvec3 vector(const std::string& expected) const {
        const auto [x, y, z] = numbers<3>(expected);
        return {x, y, z};
    }

    [[nodiscard]] std::string text(const std::string& expected) const {
        if (!value_->is_string() || value_->get_ref<const std::string&>().empty()) {
            fail(expected);
        }
        return value_->get<std::string>();
    }

    [[nodiscard]] const json& raw() const { return *value_; }

private:
    const json* value_;
    const std::string* file_;
    std::string path_;
};

Pose readPose(const Node& node) {
    Pose pose;
    if (node.has("position")) {
        pose.positionMetres = node.at("position").vector("[x, y, z] in metres");
    }
    if (node.has("rotation")) {
        const Node rotation = node.at("rotation");
        const auto [x, y, z, w] = rotation.numbers<4>("a quaternion [x, y, z, w]");
        const double length = std::sqrt(x * x + y * y + z * z + w * w);
        if (!(length > 1e-6)) {
            rotation.failWith("expected a quaternion [x, y, z, w] other than zero; no rotation is [0, 0, 0, 1]");
        }
        pose.rotation = glm::dquat(w / length, x / length, y / length, z / length);
    }
    return pose;
}

void requireSeconds(const Node& node, const std::vector<Keyframe>& keyframes) {
    std::vector<double> steps;
    double metres = 0.0;
    for (std::size_t i = 1; i < keyframes.size(); ++i) {
        const Pose& from = keyframes[i - 1].pose;
        const Pose& to = keyframes[i].pose;
        steps.push_back(keyframes[i].timeSeconds - keyframes[i - 1].timeSeconds);
        // A turn moves a surface's points by about a decimetre for each radian.
        constexpr double metresPerRadian = 0.1;
        const double cosine = std::min(1.0, std::abs(glm::dot(from.rotation, to.rotation)));
        metres += glm::distance(from.positionMetres, to.positionMetres) + metresPerRadian * 2.0 * std::acos(cosine);
    }
    const std::string unit = unitOfTimes(steps, metres);
    if (!unit.empty()) {
        node.failWith("t " + unit);
    }
}

Motion readMotion(const Node& node) {
    node.requireObject({"keyframes", "loop"});
    std::vector<Keyframe> keyframes;
    for (const Node& element : node.at("keyframes").elements(2, "an array of two or more keyframes")) {
        element.requireObject({"t", "position", "rotation"});
        const double time = element.at("t").number(-maximumMetres, maximumMetres, "seconds within +-1e9");
        if (!keyframes.empty() && time <= keyframes.back().timeSeconds) {
            element.at("t").fail("a time after that of the previous keyframe");
        }
        keyframes.push_back({time, readPose(element)});
    }
    requireSeconds(node.at("keyframes"), keyframes);
    bool loop = false;
    node.readBoolean("loop", loop);
    return {std::move(keyframes), loop};
}

Shape readMesh(const Node& node) {
    node.requireObject({"vertices", "triangles"});
    std::vector<glm::dvec3> vertices;
    for (const Node& element : node.at("vertices").elements(3, "an array of three or more vertices [x, y, z]")) {
        vertices.push_back(element.vector("a vertex [x, y, z] in metres"));
    }
    std::vector<TriangleMesh::Triangle> triangles;
    const std::string expected = "three vertex indices [a, b, c] from 0 to " + std::to_string(vertices.size() - 1);
    for (const Node& element : node.at("triangles").elements(1, "an array of one or more triangles [a, b, c]")) {
        TriangleMesh::Triangle corners{};
        if (!element.raw().is_array() || element.raw().size() != corners.size()) {
            element.fail(expected);
        }
        for (std::size_t corner = 0; corner < corners.size(); ++corner) {
            const json& index = element.raw()[corner];
            const bool whole = index.is_number_integer() && index >= 0;
            if (!whole || index.get<std::uint64_t>() >= vertices.size()) {
                element.failWith("expected " + expected + ", found " + element.raw().dump());
            }
            corners[corner] = index.get<std::uint32_t>();
        }
        triangles.push_back(corners);
    }
    try {
        return std::make_shared<const TriangleMesh>(std::move(vertices), triangles);
    } catch (const std::invalid_argument& error) {
        node.failWith(error.what());
    }
}

Shape readShape(const Node& node) {
    node.requireObject({"box", "sphere", "capsule", "plane", "mesh"});
    if (node.raw().size() != 1) {
        node.fail("an object with one key: box, sphere, capsule, plane or mesh");
    }
    const std::string kind = node.raw().begin().key();
    const Node shape = node.at(kind);
    if (kind == "box") {
        shape.requireObject({"size"});
        const std::string expected = "edge lengths [x, y, z] in metres, each from 1e-9 to 1e9";
        const glm::dvec3 size = shape.at("size").vector(expected);
        if (!(size.x >= 1e-9 && size.y >= 1e-9 && size.z >= 1e-9)) {
            shape.at("size").failWith("expected " + expected + ", found " + shape.at("size").raw().dump());
        }
        return Box{size};
    }
    if (kind == "sphere") {
        shape.requireObject({"radius"});
        return Sphere{shape.at("radius").positiveMetres()};
    }
    if (kind == "capsule") {
        shape.requireObject({"radius", "height"});
        const Capsule capsule{shape.at("radius").positiveMetres(), shape.at("height").positiveMetres()};
        if (capsule.heightMetres < 2.0 * capsule.radiusMetres) {
            shape.at("height").fail("a height that includes both caps, so at least twice the radius");
        }
        return capsule;
    }
    if (kind == "plane") {
        shape.requireObject({});
        return Plane{};
    }
    return readMesh(shape);
}

std::vector<std::pair<std::string, double>> readMaterial(const Node& node) {
    const std::string expected =
        "a label like \"wood\", a material file like \"denim.haptomaterial\", or an object of them and weights like "
        "{\"wood\": 1}";
    if (!node.raw().is_object()) {
        return {{node.text(expected), 1.0}};
    }
    std::vector<std::pair<std::string, double>> material;
    double sum = 0.0;
    for (const auto& [label, unused] : node.raw().items()) {
        if (label.empty()) {
            node.failWith("expected a label, found an empty name");
        }
        const double weight = node.at(label).number(0.0, 1e6, "a weight from 0 to 1e6");
        sum += weight;
        material.emplace_back(label, weight);
    }
    if (!(sum > 0.0)) {
        node.failWith("expected at least one label with a weight above 0");
    }
    for (auto& [label, weight] : material) {
        weight /= sum;
    }
    return material;
}

SceneRelief readRelief(const Node& node) {
    node.requireObject({"image", "normals", "size", "depth", "tiled", "share"});
    if (node.has("image") == node.has("normals")) {
        node.failWith(R"(expected one of the keys "image" (heights) and "normals", each with the name of a PNG file)");
    }
    SceneRelief relief;
    relief.isNormalMap = node.has("normals");
    relief.image = node.at(relief.isNormalMap ? "normals" : "image").text("the name of a PNG file");
    const std::string expected = "the tile's lengths [along, across] in metres, each from 0.0001 to 100";
    relief.sizeMetres = node.at("size").numbers<2>(expected);
    for (const double metres : relief.sizeMetres) {
        if (!(metres >= 1e-4 && metres <= 100.0)) {
            node.at("size").fail(expected);
        }
    }
    relief.depthMetres = node.at("depth").number(1e-6, 0.05, "metres from 1e-6 to 0.05; 0.001 is a millimetre");
    node.readNumber("share", relief.share, 0.0, 1.0, "a share from 0 to 1");
    node.readBoolean("tiled", relief.isTiled);
    return relief;
}

/// FNV-1a, 32 bits.
std::uint32_t hashOf(std::string_view text) {
    std::uint32_t hash = 2166136261U;
    for (const char character : text) {
        hash = (hash ^ static_cast<std::uint8_t>(character)) * 16777619U;
    }
    return hash;
}

SceneSurface readSurface(const Node& node) {
    node.requireObject({"name", "shape", "position", "rotation", "motion", "material", "stiffness", "grain",
                        "spatial_scale", "tone_db_per_octave", "variation", "seed", "relief"});
    SceneSurface surface;
    surface.name = node.at("name").text("a name");
    surface.shape = readShape(node.at("shape"));
    surface.pose = readPose(node);
    surface.material = readMaterial(node.at("material"));
    if (node.has("motion")) {
        if (node.has("position") || node.has("rotation")) {
            node.failWith(
                "has both a motion and a position or rotation; the keyframes give its pose, remove the other");
        }
        surface.motion = readMotion(node.at("motion"));
    }
    node.readNumber("stiffness", surface.stiffnessNewtonsPerMetre, 1e-3, 1e7, "N/m from 0.001 to 1e7");
    node.readNumber("spatial_scale", surface.spatialScale, 0.25, 4.0, "a factor from 0.25 to 4");
    node.readNumber("tone_db_per_octave", surface.toneDbPerOctave, -12.0, 12.0, "dB from -12 to 12");
    node.readNumber("variation", surface.variation, 0.0, 1.0, "a number from 0 to 1");
    if (node.has("relief")) {
        surface.relief = readRelief(node.at("relief"));
    }
    surface.seed = hashOf(surface.name);
    if (node.has("seed")) {
        const Node seed = node.at("seed");
        const json& number = seed.raw();
        if (!number.is_number_integer() || number < 0 || number > std::numeric_limits<std::uint32_t>::max()) {
            seed.fail("a whole number from 0 to 4294967295");
        }
        surface.seed = number.get<std::uint32_t>();
    }
    if (node.has("grain")) {
        surface.grain = node.at("grain").vector("a direction [x, y, z] in the object's own axes");
        if (!(glm::length(surface.grain) > 1e-9)) {
            node.at("grain").failWith("expected a direction [x, y, z] other than zero");
        }
    }
    return surface;
}

/// nlohmann's parser keeps the last of two equal keys; in a scene they are a mistake.
class DuplicateKeys {
public:
    explicit DuplicateKeys(std::string file) : file_(std::move(file)) {}

    bool operator()(int, json::parse_event_t event, json& parsed) {
        if (event == json::parse_event_t::object_start) {
            open_.emplace_back();
        } else if (event == json::parse_event_t::object_end) {
            open_.pop_back();
        } else if (event == json::parse_event_t::key && !open_.back().insert(parsed.get<std::string>()).second) {
            throw InputError(file_ + ": the key \"" + parsed.get<std::string>() +
                             "\" occurs twice in one object; keep one");
        }
        return true;
    }

private:
    std::string file_;
    std::vector<std::set<std::string>> open_;
};

std::string lineAndColumn(const std::string& text, std::size_t byte) {
    const std::string_view before(text.data(), std::min(byte > 0 ? byte - 1 : 0, text.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t lineStart = before.rfind('\n');
    const std::size_t column = before.size() - (lineStart == std::string_view::npos ? 0 : lineStart + 1) + 1;
    return std::to_string(line) + ":" + std::to_string(column);
}

}  // namespace

Scene parseScene(const json& document, const std::string& fileName) {
    const Node root(document, fileName, "");
    root.requireObject({"surfaces", "stylus", "update_rate"});
    Scene scene;
    std::set<std::string> names;
    for (const Node& element : root.at("surfaces").elements(1, "an array of one or more surfaces")) {
        scene.surfaces.push_back(readSurface(element));
        if (!names.insert(scene.surfaces.back().name).second) {
            element.at("name").fail("a name that is different from those of all other surfaces");
        }
    }
    if (root.has("stylus")) {
        const Node stylus = root.at("stylus");
        stylus.requireObject({"tip_radius"});
        scene.tipRadiusMetres = stylus.at("tip_radius").number(1e-9, 1.0, "metres from 1e-9 to 1");
    }
    root.readNumber("update_rate", scene.updateRateHz, 1.0, 10000.0, "Hz from 1 to 10000");
    return scene;
}

Scene readSceneFile(const std::string& path) {
    return parseSceneText(readInputFile("the scene", path, "a scene file (JSON)"), path);
}

Scene parseSceneText(const std::string& text, const std::string& fileName) {
    try {
        DuplicateKeys duplicates(fileName);
        return parseScene(json::parse(text, std::ref(duplicates)), fileName);
    } catch (const json::parse_error& error) {
        throw InputError(fileName + ":" + lineAndColumn(text, error.byte) +
                         ": not valid JSON; expected an object with \"surfaces\" (commas between entries, none after "
                         "the last, names in double quotes)");
    } catch (const json::out_of_range&) {
        throw InputError(fileName + ": holds a number too large to represent; expected numbers within +-1e9");
    }
}

std::string unknownMaterial(const std::string& fileName, const std::string& surface, const std::string& material,
                            std::span<const std::string> known) {
    constexpr std::size_t namedLabels = 3;
    return fileName + ": surface '" + surface + "' has material '" + material + "', which the model does not know; " +
           didYouMean(nearestWords(material, known, namedLabels));
}

}  // namespace haptoflow::headless
