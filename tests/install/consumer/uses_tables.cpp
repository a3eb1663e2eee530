// A program with a generated header: the shader IDs and buckets of a scene, compiled in this build.
#include "glint_tables.h"

static_assert(glint::scene_triangle::kShaderCount == 1);
static_assert(glint::scene_triangle::kBucketCount == 2);

int main() {
    return 0;
}
