#include "capi/handles.hpp"

using namespace haptoflow;
using namespace haptoflow::capi;

haptoflow_status haptoflow_cancellation_create(haptoflow_cancellation** cancellation) {
    return guarded([&] {
        (void)require(cancellation, "cancellation");
        *cancellation = cancellations().open(std::make_shared<inference::Cancellation>());
    });
}

haptoflow_status haptoflow_cancellation_cancel(haptoflow_cancellation* cancellation) {
    return guarded([&] { cancellations().get(cancellation)->cancel(); });
}

haptoflow_status haptoflow_cancellation_close(haptoflow_cancellation** cancellation) {
    return guarded([&] { closeHandle(cancellations(), cancellation, "cancellation"); });
}
