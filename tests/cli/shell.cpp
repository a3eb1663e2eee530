#include "cli/shell.h"

#include <cstdio>
#include <sys/wait.h>

namespace glint::testing {

Outcome runShell(const std::filesystem::path& folder, const std::string& line) {
    Outcome outcome;
    const std::string all = "exec 2>&1 && cd " + quoteForShell(folder.string()) + " && " + line;
    std::FILE* const pipe = popen(all.c_str(), "r");
    if (pipe == nullptr) {
        return outcome;
    }
    for (int c = 0; (c = std::fgetc(pipe)) != EOF;) {
        outcome.out += static_cast<char>(c);
    }
    const int status = pclose(pipe);
    outcome.exit = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome;
}

bool hasProgram(const std::string& name) {
    return runShell(".", "command -v " + quoteForShell(name)).exit == 0;
}

std::string quoteForShell(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text) {
        quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return quoted + "'";
}

}  // namespace glint::testing
