// Every struct of the header that begins with struct_size, in the sizes of callers compiled with older and newer
// headers.
#include "learning_options.hpp"
#include "model/material_builder.hpp"
#include "open_engine.hpp"
#include "public_header.hpp"

#include <array>
#include <cstddef>
#include <cstring>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

constexpr unsigned char untouched = 0xEE;
/// The library refuses larger descriptors as uninitialised.
constexpr std::size_t maximumSize = 4096;

/// A struct of any size in its own memory, followed by bytes that do not belong to the caller.
class Memory {
public:
    explicit Memory(uint32_t structSize) : bytes_(2 * maximumSize, untouched) { setSize(structSize); }
    template <typename Descriptor>
    Memory(const Descriptor& content, uint32_t structSize) : Memory(structSize) {
        std::memcpy(bytes_.data(), &content, std::min<std::size_t>(structSize, sizeof(content)));
        setSize(structSize);
    }

    [[nodiscard]] unsigned char* data() { return bytes_.data(); }
    template <typename Descriptor>
    [[nodiscard]] Descriptor* as() {
        return reinterpret_cast<Descriptor*>(bytes_.data());
    }
    friend bool operator==(const Memory&, const Memory&) = default;
    /// True if the memory holds the bytes of `first` up to `size` and is unchanged after that.
    [[nodiscard]] bool holds(const Memory& first, std::size_t size) const {
        const std::size_t begin = sizeof(uint32_t);
        return std::equal(bytes_.begin() + begin, bytes_.begin() + static_cast<std::ptrdiff_t>(std::max(size, begin)),
                          first.bytes_.begin() + begin) &&
               std::all_of(bytes_.begin() + static_cast<std::ptrdiff_t>(std::max(size, begin)), bytes_.end(),
                           [](unsigned char byte) { return byte == untouched; });
    }

private:
    void setSize(uint32_t structSize) { std::memcpy(bytes_.data(), &structSize, sizeof(structSize)); }

    // Memory of operator new is aligned for every struct.
    std::vector<unsigned char> bytes_;
};

/// A descriptor that a function reads.
struct Input {
    std::string name;
    std::string function;
    /// Sizes of the first version's mandatory fields and of the present struct.
    std::size_t smallest;
    std::size_t full;
    std::function<Memory(uint32_t)> make;
    std::function<haptoflow_status(Memory&)> call;
};

/// A descriptor that a function fills.
struct Output {
    std::string name;
    std::size_t full;
    std::function<haptoflow_status(Memory&)> call;
};

class DescriptorSizesTest : public ::testing::Test {
protected:
    void SetUp() override {
        generatorOptions_.struct_size = sizeof(generatorOptions_);
        generatorOptions_.runtime = open_.runtime;
        generatorOptions_.model = open_.model;
        engineOptions_.struct_size = sizeof(engineOptions_);
        engineOptions_.runtime = open_.runtime;
        engineOptions_.model = open_.model;
        ASSERT_EQ(haptoflow_generator_create(&generatorOptions_, &generator_), HAPTOFLOW_OK) << message();
        const char* space = nullptr;
        ASSERT_EQ(haptoflow_model_space(open_.model, &space), HAPTOFLOW_OK) << message();
        const std::string text = model::testing::validMaterial(space).dump();
        ASSERT_EQ(haptoflow_material_read(text.data(), text.size(), &material_), HAPTOFLOW_OK) << message();
        recordingOptions_.struct_size = sizeof(recordingOptions_);
        recordingOptions_.path = HAPTOFLOW_TEST_GOLDEN_DIR "/recordings/files/plain.csv";
        ASSERT_EQ(haptoflow_recording_read(&recordingOptions_, &recording_), HAPTOFLOW_OK) << message();
        // Makes the statistics that are read different from zero.
        for (int update = 0; update < 5; ++update) {
            (void)open_.update(slidingState());
        }
    }
    void TearDown() override {
        EXPECT_EQ(haptoflow_recording_close(&recording_), HAPTOFLOW_OK);
        EXPECT_EQ(haptoflow_material_close(&material_), HAPTOFLOW_OK);
        EXPECT_EQ(haptoflow_generator_close(&generator_), HAPTOFLOW_OK);
    }

