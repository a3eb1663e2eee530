// GLSL files by the names under which shaders include them.
#pragma once

#include "emit/glsl/flatten.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace glint::compiler {

class SourceSet {
public:
    void add(std::string name, std::string text);
    // Returns the file's text, which is valid as long as the set.
    std::optional<std::string_view> find(std::string_view name) const;
    SourceLookup lookup() const;

private:
    std::map<std::string, std::string, std::less<>> files_;
};

}  // namespace glint::compiler
