#pragma once

#include <stdexcept>

namespace haptoflow::inference {

/// ONNX Runtime cannot be used: there is no library at the path, it has another API, or it is older than 1.16.
class RuntimeUnavailable : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A graph failed while running, or returned a waveform that is not finite.
class InferenceError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A load was stopped by its Cancellation.
class LoadCancelled : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A probe run of a tier's graph exceeded its time limit. The message names tier and graph.
class TierTooSlow : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace haptoflow::inference
