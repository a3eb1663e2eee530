// Checks whether a scene is well formed and is the one that a package was compiled from.
#pragma once

#include "context/context.h"

#include <glint/package.h>
#include <glint/result.h>
#include <glint/scene_view.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint {

// The images that a device accepts.
struct ImageLimits {
    std::uint32_t maxSize = 0;  // texels of an axis of a 2D image
    TexelFormats formats;
    std::uint32_t maxLayers = 256;
    std::uint32_t maxCubeSize = 4096;
    std::uint32_t maxVolumeSize = 256;
};
ImageLimits imageLimits(const Context::State& context);

// Pure. Errors: "scene-order", "scene-attribute", "scene-index", "scene-package" (the package knows another
// scene), "scene-image", "scene-light". Their place is for instance "mesh 3, primitive 1", "image 2" or
// "light 0".
// `known` is the scene of `package`.
Status checkScene(const Package& package, const PackageScene& known, const SceneView& scene,
                  const ImageLimits& limits);

// The part of checkScene() for joints, weights and morph targets of primitives and instances. Errors:
// "scene-attribute", "scene-index", "scene-motion".
Status checkDeformation(const SceneView& scene);

// Checks joints and weights against the number of joints that the mesh follows, and of its morph targets.
// Errors: "scene-index", "scene-motion".
Status checkPose(const InstanceView& pose, std::size_t joints, std::size_t targets, const std::string& where);

// The properties that a MotionView must share with the scene that was uploaded, in the order of instances and
// of lights.
struct MotionShape {
    struct Instance {
        std::uint32_t mesh = 0;
        std::size_t joints = 0;
        std::size_t weights = 0;
    };
    std::vector<Instance> instances;
    std::vector<LightView::Type> lights;
};

// Pure. Errors: "scene-motion", "scene-light", "scene-origin".
Status checkMotion(const MotionView& motion, const MotionShape& shape);

// Error "texture-dimension": an image has another dimension than the package's shaders read.
Status checkDimension(package::TextureEntry::Dimension given, package::TextureEntry::Dimension wanted,
                      const std::string& where);

// Checks the size, the format, the levels and the number of bytes of an image that is read as colour in sRGB
// or as linear data. Error "scene-image".
Status checkImage(const ImageView& image, bool srgb, const std::string& where, const ImageLimits& limits);

// Checks the indices of a primitive, and that its attributes are as many as its positions. Errors:
// "scene-attribute", "scene-index".
Status checkGeometry(const PrimitiveView& view, const std::string& where);

// Checks that SceneView::origin is finite. Error "scene-origin".
Status checkOrigin(const std::array<double, 3>& origin);

// Checks that every light is finite and of a known type. Error "scene-light".
Status checkLights(std::span<const LightView> lights);
// Checks that the shaders know disks (Package::diskLights()), if any light is one. Error "scene-light".
Status checkDisks(bool areKnown, std::span<const LightView> lights);
// Checks both.
Status checkLights(const Package& package, std::span<const LightView> lights);

}  // namespace glint
