#include "material_output.hpp"

#include "messages.hpp"
#include "model/material_file.hpp"
#include "model/plain_text.hpp"

#include <exception>

namespace haptoflow::cli {
namespace {

/// The characters that some platform's file names may not hold, or that lead to another folder.
constexpr std::string_view forbidden = R"(/\:*?"<>|)";

}  // namespace

std::string fileNameOf(std::string_view words) {
    constexpr std::size_t maximumBytes = 128;
    std::string name;
    for (const char letter : model::shortened(words, maximumBytes)) {
        const bool isPlain =
            !model::hasControlCharacter({&letter, 1}) && forbidden.find(letter) == std::string_view::npos;
        name += isPlain ? letter : '-';
    }
    const std::size_t first = name.find_first_not_of(" .-");
    return first == std::string::npos ? "material" : name.substr(first, name.find_last_not_of(" .-") - first + 1);
}

void writeMaterial(const OutputFile& file, const std::string& json, const model::ModelHeader& header) {
    writeText(file, json);
    try {
        model::requireSpace(model::readMaterial(file.partial()), header);
    } catch (const std::exception& error) {
        throw InputError(file.path().string() + ": was not written, because it could not be read back (" +
                         error.what() + ")");
    }
}

}  // namespace haptoflow::cli
