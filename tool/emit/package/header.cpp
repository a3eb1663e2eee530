#include "emit/package/header.h"

#include "emit/context.h"
#include "emit/material_layout.h"
#include "emit/package/interop_layouts.h"
#include "emit/sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <vector>

namespace glint::compiler {

namespace mustache = kainjow::mustache;

namespace {

// Returns an ASCII string literal. Octal escapes end after three digits, so the next character can't extend
// them.
std::string cppLiteral(std::string_view text) {
    std::string literal = "\"";
    for (const char character : text) {
        const auto code = static_cast<unsigned char>(character);
        if (character == '"' || character == '\\') {
            literal += '\\';
            literal += character;
        } else if (code < 0x20 || code > 0x7E || character == '?') {
            literal += fmt::format("\\{:03o}", code);
        } else {
            literal += character;
        }
    }
    return literal + "\"";
}

mustache::data featureList(const materials::MaterialModel& model) {
    mustache::data list(mustache::data::type::list);
    for (const materials::Feature& info : model.features) {
        std::string name(info.name);
        name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
        mustache::data entry;
        entry.set("name", name);
        entry.set("bit", fmt::format("{}", info.bit));
        entry.set("gltf", commentText(info.gltf));
        list.push_back(entry);
    }
    return list;
}

mustache::data caseMasks(const Plan& plan) {
    mustache::data list(mustache::data::type::list);
    for (const Case& shaderCase : plan.cases) {
        mustache::data entry;
        entry.set("name", shaderCase.name);
        entry.set("always", fmt::format("{:#x}ULL", shaderCase.always));
        entry.set("sometimes", fmt::format("{:#x}ULL", shaderCase.sometimes));
        list.push_back(entry);
    }
    return list;
}

mustache::data materialNames(const gltf::Scene& scene) {
    mustache::data list(mustache::data::type::list);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        mustache::data entry;
        entry.set("index", fmt::format("{}", i));
        entry.set("literal", cppLiteral(scene.materials[i].name));
        list.push_back(entry);
    }
    return list;
}

mustache::data sceneTables(const gltf::SceneList& scenes) {
    mustache::data list(mustache::data::type::list);
    for (std::size_t i = 0; i < scenes.scenes().size(); ++i) {
        const gltf::Scene& scene = scenes.scenes()[i];
        mustache::data entry;
        entry.set("index", fmt::format("{}", i));
        entry.set("literal", cppLiteral(scenes.name(i)));
        entry.set("hasMaterials", !scene.materials.empty());
        entry.set("materialCount", fmt::format("{}", scene.materials.size()));
        entry.set("materialNames", materialNames(scene));
        list.push_back(entry);
    }
    return list;
}

mustache::data materialMembers(const MaterialLayout& layout) {
    mustache::data members(mustache::data::type::list);
    const auto add = [&members](const std::string& name, std::uint32_t offset) {
        mustache::data entry;
        entry.set("member", name);
        entry.set("offset", fmt::format("{}", offset));
        members.push_back(entry);
    };
    for (const RecordField& field : layout.fields) {
        add(field.name, field.offset);
    }
    if (!layout.textures.empty()) {
        add("textures", layout.textureOffset);
    }
    return members;
}

mustache::data layoutList(const std::vector<StructLayout>& layouts) {
    mustache::data list(mustache::data::type::list);
    for (const StructLayout& layout : layouts) {
        mustache::data members(mustache::data::type::list);
        for (const MemberLayout& member : layout.members) {
            mustache::data entry;
            entry.set("member", member.name);
            entry.set("offset", fmt::format("{}", member.offset));
            members.push_back(entry);
        }
        mustache::data entry;
        entry.set("struct", layout.name);
        entry.set("bytes", fmt::format("{}", layout.bytes));
        entry.set("members", members);
        list.push_back(entry);
    }
    return list;
}

}  // namespace

std::string headerNamespace(const std::string& scenePath) {
    std::string name = "scene_";
    for (const char character : std::filesystem::path(scenePath).stem().string()) {
        const bool valid = std::isalnum(static_cast<unsigned char>(character)) != 0;
        // C++ reserves names with two underscores in a row.
        if (valid || name.back() != '_') {
            name += valid ? character : '_';
        }
    }
    return name;
}

Result<std::string> makeHeader(const gltf::SceneList& scenes, const Plan& plan, const SourceSet& sources,
                               const PlanOptions& options) {
    GLINT_TRY(auto interop, interopDeclarations());
    GLINT_TRY(const auto layouts, interopLayouts(interop));
    mustache::data context = makeContext(scenes, plan, options);
    context.set("namespace", headerNamespace(scenes.scenes().front().path));
    const MaterialLayout layout = materialLayoutOf(plan);
    context.set("interop", interop);
    context.set("materialRecord", recordStruct(layout, "gpu::"));
    context.set("features", featureList(*plan.model));
    context.set("hasCases", !plan.cases.empty());
    context.set("caseCount", fmt::format("{}", plan.cases.size()));
    context.set("caseMasks", caseMasks(plan));
    context.set("sceneCount", fmt::format("{}", scenes.scenes().size()));
    context.set("scenes", sceneTables(scenes));
    context.set("layouts", layoutList(layouts));
    context.set("materialBytes", fmt::format("{}", layout.bytes));
    context.set("materialMembers", materialMembers(layout));
    return renderTemplate(sources, "glint_tables.h.mustache", context);
}

}  // namespace glint::compiler
