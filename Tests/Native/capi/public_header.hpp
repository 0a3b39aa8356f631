#pragma once

#include "open_handles.hpp"

#include <cstddef>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

namespace haptoflow::capi::testing {

struct DeclaredFunction {
    std::string name;
    /// The comment before the function.
    std::string comment;
    /// Number of parameters that are pointers.
    std::size_t pointers = 0;
};

/// The header's functions that have a comment before them.
inline std::vector<DeclaredFunction> declaredFunctions() {
    const std::string text = textOf(HAPTOFLOW_TEST_HEADER);
    const std::regex declaration(R"(/\*((?:[^*]|\*(?!/))*)\*/\s*HAPTOFLOW_API[^(;]*?(haptoflow_\w+)\(([^)]*)\);)");
    const std::regex pointer(R"(\*+)");
    std::vector<DeclaredFunction> functions;
    for (std::sregex_iterator match(text.begin(), text.end(), declaration), end; match != end; ++match) {
        const std::string parameters = (*match)[3];
        const auto pointers =
            std::distance(std::sregex_iterator(parameters.begin(), parameters.end(), pointer), std::sregex_iterator());
        functions.push_back({(*match)[2], (*match)[1], static_cast<std::size_t>(pointers)});
    }
    return functions;
}

}  // namespace haptoflow::capi::testing
