#include "inference/onnx_session.hpp"

#include <onnxruntime_c_api.h>

#include <array>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>

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

OrtHandle<OrtSession> createSession(const Runtime& runtime, std::span<const std::byte> graph,
                                    std::size_t memoryBytes, const LoadLimits& limits) {
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

}  // namespace haptoflow::inference
