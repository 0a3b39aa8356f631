#include "learning_options.hpp"
#include "open_engine.hpp"
#include "public_header.hpp"

#include <array>
#include <map>
#include <regex>
#include <string>
#include <thread>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

template <typename Handle>
Handle* invented(std::uintptr_t number) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): refused, never dereferenced.
    return reinterpret_cast<Handle*>(number);
}

TEST(LibraryApiTest, TheVersionIsThatOfTheProject) {
    EXPECT_STREQ(haptoflow_version(), HAPTOFLOW_TEST_VERSION);
}

TEST(LibraryApiTest, EveryStatusHasANameAndOtherNumbersHaveNone) {
    const std::string text = textOf(HAPTOFLOW_TEST_HEADER);
    const std::string statuses = text.substr(0, text.find("typedef int32_t haptoflow_solver"));
    const std::regex constant(R"(\n    (HAPTOFLOW_[A-Z_]+) = (\d+))");
    for (std::sregex_iterator match(statuses.begin(), statuses.end(), constant), end; match != end; ++match) {
        EXPECT_EQ(haptoflow_status_name(std::stoi((*match)[2])), (*match)[1].str());
    }
    EXPECT_STREQ(haptoflow_status_name(HAPTOFLOW_OK), "HAPTOFLOW_OK");
    for (const haptoflow_status status : {-1, 5, 9, 24, INT32_MAX, INT32_MIN}) {
        EXPECT_STREQ(haptoflow_status_name(status), "HAPTOFLOW_UNKNOWN_STATUS");
    }
}

