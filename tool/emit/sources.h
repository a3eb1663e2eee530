// The GLSL files that modules are flattened from: the embedded ones, and those made for a scene.
#pragma once

#include "emit/compile.h"
#include "emit/glsl/flatten.h"
#include "gltf/scene_list.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace glint::compiler {

// A set of files. They are found by the name that an #include gives.
class SourceSet {
public:
    void add(std::string name, std::string text);
    // Returns the file's text, which is valid as long as the set.
    std::optional<std::string_view> find(std::string_view name) const;
    SourceLookup lookup() const;

private:
    std::map<std::string, std::string, std::less<>> files_;
};

// Returns the embedded files, "generated/features.glsl", "generated/scene.glsl" and "generated/cases.glsl".
// Has the errors of addHost() and renderTemplate().
Result<SourceSet> makeSourceSet(const gltf::SceneList& scenes, const Plan& plan,
                                const CompileSettings& settings);

// Returns the features with code that runs where alpha is tested.
materials::FeatureMask maskCodeFeatures(const materials::MaterialModel& model);

// Returns the C++ declarations of every structure that host and device share, flattened from shaders/interop.
Result<std::string> interopDeclarations();

// Returns a hash of the names and texts of shaders/interop.
std::uint64_t interopSourceHash();

}  // namespace glint::compiler
