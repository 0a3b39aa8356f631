#include "open_handles.hpp"

#include <array>
#include <thread>

namespace haptoflow::capi::testing {
namespace {

template <typename Handle>
Handle* invented(std::uintptr_t number) {
    return reinterpret_cast<Handle*>(number);
}

TEST(LibraryApiTest, NamesTheProjectsVersion) {
    EXPECT_STREQ(haptoflow_version(), HAPTOFLOW_TEST_VERSION);
}

TEST(LibraryApiTest, NamesEveryStatusAndOnlyThose) {
    EXPECT_STREQ(haptoflow_status_name(HAPTOFLOW_OK), "HAPTOFLOW_OK");
    EXPECT_STREQ(haptoflow_status_name(HAPTOFLOW_MODEL_TOO_NEW), "HAPTOFLOW_MODEL_TOO_NEW");
    EXPECT_STREQ(haptoflow_status_name(HAPTOFLOW_INFERENCE_FAILED), "HAPTOFLOW_INFERENCE_FAILED");
    for (const haptoflow_status status : {-1, 5, 9, 17, 22, INT32_MAX, INT32_MIN}) {
        EXPECT_STREQ(haptoflow_status_name(status), "HAPTOFLOW_UNKNOWN_STATUS");
    }
}

TEST(LibraryApiTest, KeepsTheMessageOfEachThreadToItself) {
    EXPECT_EQ(haptoflow_noise_fill(0, 0, 0, nullptr, 1), HAPTOFLOW_INVALID_ARGUMENT);
    const std::string mine = message();
    std::string theirs = "unset";
    std::thread([&theirs] { theirs = message(); }).join();
    EXPECT_THAT(mine, ::testing::HasSubstr("noise is null"));
    EXPECT_EQ(theirs, "");
}

TEST(LibraryApiTest, ASuccessLeavesTheLastMessageInPlace) {
    EXPECT_EQ(haptoflow_noise_fill(0, 0, 0, nullptr, 1), HAPTOFLOW_INVALID_ARGUMENT);
    const std::string before = message();
    std::array<float, 3> noise{};
    EXPECT_EQ(haptoflow_noise_fill(0, 0, 0, noise.data(), noise.size()), HAPTOFLOW_OK);
    EXPECT_EQ(message(), before);
}

TEST(LibraryApiTest, CutsAMessageThatIsTooLong) {
    const std::string path(5000, 'p');
    const haptoflow_model_options options{sizeof(options), nullptr, 0, path.c_str()};
    haptoflow_model* model = nullptr;
    EXPECT_EQ(haptoflow_model_open(&options, &model), HAPTOFLOW_MODEL_UNREADABLE);
    EXPECT_EQ(message().size(), 1023U);
}

TEST(LibraryApiTest, NoiseIsThatOfItsKey) {
    std::array<float, 4> noise{};
    ASSERT_EQ(haptoflow_noise_fill(1, 2, 3, noise.data(), noise.size()), HAPTOFLOW_OK);
    EXPECT_FLOAT_EQ(noise[0], -1.0514221F);
    EXPECT_FLOAT_EQ(noise[3], -0.25481707F);
    EXPECT_EQ(haptoflow_noise_fill(1, 2, 3, noise.data(), UINT64_MAX), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST(ArgumentTest, NullPointersAreRefusedByEveryFunction) {
    EXPECT_EQ(haptoflow_runtime_open(nullptr, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_runtime_close(nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_open(nullptr, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_close(nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_header(nullptr, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_label_count(nullptr, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_label(nullptr, 0, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_embedding(nullptr, 0, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_tier_count(nullptr, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_tier(nullptr, 0, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_generator_create(nullptr, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_generator_close(nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_generator_set_solver(nullptr, HAPTOFLOW_SOLVER_EULER, 1), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_generator_generate(nullptr, nullptr, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_generator_levels(nullptr, nullptr, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_noise_fill(0, 0, 0, nullptr, 0), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST(ArgumentTest, ClosingANullHandleIsFine) {
    haptoflow_runtime* runtime = nullptr;
    haptoflow_model* model = nullptr;
    haptoflow_generator* generator = nullptr;
    EXPECT_EQ(haptoflow_runtime_close(&runtime), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_model_close(&model), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_generator_close(&generator), HAPTOFLOW_OK);
}

class HandleTest : public WithTinyModel {};

TEST_F(HandleTest, NullOutputsAreRefusedWithAnOpenModel) {
    EXPECT_EQ(haptoflow_model_header(model_, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_label_count(model_, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_label(model_, 0, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_embedding(model_, 0, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_tier_count(model_, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_tier(model_, 0, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    const auto options = generatorOptions();
    EXPECT_EQ(haptoflow_generator_create(&options, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST_F(HandleTest, InventedHandlesAreRecognisedAndNotFollowed) {
    for (const std::uintptr_t number : {std::uintptr_t{1}, std::uintptr_t{0xDEADBEEF}, ~std::uintptr_t{0}}) {
        uint32_t count = 0;
        EXPECT_EQ(haptoflow_model_label_count(invented<haptoflow_model>(number), &count), HAPTOFLOW_INVALID_ARGUMENT);
        EXPECT_THAT(message(), ::testing::HasSubstr("not an open model handle"));
        auto options = generatorOptions();
        options.runtime = invented<haptoflow_runtime>(number);
        haptoflow_generator* generator = nullptr;
        EXPECT_EQ(haptoflow_generator_create(&options, &generator), HAPTOFLOW_INVALID_ARGUMENT);
        generator = invented<haptoflow_generator>(number);
        EXPECT_EQ(haptoflow_generator_close(&generator), HAPTOFLOW_INVALID_ARGUMENT);
    }
}

TEST_F(HandleTest, ACopyOfAClosedHandleIsRecognisedEvenAfterAnotherIsOpened) {
    haptoflow_model* first = openTinyModel();
    haptoflow_model* copy = first;
    ASSERT_EQ(haptoflow_model_close(&first), HAPTOFLOW_OK);
    haptoflow_model* second = openTinyModel();
    uint32_t count = 0;
    EXPECT_EQ(haptoflow_model_label_count(copy, &count), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_close(&copy), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_label_count(second, &count), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_model_close(&second), HAPTOFLOW_OK);
}

TEST_F(HandleTest, AStructSizeThatWasNeverSetIsRefused) {
    for (const uint32_t size : {0U, 3U, 100'000U, UINT32_MAX}) {
        auto options = generatorOptions();
        options.struct_size = size;
        haptoflow_generator* generator = nullptr;
        EXPECT_EQ(haptoflow_generator_create(&options, &generator), HAPTOFLOW_INVALID_ARGUMENT) << size;
        EXPECT_THAT(message(), ::testing::HasSubstr("struct_size"));
        haptoflow_label_info info{};
        info.struct_size = size;
        EXPECT_EQ(haptoflow_model_label(model_, 0, &info), HAPTOFLOW_INVALID_ARGUMENT) << size;
    }
}

TEST_F(HandleTest, ARuntimeWantsExactlyOneSource) {
    haptoflow_runtime* runtime = nullptr;
    const int notAnApi = 0;
    const haptoflow_runtime_options neither{sizeof(neither), nullptr, nullptr};
    EXPECT_EQ(haptoflow_runtime_open(&neither, &runtime), HAPTOFLOW_INVALID_ARGUMENT);
    const haptoflow_runtime_options both{sizeof(both), &notAnApi, HAPTOFLOW_TEST_ONNXRUNTIME};
    EXPECT_EQ(haptoflow_runtime_open(&both, &runtime), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(runtime, nullptr);
}

}  // namespace
}  // namespace haptoflow::capi::testing
