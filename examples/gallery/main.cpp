// gallery OUTPUT_DIR: writes the example scene.
#include "scene.h"

#include <iostream>
#include <string_view>

int main(int argc, char** argv) {
    constexpr std::string_view kUsage =
        "usage: gallery OUTPUT_DIR\n"
        "Writes the example scene gallery.gltf, its buffer and its textures into OUTPUT_DIR.\n";
    if (argc == 2 && (std::string_view(argv[1]) == "--help" || std::string_view(argv[1]) == "-h")) {
        std::cout << kUsage;
        return 0;
    }
    if (argc != 2 || std::string_view(argv[1]).empty() || argv[1][0] == '-') {
        std::cerr << kUsage;
        return 2;
    }
    const glint::Status status = gallery::writeGallery(argv[1]);
    if (!status.ok()) {
        std::cerr << glint::toString(status.error()) << '\n';
        return 1;
    }
    std::cout << argv[1] << "/gallery.gltf\n";
    return 0;
}
