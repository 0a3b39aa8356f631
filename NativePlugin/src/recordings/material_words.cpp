#include "recordings/material_words.hpp"

#include "model/header_node.hpp"
#include "model/plain_text.hpp"
#include "recordings/table_rows.hpp"

#include <cctype>

namespace haptoflow::recordings {

std::string materialName(const RecordingDescription& description, const std::filesystem::path& path) {
    const std::string text = description.label.empty() ? utf8Of(path.stem()) : description.label;
    const bool isUtf8 = model::isUtf8(text);
    std::string name;
    for (const char letter : text) {
        const auto code = static_cast<unsigned char>(letter);
        const bool isSpace = letter == '_' || letter == '-' || std::isspace(code) != 0 || std::iscntrl(code) != 0 ||
                             (code >= 0x80U && !isUtf8);
        name += isSpace ? ' ' : static_cast<char>(code < 0x80U ? std::tolower(code) : code);
    }
    name = trimmed(model::shortened(trimmed(name), model::nameBytes));
    return name.empty() ? "material" : name;
}

std::string provenanceOf(const RecordingDescription& description, const std::filesystem::path& path) {
    return model::printable(utf8Of(path.filename())) + (description.source.empty() ? "" : ", " + description.source);
}

}  // namespace haptoflow::recordings
