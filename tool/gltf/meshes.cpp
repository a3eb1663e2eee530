// Imports meshes: modes, and the repair of attributes.
#include "base/vectors.h"
#include "gltf/steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

namespace glint::gltf {

// ---- Primitive modes as triangle lists ----

namespace {

struct TriangleList {
    std::vector<std::uint32_t> indices;  // 3 for each triangle
    std::size_t leftOver = 0;            // number of indices at the end that form no triangle
};

// The mode must be one of triangles. The winding is kept, so every second triangle of a strip is turned.
TriangleList makeTriangles(int mode, std::vector<std::uint32_t> indices) {
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        const std::size_t leftOver = indices.size() % 3;
        indices.resize(indices.size() - leftOver);
        return {std::move(indices), leftOver};
    }
    if (indices.size() < 3) {
        return {{}, indices.size()};
    }
    TriangleList list;
    list.indices.reserve((indices.size() - 2) * 3);
    for (std::size_t i = 0; i + 2 < indices.size(); ++i) {
        // The specification orders the vertices in this way (glTF 2.0, section 3.7.2.1).
        const std::size_t odd = i % 2;
        if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
            list.indices.insert(list.indices.end(), {indices[i], indices[i + 1 + odd], indices[i + 2 - odd]});
        } else {
            list.indices.insert(list.indices.end(), {indices[i + 1], indices[i + 2], indices[0]});
        }
    }
    return list;
}

// ---- Attributes that are finite and of unit length ----

constexpr const char* kRepairHint = "repair the mesh, or export it again";

glm::dvec3 subtract(const Float3& a, const Float3& b) {
    return base::toVector(a) - base::toVector(b);
}

// Returns a vector of unit length, or nothing if the vector is zero or not finite. Doubles can hold the
// squares of all floats. Products of two squared floats underflow only far below what a float can hold.
std::optional<Float3> unitVector(const glm::dvec3& v) {
    const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
    if (!std::isfinite(largest) || largest == 0.0) {
        return std::nullopt;
    }
    const Float3 unit = base::toFloat3(glm::normalize(v / largest));
    return base::isFinite(unit) ? std::optional(unit) : std::nullopt;
}

void dropBrokenTriangles(Document& document, Primitive& primitive) {
    std::vector<bool> broken(primitive.positions.size());
    std::size_t brokenCount = 0;
    for (std::size_t i = 0; i < primitive.positions.size(); ++i) {
        if (!base::isFinite(primitive.positions[i])) {
            broken[i] = true;
            primitive.positions[i] = {};
            ++brokenCount;
        }
    }
    if (brokenCount == 0) {
        return;
    }
    std::vector<std::uint32_t> kept;
    kept.reserve(primitive.indices.size());
    const auto& indices = primitive.indices;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        if (!broken[indices[i]] && !broken[indices[i + 1]] && !broken[indices[i + 2]]) {
            kept.insert(kept.end(), {indices[i], indices[i + 1], indices[i + 2]});
        }
    }
    const std::size_t dropped = (indices.size() - kept.size()) / 3;
    primitive.indices = std::move(kept);
    document.warn("position-not-finite", primitive.pointer + "/attributes/POSITION",
                  fmt::format("{} positions are not finite; {} triangles that use them are dropped",
                              brokenCount, dropped),
                  kRepairHint);
}

// Returns the geometric normal of one triangle around each vertex that `wanted` marks, or +Z if there is
// none.
std::vector<Float3> adjacentNormals(const Primitive& primitive, const std::vector<bool>& wanted) {
    std::vector<Float3> normals(primitive.positions.size(), Float3{0.0F, 0.0F, 1.0F});
    std::vector<bool> found(primitive.positions.size());
    const auto& indices = primitive.indices;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const Float3& origin = primitive.positions[indices[i]];
        const auto normal = unitVector(glm::cross(subtract(primitive.positions[indices[i + 1]], origin),
                                                  subtract(primitive.positions[indices[i + 2]], origin)));
        for (std::size_t corner = i; normal && corner < i + 3; ++corner) {
            const std::uint32_t vertex = indices[corner];
            if (wanted[vertex] && !found[vertex]) {
                found[vertex] = true;
                normals[vertex] = *normal;
            }
        }
    }
    return normals;
}

void repairNormals(Document& document, Primitive& primitive) {
    std::vector<bool> broken(primitive.normals.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < primitive.normals.size(); ++i) {
        const auto unit = unitVector(base::toVector(primitive.normals[i]));
        broken[i] = !unit;
        count += unit ? 0 : 1;
        primitive.normals[i] = unit.value_or(Float3{});
    }
    if (count == 0) {
        return;
    }
    const std::vector<Float3> substitutes = adjacentNormals(primitive, broken);
    for (std::size_t i = 0; i < broken.size(); ++i) {
        if (broken[i]) {
            primitive.normals[i] = substitutes[i];
        }
    }
    document.warn("normal-invalid", primitive.pointer + "/attributes/NORMAL",
                  fmt::format("{} normals are zero or not finite; that of a triangle beside is used", count),
                  kRepairHint);
}