TEST(LibraryApiTest, EachThreadHasItsOwnMessage) {
    EXPECT_EQ(haptoflow_struct_size(nullptr, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    const std::string mine = message();
    std::string theirs = "unset";
    std::thread([&theirs] { theirs = message(); }).join();
    EXPECT_THAT(mine, ::testing::HasSubstr("name is null"));
    EXPECT_EQ(theirs, "");
}

TEST(LibraryApiTest, ASuccessLeavesTheLastMessageInPlace) {
    EXPECT_EQ(haptoflow_struct_size(nullptr, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    const std::string before = message();
    uint32_t bytes = 0;
    EXPECT_EQ(haptoflow_struct_size("haptoflow_batch", &bytes), HAPTOFLOW_OK);
    EXPECT_EQ(message(), before);
}

TEST(LibraryApiTest, AMessageThatIsTooLongIsCut) {
    const std::string path(5000, 'p');
    const haptoflow_model_options options{sizeof(options), nullptr, 0, path.c_str()};
    haptoflow_model* model = nullptr;
    EXPECT_EQ(haptoflow_model_open(&options, &model), HAPTOFLOW_MODEL_UNREADABLE);
    EXPECT_EQ(message().size(), 1023U);
}

TEST(LibraryApiTest, TheSizeOfEveryStructOfTheHeaderIsKnown) {
    const std::string text = textOf(HAPTOFLOW_TEST_HEADER);
    const std::regex declaration(R"(typedef struct (haptoflow_\w+) \{)");
    std::size_t count = 0;
    for (std::sregex_iterator match(text.begin(), text.end(), declaration), end; match != end; ++match, ++count) {
        const std::string name = (*match)[1];
        uint32_t bytes = 0;
        EXPECT_EQ(haptoflow_struct_size(name.c_str(), &bytes), HAPTOFLOW_OK) << name;
        EXPECT_GE(bytes, 2 * sizeof(uint32_t)) << name;
    }
    EXPECT_GE(count, 17U);
}

TEST(LibraryApiTest, TheSizeOfAnUnknownStructIsRefusedWithItsName) {
    uint32_t bytes = 7;
    EXPECT_EQ(haptoflow_struct_size("haptoflow_engine", &bytes), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(bytes, 7U) << "a call that fails leaves its outputs unchanged";
    EXPECT_THAT(message(), ::testing::HasSubstr("\"haptoflow_engine\""));
}

/// For each function, how many of its pointers were null in a call.
using NullCalls = std::map<std::string, std::size_t>;

template <typename... Parameters, std::size_t... Places>
void callAtPlaces(NullCalls& calls, const char* name, haptoflow_status (*function)(Parameters...),
                  const std::tuple<Parameters...>& valid, std::index_sequence<Places...>) {
    const auto callWithout = [&]<std::size_t Place>(std::integral_constant<std::size_t, Place>) {
        if constexpr (std::is_pointer_v<std::tuple_element_t<Place, std::tuple<Parameters...>>>) {
            std::tuple<Parameters...> arguments = valid;
            std::get<Place>(arguments) = nullptr;
            EXPECT_EQ(std::apply(function, arguments), HAPTOFLOW_INVALID_ARGUMENT) << name << ", argument " << Place;
            ++calls[name];
        }
    };
    (callWithout(std::integral_constant<std::size_t, Places>{}), ...);
}

/// Calls the function with valid arguments of which one pointer after the other is null.
template <typename... Parameters>
void callWithNulls(NullCalls& calls, const char* name, haptoflow_status (*function)(Parameters...),
                   std::type_identity_t<Parameters>... valid) {
    callAtPlaces(calls, name, function, std::tuple<Parameters...>(valid...), std::index_sequence_for<Parameters...>{});
}

/// Somewhere to write a result to, which is not read.
template <typename Result>
Result* anywhere() {
    static Result result;
    if constexpr (requires { result.struct_size; }) {
        result.struct_size = sizeof(Result);
    }
    return &result;
}

/// Expects that no call has opened anything.
template <typename... Handles>
void expectNothingOpened() {
    EXPECT_TRUE(((*anywhere<Handles*>() == nullptr) && ...));
}

TEST(ArgumentTest, NullPointersAreRefusedByEveryFunction) {
    OpenEngine open(tinyModelPath);
    auto runtimeOptions = sized<haptoflow_runtime_options>();
    runtimeOptions.library_path = HAPTOFLOW_TEST_ONNXRUNTIME;
    const haptoflow_model_options modelOptions{sizeof(modelOptions), nullptr, 0, tinyModelPath.c_str()};
    const auto generatorChoice = generatorOptions(open.runtime, open.model);
    const auto engineChoice = engineOptions(open.runtime, open.model);
    GeneratorHandle generator;
    ASSERT_EQ(haptoflow_generator_create(&generatorChoice, generator.out()), HAPTOFLOW_OK) << message();
    std::vector<float> numbers(HAPTOFLOW_SEGMENT_SAMPLES);
    float* const data = numbers.data();
    const haptoflow_batch batch{sizeof(batch), 1, data, data, data, data, nullptr, nullptr, nullptr};
    const haptoflow_contact_state state = slidingState();
    const auto featureOptions = sized<haptoflow_wave_features_options>();
    Handle<haptoflow_wave_features, haptoflow_wave_features_close> features;
    ASSERT_EQ(haptoflow_wave_features_create(&featureOptions, features.out()), HAPTOFLOW_OK) << message();
    Handle<haptoflow_device_wave, haptoflow_device_wave_close> deviceWave;
    ASSERT_EQ(haptoflow_device_wave_create(8000.0, deviceWave.out()), HAPTOFLOW_OK) << message();
    const learning::testing::MadeRecording made({}, {.seconds = 4.0});
    const haptoflow_recording_info madeInfo = infoOf(made);
    const RecordingHandle recording(recordingOf(madeInfo));
    const auto learningChoice = learningOptions(recording, open.runtime, open.model);
    const std::string plain = HAPTOFLOW_TEST_GOLDEN_DIR "/recordings/files/plain.csv";
    auto recordingOptions = sized<haptoflow_recording_options>();
    recordingOptions.path = plain.c_str();
    const std::string json = textOf(HAPTOFLOW_TEST_GOLDEN_DIR "/material/ribbed.haptomaterial");
    Handle<haptoflow_material, haptoflow_material_close> material;
    ASSERT_EQ(haptoflow_material_read(json.data(), json.size(), material.out()), HAPTOFLOW_OK) << message();
    std::array<char, 8> text{};
    auto clipOptions = sized<haptoflow_clip_options>();
    clipOptions.wave_mps2 = data;
    clipOptions.sample_count = numbers.size();
    clipOptions.title = clipOptions.description = clipOptions.source = "";
    const std::string clipText = R"({"Pattern":[]})";
    ClipHandle clip;
    ASSERT_EQ(haptoflow_clip_create(&clipOptions, clip.out()), HAPTOFLOW_OK) << message();
    auto reliefOptions = sized<haptoflow_relief_options>();
    reliefOptions.heights_metres = data;
    reliefOptions.columns = reliefOptions.rows = 1;
    reliefOptions.size_metres[0] = reliefOptions.size_metres[1] = reliefOptions.depth_metres = 0.001F;
    // The outputs of a learning handle: see LearningApiTest.
    const auto* const learning = invented<haptoflow_learning>(1);

    haptoflow_voice noVoice = 0;
    haptoflow_relief noRelief = 0;

    NullCalls called;
#define REFUSES_NULLS(function, ...) callWithNulls(called, #function, function, __VA_ARGS__)
    REFUSES_NULLS(haptoflow_runtime_open, &runtimeOptions, anywhere<haptoflow_runtime*>());
    REFUSES_NULLS(haptoflow_runtime_close, nullptr);
    REFUSES_NULLS(haptoflow_cancellation_create, nullptr);
    REFUSES_NULLS(haptoflow_cancellation_cancel, nullptr);
    REFUSES_NULLS(haptoflow_cancellation_close, nullptr);
    REFUSES_NULLS(haptoflow_model_open, &modelOptions, anywhere<haptoflow_model*>());
    REFUSES_NULLS(haptoflow_model_close, nullptr);
    REFUSES_NULLS(haptoflow_model_header, open.model, anywhere<const char*>());
    REFUSES_NULLS(haptoflow_model_describe, open.model, anywhere<haptoflow_model_info>());
    REFUSES_NULLS(haptoflow_model_label_count, open.model, anywhere<uint32_t>());
    REFUSES_NULLS(haptoflow_model_label, open.model, 0, anywhere<haptoflow_label_info>());
    REFUSES_NULLS(haptoflow_model_embedding, open.model, 0, data);
    REFUSES_NULLS(haptoflow_model_nearest_label, open.model, data, anywhere<uint32_t>());
    REFUSES_NULLS(haptoflow_model_space, open.model, anywhere<const char*>());
    REFUSES_NULLS(haptoflow_model_tier_count, open.model, anywhere<uint32_t>());
    REFUSES_NULLS(haptoflow_model_tier, open.model, 0, anywhere<haptoflow_tier_info>());
    REFUSES_NULLS(haptoflow_material_read, json.data(), json.size(), anywhere<haptoflow_material*>());
    REFUSES_NULLS(haptoflow_material_close, nullptr);
    REFUSES_NULLS(haptoflow_material_describe, material, anywhere<haptoflow_material_info>());
    REFUSES_NULLS(haptoflow_material_embedding, material, data);
    REFUSES_NULLS(haptoflow_generator_create, &generatorChoice, anywhere<haptoflow_generator*>());
    REFUSES_NULLS(haptoflow_generator_close, nullptr);
    REFUSES_NULLS(haptoflow_generator_set_solver, nullptr, HAPTOFLOW_SOLVER_EULER, 1);
    REFUSES_NULLS(haptoflow_generator_generate, generator, &batch, data);
    REFUSES_NULLS(haptoflow_engine_create, &engineChoice, anywhere<haptoflow_engine*>());
    REFUSES_NULLS(haptoflow_engine_close, nullptr);
    REFUSES_NULLS(haptoflow_engine_set_quality, nullptr, HAPTOFLOW_QUALITY_DRAFT);
    REFUSES_NULLS(haptoflow_engine_register_material, open.engine, json.data(), json.size(), anywhere<uint32_t>());
    REFUSES_NULLS(haptoflow_engine_replace_material, open.engine, 0, json.data(), json.size());
    REFUSES_NULLS(haptoflow_engine_material_count, open.engine, anywhere<uint32_t>());
    REFUSES_NULLS(haptoflow_engine_material, open.engine, 0, anywhere<haptoflow_label_info>());
    REFUSES_NULLS(haptoflow_engine_step, nullptr);
    REFUSES_NULLS(haptoflow_engine_get_statistics, open.engine, anywhere<haptoflow_engine_statistics>());
    REFUSES_NULLS(haptoflow_engine_last_failure, open.engine, text.data(), text.size(), anywhere<uint64_t>());
    REFUSES_NULLS(haptoflow_engine_tier_times, open.engine, 0, anywhere<haptoflow_tier_times>());
    REFUSES_NULLS(haptoflow_voice_create, open.engine, 48000.0, &noVoice);
    REFUSES_NULLS(haptoflow_voice_destroy, nullptr);
    REFUSES_NULLS(haptoflow_voice_publish, open.voice, &state);
    REFUSES_NULLS(haptoflow_voices_render, &open.voice, 1, data, 1, 1, 0, 48000.0);
    REFUSES_NULLS(haptoflow_voice_render, open.voice, data, 8, 1, 0, 48000.0);
    REFUSES_NULLS(haptoflow_voice_get_statistics, open.voice, nullptr);
    REFUSES_NULLS(haptoflow_voice_set_actuator, 0, nullptr, 0);
    REFUSES_NULLS(haptoflow_voice_signal_statistics, open.voice, nullptr);
    REFUSES_NULLS(haptoflow_voice_exposure, open.voice, nullptr);
    REFUSES_NULLS(haptoflow_voice_effect_statistics, open.voice, HAPTOFLOW_EFFECT_TEXTURE, nullptr);
    REFUSES_NULLS(haptoflow_voice_place, open.voice, nullptr);
    REFUSES_NULLS(haptoflow_wave_features_create, &featureOptions, anywhere<haptoflow_wave_features*>());
    REFUSES_NULLS(haptoflow_wave_features_close, nullptr);
    REFUSES_NULLS(haptoflow_wave_features_reset, nullptr);
    REFUSES_NULLS(haptoflow_wave_features_set_range, nullptr, 100.0, 200.0);
    REFUSES_NULLS(haptoflow_wave_features_process, features, data, 1, anywhere<haptoflow_wave_frame>(), 1,
                  anywhere<uint64_t>());
    REFUSES_NULLS(haptoflow_relief_create, &reliefOptions, &noRelief);
    REFUSES_NULLS(haptoflow_relief_destroy, nullptr);
    REFUSES_NULLS(haptoflow_relief_heights_of_normals, data, 1, 1, data, 1, data);
    REFUSES_NULLS(haptoflow_clip_create, &clipOptions, anywhere<haptoflow_clip*>());
    REFUSES_NULLS(haptoflow_clip_read, clipText.data(), clipText.size(), anywhere<haptoflow_clip*>());
    REFUSES_NULLS(haptoflow_clip_close, nullptr);
    REFUSES_NULLS(haptoflow_clip_describe, clip, anywhere<haptoflow_clip_info>());
    REFUSES_NULLS(haptoflow_clip_write, clip, HAPTOFLOW_CLIP_AHAP, "", text.data(), text.size(), anywhere<uint64_t>());
    REFUSES_NULLS(haptoflow_clip_curves, nullptr, 1, data, data);
    REFUSES_NULLS(haptoflow_clip_wave, clip, 8000.0, data, 1, anywhere<uint64_t>());
    REFUSES_NULLS(haptoflow_voice_play_clip, 0, nullptr, 1.0F, 0);
    REFUSES_NULLS(haptoflow_device_share, HAPTOFLOW_DEVICE_MOTOR, 1.0F, nullptr);
    REFUSES_NULLS(haptoflow_device_wave_create, 8000.0, nullptr);
    REFUSES_NULLS(haptoflow_device_wave_close, nullptr);
    REFUSES_NULLS(haptoflow_device_wave_reset, nullptr);
    REFUSES_NULLS(haptoflow_device_wave_process, deviceWave, data, 1, 200.0F);
    REFUSES_NULLS(haptoflow_learn_material, &learningChoice, anywhere<haptoflow_learning*>());
    REFUSES_NULLS(haptoflow_find_wave_vectors, data, data, 1, anywhere<double>());
    REFUSES_NULLS(haptoflow_recording_read, &recordingOptions, anywhere<haptoflow_recording*>());
    REFUSES_NULLS(haptoflow_recording_create, &madeInfo, anywhere<haptoflow_recording*>());
    REFUSES_NULLS(haptoflow_recording_get_info, recording, anywhere<haptoflow_recording_info>());
    REFUSES_NULLS(haptoflow_recording_wave, recording, data, 1);
    REFUSES_NULLS(haptoflow_recording_remove_noise, data, data, data, 1, anywhere<haptoflow_noise_source>(),
                  anywhere<double>());
    REFUSES_NULLS(haptoflow_resample, data, 1, 2000.0, data, 1, 8000.0);
    REFUSES_NULLS(haptoflow_recording_close, nullptr);
    REFUSES_NULLS(haptoflow_learning_results, learning, anywhere<const char*>(), anywhere<const char*>());
    REFUSES_NULLS(haptoflow_learning_close, nullptr);
    REFUSES_NULLS(haptoflow_struct_size, "haptoflow_batch", anywhere<uint32_t>());
#undef REFUSES_NULLS

    NullCalls declared;
    for (const DeclaredFunction& function : declaredFunctions()) {
        if (function.pointers > 0) {
            declared[function.name] = function.pointers;
        }
    }
    EXPECT_EQ(called, declared) << "each pointer of each function of the header has a call";
    expectNothingOpened<haptoflow_runtime, haptoflow_model, haptoflow_generator, haptoflow_engine,
                        haptoflow_wave_features, haptoflow_recording, haptoflow_learning, haptoflow_material,
                        haptoflow_clip>();
    EXPECT_TRUE(noVoice == 0 && noRelief == 0);
}

TEST(ArgumentTest, ClosingANullHandleIsFine) {
    const RuntimeHandle runtime;
    const ModelHandle model;
    const Handle<haptoflow_material, haptoflow_material_close> material;
    const GeneratorHandle generator;
    const EngineHandle engine;
    const CancellationHandle cancellation;
    haptoflow_voice voice = 0;
    EXPECT_EQ(haptoflow_voice_destroy(&voice), HAPTOFLOW_OK);
    haptoflow_relief relief = 0;
    EXPECT_EQ(haptoflow_relief_destroy(&relief), HAPTOFLOW_OK);
}

class HandleTest : public WithTinyModel {};

TEST_F(HandleTest, InvalidHandlesAreDetectedAndNotDereferenced) {
    for (const std::uintptr_t number : {std::uintptr_t{1}, std::uintptr_t{0xDEADBEEF}, ~std::uintptr_t{0}}) {
        uint32_t count = 0;
        EXPECT_EQ(haptoflow_model_label_count(invented<haptoflow_model>(number), &count), HAPTOFLOW_INVALID_ARGUMENT);
        EXPECT_THAT(message(), ::testing::HasSubstr("not an open model handle"));
        auto options = generatorOptions(runtime_, model_);
        options.runtime = invented<haptoflow_runtime>(number);
        haptoflow_generator* generator = nullptr;
        EXPECT_EQ(haptoflow_generator_create(&options, &generator), HAPTOFLOW_INVALID_ARGUMENT);
        generator = invented<haptoflow_generator>(number);
        EXPECT_EQ(haptoflow_generator_close(&generator), HAPTOFLOW_INVALID_ARGUMENT);
    }
}

TEST_F(HandleTest, ACopyOfAClosedHandleIsRefusedEvenAfterAnotherIsOpened) {
    haptoflow_model* first = openModel(tinyModelPath);
    haptoflow_model* copy = first;
    ASSERT_EQ(haptoflow_model_close(&first), HAPTOFLOW_OK);
    haptoflow_model* second = openModel(tinyModelPath);
    uint32_t count = 0;
    EXPECT_EQ(haptoflow_model_label_count(copy, &count), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_close(&copy), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_model_label_count(second, &count), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_model_close(&second), HAPTOFLOW_OK);
}

TEST_F(HandleTest, AStructOfAnotherSizeIsRefusedAndKeepsItsContent) {
    haptoflow_tier_info info{};
    auto options = generatorOptions(runtime_, model_);
    for (const std::size_t size : {std::size_t{0}, sizeof(info) + 8, sizeof(options) - 8, sizeof(options) + 16}) {
        options.struct_size = static_cast<uint32_t>(size);
        haptoflow_generator* generator = nullptr;
        EXPECT_EQ(haptoflow_generator_create(&options, &generator), HAPTOFLOW_INVALID_ARGUMENT) << size;
        EXPECT_THAT(message(), ::testing::HasSubstr("options: struct_size is " + std::to_string(size) + "; expected " +
                                                    std::to_string(sizeof(options))));
        info.struct_size = static_cast<uint32_t>(size);
        EXPECT_EQ(haptoflow_model_tier(model_, 0, &info), HAPTOFLOW_INVALID_ARGUMENT) << size;
        EXPECT_EQ(info.steps, 0);
        EXPECT_EQ(info.struct_size, size);
    }
}

TEST_F(HandleTest, ARuntimeNeedsExactlyOneSource) {
    haptoflow_runtime* runtime = nullptr;
    auto options = sized<haptoflow_runtime_options>();
    EXPECT_EQ(haptoflow_runtime_open(&options, &runtime), HAPTOFLOW_INVALID_ARGUMENT);
    const int notAnApi = 0;
    options.ort_api_base = &notAnApi;
    options.library_path = HAPTOFLOW_TEST_ONNXRUNTIME;
    EXPECT_EQ(haptoflow_runtime_open(&options, &runtime), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(runtime, nullptr);
}

}  // namespace
}  // namespace haptoflow::capi::testing
