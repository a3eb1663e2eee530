#include "support/models.h"

#include <cstdlib>

namespace glint::test {

std::filesystem::path modelsFolder() {
    const char* const folder = std::getenv("GLINT_MODELS");
    return folder != nullptr && *folder != '\0' ? folder : GLINT_MODELS;
}

std::string noModels(const std::filesystem::path& path) {
    return "no models: " + path.string() + " is not there (scripts/models.sh)";
}

}  // namespace glint::test
