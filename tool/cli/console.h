// Where the command writes: results to stdout, diagnostics and progress to stderr.
#pragma once

#include <glint/result.h>

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

namespace glint {

enum class ColorChoice { Auto, Always, Never };

// What becomes of diagnostics, by id. Errors stay errors whatever it says.
struct DiagnosticPolicy {
    std::set<std::string, std::less<>> dropped;  // warnings and notes that are left out
    std::set<std::string, std::less<>> errors;   // warnings that count as errors
    bool allErrors = false;                      // all of them do

    // Nothing where it is left out.
    std::optional<Severity> judge(Severity severity, std::string_view id) const;
};

struct ConsoleOptions {
    DiagnosticPolicy policy;
    bool json = false;     // one object on stdout, at the end
    bool quiet = false;    // errors only, no text on stdout
    bool verbose = false;  // what is done, with times
    ColorChoice color = ColorChoice::Auto;
};

// Its functions are const as they change nothing that a command decides by.
class Console {
public:
    explicit Console(ConsoleOptions options = {});
    ~Console();
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;

    bool isJson() const;
    bool isVerbose() const;
    const DiagnosticPolicy& policy() const;

    // A result as text; it ends with a line break where one is wanted. Silent with --quiet.
    void print(std::string_view text) const;
    // A result as an object, which finish() writes with the diagnostics.
    void result(const nlohmann::ordered_json& object) const;
    void report(const Diagnostic& diagnostic) const;
    void report(std::span<const Diagnostic> diagnostics) const;
    // Whether a warning was reported that counts as an error.
    bool refused() const;
    // What is being done now: one line that the next message replaces, or with --verbose one that stays.
    // Silent unless stderr is a terminal, or with --verbose. Empty text clears it.
    void progress(std::string_view text) const;
    // What was read, decided or made; only with --verbose.
    void detail(std::string_view text) const;
    // Writes the JSON, and what is buffered. Error "output" where stdout can't take it, for instance on a
    // full disk.
    Status finish() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace glint
