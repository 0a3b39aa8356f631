#include "../skeleton/skeleton_model.hpp"
#include "onnx_writer.hpp"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>

// Writes the initial corpus of the fuzzers into the folder named on the command line.

namespace {

using namespace haptoflow::model::testing;

void write(const std::filesystem::path& path, const Bytes& bytes) {
    std::ofstream stream(path, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!stream) {
        throw std::runtime_error("cannot write " + path.string());
    }
}

ModelBuilder latentModel() {
    ModelBuilder builder;
    auto& tier = builder.header["tiers"][1];
    tier["representation"] = "latent";
    tier["latent_shape"] = {16, 8};
    tier["encoder"] = "level";
    tier["decoder"] = "field";
    return builder;
}

ModelBuilder averageVelocityModel() {
    ModelBuilder builder;
    builder.header["tiers"][0]["kind"] = "average-velocity";
    builder.header["tiers"][1]["kind"] = "direct";
    builder.header["measurements"] = {{"loss", 0.25}};
    return builder;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: model_corpus FOLDER\n";
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    write(folder / "plain", ModelBuilder().build());
    write(folder / "latent", latentModel().build());
    write(folder / "average_velocity", averageVelocityModel().build());
    write(folder / "skeleton", haptoflow::skeleton::testing::refinedModel({.hidden = 2}).build());
    // For onnx_fuzzer.
    std::filesystem::create_directories(folder / "graphs");
    write(folder / "graphs" / "plain", levelGraph().apply("Identity", {"weighted"}, {"log_level"}).model().written());
    write(folder / "graphs" / "loop", loopingLevel());
    return 0;
}
