#include "emit/glsl/passes.h"

#include <gtest/gtest.h>

#include <string>

namespace glint {
namespace {

TEST(PrefixNames, RenamesWhatTheTextDeclaresAndNothingElse) {
    EXPECT_EQ(compiler::prefixNames(
                  "const float kHalf = 0.5;\nconst uint kCount = 2u;\n"
                  "struct Hit {\n    vec3 normal;\n    float twice;\n    float words[kCount];\n};\n"
                  "#define GLINT_A(x) twice(x)\n"
                  "float twice(float x) {\n    return 2.0 * x;  // twice\n}\n"
                  "float glintValue(Hit hit, float twiceAs) {\n"
                  "    return twice(hit.twice) + kHalf + GLINT_A(twiceAs) + length(hit.normal);\n}\n"),
              "const float glint_kHalf = 0.5;\nconst uint glint_kCount = 2u;\n"
              "struct glint_Hit {\n    vec3 normal;\n    float twice;\n    float words[glint_kCount];\n};\n"
              "#define GLINT_LIBRARY_A(x) glint_twice(x)\n"
              "float glint_twice(float x) {\n    return 2.0 * x;  // twice\n}\n"
              "float glintValue(glint_Hit hit, float twiceAs) {\n"
              "    return glint_twice(hit.twice) + glint_kHalf + GLINT_LIBRARY_A(twiceAs) + "
              "length(hit.normal);\n}\n");
}

TEST(PrefixNames, RenamesBlocksAndTheTypesOfMembers) {
    EXPECT_EQ(
        compiler::prefixNames(
            "struct A {\n    float a;\n};\nstruct B {\n    A inner;\n    float words[4];\n};\n"
            "layout(buffer_reference) readonly buffer Words {\n    B data[];\n};\n"
            "B first(Words words) {\n    return words.data[0];\n}\n"),
        "struct glint_A {\n    float a;\n};\nstruct glint_B {\n    glint_A inner;\n    float words[4];\n};\n"
        "layout(buffer_reference) readonly buffer glint_Words {\n    glint_B data[];\n};\n"
        "glint_B glint_first(glint_Words words) {\n    return words.data[0];\n}\n");
}

}  // namespace
}  // namespace glint
