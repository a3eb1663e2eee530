// The environment map of glint render: its options, its file, and messages about it.
#pragma once

#include "cli/options.h"

#include <glint/environment.h>
#include <glint/renderer.h>

#include <memory>
#include <string>
#include <vector>

namespace glint {

struct EnvironmentArguments {
    std::string file;       // empty: no environment map
    double rotation = 0.0;  // degrees
    double intensity = 1.0;
    void apply(FrameOptions& frame) const;
};
void addEnvironmentOptions(CLI::App& command, EnvironmentArguments& arguments);
// Throws a CLI::ParseError if an option of the map is given without a map.
void checkEnvironmentOptions(const CLI::App& command);

// Reads a .hdr or .exr file and makes the map. Appends warnings and notes. Has the errors of readRadiance()
// and Environment::create(), with the file as their place.
Result<std::unique_ptr<Environment>> loadEnvironment(Context& context, const std::string& file,
                                                     std::vector<Diagnostic>& notes);

}  // namespace glint
