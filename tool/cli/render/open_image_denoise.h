// Open Image Denoise, for glint render --denoise. CMake links it where find_package() finds it.
#pragma once

#include <glint/renderer.h>
#include <glint/result.h>

#include <string>
#include <vector>

namespace glint::cli {

// Returns the error "denoise-missing" in a build without Open Image Denoise.
Status checkDenoiser();
// The layers that it reads beside the picture.
std::vector<std::string> denoiserLayers();
// Returns the renderer's last picture without its noise. Waits for the work. Errors: "denoise-missing";
// "layer-missing" if the package lacks a layer; "denoise-failed" with the library's own words.
Result<LinearImage> denoised(const LinearImage& picture, Renderer& renderer);

}  // namespace glint::cli
