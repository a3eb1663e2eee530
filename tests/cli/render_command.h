// Tests of `glint render` on the tiny scene.
#pragma once

#include "cli/tiny_scene.h"

#include <string>
#include <vector>

namespace glint::testing {

class RenderCommand : public TinySceneTest {
protected:
    using TinySceneTest::TinySceneTest;

    // Renders a small picture of the scene, with more options.
    Outcome render(const std::string& image, const std::vector<std::string>& more = {}) const;
    // These compare two pictures.
    void expectSame(const std::string& a, const std::string& b) const;
    void expectOther(const std::string& a, const std::string& b) const;
};

}  // namespace glint::testing
