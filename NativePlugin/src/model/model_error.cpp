#include "model/model_error.hpp"

namespace haptoflow::model {

std::string_view statusName(ModelStatus status) noexcept {
    switch (status) {
        case ModelStatus::unreadable:
            return "unreadable";
        case ModelStatus::notAModel:
            return "not a model";
        case ModelStatus::truncated:
            return "truncated";
        case ModelStatus::tooNew:
            return "too new";
        case ModelStatus::oversized:
            return "oversized";
        case ModelStatus::damaged:
            return "damaged";
        case ModelStatus::inconsistent:
            return "inconsistent";
    }
    return "unknown";
}

ModelError::ModelError(ModelStatus status, const std::string& message) : std::runtime_error(message), status_(status) {}

}  // namespace haptoflow::model
