// Compares what Glint shows with the specification and with the approximations that Glint states.
#pragma once

#include "oracle/spec/device.h"

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace glint::spec {

// What lights a row.
enum class Lighting : std::uint8_t { Lights, Traced, Untraced };
inline constexpr const char* kLightingNames[] = {"lights", "traced", "untraced"};

// Means over views, and ratios of such means, by channel.
struct Seen {
    Vec3 device{0.0};
    Vec3 error{0.0};   // standard error of the device's mean
    Vec3 plain{0.0};   // the specification's
    Vec3 stated{0.0};  // with the approximations that Glint states
};

// An approximation that Glint states, and what it changes.
struct Approximation {
    std::string what;
    double share = 0.0;  // of the specification's light, in the channel where that is largest
    std::string why;     // empty where `what` says it
};

struct Comparison {
    std::string group;
    std::string name;
    Lighting lighting = Lighting::Lights;
    MapKind map = MapKind::White;  // without lights
    bool compensation = true;
    bool white = false;
    // Light scatters once where it passes microfacets or a coat by rays, and nothing gives back what that
    // loses.
    bool losesByDesign = false;
    Seen whole;
    std::array<Seen, 3> zones;         // by Zone
    std::array<int, 3> viewsOfZone{};  // 0: no view of the zone faces the surface
    // The mean over views of |device - plain|, and of |device - stated|, over the mean of the truth, in the
    // channel where it is largest.
    double relativeDifference = 0.0;
    double statedDifference = 0.0;
    std::vector<Approximation> approximations;  // of half a percent or more

    // The ratio in the channel where it is farthest from 1. Channels with less than a thousandth of the light
    // of the brightest do not count.
    double ratio() const;           // device over specification
    double predictedRatio() const;  // stated over specification
    double statedRatio() const;     // device over stated
    // How far statedRatio() may be off by chance: four standard errors, relative.
    double noise() const;
};

double farthestRatio(const Vec3& numerator, const Vec3& denominator);

struct ComparisonOptions {
    DeviceOptions device;
    bool manyViews = false;
    std::size_t mapWidth = 256;
    Masking masking = Masking::HeightCorrelated;  // of the specification
    int quality = 64;                             // points of a quadrature, and twice as many across
};

// The device, the maps and what was integrated once, for any number of comparisons.
class Comparer {
public:
    Comparer(const Rows& rows, const ComparisonOptions& options);
    Comparison underLights(std::size_t row);
    Comparison underMap(std::size_t row, MapKind kind, Transport transport);
    // A sphere of a row with `sphere` in a white furnace. What it should show is 1, with compensation and
    // without a rough coat.
    Comparison inFurnaceOnSphere(std::size_t row, Transport transport);

private:
    struct LoadedMap {
        std::unique_ptr<Map> map;
        std::unique_ptr<Harmonics> harmonics;
        std::unique_ptr<Environment> environment;
    };
    const LoadedMap& mapOf(MapKind kind);
    Choices plainChoices() const;
    Choices statedChoices() const;
    bool losesByDesign(const Row& row, Transport transport) const;
    Comparison start(std::size_t row) const;

    const Rows& rows_;
    ComparisonOptions options_;
    Device device_;
    Albedos albedos_;
    std::map<MapKind, LoadedMap> maps_;
};

std::string toMarkdown(const std::vector<Comparison>& comparisons);
std::string toJson(const std::vector<Comparison>& comparisons);

}  // namespace glint::spec
