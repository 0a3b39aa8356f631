#pragma once

#include <cstddef>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace haptoflow::capi::testing {

inline std::string textOf(const std::string& path) {
    std::ifstream stream(path);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// The text of haptoflow.h.
inline std::string headerText() {
    return textOf(HAPTOFLOW_TEST_HEADER);
}

struct DeclaredFunction {
    std::string name;
    /// The comment before the function.
    std::string comment;
    /// Number of parameters that are pointers.
    std::size_t pointers = 0;
};

/// The header's functions that have a comment before them.
inline std::vector<DeclaredFunction> declaredFunctions() {
    const std::string text = headerText();
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

/// The header's structs that begin with struct_size.
inline std::set<std::string> declaredDescriptors() {
    const std::string text = headerText();
    const std::regex declaration(R"(typedef struct (haptoflow_\w+) \{\s*uint32_t struct_size;)");
    std::set<std::string> names;
    for (std::sregex_iterator match(text.begin(), text.end(), declaration), end; match != end; ++match) {
        names.insert((*match)[1]);
    }
    return names;
}

}  // namespace haptoflow::capi::testing
