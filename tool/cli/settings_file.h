// Files of settings, which glint bench writes and --settings reads.
#pragma once

#include "bench/settings.h"

#include <glint/result.h>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint {

// Adds --settings FILE, for commands that have some of bench::settingNames() as options.
void addSettingsFile(CLI::App& command, std::string& file);

// Returns the text of a file. `origin` is the command line that it comes from.
std::string settingsText(const bench::Configuration& settings, const std::string& origin);

// Has the errors of readFile(), and "settings-file" if the file has another format or a setting that Glint
// does not know.
Result<bench::Configuration> readSettings(const std::filesystem::path& file);

// A command line, with the options that come from a file.
struct CompletedLine {
    std::vector<std::string> words;
    std::string file;                  // empty: it names none
    std::vector<std::string> options;  // "--spp": those that the file gave
};

// Returns `arguments`, which lack the program's name, plus the settings from the file of --settings that they
// do not give. Options that the command does not have are left out, and with --package those that the package
// has decided. Has the errors of readSettings().
Result<CompletedLine> completeLine(const CLI::App& app, std::span<const char* const> arguments);

// Returns the error "settings-file" if a complaint of CLI11 is about an option that came from the file.
std::optional<Diagnostic> blameFile(const CompletedLine& line, const std::string& complaint);

}  // namespace glint
