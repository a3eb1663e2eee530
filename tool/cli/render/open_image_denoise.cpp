#include "base/files.h"
#include "cli/render/frames.h"

#ifdef GLINT_OPEN_IMAGE_DENOISE
#include <OpenImageDenoise/oidn.hpp>
#include <algorithm>
#include <array>
#include <utility>
#endif

namespace glint::cli {

std::vector<std::string> denoiserLayers() {
    return {"albedo", "emission", "normal"};
}

#ifdef GLINT_OPEN_IMAGE_DENOISE

namespace {

constexpr std::size_t kChannels = 3;

// An image in memory that both the host and the device of the library reach, whatever device it chose.
class SharedImage {
public:
    SharedImage(oidn::DeviceRef& device, std::size_t width, std::size_t height)
        : width_(width),
          height_(height),
          buffer_(device.newBuffer(width * height * kChannels * sizeof(float))) {}

    // Fills it with valueOf(pixel, channel).
    template <typename ValueOf>
    bool fill(const ValueOf& valueOf) {
        auto* const values = static_cast<float*>(buffer_ ? buffer_.map() : nullptr);
        if (values == nullptr) {
            return false;
        }
        for (std::size_t i = 0; i < width_ * height_ * kChannels; ++i) {
            values[i] = valueOf(i / kChannels, i % kChannels);
        }
        buffer_.unmap(values);
        return true;
    }

    bool copyTo(LinearImage& image) {
        auto* const values = static_cast<float*>(buffer_ ? buffer_.map() : nullptr);
        if (values == nullptr) {
            return false;
        }
        for (std::size_t i = 0; i < width_ * height_ * kChannels; ++i) {
            image.pixels[i / kChannels][i % kChannels] = values[i];
        }
        buffer_.unmap(values);
        return true;
    }

    void giveTo(oidn::FilterRef& filter, const char* name) const {
        filter.setImage(name, buffer_, oidn::Format::Float3, width_, height_);
    }

private:
    std::size_t width_;
    std::size_t height_;
    oidn::BufferRef buffer_;
};

Status failureOf(oidn::DeviceRef& device, bool isDone) {
    const char* message = nullptr;
    const oidn::Error error = device.getError(message);
    if (isDone && error == oidn::Error::None) {
        return okStatus();
    }
    return makeError(
        "denoise-failed", "",
        std::string("Open Image Denoise: ") + (message != nullptr ? message : "it gave no reason"),
        "render without --denoise, or a smaller picture");
}

}  // namespace

Status checkDenoiser() {
    return okStatus();
}

Result<LinearImage> denoised(const LinearImage& picture, Renderer& renderer) {
    std::array<LayerValues, 3> layers;  // in the order of denoiserLayers()
    for (std::size_t i = 0; i < layers.size(); ++i) {
        GLINT_TRY(layers[i], renderer.readLayer(denoiserLayers()[i]));
    }
    const auto& [albedo, emission, normal] = layers;
    const auto layerAt = [](const LayerValues& layer, std::size_t pixel, std::size_t channel) {
        return layer.reals[pixel * layer.components + channel];
    };
    oidn::DeviceRef device = oidn::newDevice();
    device.commit();
    SharedImage color(device, picture.width, picture.height);
    SharedImage surface(device, picture.width, picture.height);
    SharedImage facing(device, picture.width, picture.height);
    SharedImage output(device, picture.width, picture.height);
    bool isDone = color.fill([&](std::size_t i, std::size_t c) { return picture.pixels[i][c]; });
    // Light sources count as white, so that its edges stay sharp.
    isDone = isDone && surface.fill([&](std::size_t i, std::size_t c) {
        return std::min(layerAt(albedo, i, c) + layerAt(emission, i, c), 1.0F);
    });
    isDone = isDone && facing.fill([&](std::size_t i, std::size_t c) { return layerAt(normal, i, c); });
    LinearImage result = picture;
    if (isDone) {
        oidn::FilterRef filter = device.newFilter("RT");
        color.giveTo(filter, "color");
        surface.giveTo(filter, "albedo");
        facing.giveTo(filter, "normal");
        output.giveTo(filter, "output");
        filter.set("hdr", true);
        filter.commit();
        filter.execute();
        isDone = output.copyTo(result);
    }
    const Status failed = failureOf(device, isDone);
    return failed ? Result<LinearImage>(std::move(result)) : failed.error();
}

#else

Status checkDenoiser() {
    return makeError(
        "denoise-missing", "", "this glint was built without Open Image Denoise, which --denoise uses",
        "install the library with its CMake files (github.com/RenderKit/oidn), configure the build "
        "with -DOpenImageDenoise_ROOT=DIR, and build glint again");
}

Result<LinearImage> denoised(const LinearImage& /*picture*/, Renderer& /*renderer*/) {
    return checkDenoiser().error();
}

#endif

}  // namespace glint::cli
