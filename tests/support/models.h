// Finds scenes by others, which the repository does not contain. scripts/models.sh lists them.
#pragma once

#include <filesystem>
#include <string>

namespace glint::test {

// Returns the folder in the environment variable GLINT_MODELS, or without it the one in the CMake variable of
// that name.
std::filesystem::path modelsFolder();

// Returns the reason for skipping a test because `path` is missing. scripts/test.sh counts tests by this
// text.
std::string noModels(const std::filesystem::path& path);

}  // namespace glint::test
