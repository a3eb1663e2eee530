// Tests of `glint render` on the tiny scene.
#pragma once

#include "cli/command.h"

#include <string>
#include <vector>

namespace glint::testing {

class RenderCommand : public CommandTest {
protected:
    void SetUp() override;

    // Renders a small picture of the scene, with more options.
    Outcome render(const std::string& image, const std::vector<std::string>& more = {}) const;

    std::string scene_;
};

}  // namespace glint::testing
