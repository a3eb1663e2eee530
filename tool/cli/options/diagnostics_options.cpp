#include "cli/options/diagnostics_options.h"

#include "base/suggest.h"
#include "cli/options/diagnostic_table.h"
#include "cli/options/options.h"

#include <string_view>

namespace glint::cli {

namespace {

constexpr std::string_view kNoPrefix = "no-";
constexpr std::string_view kErrorWord = "error";
constexpr std::string_view kErrorPrefix = "error=";
// The value that CLI11 gives to a flag without a value.
constexpr std::string_view kAll = "true";

std::vector<std::string> idsOf(std::uint8_t severities) {
    std::vector<std::string> ids;
    for (const DiagnosticInfo& info : diagnosticTable()) {
        if ((info.severities & severities) != 0) {
            ids.emplace_back(info.id);
        }
    }
    return ids;
}

// Returns an empty text if `id` names a diagnostic of one of the severities, else the reason why it does not.
std::string checkId(const std::string& id, std::uint8_t severities) {
    const DiagnosticInfo* const info = findDiagnostic(id);
    if (info == nullptr) {
        const std::string suggestion = base::suggestion(id, idsOf(severities));
        return "there is no diagnostic \"" + id + "\"" +
               (suggestion.empty() ? "; docs/diagnostics.md lists them" : suggestion);
    }
    return (info->severities & severities) != 0 ? std::string()
                                                : "\"" + id + "\" is always an error; name a warning";
}

std::string checkWarning(const std::string& value) {
    const std::string_view text = value;
    if (text == kErrorWord) {
        return {};
    }
    if (text.starts_with(kErrorPrefix)) {
        return checkId(value.substr(kErrorPrefix.size()), kWarning);
    }
    if (text.starts_with(kNoPrefix)) {
        return checkId(value.substr(kNoPrefix.size()), kWarning | kNote);
    }
    return "\"" + value + "\" is neither no-ID, error nor error=ID; give one of these";
}

}  // namespace

ConsoleOptions ReportArguments::options() const {
    ConsoleOptions options;
    options.json = json;
    options.quiet = quiet;
    options.verbose = verbose;
    options.color = color == "always"  ? ColorChoice::Always
                    : color == "never" ? ColorChoice::Never
                                       : ColorChoice::Auto;
    for (const std::string& id : werror) {
        if (id == kAll) {
            options.policy.allErrors = true;
        } else {
            options.policy.errors.insert(id);
        }
    }
    for (const std::string& value : warnings) {
        if (value == kErrorWord) {
            options.policy.allErrors = true;
        } else if (value.starts_with(kErrorPrefix)) {
            options.policy.errors.insert(value.substr(kErrorPrefix.size()));
        } else {
            options.policy.dropped.insert(value.substr(kNoPrefix.size()));
        }
    }
    return options;
}

void ReportArguments::check() const {
    if (quiet && verbose) {
        throw CLI::ValidationError("--verbose", "can't be combined with --quiet; leave out one of them");
    }
}

void addReportOptions(CLI::App& command, ReportArguments& arguments) {
    const std::string group = "Report";
    if (command.get_option_no_throw("--json") == nullptr) {
        addFlag(command, "--json", arguments.json, "print the result and all diagnostics as JSON")
            .group(group);
    }
    addFlag(command, "-q,--quiet", arguments.quiet, "print only errors").group(group);
    addFlag(command, "-v,--verbose", arguments.verbose, "print what is read, decided and made, with times")
        .group(group);
    addChoice(command, "--color", arguments.color, {"auto", "always", "never"},
              "colour of diagnostics; auto: where stderr is a terminal\nand NO_COLOR is not set")
        .group(group);
    command
        .add_flag("--werror", arguments.werror,
                  "treat warnings as errors; --werror=ID: only those of this\n"
                  "id; may be repeated")
        ->group(group)
        ->check(CLI::Validator(
            [](const std::string& id) { return id == kAll ? std::string() : checkId(id, kWarning); }, ""));
    command
        .add_option("-W", arguments.warnings,
                    "hide warnings and notes; -Wno-ID: those of this id; -Werror,\n"
                    "-Werror=ID: the same as --werror; may be repeated")
        ->type_name("no-ID|error=ID")
        ->allow_extra_args(false)
        ->group(group)
        ->check(CLI::Validator(checkWarning, ""));
}

}  // namespace glint::cli
