#include "data/scene_checks.h"

#include "data/geometry.h"
#include "data/instance_math.h"
#include "data/materials.h"
#include "package/package.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <tuple>

namespace glint {
namespace {

constexpr const char* kSameScene = "compile the package from the scene that is rendered";

std::string placeOfPrimitive(std::uint32_t mesh, std::uint32_t primitive) {
    return phrase("mesh ", mesh, ", primitive ", primitive);
}

// An attribute span of a primitive by name, and the role of the feature whose keys need it.
struct Attribute {
    const char* name;
    std::size_t count;
    package::Role role;
};

std::array<Attribute, 5> namedAttributes(const PrimitiveView& view) {
    using enum package::Role;
    return {{{"normals", view.normals.size(), Normals},
             {"tangents", view.tangents.size(), Tangents},
             {"texCoords0", view.texCoords0.size(), TexCoord0},
             {"texCoords1", view.texCoords1.size(), TexCoord1},
             {"colors", view.colors.size(), VertexColor}}};
}

Diagnostic wrongCount(const Attribute& attribute, const PrimitiveView& view, const std::string& where) {
    return makeError("scene-attribute", where,
                     phrase(attribute.name, " has ", attribute.count, " elements for ", view.positions.size(),
                            " positions"),
                     "leave the span empty or make it as long as positions");
}

Status checkAttributes(const Package& package, const PrimitiveView& view,
                       const package::PrimitiveEntry& entry, const std::string& where) {
    for (const Attribute& attribute : namedAttributes(view)) {
        if (attribute.count != 0 && attribute.count != view.positions.size()) {
            return wrongCount(attribute, view, where);
        }
        const bool needed = package.state().hasFeature(entry.key, attribute.role);
        if (needed && attribute.count == 0 && !view.positions.empty()) {
            return makeError(
                "scene-package", where,
                std::string("the package's key reads ") + attribute.name + ", the primitive has none",
                kSameScene);
        }
    }
    return okStatus();
}

// The attributes of packs that the primitive's key reads.
Status checkDeclared(const Package& package, const PrimitiveView& view, const package::PrimitiveEntry& entry,
                     const std::string& where) {
    for (const package::AttributeEntry& row : package.attributes()) {
        const std::string name(package.string(row.name));
        const auto given = std::ranges::find(view.attributes, name, &PrimitiveView::Attribute::name);
        if (given == view.attributes.end()) {
            if (entry.key.hasAny(row.feature) && row.hasFallback == 0 && !view.positions.empty()) {
                return makeError("scene-package", where,
                                 "the package's key reads " + name + ", the primitive has none", kSameScene);
            }
            continue;
        }
        if (given->channels != row.channels || given->values.size() != view.positions.size() * row.channels) {
            return makeError(
                "scene-attribute", where,
                phrase(name, " has ", given->values.size(), " values in ", given->channels, " channels for ",
                       view.positions.size(), " positions; the package reads ", row.channels, " channels"),
                "give as many values as the positions have, times the package's channels");
        }
    }
    return okStatus();
}

Status checkIndices(const PrimitiveView& view, const std::string& where) {
    constexpr std::size_t kMaxCount = std::numeric_limits<std::uint32_t>::max();
    if (view.indices.size() % 3 != 0) {
        return makeError("scene-index", where,
                         std::to_string(view.indices.size()) + " indices are no list of triangles",
                         "give three indices for each triangle");
    }
    if (view.indices.size() > kMaxCount || view.positions.size() > kMaxCount) {
        return makeError("scene-index", where, "the primitive has more than 2^32 - 1 vertices or indices",
                         "split the primitive");
    }
    const auto outside = std::ranges::find_if(
        view.indices, [&](std::uint32_t index) { return index >= view.positions.size(); });
    if (outside != view.indices.end()) {
        return makeError("scene-index", where,
                         phrase("index ", outside - view.indices.begin(), " is ", *outside, ", there are ",
                                view.positions.size(), " positions"),
                         "repair the primitive's indices");
    }
    return okStatus();
}

std::tuple<std::uint32_t, std::uint32_t> orderOf(const PrimitiveView& view) {
    return {view.mesh, view.primitive};
}

Status checkPrimitives(const Package& package, const PackageScene& known,
                       std::span<const PrimitiveView> primitives) {
    const PrimitiveView* previous = nullptr;
    for (const PrimitiveView& view : primitives) {
        const std::string where = placeOfPrimitive(view.mesh, view.primitive);
        if (previous != nullptr && orderOf(*previous) >= orderOf(view)) {
            return makeError("scene-order", where, "the primitives are not sorted, or one is there twice",
                             "sort them by mesh, then primitive");
        }
        previous = &view;
        const package::PrimitiveEntry* entry = known.findPrimitive(view.mesh, view.primitive);
        if (entry == nullptr) {
            return makeError("scene-package", where, "the package does not know this primitive", kSameScene);
        }
        GLINT_TRY_DO(checkAttributes(package, view, *entry, where));
        GLINT_TRY_DO(checkDeclared(package, view, *entry, where));
        GLINT_TRY_DO(checkIndices(view, where));
    }
    return okStatus();
}

// The scene must have every primitive that the package has for an instance's mesh.
Status checkInstances(const PackageScene& known, const SceneView& scene) {
    std::set<std::uint32_t> used;
    for (const InstanceView& instance : scene.instances) {
        used.insert(instance.mesh);
    }
    for (const package::PrimitiveEntry& entry : known.primitives) {
        if (!used.contains(entry.mesh)) {
            continue;
        }
        if (!std::ranges::binary_search(scene.primitives, std::tuple(entry.mesh, entry.primitive),
                                        std::less<>{}, orderOf)) {
            return makeError("scene-package", placeOfPrimitive(entry.mesh, entry.primitive),
                             "the scene lacks a primitive that the package knows", kSameScene);
        }
    }
    return okStatus();
}

Status checkImages(const PackageScene& known, std::span<const ImageView> images, const ImageLimits& limits) {
    for (const package::TextureEntry& texture : known.textures) {
        const std::string where = "image " + std::to_string(texture.image);
        if (texture.image >= images.size()) {
            return makeError(
                "scene-package", where,
                "the package refers to this image, the scene has " + std::to_string(images.size()),
                kSameScene);
        }
        GLINT_TRY_DO(checkDimension(images[texture.image].dimension, texture.dimension, where));
        GLINT_TRY_DO(checkImage(images[texture.image], texture.srgb != 0, where, limits));
    }
    return okStatus();
}

// Lights that are emissive triangles read the texels of their emission on the host.
Status checkEmission(const Package& package, const PackageScene& known, std::span<const ImageView> images) {
    const package::EmissionEntry* const emission = package.emission();
    if (emission == nullptr || emission->texture == package::EmissionEntry::kNone) {
        return okStatus();
    }
    const RecordFields fields = recordFields(package, known);
    for (std::size_t i = 0; i < known.materials.size(); ++i) {
        const std::uint32_t texture = textureAt(known.materials, i, emission->texture).textureIndex;
        const bool isOfModel = fields.hasAt(placeOfTexture(known.materials, 0, emission->texture),
                                            fields.modelOf(static_cast<std::uint32_t>(i)));
        if (texture >= known.textures.size() || !isOfModel) {
            continue;
        }
        const ImageView& image = images[known.textures[texture].image];
        const std::uint64_t wanted = bytesOfLevel(TexelFormat::Rgba8, image.width, image.height, 0);
        if (isBlockFormat(image.format) && image.decoded.size() != wanted) {
            return makeError("scene-image", "image " + std::to_string(known.textures[texture].image),
                             std::string("the image is in the format ") + infoOf(image.format).name +
                                 ", and triangles with it are lights, whose texels the host has to read",
                             "give its first level in RGBA of 8 bits as ImageView::decoded");
        }
    }
    return okStatus();
}

}  // namespace

ImageLimits imageLimits(const Context::State& context) {
    const VkPhysicalDeviceLimits& core = context.limits.core;
    return {core.maxImageDimension2D, context.limits.texelFormats, core.maxImageArrayLayers,
            core.maxImageDimensionCube, core.maxImageDimension3D};
}

Status checkDimension(package::TextureEntry::Dimension given, package::TextureEntry::Dimension wanted,
                      const std::string& where) {
    if (given == wanted) {
        return okStatus();
    }
    const auto of = [](package::TextureEntry::Dimension dimension) {
        return static_cast<std::size_t>(dimension) < std::size(package::kTextureDimensionNames)
                   ? std::string(namesOf(dimension)[static_cast<std::size_t>(dimension)].what)
                   : "of no known dimension";
    };
    return makeError("texture-dimension", where,
                     "the texture is " + of(given) + ", and the package's shaders read " + of(wanted),
                     "give an image with the dimension that the declaration of the texture has");
}

namespace {

// Checks the number of texels of each axis, and of layers.
Status checkSize(const ImageView& image, const std::string& where, const ImageLimits& limits) {
    using Dimension = ImageView::Dimension;
    const bool isVolume = image.dimension == Dimension::Volume;
    const std::uint32_t most = isVolume                             ? limits.maxVolumeSize
                               : image.dimension == Dimension::Cube ? limits.maxCubeSize
                                                                    : limits.maxSize;
    if (image.width == 0 || image.height == 0 || image.width > most || image.height > most) {
        return makeError("scene-image", where,
                         phrase("the image is ", image.width, " x ", image.height,
                                " pixels, the device takes 1 to ", most),
                         "scale the image");
    }
    const std::uint32_t mostLayers = image.dimension == Dimension::Flat    ? 1
                                     : image.dimension == Dimension::Array ? limits.maxLayers
                                     : isVolume                            ? limits.maxVolumeSize
                                                                           : 6;
    const bool isCube = image.dimension == Dimension::Cube;
    if (image.layers == 0 || image.layers > mostLayers || (isCube && image.layers != mostLayers)) {
        return makeError("scene-image", where,
                         phrase("the image has ", image.layers, " layers, it takes ",
                                (isCube || mostLayers == 1 ? "" : "1 to "), mostLayers),
                         "give ImageView::dimension and ImageView::layers as they are");
    }
    if (isCube && image.width != image.height) {
        return makeError("scene-image", where, "the faces of the cube are not square", "scale the image");
    }
    return okStatus();
}

}  // namespace

Status checkImage(const ImageView& image, bool srgb, const std::string& where, const ImageLimits& limits) {
    GLINT_TRY_DO(checkSize(image, where, limits));
    const bool knownChannels = std::ranges::all_of(
        image.channels, [](TexelChannel channel) { return channel <= TexelChannel::One; });
    if (static_cast<std::size_t>(image.format) >= kTexelFormatCount || !knownChannels) {
        return makeError("scene-image", where, "the image has an unknown format, or channels of one",
                         "use values of TexelFormat and TexelChannel");
    }
    const TexelFormatInfo& info = infoOf(image.format);
    if (image.dimension == package::TextureEntry::Dimension::Volume && !hasVolumes(image.format)) {
        return makeError("scene-image", where,
                         std::string("there are no 3D images in the format ") + info.name,
                         "give it in RGBA8 or in a BC format");
    }
    if (isBlockFormat(image.format) && !limits.formats.has(image.format, srgb)) {
        return makeError("scene-image", where,
                         std::string("the device does not read ") + info.name +
                             (srgb ? " as colours in sRGB" : " as linear data"),
                         "give a format of Context::texelFormats(), or the image in RGBA8");
    }
    const std::uint32_t most = image.mostLevels();
    if (image.levels == 0 || image.levels > most) {
        return makeError("scene-image", where,
                         phrase("the image has ", image.levels, " levels, its size takes 1 to ", most),
                         "give the levels that there are");
    }
    if (image.pixels.size() != image.byteCount(image.levels)) {
        return makeError("scene-image", where,
                         phrase(image.pixels.size(), " bytes do not make ", image.levels, " levels of ",
                                image.width, " x ", image.height, " pixels in ", info.name, ", which take ",
                                image.byteCount(image.levels)),
                         "give all of the levels");
    }
    return okStatus();
}

Status checkGeometry(const PrimitiveView& view, const std::string& where) {
    for (const Attribute& attribute : namedAttributes(view)) {
        if (attribute.count != 0 && attribute.count != view.positions.size()) {
            return wrongCount(attribute, view, where);
        }
    }
    return checkIndices(view, where);
}

Status checkDisks(bool areKnown, std::span<const LightView> lights) {
    const auto disk = std::ranges::find(lights, LightView::Type::Disk, &LightView::type);
    return areKnown || disk == lights.end()
               ? okStatus()
               : makeError("scene-light", "light " + std::to_string(disk - lights.begin()),
                           "the package's shaders know no disks", "compile it with --disk-lights on");
}

Status checkLights(const Package& package, std::span<const LightView> lights) {
    GLINT_TRY_DO(checkLights(lights));
    return checkDisks(package.diskLights(), lights);
}

Status checkLights(std::span<const LightView> lights) {
    for (const LightView& light : lights) {
        const float values[] = {
            light.intensity[0], light.intensity[1],   light.intensity[2],   light.position[0],
            light.position[1],  light.position[2],    light.direction[0],   light.direction[1],
            light.direction[2], light.innerConeAngle, light.outerConeAngle, light.range,
            light.size};
        if (!isFinite(values) || light.type > LightView::Type::Disk) {
            return makeError("scene-light", "light " + std::to_string(&light - lights.data()),
                             "the light has a value that is not finite, or an unknown type",
                             "repair the light");
        }
        const bool tooWide = light.type == LightView::Type::Directional && light.size >= 1.5707963F;
        if (light.size < 0.0F || tooWide) {
            return makeError("scene-light", "light " + std::to_string(&light - lights.data()),
                             "the size of the light is negative, or a quarter turn or more",
                             "give a radius in metres, or an angle in radians");
        }
    }
    return okStatus();
}

Status checkScene(const Package& package, const PackageScene& known, const SceneView& scene,
                  const ImageLimits& limits) {
    GLINT_TRY_DO(checkPrimitives(package, known, scene.primitives));
    GLINT_TRY_DO(checkInstances(known, scene));
    GLINT_TRY_DO(checkImages(known, scene.images, limits));
    GLINT_TRY_DO(checkEmission(package, known, scene.images));
    GLINT_TRY_DO(checkDeformation(scene));
    GLINT_TRY_DO(checkOrigin(scene.origin));
    return checkLights(package, scene.lights);
}

Status checkOrigin(const std::array<double, 3>& origin) {
    if (!std::ranges::all_of(origin, [](double value) { return std::isfinite(value); })) {
        return makeError("scene-origin", "", "the scene's origin is not finite",
                         "give a place in metres, or leave it at 0");
    }
    return okStatus();
}

namespace {

constexpr const char* kGiveAll = "give as many as at upload, in the same order";

Diagnostic attributeError(const PrimitiveView& view, const std::string& what, const char* hint) {
    return makeError("scene-attribute", phrase("mesh ", view.mesh, ", primitive ", view.primitive), what,
                     hint);
}

Status checkTargets(const PrimitiveView& view) {
    for (const PrimitiveView::MorphTarget& target : view.targets) {
        struct Member {
            std::size_t count;
            std::size_t base;
        };
        for (const Member& member : {Member{target.positions.size(), view.positions.size()},
                                     Member{target.normals.size(), view.normals.size()},
                                     Member{target.tangents.size(), view.tangents.size()}}) {
            if (member.count != 0 && member.count != member.base) {
                return attributeError(view,
                                      phrase("a morph target has ", member.count,
                                             " differences to an attribute of ", member.base, " elements"),
                                      "give a difference for each element, or none");
            }
        }
    }
    return okStatus();
}

Status checkInfluences(const PrimitiveView& view) {
    if (view.joints.size() != view.jointWeights.size()) {
        return attributeError(view, "the joints are not as many as their weights", "give a weight a joint");
    }
    if (!view.joints.empty() && (view.positions.empty() || view.joints.size() % view.positions.size() != 0)) {
        return attributeError(view, "the joints are not as many for each vertex",
                              "give each vertex the same number; weights may be 0");
    }
    return okStatus();
}

// Returns one more than the largest joint index that a vertex of the mesh uses.
std::size_t jointsNeeded(std::span<const PrimitiveView> primitives) {
    std::size_t needed = 0;
    for (const PrimitiveView& view : primitives) {
        for (const std::uint16_t joint : view.joints) {
            needed = std::max(needed, joint + std::size_t{1});
        }
    }
    return needed;
}

Status checkFinite(const InstanceView& instance, const std::string& where) {
    for (const std::array<float, 12>& joint : instance.joints) {
        if (!isFinite(joint)) {
            return makeError("scene-motion", where, "a joint has a number that is not finite",
                             "repair the pose");
        }
    }
    if (!isFinite(instance.morphWeights)) {
        return makeError("scene-motion", where, "a morph weight is not finite", "repair the pose");
    }
    return okStatus();
}

Diagnostic otherCount(const std::string& where, const std::string& what, std::size_t count,
                      std::size_t expected) {
    return makeError("scene-motion", where,
                     phrase("there are ", count, " ", what, ", at upload there were ", expected), kGiveAll);
}

}  // namespace

Status checkPose(const InstanceView& pose, std::size_t joints, std::size_t targets,
                 const std::string& where) {
    GLINT_TRY_DO(checkFinite(pose, where));
    if (!pose.joints.empty() && joints > pose.joints.size()) {
        return makeError("scene-index", where,
                         phrase("a vertex follows joint ", joints - 1, ", there are ", pose.joints.size()),
                         "give every joint that the mesh follows");
    }
    if (pose.morphWeights.size() > targets) {
        return makeError(
            "scene-motion", where,
            phrase("there are ", pose.morphWeights.size(), " weights for ", targets, " morph targets"),
            "give one weight for each target");
    }
    return okStatus();
}

Status checkDeformation(const SceneView& scene) {
    for (const PrimitiveView& view : scene.primitives) {
        GLINT_TRY_DO(checkTargets(view));
        GLINT_TRY_DO(checkInfluences(view));
    }
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const InstanceView& instance = scene.instances[i];
        const std::string where = "instance " + std::to_string(i);
        const PrimitiveRange own = primitivesOf(scene.primitives, instance.mesh);
        const std::span<const PrimitiveView> primitives =
            scene.primitives.subspan(own.first, own.end - own.first);
        std::size_t targets = 0;
        for (const PrimitiveView& view : primitives) {
            targets = std::max(targets, view.targets.size());
        }
        GLINT_TRY_DO(
            checkPose(instance, instance.joints.empty() ? 0 : jointsNeeded(primitives), targets, where));
    }
    return okStatus();
}

