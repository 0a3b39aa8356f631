#include "inference/onnx_signature.hpp"

#include "inference/inference_error.hpp"
#include "model/model_error.hpp"

#include <onnxruntime_c_api.h>

#include <algorithm>
#include <memory>

namespace haptoflow::inference {
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

}  // namespace haptoflow::inference
