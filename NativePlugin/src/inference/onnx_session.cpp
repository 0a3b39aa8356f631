#include "inference/onnx_session.hpp"

#include "inference/load_limits.hpp"
#include "model/model_error.hpp"

#include <onnxruntime_c_api.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

namespace haptoflow::inference {
namespace {

constexpr std::uint32_t apiWithSessionLog = 17;
constexpr std::uint32_t apiWithLoadCancellation = 22;
constexpr auto retryInterval = std::chrono::milliseconds(1);

void ORT_API_CALL writeLog(void* sink, OrtLoggingLevel severity, const char* category, const char* /*log*/,
                           const char* /*location*/, const char* message) {
    static_cast<LogSink*>(sink)->write(static_cast<LogSeverity>(severity), category, message);
}

OrtHandle<OrtSessionOptions> createOptions(const Runtime& runtime, bool usesSharedArena) {
    const OrtApi& api = runtime.api();
    OrtSessionOptions* created = nullptr;
    runtime.check(api.CreateSessionOptions(&created), "session options");
    OrtHandle<OrtSessionOptions> options(created, api.ReleaseSessionOptions);
    // One thread: a voice's update is far shorter than waking a second thread, and a spinning pool would occupy a core.
    runtime.check(api.SetIntraOpNumThreads(created, 1), "session options");
    runtime.check(api.SetInterOpNumThreads(created, 1), "session options");
    const auto configure = [&](const char* key, const char* value) {
        runtime.check(api.AddSessionConfigEntry(created, key, value), "session options");
    };
    configure("session.intra_op.allow_spinning", "0");
    configure("session.inter_op.allow_spinning", "0");
    // Accept only ONNX, which was checked before, and not the runtime's own format.
    configure("session.load_model_format", "ONNX");
    configure("session.use_env_allocators", usesSharedArena ? "1" : "0");
    runtime.check(api.SetSessionGraphOptimizationLevel(created, ORT_ENABLE_ALL), "session options");
    if (runtime.log() != nullptr && runtime.apiVersion() >= apiWithSessionLog) {
        runtime.check(api.SetUserLoggingFunction(created, writeLog, runtime.log()), "session options");
        runtime.check(api.SetSessionLogSeverityLevel(created, ORT_LOGGING_LEVEL_WARNING), "session options");
    }
    return options;
}

/// During its lifetime, a session created with the environment's allocators gets a memory arena of limited size, which
/// the session then keeps. The environment belongs to the whole process, so only one LimitedArena exists at a time.
class LimitedArena {
public:
    LimitedArena(const Runtime& runtime, std::size_t memoryBytes, const LoadLimits& limits)
        : runtime_(runtime), lock_(mutex(), std::defer_lock), memory_(createMemoryInfo(runtime)) {
        // No timed mutex, because the thread sanitizer of GCC 12 does not recognise its lock.
        while (!lock_.try_lock()) {
            limits.check();
            std::this_thread::sleep_for(retryInterval);
        }
        const OrtApi& api = runtime_.api();
        // Regions of the requested size, because the unused part of doubling regions would count against the limit.
        const std::array<const char*, 2> keys{"max_mem", "arena_extend_strategy"};
        const std::array<std::size_t, 2> values{memoryBytes, 1};
        OrtArenaCfg* created = nullptr;
        runtime_.check(api.CreateArenaCfgV2(keys.data(), values.data(), keys.size(), &created), "memory arena");
        const OrtHandle<OrtArenaCfg> settings(created, api.ReleaseArenaCfg);
        isRegistered_ = succeeded(api.CreateAndRegisterAllocator(&runtime_.environment(), memory_.get(), created));
    }
    LimitedArena(const LimitedArena&) = delete;
    LimitedArena& operator=(const LimitedArena&) = delete;
    ~LimitedArena() {
        if (isRegistered_) {
            (void)succeeded(runtime_.api().UnregisterAllocator(&runtime_.environment(), memory_.get()));
        }
    }

