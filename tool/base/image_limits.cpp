#include "base/image_limits.h"

namespace glint::base {

Status checkImageSize(std::int64_t width, std::int64_t height, const std::string& where) {
    if (width >= 1 && height >= 1 && width <= kMaxImageSize && height <= kMaxImageSize &&
        width * height <= kMaxImagePixels) {
        return okStatus();
    }
    return makeError("image-size", where,
                     "is " + std::to_string(width) + " x " + std::to_string(height) +
                         " pixels; Glint takes 1 to 16384 each way and 67108864 in all");
}

}  // namespace glint::base
