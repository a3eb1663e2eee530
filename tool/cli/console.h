// The output of the command: results go to stdout, diagnostics and progress to stderr.
#pragma once

#include <glint/measure/observer.h>
#include <glint/result.h>

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::cli {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;  // the input or the work failed
inline constexpr int kExitUsage = 2;   // the command line is wrong

enum class ColorChoice : std::uint8_t { Auto, Always, Never };
inline constexpr Named<ColorChoice> kColorChoiceNames[] = {
    {ColorChoice::Auto, "auto"}, {ColorChoice::Always, "always"}, {ColorChoice::Never, "never"}};
constexpr std::span<const Named<ColorChoice>> namesOf(ColorChoice /*type*/) {
    return kColorChoiceNames;
}

// Decides how diagnostics are reported, by id. Errors always stay errors.
struct DiagnosticPolicy {
    std::set<std::string, std::less<>> dropped;  // warnings and notes that are left out
    std::set<std::string, std::less<>> errors;   // warnings that count as errors
    bool allErrors = false;                      // all of them do

    // Returns nothing if the diagnostic is left out.
    std::optional<Severity> judge(Severity severity, std::string_view id) const;
};

struct ConsoleOptions {
    DiagnosticPolicy policy;
    bool json = false;     // one object on stdout, at the end
    bool quiet = false;    // errors only, no text on stdout
    bool verbose = false;  // what is done, with times
    ColorChoice color = ColorChoice::Auto;
};

// Its functions are const because they change nothing that affects a command's decisions.
class Console : public measure::Observer {
public:
    explicit Console(ConsoleOptions options = {});
    ~Console() override;
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;

    bool isJson() const;
    bool isVerbose() const;
    const DiagnosticPolicy& policy() const;
    const ConsoleOptions& options() const;

    // Prints a result as text, which must contain its own line breaks. Silent with --quiet.
    void print(std::string_view text) const;
    // Stores a result as an object. finish() writes it together with the diagnostics.
    void result(const nlohmann::ordered_json& object) const;
    using measure::Observer::report;
    void report(const Diagnostic& diagnostic) const override;
    // Returns whether a warning was reported that counts as an error.
    bool refused() const;
    // Shows the current activity in a line that the next message replaces; with --verbose the line stays.
    // Silent unless stderr is a terminal, or with --verbose. An empty text clears the line.
    void progress(std::string_view text) const override;
    // Returns a function that shows "compiling 31 of 64" on a terminal. Any thread may call it while no other
    // one uses the console.
    std::function<void(std::size_t done, std::size_t all)> countTo(std::string what) const;
    // Reports what was read, decided or made; only with --verbose.
    void detail(std::string_view text) const override;
    // Writes the JSON and all buffered text. Error "output" if stdout can't take it, for instance on a full
    // disk.
    Status finish() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

// The work of a subcommand once its command line is parsed. Returns the exit code; an error is reported.
using Action = std::function<Result<int>(const Console&)>;

nlohmann::ordered_json toJson(const Diagnostic& diagnostic);
nlohmann::ordered_json toJson(std::span<const Diagnostic> diagnostics);

// Reports an error; returns the exit code of a command that failed.
int fail(const Console& console, const Diagnostic& error);

// --- Every diagnostic that Glint makes, by id: what -W and --werror take. docs/diagnostics.md explains them
// ---

inline constexpr std::uint8_t kNote = 1;
inline constexpr std::uint8_t kWarning = 2;
inline constexpr std::uint8_t kError = 4;
inline constexpr std::uint8_t kAnySeverity = kNote | kWarning | kError;

// Returns the ids of the diagnostics that come with any of the severities (bits), sorted.
std::vector<std::string> diagnosticIds(std::uint8_t severities = kAnySeverity);

// Returns the severities with which diagnostics of that id come, or 0 if there is none.
std::uint8_t severitiesOf(std::string_view id);

}  // namespace glint::cli
