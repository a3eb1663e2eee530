#include "gltf/meshes.h"

#include "gltf/attributes.h"
#include "gltf/document/repair.h"
#include "gltf/motion/morphs.h"
#include "gltf/triangles.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace glint::gltf {

namespace {

constexpr std::string_view kNoData = "buffer-external";

materials::ColorContent contentOf(const std::vector<Float4>& colors) {
    if (colors.empty()) {
        return materials::ColorContent::None;
    }
    const bool white = std::all_of(colors.begin(), colors.end(), [](const Float4& color) {
        return color == Float4{1.0F, 1.0F, 1.0F, 1.0F};
    });
    return white ? materials::ColorContent::White : materials::ColorContent::Varying;
}

// Returns whether the mode of the primitive makes triangles. Otherwise it warns or fails.
Result<bool> isDrawable(const PrimitiveSource& source, const std::string& pointer) {
    const int mode = modeOf(source);
    if (mode < 0 || mode > static_cast<int>(PrimitiveMode::TriangleFan)) {
        return source.document.error("primitive-mode", pointer + "/mode", fmt::format("{} is no mode", mode),
                                     "export the mesh again");
    }
    if (mode < static_cast<int>(PrimitiveMode::Triangles)) {
        source.document.warn("primitive-skipped", pointer,
                             "points and lines have no surface that a ray can hit; they are skipped");
        return false;
    }
    if (attributeAccessor(source, "POSITION") < 0) {
        return source.document.error("position-missing", pointer + "/attributes", "has no POSITION",
                                     "export the mesh again, or delete the primitive");
    }
    return true;
}

// Reads the primitive. Returns whether it has anything to draw.
Result<bool> readPrimitive(const PrimitiveSource& source, Primitive& primitive) {
    Result<bool> drawable = isDrawable(source, primitive.pointer);
    if (!drawable || !*drawable) {
        return drawable;
    }
    bool isList = false;
    GLINT_TRY(auto order, readVertices(source, primitive, isList));
    const auto mode = isList ? PrimitiveMode::Triangles : static_cast<PrimitiveMode>(modeOf(source));
    TriangleList list = makeTriangles(mode, std::move(order));
    if (list.leftOver > 0) {
        source.document.warn(
            "triangle-incomplete", primitive.pointer,
            fmt::format("the last {} vertices make no triangle and are dropped", list.leftOver));
    }
    primitive.indices = std::move(list.indices);
    GLINT_TRY_DO(readTargets(source, primitive));
    repairPrimitive(source.document, primitive);
    if (primitive.indices.empty()) {
        source.document.warn("primitive-empty", primitive.pointer, "has no triangle and is skipped");
        return false;
    }
    return true;
}

Result<Mesh> readMesh(Document& document, std::size_t index, int defaultMaterial) {
    const Json& json = document.json()["meshes"][index];
    const Json& primitives = arrayMember(json, "primitives");
    Mesh mesh;
    mesh.name = textMember(json, "name");
    compareTargets(document, index);
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        Primitive primitive;
        primitive.pointer = fmt::format("/meshes/{}/primitives/{}", index, i);
        primitive.material = integerMember(primitives[i], "material", defaultMaterial);
        const Result<bool> drawn = readPrimitive({document, primitives[i]}, primitive);
        // A file may leave it to others to provide data (glTF 2.0, section 3.6.1.1), so this is not the
        // file's fault.
        if (!drawn && drawn.error().id == kNoData) {
            document.warn("buffer-external", primitive.pointer,
                          fmt::format("is left out: {} {}", drawn.error().where, drawn.error().message),
                          drawn.error().hint);
        } else if (!drawn) {
            return drawn.error();
        }
        if (drawn && *drawn) {
            mesh.primitives.push_back(std::move(primitive));
        } else {
            // The last warning says why.
            mesh.leftOut.push_back(primitive.pointer + ": " + document.warnings().back().message);
        }
    }
    return mesh;
}

// Whether nodes show the mesh with different weights, or an animation changes the weights.
bool weightsVary(const Scene& scene, int mesh, const std::vector<double>& weights) {
    const auto shows = [&](int node) { return scene.nodes[static_cast<std::size_t>(node)].mesh == mesh; };
    const bool moves = std::ranges::any_of(scene.animations, [&](const Animation& animation) {
        return std::ranges::any_of(animation.channels, [&](const AnimationChannel& channel) {
            return (channel.path == AnimationPath::Weights || channel.path == AnimationPath::Weight) &&
                   shows(channel.target);
        });
    });
    return moves || std::ranges::any_of(scene.nodes, [&](const Node& node) {
               return node.mesh == mesh && node.weights != weights;
           });
}

// Adds the differences of the targets to the colours. Returns whether there are any.
bool morphColors(Primitive& primitive, const std::vector<double>& weights) {
    bool any = false;
    for (std::size_t t = 0; t < primitive.targets.size(); ++t) {
        const std::vector<Float4> differences = std::exchange(primitive.targets[t].colors, {});
        any = any || !differences.empty();
        constexpr double kLargest = std::numeric_limits<float>::max();
        const auto weight = static_cast<float>(std::clamp(weights[t], -kLargest, kLargest));
        for (std::size_t i = 0; i < differences.size(); ++i) {
            for (std::size_t c = 0; c < 4; ++c) {
                primitive.colors[i][c] += weight * differences[i][c];
            }
        }
    }
    return any;
}

}  // namespace

void settleColors(Document& document, Scene& scene) {
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        Mesh& mesh = scene.meshes[m];
        const auto node = std::ranges::find(scene.nodes, static_cast<int>(m), &Node::mesh);
        const std::vector<double>& weights = node == scene.nodes.end() ? mesh.weights : node->weights;
        for (Primitive& primitive : mesh.primitives) {
            if (morphColors(primitive, weights) && weightsVary(scene, static_cast<int>(m), weights)) {
                document.warn("morph-attribute", primitive.pointer + "/targets",
                              "the differences of COLOR_0 are added with the weights at rest of the first "
                              "node that shows the mesh; other weights don't change the colours",
                              "animate the material instead, or give each shape a mesh of its own");
            }
            for (Float4& color : primitive.colors) {
                // A sum of huge differences may be NaN, which becomes 0.
                std::ranges::transform(color, color.begin(), [](float channel) {
                    return channel > 0.0F ? std::min(channel, 1.0F) : 0.0F;
                });
            }
            primitive.colorContent = contentOf(primitive.colors);
        }
    }
}

Result<bool> importMeshes(Document& document, const std::vector<bool>& placed, Scene& scene) {
    const int defaultMaterial = static_cast<int>(scene.materials.size());
    bool usesDefault = false;
    for (std::size_t i = 0; i < arraySize(document.json(), "/meshes"); ++i) {
        Result<Mesh> mesh = readMesh(document, i, defaultMaterial);
        if (!mesh && placed[i]) {
            return mesh.error();
        }
        if (!mesh) {
            Diagnostic warning = mesh.error();
            warning.severity = Severity::Warning;
            warning.message += "; no node draws the mesh, and it is left empty";
            document.warnings().push_back(std::move(warning));
            scene.meshes.emplace_back().name = textMember(document.json()["meshes"][i], "name");
            continue;
        }
        for (const Primitive& primitive : mesh->primitives) {
            usesDefault = usesDefault || primitive.material == defaultMaterial;
        }
        scene.meshes.push_back(std::move(*mesh));
    }
    return usesDefault;
}

}  // namespace glint::gltf
