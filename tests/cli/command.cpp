#include "cli/command.h"

#include <algorithm>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

namespace glint::testing {

namespace fs = std::filesystem;

namespace {

// In the child process: only calls that are safe between fork and exec of a single-threaded parent.
[[noreturn]] void execute(std::vector<std::string> words,
                          const std::vector<std::pair<std::string, std::string>>& variables,
                          const fs::path& folder, const fs::path& out, const fs::path& err) {
    constexpr int kCantRun = 127;
    constexpr int kMode = 0600;
    const int outFile = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode);
    const int errFile = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode);
    if (outFile < 0 || errFile < 0 || dup2(outFile, STDOUT_FILENO) < 0 || dup2(errFile, STDERR_FILENO) < 0 ||
        chdir(folder.c_str()) != 0) {
        _exit(kCantRun);
    }
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

}  // namespace

nlohmann::json Outcome::json() const {
    nlohmann::json parsed = nlohmann::json::parse(out, nullptr, false);
    EXPECT_FALSE(parsed.is_discarded()) << out << err;
    return parsed;
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
    std::vector<std::string> words{commandPath()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return runProgram(words, variables);
}

Outcome CommandTest::runProgram(const std::vector<std::string>& words,
                                const std::vector<std::pair<std::string, std::string>>& variables) const {
    // Beside the folder, which a test may want to list.
    const fs::path out = folder_.string() + ".out";
    const fs::path err = folder_.string() + ".err";
    const pid_t child = fork();
    if (child == 0) {
        execute(words, variables, folder_, out, err);
    }
    int status = 0;
    Outcome outcome;
    if (child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status)) {
        outcome.exit = WEXITSTATUS(status);
    }
    outcome.out = readText(out);
    outcome.err = readText(err);
    fs::remove(out);
    fs::remove(err);
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
