#include "unit/gltf/gltf_builder.h"

#include "support/must.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <string>

namespace glint::test {

namespace fs = std::filesystem;

GltfBuilder::GltfBuilder() : root{{"asset", {{"version", "2.0"}}}} {}

int GltfBuilder::append(const std::string& array, Json value) {
    root[array].push_back(std::move(value));
    return static_cast<int>(root[array].size()) - 1;
}

int GltfBuilder::addView(const void* bytes, std::size_t size, std::size_t stride) {
    buffer.resize((buffer.size() + 3) / 4 * 4);
    Json view{{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", size}};
    if (stride > 0) {
        view["byteStride"] = stride;
    }
    const auto* first = static_cast<const std::uint8_t*>(bytes);
    buffer.insert(buffer.end(), first, first + size);
    return append("bufferViews", std::move(view));
}

Json& GltfBuilder::addMesh(Json primitive) {
    Json mesh;
    mesh["primitives"] = Json::array({std::move(primitive)});
    const int index = append("meshes", std::move(mesh));
    append("nodes", {{"mesh", index}});
    return root["meshes"][static_cast<std::size_t>(index)]["primitives"][0];
}

Json& GltfBuilder::addTriangle() {
    const int positions = addAccessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    return addMesh({{"attributes", {{"POSITION", positions}}}});
}

const char* GltfBuilder::typeName(int components) {
    switch (components) {
        case 1:
            return "SCALAR";
        case 2:
            return "VEC2";
        case 3:
            return "VEC3";
        case 4:
            return "VEC4";
        default:
            return "MAT4";
    }
}

Json GltfBuilder::buffers(bool embedded) const {
    Json first{{"byteLength", buffer.size()}};
    if (embedded) {
        first["uri"] = "data:application/octet-stream;base64," + base64(buffer);
    }
    Json all = Json::array({std::move(first)});
    for (const Json& other : otherBuffers) {
        all.push_back(other);
    }
    return all;
}

namespace {

void collectExtensions(const Json& json, std::set<std::string>& names) {
    if (json.is_object() && json.contains("extensions") && json["extensions"].is_object()) {
        for (const auto& [name, ignored] : json["extensions"].items()) {
            names.insert(name);
        }
    }
    for (auto member = json.begin(); json.is_structured() && member != json.end(); ++member) {
        if (!json.is_object() || member.key() != "extras") {
            collectExtensions(*member, names);
        }
    }
}

}  // namespace

Json GltfBuilder::document() const {
    Json all = root;
    if (all.contains("extensionsUsed")) {
        return all;
    }
    std::set<std::string> names;
    collectExtensions(all, names);
    for (const Json& other : otherBuffers) {
        collectExtensions(other, names);
    }
    if (all.contains("extensionsRequired") && all["extensionsRequired"].is_array()) {
        for (const Json& name : all["extensionsRequired"]) {
            if (name.is_string()) {
                names.insert(name.get<std::string>());
            }
        }
    }
    if (!names.empty()) {
        all["extensionsUsed"] = names;
    }
    return all;
}

std::string GltfBuilder::text() const {
    Json document = this->document();
    if (!buffer.empty() && !document.contains("buffers")) {
        document["buffers"] = buffers(true);
    }
    return document.dump();
}

std::string GltfBuilder::glb() const {
    Json document = this->document();
    if (!document.contains("buffers")) {
        document["buffers"] = buffers(false);
    }
    const std::string body = chunk(0x4E4F534A, document.dump(), ' ') +
                             chunk(0x004E4942, std::string(buffer.begin(), buffer.end()), '\0');
    return "glTF" + word(2) + word(static_cast<std::uint32_t>(body.size() + 12)) + body;
}

std::string word(std::uint32_t value) {
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &value, 4);
    return bytes;
}

std::string chunk(std::uint32_t type, std::string payload, char padding) {
    payload.resize((payload.size() + 3) / 4 * 4, padding);
    return word(static_cast<std::uint32_t>(payload.size())) + word(type) + payload;
}

std::string base64(const base::Bytes& bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = i; k < i + 3; ++k) {
            bits = bits << 8U | (k < bytes.size() ? bytes[k] : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63U] : '=';
        }
    }
    return text;
}

Result<gltf::Scene> importText(const std::string& text, const gltf::ImportOptions& options) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "scene.gltf";
    GLINT_TRY_DO(base::writeFile(path, text));
    return importScene(path, options);
}

Result<gltf::Scene> import(const GltfBuilder& builder, const gltf::ImportOptions& options) {
    return importText(builder.text(), options);
}

gltf::Scene mustImport(const GltfBuilder& builder, const gltf::ImportOptions& options) {
    return must(import(builder, options));
}

GltfBuilder sceneWithImage(const base::Bytes& bytes, const std::string& mimeType) {
    GltfBuilder builder;
    const int view = builder.addView(bytes.data(), bytes.size());
    builder.append("images", {{"bufferView", view}, {"mimeType", mimeType}});
    builder.append("textures", {{"source", 0}});
    Json material;
    material["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    builder.append("materials", std::move(material));
    return builder;
}

std::vector<Diagnostic> readingWarnings(const gltf::Scene& scene) {
    std::vector<Diagnostic> warnings;
    std::ranges::copy_if(scene.warnings, std::back_inserter(warnings), [](const Diagnostic& warning) {
        return warning.id != "nothing-drawn" && warning.id != "input-missing";
    });
    return warnings;
}

std::size_t countWarnings(const gltf::Scene& scene, std::string_view id) {
    std::size_t count = 0;
    for (const Diagnostic& warning : scene.warnings) {
        count += warning.id == id ? 1 : 0;
    }
    return count;
}

Diagnostic findWarning(const gltf::Scene& scene, std::string_view id) {
    for (const Diagnostic& warning : scene.warnings) {
        if (warning.id == id) {
            return warning;
        }
    }
    return {};
}

}  // namespace glint::test
