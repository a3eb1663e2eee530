// Renders the pictures of glint render: one picture, or a sequence in which the scene moves.
#pragma once

#include "cli/console.h"
#include "cli/render/arguments.h"
#include "cli/render/report.h"
#include "gltf/scene.h"

#include <glint/renderer.h>
#include <glint/result.h>
#include <glint/session/camera.h>
#include <glint/session/edits.h>
#include <glint/session/session.h>
#include <glint/session/textures.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glint::cli {

// The edits of --edits, and what they need.
struct EditPlan {
    std::vector<session::Edit> edits;  // by frame
    session::SceneFiles files;
    // The textures of these files, by the same names.
    std::map<std::string, std::shared_ptr<const session::TextureSet>, std::less<>> textures;
};

struct FrameSetup {
    const Console& console;
    const RenderArguments& arguments;
    const compiler::Settings& settings;        // that were decided
    const Environment* environment = nullptr;  // null: none
    const std::optional<Movement>& movement;   // nothing: the rest pose
    session::CameraChoice camera;              // of the first picture
    double aspect = 1.0;                       // width / height
    const LinearImage* reference = nullptr;    // that of --view-reference; null: none
    const EditPlan& edits;
    // Gets how many samples of all pictures are done, and how many there are.
    std::function<void(std::size_t done, std::size_t all)> progress{};
};

// Renders and writes every picture, and fills in the measurements. `scene`, from which `data` was made, is
// left in the last pose. `accept` is called before each picture is written. Its error ends the work; if it
// returns false, the work ends without an error.
Status renderFrames(Context& context, std::shared_ptr<const Package> package, const FrameSetup& setup,
                    gltf::Scene& scene, session::SceneViewData data,
                    const std::function<Result<bool>()>& accept, RenderReport& report);

// --- Open Image Denoise, for glint render --denoise. CMake links it where find_package() finds it ---

// Returns the error "denoise-missing" in a build without Open Image Denoise.
Status checkDenoiser();
// The layers that it reads beside the picture.
std::vector<std::string> denoiserLayers();
// Returns the renderer's last picture without its noise. Waits for the work. Errors: "denoise-missing";
// "layer-missing" if the package lacks a layer; "denoise-failed" with the library's own words.
Result<LinearImage> denoised(const LinearImage& picture, Renderer& renderer);

}  // namespace glint::cli
