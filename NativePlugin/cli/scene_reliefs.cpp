#include "scene_reliefs.hpp"

#include "effects/relief_normals.hpp"
#include "engine/relief_table.hpp"
#include "headless/command_files.hpp"

#include <lodepng.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>

namespace haptoflow::cli {
namespace {

using headless::InputError;

/// Four numbers from 0 to 1 for each texel: red, green, blue, and how opaque it is.
struct Image {
    unsigned columns = 0;
    unsigned rows = 0;
    std::vector<float> colours;
};

Image readImage(const std::string& path) {
    const std::string file = headless::readInputFile("the relief", path, "a PNG file");
    const auto* bytes = reinterpret_cast<const unsigned char*>(file.data());
    Image image;
    LodePNGState state;
    lodepng_state_init(&state);
    const unsigned unreadable = lodepng_inspect(&image.columns, &image.rows, &state, bytes, file.size());
    lodepng_state_cleanup(&state);
    if (unreadable != 0) {
        throw InputError(path + ": not a PNG file (" + lodepng_error_text(unreadable) + ")");
    }
    if (std::size_t{image.columns} * image.rows > effects::ReliefMap::maximumTexels) {
        throw InputError(path + ": " + std::to_string(image.columns) + " x " + std::to_string(image.rows) +
                         " texels; a relief has at most " + std::to_string(effects::ReliefMap::maximumTexels) +
                         ", such as 2048 x 1536. Make the image smaller");
    }
    constexpr unsigned bits = 16;
    unsigned char* decoded = nullptr;
    const unsigned error =
        lodepng_decode_memory(&decoded, &image.columns, &image.rows, bytes, file.size(), LCT_RGBA, bits);
    const std::unique_ptr<unsigned char, decltype(&std::free)> owner(decoded, std::free);
    if (error != 0) {
        throw InputError(path + ": damaged (" + lodepng_error_text(error) + ")");
    }
    image.colours.resize(4 * std::size_t{image.columns} * image.rows);
    for (std::size_t index = 0; index < image.colours.size(); ++index) {
        const unsigned value = 256U * decoded[2 * index] + decoded[2 * index + 1];
        image.colours[index] = static_cast<float>(value) / 65535.0F;
    }
    return image;
}

std::vector<float> heightsOf(const Image& image) {
    std::vector<float> heights;
    heights.reserve(image.colours.size() / 4);
    for (std::size_t first = 0; first < image.colours.size(); first += 4) {
        const auto colour = std::span(image.colours).subspan(first, 4);
        heights.push_back((colour[0] + colour[1] + colour[2]) / 3.0F);
    }
    return heights;
}

std::vector<float> integrated(const Image& image, const headless::SceneRelief& relief) {
    std::vector<float> normals;
    normals.reserve(3 * image.colours.size() / 4);
    for (std::size_t first = 0; first < image.colours.size(); first += 4) {
        const auto colour = std::span(image.colours).subspan(first, 4);
        // Green leads up the image, and rows lead down.
        normals.push_back(2.0F * colour[0] - 1.0F);
        normals.push_back(1.0F - 2.0F * colour[1]);
        normals.push_back(2.0F * colour[2] - 1.0F);
    }
    std::vector<float> heights =
        effects::heightsOfNormals(normals, image.columns, image.rows, relief.sizeMetres, relief.isTiled);
    const float highest = *std::ranges::max_element(heights);
    std::ranges::for_each(heights, [highest](float& height) { height /= highest > 0.0F ? highest : 1.0F; });
    return heights;
}

}  // namespace

effects::ReliefMap readRelief(const headless::SceneRelief& relief, double tipRadiusMetres,
                              const std::string& scenePath) {
    const std::string path = (std::filesystem::path(scenePath).parent_path() / relief.image).string();
    const Image image = readImage(path);
    std::vector<float> heights = relief.isNormalMap ? integrated(image, relief) : heightsOf(image);
    std::ranges::for_each(heights, [&](float& height) { height *= static_cast<float>(relief.depthMetres); });
    try {
        return {heights,
                {.columns = image.columns,
                 .rows = image.rows,
                 .sizeMetres = relief.sizeMetres,
                 .depthMetres = relief.depthMetres,
                 .tipRadiusMetres = tipRadiusMetres,
                 .isTiled = relief.isTiled}};
    } catch (const std::invalid_argument& error) {
        throw InputError(path + ": " + error.what());
    }
}

SceneReliefs::SceneReliefs(const headless::Scene& scene, const std::string& scenePath) {
    for (const headless::SceneSurface& surface : scene.surfaces) {
        if (surface.relief) {
            auto map = std::make_shared<const effects::ReliefMap>(
                readRelief(*surface.relief, scene.tipRadiusMetres, scenePath));
            numbers_.emplace_back(surface.name, engine::reliefs().add(std::move(map)));
        }
    }
}

SceneReliefs::~SceneReliefs() {
    for (const auto& [surface, number] : numbers_) {
        engine::reliefs().remove(number);
    }
}

std::uint32_t SceneReliefs::numberOf(const headless::SceneSurface& surface) const {
    return std::ranges::find(numbers_, surface.name, [](const auto& each) { return each.first; })->second;
}

}  // namespace haptoflow::cli
