// A program that uses the generated headers of two packages, and no library of Glint.
#include "both/glint_tables.h"
#include "cubes/glint_tables.h"

#include <filesystem>

static_assert(glint::scene_cubes::kShaderCount <= 2);
static_assert(glint::scene_copy::kSceneCount == 2);

int main() {
    const bool bothThere = std::filesystem::exists(GLINT_PACKAGE_CUBES "/tables.bin") &&
                           std::filesystem::exists(GLINT_PACKAGE_BOTH "/tables.bin");
    return bothThere ? 0 : 1;
}
