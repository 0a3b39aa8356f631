#include "model/header_node.hpp"
#include "refusal.hpp"

namespace haptoflow::model::testing {
namespace {

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

TEST(JsonLimitsTest, JsonThatEndsEarlyIsDamaged) {
    ModelBuilder builder;
    replaceHeader(builder, R"({"name": })");
    expectRefusal(builder.build(), ModelStatus::damaged, "valid JSON");
}

TEST(JsonLimitsTest, ASecondValueAfterTheObjectIsRefused) {
    ModelBuilder builder;
    replaceHeader(builder, R"({} {})");
    expectRefusal(builder.build(), ModelStatus::damaged, "valid JSON");
}

TEST(JsonLimitsTest, TextThatIsNotUtf8IsRefused) {
    ModelBuilder builder;
    replaceHeader(builder, "{\"name\": \"\xFF\xFE\"}");
    expectRefusal(builder.build(), ModelStatus::damaged, "valid JSON");
}

TEST(JsonLimitsTest, NumbersBeyondTheRangeOfDoubleAreRefused) {
    ModelBuilder builder;
    replaceHeader(builder, R"({"name": 1e999})");
    expectRefusal(builder.build(), ModelStatus::damaged, "valid JSON");
}

TEST(JsonLimitsTest, NanAndInfinityAreRefused) {
    for (const char* word : {"NaN", "Infinity", "-Infinity"}) {
        ModelBuilder builder;
        replaceHeader(builder, std::string(R"({"sample_rate_hz": )") + word + "}");
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

}  // namespace
}  // namespace haptoflow::model::testing
