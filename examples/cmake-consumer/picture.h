// Renders one frame without a window.
#pragma once

#include <glint/package.h>
#include <glint/renderer.h>
#include <glint/result.h>
#include <glint/scene_view.h>

#include <string>

glint::Result<glint::LinearImage> renderPicture(glint::Context& context, const glint::Package& package,
                                                const glint::SceneView& scene);

// Writes a PPM file: 8 bits a channel, sRGB, with values above 1 clipped.
glint::Status writePicture(const glint::LinearImage& image, const std::string& path);
