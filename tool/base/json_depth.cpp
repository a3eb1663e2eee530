#include "base/json_depth.h"

#include <cstddef>

namespace glint::base {

bool nestsTooDeep(std::span<const std::uint8_t> json) {
    int depth = 0;
    bool inString = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = static_cast<char>(json[i]);
        if (inString) {
            i += c == '\\' ? 1 : 0;
            inString = c != '"';
            continue;
        }
        inString = c == '"';
        depth += c == '{' || c == '[' ? 1 : 0;
        depth -= c == '}' || c == ']' ? 1 : 0;
        if (depth > kMaxJsonDepth) {
            return true;
        }
    }
    return false;
}

}  // namespace glint::base