// Returns a unit vector at right angles to `normal`.
Float3 anyTangent(const Float3& normal) {
    const glm::dvec3 n = base::toVector(normal);
    const glm::dvec3 axis = std::abs(n[0]) < 0.5 ? glm::dvec3{1.0, 0.0, 0.0} : glm::dvec3{0.0, 1.0, 0.0};
    return unitVector(glm::cross(axis, n)).value_or(Float3{1.0F, 0.0F, 0.0F});
}

void repairTangents(Document& document, Primitive& primitive) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < primitive.tangents.size(); ++i) {
        const Float4 stored = primitive.tangents[i];
        const auto unit = unitVector({stored[0], stored[1], stored[2]});
        const Float3 tangent = unit ? *unit : anyTangent(primitive.normals[i]);
        const bool valid = unit.has_value() && std::abs(stored[3]) == 1.0F;
        count += valid ? 0 : 1;
        primitive.tangents[i] = {tangent[0], tangent[1], tangent[2], stored[3] < 0.0F ? -1.0F : 1.0F};
    }
    if (count > 0) {
        document.warn(
            "tangent-invalid", primitive.pointer + "/attributes/TANGENT",
            fmt::format("{} tangents are zero or not finite, or have a w other than 1 and -1; others in the "
                        "surface are used, and the sign of w",
                        count),
            kRepairHint);
    }
}

// The values are numbers or arrays of them.
template <typename Value>
void replaceNonFinite(Document& document, const Primitive& primitive, std::vector<Value>& values,
                      float substitute, std::string_view attribute) {
    std::size_t count = 0;
    for (Value& value : values) {
        if constexpr (std::is_same_v<Value, float>) {
            count += std::isfinite(value) ? 0 : 1;
            value = std::isfinite(value) ? value : substitute;
        } else if (!base::isFinite(value)) {
            value.fill(substitute);
            ++count;
        }
    }
    if (count > 0) {
        document.warn("attribute-not-finite", fmt::format("{}/attributes/{}", primitive.pointer, attribute),
                      fmt::format("{} values are not finite; {} is used", count, substitute), kRepairHint);
    }
}

// Drops triangles that use a position that is not finite, and moves such positions to the origin. Normalises
// normals and tangents. A normal that is zero or not finite becomes the geometric normal of a triangle around
// it, or +Z if there is none; such a tangent becomes any direction in the surface. Texture coordinates that
// are not finite become 0, and such colours become 1. Warns once about each kind and states the count.
void repairPrimitive(Document& document, Primitive& primitive) {
    dropBrokenTriangles(document, primitive);
    repairNormals(document, primitive);
    repairTangents(document, primitive);
    replaceNonFinite(document, primitive, primitive.texCoords0, 0.0F, "TEXCOORD_0");
    replaceNonFinite(document, primitive, primitive.texCoords1, 0.0F, "TEXCOORD_1");
    replaceNonFinite(document, primitive, primitive.colors, 1.0F, "COLOR_0");
    for (VertexValues& declared : primitive.attributes) {
        replaceNonFinite(document, primitive, declared.values, 0.0F, declared.name);
    }
    for (MorphTarget& target : primitive.targets) {
        replaceNonFinite(document, primitive, target.positions, 0.0F, "POSITION of a morph target");
        replaceNonFinite(document, primitive, target.normals, 0.0F, "NORMAL of a morph target");
        replaceNonFinite(document, primitive, target.tangents, 0.0F, "TANGENT of a morph target");
        replaceNonFinite(document, primitive, target.colors, 0.0F, "COLOR_0 of a morph target");
    }
}

// ---- Meshes ----

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
Result<bool> isDrawable(Document& document, const tinygltf::Primitive& file, const std::string& pointer) {
    const int mode = file.mode;
    if (mode < 0 || mode > TINYGLTF_MODE_TRIANGLE_FAN) {
        return document.error("primitive-mode", pointer + "/mode", fmt::format("{} is no mode", mode),
                              "export the mesh again");
    }
    if (mode < TINYGLTF_MODE_TRIANGLES) {
        document.warn("primitive-skipped", pointer,
                      "points and lines have no surface that a ray can hit; they are skipped");
        return false;
    }
    if (!file.attributes.contains("POSITION")) {
        return document.error("position-missing", pointer + "/attributes", "has no POSITION",
                              "export the mesh again, or delete the primitive");
    }
    return true;
}