    /// False if the application has registered its own arena with the environment; sessions then have an unlimited one.
    [[nodiscard]] bool isRegistered() const noexcept { return isRegistered_; }

private:
    static std::mutex& mutex() {
        static std::mutex each;
        return each;
    }
    [[nodiscard]] bool succeeded(OrtStatus* status) const {
        const bool isFine = status == nullptr;
        runtime_.api().ReleaseStatus(status);
        return isFine;
    }

    const Runtime& runtime_;
    std::unique_lock<std::mutex> lock_;
    OrtHandle<OrtMemoryInfo> memory_;
    bool isRegistered_ = false;
};

}  // namespace

OrtHandle<OrtMemoryInfo> createMemoryInfo(const Runtime& runtime) {
    OrtMemoryInfo* memory = nullptr;
    runtime.check(runtime.api().CreateCpuMemoryInfo(OrtArenaAllocator, OrtMemTypeDefault, &memory), "memory info");
    return {memory, runtime.api().ReleaseMemoryInfo};
}

OrtHandle<OrtIoBinding> createBinding(const Runtime& runtime, OrtSession& session) {
    OrtIoBinding* binding = nullptr;
    runtime.check(runtime.api().CreateIoBinding(&session, &binding), "binding");
    return {binding, runtime.api().ReleaseIoBinding};
}

OrtHandle<OrtSession> createSession(const Runtime& runtime, std::span<const std::byte> graph, std::size_t memoryBytes,
                                    const LoadLimits& limits) {
    limits.check();
    const OrtApi& api = runtime.api();
    const LimitedArena arena(runtime, memoryBytes, limits);
    const auto options = createOptions(runtime, arena.isRegistered());
    const CancellationAction stop(limits.cancellation.get(), [&] {
        if (runtime.apiVersion() >= apiWithLoadCancellation) {
            if (OrtStatus* status = api.SessionOptionsSetLoadCancellationFlag(options.get(), true)) {
                api.ReleaseStatus(status);
            }
        }
    });
    OrtSession* session = nullptr;
    OrtStatus* status =
        api.CreateSessionFromArray(&runtime.environment(), graph.data(), graph.size(), options.get(), &session);
    const OrtHandle<OrtStatus> failure(status, api.ReleaseStatus);
    OrtHandle<OrtSession> made(session, api.ReleaseSession);
    limits.check();
    if (failure != nullptr) {
        throw InferenceError(std::string("loading the graph: ") + api.GetErrorMessage(failure.get()));
    }
    return made;
}

namespace {

using TypeInfoOf = OrtStatus*(ORT_API_CALL*)(const OrtSession*, std::size_t, OrtTypeInfo**);
using NameOf = OrtStatus*(ORT_API_CALL*)(const OrtSession*, std::size_t, OrtAllocator*, char**);

std::string describe(const std::vector<std::int64_t>& shape, const std::string& batch) {
    std::string text = '[' + batch;
    for (const std::int64_t dimension : shape) {
        text += ',' + (dimension < 0 ? std::string("?") : std::to_string(dimension));
    }
    return text + ']';
}

class SignatureReader {
public:
    SignatureReader(const Runtime& runtime, const OrtSession& session, const std::string& graphName)
        : runtime_(runtime), session_(session), graphName_(graphName) {}

    [[noreturn]] void refuse(const std::string& message) const {
        throw model::ModelError(model::ModelStatus::inconsistent, graphName_ + ": " + message);
    }

    [[nodiscard]] std::string name(NameOf nameOf, std::size_t index) const {
        OrtAllocator* allocator = nullptr;
        runtime_.check(runtime_.api().GetAllocatorWithDefaultOptions(&allocator), graphName_);
        char* text = nullptr;
        runtime_.check(nameOf(&session_, index, allocator, &text), graphName_);
        const auto release = [allocator](char* memory) { allocator->Free(allocator, memory); };
        const std::unique_ptr<char, decltype(release)> owner(text, release);
        return text;
    }

