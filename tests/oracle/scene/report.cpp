#include "oracle/scene/report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace glint::oracle {

std::string toText(const Difference& difference, std::uint32_t list) {
    std::string text = fmt::format(
        "pixels          {} ({} not finite)\n"
        "mean            {:.4g}\n"
        "RMSE            {:.2e} (independent samples {:.2e})\n"
        "relMSE          {:.2e}\n"
        "relative error  median {:.1e}, 99.9 % {:.1e}, largest {:.1e}\n"
        "signed mean     {:+.1e} ± {:.0e}\n"
        "off by > {:.0e}  {} pixels; {} beyond what samples explain\n",
        difference.pixels, difference.notFinite, difference.mean, difference.rootMeanSquare,
        difference.expected, difference.relMse, difference.median, difference.p999, difference.largest,
        difference.signedMean, difference.signedError, kDiffers, difference.different.size(),
        difference.outliers);
    for (std::size_t i = 0; i < kCauses; ++i) {
        const Cause cause = static_cast<Cause>(i);
        if (difference.count(cause) > 0) {
            text += fmt::format("  {:<18}{} pixels, largest {:.1e}\n", nameOf(cause), difference.count(cause),
                                difference.largestOf(cause));
        }
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(list, difference.different.size()); ++i) {
        const DifferentPixel& pixel = difference.different[i];
        text += fmt::format(
            "  ({}, {}) {:.2e} {}, {}: device {:.6f} {:.6f} {:.6f}, truth {:.6f} {:.6f} {:.6f}\n", pixel.x,
            pixel.y, pixel.relative, pixel.cause ? nameOf(*pixel.cause) : "mean", pixel.material,
            pixel.device[0], pixel.device[1], pixel.device[2], pixel.truth.x, pixel.truth.y, pixel.truth.z);
    }
    return text;
}

std::string toJson(const Difference& difference, std::uint32_t rays, std::uint32_t samples) {
    nlohmann::ordered_json causes = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < kCauses; ++i) {
        const Cause cause = static_cast<Cause>(i);
        if (difference.count(cause) > 0) {
            causes[std::string(nameOf(cause))] = {{"pixels", difference.count(cause)},
                                                  {"largest", difference.largestOf(cause)}};
        }
    }
    const nlohmann::ordered_json json{{"rays", rays},
                                      {"samples", samples},
                                      {"pixels", difference.pixels},
                                      {"notFinite", difference.notFinite},
                                      {"mean", difference.mean},
                                      {"rmse", difference.rootMeanSquare},
                                      {"expectedRmse", difference.expected},
                                      {"relMse", difference.relMse},
                                      {"median", difference.median},
                                      {"p999", difference.p999},
                                      {"largest", difference.largest},
                                      {"signedMean", difference.signedMean},
                                      {"signedError", difference.signedError},
                                      {"differing", difference.different.size()},
                                      {"outliers", difference.outliers},
                                      {"causes", causes}};
    return json.dump(2) + "\n";
}

}  // namespace glint::oracle
