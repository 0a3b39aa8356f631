#include "model/onnx_check.hpp"
#include "model/model_error.hpp"
#include "model/model_file.hpp"
#include "model/onnx_tensor.hpp"
#include "onnx_writer.hpp"
#include "random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

// Checks of a graph before ONNX Runtime loads it.

namespace haptoflow::model::testing {
namespace {

const std::string graphName = "tier \"draft\", graph \"level\"";

void expectGraphRefusal(const Bytes& bytes, const std::string& part, ModelStatus status = ModelStatus::inconsistent) {
    try {
        checkOnnxModel(bytes, graphName);
        ADD_FAILURE() << "the graph was accepted; expected a refusal that mentions: " << part;
    } catch (const ModelError& error) {
        EXPECT_EQ(error.status(), status) << error.what();
        EXPECT_THAT(error.what(), ::testing::StartsWith(graphName));
        EXPECT_THAT(error.what(), ::testing::HasSubstr(part));
    }
}

void expectGraphRefusal(const WireWriter& model, const std::string& part,
                        ModelStatus status = ModelStatus::inconsistent) {
    expectGraphRefusal(model.written(), part, status);
}

OnnxWriter plainLevel() {
    return levelGraph().apply("Identity", {"weighted"}, {"log_level"});
}

TEST(OnnxCheckTest, EveryGraphOfTheShippedModelIsAccepted) {
    const ModelFile model = ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
    int graphs = 0;
    for (const Blob& blob : model.header().blobs) {
        if (blob.type == BlobType::onnx) {
            EXPECT_NO_THROW(checkOnnxModel(model.blob(blob.name), blob.name));
            ++graphs;
        }
    }
    EXPECT_EQ(graphs,
              std::ranges::count_if(model.header().tiers, [](const Tier& tier) { return !tier.field.empty(); }));
    EXPECT_GE(graphs, 2) << "a refinement for each tier with a network";
}

TEST(OnnxCheckTest, EveryKindOfTierOfTheTinyModelIsAccepted) {
    const ModelFile model = ModelFile::read(HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow");
    for (const Tier& tier : model.header().tiers) {
        for (const std::string& graph : {tier.field, tier.level, tier.encoder, tier.decoder}) {
            if (!graph.empty()) {
                EXPECT_NO_THROW(checkOnnxModel(model.blob(graph), graph));
            }
        }
    }
}

TEST(OnnxCheckTest, ALoopIsRefusedByNameWithTheRemedy) {
    expectGraphRefusal(loopingLevel(),
                       "uses the operator \"Loop\", which model files may not contain: export it with the");
    expectGraphRefusal(loopingLevel(), "Documentation~/model-format.md");
}

TEST(OnnxCheckTest, OperatorsThatContainGraphsOrDeriveSizesFromValuesAreNotInTheList) {
    for (const char* type :
         {"Loop", "Scan", "If", "SequenceMap", "Tile", "Range", "Resize", "Upsample", "OneHot", "NonZero", "EyeLike",
          "RandomNormal", "StringNormalizer", "Optional", "", "loop", "Loop "}) {
        expectGraphRefusal(levelGraph().apply(type, {"weighted"}, {"log_level"}).model(), "uses the operator");
    }
}

TEST(OnnxCheckTest, TheDocumentationListsTheOperatorsAndNoOthers) {
    std::ifstream stream(HAPTOFLOW_TEST_DOCUMENTATION_DIR "/model-format.md");
    const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    const std::string head = "### Operators\n";
    const std::size_t begin = text.find(head);
    ASSERT_NE(begin, std::string::npos);
    const std::size_t first = text.find("```\n", begin) + 4;
    const auto wordsOf = [](const std::string& words) {
        std::istringstream each(words);
        return std::set<std::string>{std::istream_iterator<std::string>(each), {}};
    };
    EXPECT_EQ(wordsOf(text.substr(first, text.find("```", first) - first)), wordsOf(std::string(allowedOperators)));
}

TEST(OnnxCheckTest, AGraphInsideAnAllowedOperatorIsRefused) {
    const WireWriter inner = OnnxWriter().graph;
    for (const std::uint32_t field : {6U, 11U, 10U, 14U, 15U, 21U, 22U, 23U}) {
        const WireWriter attribute = WireWriter().text(1, "body").message(field, inner);
        expectGraphRefusal(levelGraph().apply("Identity", {"weighted"}, {"log_level"}, {attribute}).model(),
                           "the operator \"Identity\" has an attribute");
    }
}

TEST(OnnxCheckTest, ADomainOtherThanOnnxIsRefusedWhereItIsImportedAndWhereItIsUsed) {
    expectGraphRefusal(plainLevel().model().message(8, OnnxWriter::opsetOf(1, "com.microsoft")), "\"com.microsoft\"");
    expectGraphRefusal(levelGraph().apply("Add", {"weighted", "weighted"}, {"log_level"}, {}, "com.microsoft").model(),
                       "uses the operator \"Add\" of the domain \"com.microsoft\"");
    EXPECT_NO_THROW(checkOnnxModel(plainLevel().model(16, "ai.onnx").written(), graphName));
}

TEST(OnnxCheckTest, AnotherOpsetIsRefusedWithTheExpectedOne) {
    expectGraphRefusal(plainLevel().model(17), "opset 17; export it for opset 16");
    expectGraphRefusal(plainLevel().model(0), "opset 0");
    expectGraphRefusal(WireWriter().message(7, plainLevel().graph), "is not an ONNX model");
}

TEST(OnnxCheckTest, FunctionsTrainingAndFieldsOfLaterVersionsAreRefused) {
    for (const std::uint32_t field : {20U, 25U, 26U, 99U}) {
        expectGraphRefusal(plainLevel().model().message(field, WireWriter()),
                           "its model has the field " + std::to_string(field));
    }
    OnnxWriter sparse = plainLevel();
    sparse.graph.message(15, WireWriter());
    expectGraphRefusal(sparse.model(), "its graph has the field 15");
}

TEST(OnnxCheckTest, NoGraphAndTwoGraphsAreRefused) {
    expectGraphRefusal(WireWriter().message(8, OnnxWriter::opsetOf(16, "")), "must have one graph");
    expectGraphRefusal(plainLevel().model().message(7, plainLevel().graph), "must have one graph");
    expectGraphRefusal(Bytes{}, "must have one graph");
}

TEST(OnnxCheckTest, ATensorInAnotherFileIsRefused) {
    const WireWriter entry = WireWriter().text(1, "location").text(2, "/etc/passwd");
    const Bytes four(4);
    for (const WireWriter& tensor : {rawTensor("w", onnxFloat, {1}, four).message(13, entry),
                                     rawTensor("w", onnxFloat, {1}, four).number(14, 1)}) {
        expectGraphRefusal(plainLevel().constant(tensor).model(), "the tensor \"w\" is in another file");
    }
}

TEST(OnnxCheckTest, ATensorThatDoesNotMatchItsDimensionsIsRefused) {
    const std::string part = "has another number of values than its dimensions";
    for (const Dimensions& dimensions :
         {Dimensions{3}, Dimensions{2, 2}, Dimensions{-1}, Dimensions{0}, Dimensions{1000000000, 1000000000},
          Dimensions{std::int64_t{1} << 62, 4}, Dimensions{INT64_MIN}}) {
        expectGraphRefusal(plainLevel().constant(rawTensor("w", onnxFloat, dimensions, Bytes(8))).model(), part);
    }
    expectGraphRefusal(plainLevel().constant(rawTensor("w", onnxInt64, {2}, Bytes(8))).model(), part);
    expectGraphRefusal(plainLevel().constant(rawTensor("w", onnxFloat, {2}, Bytes(8)).number(4, 1)).model(), part);
    EXPECT_NO_THROW(
        checkOnnxModel(plainLevel().constant(rawTensor("w", onnxFloat, {2}, Bytes(8))).model().written(), graphName));
}

TEST(OnnxCheckTest, NumbersOutsideTheRawBytesAreCounted) {
    const auto tensor = [](std::uint64_t type, std::int64_t count) {
        return WireWriter().number(1, static_cast<std::uint64_t>(count)).number(2, type).text(8, "w");
    };
    const Bytes packed{std::byte{0x01}, std::byte{0x80}, std::byte{0x01}, std::byte{0x02}};
    for (const WireWriter& fitting : {tensor(onnxFloat, 2).bytes(4, Bytes(8)), tensor(onnxInt64, 3).bytes(7, packed),
                                      tensor(onnxInt64, 2).number(7, 5).number(7, 6), tensor(onnxInt64, 0)}) {
        EXPECT_EQ(readOnnxTensor(fitting.written()).problem, "");
    }
    for (const WireWriter& wrong :
         {tensor(onnxFloat, 3).bytes(4, Bytes(8)), tensor(onnxInt64, 4).bytes(7, packed), tensor(onnxInt64, 1)}) {
        EXPECT_THAT(readOnnxTensor(wrong.written()).problem, ::testing::HasSubstr("another number of values"));
    }
}

TEST(OnnxCheckTest, TensorsOfTextAndOfUnknownTypesAreRefused) {
    expectGraphRefusal(plainLevel().constant(rawTensor("w", 8, {1}, Bytes(4))).model(), "is of type 8");
    expectGraphRefusal(plainLevel().constant(rawTensor("w", 99, {1}, Bytes(4))).model(), "is of type 99");
}

TEST(OnnxCheckTest, ATensorInAnAttributeIsCheckedLikeAnInitialiser) {
    const WireWriter attribute =
        WireWriter().text(1, "value").message(5, rawTensor("", onnxFloat, {9}, Bytes(4))).number(20, 4);
    expectGraphRefusal(levelGraph().apply("Constant", {}, {"c"}, {attribute}).model(), "another number of values");
}

TEST(OnnxCheckTest, ASizeThatDependsOnTheContentOfAnInputIsRefused) {
    for (const char* type : {"ConstantOfShape", "Expand", "Pad", "Reshape", "Slice"}) {
        OnnxWriter writer = levelGraph();
        writer.apply("Cast", {"weighted"}, {"size"}, {integerAttribute("to", 7)});
        const Names inputs = std::string(type) == "ConstantOfShape" ? Names{"size"} : Names{"weighted", "size"};
        expectGraphRefusal(
            writer.apply(type, inputs, {"log_level"}).model(),
            std::string("the operator \"") + type + "\" takes a size from the content of the graph's inputs");
    }
}

TEST(OnnxCheckTest, ASizeThatDependsOnTheShapeOfAnInputIsAccepted) {
    OnnxWriter writer = levelGraph();
    writer.apply("Shape", {"weighted"}, {"shape"}).apply("ConstantOfShape", {"shape"}, {"zeros"});
    EXPECT_NO_THROW(
        checkOnnxModel(writer.apply("Add", {"weighted", "zeros"}, {"log_level"}).model().written(), graphName));
}

TEST(OnnxCheckTest, ANameThatIsUsedBeforeItsDefinitionOrDefinedTwiceIsRefused) {
    expectGraphRefusal(levelGraph().apply("Add", {"weighted", "later"}, {"log_level"}).model(),
                       "\"Add\" reads \"later\" before it is defined");
    expectGraphRefusal(levelGraph().apply("Add", {"log_level", "weighted"}, {"log_level"}).model(),
                       "before it is defined");
    expectGraphRefusal(levelGraph().apply("Identity", {"motion"}, {"weighted"}).model(),
                       "\"weighted\" is defined twice");
    expectGraphRefusal(levelGraph().apply("Identity", {"weighted"}, {"motion"}).model(), "\"motion\" is defined twice");
}

TEST(OnnxCheckTest, TooManyOperatorsOrTensorsAreRefusedBeforeTheyAreRead) {
    OnnxWriter operators = levelGraph();
    for (std::size_t index = 0; index < maximumGraphNodes; ++index) {
        operators.graph.message(1, WireWriter());
    }
    expectGraphRefusal(operators.model(), "more than 16384 operators", ModelStatus::oversized);
    OnnxWriter tensors = levelGraph();
    for (std::size_t index = 0; index < maximumGraphTensors; ++index) {
        tensors.graph.message(13, WireWriter());
    }
    expectGraphRefusal(tensors.model(), "more than 65536 inputs and tensors", ModelStatus::oversized);
}

TEST(OnnxCheckTest, AMessageContainsNoControlCharactersOfAFile) {
    expectGraphRefusal(levelGraph().apply("\x1b[2J\n" + std::string(500, 'x'), {"weighted"}, {"log_level"}).model(),
                       "uses the operator \"?[2J?" + std::string(59, 'x') + "\", which");
}

TEST(WireReaderTest, EveryEncodingIsRead) {
    const Bytes bytes{std::byte{0x08}, std::byte{0xAC}, std::byte{0x02}, std::byte{0x11}, std::byte{1},
                      std::byte{0},    std::byte{0},    std::byte{0},    std::byte{0},    std::byte{0},
                      std::byte{0},    std::byte{0x80}, std::byte{0x1A}, std::byte{2},    std::byte{'o'},
                      std::byte{'k'},  std::byte{0x25}, std::byte{7},    std::byte{0},    std::byte{0},
                      std::byte{0}};
    WireReader reader(bytes);
    EXPECT_EQ(reader.next()->value, 300U);
    EXPECT_EQ(reader.next()->value, 0x8000000000000001U);
    EXPECT_EQ(reader.next()->text(), "ok");
    const auto last = reader.next();
    EXPECT_EQ(last->number, 4U);
    EXPECT_EQ(last->value, 7U);
    EXPECT_FALSE(reader.next().has_value());
}

TEST(WireReaderTest, LengthsBeyondTheEndLongNumbersAndUnknownEncodingsAreRefused) {
    const auto refuse = [](std::initializer_list<int> values, const std::string& part) {
        Bytes bytes;
        for (const int value : values) {
            bytes.push_back(static_cast<std::byte>(value));
        }
        WireReader reader(bytes);
        try {
            while (reader.next()) {
            }
            ADD_FAILURE() << "accepted; expected " << part;
        } catch (const WireError& error) {
            EXPECT_THAT(error.what(), ::testing::HasSubstr(part));
        }
    };
    refuse({0x0A, 0x05, 1, 2}, "beyond the end");
    refuse({0x0A, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x01}, "beyond the end");
    refuse({0x09, 1, 2, 3}, "beyond the end");
    refuse({0x08, 0x80}, "beyond the end");
    refuse({0x08, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x01}, "longer than ten bytes");
    refuse({0x0B}, "encoding that protobuf does not have");
    refuse({0x0E}, "encoding that protobuf does not have");
    refuse({0x02, 0}, "the number 0");
}

/// The shipped draft's graph, which has constants, initialisers and attributes, and two generated ones.
std::vector<Bytes> seedGraphs() {
    const ModelFile model = ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
    const auto shipped = model.blob(model.findTier("draft")->field);
    return {Bytes(shipped.begin(), shipped.end()), plainLevel().model().written(), loopingLevel()};
}

struct GraphOutcome {
    int accepted = 0;
    int refused = 0;

    void tryGraph(const Bytes& bytes) {
        try {
            checkOnnxModel(bytes, graphName);
            ++accepted;
        } catch (const ModelError& error) {
            EXPECT_THAT(error.what(), ::testing::StartsWith(graphName));
            ++refused;
        }
    }
};

TEST(OnnxMutationTest, ChangedBytesAreRefusedOrReadToTheEnd) {
    Random random(6);
    for (const Bytes& valid : seedGraphs()) {
        GraphOutcome outcome;
        for (int index = 0; index < 1000; ++index) {
            Bytes bytes = valid;
            for (std::size_t change = 0; change <= random.below(4); ++change) {
                // The first bytes hold the structure, the rest mostly weights.
                const std::size_t end = random.below(2) == 0 ? std::min<std::size_t>(bytes.size(), 4000) : bytes.size();
                bytes[random.below(end)] = static_cast<std::byte>(random.below(256));
            }
            outcome.tryGraph(bytes);
        }
        EXPECT_GT(outcome.refused, 0);
    }
}

TEST(OnnxMutationTest, CutAndJoinedGraphsAreRefusedOrReadToTheEnd) {
    Random random(7);
    const std::vector<Bytes> valid = seedGraphs();
    GraphOutcome outcome;
    for (std::size_t length = 0; length < valid[1].size(); ++length) {
        outcome.tryGraph(Bytes(valid[1].begin(), valid[1].begin() + static_cast<std::ptrdiff_t>(length)));
    }
    EXPECT_EQ(outcome.accepted, 0) << "the opset is at the end";
    for (int index = 0; index < 4000; ++index) {
        const Bytes& first = valid[random.below(valid.size())];
        const Bytes& second = valid[random.below(valid.size())];
        Bytes bytes(first.begin(), first.begin() + static_cast<std::ptrdiff_t>(random.below(first.size())));
        bytes.insert(bytes.end(), second.begin() + static_cast<std::ptrdiff_t>(random.below(second.size())),
                     second.end());
        outcome.tryGraph(bytes);
    }
    EXPECT_GT(outcome.refused, 3000);
}

TEST(OnnxMutationTest, NoiseIsRefused) {
    Random random(8);
    GraphOutcome outcome;
    for (int index = 0; index < 20'000; ++index) {
        Bytes bytes(random.below(64));
        for (std::byte& byte : bytes) {
            byte = static_cast<std::byte>(random.below(256));
        }
        outcome.tryGraph(bytes);
    }
    EXPECT_EQ(outcome.accepted, 0);
}

}  // namespace
}  // namespace haptoflow::model::testing
