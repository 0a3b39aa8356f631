#include "model/model_error.hpp"
#include "model/onnx_check.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        haptoflow::model::checkOnnxModel(std::as_bytes(std::span(data, size)), "fuzzed");
    } catch (const haptoflow::model::ModelError&) {
    }
    return 0;
}
