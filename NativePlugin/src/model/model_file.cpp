#include "model/model_file.hpp"

#include "model/file_layout.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

namespace haptoflow::model {
namespace {

template <typename Element>
const Element* findByName(const std::vector<Element>& elements, std::string_view name) noexcept {
    const auto found =
        std::find_if(elements.begin(), elements.end(), [name](const Element& each) { return each.name == name; });
    return found != elements.end() ? &*found : nullptr;
}

/// Throws ModelError (damaged) unless the bytes from `begin` to `end` are zero.
void requireZero(std::span<const std::byte> file, std::size_t begin, std::size_t end) {
    const auto gap = file.subspan(begin, end - begin);
    const auto stray = std::find_if(gap.begin(), gap.end(), [](std::byte value) { return value != std::byte{0}; });
    if (stray != gap.end()) {
        throw ModelError(ModelStatus::damaged,
                         "byte " + std::to_string(begin + static_cast<std::size_t>(stray - gap.begin())) +
                             " lies between blobs and is not zero");
    }
}

/// Checks that the blobs lie inside `file` after `headerEnd`, do not overlap and match their checksums, and that every
/// byte outside them is zero. Throws ModelError.
void checkBlobBytes(std::span<const std::byte> file, std::size_t headerEnd, const std::vector<Blob>& blobs) {
    std::vector<const Blob*> inOrder;
    inOrder.reserve(blobs.size());
    for (const Blob& blob : blobs) {
        inOrder.push_back(&blob);
    }
    std::sort(inOrder.begin(), inOrder.end(),
              [](const Blob* left, const Blob* right) { return left->offset < right->offset; });

    std::size_t covered = headerEnd;
    for (const Blob* blob : inOrder) {
        if (blob->offset < covered) {
            throw ModelError(ModelStatus::inconsistent, "blob \"" + blob->name + "\" at byte " +
                                                            std::to_string(blob->offset) +
                                                            " overlaps what ends at byte " + std::to_string(covered));
        }
        if (blob->offset > file.size() || blob->bytes > file.size() - blob->offset) {
            throw ModelError(ModelStatus::inconsistent,
                             "blob \"" + blob->name + "\" at byte " + std::to_string(blob->offset) + " of " +
                                 std::to_string(blob->bytes) + " bytes reaches beyond the end of the file");
        }
        requireZero(file, covered, blob->offset);
        if (crc32(file.subspan(blob->offset, blob->bytes)) != blob->crc32) {
            throw ModelError(ModelStatus::damaged, "blob \"" + blob->name + "\" at byte " +
                                                       std::to_string(blob->offset) +
                                                       " does not match its checksum: get the file again");
        }
        covered = blob->offset + blob->bytes;
    }
    requireZero(file, covered, file.size());
}

/// The numbers of a float32 blob of `file`. Throws ModelError (inconsistent) if one is not finite or has a magnitude
/// above 1e6.
std::vector<float> readTensor(std::span<const std::byte> file, const Blob& blob) {
    const auto bytes = file.subspan(blob.offset, blob.bytes);
    std::vector<float> values(blob.bytes / sizeof(float));
    for (std::size_t index = 0; index < values.size(); ++index) {
        const std::uint64_t bits = readUnsigned(bytes.subspan(index * sizeof(float), sizeof(float)));
        values[index] = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
        // In this form the condition is also true for NaN.
        if (!(std::fabs(values[index]) <= maximumMagnitude)) {
            throw ModelError(ModelStatus::inconsistent, "tensor \"" + blob.name + "\": number " +
                                                            std::to_string(index) +
                                                            " is not finite or above 1e6 in magnitude");
        }
    }
    return values;
}

/// Checks that every row of seedSamples numbers has an RMS of 1 within 1 %. Throws ModelError (inconsistent).
void checkSeedRows(std::span<const float> seeds) {
    for (std::size_t row = 0; row < seeds.size() / seedSamples; ++row) {
        const auto seed = seeds.subspan(row * seedSamples, seedSamples);
        if (!isUnitRms(seed)) {
            throw ModelError(ModelStatus::inconsistent, "seed " + std::to_string(row) + " has an RMS of " +
                                                            std::to_string(rmsOf(seed)) + "; expected 1 within 1 %");
        }
    }
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
        return parse(readFile(path, maximumFileBytes));
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
