#include "model/file_layout.hpp"
#include "model/model_file.hpp"
#include "model_builder.hpp"

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

namespace {

using namespace haptoflow::model;
using testing::Bytes;

void tryFile(Bytes file) {
    try {
        const ModelFile model = ModelFile::parse(std::move(file));
        for (std::size_t label = 0; label < model.header().labels.size(); ++label) {
            (void)model.embedding(label)[embeddingSize - 1];
        }
        for (std::size_t seed = 0; seed < model.header().seeds.size(); ++seed) {
            (void)model.seed(seed)[seedSamples - 1];
        }
        for (const Tier& tier : model.header().tiers) {
            for (const std::string* graph : {&tier.field, &tier.level, &tier.encoder, &tier.decoder}) {
                if (!graph->empty() && model.blob(*graph).empty()) {
                    std::abort();
                }
            }
        }
        if (model.header().skeleton.has_value() == !model.header().seeds.empty()) {
            std::abort();
        }
        (void)spaceOf(model.header());
    } catch (const ModelError&) {
    }
}

/// Corrects the checksums of all blobs with a valid position, if the header still fits.
void resealBlobs(Bytes& file) {
    const auto headerLength = static_cast<std::size_t>(testing::readUnsigned(file, 12, 4));
    if (headerLength > file.size() - prefixBytes) {
        return;
    }
    const auto* text = reinterpret_cast<const char*>(file.data()) + prefixBytes;
    nlohmann::json header = nlohmann::json::parse(text, text + headerLength, nullptr, false);
    if (!header.is_object() || !header.contains("blobs") || !header["blobs"].is_array()) {
        return;
    }
    for (auto& blob : header["blobs"]) {
        if (!blob.is_object() || !blob.contains("offset") || !blob.contains("bytes") ||
            !blob["offset"].is_number_unsigned() || !blob["bytes"].is_number_unsigned()) {
            continue;
        }
        const auto offset = blob["offset"].get<std::uint64_t>();
        const auto bytes = blob["bytes"].get<std::uint64_t>();
        if (offset <= file.size() && bytes <= file.size() - offset) {
            blob["crc32"] = crc32(std::span(file).subspan(offset, bytes));
        }
    }
    std::string sealed = header.dump();
    if (sealed.size() <= headerLength) {
        sealed.resize(headerLength, ' ');
        std::memcpy(file.data() + prefixBytes, sealed.data(), headerLength);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes file(size);
    if (size > 0) {
        std::memcpy(file.data(), data, size);
    }
    tryFile(file);
    if (size >= prefixBytes) {
        testing::writeUnsigned(file, 16, 8, size);
        resealBlobs(file);
        testing::resealHeader(file);
        tryFile(std::move(file));
    }
    return 0;
}
