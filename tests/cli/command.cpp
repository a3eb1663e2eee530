#include "cli/command.h"

#include "cli/console.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace glint::testing {

namespace fs = std::filesystem;

namespace {

// Runs in the child process, with only those calls that are safe between fork and exec of a single-threaded
// parent.
[[noreturn]] void execute(std::vector<std::string> words,
                          const std::vector<std::pair<std::string, std::string>>& variables,
                          const fs::path& folder, std::uint64_t memoryLimit, int outFile, int errFile) {
    constexpr int kCantRun = 127;
    if (outFile < 0 || errFile < 0 || dup2(outFile, STDOUT_FILENO) < 0 || dup2(errFile, STDERR_FILENO) < 0 ||
        chdir(folder.c_str()) != 0) {
        _exit(kCantRun);
    }
    const rlimit limit{memoryLimit, memoryLimit};
    if (memoryLimit != 0 && setrlimit(RLIMIT_AS, &limit) != 0) {
        _exit(kCantRun);
    }
    // The cache is not the user's, so that tests depend on nothing outside of the build.
    setenv("GLINT_CACHE", GLINT_BINARY_DIR "/tests/cache", 1);
    for (const auto& [name, value] : variables) {
        setenv(name.c_str(), value.c_str(), 1);
    }
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    execvp(pointers[0], pointers.data());
    _exit(kCantRun);
}

int openForWriting(const fs::path& path) {
    constexpr int kMode = 0600;
    return open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kMode);
}

// Returns -1 if the process was killed.
int waitFor(pid_t child) {
    int status = 0;
    return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// Reads until the other side of the terminal is closed.
std::string readTerminal(int terminal) {
    std::string text;
    std::array<char, 4096> part{};
    for (ssize_t count = 0; (count = read(terminal, part.data(), part.size())) > 0;) {
        text.append(part.data(), static_cast<std::size_t>(count));
    }
    return text;
}

// Expects that every diagnostic has an id of the table, with a severity that the table lists. `raised` says
// that warnings may be errors.
void expectKnownDiagnostics(const std::string& err, bool raised) {
    static const std::regex kDiagnostic(R"((?:^|: )(error|warning|note): .*\[([a-z0-9-]+)\]$)");
    std::istringstream lines(err);
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (!std::regex_search(line, match, kDiagnostic)) {
            continue;
        }
        const std::uint8_t known = cli::severitiesOf(match[2].str());
        const std::uint8_t severity = match[1] == "error"     ? cli::kError
                                      : match[1] == "warning" ? cli::kWarning
                                                              : cli::kNote;
        const bool isRaised = raised && severity == cli::kError && (known & cli::kWarning) != 0;
        EXPECT_TRUE((known & severity) != 0 || isRaised) << "not in the table of diagnostics: " << line;
    }
}

}  // namespace

nlohmann::json Outcome::json() const {
    nlohmann::json parsed = nlohmann::json::parse(out, nullptr, false);
    EXPECT_FALSE(parsed.is_discarded()) << out << err;
    return parsed;
}

Outcome must(Outcome outcome) {
    if (outcome.exit != 0) {
        throw std::runtime_error("exit code " + std::to_string(outcome.exit) + "\n" + outcome.out +
                                 outcome.err);
    }
    return outcome;
}

std::string commandPath() {
    return GLINT_COMMAND;
}

std::string readText(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

void writeText(const fs::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    ASSERT_TRUE(file.good()) << path;
}

void expectFitsTerminal(const std::string& text) {
    constexpr std::ptrdiff_t kMost = 100;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const auto characters = std::ranges::count_if(
            line, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
        EXPECT_LE(characters, kMost) << line;
    }
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

void CommandTest::SetUp() {
    const ::testing::TestInfo* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(GLINT_BINARY_DIR) / "tests" / "tmp" /
              (std::string(info->test_suite_name()) + "_" + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
}

void CommandTest::TearDown() {
    fs::remove_all(folder_);
}

Outcome CommandTest::run(const std::vector<std::string>& arguments,
                         const std::vector<std::pair<std::string, std::string>>& variables) const {
    return runAs({commandPath()}, arguments, variables);
}

Outcome CommandTest::runAs(std::vector<std::string> words, const std::vector<std::string>& arguments,
                           const std::vector<std::pair<std::string, std::string>>& variables) const {
    words.insert(words.end(), arguments.begin(), arguments.end());
    Outcome outcome = runProgram(words, variables);
    const bool raised = std::ranges::any_of(arguments, [](const std::string& argument) {
        return argument.starts_with("--werror") || argument.starts_with("-Werror");
    });
    expectKnownDiagnostics(outcome.err, raised);
    return outcome;
}

Outcome CommandTest::runProgram(const std::vector<std::string>& words,
                                const std::vector<std::pair<std::string, std::string>>& variables) const {
    // The files lie beside the folder, because a test may want to list the folder.
    const fs::path out = folder_.string() + ".out";
    const fs::path err = folder_.string() + ".err";
    const pid_t child = fork();
    if (child == 0) {
        execute(words, variables, folder_, memoryLimit_, openForWriting(out), openForWriting(err));
    }
    Outcome outcome;
    outcome.exit = waitFor(child);
    outcome.out = readText(out);
    outcome.err = readText(err);
    fs::remove(out);
    fs::remove(err);
    return outcome;
}

Outcome CommandTest::runOnTerminal(const std::vector<std::string>& arguments,
                                   const std::vector<std::pair<std::string, std::string>>& variables) const {
    std::vector<std::string> words{commandPath()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    const fs::path out = folder_.string() + ".out";
    Outcome outcome;
    const int terminal = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0) {
        ADD_FAILURE() << "there is no pseudo terminal";
        return outcome;
    }
    // The child's side stays open here until the child has it; otherwise the terminal would be closed too
    // early.
    const int errFile = open(ptsname(terminal), O_RDWR | O_NOCTTY | O_CLOEXEC);
    const pid_t child = fork();
    if (child == 0) {
        execute(words, variables, folder_, memoryLimit_, openForWriting(out), errFile);
    }
    close(errFile);
    outcome.err = readTerminal(terminal);
    close(terminal);
    outcome.exit = waitFor(child);
    outcome.out = readText(out);
    fs::remove(out);
    return outcome;
}

std::vector<std::string> CommandTest::filesBelow(const fs::path& folder) {
    std::vector<std::string> files;
    if (fs::exists(folder)) {
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
            files.push_back(fs::relative(entry.path(), folder).string());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace glint::testing
