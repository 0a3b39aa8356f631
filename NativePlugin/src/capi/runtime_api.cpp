#include "capi/handles.hpp"
#include "capi/utf8_path.hpp"

#include <cstddef>

using namespace haptoflow;
using namespace haptoflow::capi;

haptoflow_status haptoflow_runtime_open(const haptoflow_runtime_options* options, haptoflow_runtime** runtime) {
    return guarded([&] {
        const auto given = readDescriptor(options, sizeof(haptoflow_runtime_options), "options");
        (void)require(runtime, "runtime");
        if ((given.ort_api_base == nullptr) == (given.library_path == nullptr)) {
            throw std::invalid_argument("options: exactly one of ort_api_base and library_path must be set");
        }
        *runtime =
            runtimes().open(given.ort_api_base != nullptr
                                ? inference::Runtime::fromApiBase(static_cast<const OrtApiBase*>(given.ort_api_base))
                                : inference::Runtime::open(utf8Path(given.library_path)));
    });
}

haptoflow_status haptoflow_runtime_close(haptoflow_runtime** runtime) {
    return guarded([&] { closeHandle(runtimes(), runtime, "runtime"); });
}
