#include "refusal.hpp"

#include <limits>

namespace haptoflow::model::testing {
namespace {

using Json = nlohmann::json;

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
    ModelBuilder builder;
    std::vector<float> seeds(3 * seedSamples, 1.0F);
    std::fill(seeds.begin() + 2 * seedSamples, seeds.end(), 1.02F);
    builder.blobs[1].bytes = bytesOf(seeds);
    expectRefusal(builder.build(), ModelStatus::inconsistent, "seed 2 has an RMS");
}

TEST(TensorTest, ASilentSeedIsRefused) {
    ModelBuilder builder;
    builder.blobs[1].bytes = Bytes(3 * seedSamples * sizeof(float));
    expectRefusal(builder.build(), ModelStatus::inconsistent, "seed 0 has an RMS");
}

TEST(TensorTest, UnusedTensorsAreChecked) {
    ModelBuilder builder;
    builder.blobs.push_back({"extra", "float32", {1}, bytesOf({std::numeric_limits<float>::quiet_NaN()})});
    expectRefusal(builder.build(), ModelStatus::inconsistent, "\"extra\"");
}

}  // namespace
}  // namespace haptoflow::model::testing
