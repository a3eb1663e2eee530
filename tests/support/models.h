// Where scenes by others are, which the repository does not hold: scripts/models.sh says what they are.
#pragma once

#include <filesystem>
#include <string>

namespace glint::test {

// The folder that the environment variable GLINT_MODELS names; without it the CMake variable of that name.
std::filesystem::path modelsFolder();

// Why a test is skipped that needs `path`, which is not there. scripts/test.sh counts tests by this text.
std::string noModels(const std::filesystem::path& path);

}  // namespace glint::test
