#include "capi/handles.hpp"

#include <cstddef>

using namespace haptoflow;
using namespace haptoflow::capi;

namespace {


}  // namespace

haptoflow_status haptoflow_runtime_open(const haptoflow_runtime_options* options, haptoflow_runtime** runtime) {
    return guarded([&] {
        const auto given = readDescriptor(options, "options");
        (void)require(runtime, "runtime");
        if ((given.ort_api_base == nullptr) == (given.library_path == nullptr)) {
            throw std::invalid_argument("options: exactly one of ort_api_base and library_path must be set");
        }
        const auto log =
            given.log != nullptr ? std::make_shared<inference::LogSink>(given.log, given.log_context) : nullptr;
        *runtime = runtimes().open(
            given.ort_api_base != nullptr
                ? inference::Runtime::fromApiBase(static_cast<const OrtApiBase*>(given.ort_api_base), log)
                : inference::Runtime::open(utf8Path(given.library_path), log));
    });
}

haptoflow_status haptoflow_runtime_close(haptoflow_runtime** runtime) {
    return guarded([&] {
        if (*require(runtime, "runtime") == nullptr) {
            return;
        }
        const auto open = runtimes().get(*runtime);
        closeHandle(runtimes(), runtime, "runtime");
        if (open->log() != nullptr) {
            open->log()->close();
        }
    });
}
