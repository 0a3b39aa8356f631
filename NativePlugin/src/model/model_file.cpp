#include "model/model_file.hpp"

#include "model/file_layout.hpp"
#include "model/model_blobs.hpp"

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>

namespace haptoflow::model {
namespace {

template <typename Element>
const Element* findByName(const std::vector<Element>& elements, std::string_view name) noexcept {
    const auto found =
        std::find_if(elements.begin(), elements.end(), [name](const Element& each) { return each.name == name; });
    return found != elements.end() ? &*found : nullptr;
}

std::vector<std::byte> readBytes(const std::filesystem::path& path) {
    std::error_code failure;
    if (!std::filesystem::is_regular_file(path, failure)) {
        throw ModelError(ModelStatus::unreadable, "there is no such file");
    }
    const std::uintmax_t size = std::filesystem::file_size(path, failure);
    if (failure) {
        throw ModelError(ModelStatus::unreadable, "cannot be read: " + failure.message());
    }
    if (size > maximumFileBytes) {
        throw ModelError(ModelStatus::oversized,
                         "the file has " + std::to_string(size) + " bytes; the limit is 268435456");
    }
    std::ifstream stream(path, std::ios::binary);
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    if (!stream || !stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) {
        throw ModelError(ModelStatus::unreadable, "cannot be opened or read to its end");
    }
    return bytes;
}

}  // namespace

ModelFile ModelFile::parse(std::vector<std::byte> bytes) {
    ModelFile model;
    model.bytes_ = std::move(bytes);
    const FileLayout layout = readLayout(model.bytes_);
    model.headerTextBytes_ = layout.headerText.size();
    model.header_ = readHeader(layout.headerText);
    checkBlobBytes(model.bytes_, layout.headerEnd, model.header_.blobs);
    for (const Blob& blob : model.header_.blobs) {
        if (blob.type != BlobType::float32) {
            continue;
        }
        std::vector<float> values = readTensor(model.bytes_, blob);
        if (blob.name == "embedding") {
            model.embeddings_ = std::move(values);
        } else if (blob.name == piecesTensor) {
            model.pieces_ = std::move(values);
            model.piecesPerLabel_ = static_cast<std::size_t>(blob.shape[1]);
        } else if (blob.name == model.header_.seedTensor) {
            checkSeedRows(values);
            model.seeds_ = std::move(values);
        }
    }
    return model;
}

ModelFile ModelFile::read(const std::filesystem::path& path) {
    try {
        return parse(readBytes(path));
    } catch (const ModelError& error) {
        const std::u8string name = path.u8string();
        throw ModelError(error.status(), std::string(name.begin(), name.end()) + ": " + error.what());
    }
}

std::string_view ModelFile::headerText() const noexcept {
    return {reinterpret_cast<const char*>(bytes_.data()) + prefixBytes, headerTextBytes_};
}

std::uint32_t ModelFile::checksum() const noexcept {
    return crc32(bytes_);
}

const Tier* ModelFile::findTier(std::string_view name) const noexcept {
    return findByName(header_.tiers, name);
}

const Blob* ModelFile::findBlob(std::string_view name) const noexcept {
    return findByName(header_.blobs, name);
}

const Blob& ModelFile::requireBlob(std::string_view name) const {
    const Blob* found = findBlob(name);
    if (found == nullptr) {
        throw std::out_of_range("the model has no blob \"" + std::string(name) + '"');
    }
    return *found;
}

std::span<const std::byte> ModelFile::blob(std::string_view name) const {
    const Blob& found = requireBlob(name);
    return std::span(bytes_).subspan(found.offset, found.bytes);
}

std::vector<float> ModelFile::tensor(std::string_view name) const {
    return readTensor(bytes_, requireBlob(name));
}

std::span<const float, embeddingSize> ModelFile::embedding(std::size_t label) const {
    const std::size_t row = header_.labels.at(label).embeddingRow;
    return std::span(embeddings_).subspan(row * embeddingSize).first<embeddingSize>();
}

std::span<const float> ModelFile::pieceOffsets(std::size_t label) const {
    const std::size_t count = piecesPerLabel_ * textureSize;
    return std::span(pieces_).subspan(header_.labels.at(label).embeddingRow * count, count);
}

std::size_t ModelFile::nearestLabel(std::span<const float, embeddingSize> embedding) const {
    const auto distance = [&](const Label& label) {
        const auto own = std::span(embeddings_).subspan(label.embeddingRow * embeddingSize);
        double squares = 0.0;
        for (std::size_t i = 0; i < textureSize; ++i) {
            const double gap = static_cast<double>(own[i]) - static_cast<double>(embedding[i]);
            squares += gap * gap;
        }
        return squares;
    };
    const auto nearest = std::ranges::min_element(header_.labels, {}, distance);
    return static_cast<std::size_t>(nearest - header_.labels.begin());
}

std::span<const float, seedSamples> ModelFile::seed(std::size_t seed) const {
    if (seed >= header_.seeds.size()) {
        throw std::out_of_range("the model has " + std::to_string(header_.seeds.size()) + " seeds, not seed " +
                                std::to_string(seed));
    }
    return std::span(seeds_).subspan(seed * seedSamples).first<seedSamples>();
}

}  // namespace haptoflow::model