// Reads the primitive. Returns whether it has anything to draw.
Result<bool> readPrimitive(Document& document, const tinygltf::Primitive& file, Primitive& primitive) {
    Result<bool> drawable = isDrawable(document, file, primitive.pointer);
    if (!drawable || !*drawable) {
        return drawable;
    }
    bool isList = false;
    GLINT_TRY(auto order, readVertices(document, file, primitive, isList));
    const int mode = isList ? TINYGLTF_MODE_TRIANGLES : file.mode;
    TriangleList list = makeTriangles(mode, std::move(order));
    if (list.leftOver > 0) {
        document.warn("triangle-incomplete", primitive.pointer,
                      fmt::format("the last {} vertices make no triangle and are dropped", list.leftOver));
    }
    primitive.indices = std::move(list.indices);
    GLINT_TRY_DO(readTargets(document, file, primitive));
    repairPrimitive(document, primitive);
    if (primitive.indices.empty()) {
        document.warn("primitive-empty", primitive.pointer, "has no triangle and is skipped");
        return false;
    }
    return true;
}

// Reads meshes one after another. Primitives that differ in their materials alone are read once, and copied.
class MeshReader {
public:
    // `scene` gets each mesh that was read, or an empty one in its place.
    MeshReader(Document& document, const Scene& scene) : document_(document), scene_(scene) {}

    Result<Mesh> read(std::size_t index) {
        const tinygltf::Mesh& file = document_.model().meshes[index];
        Mesh mesh;
        mesh.name = file.name;
        compareTargets(document_, index);
        for (std::size_t i = 0; i < file.primitives.size(); ++i) {
            Primitive primitive;
            primitive.pointer = fmt::format("/meshes/{}/primitives/{}", index, i);
            const Result<bool> drawn = read(file.primitives[i], primitive, {index, mesh.primitives.size()});
            const int material = file.primitives[i].material;
            primitive.material = material < 0 ? static_cast<int>(scene_.materials.size()) : material;
            // A file may leave it to others to provide data (glTF 2.0, section 3.6.1.1), so this is not the
            // file's fault.
            if (!drawn && drawn.error().id == kNoData) {
                document_.warn("buffer-external", primitive.pointer,
                               fmt::format("is left out: {} {}", drawn.error().where, drawn.error().message),
                               drawn.error().hint);
            } else if (!drawn) {
                return drawn.error();
            }
            if (drawn && *drawn) {
                mesh.primitives.push_back(std::move(primitive));
            } else {
                // The last warning says why.
                mesh.leftOut.push_back(primitive.pointer + ": " + document_.warnings().back().message);
            }
        }
        return mesh;
    }

private:
    struct Place {
        std::size_t mesh = 0;
        std::size_t primitive = 0;
        std::uint64_t elements = 0;  // that reading it took from the budget of vertices
    };
    struct BySource {
        bool operator()(const tinygltf::Primitive* a, const tinygltf::Primitive* b) const {
            return std::tie(a->attributes, a->indices, a->mode) <
                   std::tie(b->attributes, b->indices, b->mode);
        }
    };

    // Returns whether the primitive has anything to draw. `place` is where it will be.
    Result<bool> read(const tinygltf::Primitive& file, Primitive& primitive, Place place) {
        const bool isPlain = file.targets.empty() && file.extensions.empty();
        const auto known = isPlain ? known_.find(&file) : known_.end();
        if (known != known_.end()) {
            const auto& [mesh, number, elements] = known->second;
            if (mesh < scene_.meshes.size() && number < scene_.meshes[mesh].primitives.size()) {
                GLINT_TRY_DO(document_.chargeVertices(elements, primitive.pointer));
                std::string pointer = std::move(primitive.pointer);
                primitive = scene_.meshes[mesh].primitives[number];
                primitive.pointer = std::move(pointer);
                return true;
            }
        }
        const std::size_t warnings = document_.warnings().size();
        const std::uint64_t before = document_.vertices().left();
        const Result<bool> drawn = readPrimitive(document_, file, primitive);
        if (isPlain && drawn && *drawn && document_.warnings().size() == warnings) {
            place.elements = before - document_.vertices().left();
            known_.try_emplace(&file, place);
        }
        return drawn;
    }

    Document& document_;
    const Scene& scene_;
    std::map<const tinygltf::Primitive*, Place, BySource> known_;  // read without a warning
};

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
        // The search takes long in a scene of many meshes, and few have morph targets.
        const auto node = mesh.weights.empty()
                              ? scene.nodes.end()
                              : std::ranges::find(scene.nodes, static_cast<int>(m), &Node::mesh);
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

Status importMeshes(Document& document, const std::vector<bool>& placed, Scene& scene) {
    MeshReader reader(document, scene);
    for (std::size_t i = 0; i < document.model().meshes.size(); ++i) {
        Result<Mesh> mesh = reader.read(i);
        if (!mesh && placed[i]) {
            return mesh.error();
        }
        if (!mesh) {
            Diagnostic warning = mesh.error();
            warning.severity = Severity::Warning;
            warning.message += "; no node draws the mesh, and it is left empty";
            document.warnings().push_back(std::move(warning));
            scene.meshes.emplace_back().name = document.model().meshes[i].name;
            continue;
        }
        scene.meshes.push_back(std::move(*mesh));
    }
    return okStatus();
}

}  // namespace glint::gltf
