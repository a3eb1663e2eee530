// The input of the scene renderer: a file as glint render reads it.
#pragma once

#include "gltf/scene.h"
#include "oracle/irradiance.h"
#include "oracle/view.h"

#include <glint/result.h>
#include <glint/scene_view.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace glint::oracle {

struct SceneChoice {
    std::filesystem::path path;
    std::string variant;
    std::string camera;  // as of glint render: a name, a number, "auto"; empty: the first, else "auto"
};

struct OracleInput {
    gltf::Scene scene;  // with its pixels; and a sun where the file has no light, as glint render adds one
    CameraView camera;
    View view;
};

// Has the errors of the import and of the camera; "oracle-moves" if a mesh has skins or morph targets.
Result<OracleInput> readOracleInput(const SceneChoice& choice, std::uint32_t width, std::uint32_t height);

// Returns the default sky of glint render.
GradientSky defaultSky();

struct ImageSize {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
};

// Parses WxH, 1 to 4096 each. Error "oracle-size".
Result<ImageSize> parseSize(const std::string& text);

}  // namespace glint::oracle