    template <typename Descriptor>
    static Input input(const char* name, const char* function, std::size_t smallest, const Descriptor& content,
                       const std::function<haptoflow_status(const Descriptor*)>& call) {
        return {name,
                function,
                smallest,
                sizeof(Descriptor),
                [content](uint32_t size) { return Memory(content, size); },
                [call](Memory& memory) { return call(memory.as<Descriptor>()); }};
    }
    /// Opens an object, expects a handle if the status is HAPTOFLOW_OK, and closes it.
    template <typename Options, typename Handle>
    static std::function<haptoflow_status(const Options*)> opening(haptoflow_status (*open)(const Options*, Handle**),
                                                                   haptoflow_status (*close)(Handle**)) {
        return [open, close](const Options* options) {
            Handle* handle = nullptr;
            const haptoflow_status status = open(options, &handle);
            EXPECT_EQ(handle != nullptr, status == HAPTOFLOW_OK);
            EXPECT_EQ(close(&handle), HAPTOFLOW_OK);
            return status;
        };
    }
    template <typename Descriptor>
    static Output output(const char* name, const std::function<haptoflow_status(Descriptor*)>& call) {
        return {name, sizeof(Descriptor), [call](Memory& memory) { return call(memory.as<Descriptor>()); }};
    }

    std::vector<Input> inputs() {
        return {
            input<haptoflow_runtime_options>("haptoflow_runtime_options", "haptoflow_runtime_open",
                                             offsetof(haptoflow_runtime_options, log),
                                             {0, nullptr, HAPTOFLOW_TEST_ONNXRUNTIME, nullptr, nullptr},
                                             opening(haptoflow_runtime_open, haptoflow_runtime_close)),
            input<haptoflow_model_options>("haptoflow_model_options", "haptoflow_model_open",
                                           sizeof(haptoflow_model_options), {0, nullptr, 0, tinyModelPath.c_str()},
                                           opening(haptoflow_model_open, haptoflow_model_close)),
            input<haptoflow_generator_options>("haptoflow_generator_options", "haptoflow_generator_create",
                                               offsetof(haptoflow_generator_options, steps), generatorOptions_,
                                               opening(haptoflow_generator_create, haptoflow_generator_close)),
            input<haptoflow_batch>("haptoflow_batch", "haptoflow_generator_generate", offsetof(haptoflow_batch, phases),
                                   batch_,
                                   [this](const haptoflow_batch* batch) {
                                       return haptoflow_generator_generate(generator_, batch, segment_.data());
                                   }),
            input<haptoflow_batch>("haptoflow_batch", "haptoflow_generator_levels",
                                   offsetof(haptoflow_batch, previous_mps2), batch_,
                                   [this](const haptoflow_batch* batch) {
                                       return haptoflow_generator_levels(generator_, batch, segment_.data());
                                   }),
            input<haptoflow_engine_options>("haptoflow_engine_options", "haptoflow_engine_create",
                                            offsetof(haptoflow_engine_options, update_rate_hz), engineOptions_,
                                            opening(haptoflow_engine_create, haptoflow_engine_close)),
            input<haptoflow_wave_features_options>(
                "haptoflow_wave_features_options", "haptoflow_wave_features_create",
                sizeof(haptoflow_wave_features_options), {0, 8000, 0.005, 60.0, 400.0},
                opening(haptoflow_wave_features_create, haptoflow_wave_features_close)),
            input<haptoflow_recording_options>("haptoflow_recording_options", "haptoflow_recording_read",
                                               offsetof(haptoflow_recording_options, files), recordingOptions_,
                                               opening(haptoflow_recording_read, haptoflow_recording_close)),
            input<haptoflow_recording_info>("haptoflow_recording_info", "haptoflow_recording_create",
                                            offsetof(haptoflow_recording_info, acceleration), infoOf(made_),
                                            opening(haptoflow_recording_create, haptoflow_recording_close)),
            input<haptoflow_learning_options>("haptoflow_learning_options", "haptoflow_learn_material",
                                              offsetof(haptoflow_learning_options, seed), learningOptions_,
                                              opening(haptoflow_learn_material, haptoflow_learning_close)),
            input<haptoflow_contact_state>(
                "haptoflow_contact_state", "haptoflow_voice_publish",
                offsetof(haptoflow_contact_state, approach_speed_mps), slidingState(),
                [this](const haptoflow_contact_state* state) { return haptoflow_voice_publish(open_.voice, state); }),
        };
    }

