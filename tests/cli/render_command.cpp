#include "cli/render_command.h"

namespace glint::testing {

Outcome RenderCommand::render(const std::string& image, const std::vector<std::string>& more) const {
    return runWith({"render", scene_, "-o", image, "--size", "64x36"}, more);
}

void RenderCommand::expectSame(const std::string& a, const std::string& b) const {
    const Outcome same = run({"compare", a, b, "--max-error", "1e-4"});
    EXPECT_EQ(same.exit, 0) << a << " and " << b << ": " << same.out << same.err;
}

void RenderCommand::expectOther(const std::string& a, const std::string& b) const {
    EXPECT_EQ(run({"compare", a, b, "--max-error", "1e-2"}).exit, 1) << a << " and " << b;
}

}  // namespace glint::testing
