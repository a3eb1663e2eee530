// Runs the built `glint` and captures what it says.
#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace glint::testing {

struct Outcome {
    int exit = -1;  // -1: it did not end by itself
    std::string out;
    std::string err;

    // Standard output as JSON; a discarded value and a failed test where it is none.
    nlohmann::json json() const;
};

// Each test has an empty folder of its own, which goes at the end.
class CommandTest : public ::testing::Test {
protected:
    void SetUp() override;
    void TearDown() override;

    std::filesystem::path path(const std::string& name) const {
        return folder_ / name;
    }
    // Runs `glint` in the test's folder, with these variables added to the environment and a cache of the
    // build's own. Fails the test where a diagnostic has an id or a severity that the table does not have.
    Outcome run(const std::vector<std::string>& arguments,
                const std::vector<std::pair<std::string, std::string>>& variables = {}) const;
    // Likewise, with a terminal as its standard error; Outcome::err is what that was sent, with "\r\n".
    Outcome runOnTerminal(const std::vector<std::string>& arguments,
                          const std::vector<std::pair<std::string, std::string>>& variables = {}) const;
    // Runs another program, found on the PATH, likewise.
    Outcome runProgram(const std::vector<std::string>& words,
                       const std::vector<std::pair<std::string, std::string>>& variables = {}) const;
    // Paths of all files below `folder`, relative and sorted.
    static std::vector<std::string> filesBelow(const std::filesystem::path& folder);

    // Of the command's address space, in bytes; 0: none.
    std::uint64_t memoryLimit_ = 0;

private:
    std::filesystem::path folder_;
};

// The path of `glint`.
std::string commandPath();
std::string readText(const std::filesystem::path& path);
void writeText(const std::filesystem::path& path, const std::string& text);
// Fails the test for each line of `text` with more characters than a table may have.
void expectFitsTerminal(const std::string& text);
// Whether `part` stands in `text`.
bool has(const std::string& text, const std::string& part);

}  // namespace glint::testing
