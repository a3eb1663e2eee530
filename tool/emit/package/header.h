// C++ for programs that use a package: glint_tables.h with shader IDs, features and layouts, and the package
// itself.
#pragma once

#include "base/files.h"
#include "emit/package/compiled_package.h"
#include "emit/source_set.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

// Returns the header's text. Has the errors of renderTemplate() and flatten().
Result<std::string> makeHeader(const gltf::SceneList& scenes, const Plan& plan, const SourceSet& sources,
                               const PlanOptions& options);

// Returns the namespace within glint: "scene_" and the file's name, as an identifier.
std::string headerNamespace(const std::string& scenePath);

// --- A package as C++ source, for programs that ship without data files ---

struct EmbeddedSource {
    std::string header;  // declares glint::scene_x::embeddedPackage()
    std::string source;  // includes the header as `headerName`
};

// Returns the files that Package::load() reads, as arrays of 64-bit words.
EmbeddedSource makeEmbeddedSource(const gltf::SceneList& scenes, const CompiledPackage& package,
                                  const std::string& headerName);

// Returns the name of the header beside a source: "room_package.h" for "room_package.cpp".
std::filesystem::path embeddedHeader(const std::filesystem::path& source);

// Stages both files, ready to be moved to their place. It creates the folder and removes staged files that
// killed runs left behind. Error "output-write".
Result<std::vector<base::StagedFile>> stageEmbeddedSource(const gltf::SceneList& scenes,
                                                          const CompiledPackage& package,
                                                          const std::filesystem::path& source);

// --- Sizes and offsets of the structures that host and device share, as their declarations give them ---

struct MemberLayout {
    std::string name;
    std::uint32_t offset;  // bytes
};

struct StructLayout {
    std::string name;
    std::uint32_t bytes;
    std::vector<MemberLayout> members;  // all members, in order
};

// Lays out every structure of `declarations`, the text of interopDeclarations(), in the `scalar` layout,
// which is also that of C++. A member is of a type of interop/types.h, or an array of one. Error
// "interop-type" for other members.
Result<std::vector<StructLayout>> interopLayouts(std::string_view declarations);

}  // namespace glint::compiler