    std::vector<Output> outputs() {
        return {
            output<haptoflow_model_info>(
                "haptoflow_model_info",
                [this](haptoflow_model_info* info) { return haptoflow_model_describe(open_.model, info); }),
            output<haptoflow_material_info>(
                "haptoflow_material_info",
                [this](haptoflow_material_info* info) { return haptoflow_material_describe(material_, info); }),
            output<haptoflow_recording_info>(
                "haptoflow_recording_info",
                [this](haptoflow_recording_info* info) { return haptoflow_recording_get_info(recording_, info); }),
            output<haptoflow_label_info>(
                "haptoflow_label_info",
                [this](haptoflow_label_info* info) { return haptoflow_model_label(open_.model, 1, info); }),
            output<haptoflow_tier_info>(
                "haptoflow_tier_info",
                [this](haptoflow_tier_info* info) { return haptoflow_model_tier(open_.model, 1, info); }),
            output<haptoflow_tier_times>(
                "haptoflow_tier_times",
                [this](haptoflow_tier_times* times) { return haptoflow_engine_tier_times(open_.engine, 0, times); }),
            output<haptoflow_engine_statistics>("haptoflow_engine_statistics",
                                                [this](haptoflow_engine_statistics* statistics) {
                                                    return haptoflow_engine_get_statistics(open_.engine, statistics);
                                                }),
            output<haptoflow_voice_statistics>("haptoflow_voice_statistics",
                                               [this](haptoflow_voice_statistics* statistics) {
                                                   return haptoflow_voice_get_statistics(open_.voice, statistics);
                                               }),
            output<haptoflow_exposure>(
                "haptoflow_exposure",
                [this](haptoflow_exposure* exposure) { return haptoflow_voice_exposure(open_.voice, exposure); }),
            output<haptoflow_signal_statistics>("haptoflow_signal_statistics",
                                                [this](haptoflow_signal_statistics* statistics) {
                                                    return haptoflow_voice_signal_statistics(open_.voice, statistics);
                                                }),
            output<haptoflow_effect_statistics>("haptoflow_effect_statistics",
                                                [this](haptoflow_effect_statistics* statistics) {
                                                    return haptoflow_voice_effect_statistics(
                                                        open_.voice, HAPTOFLOW_EFFECT_TEXTURE, statistics);
                                                }),
        };
    }

    OpenEngine open_{tinyModelPath};
    haptoflow_generator_options generatorOptions_{};
    haptoflow_engine_options engineOptions_{};
    learning::testing::MadeRecording made_{{}, {.seconds = 4.0}};
    MadeHandle madeRecording_{infoOf(made_)};
    haptoflow_learning_options learningOptions_ = optionsOf(madeRecording_.recording, open_.runtime, open_.model);
    haptoflow_recording_options recordingOptions_{};
    haptoflow_recording* recording_ = nullptr;
    haptoflow_generator* generator_ = nullptr;
    haptoflow_material* material_ = nullptr;
    std::array<float, HAPTOFLOW_EMBEDDING_SIZE> embedding_{};
    std::array<float, HAPTOFLOW_MOTION_SIZE> motion_{0.1F, 0.0F, 1.0F};
    std::array<float, HAPTOFLOW_SEGMENT_SAMPLES> silence_{};
    std::array<float, HAPTOFLOW_SEGMENT_SAMPLES> segment_{};
    haptoflow_batch batch_{
        0, 1, embedding_.data(), motion_.data(), silence_.data(), silence_.data(), nullptr, nullptr, nullptr};
};

TEST_F(DescriptorSizesTest, EveryDescriptorOfTheHeaderIsInATable) {
    std::set<std::string> tabled;
    for (const Input& input : inputs()) {
        tabled.insert(input.name);
    }
    for (const Output& output : outputs()) {
        tabled.insert(output.name);
    }
    EXPECT_EQ(tabled, declaredDescriptors());
}

