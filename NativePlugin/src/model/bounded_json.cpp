#include "model/bounded_json.hpp"

#include "model/model_error.hpp"

#include <string>
#include <unordered_set>
#include <vector>

namespace haptoflow::model {
namespace {

/// Checks the limits without building values, so that deeply nested text cannot exhaust memory.
class LimitChecker : public nlohmann::json_sax<nlohmann::json> {
public:
    explicit LimitChecker(std::string_view document) : document_(document) {}

    bool null() override { return true; }
    bool boolean(bool /*value*/) override { return true; }
    bool number_integer(number_integer_t /*value*/) override { return true; }
    bool number_unsigned(number_unsigned_t /*value*/) override { return true; }
    bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return true; }
    bool string(string_t& /*value*/) override { return true; }
    bool binary(binary_t& /*value*/) override { return true; }
    bool start_object(std::size_t /*elements*/) override {
        enter();
        return true;
    }
    bool start_array(std::size_t /*elements*/) override {
        enter();
        return true;
    }
    bool end_object() override {
        keys_.pop_back();
        return true;
    }
    bool end_array() override {
        keys_.pop_back();
        return true;
    }
    bool key(string_t& name) override {
        if (!keys_.back().insert(name).second) {
            throw ModelError(ModelStatus::inconsistent,
                             document_ + " names the key \"" + name.substr(0, 64) + "\" twice in one object");
        }
        return true;
    }
    bool parse_error(std::size_t position, const std::string& /*token*/,
                     const nlohmann::detail::exception& /*error*/) override {
        throw ModelError(ModelStatus::damaged,
                         document_ + " is not valid JSON at its byte " + std::to_string(position));
    }

private:
    void enter() {
        if (keys_.size() >= static_cast<std::size_t>(maximumJsonDepth)) {
            throw ModelError(ModelStatus::oversized,
                             document_ + " nests deeper than " + std::to_string(maximumJsonDepth) + " levels");
        }
        keys_.emplace_back();
    }

    std::string document_;
    std::vector<std::unordered_set<std::string>> keys_;
};

}  // namespace

nlohmann::json parseBoundedJson(std::string_view text, std::string_view document) {
    LimitChecker checker(document);
    nlohmann::json::sax_parse(text, &checker);
    return nlohmann::json::parse(text);
}

}  // namespace haptoflow::model
