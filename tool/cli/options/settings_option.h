// The option --settings: a file of settings, as glint bench writes it, completes a command line.
#pragma once

#include <glint/result.h>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint::cli {

// Adds --settings FILE, for commands that have some of settingNames() as options.
void addSettingsFile(CLI::App& command, std::string& file);

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

}  // namespace glint::cli
