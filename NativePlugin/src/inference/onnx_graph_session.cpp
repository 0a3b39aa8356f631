#include "inference/graph_session.hpp"
#include "inference/load_limits.hpp"
#include "inference/onnx_runtime.hpp"
#include "model/model_error.hpp"

#include <onnxruntime_c_api.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace haptoflow::inference {
namespace {

template <typename Type>
using OrtHandle = std::unique_ptr<Type, void (*)(Type*)>;

constexpr std::uint32_t apiWithLoadCancellation = 22;
constexpr auto retryInterval = std::chrono::milliseconds(1);

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
    return options;
}

OrtHandle<OrtMemoryInfo> createMemoryInfo(const Runtime& runtime) {
    OrtMemoryInfo* memory = nullptr;
    runtime.check(runtime.api().CreateCpuMemoryInfo(OrtArenaAllocator, OrtMemTypeDefault, &memory), "memory info");
    return {memory, runtime.api().ReleaseMemoryInfo};
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

OrtHandle<OrtIoBinding> createBinding(const Runtime& runtime, OrtSession& session) {
    OrtIoBinding* binding = nullptr;
    runtime.check(runtime.api().CreateIoBinding(&session, &binding), "binding");
    return {binding, runtime.api().ReleaseIoBinding};
}

/// A session with one thread whose tensors, weights included, take at most `memoryBytes`. A graph that needs more fails
/// while loading or running. Throws InferenceError, LoadCancelled.
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

/// Compares a session's inputs and outputs with `expected`: names, element type, number of dimensions, a variable batch
/// dimension, and the other dimensions. Returns, for each expected input, whether the graph has it. Throws
/// model::ModelError (inconsistent); the message begins with `graphName`.
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

/// Runs an action on its own thread once a time has passed, unless it was destroyed before. For loading only, because
/// it starts a thread.
class TimeLimit {
public:
    /// The action must neither block nor throw. Throws std::system_error.
    TimeLimit(double milliseconds, std::function<void()> action);
    TimeLimit(const TimeLimit&) = delete;
    TimeLimit& operator=(const TimeLimit&) = delete;
    /// Waits for a running action. Afterwards the action never runs.
    ~TimeLimit();

    /// By the clock: on a busy machine the thread may not have run yet.
    [[nodiscard]] bool hasPassed() const { return std::chrono::steady_clock::now() >= end_; }

private:
    std::chrono::steady_clock::time_point end_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool isOver_ = false;
    std::thread timer_;
};

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

// Memory limit of a session: a constant, an amount per request of the batch, and copies of the weights, which exist as
// read from the file, as tensors and packed for the processor.
constexpr std::size_t memoryOfAnyGraph = std::size_t{64} << 20U;
constexpr std::size_t memoryOfRequest = std::size_t{4} << 20U;
constexpr std::size_t copiesOfWeights = 4;

/// A session of the library ONNX Runtime.
class OnnxGraphSession final : public GraphSession {
public:
    OnnxGraphSession(std::shared_ptr<const Runtime> runtime, std::span<const std::byte> graph, std::string name,
                     GraphSignature signature, std::size_t maximumBatch, const LoadLimits& limits);

    void run() override { run(nullptr, name_); }

private:
    void bind(std::size_t batch) override;
    void bind(const TensorSignature& tensor, std::size_t batch, std::vector<float>& buffer, bool isInput);
    /// Loads the graph and runs it once with maximumBatch_ requests within the limits.
    void probe(std::span<const std::byte> graph, const LoadLimits& limits);
    void run(const OrtRunOptions* options, const std::string& what);

    std::shared_ptr<const Runtime> runtime_;
    OrtHandle<OrtMemoryInfo> memory_;
    OrtHandle<OrtSession> session_;
    OrtHandle<OrtIoBinding> binding_;
};

OnnxGraphSession::OnnxGraphSession(std::shared_ptr<const Runtime> runtime, std::span<const std::byte> graph,
                                   std::string name, GraphSignature signature, std::size_t maximumBatch,
                                   const LoadLimits& limits)
    : GraphSession(std::move(name), std::move(signature), maximumBatch),
      runtime_(std::move(runtime)),
      memory_(nullptr, nullptr),
      session_(nullptr, nullptr),
      binding_(nullptr, nullptr) {
    try {
        memory_ = createMemoryInfo(*runtime_);
        probe(graph, limits);
    } catch (const InferenceError& error) {
        throw model::ModelError(model::ModelStatus::inconsistent, name_ + ": " + error.what());
    }
}

void OnnxGraphSession::probe(std::span<const std::byte> graph, const LoadLimits& limits) {
    const OrtApi& api = runtime_->api();
    const std::size_t memoryBytes = memoryOfAnyGraph + memoryOfRequest * maximumBatch_ + copiesOfWeights * graph.size();
    session_ = createSession(*runtime_, graph, memoryBytes, limits);
    present_ = matchSignature(*runtime_, *session_, signature_, name_);
    binding_ = createBinding(*runtime_, *session_);
    setBatch(maximumBatch_);

    OrtRunOptions* created = nullptr;
    runtime_->check(api.CreateRunOptions(&created), "run options");
    const OrtHandle<OrtRunOptions> options(created, api.ReleaseRunOptions);
    const auto terminate = [&] {
        if (OrtStatus* status = api.RunOptionsSetTerminate(options.get())) {
            api.ReleaseStatus(status);
        }
    };
    const std::size_t parts = (maximumBatch_ + probeBatch - 1) / probeBatch;
    const double limitMs = limits.probeLimitMs * static_cast<double>(parts);
    const CancellationAction cancelled(limits.cancellation.get(), terminate);
    const TimeLimit limit(limitMs, terminate);
    const auto explain = [&] {
        limits.check();
        if (limit.hasPassed()) {
            throw TierTooSlow(name_ + ": a run of " + std::to_string(maximumBatch_) + " took longer than " +
                              std::to_string(static_cast<std::int64_t>(std::ceil(limitMs))) +
                              " ms; choose a smaller tier or model, or a higher probe_limit_ms");
        }
    };
    try {
        run(options.get(), "a run of " + std::to_string(maximumBatch_) + " with at most " +
                               std::to_string(memoryBytes >> 20U) + " MiB failed");
    } catch (const InferenceError&) {
        explain();
        throw;
    }
    explain();
}

void OnnxGraphSession::bind(const TensorSignature& tensor, std::size_t batch, std::vector<float>& buffer,
                            bool isInput) {
    const OrtApi& api = runtime_->api();
    std::vector<std::int64_t> shape{static_cast<std::int64_t>(batch)};
    shape.insert(shape.end(), tensor.shape.begin(), tensor.shape.end());
    OrtValue* created = nullptr;
    runtime_->check(
        api.CreateTensorWithDataAsOrtValue(memory_.get(), buffer.data(), tensor.size() * batch * sizeof(float),
                                           shape.data(), shape.size(), ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT, &created),
        tensor.name);
    const OrtHandle<OrtValue> value(created, api.ReleaseValue);
    // The binding keeps its own reference to the value.
    runtime_->check(isInput ? api.BindInput(binding_.get(), tensor.name.c_str(), created)
                            : api.BindOutput(binding_.get(), tensor.name.c_str(), created),
                    tensor.name);
}

void OnnxGraphSession::bind(std::size_t batch) {
    runtime_->api().ClearBoundInputs(binding_.get());
    runtime_->api().ClearBoundOutputs(binding_.get());
    for (std::size_t index = 0; index < inputs_.size(); ++index) {
        if (present_[index]) {
            bind(signature_.inputs[index], batch, inputs_[index], true);
        }
    }
    bind(signature_.output, batch, output_, false);
}

void OnnxGraphSession::run(const OrtRunOptions* options, const std::string& what) {
    runtime_->check(runtime_->api().RunWithBinding(session_.get(), options, binding_.get()), what);
}

}  // namespace

std::unique_ptr<GraphSession> loadGraphSession(std::shared_ptr<const Runtime> runtime, std::span<const std::byte> graph,
                                               std::string name, GraphSignature signature, std::size_t maximumBatch,
                                               const LoadLimits& limits) {
    return std::make_unique<OnnxGraphSession>(std::move(runtime), graph, std::move(name), std::move(signature),
                                              maximumBatch, limits);
}

}  // namespace haptoflow::inference
