#include "contact_command.hpp"
#include "commands.hpp"
#include "exit_codes.hpp"
#include "scene_file.hpp"
#include "stroke_file.hpp"

#include <array>
#include <charconv>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>

namespace haptoflow::cli {
namespace {

constexpr int significantDigits = 12;

struct ContactOptions {
    std::string scenePath;
    std::string strokePath;
    std::string outputPath;
    contact::ContactSettings settings;
};

/// Twelve significant digits, with a point whatever the locale; never "-0".
void writeNumber(std::ostream& output, double value) {
    std::array<char, 32> digits{};
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value + 0.0,
                                            std::chars_format::general, significantDigits);
    output.write(digits.data(), end - digits.data());
}

void writeName(std::ostream& output, const std::string& name) {
    if (name.find_first_of(",\"\r\n") == std::string::npos) {
        output << name;
        return;
    }
    output << '"';
    for (const char letter : name) {
        output << (letter == '"' ? "\"\"" : std::string(1, letter));
    }
    output << '"';
}

void runContact(const ContactOptions& options) {
    const contact::Scene scene = readSceneFile(options.scenePath);
    const Stroke stroke = readStrokeFile(options.strokePath);
    if (options.outputPath.empty()) {
        writeContactStates(std::cout, scene, stroke, options.strokePath, options.settings);
        return;
    }
    std::ofstream file(options.outputPath, std::ios::binary);
    writeContactStates(file, scene, stroke, options.strokePath, options.settings);
    file.close();
    if (!file) {
        throw InputError(options.outputPath + ": cannot be written; expected a path in a folder that exists");
    }
}

}  // namespace

void writeContactStates(std::ostream& output, const contact::Scene& scene, const Stroke& stroke,
                        const std::string& strokeName, const contact::ContactSettings& settings) {
    contact::ContactTracker tracker(scene, settings);
    const std::size_t frames = frameCount(stroke, scene.updateRateHz, strokeName);
    output << "t,surface,touching,touch_counter,px,py,pz,nx,ny,nz,penetration_m,vx_mps,vy_mps,approach_mps,force_n\n";
    for (std::size_t frame = 0; frame < frames; ++frame) {
        const contact::ContactReading reading = tracker.update(frameAt(stroke, scene.updateRateHz, frame));
        writeNumber(output, reading.timeSeconds);
        output << ',';
        if (reading.touching) {
            writeName(output, scene.surfaces[static_cast<std::size_t>(reading.surfaceIndex)].name);
        }
        output << ',' << (reading.touching ? 1 : 0) << ',' << reading.touchCounter;
        for (const double value :
             {reading.pointMetres.x, reading.pointMetres.y, reading.pointMetres.z, reading.normal.x, reading.normal.y,
              reading.normal.z, reading.penetrationMetres, reading.tangentialVelocityMps.x,
              reading.tangentialVelocityMps.y, reading.approachSpeedMps, reading.forceNewtons}) {
            output << ',';
            writeNumber(output, value);
        }
        output << '\n';
    }
}

void addContactCommand(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command = app.add_subcommand("contact", "Print what a stroke touches, frame by frame, as CSV");
    const auto options = std::make_shared<ContactOptions>();
    command->add_option("scene", options->scenePath, "SCENE.json: surfaces, their materials and motions")
        ->required()
        ->type_name("SCENE.json");
    command->add_option("--stroke", options->strokePath, "Where the tip goes: t,x,y,z[,force][,qx,qy,qz,qw]")
        ->required()
        ->type_name("STROKE.csv");
    command->add_option("-o,--output", options->outputPath, "Write to this file instead of standard output")
        ->type_name("FILE");
    command
        ->add_option("--default-stiffness", options->settings.defaultStiffnessNewtonsPerMetre,
                     "N/m of surfaces that give no stiffness of their own")
        ->check(CLI::Range(1e-3, 1e7))
        ->capture_default_str();
    command
        ->add_option("--maximum-force", options->settings.maximumForceNewtons,
                     "Newtons at which spring and measured force saturate")
        ->check(CLI::Range(1e-3, 1e3))
        ->capture_default_str();
    command->footer(
        "One line per frame of the scene's update_rate (90 Hz where it gives none): time, the surface touched\n"
        "(empty without touch), touch-downs so far, the contact point and the normal out of the surface, how deep\n"
        "the tip sits in it, the tip's speed along the surface's two tangent axes, the speed with which this touch\n"
        "began, and the force: the stroke's own where it has one, else stiffness times depth.\n"
        "Metres, seconds, newtons; Unity's left-handed frame with y up.\n"
        "Example:\n"
        "  haptoflow contact scene.json --stroke stroke.csv -o states.csv\n"
        "Both files are explained in Documentation~/scene-and-stroke.md.");
    command->callback([options, &outcome] {
        runContact(*options);
        outcome.exitCode = exitDone;
    });
}

}  // namespace haptoflow::cli
