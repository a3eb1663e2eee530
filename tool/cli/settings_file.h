// Settings in a file, which glint bench writes and --settings reads.
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

// --settings FILE, for commands that have some of bench::settingNames() as options.
void addSettingsFile(CLI::App& command, std::string& file);

// The text of a file. `origin`: the command line that it comes from.
std::string settingsText(const bench::Configuration& settings, const std::string& origin);

// Errors of readFile(); "settings-file" where it is no such file or has a setting that Glint does not know.
Result<bench::Configuration> readSettings(const std::filesystem::path& file);

// A command line, and what of it comes from a file.
struct CompletedLine {
    std::vector<std::string> words;
    std::string file;                  // empty: it names none
    std::vector<std::string> options;  // "--spp": those that the file gave
};

// `arguments`, without the program's name, with what the file of --settings says and they do not. Of the
// file are left out options that the command does not have and, beside --package, those that the package has
// decided. Errors of readSettings().
Result<CompletedLine> completeLine(const CLI::App& app, std::span<const char* const> arguments);

// What a complaint of CLI11 says of the file, where it is about one of its options: error "settings-file".
std::optional<Diagnostic> blameFile(const CompletedLine& line, const std::string& complaint);

}  // namespace glint
