#include "package/interop_hash.h"

#include <xxhash.h>

namespace glint {

std::uint32_t interopHash() {
    const std::string_view text = interopText();
    return static_cast<std::uint32_t>(XXH3_64bits(text.data(), text.size()));
}

}  // namespace glint
