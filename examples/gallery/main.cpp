// gallery [--evening] OUTPUT_DIR: writes the example scene.
#include "scene.h"

#include <iostream>
#include <string_view>

int main(int argc, char** argv) {
    constexpr std::string_view kUsage =
        "usage: gallery [--evening] OUTPUT_DIR\n"
        "Writes the example scene gallery.gltf, its buffer and its textures into OUTPUT_DIR.\n"
        "\n"
        "  --evening  write evening.gltf instead: the same room in low light, with a camera for it\n"
        "             and the environment map evening.hdr\n";
    const bool evening = argc == 3 && std::string_view(argv[1]) == "--evening";
    const char* const folder = argv[argc - 1];
    if (argc == 2 && (std::string_view(argv[1]) == "--help" || std::string_view(argv[1]) == "-h")) {
        std::cout << kUsage;
        return 0;
    }
    if (argc != (evening ? 3 : 2) || std::string_view(folder).empty() || folder[0] == '-') {
        std::cerr << kUsage;
        return 2;
    }
    const glint::Status status =
        gallery::writeGallery(folder, evening ? gallery::TimeOfDay::Evening : gallery::TimeOfDay::Noon);
    if (!status.ok()) {
        std::cerr << glint::toString(status.error()) << '\n';
        return 1;
    }
    std::cout << folder << (evening ? "/evening.gltf\n" : "/gallery.gltf\n");
    return 0;
}