TEST_F(DescriptorSizesTest, AnInputOfAnOlderCallerIsAcceptedAndNothingBeyondItsEndIsRead) {
    for (const Input& input : inputs()) {
        for (const std::size_t size : {input.smallest, input.full}) {
            Memory given = input.make(static_cast<uint32_t>(size));
            const Memory before = given;
            EXPECT_EQ(input.call(given), HAPTOFLOW_OK) << input.function << ", " << size << " bytes: " << message();
            EXPECT_EQ(given, before) << input.function << " changed its input";
        }
    }
    EXPECT_EQ(open_.statistics().sanitised, 0U) << "an approach speed was read beyond the end of the caller's struct";
}

TEST_F(DescriptorSizesTest, AnInputOfANewerCallerIsAcceptedAndItsUnknownFieldsAreIgnored) {
    for (const Input& input : inputs()) {
        for (const std::size_t size : {input.full + 1, input.full + 8, input.full + 64, maximumSize}) {
            Memory given = input.make(static_cast<uint32_t>(size));
            const Memory before = given;
            EXPECT_EQ(input.call(given), HAPTOFLOW_OK) << input.function << ", " << size << " bytes: " << message();
            EXPECT_EQ(given, before) << input.function << " changed its input";
        }
    }
}

TEST_F(DescriptorSizesTest, AnInputThatIsTooSmallForItsMandatoryFieldsOrHasNoSizeIsRefused) {
    const std::uint64_t updates = open_.statistics().updates;
    for (const Input& input : inputs()) {
        for (const std::size_t size : {std::size_t{0}, std::size_t{3}, sizeof(uint32_t), input.smallest - 1,
                                       maximumSize + 1, std::size_t{UINT32_MAX}}) {
            Memory given = input.make(static_cast<uint32_t>(input.full));
            *given.as<uint32_t>() = static_cast<uint32_t>(size);
            EXPECT_EQ(input.call(given), HAPTOFLOW_INVALID_ARGUMENT) << input.function << ", " << size << " bytes";
            EXPECT_THAT(message(), ::testing::HasSubstr("struct_size is " + std::to_string(size))) << input.function;
        }
    }
    EXPECT_EQ(open_.statistics().updates, updates) << "a refused state is not published";
}

TEST_F(DescriptorSizesTest, AnOutputIsFilledUpToTheCallersSizeAndReportsTheFilledSize) {
    for (const Output& output : outputs()) {
        Memory whole(static_cast<uint32_t>(output.full));
        ASSERT_EQ(output.call(whole), HAPTOFLOW_OK) << output.name << ": " << message();
        for (std::size_t size = sizeof(uint32_t); size <= output.full + 64; ++size) {
            Memory filled(static_cast<uint32_t>(size));
            ASSERT_EQ(output.call(filled), HAPTOFLOW_OK) << output.name << ", " << size << " bytes: " << message();
            EXPECT_TRUE(filled.holds(whole, std::min(size, output.full))) << output.name << ", " << size << " bytes";
            EXPECT_EQ(*filled.as<uint32_t>(), std::min(size, output.full)) << output.name << ", " << size << " bytes";
        }
    }
}

TEST_F(DescriptorSizesTest, AnOutputWithoutASizeIsRefusedAndUnchanged) {
    for (const Output& output : outputs()) {
        for (const std::size_t size :
             {std::size_t{0}, std::size_t{1}, std::size_t{3}, maximumSize + 1, std::size_t{UINT32_MAX}}) {
            Memory given(static_cast<uint32_t>(size));
            const Memory before = given;
            EXPECT_EQ(output.call(given), HAPTOFLOW_INVALID_ARGUMENT) << output.name << ", " << size << " bytes";
            EXPECT_THAT(message(), ::testing::HasSubstr("struct_size is " + std::to_string(size))) << output.name;
            EXPECT_EQ(given, before) << output.name << ", " << size << " bytes";
        }
    }
}

}  // namespace
}  // namespace haptoflow::capi::testing
