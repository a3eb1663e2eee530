// The GLSL files that modules are flattened from: embedded ones, and those made for a scene.
#pragma once

#include "emit/compile.h"
#include "emit/flatten.h"
#include "gltf/scene_list.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace glint {

// Files by the name that an #include gives.
class SourceSet {
public:
    void add(std::string name, std::string text);
    // Valid as long as the set.
    std::optional<std::string_view> find(std::string_view name) const;
    SourceLookup lookup() const;

private:
    std::map<std::string, std::string, std::less<>> files_;
};

// Embedded files, "generated/features.glsl", "generated/scene.glsl" and "generated/cases.glsl". Errors as
// renderTemplate().
Result<SourceSet> makeSourceSet(const SceneList& scenes, const Plan& plan, const CompileSettings& settings);

// C++ declarations of every structure that host and device share, flattened from shaders/interop.
Result<std::string> interopDeclarations();

// Over the names and texts of shaders/interop.
std::uint64_t interopHash();

}  // namespace glint
