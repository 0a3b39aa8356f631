#include "learning_options.hpp"
#include "open_engine.hpp"
#include "public_header.hpp"

#include <array>
#include <cstring>
#include <functional>
#include <map>
#include <regex>
#include <string>
#include <thread>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

template <typename Handle>
Handle* invented(std::uintptr_t number) {
    return reinterpret_cast<Handle*>(number);
}

TEST(LibraryApiTest, TheVersionIsThatOfTheProject) {
    EXPECT_STREQ(haptoflow_version(), HAPTOFLOW_TEST_VERSION);
}

TEST(LibraryApiTest, EveryStatusHasANameAndOtherNumbersHaveNone) {
    EXPECT_STREQ(haptoflow_status_name(HAPTOFLOW_OK), "HAPTOFLOW_OK");
    EXPECT_STREQ(haptoflow_status_name(HAPTOFLOW_MODEL_TOO_NEW), "HAPTOFLOW_MODEL_TOO_NEW");
    EXPECT_STREQ(haptoflow_status_name(HAPTOFLOW_INFERENCE_FAILED), "HAPTOFLOW_INFERENCE_FAILED");
    EXPECT_STREQ(haptoflow_status_name(HAPTOFLOW_CANCELLED), "HAPTOFLOW_CANCELLED");
    EXPECT_STREQ(haptoflow_status_name(HAPTOFLOW_TIER_TOO_SLOW), "HAPTOFLOW_TIER_TOO_SLOW");
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
    const std::string text = headerText();
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

/// Calls of a function, each with one null pointer and otherwise valid arguments.
struct NullCalls {
    std::string function;
    std::vector<std::function<haptoflow_status()>> calls;
};

TEST(ArgumentTest, NullPointersAreRefusedByEveryFunction) {
    OpenEngine open(tinyModelPath);
    const haptoflow_runtime_options runtimeOptions{sizeof(runtimeOptions), nullptr, HAPTOFLOW_TEST_ONNXRUNTIME, nullptr,
                                                   nullptr};
    const haptoflow_model_options modelOptions{sizeof(modelOptions), nullptr, 0, tinyModelPath.c_str()};
    haptoflow_generator_options generatorOptions{};
    generatorOptions.struct_size = sizeof(generatorOptions);
    generatorOptions.runtime = open.runtime;
    generatorOptions.model = open.model;
    haptoflow_engine_options engineOptions{};
    engineOptions.struct_size = sizeof(engineOptions);
    engineOptions.runtime = open.runtime;
    engineOptions.model = open.model;

    haptoflow_generator* generator = nullptr;
    ASSERT_EQ(haptoflow_generator_create(&generatorOptions, &generator), HAPTOFLOW_OK) << message();
    const std::vector<float> embedding(HAPTOFLOW_EMBEDDING_SIZE);
    const std::vector<float> motion(HAPTOFLOW_MOTION_SIZE);
    const std::vector<float> waveform(HAPTOFLOW_SEGMENT_SAMPLES);
    const haptoflow_batch batch{sizeof(batch),   1,       embedding.data(), motion.data(), waveform.data(),
                                waveform.data(), nullptr, nullptr,          nullptr};
    std::vector<float> numbers(HAPTOFLOW_SEGMENT_SAMPLES);

    haptoflow_runtime* noRuntime = nullptr;
    haptoflow_model* noModel = nullptr;
    haptoflow_generator* noGenerator = nullptr;
    haptoflow_engine* noEngine = nullptr;
    haptoflow_wave_features* noFeatures = nullptr;
    const haptoflow_wave_features_options featureOptions{sizeof(featureOptions), 0, 0.0, 0.0, 0.0};
    haptoflow_wave_features* features = nullptr;
    ASSERT_EQ(haptoflow_wave_features_create(&featureOptions, &features), HAPTOFLOW_OK) << message();
    haptoflow_device_wave* deviceWave = nullptr;
    ASSERT_EQ(haptoflow_device_wave_create(8000.0, &deviceWave), HAPTOFLOW_OK) << message();
    const learning::testing::MadeRecording made({}, {.seconds = 4.0});
    const MadeHandle madeRecording(infoOf(made));
    const haptoflow_recording_info madeInfo = infoOf(made);
    const haptoflow_learning_options learningOptions = optionsOf(madeRecording.recording, open.runtime, open.model);
    const std::string plain = HAPTOFLOW_TEST_GOLDEN_DIR "/recordings/files/plain.csv";
    haptoflow_recording_options recordingOptions{};
    recordingOptions.struct_size = sizeof(recordingOptions);
    recordingOptions.path = plain.c_str();
    haptoflow_recording_info recordingInfo{};
    recordingInfo.struct_size = sizeof(recordingInfo);
    haptoflow_recording* noRecording = nullptr;
    haptoflow_recording* recording = nullptr;
    ASSERT_EQ(haptoflow_recording_read(&recordingOptions, &recording), HAPTOFLOW_OK) << message();
    haptoflow_learning* noLearning = nullptr;
    haptoflow_learning* learning = nullptr;
    ASSERT_EQ(haptoflow_learn_material(&learningOptions, &learning), HAPTOFLOW_OK) << message();
    const char* learnt = nullptr;
    const char* report = nullptr;
    ASSERT_EQ(haptoflow_learning_results(learning, &learnt, &report), HAPTOFLOW_OK) << message();
    haptoflow_material* noMaterial = nullptr;
    haptoflow_material* material = nullptr;
    ASSERT_EQ(haptoflow_material_read(learnt, std::strlen(learnt), &material), HAPTOFLOW_OK) << message();
    haptoflow_wave_frame frame{};
    std::array<double, 4> waveVectors{};
    haptoflow_noise_source noiseSource = HAPTOFLOW_NOISE_NONE;
    double noise = 0.0;
    const auto removeNoise = [](float* wave, const float* velocity, const float* force, haptoflow_noise_source* source,
                                double* rms) {
        return haptoflow_recording_remove_noise(wave, velocity, force, 1, source, rms);
    };
    haptoflow_voice noVoice = 0;
    uint32_t count = 0;
    const char* text = nullptr;
    haptoflow_label_info label{};
    label.struct_size = sizeof(label);
    haptoflow_model_info modelInfo{};
    modelInfo.struct_size = sizeof(modelInfo);
    haptoflow_material_info materialInfo{};
    materialInfo.struct_size = sizeof(materialInfo);
    haptoflow_tier_info tier{};
    tier.struct_size = sizeof(tier);
    haptoflow_tier_times times{};
    std::array<char, 8> failure{};
    uint64_t length = 0;
    times.struct_size = sizeof(times);
    haptoflow_engine_statistics statistics{};
    statistics.struct_size = sizeof(statistics);

    const std::vector<NullCalls> table{
        {"haptoflow_runtime_open",
         {[&] { return haptoflow_runtime_open(nullptr, &noRuntime); },
          [&] { return haptoflow_runtime_open(&runtimeOptions, nullptr); }}},
        {"haptoflow_runtime_close", {[&] { return haptoflow_runtime_close(nullptr); }}},
        {"haptoflow_cancellation_create", {[&] { return haptoflow_cancellation_create(nullptr); }}},
        {"haptoflow_cancellation_cancel", {[&] { return haptoflow_cancellation_cancel(nullptr); }}},
        {"haptoflow_cancellation_close", {[&] { return haptoflow_cancellation_close(nullptr); }}},
        {"haptoflow_model_open",
         {[&] { return haptoflow_model_open(nullptr, &noModel); },
          [&] { return haptoflow_model_open(&modelOptions, nullptr); }}},
        {"haptoflow_model_close", {[&] { return haptoflow_model_close(nullptr); }}},
        {"haptoflow_model_header",
         {[&] { return haptoflow_model_header(nullptr, &text); },
          [&] { return haptoflow_model_header(open.model, nullptr); }}},
        {"haptoflow_model_describe",
         {[&] { return haptoflow_model_describe(nullptr, &modelInfo); },
          [&] { return haptoflow_model_describe(open.model, nullptr); }}},
        {"haptoflow_model_label_count",
         {[&] { return haptoflow_model_label_count(nullptr, &count); },
          [&] { return haptoflow_model_label_count(open.model, nullptr); }}},
        {"haptoflow_model_label",
         {[&] { return haptoflow_model_label(nullptr, 0, &label); },
          [&] { return haptoflow_model_label(open.model, 0, nullptr); }}},
        {"haptoflow_model_embedding",
         {[&] { return haptoflow_model_embedding(nullptr, 0, numbers.data()); },
          [&] { return haptoflow_model_embedding(open.model, 0, nullptr); }}},
        {"haptoflow_model_nearest_label",
         {[&] { return haptoflow_model_nearest_label(nullptr, numbers.data(), &count); },
          [&] { return haptoflow_model_nearest_label(open.model, nullptr, &count); },
          [&] { return haptoflow_model_nearest_label(open.model, numbers.data(), nullptr); }}},
        {"haptoflow_model_space",
         {[&] { return haptoflow_model_space(nullptr, &text); },
          [&] { return haptoflow_model_space(open.model, nullptr); }}},
        {"haptoflow_model_tier_count",
         {[&] { return haptoflow_model_tier_count(nullptr, &count); },
          [&] { return haptoflow_model_tier_count(open.model, nullptr); }}},
        {"haptoflow_model_tier",
         {[&] { return haptoflow_model_tier(nullptr, 0, &tier); },
          [&] { return haptoflow_model_tier(open.model, 0, nullptr); }}},
        {"haptoflow_material_read",
         {[&] { return haptoflow_material_read(nullptr, 1, &noMaterial); },
          [&] { return haptoflow_material_read("{}", 2, nullptr); }}},
        {"haptoflow_material_close", {[&] { return haptoflow_material_close(nullptr); }}},
        {"haptoflow_material_describe",
         {[&] { return haptoflow_material_describe(nullptr, &materialInfo); },
          [&] { return haptoflow_material_describe(material, nullptr); }}},
        {"haptoflow_material_embedding",
         {[&] { return haptoflow_material_embedding(nullptr, numbers.data()); },
          [&] { return haptoflow_material_embedding(material, nullptr); }}},
        {"haptoflow_generator_create",
         {[&] { return haptoflow_generator_create(nullptr, &noGenerator); },
          [&] { return haptoflow_generator_create(&generatorOptions, nullptr); }}},
        {"haptoflow_generator_close", {[&] { return haptoflow_generator_close(nullptr); }}},
        {"haptoflow_generator_set_solver",
         {[&] { return haptoflow_generator_set_solver(nullptr, HAPTOFLOW_SOLVER_EULER, 1); }}},
        {"haptoflow_generator_generate",
         {[&] { return haptoflow_generator_generate(nullptr, &batch, numbers.data()); },
          [&] { return haptoflow_generator_generate(generator, nullptr, numbers.data()); },
          [&] { return haptoflow_generator_generate(generator, &batch, nullptr); }}},
        {"haptoflow_engine_create",
         {[&] { return haptoflow_engine_create(nullptr, &noEngine); },
          [&] { return haptoflow_engine_create(&engineOptions, nullptr); }}},
        {"haptoflow_engine_close", {[&] { return haptoflow_engine_close(nullptr); }}},
        {"haptoflow_engine_set_quality",
         {[&] { return haptoflow_engine_set_quality(nullptr, HAPTOFLOW_QUALITY_DRAFT); }}},
        {"haptoflow_engine_register_material",
         {[&] { return haptoflow_engine_register_material(nullptr, "{}", 2, &count); },
          [&] { return haptoflow_engine_register_material(open.engine, nullptr, 2, &count); },
          [&] { return haptoflow_engine_register_material(open.engine, "{}", 2, nullptr); }}},
        {"haptoflow_engine_replace_material",
         {[&] { return haptoflow_engine_replace_material(nullptr, 0, "{}", 2); },
          [&] { return haptoflow_engine_replace_material(open.engine, 0, nullptr, 2); }}},
        {"haptoflow_engine_material_count",
         {[&] { return haptoflow_engine_material_count(nullptr, &count); },
          [&] { return haptoflow_engine_material_count(open.engine, nullptr); }}},
        {"haptoflow_engine_material",
         {[&] { return haptoflow_engine_material(nullptr, 0, &label); },
          [&] { return haptoflow_engine_material(open.engine, 0, nullptr); }}},
        {"haptoflow_engine_step", {[&] { return haptoflow_engine_step(nullptr); }}},
        {"haptoflow_engine_get_statistics",
         {[&] { return haptoflow_engine_get_statistics(nullptr, &statistics); },
          [&] { return haptoflow_engine_get_statistics(open.engine, nullptr); }}},
        {"haptoflow_engine_last_failure",
         {[&] { return haptoflow_engine_last_failure(nullptr, failure.data(), failure.size(), &length); },
          [&] { return haptoflow_engine_last_failure(open.engine, nullptr, failure.size(), &length); },
          [&] { return haptoflow_engine_last_failure(open.engine, failure.data(), failure.size(), nullptr); }}},
        {"haptoflow_engine_tier_times",
         {[&] { return haptoflow_engine_tier_times(nullptr, 0, &times); },
          [&] { return haptoflow_engine_tier_times(open.engine, 0, nullptr); }}},
        {"haptoflow_voice_create",
         {[&] { return haptoflow_voice_create(nullptr, 48000.0, &noVoice); },
          [&] { return haptoflow_voice_create(open.engine, 48000.0, nullptr); }}},
        {"haptoflow_voice_destroy", {[&] { return haptoflow_voice_destroy(nullptr); }}},
        {"haptoflow_voice_publish", {[&] { return haptoflow_voice_publish(open.voice, nullptr); }}},
        {"haptoflow_voices_render",
         {[&] { return haptoflow_voices_render(nullptr, 1, numbers.data(), 1, 1, 0, 48000.0); },
          [&] { return haptoflow_voices_render(&open.voice, 1, nullptr, 8, 1, 0, 48000.0); }}},
        {"haptoflow_voice_render", {[&] { return haptoflow_voice_render(open.voice, nullptr, 8, 1, 0, 48000.0); }}},
        {"haptoflow_voice_get_statistics", {[&] { return haptoflow_voice_get_statistics(open.voice, nullptr); }}},
        {"haptoflow_voice_set_actuator", {[&] { return haptoflow_voice_set_actuator(0, nullptr, 0); }}},
        {"haptoflow_voice_signal_statistics", {[&] { return haptoflow_voice_signal_statistics(open.voice, nullptr); }}},
        {"haptoflow_voice_exposure", {[&] { return haptoflow_voice_exposure(open.voice, nullptr); }}},
        {"haptoflow_voice_effect_statistics",
         {[&] { return haptoflow_voice_effect_statistics(open.voice, HAPTOFLOW_EFFECT_TEXTURE, nullptr); }}},
        {"haptoflow_voice_place", {[&] { return haptoflow_voice_place(open.voice, nullptr); }}},
        {"haptoflow_wave_features_create",
         {[&] { return haptoflow_wave_features_create(nullptr, &noFeatures); },
          [&] { return haptoflow_wave_features_create(&featureOptions, nullptr); }}},
        {"haptoflow_wave_features_close", {[&] { return haptoflow_wave_features_close(nullptr); }}},
        {"haptoflow_wave_features_reset", {[&] { return haptoflow_wave_features_reset(nullptr); }}},
        {"haptoflow_wave_features_set_range",
         {[&] { return haptoflow_wave_features_set_range(nullptr, 100.0, 200.0); }}},
        {"haptoflow_wave_features_process",
         {[&] { return haptoflow_wave_features_process(nullptr, numbers.data(), 1, &frame, 1, &length); },
          [&] { return haptoflow_wave_features_process(features, nullptr, 1, &frame, 1, &length); },
          [&] { return haptoflow_wave_features_process(features, numbers.data(), 1, nullptr, 1, &length); },
          [&] { return haptoflow_wave_features_process(features, numbers.data(), 1, &frame, 1, nullptr); }}},
        {"haptoflow_device_share", {[&] { return haptoflow_device_share(HAPTOFLOW_DEVICE_MOTOR, 1.0F, nullptr); }}},
        {"haptoflow_device_wave_create", {[&] { return haptoflow_device_wave_create(8000.0, nullptr); }}},
        {"haptoflow_device_wave_close", {[&] { return haptoflow_device_wave_close(nullptr); }}},
        {"haptoflow_device_wave_reset", {[&] { return haptoflow_device_wave_reset(nullptr); }}},
        {"haptoflow_device_wave_process",
         {[&] { return haptoflow_device_wave_process(nullptr, numbers.data(), 1, 200.0F); },
          [&] { return haptoflow_device_wave_process(deviceWave, nullptr, 1, 200.0F); }}},
        {"haptoflow_learn_material",
         {[&] { return haptoflow_learn_material(nullptr, &noLearning); },
          [&] { return haptoflow_learn_material(&learningOptions, nullptr); }}},
        {"haptoflow_find_wave_vectors",
         {[&] { return haptoflow_find_wave_vectors(nullptr, numbers.data(), 1, waveVectors.data()); },
          [&] { return haptoflow_find_wave_vectors(numbers.data(), nullptr, 1, waveVectors.data()); },
          [&] { return haptoflow_find_wave_vectors(numbers.data(), numbers.data(), 1, nullptr); }}},
        {"haptoflow_recording_read",
         {[&] { return haptoflow_recording_read(nullptr, &noRecording); },
          [&] { return haptoflow_recording_read(&recordingOptions, nullptr); }}},
        {"haptoflow_recording_create",
         {[&] { return haptoflow_recording_create(nullptr, &noRecording); },
          [&] { return haptoflow_recording_create(&madeInfo, nullptr); }}},
        {"haptoflow_recording_get_info",
         {[&] { return haptoflow_recording_get_info(nullptr, &recordingInfo); },
          [&] { return haptoflow_recording_get_info(recording, nullptr); }}},
        {"haptoflow_recording_wave",
         {[&] { return haptoflow_recording_wave(nullptr, numbers.data(), 1); },
          [&] { return haptoflow_recording_wave(recording, nullptr, 1); }}},
        {"haptoflow_recording_remove_noise",
         {[&] { return removeNoise(nullptr, numbers.data(), numbers.data(), &noiseSource, &noise); },
          [&] { return removeNoise(numbers.data(), nullptr, numbers.data(), &noiseSource, &noise); },
          [&] { return removeNoise(numbers.data(), numbers.data(), nullptr, &noiseSource, &noise); },
          [&] { return removeNoise(numbers.data(), numbers.data(), numbers.data(), nullptr, &noise); },
          [&] { return removeNoise(numbers.data(), numbers.data(), numbers.data(), &noiseSource, nullptr); }}},
        {"haptoflow_resample",
         {[&] { return haptoflow_resample(nullptr, 1, 2000.0, numbers.data(), 1, 8000.0); },
          [&] { return haptoflow_resample(numbers.data(), 1, 2000.0, nullptr, 1, 8000.0); }}},
        {"haptoflow_recording_close", {[&] { return haptoflow_recording_close(nullptr); }}},
        {"haptoflow_learning_results",
         {[&] { return haptoflow_learning_results(nullptr, &learnt, &report); },
          [&] { return haptoflow_learning_results(learning, nullptr, &report); },
          [&] { return haptoflow_learning_results(learning, &learnt, nullptr); }}},
        {"haptoflow_learning_close", {[&] { return haptoflow_learning_close(nullptr); }}},
        {"haptoflow_struct_size",
         {[&] { return haptoflow_struct_size(nullptr, &count); },
          [&] { return haptoflow_struct_size("haptoflow_batch", nullptr); }}},
    };
    std::map<std::string, std::size_t> called;
    for (const auto& [function, calls] : table) {
        called[function] = calls.size();
        for (std::size_t i = 0; i < calls.size(); ++i) {
            EXPECT_EQ(calls[i](), HAPTOFLOW_INVALID_ARGUMENT) << function << ", call " << i;
        }
    }
    std::map<std::string, std::size_t> declared;
    for (const DeclaredFunction& function : declaredFunctions()) {
        if (function.pointers > 0) {
            declared[function.name] = function.pointers;
        }
    }
    EXPECT_EQ(called, declared) << "each pointer of each function of the header has a call in the table";
    EXPECT_EQ(noRuntime, nullptr);
    EXPECT_EQ(noModel, nullptr);
    EXPECT_EQ(noGenerator, nullptr);
    EXPECT_EQ(noEngine, nullptr);
    EXPECT_EQ(noVoice, 0U);
    EXPECT_EQ(noLearning, nullptr);
    EXPECT_EQ(noMaterial, nullptr);
    EXPECT_EQ(haptoflow_material_close(&material), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_learning_close(&learning), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_recording_close(&recording), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_generator_close(&generator), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_device_wave_close(&deviceWave), HAPTOFLOW_OK);
}

TEST(ArgumentTest, ClosingANullHandleIsFine) {
    haptoflow_runtime* runtime = nullptr;
    haptoflow_model* model = nullptr;
    haptoflow_generator* generator = nullptr;
    haptoflow_engine* engine = nullptr;
    haptoflow_cancellation* cancellation = nullptr;
    haptoflow_voice voice = 0;
    EXPECT_EQ(haptoflow_cancellation_close(&cancellation), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_runtime_close(&runtime), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_model_close(&model), HAPTOFLOW_OK);
    haptoflow_material* material = nullptr;
    EXPECT_EQ(haptoflow_material_close(&material), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_generator_close(&generator), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_engine_close(&engine), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_voice_destroy(&voice), HAPTOFLOW_OK);
}

class HandleTest : public WithTinyModel {};

TEST_F(HandleTest, InvalidHandlesAreDetectedAndNotDereferenced) {
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

TEST_F(HandleTest, ACopyOfAClosedHandleIsRefusedEvenAfterAnotherIsOpened) {
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

TEST_F(HandleTest, AStructOfAnotherSizeIsRefusedAndKeepsItsContent) {
    haptoflow_tier_info info{};
    auto options = generatorOptions();
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
    const int notAnApi = 0;
    const haptoflow_runtime_options neither{sizeof(neither), nullptr, nullptr, nullptr, nullptr};
    EXPECT_EQ(haptoflow_runtime_open(&neither, &runtime), HAPTOFLOW_INVALID_ARGUMENT);
    const haptoflow_runtime_options both{sizeof(both), &notAnApi, HAPTOFLOW_TEST_ONNXRUNTIME, nullptr, nullptr};
    EXPECT_EQ(haptoflow_runtime_open(&both, &runtime), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(runtime, nullptr);
}

}  // namespace
}  // namespace haptoflow::capi::testing
