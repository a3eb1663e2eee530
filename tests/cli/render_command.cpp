#include "cli/render_command.h"

#include "cli/tiny_scene.h"

namespace glint::testing {

void RenderCommand::SetUp() {
    CommandTest::SetUp();
    scene_ = writeTinyScene(path("")).string();
}

Outcome RenderCommand::render(const std::string& image, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"render", scene_, "-o", image, "--size", "64x36"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
}

}  // namespace glint::testing
