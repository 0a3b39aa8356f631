#include "messages.hpp"

#include "model/plain_text.hpp"

#include <iostream>

namespace haptoflow::cli {

void complain(std::string_view text) {
    std::cerr << "haptoflow: " << model::printable(text) << '\n';
}

void note(std::string_view text) {
    std::cerr << "haptoflow: note: " << model::printable(text) << '\n';
}

}  // namespace haptoflow::cli
