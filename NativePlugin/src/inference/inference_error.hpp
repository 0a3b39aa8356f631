#pragma once

#include <stdexcept>

namespace haptoflow::inference {

/// ONNX Runtime cannot be had: no library at the path, not its API, or a version older than 1.16.
class RuntimeUnavailable : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A graph failed while running, or what it returned is not a finite waveform.
class InferenceError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A load ended because its Cancellation came.
class LoadCancelled : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A probe run of a tier's graph took longer than its limit. The message names tier and graph.
class TierTooSlow : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace haptoflow::inference
