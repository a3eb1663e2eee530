#include "base/files.h"
#include "image/compare.h"
#include "image/png.h"
#include "image/tone.h"
#include "measure/page.h"
#include "measure/report_json.h"

#include <glint/measure/report.h>
#include <glint/measure/settings_file.h>

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <system_error>
#include <vector>

namespace glint::measure {

namespace {

namespace fs = std::filesystem;

constexpr const char* kImages = "images";

// The files, and their content for the page.
struct Pictures {
    std::vector<PageImage> files;
    std::vector<PageImage> ofPage;
};

// Returns means over `factor` x `factor` pixels. The remainder at the right and the bottom is cut off.
image::DisplayImage shrunk(const image::DisplayImage& image, std::uint32_t factor) {
    const std::uint32_t area = std::max(1U, factor * factor);
    image::DisplayImage small{image.width / factor, image.height / factor, {}};
    for (std::uint32_t y = 0; y < small.height; ++y) {
        for (std::uint32_t x = 0; x < small.width; ++x) {
            std::array<std::uint32_t, 3> sum{};
            for (std::uint32_t i = 0; i < area; ++i) {
                const std::size_t row = std::size_t{y} * factor + i / factor;
                const auto& pixel = image.pixels[row * image.width + std::size_t{x} * factor + i % factor];
                for (std::size_t c = 0; c < 3; ++c) {
                    sum[c] += pixel[c];
                }
            }
            std::array<std::uint8_t, 3> mean{};
            for (std::size_t c = 0; c < 3; ++c) {
                mean[c] = static_cast<std::uint8_t>((sum[c] + area / 2) / area);
            }
            small.pixels.push_back(mean);
        }
    }
    return small;
}

Status add(Pictures& pictures, std::uint32_t factor, const std::string& name,
           const image::DisplayImage& image) {
    GLINT_TRY(auto png, encodePng(image, name));
    GLINT_TRY(auto small, factor == 1 ? png : encodePng(shrunk(image, factor), name));
    pictures.files.push_back({name, std::move(png)});
    pictures.ofPage.push_back({name, std::move(small)});
    return okStatus();
}

image::DisplayImage shown(const LinearImage& image, double exposure) {
    image::DisplayImage display{image.width, image.height, {}};
    display.pixels.reserve(image.pixels.size());
    for (const std::array<float, 4>& pixel : image.pixels) {
        display.pixels.push_back(image::toDisplay({pixel[0], pixel[1], pixel[2]}, exposure));
    }
    return display;
}

Result<Pictures> picturesOf(const BenchReport& report) {
    const double exposure = report.reference.exposure;
    const std::uint32_t factor = pictureScale(report);
    Pictures pictures;
    const LinearImage reference = image::exposed(report.reference.image, exposure);
    Status added = add(pictures, factor, kReferenceImage, shown(report.reference.image, exposure));
    for (std::size_t i = 0; added && i < report.points.size(); ++i) {
        const LinearImage& image = report.points[i].image;
        added = add(pictures, factor, imageName(i), shown(image, exposure));
        if (added) {
            added = add(pictures, factor, errorImageName(i),
                        image::differenceMap(image::exposed(image, exposure), reference));
        }
    }
    return added ? Result(std::move(pictures)) : Result<Pictures>(added.error());
}

// Removes pictures of an earlier bench that had more configurations.
void removeOthers(const fs::path& folder, const std::vector<PageImage>& pictures) {
    std::set<std::string> names;
    for (const PageImage& picture : pictures) {
        names.insert(fs::path(picture.name).filename().string());
    }
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / kImages, ignored)) {
        if (entry.path().extension() == ".png" && !names.contains(entry.path().filename().string())) {
            fs::remove(entry.path(), ignored);
        }
    }
}

}  // namespace

Status checkBenchFolder(const fs::path& folder, const char* mark) {
    std::error_code error;
    const fs::file_status status = fs::status(folder, error);
    if (fs::exists(status) && !fs::is_directory(status)) {
        return makeError("bench-folder", folder.string(), "is a file, not a folder", "give another -o");
    }
    if (fs::exists(status) && !fs::is_empty(folder, error) && !fs::exists(folder / mark, error)) {
        return makeError("bench-folder", folder.string(), "holds something other than a bench",
                         "give an empty folder, a new one, or that of an earlier bench");
    }
    const Status possible = base::checkOutputFolder(folder);
    return possible ? possible
                    : Status(makeError("bench-folder", folder.string(), possible.error().message,
                                       "give another -o, or check the folder and its permissions"));
}

Status writeBench(const BenchReport& report, const fs::path& folder) {
    GLINT_TRY(const auto pictures, picturesOf(report));
    std::error_code error;
    fs::create_directories(folder / kImages, error);
    if (error) {
        return makeError("bench-folder", folder.string(), "can't be made: " + error.message(),
                         "give another -o");
    }
    for (const PageImage& picture : pictures.files) {
        GLINT_TRY_DO(base::writeFile(folder / picture.name, picture.png));
    }
    if (report.advice && report.advice->point) {
        compiler::Configuration settings = report.base;
        for (const auto& [name, value] : report.points[*report.advice->point].configuration) {
            settings[name] = value;
        }
        GLINT_TRY_DO(base::writeFile(folder / kSettingsFile, settingsText(settings, report.command)));
    }
    const base::Json json = base::jsonOf(report);
    GLINT_TRY_DO(base::writeFile(folder / kReportFile, base::toText(json)));
    GLINT_TRY_DO(base::writeFile(folder / kPageFile, makePage(json, pictures.ofPage)));
    removeOthers(folder, pictures.files);
    return okStatus();
}

}  // namespace glint::measure
