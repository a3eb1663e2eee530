// Runs the built `glint` and captures its output.
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

    // Parses standard output as JSON. If it is not JSON, the test fails and the value is discarded.
    nlohmann::json json() const;
};

// Returns the outcome of a command that has to succeed. Otherwise it throws what the command has said, which
// GoogleTest reports as the failure of the case.
Outcome must(Outcome outcome);

// Gives each test an empty folder, which is removed at the end.
class CommandTest : public ::testing::Test {
protected:
    void SetUp() override;
    void TearDown() override;

    std::filesystem::path path(const std::string& name) const {
        return folder_ / name;
    }
    // Runs `glint` in the test's folder, with these variables added to the environment and a cache of the
    // build's own. Fails the test if a diagnostic has an id or a severity that the table lacks.
    Outcome run(const std::vector<std::string>& arguments,
                const std::vector<std::pair<std::string, std::string>>& variables = {}) const;
    // Runs a program that takes the same command line after its own `words`.
    Outcome runAs(std::vector<std::string> words, const std::vector<std::string>& arguments,
                  const std::vector<std::pair<std::string, std::string>>& variables = {}) const;
    Outcome runWith(std::vector<std::string> arguments, const std::vector<std::string>& more) const {
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
    // Does the same with a terminal as standard error; Outcome::err is what the terminal received, with
    // "\r\n".
    Outcome runOnTerminal(const std::vector<std::string>& arguments,
                          const std::vector<std::pair<std::string, std::string>>& variables = {}) const;
    // Runs another program, found on the PATH, in the same way.
    Outcome runProgram(const std::vector<std::string>& words,
                       const std::vector<std::pair<std::string, std::string>>& variables = {}) const;
    // Returns the paths of all files below `folder`, relative and sorted.
    static std::vector<std::string> filesBelow(const std::filesystem::path& folder);

    // Limit of the command's address space in bytes; 0 for none.
    std::uint64_t memoryLimit_ = 0;

private:
    std::filesystem::path folder_;
};

// Returns the path of `glint`.
std::string commandPath();
std::string readText(const std::filesystem::path& path);
void writeText(const std::filesystem::path& path, const std::string& text);
// Fails the test for each line of `text` with more characters than a table may have.
void expectFitsTerminal(const std::string& text);
// Whether `part` stands in `text`.
bool has(const std::string& text, const std::string& part);

}  // namespace glint::testing
