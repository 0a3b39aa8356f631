#include "input_file.hpp"

#include "command_files.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace haptoflow::cli {

std::string readInputFile(const std::string& role, const std::string& path, const std::string& expected) {
    claimInput(role, path);
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
        throw InputError(path + ": is a folder; expected " + expected);
    }
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw InputError(path + ": cannot be opened; expected " + expected);
    }
    constexpr std::size_t maximumBytes = std::size_t{1} << 30U;
    std::string text;
    std::array<char, 1U << 16U> part{};
    while (text.size() <= maximumBytes && (file.read(part.data(), part.size()) || file.gcount() > 0)) {
        text.append(part.data(), static_cast<std::size_t>(file.gcount()));
    }
    if (text.size() > maximumBytes) {
        throw InputError(path + ": is larger than 1 GiB; expected " + expected);
    }
    if (file.bad()) {
        throw InputError(path + ": cannot be read to its end; expected " + expected);
    }
    return text;
}

}  // namespace haptoflow::cli