    void requireTensor(TypeInfoOf typeInfoOf, std::size_t index, const TensorSignature& expected,
                       const std::string& role) const {
        const OrtApi& api = runtime_.api();
        OrtTypeInfo* type = nullptr;
        runtime_.check(typeInfoOf(&session_, index, &type), graphName_);
        const std::unique_ptr<OrtTypeInfo, decltype(api.ReleaseTypeInfo)> owner(type, api.ReleaseTypeInfo);
        const OrtTensorTypeAndShapeInfo* tensor = nullptr;
        runtime_.check(api.CastTypeInfoToTensorInfo(type, &tensor), graphName_);

        const std::string who = role + " \"" + expected.name + '"';
        ONNXTensorElementDataType element = ONNX_TENSOR_ELEMENT_DATA_TYPE_UNDEFINED;
        if (tensor != nullptr) {
            runtime_.check(api.GetTensorElementType(tensor, &element), graphName_);
        }
        if (element != ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT) {
            refuse(who + " is not a float32 tensor");
        }
        std::size_t dimensionCount = 0;
        runtime_.check(api.GetDimensionsCount(tensor, &dimensionCount), graphName_);
        std::vector<std::int64_t> found(dimensionCount);
        runtime_.check(api.GetDimensions(tensor, found.data(), found.size()), graphName_);
        requireShape(found, expected, who);
    }

private:
    void requireShape(const std::vector<std::int64_t>& found, const TensorSignature& expected,
                      const std::string& who) const {
        const bool sameRank = found.size() == expected.shape.size() + 1;
        // A dimension that the graph leaves open (-1) accepts any size here; the probe run checks it.
        if (!sameRank ||
            !std::equal(expected.shape.begin(), expected.shape.end(), found.begin() + 1,
                        [](std::int64_t size, std::int64_t actual) { return actual < 0 || actual == size; })) {
            refuse(who + " has the shape " + describe(found, "").erase(1, found.empty() ? 0 : 1) + "; expected " +
                   describe(expected.shape, "B"));
        }
        if (found.front() >= 0) {
            refuse(who + " has a fixed batch of " + std::to_string(found.front()) + "; the batch must be free");
        }
    }

    const Runtime& runtime_;
    const OrtSession& session_;
    const std::string& graphName_;
};

}  // namespace

std::vector<bool> matchSignature(const Runtime& runtime, const OrtSession& session, const GraphSignature& expected,
                                 const std::string& graphName) {
    const OrtApi& api = runtime.api();
    const SignatureReader reader(runtime, session, graphName);

    std::size_t inputCount = 0;
    runtime.check(api.SessionGetInputCount(&session, &inputCount), graphName);
    std::vector<bool> present(expected.inputs.size(), false);
    for (std::size_t index = 0; index < inputCount; ++index) {
        const std::string name = reader.name(api.SessionGetInputName, index);
        const auto match = std::find_if(expected.inputs.begin(), expected.inputs.end(),
                                        [&name](const TensorSignature& each) { return each.name == name; });
        if (match == expected.inputs.end()) {
            reader.refuse("has an input \"" + name + "\" that the format does not know");
        }
        reader.requireTensor(api.SessionGetInputTypeInfo, index, *match, "input");
        present[static_cast<std::size_t>(match - expected.inputs.begin())] = true;
    }

    std::size_t outputCount = 0;
    runtime.check(api.SessionGetOutputCount(&session, &outputCount), graphName);
    for (std::size_t index = 0; index < outputCount; ++index) {
        if (reader.name(api.SessionGetOutputName, index) == expected.output.name) {
            reader.requireTensor(api.SessionGetOutputTypeInfo, index, expected.output, "output");
            return present;
        }
    }
    reader.refuse("has no output \"" + expected.output.name + '"');
}

TimeLimit::TimeLimit(double milliseconds, std::function<void()> action)
    : end_(std::chrono::steady_clock::now() +
           std::chrono::microseconds(static_cast<std::chrono::microseconds::rep>(1000.0 * milliseconds))) {
    timer_ = std::thread([this, act = std::move(action)] {
        std::unique_lock lock(mutex_);
        if (!changed_.wait_until(lock, end_, [this] { return isOver_; })) {
            act();
        }
    });
}

TimeLimit::~TimeLimit() {
    {
        const std::lock_guard lock(mutex_);
        isOver_ = true;
    }
    changed_.notify_all();
    timer_.join();
}

}  // namespace haptoflow::inference
