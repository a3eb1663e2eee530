#include "cli/console.h"

#include "base/clock.h"
#include "base/json.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <unistd.h>
#include <utility>

namespace glint::cli {

namespace {

constexpr const char* kClearLine = "\r\x1b[K";
constexpr const char* kReset = "\x1b[0m";

void write(std::FILE* stream, std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stream);
}

const char* colorOf(Severity severity) {
    switch (severity) {
        case Severity::Error:
            return "\x1b[1;31m";
        case Severity::Warning:
            return "\x1b[1;33m";
        case Severity::Note:
            break;
    }
    return "\x1b[1;36m";
}

bool wantsColor(ColorChoice choice, bool terminal) {
    const char* noColor = std::getenv("NO_COLOR");
    const bool automatic = terminal && (noColor == nullptr || *noColor == '\0');
    return choice == ColorChoice::Always || (choice == ColorChoice::Auto && automatic);
}

std::string colored(const Diagnostic& diagnostic) {
    std::string text = toString(diagnostic);
    // The severity follows the place, and ends at the first colon.
    const std::size_t begin = diagnostic.where.empty() ? 0 : diagnostic.where.size() + 2;
    const std::size_t end = text.find(':', begin);
    text.insert(end, kReset);
    text.insert(begin, colorOf(diagnostic.severity));
    return text;
}

// Returns "/materials/3" for "scene.gltf#/materials/3", or an empty text if the place has no JSON pointer.
std::string pointerOf(const std::string& where) {
    const std::size_t begin = where.find("#/");
    return begin == std::string::npos ? std::string() : where.substr(begin + 1);
}

}  // namespace

base::Json toJson(const Diagnostic& diagnostic) {
    static constexpr const char* kNames[] = {"note", "warning", "error"};
    return {{"severity", kNames[static_cast<int>(diagnostic.severity)]},
            {"id", diagnostic.id},
            {"where", diagnostic.where},
            {"pointer", base::textOrNull(pointerOf(diagnostic.where))},
            {"message", diagnostic.message},
            {"hint", diagnostic.hint}};
}

base::Json toJson(std::span<const Diagnostic> diagnostics) {
    base::Json list = base::Json::array();
    for (const Diagnostic& diagnostic : diagnostics) {
        list.push_back(toJson(diagnostic));
    }
    return list;
}

std::optional<Severity> DiagnosticPolicy::judge(Severity severity, std::string_view id) const {
    if (severity != Severity::Error && dropped.contains(id)) {
        return std::nullopt;
    }
    const bool counts = allErrors || errors.contains(id);
    return severity == Severity::Warning && counts ? Severity::Error : severity;
}

struct Console::State {
    ConsoleOptions options;
    base::Clock::time_point start = base::Clock::now();
    bool terminal = false;
    bool color = false;
    bool refused = false;
    std::vector<Diagnostic> reported;
    std::optional<base::Json> result;
};

Console::Console(ConsoleOptions options) : state_(std::make_unique<State>()) {
    state_->options = std::move(options);
    state_->terminal = isatty(STDERR_FILENO) != 0;
    state_->color = wantsColor(state_->options.color, state_->terminal);
}

Console::~Console() = default;

bool Console::isVerbose() const {
    return state_->options.verbose;
}

bool Console::isJson() const {
    return state_->options.json;
}

const ConsoleOptions& Console::options() const {
    return state_->options;
}

const DiagnosticPolicy& Console::policy() const {
    return state_->options.policy;
}

void Console::print(std::string_view text) const {
    progress("");
    if (!state_->options.quiet) {
        write(stdout, text);
    }
}

void Console::result(const base::Json& object) const {
    state_->result = object;
}

void Console::report(const Diagnostic& diagnostic) const {
    const std::optional<Severity> severity = policy().judge(diagnostic.severity, diagnostic.id);
    if (!severity) {
        return;
    }
    state_->refused = state_->refused || *severity != diagnostic.severity;
    Diagnostic judged = diagnostic;
    judged.severity = *severity;
    if (!state_->options.quiet || judged.severity == Severity::Error) {
        progress("");
        write(stderr, (state_->color ? colored(judged) : toString(judged)) + "\n");
    }
    state_->reported.push_back(std::move(judged));
}

bool Console::refused() const {
    return state_->refused;
}

void Console::progress(std::string_view text) const {
    if (state_->options.verbose) {
        detail(text);
    } else if (state_->terminal && !state_->options.quiet) {
        write(stderr, kClearLine);
        write(stderr, text);
        std::fflush(stderr);
    }
}

std::function<void(std::size_t, std::size_t)> Console::countTo(std::string what) const {
    return [this, what = std::move(what)](std::size_t done, std::size_t all) {
        if (!state_->options.verbose) {
            progress(fmt::format("{} {} of {}", what, done, all));
        }
    };
}

void Console::detail(std::string_view text) const {
    if (state_->options.verbose && !text.empty()) {
        const std::chrono::duration<double> elapsed = base::Clock::now() - state_->start;
        write(stderr, fmt::format("{:8.3f} s  {}\n", elapsed.count(), text));
    }
}

Status Console::finish() const {
    progress("");
    if (isJson()) {
        base::Json object = state_->result.value_or(base::Json::object());
        object["diagnostics"] = toJson(state_->reported);
        write(stdout, base::toText(object));
    }
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        return makeError("output", "stdout", "can't be written", "check the free space and the reader");
    }
    return okStatus();
}

int fail(const Console& console, const Diagnostic& error) {
    console.report(error);
    return kExitFailed;
}

}  // namespace glint::cli
