#include "model/model_blobs.hpp"

#include "model/file_layout.hpp"
#include "model/header_node.hpp"
#include "model/model_error.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

namespace haptoflow::model {
namespace {

constexpr auto maximumLength = static_cast<std::int64_t>(maximumFileBytes);

std::vector<std::int64_t> readShape(const HeaderNode& node) {
    std::vector<std::int64_t> shape;
    std::int64_t product = 1;
    for (const HeaderNode& dimension : node.elements(1, maximumTensorRank)) {
        shape.push_back(dimension.integer(1, maximumLength / 4));
        // Both factors are below 2^28, so that the product does not overflow before the comparison.
        product *= shape.back();
        if (product > maximumLength / 4) {
            node.refuse("a tensor that fits into a file of 268435456 bytes");
        }
    }
    return shape;
}

void requireZero(std::span<const std::byte> file, std::size_t begin, std::size_t end) {
    const auto gap = file.subspan(begin, end - begin);
    const auto stray = std::find_if(gap.begin(), gap.end(), [](std::byte value) { return value != std::byte{0}; });
    if (stray != gap.end()) {
        throw ModelError(ModelStatus::damaged,
                         "byte " + std::to_string(begin + static_cast<std::size_t>(stray - gap.begin())) +
                             " lies between blobs and is not zero");
    }
}

}  // namespace

Blob readBlob(const HeaderNode& node) {
    Blob blob;
    blob.name = node.at("name").name(nameBytes);
    const HeaderNode type = node.at("type");
    const std::string word = type.text(nameBytes);
    blob.bytes = static_cast<std::size_t>(node.at("bytes").integer(1, maximumLength));
    const HeaderNode offset = node.at("offset");
    blob.offset = static_cast<std::size_t>(offset.integer(0, maximumLength));
    if (blob.offset % blobAlignment != 0) {
        offset.refuse("a multiple of 64");
    }
    blob.crc32 = static_cast<std::uint32_t>(node.at("crc32").integer(0, 0xFFFFFFFF));
    if (word == "onnx") {
        blob.type = BlobType::onnx;
        const HeaderNode shape = node.at("shape");
        if (!shape.elements(0, maximumTensorRank).empty()) {
            shape.refuse("[], because the blob is a graph");
        }
        return blob;
    }
    if (word != "float32") {
        type.refuse("\"float32\" or \"onnx\"");
    }
    blob.type = BlobType::float32;
    blob.shape = readShape(node.at("shape"));
    std::size_t count = 1;
    for (const std::int64_t dimension : blob.shape) {
        count *= static_cast<std::size_t>(dimension);
    }
    if (blob.bytes != count * sizeof(float)) {
        node.at("bytes").refuse("4 times the product of the shape (" + std::to_string(count * sizeof(float)) + ')');
    }
    return blob;
}

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

namespace {

constexpr double seedRmsTolerance = 0.01;

float readFloat(std::span<const std::byte> bytes) {
    std::uint32_t bits = 0;
    for (std::size_t index = sizeof(float); index > 0; --index) {
        bits = (bits << 8U) | std::to_integer<std::uint32_t>(bytes[index - 1]);
    }
    return std::bit_cast<float>(bits);
}

double rmsOf(std::span<const float> samples) {
    double sumOfSquares = 0.0;
    for (const float value : samples) {
        sumOfSquares += static_cast<double>(value) * static_cast<double>(value);
    }
    return std::sqrt(sumOfSquares / static_cast<double>(samples.size()));
}

}  // namespace

std::vector<float> readTensor(std::span<const std::byte> file, const Blob& blob) {
    const auto bytes = file.subspan(blob.offset, blob.bytes);
    std::vector<float> values(blob.bytes / sizeof(float));
    for (std::size_t index = 0; index < values.size(); ++index) {
        values[index] = readFloat(bytes.subspan(index * sizeof(float), sizeof(float)));
        // In this form the condition is also true for NaN.
        if (!(std::fabs(values[index]) <= maximumMagnitude)) {
            throw ModelError(ModelStatus::inconsistent, "tensor \"" + blob.name + "\": number " +
                                                            std::to_string(index) +
                                                            " is not finite or above 1e6 in magnitude");
        }
    }
    return values;
}

bool isUnitRms(std::span<const float> samples) {
    return std::fabs(rmsOf(samples) - 1.0) <= seedRmsTolerance;
}

void checkSeedRows(std::span<const float> seeds) {
    for (std::size_t row = 0; row < seeds.size() / seedSamples; ++row) {
        const auto seed = seeds.subspan(row * seedSamples, seedSamples);
        if (!isUnitRms(seed)) {
            throw ModelError(ModelStatus::inconsistent, "seed " + std::to_string(row) + " has an RMS of " +
                                                            std::to_string(rmsOf(seed)) + "; expected 1 within 1 %");
        }
    }
}

}  // namespace haptoflow::model
