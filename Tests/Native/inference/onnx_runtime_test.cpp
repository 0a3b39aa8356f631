#include "inference/onnx_runtime.hpp"

#include "inference/load_limits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <onnxruntime_c_api.h>

namespace haptoflow::inference {
namespace {

template <typename Action>
std::string refusalOf(Action action) {
    try {
        action();
    } catch (const RuntimeUnavailable& error) {
        return error.what();
    }
    ADD_FAILURE() << "no RuntimeUnavailable was thrown";
    return {};
}

const OrtApi* ORT_API_CALL noApi(std::uint32_t /*version*/) noexcept {
    return nullptr;
}

const char* ORT_API_CALL oldVersion() noexcept {
    return "1.2.3";
}

TEST(OnnxRuntimeTest, TheLibraryIsOpenedByPathAndItsVersionIsReported) {
    const auto runtime = Runtime::open(HAPTOFLOW_TEST_ONNXRUNTIME);
    EXPECT_THAT(runtime->version(), ::testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+.*"));
}

TEST(OnnxRuntimeTest, TheErrorForAMissingLibraryNamesItsPath) {
    EXPECT_THAT(refusalOf([] { (void)Runtime::open("/nowhere/libonnxruntime.so"); }),
                ::testing::StartsWith("/nowhere/libonnxruntime.so: cannot be loaded"));
}

TEST(OnnxRuntimeTest, AFileThatIsNotALibraryIsRejected) {
    const std::string path = HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow";
    EXPECT_THAT(refusalOf([&] { (void)Runtime::open(path); }), ::testing::StartsWith(path));
}

TEST(OnnxRuntimeTest, ALibraryOtherThanOnnxRuntimeIsRejected) {
    EXPECT_THAT(refusalOf([] { (void)Runtime::open("libm.so.6"); }), ::testing::HasSubstr("OrtGetApiBase"));
}

TEST(OnnxRuntimeTest, AVersionWithoutTheRequiredApiIsRejected) {
    const OrtApiBase base{noApi, oldVersion};
    EXPECT_THAT(refusalOf([&] { (void)Runtime::fromApiBase(&base); }), ::testing::HasSubstr("1.2.3 is too old: 1.16"));
}

TEST(OnnxRuntimeTest, AnErrorNamesTheOperationAndTheReason) {
    const auto runtime = Runtime::open(HAPTOFLOW_TEST_ONNXRUNTIME);
    try {
        runtime->check(runtime->api().CreateStatus(ORT_FAIL, "made by the test"), "trying");
        FAIL() << "a failure was not reported";
    } catch (const InferenceError& error) {
        EXPECT_STREQ(error.what(), "trying: made by the test");
    }
}

}  // namespace
}  // namespace haptoflow::inference