Status checkMotion(const MotionView& motion, const MotionShape& shape) {
    if (motion.instances.size() != shape.instances.size()) {
        return otherCount("", "instances", motion.instances.size(), shape.instances.size());
    }
    if (motion.lights.size() != shape.lights.size()) {
        return otherCount("", "lights", motion.lights.size(), shape.lights.size());
    }
    for (std::size_t i = 0; i < motion.instances.size(); ++i) {
        const InstanceView& instance = motion.instances[i];
        const std::string where = "instance " + std::to_string(i);
        const MotionShape::Instance& uploaded = shape.instances[i];
        if (instance.mesh != uploaded.mesh) {
            return makeError("scene-motion", where, "the instance has another mesh than at upload", kGiveAll);
        }
        if (instance.joints.size() != uploaded.joints) {
            return otherCount(where, "joints", instance.joints.size(), uploaded.joints);
        }
        if (instance.morphWeights.size() != uploaded.weights) {
            return otherCount(where, "morph weights", instance.morphWeights.size(), uploaded.weights);
        }
        GLINT_TRY_DO(checkFinite(instance, where));
    }
    for (std::size_t i = 0; i < motion.lights.size(); ++i) {
        if (motion.lights[i].type != shape.lights[i]) {
            return makeError("scene-motion", "light " + std::to_string(i),
                             "the light has another type than at upload", kGiveAll);
        }
    }
    GLINT_TRY_DO(checkOrigin(motion.origin));
    return checkLights(motion.lights);
}

}  // namespace glint
