#include "model/file_layout.hpp"
#include "model/header_node.hpp"
#include "refusal.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <span>
#include <string_view>

namespace haptoflow::model::testing {
namespace {

using Json = nlohmann::json;

constexpr std::size_t versionOffset = 8;
constexpr std::size_t headerLengthOffset = 12;
constexpr std::size_t fileLengthOffset = 16;

Bytes validFile() {
    return ModelBuilder().build();
}

TEST(FileLayoutTest, AnEmptyFileIsTruncatedAndOneWithAnotherMagicIsNotAModel) {
    expectRefusal({}, ModelStatus::truncated, "0 bytes");
    Bytes file = validFile();
    file[7] = std::byte{'X'};
    expectRefusal(file, ModelStatus::notAModel, "HAPTFLOW");
    expectRefusal({std::byte{'R'}, std::byte{'I'}, std::byte{'F'}, std::byte{'F'}}, ModelStatus::notAModel, "HAPTFLOW");
}

TEST(FileLayoutTest, AValidFileCutAtAnyLengthIsRefused) {
    const Bytes file = validFile();
    for (std::size_t length = 0; length < file.size(); length += 13) {
        expectRefusal(Bytes(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(length)), ModelStatus::truncated,
                      "bytes");
    }
}

TEST(FileLayoutTest, AnAppendedByteIsRefused) {
    Bytes file = validFile();
    file.push_back(std::byte{0});
    expectRefusal(file, ModelStatus::inconsistent, "appended");
}

TEST(FileLayoutTest, ANewerVersionIsRefusedWithTheRemedy) {
    Bytes file = validFile();
    writeUnsigned(file, versionOffset, 4, formatVersion + 1);
    resealPrefix(file);
    expectRefusal(file, ModelStatus::tooNew,
                  "version " + std::to_string(formatVersion + 1) + " at byte 8; this reader knows version " +
                      std::to_string(formatVersion) + ": update HaptoFlow");
}

TEST(FileLayoutTest, AnOlderVersionIsRefusedWithTheCommandThatMakesANewFile) {
    for (std::uint32_t version = 0; version < formatVersion; ++version) {
        Bytes file = validFile();
        writeUnsigned(file, versionOffset, 4, version);
        resealPrefix(file);
        expectRefusal(file, ModelStatus::inconsistent,
                      "version " + std::to_string(version) + " at byte 8; this reader knows version " +
                          std::to_string(formatVersion) +
                          ": make the file again from its training run with `haptoflow-training export`");
    }
}

TEST(FileLayoutTest, AFileWithAFlippedVersionBitIsDamagedAndNotNewer) {
    Bytes file = validFile();
    file[versionOffset] ^= std::byte{0x40};
    expectRefusal(file, ModelStatus::damaged, "checksum at byte 28");
}

TEST(FileLayoutTest, LengthsThatDoNotFitAreRefused) {
    struct Length {
        std::size_t offset;
        std::size_t bytes;
        std::uint64_t value;
        ModelStatus status;
        const char* part;
    };
    const std::uint64_t header = readUnsigned(validFile(), headerLengthOffset, 4);
    for (const Length& length : {
             Length{headerLengthOffset, 4, 4'194'305, ModelStatus::oversized, "4194305"},
             Length{headerLengthOffset, 4, 1, ModelStatus::inconsistent, "header length 1"},
             Length{headerLengthOffset, 4, 4'194'272, ModelStatus::inconsistent, "inside the file"},
             Length{headerLengthOffset, 4, header - 1, ModelStatus::inconsistent, "multiple of 64"},
             Length{fileLengthOffset, 8, 268'435'457, ModelStatus::oversized, "268435457"},
             Length{fileLengthOffset, 8, ~std::uint64_t{0}, ModelStatus::oversized, "18446744073709551615"},
             Length{fileLengthOffset, 8, 3, ModelStatus::inconsistent, "says 3 bytes"},
         }) {
        Bytes file = validFile();
        writeUnsigned(file, length.offset, length.bytes, length.value);
        if (length.value == header - 1) {
            resealHeader(file);
        }
        resealPrefix(file);
        expectRefusal(file, length.status, length.part);
    }
}

TEST(FileLayoutTest, AHeaderThatDoesNotMatchItsChecksumIsRefused) {
    Bytes file = validFile();
    file[40] ^= std::byte{1};
    expectRefusal(file, ModelStatus::damaged, "checksum at byte 24");
}

TEST(FileLayoutTest, AHeaderThatIsNoObjectFollowedBySpacesIsRefused) {
    const auto refuse = [](void (*edit)(std::string&), const char* part) {
        ModelBuilder builder;
        builder.editText = edit;
        expectRefusal(builder.build(), ModelStatus::inconsistent, part);
    };
    refuse([](std::string& text) { text.back() = '\n'; }, "spaces");
    refuse([](std::string& text) { text.assign(text.size(), ' '); }, "one object");
    refuse([](std::string& text) { text = "[]" + std::string(text.size() - 2, ' '); }, "one object");
}

TEST(Crc32Test, AgreesWithZlibAndThePublishedValue) {
    const auto crcOf = [](std::string_view text) { return crc32(std::as_bytes(std::span(text.data(), text.size()))); };
    EXPECT_EQ(crcOf("123456789"), 0xCBF43926U);
    EXPECT_EQ(crcOf(""), 0U);
    EXPECT_EQ(crcOf("The quick brown fox jumps over the lazy dog"), 0x414FA339U);
    std::array<std::byte, 256> bytes{};
    for (std::size_t index = 0; index < bytes.size(); ++index) {
        bytes.at(index) = static_cast<std::byte>(index);
    }
    EXPECT_EQ(crc32(bytes), 0x29058C73U);
}

void replaceHeader(ModelBuilder& builder, const std::string& replacement) {
    builder.editText = [replacement](std::string& text) {
        const std::size_t length = text.size();
        text = replacement;
        text.resize(length, ' ');
    };
}

std::string nested(int levels) {
    std::string text = "{\"a\":";
    for (int level = 1; level < levels; ++level) {
        text += '[';
    }
    return text + std::string(static_cast<std::size_t>(levels - 1), ']') + '}';
}

TEST(JsonLimitsTest, WhatIsNotOneJsonValueIsDamaged) {
    for (const char* text : {R"({"name": })", R"({} {})", "{\"name\": \"\xFF\xFE\"}", R"({"name": 1e999})",
                             R"({"sample_rate_hz": NaN})", R"({"sample_rate_hz": -Infinity})"}) {
        ModelBuilder builder;
        replaceHeader(builder, text);
        expectRefusal(builder.build(), ModelStatus::damaged, "valid JSON");
    }
}

TEST(JsonLimitsTest, ADuplicateKeyIsRefused) {
    ModelBuilder builder;
    replaceHeader(builder, R"({"name": "a", "name": "b"})");
    expectRefusal(builder.build(), ModelStatus::inconsistent, "\"name\" twice");
}

TEST(JsonLimitsTest, TheSameKeyInDifferentObjectsIsAccepted) {
    EXPECT_NO_THROW((void)parseBoundedJson(R"({"a": {"a": 1}, "b": [{"a": 1}, {"a": 2}]})"));
}

TEST(JsonLimitsTest, TheMaximumNestingIsAcceptedAndOneLevelMoreRefused) {
    EXPECT_NO_THROW((void)parseBoundedJson(nested(maximumJsonDepth)));
    ModelBuilder builder;
    replaceHeader(builder, nested(maximumJsonDepth + 1));
    expectRefusal(builder.build(), ModelStatus::oversized, "deeper than 32");
}

TEST(JsonLimitsTest, AMillionOpenBracketsAreRefusedBeforeAnyValueIsBuilt) {
    const std::string text = "{\"a\":" + std::string(1'000'000, '[');
    EXPECT_THROW((void)parseBoundedJson(text), ModelError);
}

TEST(BlobTest, ABlobWithAMissingKeyIsRefused) {
    for (const char* key : {"name", "type", "shape", "offset", "bytes", "crc32"}) {
        expectBlobRefusal([key](Json& blobs) { blobs[1].erase(key); }, key);
    }
}

TEST(BlobTest, MoreBlobsThanTheLimitAreRefused) {
    ModelBuilder builder;
    builder.blobs.assign(maximumBlobs + 1, {"a", "onnx", {}, Bytes(1)});
    expectRefusal(builder.build(), ModelStatus::oversized, "the limit is 1024");
}

TEST(BlobTest, InvalidEntriesAreRefusedByKey) {
    expectBlobRefusal([](Json& blobs) { blobs[3]["name"] = ""; }, "blobs[3].name");
    expectBlobRefusal([](Json& blobs) { blobs[3]["name"] = "field"; }, "appears twice");
    expectBlobRefusal([](Json& blobs) { blobs[0]["type"] = "float16"; }, "\"float32\"");
    expectBlobRefusal([](Json& blobs) { blobs[2]["offset"] = blobs[2]["offset"].get<int>() + 4; }, "blobs[2].offset");
    expectBlobRefusal([](Json& blobs) { blobs[0]["offset"] = 64; }, "overlaps");
    expectBlobRefusal([](Json& blobs) { blobs[1]["offset"] = blobs[0]["offset"]; }, "overlaps");
    expectBlobRefusal([](Json& blobs) { blobs[3]["bytes"] = 38; }, "beyond the end");
    expectBlobRefusal([](Json& blobs) { blobs[3]["offset"] = 64 * 1024 * 1024; }, "beyond the end");
    expectBlobRefusal([](Json& blobs) { blobs[2]["bytes"] = 0; }, "blobs[2].bytes");
    expectBlobRefusal([](Json& blobs) { blobs[0]["shape"] = {3, 64}; }, "blobs[0].bytes");
    expectBlobRefusal([](Json& blobs) { blobs[0]["shape"] = {1LL << 26, 1LL << 26, 1LL << 26}; }, "blobs[0].shape");
    expectBlobRefusal([](Json& blobs) { blobs[0]["shape"] = {1LL << 33, 1LL << 31}; }, "blobs[0].shape[0]");
    expectBlobRefusal([](Json& blobs) { blobs[0]["shape"] = {0, 64}; }, "blobs[0].shape[0]");
    expectBlobRefusal([](Json& blobs) { blobs[0]["shape"] = {-2, -64}; }, "blobs[0].shape[0]");
    expectBlobRefusal([](Json& blobs) { blobs[0]["shape"] = Json::array(); }, "blobs[0].shape");
    expectBlobRefusal([](Json& blobs) { blobs[2]["shape"] = {100}; }, "blobs[2].shape");
    expectBlobRefusal([](Json& blobs) { blobs[0]["crc32"] = 1LL << 32; }, "blobs[0].crc32");
    expectBlobRefusal([](Json& blobs) { blobs[0]["name"] = "embeddings"; }, "\"embedding\"");
}

TEST(BlobTest, LengthsThatWouldOverflowAreRefused) {
    for (const Json& value : {Json(UINT64_MAX), Json(INT64_MIN), Json(-64), Json(INT64_MAX - 63), Json(1e300)}) {
        expectBlobRefusal([&value](Json& blobs) { blobs[2]["offset"] = value; }, "blobs[2].offset");
        expectBlobRefusal([&value](Json& blobs) { blobs[2]["bytes"] = value; }, "blobs[2].bytes");
    }
}

TEST(BlobTest, ABlobThatDoesNotMatchItsChecksumIsRefused) {
    Bytes file = ModelBuilder().build();
    file.back() ^= std::byte{1};
    expectRefusal(file, ModelStatus::damaged, "\"level\"");
}

TEST(BlobTest, GapsThatAreNotZeroAreRefused) {
    ModelBuilder builder;
    std::size_t gap = 0;
    builder.editLaidOut = [&gap](Json& header) { gap = header["blobs"][3]["offset"].get<std::size_t>() - 1; };
    Bytes file = builder.build();
    file.at(gap) = std::byte{1};
    expectRefusal(file, ModelStatus::damaged, "byte " + std::to_string(gap));
}

TEST(BlobTest, BytesAfterTheLastBlobThatAreNotZeroAreRefused) {
    Bytes file = ModelBuilder().build();
    file.push_back(std::byte{7});
    writeUnsigned(file, 16, 8, file.size());
    resealPrefix(file);
    expectRefusal(file, ModelStatus::damaged, "not zero");
}

TEST(BlobTest, BlobsMayBeListedInAnyOrder) {
    ModelBuilder builder;
    builder.editLaidOut = [](Json& header) { std::reverse(header["blobs"].begin(), header["blobs"].end()); };
    EXPECT_NO_THROW((void)ModelFile::parse(builder.build()));
}

TEST(BlobTest, PiecesOfAnotherShapeThanTheEmbeddingsAreRefused) {
    const std::vector<std::vector<std::int64_t>> shapes{{3, 1, 60}, {1, 1, 60}, {2, 257, 60}, {2, 1, 64}, {2, 60}};
    for (const std::vector<std::int64_t>& shape : shapes) {
        std::size_t count = 1;
        for (const std::int64_t dimension : shape) {
            count *= static_cast<std::size_t>(dimension);
        }
        ModelBuilder builder;
        builder.blobs.push_back({"pieces", "float32", shape, bytesOf(std::vector<float>(count))});
        expectRefusal(builder.build(), ModelStatus::inconsistent, "shape [2, 1 to 256, 60]");
    }
    ModelBuilder graph;
    graph.blobs.push_back({"pieces", "onnx", {}, Bytes(10, std::byte{1})});
    expectRefusal(graph.build(), ModelStatus::inconsistent, "\"pieces\" of type \"float32\"");
}

TEST(TensorTest, NumbersThatAreNotFiniteAreRefused) {
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                              -std::numeric_limits<float>::infinity(), 1e7F}) {
        ModelBuilder builder;
        std::vector<float> embedding(2 * embeddingSize, 0.5F);
        embedding[70] = value;
        builder.blobs[0].bytes = bytesOf(embedding);
        expectRefusal(builder.build(), ModelStatus::inconsistent, "\"embedding\": number 70");
    }
}

TEST(TensorTest, ASeedWhoseRmsIsNotOneIsRefused) {
    for (const float amplitude : {1.02F, 0.0F}) {
        ModelBuilder builder;
        std::vector<float> seeds(3 * seedSamples, 1.0F);
        std::fill(seeds.begin() + 2 * seedSamples, seeds.end(), amplitude);
        builder.blobs[1].bytes = bytesOf(seeds);
        expectRefusal(builder.build(), ModelStatus::inconsistent, "seed 2 has an RMS");
    }
}

TEST(TensorTest, UnusedTensorsAreChecked) {
    ModelBuilder builder;
    builder.blobs.push_back({"extra", "float32", {1}, bytesOf({std::numeric_limits<float>::quiet_NaN()})});
    expectRefusal(builder.build(), ModelStatus::inconsistent, "\"extra\"");
}

}  // namespace
}  // namespace haptoflow::model::testing
