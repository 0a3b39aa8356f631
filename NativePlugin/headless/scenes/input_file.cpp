#include "headless/scenes/input_file.hpp"

#include "headless/scenes/command_files.hpp"
#include "recordings/recording.hpp"
#include "recordings/recording_files.hpp"

namespace haptoflow::cli {

std::string readInputFile(const std::string& role, const std::string& path, const std::string& expected) {
    claimInput(role, path);
    try {
        return recordings::readWholeFile(path, expected);
    } catch (const recordings::RecordingUnusable& error) {
        throw InputError(error.what());
    }
}

}  // namespace haptoflow::cli
